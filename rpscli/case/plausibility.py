"""Doubts about a case, possible, but probably not intended: the
number, and what is usual.

Mostly slips of units: millimetres for metres, kilograms for tonnes. The systems
of a study are looked at as a single case is; what is doubted in many of them is
told once, with the range.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rpscli.case.build import each_storey
from rpscli.case.schema.case_file import SuperstructureSection
from rpscli.errors import listed
from rpscli.model.statics import storey_strengths, wind_on
from rpscli.model.twisting import unstable_from

if TYPE_CHECKING:
    from rpscli.model.contact import Bed
    from rpscli.model.podium import PodiumStructure
    from rpscli.model.superstructure import Superstructure
    from rpscli.records.ground_motion import MotionComponents


class Doubt(NamedTuple):
    """Something unusual: a sentence, with ``{0}`` for its number
    and ``{1}`` for a detail.
    """

    sentence: str
    value: float | None = None
    detail: str = ""

    def __str__(self) -> str:
        """The sentence of a warning."""
        number = "" if self.value is None else f"{self.value:.4g}"
        return self.sentence.format(number, self.detail)


def doubts_of_many(systems: Sequence[Iterable[Doubt]]) -> list[str]:
    """Each kind of doubt once, with how many systems raise it and
    the range of its number.
    """
    kinds: dict[str, dict[int, list[float]]] = {}
    for system, doubts in enumerate(systems):
        for sentence, value, _ in doubts:
            values = kinds.setdefault(sentence, {}).setdefault(system, [])
            values += [] if value is None else [value]
    texts = []
    for sentence, raised in kinds.items():
        values = [value for of_system in raised.values() for value in of_system]
        numbers = dict.fromkeys(f"{f(values):.4g}" for f in (min, max) if values)
        texts.append(
            f"{len(raised)} of {len(systems)} systems:"
            f" {sentence.format(' to '.join(numbers), '')}"
        )
    return texts


HOLDS = 1.3
"""Over tan(alpha): columns with less friction may slide in any
record (Theory, section 2)."""

WALKS = 0.25
"""tan(alpha) above which contacts that rebound let the beam walk over
its columns (Theory, 2)."""

LEAST_STRENGTH = 1e5
"""Of material under an end [Pa], a tenth of any mortar: a smaller number has lost its
MPa.
"""

NEIGHBOURS = 20.0
"""No storey is so many times as heavy, or as stiff, as the next one."""

STIFFEST = 1.02
SOFTEST = 0.02
"""Least period ratio and largest phi_u/alpha of compliant ends
for which that is meant."""

STRONGEST = 0.4
"""Hardly a building carries more than this part of its weight
sideways: V_st/(M_tot g)."""

LARGEST_DRIFT = 0.02
"""Hardly a building carries a larger drift over its storey height without damage."""


def doubts_of_structure(structure: PodiumStructure) -> Iterator[Doubt]:
    """Sizes, masses, period, restitution, friction, pressure; storey shears at uplift."""
    yield from _unusual_sizes(structure)
    yield from _unsaid_ends(structure)
    yield from _pressed_arcs(structure)
    yield from _turning_slab(structure)
    yield from _moving_wind(structure)
    bearing = structure.bearing
    building = structure.superstructure
    if (
        structure.friction is not None
        and structure.friction < HOLDS * bearing.slenderness
    ):
        yield Doubt(
            f"podium.friction = {{0}} is below {HOLDS:g} tan(alpha): columns may slide"
            " in any record that lifts them, which the model leaves out",
            structure.friction,
        )
    if structure.bed is not None:
        yield from _unusual_bed(structure.bed)
    if building is None:
        return
    if bearing.slenderness > WALKS:
        yield Doubt(
            f"tan(alpha) = {{0}} is above {WALKS:g}: contacts that rebound, which the"
            " model leaves out, let the cap beam walk over its columns",
            bearing.slenderness,
        )
    yield from _weak_storeys(structure)
    if bearing.slenderness > STRONGEST:
        yield Doubt(
            "the base shear at uplift V_st is {0} of the building's weight, above the"
            f" {STRONGEST:g} that any usual building carries: it would be damaged before"
            " it lifts; more slender columns lift earlier",
            bearing.slenderness,
        )
    yield from _soft_storey(building, structure.uplift_acceleration)


def _unusual_bed(bed: Bed) -> Iterator[Doubt]:
    """Compliant ends that are nearly rigid, or so soft that they settle."""
    if (bed.period_ratio or STIFFEST) < STIFFEST:
        yield Doubt(
            "podium.contact: the period in full contact is {0} of the fixed base,"
            f" below {STIFFEST:g}: short steps and no effect; use kind: rigid",
            bed.period_ratio,
        )
    if bed.ratio > SOFTEST:
        yield Doubt(
            f"podium.contact: ends lift at {{0}} alpha only, above {SOFTEST:g}: the"
            " settlement is no longer small compared with the width of the joint",
            bed.ratio,
        )


def _soft_storey(building: Superstructure, uplift_acceleration: float) -> Iterator[Doubt]:
    """The storey with the largest drift over its height at uplift."""
    if building.storey_heights is None:
        return
    above = building.carried * uplift_acceleration
    drifts = above / building.stiffnesses / building.storey_heights
    storey = int(drifts.argmax())
    if drifts[storey] > LARGEST_DRIFT:
        yield Doubt(
            "a storey drifts at uplift by {0} of its height{1}; more than"
            f" {LARGEST_DRIFT:g} is beyond usual buildings; check stiffness, period"
            " and storey height",
            float(drifts[storey]),
            f" (storey {storey + 1}, under a shear of {above[storey]:.4g} N)",
        )


def _unusual_sizes(structure: PodiumStructure) -> Iterator[Doubt]:
    """Quantities outside the range in which buildings have them."""
    bearing = structure.bearing
    building = structure.superstructure
    ranges: list[tuple[str, float | None, str, float, float]] = [
        ("the height of the columns 2H", 2.0 * bearing.half_height, "m", 0.3, 10.0),
        ("the semi-diagonal of the columns R", bearing.semi_diagonal, "m", 0.15, 6.0),
        ("the restitution at impact e", structure.restitution, "", 0.5, 1.0),
        ("the coefficient podium.friction", structure.friction, "", 0.1, 1.5),
    ]
    if building is not None:
        column = structure.columns_mass / structure.columns
        ranges += [
            (
                "the mean mass of a storey",
                1e-3 * building.masses.mean(),
                "t",
                1.0,
                10_000.0,
            ),
            ("the mean mass of a column", 1e-3 * column, "t", 0.02, 10_000.0),
            ("the first period on a fixed base T1", building.periods[0], "s", 0.02, 5.0),
            ("superstructure.vertical_period", building.vertical_period, "s", 0.01, 1.0),
        ]
    for name, value, unit, least, most in ranges:
        if value is not None and not least <= value <= most:
            usual = f"{least:g} to {most:g}{unit and f' {unit}'}"
            advice = "; check the units" if unit else ""
            yield Doubt(
                f"{name} = {{0}}{unit and f' {unit}'} is unusual: {usual} is"
                f" usual{advice}",
                float(value),
            )


def _unsaid_ends(structure: PodiumStructure) -> Iterator[Doubt]:
    """Square columns without a flat part: nothing says how their ends are curved."""
    bearing = structure.bearing
    column = structure.column
    if column is None or column.section != "square":
        return
    if bearing.ends is None and bearing.is_spherical:
        yield Doubt(
            "podium.bearing.ends is missing: the ends of square columns without a flat"
            " part are taken as spherical, which touch in a point and have the larger"
            " pressure; write ends: spherical, or ends: cylindrical for ends that are"
            " curved along the motion only and bear on a line of podium.column."
            "edge_length"
        )


def _pressed_arcs(structure: PodiumStructure) -> Iterator[Doubt]:
    """Columns whose arcs bear more than they can before anything moves."""
    bearing = structure.bearing
    column = structure.column
    tilt = 0.1 * structure.bearing.alpha
    if column is None or tilt >= bearing.beta:
        return
    pressure, *_ = column.pressed(bearing, np.array(tilt), np.array(structure.rest_force))
    if pressure > (strength := column.contact_strength):
        remedy = "a larger radius or more columns lower it"
        if strength < LEAST_STRENGTH:
            remedy = f"{strength:g} MPa? write contact_strength: {strength:g} MPa"
        yield Doubt(
            "podium.column: under the weight alone the pressure on arcs is {0} times"
            f" contact_strength{{1}}; {remedy}",
            float(pressure / strength),
            f" ({1e-6 * pressure:.4g} MPa over {1e-6 * strength:.4g} MPa)",
        )


def _turning_slab(structure: PodiumStructure) -> Iterator[Doubt]:
    """A slab that may turn about the vertical, where no history computes it."""
    ratio = unstable_from(structure)
    if ratio is None or structure.twist is not None:
        return
    yield Doubt(
        "podium.plan: that the slab may turn about the vertical is not computed without"
        " podium.twist; turns"
        " grow once it moves {0} of its critical displacement, so that columns at corners"
        " may move 1.1 to 1.5 times as far as the figure given (one motion in six: 1.5 to"
        " 2), unless their ends resist pivoting with a lever of some 20 mm of the weight,"
        " or dampers of 0.1 W per m/s in all stand at the corners; a limit can carry the"
        " factor, as in rotation_ratio: {{at_most: 0.5, factor: 1.3}}",
        ratio,
    )


def _moving_wind(structure: PodiumStructure) -> Iterator[Doubt]:
    """Wind that lifts the columns, or rolls them, and overcomes friction."""
    wind = wind_on(structure)
    if wind is None or not wind.moves:
        return
    remedy = "give the podium friction dampers, or its columns a wider flat part"
    if wind.ratio is None:
        yield Doubt(
            "podium.wind moves the building, which stands on ends without a flat part and"
            f" without friction: {remedy}"
        )
        return
    yield Doubt(
        "podium.wind is {0} times the force that moves the cap beam{1}: the wind moves"
        f" the building; {remedy}",
        wind.ratio,
        f" ({1e-3 * wind.base_shear:.4g} kN over {1e-3 * wind.moving_force:.4g} kN)",
    )


def _weak_storeys(structure: PodiumStructure) -> Iterator[Doubt]:
    """Storeys that the podium does not protect, as they yield before columns lift."""
    for way, seen in structure.ways.items():
        weak = {
            i: s for i, s in enumerate(storey_strengths(seen), 1) if not s.uplift_first
        }
        if weak:
            yield Doubt(
                "superstructure.yield: under slow ground motion storeys"
                f" yield{way.replace('_', ' in ')} before columns lift, at {{0}} of"
                " their shear at uplift{1}: the podium does not protect them; give them"
                " more strength, or the podium more slender columns",
                min(s.strength / s.shear_at_uplift for s in weak.values()),
                f" (storey {listed(map(str, weak), 'and')})",
            )


def doubts_of_directions(structure: PodiumStructure, *, both: bool) -> Iterator[Doubt]:
    """Effects that both horizontal components bring in, or one alone leaves out."""
    if not both:
        if structure.superstructure_y is not None:
            yield Doubt(
                "superstructure.y has an effect only where both components act (`?both`)"
            )
        return
    if structure.gamma == 0.0:
        yield Doubt(
            "free-standing columns (no cap beam) are assumed to roll on their own ends"
            " and to stay in place, which torsion under their weight hardly ensures:"
            " they may roll away"
        )
    column = structure.column
    if column is not None and column.stands_on_corners(structure.bearing):
        yield Doubt(
            "podium.column.section: square columns are modelled as round under both"
            " components, on their inscribed circle; towards corners real ones bring up"
            " to 1.4 times the shear into the building, which base shears, accelerations"
            " and shears of columns here do not hold (column_moment does, as about a"
            " corner), and they wobble over corners with impacts; the pressure at a"
            " corner is not computed"
        )
    lossless = structure.impact_law.contact_time == 0.0 and not structure.passes_smoothly
    if lossless and structure.restitution < 1.0:
        yield Doubt(
            "podium.impact.contact_time = 0: passes near upright lose nothing, however"
            " close, but impacts do: results are discontinuous, and rounding decides"
            " them"
        )


def doubts_of_motion(
    structure: PodiumStructure, motion: MotionComponents
) -> Iterator[Doubt]:
    """Effects of the directions in which a motion acts, and of a pair that is none."""
    both = motion.y is not None
    yield from doubts_of_directions(structure, both=both)
    alone = motion.y is not None and not (motion.y.pga and motion.horizontal.pga)
    if alone and structure.restitution < 1.0 and not structure.passes_smoothly:
        yield Doubt(
            "one component of the pair is zero: columns that rattle lock by the rule for"
            " pairs, not by that for one component. Of 114 such motions 36 differed by"
            " more than 1e-6 in rotation, the worst by 2.4 %"
            " (THEORY.md, section 13): leave the zero component out"
        )


def doubts_of_text(section: SuperstructureSection) -> Iterator[Doubt]:
    """Keys without effect, unequal neighbours."""
    fields = type(section).model_fields.items()
    ignored = [
        each.alias or name for name, each in fields if name in section.model_fields_set
    ]
    if section.storeys == 0 and len(ignored) > 1:
        keys = listed((f"superstructure.{name}" for name in ignored[1:]), "and")
        yield Doubt(
            f"superstructure.storeys = 0: there is no building, so {keys} had no effect"
        )
    for name, unit in (("storey_mass", "kg"), ("stiffness", "N/m")):
        given = getattr(section, name) if section.storeys else None
        values = each_storey(given, section.storeys) if given else ()
        for storey, (below, above) in enumerate(pairwise(values), start=1):
            if max(below, above) > NEIGHBOURS * min(below, above):
                yield Doubt(
                    f"superstructure.{name}: a storey has {{0}} times as much as its"
                    f" neighbour{{1}}; less than {NEIGHBOURS:g} times is usual; check"
                    " the units",
                    max(below, above) / min(below, above),
                    f" (storey {storey} has {below:.4g} {unit},"
                    f" storey {storey + 1} {above:.4g} {unit})",
                )
