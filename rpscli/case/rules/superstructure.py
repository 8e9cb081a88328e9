"""What the keys of `superstructure` and `limits` must be together."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.rules.partial_case import LIMITS, SUPERSTRUCTURE, PartialCase
from rpscli.case.text.faults import Fault, Path, listed, shown

STOREYS: Path = (*SUPERSTRUCTURE, "storeys")
BUILDING_KEYS = ("storey_mass", "storey_height", "period", "profile", "stiffness", "damping")


def superstructure_rules(case: PartialCase) -> Iterator[Fault]:
    """A building needs masses, stiffness and damping, each given once."""
    if not case.storeys:
        return
    yield from _masses_and_damping(case)
    yield from _stiffness(case)
    yield from _list_lengths(case)
    yield from _modes(case)


def ignored_keys(case: PartialCase) -> list[str]:
    """Keys of a building that have no effect because there is none."""
    return case.present(SUPERSTRUCTURE, *BUILDING_KEYS) if case.storeys == 0 else []


def _masses_and_damping(case: PartialCase) -> Iterator[Fault]:
    needed = {
        "storey_mass": "floor mass, one value or a list from the bottom, as in '200 t'",
        "damping": "as in {ratio: 0.05, modes: [1, 2]} (Rayleigh) or {ratio: 0.05} (every mode)",
    }
    for name, meaning in needed.items():
        path = (*SUPERSTRUCTURE, name)
        if not case.has(path):
            text = f"superstructure.{name} is missing: {meaning}"
            yield Fault(path, text, at_key=True, needs=(path,))


def _stiffness(case: PartialCase) -> Iterator[Fault]:
    period, profile, stiffness = ((*SUPERSTRUCTURE, n) for n in ("period", "profile", "stiffness"))
    if not case.has(stiffness) and not case.has(period):
        text = "superstructure has no stiffness: give period (with profile), or stiffness"
        yield Fault(SUPERSTRUCTURE, text, at_key=True, needs=(period, stiffness))
    for path, name in ((period, "period"), (profile, "profile")):
        if case.document.has(stiffness) and case.document.has(path):
            yield Fault(
                stiffness,
                f"superstructure.stiffness and superstructure.{name}{case.where(path)} both fix"
                f" the storey stiffnesses; keep one of them",
                at_key=True,
            )


def _list_lengths(case: PartialCase) -> Iterator[Fault]:
    section = case.superstructure
    for name in ("storey_mass", "storey_height", "stiffness"):
        values = getattr(section, name)
        if isinstance(values, tuple) and len(values) != case.storeys:
            yield Fault(
                (*SUPERSTRUCTURE, name),
                f"superstructure.{name} has {len(values)} values, but superstructure.storeys ="
                f" {case.storeys}{case.where(STOREYS)}; give one value a storey from the bottom,"
                " or a single value",
            )


def _modes(case: PartialCase) -> Iterator[Fault]:
    damping = case.superstructure.damping if case.superstructure else None
    storeys = case.storeys or 0
    # One storey takes [1, 2] as well: stiffness-proportional, so that a study can vary storeys.
    if damping and damping.modes and max(damping.modes) > max(storeys, 2):
        yield Fault(
            (*SUPERSTRUCTURE, "damping", "modes"),
            f"superstructure.damping.modes = {shown(damping.modes)} must be from 1 to"
            f" superstructure.storeys = {storeys}{case.where(STOREYS)}; a building has as many"
            " modes as storeys",
        )


def limits_rules(case: PartialCase) -> Iterator[Fault]:
    """A limit on something that the case cannot give would never be exceeded."""
    if case.storeys == 0:
        of_buildings = (q.name for q in LIMITED if "superstructure" in q.needs)
        for name in case.present(LIMITS, *of_buildings):
            yield Fault(
                (*LIMITS, name),
                f"limits.{name} needs a building, but superstructure.storeys ="
                f" 0{case.where(STOREYS)}; take the limit out",
                at_key=True,
            )
    height = (*SUPERSTRUCTURE, "storey_height")
    if case.storeys and case.has((*LIMITS, "drift_ratio")) and not case.has(height):
        yield Fault(
            (*LIMITS, "drift_ratio"),
            "limits.drift_ratio needs superstructure.storey_height, which is missing",
            at_key=True,
            needs=(height,),
        )


def ignored_text(names: list[str]) -> str:
    """The warning about `ignored_keys`."""
    keys = listed((f"superstructure.{name}" for name in names), "and")
    return f"superstructure.storeys = 0: there is no building, so {keys} had no effect"
