"""What the masses of `podium` must be together: each given once, none left open."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.draft import PODIUM, Draft
from rpscli.case.faults import Fault, Path, listed
from rpscli.case.rules_superstructure import STOREYS
from rpscli.case.schema import PodiumMasses

GAMMA, ETA = "cap_beam_mass_ratio", "superstructure_mass_ratio"
BEAM, COLUMN, COLUMNS = "cap_beam_mass", "column_mass", "columns"


def masses_rules(draft: Draft) -> Iterator[Fault]:
    """Cap beam and columns each have one mass."""
    if draft.storeys is None or not draft.is_mapping(PODIUM):
        return
    if draft.storeys:
        yield from _one_of(draft, "the mass of the cap beam", ETA, BEAM)
        yield from _one_of(draft, "the mass of the columns", GAMMA, COLUMN)
        yield from _number_of_columns(draft)
        yield from _beam_under_building(draft)
    else:
        yield from _frame(draft)


def without_beam(masses: PodiumMasses) -> bool:
    """Whether the columns stand free, without a cap beam."""
    return masses.cap_beam_mass_ratio == 0.0 or masses.cap_beam_mass == 0.0


def _path(name: str) -> Path:
    return (*PODIUM, name)


def _one_of(draft: Draft, what: str, *names: str) -> Iterator[Fault]:
    given = draft.present(PODIUM, *names)
    if not given:
        needs = tuple(_path(name) for name in names)
        text = f"podium leaves {what} open: give {listed(names)}"
        yield Fault(PODIUM, text, at_key=True, needs=needs)
    written = draft.written(PODIUM, *names)
    if len(written) > 1:
        yield _twice(draft, what, written)


def _twice(draft: Draft, what: str, given: list[str]) -> Fault:
    """Point at the last one written and name the places of the others."""
    order = [(draft.document.key_place(_path(name)), name) for name in given]
    *others, last = [n for _, n in sorted(order, key=lambda o: (o[0].rank, o[0].line, o[0].column))]
    named = listed((f"podium.{name}{draft.where(_path(name))}" for name in others), "and")
    both = "both" if len(others) == 1 else "together"
    return Fault(
        _path(last),
        f"podium.{last} and {named} {both} fix {what}; take one of them out",
        at_key=True,
    )


def _number_of_columns(draft: Draft) -> Iterator[Fault]:
    if draft.has(_path(COLUMN)) and not draft.has(_path(COLUMNS)):
        text = "podium.columns is missing: the number of columns, each of column_mass"
        yield Fault(_path(COLUMNS), text, at_key=True, needs=(_path(COLUMNS),))


def _beam_under_building(draft: Draft) -> Iterator[Fault]:
    masses = draft.masses
    for name in (GAMMA, BEAM):
        if masses and getattr(masses, name) == 0.0:
            yield Fault(
                _path(name),
                f"podium.{name} = 0 must be > 0: the superstructure{draft.where(STOREYS)} stands"
                " on the cap beam; 0 is for free-standing columns, with superstructure.storeys: 0",
            )


def _frame(draft: Draft) -> Iterator[Fault]:
    """Without a building two of three: beam mass, column mass, and their ratio."""
    if draft.has(_path(ETA)):
        yield Fault(
            _path(ETA),
            f"podium.{ETA} has no meaning with superstructure.storeys = 0{draft.where(STOREYS)};"
            f" give podium.{BEAM} instead",
            at_key=True,
        )
        return
    masses, given = draft.masses, draft.present(PODIUM, BEAM, GAMMA, COLUMN)
    written = draft.written(PODIUM, BEAM, GAMMA, COLUMN)
    if len(written) > len((BEAM, COLUMN)):
        yield _twice(draft, "the masses of cap beam and columns", written)
    elif masses and without_beam(masses):
        yield from _free_standing(draft, masses)
    else:
        yield from _too_few(given)
        yield from _number_of_columns(draft)


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


def _free_standing(draft: Draft, masses: PodiumMasses) -> Iterator[Fault]:
    if masses.cap_beam_mass_ratio or masses.cap_beam_mass:
        yield Fault(
            _path(BEAM),
            f"podium.{BEAM} and podium.{GAMMA}{draft.where(_path(GAMMA))} contradict each other:"
            " one says that there is no cap beam; give column_mass instead of one of them",
        )
    elif not draft.has(_path(COLUMN)):
        text = "podium.column_mass is missing: without a cap beam it is the only mass"
        yield Fault(_path(COLUMN), text, at_key=True, needs=(_path(COLUMN),))
