"""What the masses of `podium` must be together: each given once, none left open."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.rules.partial_case import PODIUM, PartialCase
from rpscli.case.rules.superstructure import STOREYS
from rpscli.case.schema.case_file import PodiumMasses
from rpscli.case.text.faults import Fault, Path, listed

GAMMA, ETA = "cap_beam_mass_ratio", "superstructure_mass_ratio"
BEAM, COLUMN, COLUMNS = "cap_beam_mass", "column_mass", "columns"


def masses_rules(case: PartialCase) -> Iterator[Fault]:
    """Cap beam and columns each have one mass."""
    if case.storeys is None or not case.is_mapping(PODIUM):
        return
    if case.storeys:
        yield from _one_of(case, "the mass of the cap beam", ETA, BEAM)
        yield from _one_of(case, "the mass of the columns", GAMMA, COLUMN)
        yield from _number_of_columns(case)
        yield from _beam_under_building(case)
    else:
        yield from _frame(case)


def _path(name: str) -> Path:
    return (*PODIUM, name)


def _one_of(case: PartialCase, what: str, *names: str) -> Iterator[Fault]:
    given = case.present(PODIUM, *names)
    if not given:
        needs = tuple(_path(name) for name in names)
        text = f"podium leaves {what} open: give {listed(names)}"
        yield Fault(PODIUM, text, at_key=True, needs=needs)
    written = case.written(PODIUM, *names)
    if len(written) > 1:
        yield _twice(case, what, written)


def _twice(case: PartialCase, what: str, given: list[str]) -> Fault:
    """Point at the last one written and name the places of the others."""
    order = [(case.document.key_place(_path(name)), name) for name in given]
    *others, last = [n for _, n in sorted(order, key=lambda o: (o[0].rank, o[0].line, o[0].column))]
    named = listed((f"podium.{name}{case.where(_path(name))}" for name in others), "and")
    both = "both" if len(others) == 1 else "together"
    return Fault(
        _path(last),
        f"podium.{last} and {named} {both} fix {what}; take one of them out",
        at_key=True,
    )


def _number_of_columns(case: PartialCase) -> Iterator[Fault]:
    if case.has(_path(COLUMN)) and not case.has(_path(COLUMNS)):
        text = "podium.columns is missing: the number of columns, each of column_mass"
        yield Fault(_path(COLUMNS), text, at_key=True, needs=(_path(COLUMNS),))


def _beam_under_building(case: PartialCase) -> Iterator[Fault]:
    masses = case.masses
    for name in (GAMMA, BEAM):
        if masses and getattr(masses, name) == 0.0:
            yield Fault(
                _path(name),
                f"podium.{name} = 0 must be > 0: the superstructure{case.where(STOREYS)} stands"
                " on the cap beam; 0 is for free-standing columns, with superstructure.storeys: 0",
            )


def _frame(case: PartialCase) -> Iterator[Fault]:
    """Without a building two of three: beam mass, column mass, and their ratio."""
    if case.has(_path(ETA)):
        yield Fault(
            _path(ETA),
            f"podium.{ETA} has no meaning with superstructure.storeys = 0{case.where(STOREYS)};"
            f" give podium.{BEAM} instead",
            at_key=True,
        )
        return
    masses, given = case.masses, case.present(PODIUM, BEAM, GAMMA, COLUMN)
    written = case.written(PODIUM, BEAM, GAMMA, COLUMN)
    if len(written) > len((BEAM, COLUMN)):
        yield _twice(case, "the masses of cap beam and columns", written)
    elif masses and masses.without_cap_beam:
        yield from _free_standing(case, masses)
    else:
        yield from _too_few(given)
        yield from _number_of_columns(case)


def _too_few(given: list[str]) -> Iterator[Fault]:
    if len(given) < 2:
        open_names = [name for name in (BEAM, GAMMA, COLUMN) if name not in given]
        number = "one" if given else "two"
        yield Fault(
            PODIUM,
            f"podium leaves the masses of cap beam and columns open: give {number} of"
            f" {listed(open_names)} (column_mass with columns)",
            at_key=True,
            needs=tuple(_path(name) for name in open_names),
        )


def _free_standing(case: PartialCase, masses: PodiumMasses) -> Iterator[Fault]:
    if masses.cap_beam_mass_ratio or masses.cap_beam_mass:
        yield Fault(
            _path(BEAM),
            f"podium.{BEAM} and podium.{GAMMA}{case.where(_path(GAMMA))} contradict each other:"
            " one says that there is no cap beam; give column_mass instead of one of them",
        )
    elif not case.has(_path(COLUMN)):
        text = "podium.column_mass is missing: without a cap beam it is the only mass"
        yield Fault(_path(COLUMN), text, at_key=True, needs=(_path(COLUMN),))
