"""The table of results: each quantity's name, unit, label and symbol,
and what it is used for.

A quantity has its value in the attribute of its name: those of modes in
`FixedBaseModes` and `UpliftedModes`, those of the static curves in `PushoverResult` and
`StoreyCurve`. Those of histories are a field of the kernel's record, which `kernel`
names, or an attribute of `Histories`, for many of them at once; `Demand` has the same
for one. JSON documents, headers of CSV files, stores of studies, tables for the
terminal, limits, reports and figures all read this table, which imports no
model, so that the schema of a case can.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.analyses.needs import NEEDS

if TYPE_CHECKING:
    from rpscli.model.podium import PodiumStructure


class ResultQuantity(NamedTuple):
    """One quantity that an analysis finds."""

    name: str  # in the Python interface, JSON and CSV
    unit: (
        str  # SI; ``-`` for a plain number, nothing for one that needs no unit on an axis
    )
    label: str  # in words, for tables and figures
    symbol: str = ""  # the paper's letters as a formula for figures, where there are any
    # An example of a limit; empty where none makes sense. What has one may be limited in
    # a case, a study, a fragility and by `--fail-on`.
    limit: str = ""
    demand: bool = (
        False  # one of the main demands, which tables of studies show in the terminal
    )
    whole: bool = False  # a count
    needs: str = ""  # what a structure must have to have it, one of `NEEDS`
    meaning: str = ""  # what a ratio is made of, for the schemas of limits
    from_below: bool = (
        False  # small values are bad: a limit is the least that is admissible
    )
    column: str = ""  # its head in a table of storeys, where that is not the name
    kernel: str = (
        ""  # the field of `physics.interface.RESULT` that holds it; empty where computed
    )

    @property
    def described(self) -> str:
        """Label, unit, what a ratio is made of, and what a structure without it lacks."""
        meaning = f": {self.meaning}" if self.meaning else ""
        none = f"; None without {self.needed}" if self.needs else ""
        return f"{self.label} [{self.unit}]{meaning}{none}"

    @property
    def needed(self) -> str:
        """Words for what a structure must have to have it; empty if all have it."""
        return NEEDS[self.needs].words if self.needs else ""

    def lacks(self, structure: PodiumStructure) -> str:
        """Words for what a structure lacks to have it; empty if it has it."""
        lacking = self.needs and not NEEDS[self.needs].met_by(structure)
        return self.needed if lacking else ""

    @property
    def axis_label(self) -> str:
        """Symbol or words, with the unit, for the axis of a figure."""
        return self.in_unit(self.unit, self.symbol)

    def in_unit(self, unit: str, symbol: str = "") -> str:
        """The label of an axis in another unit."""
        words = symbol or self.label
        return f"{words} [{unit.replace('/s2', '/s²')}]" if unit else words


_Q = ResultQuantity


def values_of(result: object, quantities: Iterable[ResultQuantity]) -> dict[str, Any]:
    """Values of quantities by name: numbers, lists of them, and
    None for what is not finite.
    """
    return {
        quantity.name: plain(getattr(result, quantity.name)) for quantity in quantities
    }


def plain(value: Any) -> Any:
    """A value as JSON knows it: arrays as lists, complex numbers
    as [re, im], NaN as null.
    """
    if type(value) is not float and hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None  # no -0.0
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    return value


HISTORY = (
    _Q("max_rotation", "rad", "largest rotation", r"$|\theta_{max}|$", limit="0.1",
        kernel="max_theta"),
    _Q("max_rotation_time", "s", "time of largest rotation"),
    _Q("rotation_ratio", "-", "rotation ratio", r"$|\theta_{max}|/\theta_{cr}$", limit="0.5",
        demand=True, meaning="largest rotation over critical rotation"),
    _Q("critical_rotation", "rad", "critical rotation", r"$\theta_{cr}$"),
    _Q("critical_passage_time", "s", "critical rotation passed at"),
    _Q("max_cap_beam_displacement", "m", "cap beam displacement", limit="0.3", demand=True),
    _Q("max_lift", "m", "lift of the building", "$v_b$", limit="0.03", demand=True,
        meaning="largest rise of the cap beam above its place at rest"),
    _Q("max_base_shear", "N", "base shear", "$V_b$", limit="2e6", demand=True),
    _Q("base_shear_ratio", "-", "base shear ratio", "$V_b/V_{st}$", limit="2", demand=True,
        needs=(
            "superstructure,"
            " flat part"
        ), meaning="largest base shear over M_tot g tan(alpha)"),
    _Q("uplift_shear_ratio", "-", "base shear over uplift with devices", limit="2",
        needs="superstructure, devices",
        meaning="largest base shear over that at uplift, V_st with what devices add"),
    _Q("drift_ratio", "-", "drift ratio", limit="0.005", demand=True,
        needs="superstructure.storey_height",
        meaning=(
            "largest storey drift over storey height; of pairs a bound, where storeys"
            " yield or differ in x and y"
        )),
    _Q("max_floor_acceleration", "m/s2", "floor acceleration", limit="5", demand=True,
        needs="superstructure"),
    _Q("residual_rotation", "rad", "residual rotation", limit="0.001"),
    _Q("residual_displacement", "m", "residual displacement", limit="0.01"),
    _Q("max_damper_force", "N", "damper force", limit="4e5", needs="damper",
        meaning="largest of any one damper; of one at several places that of all of them"),
    _Q("max_stop_force", "N", "stop force", limit="1e6", needs="stop",
        meaning="largest of any one stop"),
    _Q("lost_prestress", "-", "lost prestress", limit="0.1", needs="tendon",
        meaning="share that a tendon has lost"),
    _Q("uplifts", "-", "uplifts", limit="2", whole=True),
    _Q("impacts", "-", "impacts", limit="50", whole=True),
    _Q("reentries", "-", "returns to full contact", limit="50", whole=True, needs="contact"),
    _Q("full_contact_share", "-", "share of time in full contact", limit="0.5", needs="contact",
        from_below=True),
    _Q("max_impact_number", "-", "impact number", r"$\chi$", limit="8", needs="contact",
        meaning="largest |theta'| sqrt(2 B/(g phi_u)) of returns to full contact"),
    _Q("edge_pressure_ratio", "-", "edge pressure ratio", limit="10", needs="plane contact",
        meaning="largest pressure at an edge over the mean under permanent load"),
    _Q("duration", "s", "duration", kernel="time"),
    _Q("friction_demand", "-", "friction demand |F|/N", limit="0.3", demand=True,
        meaning=(
            "largest shear over axial force of columns; of pairs without the shortest"
            " passes near upright, as the output says"
        )),
    _Q("friction_ratio", "-", "friction ratio", limit="1", needs="podium.friction",
        meaning="friction demand over podium.friction; columns slide above 1"),
)  # fmt: skip
"""Scalars of a time history."""

YIELDING = (
    _Q("ductility", "-", "ductility", limit="3", demand=True, needs="superstructure.yield",
        meaning="largest drift of a storey over its drift at yield"),
    _Q("plastic_drift", "m", "plastic drift", limit="0.01", needs="superstructure.yield",
        meaning="largest range of the plastic drift of a storey, in x or in y"),
    _Q("residual_drift", "m", "residual drift", limit="0.005", needs="superstructure.yield",
        meaning="largest plastic drift at the end, of both components together"),
    _Q("residual_drift_ratio", "-", "residual drift ratio", limit="0.005", demand=True,
        needs=(
            "superstructure.yield,"
            " storey_height"
        ), meaning="residual drift over storey height"),
    _Q("energy_yielded", "J", "energy yielded", needs="superstructure.yield"),
)  # fmt: skip
"""Scalars of a time history of storeys that yield; elastic buildings do not list them."""

SAMPLED = (
    _Q("max_roof_displacement", "m", "roof displacement", limit="0.5", needs="superstructure"),
    _Q("max_floor_velocity", "m/s", "floor velocity", limit="1", needs="superstructure"),
    _Q("base_shear_with_dashpots", "N", "base shear with dashpots", limit="2e6",
        needs="superstructure",
        meaning="largest force of the floors' inertia: base shear is that of springs alone"),
    _Q("fixed_base_ratio", "-", "base shear over fixed base", r"$V_b/V_{b,fixed}$", limit="0.5",
        demand=True, needs="superstructure",
        meaning="largest base shear over that of the fixed base"),
    _Q("floor_acceleration_over_fixed", "-", "floor acceleration over fixed base", limit="1",
        demand=True, needs="superstructure",
        meaning="largest floor acceleration over that of the fixed base"),
    _Q("max_column_shear", "N", "shear of a column", limit="2e5", needs="rows of columns",
        meaning=(
            "largest of the most loaded column with podium.plan and podium.columns, else"
            " the mean of all columns, which cannot be a limit"
        )),
    _Q("max_column_force", "N", "axial force of a column", limit="2e6", needs="columns"),
    _Q("min_column_force", "N", "minimum axial force of a column", limit="1e4", from_below=True,
        needs="columns"),
    _Q("overturning_ratio", "-", "overturning ratio, of floors' inertia",
        meaning=(
            "what it adds to the mean force of an outer column; its forces hold the"
            " shift of contacts and drifts too"
        )),
    _Q("column_moment", "N m", "moment at an end of a column", "$M_{end}$", limit="2e5",
        needs="designed columns"),
    _Q("contact_pressure_ratio", "-", "contact pressure ratio", "$p_0/f$", limit="1",
        needs="columns on arcs",
        meaning="largest elastic pressure on arcs over podium.column.contact_strength"),
    _Q("crushed_width_ratio", "-", "crushed width ratio", limit="0.15", needs="designed columns",
        meaning="largest depth of a plastic edge over the width of the end"),
    _Q("sliding_time", "s", "columns slide at", needs="podium.friction"),
    _Q("max_twist", "rad", "twist about the vertical", r"$\psi$", limit="0.02", needs="twist"),
    _Q("residual_twist", "rad", "residual twist", limit="0.002", needs="twist"),
    _Q("max_corner_displacement", "m", "displacement of a column", limit="0.3", needs="twist",
        demand=True, meaning=(
            "of the head of the column that moves most, or of the cap beam without a turn if"
            " that is larger"
        )),
    _Q("corner_factor", "-", "corner factor", limit="1.5", needs="twist", demand=True,
        meaning="largest displacement of a column over that of the slab's centre, both turning"),
    _Q("max_column_rotation", "rad", "rotation of a column", limit="0.1", needs="twist",
        meaning="of the one that tilts most, where the slab turns"),
    _Q("column_rotation_ratio", "-", "rotation ratio of a column", limit="0.5", needs="twist",
        meaning="largest rotation of a column over its own critical one, where the slab turns"),
)  # fmt: skip
"""Scalars of a history that is followed with all its samples: a single one, or those of a
study with `whole_histories: true`."""

IMPACTS = (
    _Q("energy_devices", "J", "energy dissipated in devices"),
    _Q("energy_impact", "J", "energy lost at impacts", kernel="energy_lost"),
    _Q("energy_created", "J", "energy created at impacts", kernel="energy_created"),
    _Q("creating_impacts", "-", "impacts that created energy", whole=True,
        kernel="creating_impacts"),
)  # fmt: skip
"""Effects of the impacts of a history, in the table of a study."""

PAIR = (
    _Q("max_rotation_azimuth", "rad", "azimuth of the largest rotation"),
    _Q("critical_azimuth", "rad", "azimuth where the critical rotation was passed"),
    _Q("residual_azimuth", "rad", "azimuth of the residual rotation"),
    *(
        _Q(f"{name}_{way}", unit, f"{label} in {way}")
        for name, unit, label in (
            ("max_cap_beam_displacement", "m", "cap beam displacement"),
            ("max_base_shear", "N", "base shear"),
            ("max_floor_acceleration", "m/s2", "floor acceleration"),
        )
        for way in "xy"
    ),
    _Q("passes", "-", "passes near upright", whole=True),
    _Q("passes_as_impacts", "-", "passes that lose like an impact", whole=True,
        kernel="passes_as_impacts", meaning="more than half of what an impact would lose"),
    _Q("accumulations", "-", "accumulations of passes", whole=True, kernel="accumulations",
        meaning="begun anew as uplifts, in a direction that no program resolves"),
    _Q("closest_pass", "-", "closest pass", meaning="least theta_min over alpha"),
    _Q("shortest_pass", "s", "shortest pass", meaning="least theta_min/|theta phi'|"),
    _Q("energy_passes", "J", "energy lost in passes", kernel="energy_passes"),
    _Q("torsion_lever", "m", "torsion in a contact over its weight", kernel="torsion_lever",
        meaning="which friction in the contacts must resist to keep columns in place"),
)  # fmt: skip
"""Results of a history under both horizontal components; its other results are those of
resultants, largest sqrt(x^2 + y^2)."""

KERNEL_FIELDS = {q.name: q.kernel for q in (*HISTORY, *IMPACTS, *PAIR) if q.kernel}

_WHICH = "of the scaled motion; in a study of pairs as `scale: of` says"
INTENSITIES = (
    _Q("pga", "m/s2", "PGA", meaning=_WHICH),
    _Q("pgv", "m/s", "PGV", meaning=_WHICH),
)
"""Peaks of the scaled motion of a history, in the table of a study."""

STOREY_SHEARS = _Q("storey_shears", "N", "storey shear", "$V_i$", column="max_shear")
STOREY_DRIFTS = _Q("storey_drifts", "m", "storey drift", column="max_drift")
STOREY_DRIFT_RATIOS = _Q(
    "storey_drift_ratios", "-", "storey drift ratio", column="drift_ratio"
)
FLOOR_ACCELERATIONS = _Q(
    "floor_accelerations", "m/s2", "floor acceleration", column="floor_acceleration"
)
FLOOR_VELOCITIES = _Q(
    "floor_velocities", "m/s", "floor velocity", column="floor_velocity"
)

STOREYS_YIELDING = (
    _Q("ductilities", "-", "ductility", column="ductility"),
    _Q("plastic_drifts", "m", "range of the plastic drift", column="plastic_drift"),
    _Q("residual_drifts", "m", "residual drift", column="residual_drift"),
    _Q("energies_yielded", "J", "energy yielded", column="energy_yielded"),
    _Q("first_yields", "s", "first yields at", column="first_yield"),
)
"""What yielding does to each storey from the bottom."""

STOREYS = (
    STOREY_DRIFTS,
    STOREY_DRIFT_RATIOS,
    STOREY_SHEARS,
    FLOOR_ACCELERATIONS,
    FLOOR_VELOCITIES,
)
"""Largest values in each storey from the bottom, on bearings and on a fixed base."""

LIMITED = tuple(
    quantity for quantity in (*HISTORY, *YIELDING, *SAMPLED) if quantity.limit
)
"""Results that limits, `--fail-on` and fragilities may name."""

DEMANDS = tuple(quantity for quantity in LIMITED if not quantity.from_below)
"""Those that are the worse the larger they are, as an axis of demands needs them."""

_FREQUENCIES = _Q("frequencies", "rad/s", "frequency", r"$\omega$")
_DAMPING = _Q("damping", "-", "damping", r"$\xi$")
_SHAPES = _Q("shapes", "-", "mode shape")

FIXED_BASE_MODES = (_FREQUENCIES, _Q("periods", "s", "period", "$T$"), _DAMPING)
"""Lists by mode in full contact."""

ORDER = "exact where the state begins; under first_order the paper's, for small alpha"
UNDAMPED = f"undamped, without dampers; {ORDER}"

UPLIFTED_MODES = (_FREQUENCIES, _DAMPING)
"""Lists by vibration mode of a linearised uplifted state."""

UPLIFTED_RATIOS = (
    _Q("frequency_ratio", "-", "frequency ratio", r"$\omega_u/\omega_0$", meaning=ORDER),
    _Q("damping_ratio", "-", "damping ratio", r"$\xi_u/\xi_0$", meaning=ORDER),
)
"""Lists by vibration mode, over those of the fixed base."""

FREQUENCY_PARAMETERS = (
    _Q(
        "frequency_parameter",
        "rad/s",
        "frequency parameter",
        "$p_{ext}$",
        meaning=UNDAMPED,
    ),
    _Q(
        "frequency_parameter_rigid",
        "rad/s",
        "rigid estimate",
        r"$\hat{p}_{ext}$",
        meaning=ORDER,
    ),
)
"""Of the podium's own mode."""

LINEAR = (*UPLIFTED_MODES, *UPLIFTED_RATIOS, *FREQUENCY_PARAMETERS)
"""Results of both orders, the exact one and the paper's."""

OWN_MOTION = (
    _Q("own_motion", "", "the podium's own mode"),
    _Q("own_period", "s", "its period, if it oscillates", "$T$"),
    _Q("own_damping", "-", "its damping ratio, if it oscillates", r"$\xi$"),
    _Q("own_growth_time", "s", "time of e-fold growth, if it diverges"),
)
"""The podium's own mode in words and times."""

EIGENVALUES = _Q("eigenvalues", "1/s", "eigenvalue", r"$\lambda$")

UPLIFTED = (
    *LINEAR,
    _Q("linearised_at", "rad", "rotation about which modes are linearised"),
    *OWN_MOTION,
    EIGENVALUES,
)
"""All results of an uplifted state besides its shapes."""

FIXED_BASE_SHAPES = (_SHAPES,)
VERTICAL_MODES = (
    _Q("vertical_frequencies", "rad/s", "vertical frequency", r"$\omega_v$"),
    _Q("vertical_damping", "-", "vertical damping", r"$\xi_v$"),
)
"""Lists by mode of the vertical springs, uplifted; nothing without them."""

UPLIFTED_SHAPES = (_SHAPES, _Q("elastic_shapes", "-", "elastic mode shape"))
LEVEL = _Q("floor", "", "level (0 = cap beam)")
"""Levels over which shapes are drawn."""

OF_CHECK = "with devices; `rps check` gives that of the weight on rigid ends by this name"
FORCE = f"of compliant ends where they begin to lift, {OF_CHECK}"
STIFFNESS = f"of compliant ends in full contact, {OF_CHECK}"
PUSHOVER = (
    _Q("uplift_force", "N", "uplift force", meaning=FORCE),
    _Q("critical_rotation", "rad", "critical rotation", r"$\theta_{cr}$"),
    _Q("critical_displacement", "m", "critical displacement"),
    _Q("initial_stiffness", "N/m", "stiffness after uplift", meaning=STIFFNESS),
)
"""Scalars of the static curves."""

STOREY_CURVE = (
    _Q("rotation", "rad", "rotation", r"$\theta$"),
    _Q("displacement", "m", "cap beam displacement", "$u_b$"),
    _Q("force", "N", "force at the cap beam"),
    _Q("lift", "m", "lift", "$v_b$"),
    _Q("unloading_force", "N", "force on the way back"),
)
"""Lists along the podium's curve."""

STOREY_CURVE_RATIOS = (
    _Q("rotation_ratio", "-", "rotation ratio", r"$\theta/\theta_{cr}$"),
    _Q("force_over_weight", "-", "force over weight", "$F/W$"),
)
"""The podium's curve without units."""

_ALL = [
    quantity
    for value in [*globals().values()]
    for quantity in (value if type(value) is tuple else (value,))
    if isinstance(quantity, ResultQuantity)
]
EVERY = {quantity.name: quantity for quantity in reversed(_ALL)}
"""The whole table by name."""
