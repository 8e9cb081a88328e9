"""What the keys of `superstructure` and `limits` must be together."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.draft import LIMITS, SUPERSTRUCTURE, Draft
from rpscli.case.faults import Fault, Path, listed, shown

STOREYS: Path = (*SUPERSTRUCTURE, "storeys")
BUILDING_KEYS = ("storey_mass", "storey_height", "period", "profile", "stiffness", "damping")


def superstructure_rules(draft: Draft) -> Iterator[Fault]:
    """A building needs masses, stiffness and damping, each given once."""
    if not draft.storeys:
        return
    yield from _masses_and_damping(draft)
    yield from _stiffness(draft)
    yield from _list_lengths(draft)
    yield from _modes(draft)


def ignored_keys(draft: Draft) -> list[str]:
    """Keys of a building that have no effect because there is none."""
    return draft.present(SUPERSTRUCTURE, *BUILDING_KEYS) if draft.storeys == 0 else []


def _masses_and_damping(draft: Draft) -> Iterator[Fault]:
    needed = {
        "storey_mass": "floor mass, one value or a list from the bottom, as in '200 t'",
        "damping": "as in {ratio: 0.05, modes: [1, 2]} (Rayleigh) or {ratio: 0.05} (every mode)",
    }
    for name, meaning in needed.items():
        path = (*SUPERSTRUCTURE, name)
        if not draft.has(path):
            text = f"superstructure.{name} is missing: {meaning}"
            yield Fault(path, text, at_key=True, needs=(path,))


def _stiffness(draft: Draft) -> Iterator[Fault]:
    period, profile, stiffness = ((*SUPERSTRUCTURE, n) for n in ("period", "profile", "stiffness"))
    if not draft.has(stiffness) and not draft.has(period):
        text = "superstructure has no stiffness: give period (with profile), or stiffness"
        yield Fault(SUPERSTRUCTURE, text, at_key=True, needs=(period, stiffness))
    for path, name in ((period, "period"), (profile, "profile")):
        if draft.document.has(stiffness) and draft.document.has(path):
            yield Fault(
                stiffness,
                f"superstructure.stiffness and superstructure.{name}{draft.where(path)} both fix"
                f" the storey stiffnesses; keep one of them",
                at_key=True,
            )


def _list_lengths(draft: Draft) -> Iterator[Fault]:
    section = draft.superstructure
    for name in ("storey_mass", "storey_height", "stiffness"):
        values = getattr(section, name)
        if isinstance(values, tuple) and len(values) != draft.storeys:
            yield Fault(
                (*SUPERSTRUCTURE, name),
                f"superstructure.{name} has {len(values)} values, but superstructure.storeys ="
                f" {draft.storeys}{draft.where(STOREYS)}; give one value a storey from the bottom,"
                " or a single value",
            )


def _modes(draft: Draft) -> Iterator[Fault]:
    damping = draft.superstructure.damping if draft.superstructure else None
    storeys = draft.storeys or 0
    # One storey takes [1, 2] as well: stiffness-proportional, so that a study can vary storeys.
    if damping and damping.modes and max(damping.modes) > max(storeys, 2):
        yield Fault(
            (*SUPERSTRUCTURE, "damping", "modes"),
            f"superstructure.damping.modes = {shown(damping.modes)} must be from 1 to"
            f" superstructure.storeys = {storeys}{draft.where(STOREYS)}; a building has as many"
            " modes as storeys",
        )


def limits_rules(draft: Draft) -> Iterator[Fault]:
    """A limit on something that the case cannot give would never be exceeded."""
    if draft.storeys == 0:
        for name in draft.present(LIMITS, "base_shear_ratio", "drift_ratio"):
            yield Fault(
                (*LIMITS, name),
                f"limits.{name} needs a building, but superstructure.storeys ="
                f" 0{draft.where(STOREYS)}; take the limit out",
                at_key=True,
            )
    height = (*SUPERSTRUCTURE, "storey_height")
    if draft.storeys and draft.has((*LIMITS, "drift_ratio")) and not draft.has(height):
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
