"""What is possible in a case and yet hardly meant: each with its number and what is usual.

Mostly slips of units: millimetres for metres, kilograms for tonnes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from rpscli.case.build import each_storey
from rpscli.case.schema.case_file import SuperstructureSection
from rpscli.case.text.document import Document

if TYPE_CHECKING:
    from rpscli.model.podium import PodiumStructure


class Usual(NamedTuple):
    """A quantity and the range in which buildings have it."""

    name: str
    unit: str
    least: float
    most: float

    def doubts(self, value: float) -> Iterator[str]:
        """A warning if the value is outside."""
        if not self.least <= value <= self.most:
            unit = f" {self.unit}" if self.unit else ""
            yield (
                f"{self.name} = {value:.4g}{unit} is unusual: {self.least:g} to"
                f" {self.most:g}{unit} is; check the units"
            )


HEIGHT = Usual("the height of the columns 2H", "m", 0.3, 10.0)
SEMI_DIAGONAL = Usual("the semi-diagonal of the columns R", "m", 0.15, 6.0)
PERIOD = Usual("the first period on a fixed base T1", "s", 0.02, 5.0)
RESTITUTION = Usual("the restitution at impact e", "", 0.5, 1.0)
FRICTION = Usual("the coefficient podium.friction", "", 0.1, 1.5)

NEIGHBOURS = 20.0
"""No storey is so many times as heavy, or as stiff, as the next one."""

STRONGEST = 0.4
"""Hardly a building carries more than this part of its weight sideways: V_st/(M_tot g)."""

LARGEST_DRIFT = 0.02
"""Hardly a building carries a larger drift over its storey height without damage."""

PER_STOREY = ("storey_mass", "storey_height", "stiffness")


def doubts_of_structure(structure: PodiumStructure) -> Iterator[str]:
    """Sizes, period, restitution and friction; storey shears at uplift."""
    bearing, building = structure.bearing, structure.superstructure
    yield from HEIGHT.doubts(2.0 * bearing.half_height)
    yield from SEMI_DIAGONAL.doubts(bearing.semi_diagonal)
    yield from RESTITUTION.doubts(structure.restitution)
    if structure.friction is not None:
        yield from FRICTION.doubts(structure.friction)
    if building is None:
        return
    yield from PERIOD.doubts(float(building.periods[0]))
    share = bearing.slenderness
    if share > STRONGEST:
        yield (
            f"the base shear at uplift V_st = {structure.static_base_shear:.4g} N is {share:.3g} of"
            f" the building's weight, above the {STRONGEST:g} that any usual building carries: it"
            " would be damaged before it lifts; more slender columns lift earlier"
        )
    if building.storey_heights is not None:
        above = building.masses[::-1].cumsum()[::-1] * structure.uplift_acceleration
        drifts = above / building.stiffnesses / building.storey_heights
        storey = int(drifts.argmax())
        if drifts[storey] > LARGEST_DRIFT:
            yield (
                f"storey {storey + 1} drifts by {drifts[storey]:.3g} of its height at uplift, under"
                f" a shear of {above[storey]:.4g} N; more than {LARGEST_DRIFT:g} is beyond usual"
                " buildings; check stiffness, period and storey height"
            )


def doubts_of_storeys(section: SuperstructureSection, document: Document) -> Iterator[str]:
    """Neighbours that differ too much, and lists in which some numbers lack a unit."""
    for name in PER_STOREY:
        written = document.at(("superstructure", name))
        if isinstance(written, list):
            yield from _mixed(name, written)
    for name, unit in (("storey_mass", "kg"), ("stiffness", "N/m")):
        given = getattr(section, name)
        if section.storeys and given is not None:
            yield from _neighbours(name, unit, each_storey(given, section.storeys))


def _mixed(name: str, written: Sequence[object]) -> Iterator[str]:
    bare = [value for value in written if not isinstance(value, str)]
    if bare and len(bare) < len(written):
        with_unit = next(value for value in written if isinstance(value, str))
        yield (
            f"superstructure.{name} mixes numbers with a unit ({with_unit}) and without"
            f" ({bare[0]}): a bare number is in SI units; write the unit everywhere"
        )


def _neighbours(name: str, unit: str, values: Sequence[float]) -> Iterator[str]:
    for storey, (below, above) in enumerate(pairwise(values), start=1):
        if max(below, above) > NEIGHBOURS * min(below, above):
            yield (
                f"superstructure.{name}: storey {storey} has {below:.4g} {unit}, storey"
                f" {storey + 1} {above:.4g} {unit}; neighbours usually differ by less than"
                f" {NEIGHBOURS:g} times; check the units"
            )
