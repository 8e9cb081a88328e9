"""`rps export`: other programs find what rps finds, within what their models leave out."""

import ast
import importlib.util
import json
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from commands.conftest import columns, write_case
from paper_structures import known, needs_compiled_kernels, python
from scipy.integrate import solve_ivp

from rpscli.case.case import load_case
from rpscli.records.loading import load_record

pytestmark = needs_compiled_kernels

SLENDER = """\
rps: 1
superstructure:
  storeys: 2
  storey_mass: [60 t, 50 t]
  period: 0.25
  damping: {ratio: 0.05}
podium:
  bearing: {semi_diagonal: 2.0, slenderness: 0.06, wedge_slenderness: 0.2, curvature_ratio: 0.3}
  cap_beam_mass_ratio: 10
  superstructure_mass_ratio: 1
  impact: {loss: 0}
record: {source: "pulse:sine?amplitude=0.15g&period=0.8&dt=0.005"}
analysis: {free_vibration: 3}
"""


def rerun(folder):
    """Columns of both programs after the script has run."""
    python(str(folder / "rerun.py"))
    assert (folder / "rerun.png").stat().st_size > 10_000
    return columns(folder / "timehistory.csv"), columns(folder / "rerun.csv")


def gap(of, ours, theirs):
    """Largest difference at the samples of rps, over the largest value."""
    mine = np.array(ours[of], dtype=float)
    at = np.array(ours["time [s]"], dtype=float)
    time, found = (np.array(theirs[name], dtype=float) for name in ("time [s]", of))
    other = np.interp(at, time, found)
    return float(np.abs(other - mine).max() / np.abs(mine).max())


UP = "record.vertical=pulse:half_sine?amplitude=0.4g&period=0.6&dt=0.01"


@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.evidence("export", "program")
@pytest.mark.long
@pytest.mark.parametrize("vertical", ["record.vertical=null", UP])
def test_mujoco_finds_the_same(workplace, rps, vertical):
    pytest.importorskip("mujoco", reason="pip install rpscli[contact]")
    write_case("small.yaml", ("period=0.6", "period=0.6&dt=0.01"))
    short = ("--set", "analysis.free_vibration=0.3", "--set", vertical)
    rps("export", "small.yaml", "mujoco", "-o", "m", *short)
    ours, theirs = rerun(workplace / "m")
    # contacts close within 0.1 ms, a part of a thousand of the period; the rest are its corners
    assert gap("cap_beam_displacement [m]", ours, theirs) < 5e-3
    assert gap("storey_1_drift [m]", ours, theirs) < 2e-2


@pytest.mark.evidence("export", "program")
@pytest.mark.long
def test_opensees_finds_the_same_where_impacts_take_nothing(workplace, rps):
    if importlib.util.find_spec("openseespy") is None:
        pytest.skip("pip install openseespy")
    (workplace / "slender.yaml").write_text(SLENDER, encoding="utf-8")
    rps("export", "slender.yaml", "opensees", "-o", "o")
    ours, theirs = rerun(workplace / "o")
    # 0.8 % are of the spring, which is soft up to uplift (6 % if that is ten times as far), and
    # 0.2 % of tan(alpha)^2 = 0.0036
    assert gap("cap_beam_displacement [m]", ours, theirs) < 1.5e-2


def test_a_damper_takes_as_much_as_an_impact(workplace, rps_json):
    """Of a rigid building: a swing is integrated here, and its energy is lost as (1 - e^2)."""
    law = "podium:\n  impact: {law: value, restitution: 0.99}"
    write_case("stiff.yaml", ("podium:", law))
    rps_json("export", "stiff.yaml", "opensees", "-o", "o")
    text = (workplace / "o" / "model.py").read_text(encoding="utf-8")
    found = {
        node.targets[0].id: ast.literal_eval(node.value)
        for node in ast.parse(text).body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }
    mass = found["BEAM"] + sum(found["MASSES"])
    u, force = found["DISPLACEMENTS"], found["FORCES"]
    # between samples it may be a little more
    history = columns(workplace / "o" / "timehistory.csv")["cap_beam_displacement [m]"]
    released = max(abs(float(displacement)) for displacement in history)

    def rates(_, y):
        return [y[1], -(np.interp(y[0], u, force) + found["LOSS"] * y[1]) / mass]

    def turns(_, y):
        return float(y[1])

    turns.direction = 1.0
    turns.terminal = True
    swing = solve_ivp(
        rates, (0.0, 20.0), [released, -1e-9], events=turns, rtol=1e-8, max_step=0.01
    )
    ends = [released, -float(swing.y[0, -1])]
    at = np.linspace(0.0, 1.0, 4001)
    before, after = (
        np.trapezoid(np.interp(at * end, u, force), at * end) for end in ends
    )
    # the damper itself slows the swing: second order in what it takes, which is 2 %
    assert 1.0 - after / before == pytest.approx(1.0 - 0.99**2, rel=0.02)
    moved = (
        found["PUSHED"] / 10.5
    )  # of which half moves with a cap beam of ten times their mass
    # half-way at the speed of a half, and turning, I_o/(m_c R^2) = 4/3, by du_b/(2 R cos(alpha))
    moving = 10.0 + 0.25 + 0.25 * (4.0 / 3.0 - 1.0) * (1.0 + 0.15**2)
    assert found["BEAM"] == pytest.approx(moving * moved, rel=1e-9)


def test_what_a_model_lacks_is_refused(workplace, rps):
    """With a remedy that works."""
    pulse = "pulse:sine?amplitude=0.1g&period=1&dt=0.01"
    two = ("--record", pulse, "--record", pulse.replace("period=1", "period=2"))
    for given, remedy in {
        "podium.devices=[{kind: viscous, coefficient: 1e5}]": "--set podium.devices=null",
        "podium.contact={kind: edges, period_ratio: 1.2}": "--set podium.contact=null",
        f"record={{source: '{pulse}', vertical: '{pulse}'}}": "--set record.vertical=null",
        f"record={{x: '{pulse}', y: '{pulse}'}}": "name one of both components by --record",
    }.items():
        rps("export", "small.yaml", "opensees", "--set", given, exit_code=2, says=remedy)
        found = remedy.split()[1:] if "--set" in remedy else [pulse]
        rest = ("--set", *found) if "--set" in remedy else ("--record", *found)
        words = ("--set", given, *rest, "--force")
        rps("export", "small.yaml", "opensees", *words)
    rps("export", "small.yaml", "opensees", *two, "-o", "two", exit_code=2)
    assert not (workplace / "two").exists()


def test_storeys_that_yield_are_springs_of_opensees(workplace, rps):
    """`Steel01` has their law: strength, stiffness, kinematic hardening."""
    yields = "--set", "superstructure.yield={shears: 900 kN, hardening: 0.02}"
    refused = rps("export", "small.yaml", "mujoco", *yields, exit_code=2)
    assert "--set superstructure.yield=null" in refused.stderr
    stiffnesses = known(
        load_case("small.yaml").structure.superstructure
    ).stiffnesses.tolist()
    for laws, options in (([(9e5, k, 0.02) for k in stiffnesses], yields),
                          ([(k, 0.0) for k in stiffnesses], ())):  # fmt: skip
        rps("export", "small.yaml", "opensees", "-o", "o", *options)
        assert f"SPRINGS = {laws}" in (workplace / "o/model.py").read_text(
            encoding="utf-8"
        )


def test_vertical_motion_is_beside_the_model(workplace, rps):
    write_case("small.yaml", ("period=0.6", "period=0.6&dt=0.01"))
    rps("export", "small.yaml", "mujoco", "-o", "m", "--set", UP)
    history = columns(workplace / "m" / "timehistory.csv")
    up = [float(value) for value in history["ground_acceleration_up [m/s2]"]]
    motion = load_record(UP.partition("=")[2]).acceleration
    assert up[: len(motion)] == pytest.approx(
        motion.tolist(), rel=1e-8
    )  # ten digits are written
    assert not any(up[len(motion) :])


OVERTURNING = "synthetic:?pga=0.4g&seed=1&duration=20&dt=0.01"
OTHER = """\
DISPLACEMENTS, STOREYS = [], 0
class ops:
    step = 0
    def analyze(parts, dt): ops.step += 1; return 0
    def nodeDisp(node, way): return 0.01 * 1.5**ops.step
def build(ground, dt, released): pass
"""
"""In place of a model: it runs away."""


def other_program(folder, text):
    """A package of that name, as the script finds it."""
    (folder / "site" / "openseespy").mkdir(parents=True)
    (folder / "site" / "openseespy" / "opensees.py").write_text(text, encoding="utf-8")
    return str(folder / "site")


def test_a_model_that_overturns_stops_and_says_so(workplace, rps):
    rps("export", "small.yaml", "opensees", "-o", "o")
    (workplace / "o" / "model.py").write_text(OTHER, encoding="utf-8")
    places = {"PYTHONPATH": other_program(workplace, "")}
    done = python(str(workplace / "o/rerun.py"), environment=places)
    assert done.stdout.startswith("overturned at ")
    _, found, *_ = columns(workplace / "o" / "rerun.csv").values()
    *_, before, last = (abs(float(displacement)) for displacement in found)
    beyond = float(done.stdout.split(" m\n")[0].split()[-1])
    assert before < beyond <= last
    assert beyond < 4.0  # columns are 3 m long


def test_what_the_other_program_lacks_is_one_sentence(workplace, rps):
    rps("export", "small.yaml", "opensees", "-o", "o")
    site = other_program(
        workplace,
        "try:\n    raise ImportError('libblas.so.3: cannot open')\n"
        "except ImportError:\n    raise RuntimeError('Failed to import openseespy')\n",
    )
    done = python(
        str(workplace / "o/rerun.py"), environment={"PYTHONPATH": site}, exit_code=1
    )
    (line,) = done.stderr.splitlines()
    assert line.startswith(
        "openseespy cannot be loaded: libblas.so.3: cannot open; install it"
    )


def test_how_long_programs_compare_is_said(workplace, rps_json):
    """A frame that rocks for long under a record that is none of a pulse."""
    (workplace / "slender.yaml").write_text(SLENDER, encoding="utf-8")
    calm = rps_json("export", "slender.yaml", "mujoco", "-o", "calm")
    assert calm["comparable_until"] is None
    assert "1 % of the\nlargest to the end." in calm["limits"]
    assert "the case has e = 1, and histories part at the first impact" in calm["limits"]
    shaken = "synthetic:?pga=0.25g&seed=2&duration=20&dt=0.01"
    wild = rps_json("export", "slender.yaml", "mujoco", "-o", "wild", "--record", shaken)
    until = wild["comparable_until"]
    assert 1.0 < until < 20.0
    assert f"up to {until:.4g} s" in wild["limits"]
    fallen = rps_json(
        "export", "slender.yaml", "mujoco", "-o", "f", "--record", OVERTURNING
    )
    assert "In rps it overturns at " in fallen["limits"]
    assert f"COMPARABLE = {until!r}\n" in (workplace / "wild" / "rerun.py").read_text(
        "utf-8"
    )


def test_a_title_stays_text(workplace, rps):
    title = 'a --> <b> & """ \'\' \\ {c} \x07'
    write_case("small.yaml", ('"Three storeys [test]"', json.dumps(title)))
    for program in ("mujoco", "opensees"):
        rps("export", "small.yaml", program, "-o", program)
    shown = title.replace("\x07", "\ufffd")
    model = fromstring((workplace / "mujoco/model.xml").read_text("utf-8"))  # noqa: S314 -- ours
    assert model.attrib == {"model": shown}
    assert len(model.findall("worldbody/body")) == 3
    lines = (workplace / "opensees" / "model.py").read_text(encoding="utf-8").splitlines()
    (said,) = (line for line in lines if line.startswith("TITLE = "))
    assert ast.literal_eval(said.removeprefix("TITLE = ")) == shown
