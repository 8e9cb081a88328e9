"""Every inadmissible case is refused with place, value, rule and remedy: tables of refusals."""

import pytest

from rpscli.case.case import case_from_mapping
from rpscli.case.schema.keys import REMOVED
from rpscli.errors import CaseError

from .conftest import (
    BUILDING,
    COLUMNS,
    EDGES,
    EQUIPPED,
    FLAT,
    FRAME,
    PLANE,
    case_of,
    refusal,
)

WITHOUT_END = """\
  impact: {law: rigid}
record: {source: motion.at2}
analysis: {free_vibration: auto}
limits: {rotation_ratio: 0.5}
"""
OF_A_BUILDING = [
    # text, what stands in its place, beginning of the message, and parts of it
    ("storeys: 3", "storeys: 3.0", "3:12: superstructure.storeys = 3.0", "whole number; write 3"),
    ("storeys: 3", "storeys: three", "3:12: superstructure.storeys = 'three'", "whole number"),
    ("storeys: 3", "storeys: -1", "3:12", "from 0 to 200", "0 = no building"),
    ("storeys: 3", "storeys: true", "3:12: superstructure.storeys = true", "whole number"),
    ("200 t", "-200 t", "4:16: superstructure.storey_mass = '-200 t'", "> 0 kg"),
    ("200 t", "[200 t, no, 3]", "4:24: superstructure.storey_mass.1 = 'no'", "a mass"),
    ("200 t", "[]", "4:16: superstructure.storey_mass = []", "empty list"),
    ("200 t", "[[1, 2, 3]]", "4:17: superstructure.storey_mass.0 = [1, 2, 3] must be a mass in kg"),
    ("200 t", "1e300", "4:16", "outside", "check the unit"),
    ("200 t", ".nan", "4:16: superstructure.storey_mass = nan", "finite"),
    ("200 t", "{a: 1}", "4:16: superstructure.storey_mass = {a: 1}", "a mass in kg"),
    ("200 t", "200 kN", "4:16: superstructure.storey_mass = '200 kN' is a force", "W/g"),
    ("200 t", "500 kN", "4:16", "; a weight? 500 kN/g = 50.99 t"),
    ("period: 0.3", "period: 2.5 Hz", "6:11", "; a frequency? 1/(2.5 Hz) = 0.4 s"),
    ("slenderness: 0.15", "slenderness: 8.5 deg", "12:18", "; an angle? tan(8.5 deg) = 0.149"),
    ("slenderness: 0.15", "slenderness: -1", "12:18", ">= 0; it is B/H, as 0.15, or 0 for"),
    ("200 t", "heavy", "4:16: superstructure.storey_mass = 'heavy' must be a mass"),
    ("200 t", "0,3", "4:16", "; a decimal comma: write 0.3"),
    ("200 t", "12,5 t", "4:16", "; a decimal comma: write 12.5 t"),
    ("200 t", "1,500", "4:16", "; digits are not grouped, write 1500"),
    ("200 t", "1 000", "4:16", "; digits are not grouped, write 1000"),
    ("  impact", "  plan: {rows: 200}\n  impact", "17:16", "podium.plan.rows = 200", "[0, 4 m"),
    ("  impact", "  plan: {rows: [0 m]}\n  impact", "17:16: podium.plan.rows must be", "positions"),
    ("  impact", "  plan: {rows: [4, 4 m]}\n  impact", "17:16", "podium.plan.rows", "as in [0, "),
    ("  impact", "  plan: {}\n  impact", "17:9: podium.plan: give length", "not neither"),
    ("  impact", "  plan: {length: 1, y: {}}\n  impact", "17:24: podium.plan.y: give", "neither"),
    ("  impact", "  plan: {length: 1, y: {rows: [4, 4]}}\n  impact", "17:25", "plan.y.rows", "[0"),
    ("  impact", "  plan: {rows: [0, 1, 2]}\n  columns: 4\n  impact", "18:12", "in 3 rows of"),
    ("  impact", "  plan: {length: 9, y: {rows: [0, 1, 2]}}\n  columns: 4\n  impact", "18:12",
     "podium.columns = 4 must be 2 x 3", "wherever two rows"),
    ("  impact", "  plan: {length: 1, rows: [0, 4]}\n  impact", "17:9", "not both"),
    ("period: 0.3", "period: .inf", "6:11", "finite"),
    ("period: 0.3", f"period: {'9' * 350}", "6:11", "finite"),
    ("period: 0.3", "period: true", "6:11: superstructure.period = true", "a time in s"),
    ("profile: sine", "profile: sin", "7:12", "sine, uniform, linear or flexural", "mean sine?"),
    ("ratio: 0.05", "ratio: 5", "8:20", "< 1", "5 % is 0.05"),
    ("ratio: 0.05", "ratio: 5 %", "8:20: superstructure.damping.ratio = '5 %'", "a number"),
    ("[1, 2]", "[1]", "8:33", "two modes, as in [1, 2]"),
    ("[1, 2]", "[0, 2]", "8:34", "modes count from 1"),
    ("[1, 2]", "[1, 4]", "8:33", "from 1 to superstructure.storeys = 3 (line 3)"),
    ("semi_diagonal: 1.5", "semi_diagonal: 0", "11:20", "> 0 m"),
    ("slenderness: 0.15", "slenderness: '0.15'", "12:18", "without quotes"),
    ("ratio: 0.5\n  cap", "ratio: -0.2\n  cap", "14:22", "= -0.2 must be >= 0 (rho = r/2H)"),
    ("ratio: 0.5\n  cap", "ratio: criticl\n  cap", "14:22", "did you mean critical?"),
    ("cap_beam_mass_ratio: 10", "cap_beam_mass_ratio: -1", "15:24", ">= 0"),
    ("cap_beam_mass_ratio: 10", "cap_beam_mass_ratio: ten", "15:24", "it must be a number"),
    ("law: rigid", "law: elastic", "17:17", "flexible, rigid or value"),
    ("impact: {law: rigid}", "impact: flexibel", "17:11", "did you mean flexible?"),
    ("law: rigid", "law: value, restitution: 1.5", "17:37", "> 0 and <= 1"),
    ("law: rigid", "law: rigid, loss: 1.6", "17:30", ">= 0 and <= 1.5", "kappa"),
    ("law: rigid", "law: rigid, contact_time: 30 ms", "17:38", "= '30 ms'", "<= 0.02 s"),
    ("record: {source: motion.at2}", "record: motion.at2", "18:9", "mapping", "source"),
    ("motion.at2", "12", "18:18: record.source = 12", "put it in quotes"),
    ("motion.at2", "' '", "18:18", "empty"),
    ("motion.at2", '"\\ud800"', "18:18: record.source: '\\ud800' holds half a letter"),
    ("motion.at2", "a.txt, units: kg", "18:32: record.units = 'kg' is no unit of", "cm/s2, mm/s2"),
    ("vibration: auto", "vibration: atuo", "19:28", "a time in s", "did you mean auto?"),
    ("free_vibration: auto", "overturning_limit: 0.5", "19:31", ">= 1"),
    ("free_vibration: auto", "recontact_tolerance: 1", "19:33", "> 0 and < 1"),
    ("free_vibration: auto", "gravity: 0", "19:21", "> 0 m/s2"),
    ("free_vibration: auto", "max_events: 0", "19:24", "whole number from 1 to 1000000000"),
    ("limits: {rotation_ratio: 0.5}", "limits: 3", "20:9: limits = 3", "rotation_ratio, ", " more"),
    ("rps: 1", "rps: 2", "1:6: rps = 2", "this program reads version 1"),
    ("  profile: sine", "  yield: {}", "7:10: superstructure.yield: give ratio", "not neither"),
    ("  profile: sine", "  yield: {ratio: 1, shears: 1 MN}", "7:10", "superstructure.yield: give",
     "not both"),
    ("  profile: sine", "  yield: 1.3", "7:10: superstructure.yield = 1.3", "among ratio, shears"),
    ("  profile: sine", "  yield: {ratio: 0}", "7:18: superstructure.yield.ratio = 0 must be > 0"),
    ("  profile: sine", "  yield: {ratio: 1, hardening: 1}", "7:32", ">= 0 and < 1 (h)"),
    ("  profile: sine", "  yield: {shears: 1}", "7:3: superstructure.yield: a strength of 1 N is",
     "of the weight of the floors, 5.88e+06 N; check its unit"),
    ("  profile: sine", "  yield: {shears: [1 MN, 2 MN]}", "7:19", "yield.shears has 2 values"),
    ("  profile: sine", "  yield: {shears: 1 t}", "7:19", "yield.shears = '1 t' is a mass"),
    ("  profile: sine", "  yields: {ratio: 1}", "7:3", "did you mean superstructure.yield?"),
    ("  profile: sine", "  vertical_damping: 0.1", "7:3: superstructure.vertical_damping needs",
     "vertical_period, which is missing"),
    # missing and twice
    ("rps: 1\n", "", "1:1: rps is missing", "write `rps: 1`"),
    ("  storeys: 3\n", "", "2:1: superstructure.storeys is missing", "number of storeys"),
    ("  storey_mass: 200 t\n", "", "2:1: superstructure.storey_mass is missing", "200 t"),
    ("  damping: {ratio: 0.05, modes: [1, 2]}\n", "", "2:1", "damping is missing", "ratio: 0.05"),
    ("{ratio: 0.05, modes", "{modes", "8:3: superstructure.damping.ratio is missing", "ratio"),
    ("  period: 0.3\n", "", "2:1: superstructure has no stiffness", "period", "stiffness"),
    ("  period: 0.3\n", "  stiffness: 1\n", "6:3", "profile (line 7)", "keep one"),
    ("200 t", "[2 t, 2 t]", "4:16: superstructure.storey_mass has 2 values", "= 3 (line 3)"),
    ("t: 3.0", "t: [3, 3, 3, 4]", "5:18: superstructure.storey_height has 4 values", "bottom"),
    ("    slenderness: 0.15\n", "", "10:3: podium.bearing.slenderness is missing", "B/H"),
    ("    wedge_slenderness: 0.30\n", "", "10:3", "wedge_slenderness is missing", "flat ends"),
    ("    curvature_ratio: 0.5\n", "", "10:3", "curvature_ratio is missing", "0 for flat"),
    ("  cap_beam_mass_ratio: 10\n", "", "9:1: podium leaves the mass of the columns open"),
    ("  superstructure_mass_ratio: 3\n", "", "9:1", "mass of the cap beam open", "cap_beam_mass"),
    ("  impact", "  cap_beam_mass: 1\n  impact", "17:3", "_mass_ratio (line 16) both fix"),
    ("  impact", "  column_mass: 1\n  columns: 2\n  impact", "17:3", "(line 15) both fix"),
    ("cap_beam_mass_ratio: 10", "column_mass: 1", "9:1: podium.columns is missing"),
    ("cap_beam_mass_ratio: 10", "cap_beam_mass_ratio: 0", "15:24", "> 0", "(line 3) stands"),
    ("{law: rigid}", "{law: value}", "17:3: podium.impact.restitution: law `value`", "0.92"),
    ("{law: rigid}", "value", "17:3: podium.impact.restitution: law `value`", "0.92"),
    ("law: rigid", "law: rigid, factor: 1.2", "17:3: podium.impact: restitution e = 1.1", "law ri"),
    ("law: rigid", "law: value, restitution: 0.9, loss: 0.5", "17:42", "loss", "law value"),
    ("law: rigid", "restitution: 0.9", "17:12", "law `value`, and it alone"),
    ("source: motion.at2", "scale: 2", "18:1: record.source is missing", "file"),
    ("  storey_height: 3.0\n", "  storey_height: 3.0\n  storey_height: 4\n", "6:3", "twice"),
    ("  period: 0.3", "  period:", "6:3: superstructure.period has no value", "remove the key"),
    ("200 t", "[1, null, 3]", "4:20: superstructure.storey_mass.1 has no value"),
    # unknown keys are the only fault
    ("  impact", "  cap_beam_mas: 3\n  impact", "17:3: podium.cap_beam_mas is not a key",
     "did you mean podium.cap_beam_mass?"),
    ("  profile", "  stifness: 3\n  profile", "7:3", "did you mean superstructure.stiffness?"),
    ("  bearing:", "  baering:", "10:3", "did you mean podium.bearing?"),
    ("    slenderness: 0.15", "    slendernes: 0.15", "12:5", "mean podium.bearing.slenderness?"),
    ("  storey_mass", "  storey-mass", "4:3", "did you mean superstructure.storey_mass?"),
    ("  cap_beam_mass_ratio", "  Cap_Beam_Mass_Ratio", "15:3", "podium.cap_beam_mass_ratio?"),
    ("limits: {", "limits: {gravity: 9.8, ", "20:10", "gravity belongs under analysis"),
    ("  impact: {law: rigid}", "  restitution: 1", "17:3", "belongs under podium.impact"),
    ("record:", "title: a\nstoreys: 3\nrecord:", "19:1", "storeys belongs under superstructure"),
    ("limits: {", "limits: {title: x, ", "20:10", "it belongs at the top level"),
    ("analysis: {", "analysis: {foo: 3, ", "19:12", "known here: free_vibration, recontact"),
    ("analysis: {", "analysis: {foo: , ", "19:12", "known here: free_vibration, recontact"),
    ("analysis: {", "analysis: {foo: {bar: }, ", "19:12", "analysis.foo is not a key"),
    # an arc that does not fit
    ("slenderness: 0.30", "slenderness: 0.10", "13:24", "= 0.1 must be >= slenderness = 0.15"),
    ("ratio: 0.5\n  c", "ratio: 0.05\n  c", "14:22", "must be >= 0.075", "a smaller wedge"),
    ("slenderness: 0.30", "slenderness: 1.60", "14:22", "must be >= 0.725", "use a larger"),
    ("slenderness: 0.15", "slenderness: 8.5", "13:24", "both are tangents"),
    # two components
    ("{source: motion.at2}", "{x: a.at2}", "18:1: record.y is missing"),
    ("{source: motion.at2}", "{x: 0.9, y: b}", "18:13: record.x = 0.9 must be text"),
    ("{source: motion.at2}", "{y: a.at2}", "18:1: record.source is missing"),
    ("{source: motion.at2}", "{x: a, source: b, y: c}", "18:10", "both name the first component"),
    ("motion.at2", "'a.at2?second=b.at2&both&angle=3'", "18:18", "angle= is one direction"),
    ("motion.at2", "a.at2, rotation: 3", "18:25: record.rotation turns a pair"),
    ("source: motion.at2", "x: 'a?second=b&both', y: c", "18:13: record.x names a pair"),
    ("source: motion.at2", "x: c, y: 'a?second=b&angle=3'", "18:19: record.y names a pair"),
    ("source: motion.at2", "source: a, scale: 2, scale_to: {measure: PGA, value: 1}", "18:31"),
    # limits in their three forms
    ("0.5}\n", "{at_most: 0.5, share: 0.1, fractile: 0.5}}\n", "20:26", "a share or a fractile"),
    ("0.5}\n", "{at_most: 0.5, of: mean, share: 0.1}}\n", "20:26: limits.rotation_ratio",
     "must have a share or a fractile or `of: mean`, only one of them; remove the rest"),
    ("0.5}\n", "{at_most: 0.5, of: median}}\n", "20:45: limits.rotation_ratio.of = 'median'",
     "must be mean"),
    ("0.5}\n", "{at_most: 0.5, share: 1}}\n", "20:48", "share = 1 must be >= 0 and < 1; 10 % is"),
    ("0.5}\n", "{share: 0.1}}\n", "20:10: limits.rotation_ratio.at_most is missing"),
    ("0.5}\n", "-1}\n", "20:26: limits.rotation_ratio = -1 must be > 0"),
    ("rotation_ratio: 0.5}\n", "max_base_shear: 2 m}\n", "20:26", "a length, but must be a force"),
    ("rotation_ratio: 0.5}\n", "overturning: 2}\n", "20:23: limits.overturning = 2 must be >= 0"),
    ("rotation_ratio: 0.5}\n", "ductility: 3}\n", "20:10: limits.ductility needs",
     "superstructure.yield, strengths of storeys, in the case; give that, or remove the limit"),
    ("rotation_ratio: 0.5}\n", "max_column_force: 1 kN}\n", "20:10: limits.max_column_force needs",
     "leaves out the overturning moment and the shock of impacts", "podium.columns, podium.plan"),
    ("rotation_ratio: 0.5}\n", "max_column_shear: 1 kN}\n", "20:10: limits.max_column_shear needs",
     "podium.columns and podium.plan", "not that of the most loaded one"),
]  # fmt: skip
OF_A_FRAME = [
    ("radius: 1.2", "radius: 200 mm", "5:5", "curvature_ratio = 0.0666667 must be >="),
    ("wedge_width: 900 mm", "wedge_width: 300 mm", "5:5: podium.bearing.dimensions", ">= slender"),
    (", wedge_width: 900 mm", "", "5:5", "dimensions.wedge_width is missing", "flat ends"),
    (", radius: 1.2", "", "5:5", "dimensions.radius is missing", "0 = flat ends"),
    ("width: 400 mm", "width: 0", "5:5", "curvature_ratio = 0.4 must be > 0.5 with"),
    ("dimensions:", "slenderness: 1\n    dimensions:", "5:5", "(line 6)", "both describe"),
    ("    dimensions", "    inertia_ratio: 0.3\n    dimensions", "5:20", "4/3 is a rect"),
    ("dimensions: {", "#", "4:3: podium.bearing has no value"),
    ("  columns: 4\n", "", "3:1: podium.columns is missing"),
    ("  columns: 4\n", "  cap_beam_mass_ratio: 10\n", "8:3", "(line 6)", "(line 7)", "together"),
    ("  cap_beam_mass: 200 t\n", "", "3:1", "give one of cap_beam_mass or cap_beam_mass_ratio"),
    ("  column_mass: 5 t\n", "", "3:1", "give one of cap_beam_mass_ratio or column_mass"),
    ("  column_mass: 5 t\n", "  cap_beam_mass_ratio: 0\n", "6:18", "(line 7) contradict"),
    ("cap_beam_mass: 200 t\n  column_mass: 5 t", "cap_beam_mass_ratio: 0", "3:1", "column_mass is"),
    ("columns: 4", f"columns: {'9' * 400}", "8:12: podium.columns", "from 1 to 100000"),
    ("  columns: 4", "  superstructure_mass_ratio: 3", "8:3", "storeys = 0 (line 2)", "instead"),
    ("  columns: 4", "  columns: 4\nlimits: {base_shear_ratio: 2}", "9:10", "needs a superstr"),
]  # fmt: skip
FRICTION = "    - {kind: friction, force: 1}\n"
OF_DEVICES = [
    ("force: 400 kN", "force: -1", "21:31: podium.devices.1.force = -1 must be > 0 N"),
    ("force: 400 kN", "force: 4 t", "21:31", "podium.devices.1.force = '4 t' is a mass, but must"),
    (", force: 400 kN", "", "21:7: podium.devices.1.force is missing: friction: F_d"),
    ("force: 4", "gap: 1, force: 4", "21:24", ".gap is not a key of kind: friction, which"),
    ("exponent: 0.5", "exponent: 3", "20:56", ">= 0.2 and <= 2 (a); 1 is a linear damper"),
    ("kind: friction", "kind: fiction", "21:14", "did you mean friction?"),
    ("kind: friction, ", "", "21:7: podium.devices.1.kind is missing: viscous or friction damper"),
    ("force: 4", "forse: 4", "21:24", "is not a key of the format; did you mean"),
    ("yield_force: 300 kN", "yield_force: 90 kN", "19:3", "= 90000 N must be > prestress = "),
    (COLUMNS, "  cap_beam_mass_ratio: 10\n", "22:7: podium.devices.3 is in each column, but"),
    ("    - {kind: fr", f"{FRICTION * 4}    - {{kind: fr", "20:5", "devices: 9 must be at most 8"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "row"),
    [
        *((BUILDING, row) for row in OF_A_BUILDING),
        *((FRAME, row) for row in OF_A_FRAME),
        *((EQUIPPED, row) for row in OF_DEVICES),
    ],
    ids=lambda value: " -> ".join(value[:2]) if isinstance(value, tuple) else "",
)
def test_a_refusal(text, row):
    old, new, start, *parts = row
    message = refusal(text, old, new)
    assert message.startswith(f"c.yaml:{start}")
    assert "\n" not in message
    for part in parts:
        assert part in message


@pytest.mark.parametrize(
    ("key", "now"),
    [item for item in REMOVED.items() if not item[0].startswith("reports.")],
)
def test_a_removed_key_says_what_to_do_without_it(key, now):
    assert (
        refusal(BUILDING, overrides=[f"{key}=1"])
        == f"--set {key}=1: {key} is gone: {now}"
    )


def test_a_section_under_the_wrong_parent():
    message = refusal(FRAME, "  bearing:\n    dimensions:", "  dimensions:")
    assert "3:1: podium.bearing is missing" in message
    assert "4:3: podium.dimensions" in message
    assert "dimensions belongs under podium.bearing" in message


RHO, WEDGE = "podium.bearing.curvature_ratio={}", "podium.bearing.wedge_slenderness={}"
TAN = "podium.bearing.slenderness={}"
ENDS = "podium.bearing.ends={}"
SPHERE = (TAN.format(0), RHO.format(0.7))
ON_PLANE, ON_EDGES = (*FLAT, PLANE), (*FLAT, EDGES)
PLAIN_FRAME = (
    "superstructure={storeys: 0}",
    "podium={bearing: {semi_diagonal: 1, slenderness: 0.2, curvature_ratio: 0}, columns: 4}",
    "podium.cap_beam_mass=9 t",
    "podium.column_mass=1 t",
)
CARRIES = (
    "podium.plan={length: 1}",
    "superstructure.vertical_period=0.1",
    "podium.columns=4",
)
ROUND = "podium.column={section: round, modulus: 35 GPa, poisson: 0.2, contact_strength: 25 MPa}"
TENDON = "[{kind: tendon, prestress: 1 kN, stiffness: 1 kN/mm}]"


@pytest.mark.parametrize(
    ("overrides", "reason"),
    [
        ((WEDGE.format(1.3), RHO.format("critical")), "= 0.442308 must be >= 0.575"),
        ((TAN.format(0),), "curvature_ratio = 0.5 must be > 0.5 with slenderness: 0"),
        ((TAN.format(0), RHO.format("critical")), "curvature_ratio = 0.5 must be > 0.5"),
        ((TAN.format(0), RHO.format(0)), "curvature_ratio = 0 must be > 0.5"),
        ((*SPHERE, "podium.impact.factor=0.9"), "without an impact; remove restitution and fac"),
        ((*SPHERE, f"podium.devices={TENDON}", "podium.columns=4"), "tendons are not followed"),
        (("podium.bearing={inertia_ratio: 1.3}",), "podium.bearing has no shape: give semi_diag"),
        (("superstructure.y={profile: sine}",), "superstructure.y has no stiffness"),
        (("superstructure.y={period: 1, stiffness: 2e6}",), "superstructure.y.period both fix"),
        (("superstructure.y={stiffness: [1e6, 2e6]}",), "superstructure.y.stiffness has 2 values"),
        (("superstructure.storey_height=null", "limits={drift_ratio: 0.1}"), "needs super"),
        (("superstructure.storey_height=null", "podium.plan={length: 1}"), "plan needs super"),
        ((*ON_PLANE, f"podium.devices={TENDON}"), "tendons would load the bed"),
        ((*ON_EDGES, "podium.devices=[{kind: rolling_resistance, lever: 1 mm}]"), "rolling resis"),
        ((*ON_PLANE, "podium.devices=[{kind: stop, gap: 0, stiffness: 1 kN/mm}]"), "gap above"),
        ((*ON_PLANE, "podium.impact.law=rigid"), "floors would jump"),
        ((*ON_EDGES, "podium.impact={law: value, restitution: 0.9}"), "floors would jump"),
        ((*ON_PLANE, "analysis.recontact_tolerance=1e-8"), "recontact_tolerance has no effect"),
        ((*ON_PLANE, "podium.impact.contact_time=1 ms"), "contact_time has no effect with"),
        ((*SPHERE, "podium.impact={law: flexible, contact_time: 1 ms}"), "without a flat part"),
        ((*ON_PLANE, "analysis.initial_rotation=1e-6"), "initial_rotation = 1e-06 rad must be 0"),
        (("podium.impact.law=flexible", "podium.contact={kind: plane, settlement: 1 mm}"),
         "curved ends bear on more than a settlement describes"),
        (("podium.contact={period_ratio: 1.2}",), "whether ends are `plane` or `edges`"),
        ((*FLAT, "podium.contact={kind: plane}"), "stiffness, settlement; 0 are given"),
        ((*ON_PLANE, "podium.contact.stiffness=1 kN/mm"), "2 are given"),
        (("podium.contact={kind: rigid, settlement: 1 mm}",), "rigid contact takes no"),
        ((*ON_PLANE, "podium.contact.period_ratio=1"), "must be > 1 (r = T/T_1)"),
        ((*FLAT, "podium.contact={kind: plane, settlement: 12 mm}"), "does not hold the weight"),
        ((*ON_PLANE, "podium.contact.kind=soft"), "rigid, plane or edges"),
        ((*ON_PLANE, "podium.contact={kind: plane, dampin: 0.1}"), "contact.damping?"),
        ((*PLAIN_FRAME, PLANE), "without one give stiffness or settlement"),
        (("limits={min_column_force: {at_most: 1 kN}}",), "at_least is missing"),
        (("limits={max_column_force: {at_least: 1 kN}}",), "at_most is missing"),
        (("limits={column_moment: 1 kN m}", *FLAT, *CARRIES), "column_moment needs podium.column"),
        ((ROUND, "podium.columns=4", "limits={column_moment: 1 kN m}"), "podium.plan and superstr"),
        ((ROUND, *CARRIES, *FLAT, "limits={contact_pressure_ratio: 1}"), "ratio needs curved ends"),
        ((ROUND,), "podium.columns is missing: podium.column asks for the force of one"),
        ((ROUND, "podium.columns=4", "podium.column.edge_length=1 m"), "belongs to square columns"),
        ((ROUND, "podium.columns=4", "podium.column.section=square"), "column.edge_length belongs"),
        ((ROUND, "podium.columns=4", ENDS.format("cylindrical")), "column.edge_length belongs"),
        ((ROUND, "podium.columns=4", "podium.column.edge_length=1 m", ENDS.format("spherical")),
         "spherical ends touch in a point; remove it"),
        ((*FLAT, ENDS.format("spherical")), "bearing.ends = spherical has no meaning for flat"),
        ((ENDS.format("round"),), "spherical or cylindrical"),
        ((*FLAT, TAN.format(1.2), "podium.superstructure_mass_ratio=50"), "(law flexible) must be"),
        ((ROUND, "podium.column.modulus=35 kN"), "is a force, but must be a pressure"),
        ((ROUND, "podium.column.on.poisson=0.6"), "poisson = 0.6 must be >= 0 and <= 0.5 (nu)"),
        ((ROUND, "podium.column.section=oval"), "square or round"),
    ],
)  # fmt: skip
def test_overrides_that_are_refused(overrides, reason):
    assert reason in refusal(BUILDING, overrides=overrides)


@pytest.mark.parametrize("overrides", [FLAT, SPHERE, ON_PLANE, ON_EDGES, PLAIN_FRAME])
def test_what_they_are_put_over_is_valid(overrides):
    assert case_of(*overrides).structure.restitution > 0.0


def test_faults_of_keys_together_in_order_then_those_between_keys():
    text = BUILDING.replace("period: 0.3", "period: -1").replace(
        "law: rigid", "lw: rigid"
    )
    text = text.replace(
        "    curvature_ratio: 0.5\n", "    curvature_ratio: 0.5\n    x: 1\n"
    )
    text = text.replace("  cap_beam_mass_ratio: 10\n", "")
    message = refusal(
        text, "rps: 1", "rps: 3", ["record.scale=big", "limits.rotation_ratio=0"]
    )
    places = [line.split(": ")[0] for line in message.splitlines()]
    assert places == [
        "c.yaml:1:6",
        "c.yaml:6:11",
        "c.yaml:15:5",
        "c.yaml:17:12",
        "--set record.scale=big",
        "--set limits.rotation_ratio=0",
    ]
    text = BUILDING.replace("  cap_beam_mass_ratio: 10\n", "").replace(
        "  period: 0.3\n", ""
    )
    message = refusal(text, "    slenderness: 0.15\n", "")
    places = [line.split(": ")[0] for line in message.splitlines()]
    assert places == ["c.yaml:2:1", "c.yaml:8:1", "c.yaml:9:3"]


@pytest.mark.parametrize("text", ["podium: 3", "podium: [1]", "podium: text", "podium:"])
def test_a_section_that_is_no_mapping(text):
    message = refusal(f"rps: 1\nsuperstructure: {{storeys: 0}}\n{text}\n")
    assert message.startswith("c.yaml:3:")
    assert "\n" not in message


def test_a_mapping_in_memory_has_its_name_for_a_place():
    with pytest.raises(CaseError) as error:
        case_from_mapping(
            {"rps": 1, "superstructure": {"storeys": 0}, "podium": {}}, "base of x"
        )
    assert str(error.value).splitlines()[0].startswith("base of x: podium")


def test_what_only_the_model_refuses_is_placed(monkeypatch):
    def refusing(*_):
        raise ValueError("no such column")

    monkeypatch.setattr("rpscli.case.structure.built", refusing)
    assert refusal(BUILDING).startswith("c.yaml:9:1: podium: no such column")
