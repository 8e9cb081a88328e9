"""Quantities that follow from a case before any analysis, as `rps
check` has them, and formulas.

A formula is written once, as an expression that can be evaluated. Its letters
become symbols in one column and numbers in another, so that a checker can follow
with a pocket calculator.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.report.formulas import formulas, of_column
from rpscli.report.table import Part, Table, shown

if TYPE_CHECKING:
    from rpscli.analyses.column_design import ColumnDemand, ColumnInstant
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.model.podium import Array, PodiumStructure
    from rpscli.model.statics import StoreyStrength
    from rpscli.model.superstructure import Superstructure


class Derived(NamedTuple):
    """One quantity: its name in JSON, words, symbol, SI unit, and
    where a structure has it.
    """

    name: str
    label: str
    symbol: str
    unit: str
    of: str | Callable[[PodiumStructure], Any] = ""

    def value(self, structure: PodiumStructure) -> Any:
        """Of a structure: the attribute of the name where nothing else is said."""
        if callable(self.of):
            return self.of(structure)
        return attrgetter(self.of or self.name)(structure)


GEOMETRY = (
    Derived("semi_diagonal", "semi-diagonal", "R", "m", "bearing.semi_diagonal"),
    Derived("column_height", "column height", "2H", "m", lambda s: 2.0 * s.bearing.half_height),
    Derived("flat_width", "width of the flat part", "2B", "m", lambda s: 2 * s.bearing.half_width),
    Derived("arc_radius", "radius of the arcs", "r", "m", "bearing.radius"),
    Derived("alpha", "slenderness angle", "alpha", "rad", "bearing.alpha"),
    Derived("alpha_wedge", "slenderness angle of the wedge", "alpha'", "rad",
            "bearing.alpha_wedge"),
    Derived("beta", "rolling ends at", "beta", "rad", "bearing.beta"),
    Derived("curvature_ratio", "curvature ratio", "rho", "-", "bearing.curvature_ratio"),
    Derived("rho_cr_paper", "critical curvature ratio, first order", "rho_cr", "-",
            "bearing.critical_curvature_ratio_of_paper"),
    Derived("rho_cr_exact", "critical curvature ratio, exact", "rho_cr", "-",
            "bearing.critical_curvature_ratio"),
    Derived("critical_rotation", "critical rotation", "theta_cr", "rad"),
    Derived("critical_rotation_paper", "critical rotation, first order", "theta_cr", "rad",
            "bearing.critical_rotation_of_paper"),
    Derived("overturns", "overturning", "", "-",
            lambda s: "rolling" if s.bearing.overturns_rolling else "rocking"),
)  # fmt: skip
"""Shape of the columns. `rho_cr_paper` is the first-order formula of the paper,
`rho_cr_exact` the curvature ratio at which theta_cr = beta (Theory (1.14))."""

DYNAMICS = (
    Derived("columns_mass", "all columns", "N m_c", "kg"),
    Derived("cap_beam_mass", "cap beam", "m_b", "kg"),
    Derived("superstructure_mass", "superstructure", "M_tot", "kg"),
    Derived("gamma", "cap beam over columns", "gamma", "-"),
    Derived("eta", "superstructure over cap beam", "eta", "-"),
    Derived("gamma_total", "total mass ratio", "gamma (1 + eta)", "-"),
    Derived("restitution", "restitution at impact", "e", "-"),
    Derived("uplift_acceleration", "uplift acceleration, quasi-static", "g tan(alpha)", "m/s2"),
    Derived("uplift_force", "uplift force at the cap beam", "W tan(alpha)", "N"),
    Derived("static_base_shear", "base shear at uplift", "V_st", "N"),
    Derived("initial_stiffness", "stiffness after uplift, at the cap beam", "", "N/m"),
    Derived("rolling_period", "period of rolling, rigid building", "T", "s"),
    Derived("p_hat", "frequency parameter, rigid estimate", "p_hat", "rad/s",
            "rigid_frequency_parameter"),
)  # fmt: skip
"""Masses and statics."""


def _path_at_critical(structure: PodiumStructure) -> tuple[float, float]:
    """u_b and v_b at theta_cr [m]."""
    import numpy as np  # slow

    _, u, v = structure.path(np.array(structure.critical_rotation))
    return float(u), float(v)


AT_CRITICAL = (
    Derived("critical_displacement", "cap beam displacement at it", "u_b", "m",
            lambda s: _path_at_critical(s)[0]),
    Derived("critical_lift", "lift at it", "v_b", "m", lambda s: _path_at_critical(s)[1]),
)  # fmt: skip
"""Where the weight no longer restores."""

BOTH = (
    Derived("pass_turn", "azimuth change in a pass near upright", "Delta phi", "rad",
            lambda s: None if s.passes_smoothly else s.pass_turn),
    Derived("turning_inertia", "rotational inertia, upright", "K(0)", "-"),
    Derived("contact_time", "contact time of an impact", "t_c", "s",
            lambda s: None if s.passes_smoothly else s.impact_law.contact_time),
)  # fmt: skip
"""Where both horizontal components act."""

CONTACT = (
    Derived(
        "period_ratio", "period in full contact over T1", "r", "-", "bed.period_ratio"
    ),
    Derived("contact_period", "first period in full contact", "T", "s", "bed.period"),
    Derived(
        "contact_stiffness", "stiffness in full contact", "K_s", "N/m", "bed.stiffness"
    ),
    Derived("settlement", "settlement of a joint", "D_0", "m", "bed.settlement"),
    Derived(
        "joint_stiffness",
        "mean stiffness of all joints",
        "W/D_0",
        "N/m",
        "bed.joint_stiffness",
    ),
    Derived("lifts_from", "ends begin to lift at", "phi_u", "rad", "bed.uplift_rotation"),
    Derived(
        "lifts_from_ratio", "over the slenderness angle", "phi_u/alpha", "-", "bed.ratio"
    ),
    Derived("contact_mass", "columns and cap beam at u_b", "m_0", "kg", "bed.mass"),
    Derived("contact_share", "contact length at 0.1 alpha", "", "-", "bed.contact_share"),
)
"""Of compliant ends."""


def _steps_for_springs(structure: PodiumStructure) -> float:
    """Steps of floors on springs over those of floors that ride on the beam."""
    from rpscli.analyses.kernels.systems import steps_a_second  # numpy is slow
    from rpscli.model.impact import ImpactLaw

    above = structure.superstructure
    assert above is not None, "floors on springs are floors"
    # Riding on the beam a heavy building may leave no restitution, which steps do not ask
    # for.
    above = replace(above, vertical_period=None)
    law = ImpactLaw(loss=0.0)
    riding = replace(structure, superstructure=above, impact_law=law)
    return steps_a_second(structure) / steps_a_second(riding)


def _first_sag(structure: PodiumStructure) -> float | None:
    """Shortening of the first of the vertical springs under the floors' weight [m]."""
    above = structure.superstructure
    if above is None or above.upwards is None:
        return None
    return float(above.mass * structure.gravity / above.upwards.stiffnesses[0])


UPWARDS = (
    Derived("vertical_period", "vertical period", "T_v", "s", "superstructure.vertical_period"),
    Derived("first_sag", "sag of the first floor", "M_tot g/k_v", "m", _first_sag),
    Derived("steps_ratio", "steps, over those without springs", "", "-", _steps_for_springs),
)  # fmt: skip
"""Of floors on vertical springs."""


def _column_at_rest(structure: PodiumStructure) -> dict[str, float]:
    """One column under the weight at rest, tilted to a tenth of alpha, by letters."""
    b = structure.bearing
    x = 0.1 * structure.bearing.alpha
    N = structure.rest_force
    y = min(x, b.beta)
    r = b.radius
    turned = math.sin(x) + math.sin(y) * math.cos(x) - math.cos(y) * math.sin(x)
    moment = N * (b.half_width * math.cos(x) + r * turned)
    return {"N_0": N, "x": x, "y": y, "moment": moment, **_ends(structure, x, N)}


def _ends(structure: PodiumStructure, x: float, N: float) -> dict[str, float]:
    """Pressure on arcs at a tilt [rad] and the edge under N of
    a column [N], by letters.
    """
    import numpy as np  # slow

    b = structure.bearing
    design = structure.column
    assert design is not None, "there is a column"
    found = {
        "L": design.line(b) or math.nan, "E_c": design.contact_modulus,
        "strength": design.contact_strength, "wide": 2.0 * b.end_half_width,
    }  # fmt: skip
    found["crushed"] = design.crushed(b, N)[0] / found["wide"]
    found["p_c"] = math.acos(max(1.0 - 2.0 * found["crushed"], -1.0))
    if x < b.beta:
        pressed = design.pressed(b, np.array(x), np.array(N))
        found |= zip(("pressure", "a_c", "b_c"), map(float, pressed), strict=True)
    return found


def _at_rest(letter: str) -> Callable[[PodiumStructure], float | None]:
    return lambda structure: _column_at_rest(structure).get(letter)


COLUMN = (
    Derived("column_rest_force", "weight on a column", "N_0", "N", _at_rest("N_0")),
    Derived(
        "column_rest_moment",
        "moment of a column at 0.1 alpha",
        "M_end",
        "N m",
        _at_rest("moment"),
    ),
    Derived(
        "contact_rest_pressure",
        "pressure on its arcs there",
        "p_0",
        "Pa",
        _at_rest("pressure"),
    ),
    Derived(
        "crushed_rest_ratio",
        "crushed width at its edge",
        "b_c/2B'",
        "-",
        _at_rest("crushed"),
    ),
)
"""Of `podium.column`."""

NEVER_LIFTS = {
    "restitution": "", "uplift_acceleration": "", "uplift_force": "", "static_base_shear": "",
    "column_rest_moment": "", "initial_stiffness": "stiffness of rolling, at the cap beam",
    "contact_rest_pressure": "pressure under its arcs upright",
}  # fmt: skip
"""Words of ends without a flat part, which roll from rest; empty for what they lack."""


def label_of(row: Derived, found: Mapping[str, Any]) -> str:
    """Words for a quantity beside all of them, which say how arcs touch; empty if a column
    without a flat part has none.
    """
    label = row.label if found["flat_width"] else NEVER_LIFTS.get(row.name, row.label)
    contact = found.get("contact_of_arcs")
    if row.name == "contact_rest_pressure" and contact:
        from rpscli.model.column import ArcContact  # numpy is slow

        return f"{label}: {ArcContact(**contact)}"
    return label


def _contact_of_arcs(structure: PodiumStructure) -> dict[str, Any] | None:
    """Contact of the arcs of a column at rest; None of flat ends."""
    b = structure.bearing
    design = structure.column
    x = 0.1 * b.alpha
    return asdict(design.contact(b, x)) if design and x < b.beta else None


FIRST_PERIOD = Derived("T1", "first period on a fixed base", "T1", "s",
    lambda s: float(s.superstructure.periods[0]) if s.superstructure else None)  # fmt: skip


def derived_quantities(structure: PodiumStructure) -> dict[str, Any]:
    """All of them under their names; lists by mode or storey are
    empty without a building.
    """
    building = structure.superstructure
    lists = ("periods", "damping_ratios", "stiffnesses")
    some = (
        (CONTACT, structure.bed),
        (UPWARDS, structure.upwards),
        (COLUMN, structure.column),
    )
    further = [row for rows, has in some if has for row in rows]
    return {
        **{
            row.name: row.value(structure)
            for row in (*GEOMETRY, *AT_CRITICAL, *DYNAMICS, *BOTH)
        },
        "storeys": structure.storeys,
        **{row.name: row.value(structure) for row in (FIRST_PERIOD, *further)},
        **({"contact_of_arcs": _contact_of_arcs(structure)} if structure.column else {}),
        **{name: getattr(building, name) if building else [] for name in lists},
    }


DIGITS = 6

SYMBOLS = {
    "alpha": "α", "alpha_w": "α′", "beta": "β", "rho": "ρ", "gamma": "γ", "eta": "η", "kappa": "κ",
    "theta_cr": "θ_cr", "tan_alpha": "tan α", "tan_alpha_w": "tan α′", "rho_cr": "ρ_cr",
    "height": "2H", "width": "2B", "radius": "r", "m_column": "m_c", "m_c": "N m_c", "M": "M_tot",
    "gamma_t": "γ(1 + η)", "pi": "π", "sum_m": "Σ m_i φ_i²", "sum_k": "Σ k_i (φ_i − φ_i₋₁)²",
    "E_c": "E*", "strength": "f", "wide": "2B′", "a_c": "a", "b_c": "b", "p_c": "p",
    "N_1": "N", "F_1": "F", "phi_u": "φ_u", "sum_M": "Σ M_i / (1 − (ω/ω_i)²)",
}  # fmt: skip
"""Letters that are written otherwise than in an expression."""

FUNCTIONS = ("sin", "cos", "tan", "asin", "atan", "sqrt")


class Derivation(NamedTuple):
    """One quantity: words, symbol, value, unit, formula, empty for
    inputs, and it with numbers.
    """

    name: str
    label: str
    symbol: str
    value: float
    unit: str
    formula: str
    numbers: str


BEFORE = {
    "restitution": (
        Derived("inertia_ratio", "I_o / (m_c R²) of a column", "I", "-", "bearing.inertia_ratio"),
        Derived("e_edge", "restitution, impulse at the edges", "e_edge", "-",
                lambda s: _letters(s).get("e_edge")),
    ),
    "uplift_force": (Derived("weight", "weight that is lifted", "W", "N"),),
}  # fmt: skip
"""What is no result of its own, but stands in the next formula."""


def derivations(
    structure: PodiumStructure, podium: Mapping[str, Any]
) -> Iterator[Derivation]:
    """All derived quantities that are numbers, in the order in which they follow."""
    letters = _letters(structure)
    crushed = _column_at_rest(structure)["crushed"] if structure.column else 0.0
    expressions = formulas(structure, podium, crushed)
    further = (*CONTACT * bool(structure.bed), *COLUMN * bool(structure.column))
    exact = f"{structure.critical_rotation:.{DIGITS}g}"
    contact = _contact_of_arcs(structure)
    shape = {"flat_width": structure.bearing.half_width, "contact_of_arcs": contact}
    for quantity in (*GEOMETRY, *DYNAMICS, FIRST_PERIOD, *further):
        for row in (*BEFORE.get(quantity.name, ()), quantity):
            value = row.value(structure)
            formula = expressions.get(row.name, "")
            label = label_of(row, shape)
            if not isinstance(value, float | int) or not label:
                continue
            if row.name == "critical_rotation_paper" and f"{value:.{DIGITS}g}" == exact:
                continue
            texts = symbolic(formula), numeric(formula, letters)
            symbol = greek(row.symbol)
            yield Derivation(row.name, label, symbol, float(value), row.unit, *texts)


class _Step(NamedTuple):
    """A number of an instant of a column: words, symbol, value, unit and formula."""

    label: str
    symbol: str
    value: float
    unit: str
    formula: str


def column_derivations(result: TimeHistoryResult) -> Iterator[Derivation]:
    """Largest moment, pressure and edge of the most loaded column of a history."""
    structure = result.structure
    demand = result.column_demand
    assert demand is not None, "there is a column"
    for each in demand.instants:
        x = abs(each.rotation)
        N = each.axial_force
        letters = _letters(structure) | _ends(structure, x, N) | {"x": x, "N_1": N}
        if each.largest == "column_moment":
            letters |= _moment_letters(demand, each) | {"columns": structure.columns}
            steps = _moment_steps(each, letters, demand.corner)
        else:
            steps = _end_steps(structure, each, letters["crushed"])
        for label, symbol, value, unit, formula in steps:
            own = formula.replace("N_0", "N_1")
            texts = symbolic(own), numeric(own, letters)
            yield Derivation(each.largest, label, greek(symbol), value, unit, *texts)


def _moment_letters(demand: ColumnDemand, at: ColumnInstant) -> dict[str, float]:
    """Numbers for the letters of the largest moment."""
    side = demand.at_largest_moment.side
    rise = demand.at_largest_moment.rise
    x = abs(at.rotation)
    N = at.axial_force
    F = side * at.shear
    P = N * math.cos(x) + F * math.sin(x)
    Q = F * math.cos(x) - N * math.sin(x)
    letters = {"s": side, "F_1": at.shear, "d": rise, "P": P, "Q": Q}
    letters |= {
        "e": (at.moment / demand.corner + rise * Q) / P,
        "N_mean": demand.mean_force,
    }
    for way, (moment, lever) in zip("xy", demand.moments, strict=False):
        letters |= {f"M_{way}": abs(moment), f"l_{way}": lever}
    return letters


def _moment_steps(
    at: ColumnInstant, letters: Mapping[str, float], corner: float
) -> list[_Step]:
    """Forces at an end when its moment is largest, and the moment
    that they give, about a `corner` of square columns.
    """
    moment = "e * P - d * Q"
    moment = f"sqrt(2) * ({moment})" if corner > 1.0 else moment
    ways = [way for way in "xy" if f"M_{way}" in letters]
    carried = "N_mean" + "".join(f" + M_{way} / (columns * l_{way})" for way in ways)
    axial = "N_1 * cos(x) + s * F_1 * sin(x)"
    shear = "s * F_1 * cos(x) - N_1 * sin(x)"
    return [
        _Step("axial force, by moments of the podium", "N", at.axial_force, "N", carried),
        _Step("axial force at its end", "P", letters["P"], "N", axial),
        _Step("shear at its end", "Q", letters["Q"], "N", shear),
        _Step("largest moment", "M", at.moment, "N m", moment),
    ]


def _end_steps(
    structure: PodiumStructure, at: ColumnInstant, crushed: float
) -> list[_Step]:
    """The largest pressure on an arc, or the largest crushed width at an edge."""
    pressure = at.contact_pressure
    if at.largest == "contact_pressure_ratio" and pressure is not None:
        formula = of_column(structure, 0.0)["contact_rest_pressure"]
        words = f"largest pressure on arcs: {at.contact}"
        return [_Step(words, "p_0", pressure, "Pa", formula)]
    if at.largest == "crushed_width_ratio":
        formula = of_column(structure, crushed)["crushed_rest_ratio"]
        return [_Step("largest crushed width", "b_c/2B'", crushed, "-", formula)]
    return []


LETTERS = {
    "R": "bearing.semi_diagonal", "radius": "bearing.radius", "N": "columns",
    "alpha": "bearing.alpha", "tan_alpha": "bearing.slenderness", "alpha_w": "bearing.alpha_wedge",
    "beta": "bearing.beta", "rho": "bearing.curvature_ratio", "I": "bearing.inertia_ratio",
    "rho_cr": "bearing.critical_curvature_ratio", "m_c": "columns_mass", "m_b": "cap_beam_mass",
    "M": "superstructure_mass", "gamma": "gamma", "eta": "eta", "gamma_t": "gamma_total",
    "g": "gravity", "W": "weight", "K": "initial_stiffness", "f": "impact_law.factor",
    "kappa": "impact_law.loss",
}  # fmt: skip
"""Where a structure has the letters of expressions."""


def _letters(structure: PodiumStructure) -> dict[str, float]:
    """Numbers for the letters of all expressions, SI units."""
    b = structure.bearing
    law = structure.impact_law
    building = structure.superstructure
    letters: dict[str, float] = {
        name: attrgetter(of)(structure) for name, of in LETTERS.items()
    }
    letters["height"] = 2.0 * b.half_height
    letters["width"] = 2.0 * b.half_width
    letters["m_column"] = structure.columns_mass / structure.columns
    letters["tan_alpha_w"] = b.slenderness if b.is_flat else b.wedge_slenderness
    if law.kind == "value":
        letters["e_given"] = structure.restitution / law.factor
    else:
        # With all of the loss and no factor, the law gives the restitution at the edges.
        edges = replace(law, factor=1.0, loss=1.0)
        letters["e_edge"] = edges.ratio(b, structure.gamma, structure.eta_riding)
    if (bed := structure.bed) is not None:
        letters |= {
            "phi_u": bed.uplift_rotation, "B_u": bed.lift_arm, "C_u": bed.height, "m_0": bed.mass,
            "K_s": bed.stiffness, "D_0": bed.settlement or math.nan,
        }  # fmt: skip
    if bed is not None and building is not None and bed.period is not None:
        w = 2.0 * math.pi / bed.period
        shaken = building.participation**2 / (1.0 - (w / building.frequencies) ** 2)
        letters |= {"T_c": bed.period, "sum_M": float(shaken.sum())}
        letters["T_1"] = float(building.periods[0])
    if structure.column is not None:
        letters |= _column_at_rest(structure)
    if building is not None:
        shape = first_shape(building)
        k = building.stiffnesses
        letters |= {f"m_{i}": mass for i, mass in enumerate(building.masses.tolist(), 1)}
        letters |= {"n": building.storeys, "m_i": letters["m_1"]}
        letters["sum_m"] = float(building.masses @ shape**2)
        letters["sum_k"] = float(
            k[0] * shape[0] ** 2 + k[1:] @ (shape[1:] - shape[:-1]) ** 2
        )
    return letters


def first_shape(building: Superstructure) -> Array:
    """First mode on a fixed base, (n,), 1 at the roof."""
    shape: Array = building.shapes[:, 0] / building.shapes[-1, 0]
    return shape


def symbolic(expression: str) -> str:
    """An expression with its symbols."""
    text = _LETTER.sub(lambda found: SYMBOLS.get(found[0], found[0]), expression)
    return _printed(text.replace(" * ", " "))


def numeric(expression: str, letters: Mapping[str, float]) -> str:
    """An expression with numbers for its letters."""

    def number(found: re.Match[str]) -> str:
        name = found[0]
        return name if name in FUNCTIONS else f"{letters.get(name, math.pi):.{DIGITS}g}"

    return _printed(_LETTER.sub(number, expression).replace(" * ", " · "))


def greek(text: str) -> str:
    """Letters that are written out, as they are."""
    return _printed(re.sub("alpha|beta|gamma|theta|rho|eta", lambda f: GREEK[f[0]], text))


GREEK = {"alpha": "α", "beta": "β", "gamma": "γ", "eta": "η", "rho": "ρ", "theta": "θ"}


def _printed(text: str) -> str:
    text = text.replace("'", "′").replace("^2", "²").replace("^3", "³")
    return text.replace("sqrt", "√").replace(" - ", " − ").replace("-W", "−W")


_LETTER = re.compile(r"[A-Za-z_]\w*")


UPPER = (
    "strengths follow the shears of the first mode on a fixed base, so upper storeys"
    " yield most: modes of uplifted columns are stiffer, and load upper storeys more"
    " than that mode does"
)


def strengths_by_way(structure: PodiumStructure) -> dict[str, list[StoreyStrength]]:
    """Strengths of the storeys from the bottom, in y too if that differs; of those ways
    in which storeys yield.
    """
    from rpscli.model.statics import storey_strengths  # numpy is slow

    found = {way: storey_strengths(seen) for way, seen in structure.ways.items()}
    return {way: strengths for way, strengths in found.items() if strengths}


def strength_tables(structure: PodiumStructure) -> Iterator[Part]:
    """Strength of each storey beside its shear at uplift, the roof on
    top; in y if that differs.
    """
    first, begins = "lift", "uplift"
    if structure.bearing.is_spherical:
        first, begins = "roll", "rolling"
    heads = (
        "strength kN",
        "of V_st",
        f"shear at {begins} kN",
        "under slow ground motion",
    )
    for way, strengths in strengths_by_way(structure).items():
        rows = [
            (
                str(storey),
                shown(1e-3 * each.strength),
                "" if each.strength_ratio is None else shown(each.strength_ratio),
                shown(1e-3 * each.shear_at_uplift),
                f"columns {first} first"
                if each.uplift_first
                else f"yields BEFORE {begins}",
                shown(1e3 * each.yield_drift),
            )
            for storey, each in enumerate(strengths, 1)
        ]
        storey = f"storey{way.replace('_', ', in ')}"
        yield Table.of_texts((storey, *heads, "drift at yield mm"), rows[::-1])
    building = structure.superstructure
    if building is not None and building.yields_by_first_mode:
        yield f"{UPPER} (one history of six storeys: ductility 1.8 of the first, 6.7 of the last)"


def twist_texts(structure: PodiumStructure) -> Iterator[str]:
    """Twist of the storeys on the slab, which modes and statics of its centre leave out."""
    twist = structure.twist
    above = structure.superstructure
    if twist is None:
        return
    yield "The slab turns in time histories alone: not in these modes and forces."
    if above is None:
        return
    lengths = (max(rows) - min(rows) for rows in (structure.rows, structure.rows_y))
    e_x, e_y = (
        part * length for part, length in zip(twist.eccentricity, lengths, strict=True)
    )
    period = float(above.periods[0]) / twist.period_ratio
    yield (
        f"Storeys twist on it with a first period of {shown(period)} s, not coupled"
        f" (superstructure.torsion.period_ratio {twist.period_ratio:g}); their centres of"
        f" stiffness stand {shown(e_x)} m in x and {shown(e_y)} m in y from those of mass."
    )
