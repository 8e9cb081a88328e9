"""The case file as pydantic models: every key, its meaning, unit and bounds.

Rules that join several keys stand in `case.rules`. Optional keys are None when absent.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, model_validator

from rpscli.case.schema.fields import (
    DampingRatio,
    ModePair,
    NameOf,
    OwnLaws,
    Quantity,
    Section,
    Text,
    Whole,
    must_be,
    refuse,
)
from rpscli.case.schema.limits import LimitsSection
from rpscli.case.schema.scale_to import ScaleToSection
from rpscli.constants import MOST_STOREYS, STANDARD_GRAVITY
from rpscli.model.bearing import Ends
from rpscli.model.devices import DAMPERS
from rpscli.model.impact import CONTACT_TIME, IMPACT_LAWS, LONGEST_CONTACT
from rpscli.records.quantities import KNOWN_UNITS, canonical_unit

Place = Annotated[float, Quantity("m", symbol="of a place")]


class DeviceSection(Section):
    """A device between ground and cap beam; its kind says which keys it has."""

    kind: Annotated[str, NameOf(DAMPERS)]
    """viscous or friction damper, elastic stop, unbonded tendon in the axis of each
    column, or the resistance of the columns to rolling, which goes with rigid ends alone;
    other keys name one by its number, from 0: podium.devices.0.force"""
    coefficient: Annotated[float | None, Quantity("N s/m", symbol="c", above=0)] = None
    """viscous: c, the force at a velocity of 1 m/s, P = c |u_b'|^a"""
    exponent: Annotated[
        float | None,
        Quantity(symbol="a", at_least=0.2, at_most=2, remedy="1 is a linear damper"),
    ] = None
    """viscous: a of P = c |u_b'|^a; 1 if left out"""
    force: Annotated[float | None, Quantity("N", symbol="F_d", above=0)] = None
    """friction: F_d, at which the damper slides"""
    gap: Annotated[float | None, Quantity("m", symbol="d", at_least=0)] = None
    """stop: d, the cap beam's displacement at which it is met, on all sides"""
    stiffness: Annotated[float | None, Quantity("N/m", above=0)] = None
    """stop: k_s; tendon: k_t of one"""
    damping: Annotated[float | None, Quantity("N s/m", symbol="c_s", at_least=0)] = None
    """stop: c_s beside its stiffness; it never pulls; 0 if left out"""
    prestress: Annotated[float | None, Quantity("N", symbol="P_0", at_least=0)] = None
    """tendon: P_0 of one, while the structure stands"""
    yield_force: Annotated[float | None, Quantity("N", symbol="P_y", above=0)] = None
    """tendon: P_y of one; left out: it never yields"""
    at: (
        Annotated[
            tuple[tuple[Place, Place], ...],
            must_be(list, "places on the plan, as in [[0 m, 0 m], [10 m, 10 m]]"),
        ]
        | None
    ) = None
    """viscous and friction with podium.twist: places on the plan, each with an equal part
    of the damper; left out: in the middle of the columns"""
    lever: Annotated[float | None, Quantity("m", symbol="f", above=0)] = None
    """rolling_resistance: f, lever by which the normal force lies ahead of the contact; a
    moment f N at either end of the columns"""


OWN_DAMPERS = OwnLaws("kind", DAMPERS, DeviceSection)

Ratio = Annotated[float, Quantity(at_least=0)]
PositiveRatio = Annotated[float, Quantity(above=0)]
Length = Annotated[float, Quantity("m", above=0)]
Mass = Annotated[float, Quantity("kg", above=0)]
Time = Annotated[float, Quantity("s", above=0)]
Masses = Annotated[float | tuple[float, ...], Quantity("kg", above=0, per_storey=True)]
Lengths = Annotated[float | tuple[float, ...], Quantity("m", above=0, per_storey=True)]
Stiffnesses = Annotated[
    float | tuple[float, ...], Quantity("N/m", above=0, per_storey=True)
]
Forces = Annotated[float | tuple[float, ...], Quantity("N", above=0, per_storey=True)]
Profile = Literal["sine", "uniform", "linear", "flexural"]


class DampingSection(Section):
    """Damping of the building on a fixed base: Rayleigh if
    modes are named, else modal.
    """

    ratio: DampingRatio
    """critical damping ratio"""
    modes: ModePair | None = None
    """the two modes of Rayleigh damping, counted from 1; left out: the same ratio in
    every mode. One storey, or one mode named twice: stiffness-proportional"""


class YieldSection(Section):
    """Storeys that yield at a shear, elastic on the way back;
    strengths are given in one way.
    """

    ratio: Annotated[float | None, Quantity(symbol="F_1/V_st", above=0)] = None
    """F_1/V_st, strength of the first storey over the base shear at uplift; upwards
    strengths go as the shears of the first mode on a fixed base"""
    shears: Forces | None = None
    """strengths F_i in place of ratio: one value, or a list from
    the bottom; the same in y"""
    hardening: Annotated[float, Quantity(symbol="h", at_least=0, below=1)] = 0.0
    """h, stiffness after yielding over the elastic one, kinematic, of all storeys"""


class AcrossSection(Section):
    """Stiffness of the building in y, in place of that along x."""

    period: Time | None = None
    """first period on a fixed base in y; scales the profile"""
    profile: Profile | None = None
    """as in x, for the period in y; sine if left out"""
    stiffness: Stiffnesses | None = None
    """storey stiffness in y in place of period and profile: one value, or a list"""


class TorsionSection(Section):
    """How storeys twist about the vertical, with podium.twist."""

    period_ratio: Annotated[
        float, Quantity(symbol="T_x/T_twist, both uncoupled", at_least=0.2, at_most=5)
    ] = 1.2
    """first period in x over that in twist, both without eccentricity"""
    eccentricity: tuple[
        Annotated[float, Quantity(at_least=-0.5, at_most=0.5)],
        Annotated[float, Quantity(at_least=-0.5, at_most=0.5)],
    ] = (0.0, 0.0)
    """of the centre of stiffness of every storey from that of mass, in parts of the plan's
    lengths in x and y; accidental eccentricity of codes is 0.05, of either sign"""


class SuperstructureSection(Section):
    """The building on the cap beam: a shear building."""

    storeys: Annotated[
        int, Whole(0, MOST_STOREYS, remedy="0 = no building, a rigid frame")
    ]
    """number of storeys; 0 = none, a rigid rolling or rocking frame"""
    storey_mass: Masses | None = None
    """floor mass: one value, or a list from the bottom"""
    storey_height: Lengths | None = None
    """storey height, for drift ratios and pictures: one value, or a list"""
    period: Time | None = None
    """first period on a fixed base; scales the profile"""
    profile: Profile | None = None
    """distribution of the stiffness: a sine, linear or flexural first mode, or
    uniform stiffness; sine if a period is given without it, up to twice as stiff at
    the roof as at the bottom"""
    stiffness: Stiffnesses | None = None
    """storey stiffness in place of period and profile: one value, or a list"""
    damping: DampingSection | None = None
    """damping of the building on a fixed base"""
    vertical_period: Time | None = None
    """first period of the vertical vibration on the cap beam, in which floors move up and
    down on springs; left out: they rise rigidly with the beam"""
    vertical_damping: DampingRatio | None = None
    """damping ratio of each vertical mode; 0.05 if a vertical
    period is given without it"""
    yields: YieldSection | None = Field(
        None,
        alias="yield",
        description="strengths of the storeys; left out: they stay elastic",
    )
    y: AcrossSection | None = None
    """another stiffness in the second horizontal direction; left out:
    the same as in the first"""
    torsion: TorsionSection | None = None
    """how storeys twist, with podium.twist; left out: a period ratio of 1.2,
    concentric
    """


class DimensionsSection(Section):
    """Full sizes of the column, in place of semi_diagonal and the ratios."""

    height: Length
    """2H, between the flat parts of the two ends"""
    width: Annotated[float, Quantity("m", at_least=0)]
    """2B, of the flat part; 0 = spherical or cylindrical ends, which roll from rest"""
    wedge_width: Length | None = None
    """2B', across the outer edges of the arcs; ignored for flat ends"""
    radius: Annotated[
        float,
        Quantity("m", symbol="r, of the arcs", at_least=0, remedy="use 0 for flat ends"),
    ]
    """r of the arcs; 0 = flat ends"""


class BearingSection(Section):
    """Shape of one column."""

    semi_diagonal: Length | None = None
    """R = sqrt(H^2 + B^2), half height and half width of the flat part"""
    slenderness: Annotated[
        float | None,
        Quantity(at_least=0, remedy="it is B/H, as 0.15, or 0 for spherical ends"),
    ] = None
    """tan(alpha) = B/H; 0 = spherical or cylindrical ends, which roll from rest"""
    wedge_slenderness: PositiveRatio | None = None
    """tan(alpha') = B'/H; ignored for flat ends"""
    curvature_ratio: Annotated[
        float | Literal["critical"] | None,
        Quantity(
            symbol="rho = r/2H",
            at_least=0,
            remedy="use 0 for flat ends",
            words=("critical",),
        ),
    ] = None
    """rho = r/2H; 0 = flat ends; critical = (1 - tan(alpha)/tan(alpha'))/2"""
    dimensions: DimensionsSection | None = None
    """sizes in place of semi_diagonal, slenderness,
    wedge_slenderness and curvature_ratio"""
    inertia_ratio: Annotated[
        float,
        Quantity(
            symbol="I_o/(m_c R^2), I_o about the edge",
            at_least=1,
            remedy="4/3 is a rectangular block",
        ),
    ] = 4.0 / 3.0
    """I_o/(m_c R^2), I_o about an edge of the flat part"""
    inertia_ratio_axial: Annotated[
        float | None, Quantity(symbol="I_3/(m_c R^2), I_3 about the axis", above=0)
    ] = None
    """I_3/(m_c R^2), I_3 about the column's axis, where both components act; left out:
    solid round columns, (B'/R)^2/2"""
    ends: Ends | None = None
    """shape of curved ends: spherical = of revolution about the axis, touching in a
    point; cylindrical = curved along the motion only, touching along a line, for one
    component; left out: spherical without a flat part, else as the section says"""


class ImpactSection(Section):
    """What happens when the columns fall back on their flat ends."""

    law: Annotated[str, NameOf(IMPACT_LAWS)] = "flexible"
    """flexible: floors keep their velocity; rigid: floors jump with the cap beam; value:
    restitution is given"""
    restitution: Annotated[
        float | None, Quantity(symbol="velocity after over before", above=0, at_most=1)
    ] = None
    """e of the law value"""
    loss: Annotated[
        float | None,
        Quantity(symbol="kappa = (1 - e)/(1 - e of the law)", at_least=0, at_most=1.5),
    ] = None
    """kappa: part of the law's loss at an impact, 1 - e = kappa (1 - e of the law); 1 =
    impulse at the edges, 0.3 to 0.5 = spread over plane ends on a damped bed; left out:
    0.3 with contact plane, else 1"""
    factor: PositiveRatio = 1.0
    """multiplies the restitution of the law"""
    contact_time: Annotated[
        float, Quantity("s", symbol="t_c", at_least=0, at_most=LONGEST_CONTACT)
    ] = CONTACT_TIME
    """t_c, how long an impact takes, where both horizontal components act: the nearer a
    pass to upright, the more of an impact's loss it has; 0 = passes lose nothing"""


OWN_IMPACTS = OwnLaws("law", IMPACT_LAWS, ImpactSection)


def _law_alone(value: object) -> object:
    return {"law": value} if isinstance(value, str) else value


class ContactSection(Section):
    """What the ends of the columns bear on; other kinds than rigid
    take one of three sizes.
    """

    kind: Literal["rigid", "plane", "edges"] = "rigid"
    """rigid: nothing moves before uplift; plane: a compliant joint that lifts gradually;
    edges: two compliant edges that lift at once"""
    period_ratio: Annotated[float | None, Quantity(symbol="r = T/T_1", above=1)] = None
    """first period in full contact over that on a fixed base, as measured"""
    stiffness: Annotated[float | None, Quantity("N/m", symbol="K_s", above=0)] = None
    """K_s of the podium in full contact, force at the cap beam over u_b"""
    settlement: Annotated[float | None, Quantity("m", symbol="D_0", above=0)] = None
    """D_0 of one joint under the permanent load, of flat ends"""
    damping: Annotated[float, Quantity(symbol="zeta", at_least=0, at_most=2)] = 0.03
    """damping ratio of the podium's own vibration in full contact"""


class RowsSection(Section):
    """Where columns stand in one direction."""

    length: Length | None = None
    """between two rows of columns, the outer ones"""
    rows: (
        Annotated[
            tuple[Annotated[float, Quantity("m", symbol="of each row")], ...],
            must_be(list, "places of the rows, as in [0, 4 m, 8 m]"),
        ]
        | None
    ) = None
    """places of all rows, with equally many columns each"""


class PlanSection(RowsSection):
    """Where columns stand: along the motion, and across it."""

    y: RowsSection | None = None
    """in the second horizontal direction, with a column wherever two rows cross; forces
    of columns under both components need it"""


Modulus = Annotated[float, Quantity("Pa", symbol="E", above=0)]
Poisson = Annotated[float, Quantity(symbol="nu", at_least=0, at_most=0.5)]


class PlateSection(Section):
    """Plates under and over the columns."""

    modulus: Modulus | None = None
    """E of the plate; left out: that of the column"""
    poisson: Poisson | None = None
    """nu of the plate; left out: that of the column"""


class ColumnSection(Section):
    """Section and material of one column."""

    section: Literal["square", "round"]
    """unless bearing.ends says it: square columns with a flat part
    bear on lines, all others in points"""
    edge_length: Length | None = None
    """square: L of the line on which a column bears, across the motion; also of
    cylindrical ends"""
    modulus: Modulus
    """E of the column"""
    poisson: Poisson
    """nu of the column"""
    contact_strength: Annotated[float, Quantity("Pa", symbol="f", above=0)]
    """f, pressure that the ends of the column and the plates can bear"""
    on: PlateSection = PlateSection()
    """plates under and over the columns; left out: like the column"""


class ScatterSection(Section):
    """Columns that differ from each other."""

    slenderness: Annotated[float, Quantity(at_least=0, at_most=0.2, remedy="2 % is 0.02")]
    """standard deviation of the slenderness over its mean"""
    seed: Annotated[int, Whole(0, 2**31)] = 1
    """of what is drawn: run several where only the size is known"""


class TwistSection(Section):
    """The slab turns about the vertical, each column on its own head; needs podium.plan
    with rows and y.rows, and both components.
    """

    scatter: ScatterSection | None = None
    """columns of unequal slenderness, drawn"""
    factors: tuple[Annotated[float, Quantity(at_least=0.5, at_most=2)], ...] = ()
    """in place of scatter: on the slenderness of each column, row by row"""
    pivot_friction: Annotated[float, Quantity("m", symbol="lever", at_least=0)] = 0.0
    """lever of the weight by which friction resists the pivoting of ends; 0 is cautious,
    2 to 15 mm are estimates, which nobody has measured"""
    seats: Annotated[
        float | Literal["free"], Quantity("m", at_least=2e-4, words=("free",))
    ] = "free"
    """how far the slab sinks at a column under its weight; free: it warps freely"""


class PodiumSection(Section):
    """Columns and cap beam."""

    cap_beam_mass_ratio: Ratio | None = None
    """gamma = m_b/(N m_c); 0 = no cap beam, free-standing columns"""
    superstructure_mass_ratio: PositiveRatio | None = None
    """eta = M_tot/m_b, building over cap beam"""
    cap_beam_mass: Annotated[float | None, Quantity("kg", symbol="m_b", at_least=0)] = (
        None
    )
    """m_b; in place of a ratio"""
    column_mass: Mass | None = None
    """m_c of one column; in place of cap_beam_mass_ratio"""
    columns: Annotated[int, Whole(1, 100_000)] | None = None
    """their number N"""
    bearing: BearingSection
    """shape of one column"""
    impact: Annotated[ImpactSection, OWN_IMPACTS, BeforeValidator(_law_alone)] = (
        ImpactSection()
    )
    """impact law; a law's name alone may stand here"""
    contact: ContactSection = ContactSection()
    """what the ends of the columns bear on: rigid, or giving way,
    with a period before uplift"""
    friction: Annotated[
        float | None, Quantity(symbol="of friction, at both ends of the columns", above=0)
    ] = None
    """coefficient of friction at both ends of the columns; the
    friction demand is then judged"""
    wind: Annotated[float | None, Quantity("N", symbol="V_w, base shear", above=0)] = None
    """V_w, base shear of the building under the wind, with the factors of the code; `rps
    check` compares it with the force that moves the cap beam"""
    plan: PlanSection | None = None
    """where columns stand; gives the overturning moment in their forces, with
    superstructure.storey_height"""
    column: ColumnSection | None = None
    """section and material of a column; give its moment and
    the pressure under its ends"""
    twist: TwistSection | None = None
    """the slab turns about the vertical; left out: that is not computed"""
    devices: tuple[Annotated[DeviceSection, OWN_DAMPERS], ...] = ()
    """dampers, stops and tendons between ground and cap beam, at most 8"""

    @property
    def without_cap_beam(self) -> bool:
        """True if the columns stand free."""
        return self.cap_beam_mass_ratio == 0.0 or self.cap_beam_mass == 0.0


def _acceleration(unit: str) -> str:
    if canonical_unit(unit) is None:
        refuse(f"is no unit of acceleration; use one of {KNOWN_UNITS}")
    return unit


def _record_schema(schema: dict[str, Any]) -> None:
    """The first component has two names."""
    del schema["required"]
    schema["anyOf"] = [{"required": ["source"]}, {"required": ["x", "y"]}]


class RecordSection(Section):
    """The ground motion."""

    model_config = ConfigDict(json_schema_extra=_record_schema)

    source: Text
    """a file, a member of a record set, or a pulse; both components of a pair: `?both`"""
    x: Text | None = Field(
        None,
        exclude=True,
        description="in place of source where y is given: the first component",
    )
    y: Text | None = None
    """second horizontal component, which acts together with the first one"""
    rotation: Annotated[float | None, Quantity("deg")] = None
    """of a pair, from x towards y: what acted along x then acts at this azimuth"""
    scale: Annotated[float, Quantity()] = 1.0
    """factor on all components"""
    scale_to: ScaleToSection | None = None
    """value of an intensity measure, in place of scale"""
    vertical: Text | None = None
    """source of the vertical component; own: that which lies beside the file, or in it"""
    dt: Time | None = None
    """time step of a file that does not state it"""
    units: Annotated[Text, AfterValidator(_acceleration)] | None = None
    """unit of the values of a file that does not state it, such as g"""

    @model_validator(mode="before")
    @classmethod
    def _first_component(cls, value: object) -> object:
        if isinstance(value, dict) and "x" in value and "source" not in value:
            x = value["x"]
            fits = (
                isinstance(x, str) and x.strip()
            )  # else it is refused as x, which is enough
            return {"source": x if fits else "x", **value}
        return value


class AnalysisSection(Section):
    """How the time history is computed."""

    free_vibration: Annotated[
        float | Literal["auto"],
        Quantity("s", symbol="after the record's end", at_least=0, words=("auto",)),
    ] = "auto"
    """time after the record; auto = until rest or no new maximum is possible"""
    recontact_tolerance: Annotated[float, Quantity(above=0, below=1)] = 1e-6
    """an excursion below this part of alpha after an impact is contact"""
    initial_rotation: Annotated[float, Quantity(symbol="rad")] = 0.0
    """rotation from which the structure is released at rest; 0 = full contact"""
    overturning_limit: Annotated[
        float, Quantity(symbol="times the critical rotation", at_least=1)
    ] = 2.0
    """rotation that counts as overturned, over theta_cr"""
    overturning_displacement: Annotated[
        float | None, Quantity("m", symbol="of the cap beam", above=0)
    ] = None
    """displacement of the cap beam that does too, such as a
    moat or the length of a seat"""
    gravity: Annotated[float, Quantity("m/s2", above=0)] = STANDARD_GRAVITY
    """g"""
    accuracy: PositiveRatio = 1.0
    """time steps are 1/accuracy times the default size"""
    max_events: Annotated[int, Whole(1, 1_000_000_000)] = 100_000
    """uplifts, impacts and phase changes after which the analysis gives up"""


class DocumentSection(Section):
    """Who answers for the page of `rps report`, whose options come before these."""

    project: Text | None = None
    """name or number of the project"""
    author: Text | None = None
    """who made the page and signs it"""
    checker: Text | None = None
    """who checks the page and signs it"""
    language: Literal["en", "ru"] = "en"
    """words of the page: en, or ru by a table of terms; numbers and formulas stay"""


class TitledFile(Section):
    """The first keys of all files."""

    rps: Annotated[int, Whole(1, 1, "this program reads version 1 of the format")]
    """version of the format; write `rps: 1`"""
    title: Text | None = None
    """heading of reports and plots"""


class CaseFile(TitledFile):
    """A case of rps: one structure, its ground motion, and how to analyse it."""

    superstructure: SuperstructureSection
    """the building on the cap beam"""
    podium: PodiumSection
    """columns and cap beam"""
    record: RecordSection | None = None
    """the ground motion"""
    analysis: AnalysisSection = AnalysisSection()
    """how to compute"""
    limits: LimitsSection = LimitsSection()
    """exceeding one of them ends with exit code 10"""
    document: DocumentSection = DocumentSection()
    """who answers for the page of `rps report`"""
