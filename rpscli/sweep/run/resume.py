"""What of a study is in its store already, and what a changed study keeps, adds and drops."""

from __future__ import annotations

import hashlib
import json
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from rpscli.case.text.document import shown
from rpscli.errors import Refused
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.points.layout import StudyPoints, known_factor
from rpscli.sweep.store import Store


def all_keys(layout: StudyPoints, context: StudyContext) -> list[bytes]:
    """Digests of resolved case, record content, scale, perturbation and solver of all points."""
    plan, keys, of_system = layout.plan, list[bytes](), layout.points_of_system
    tails, before = list[bytes](), None
    for system, properties in enumerate(layout.properties):
        begun = hashlib.sha256(plan.solver.encode() + plan.analysis.encode() + properties.digest)
        own = properties.record, properties.scale, layout.period_of_measure(properties)
        if own != before:
            first, before = system * of_system, own
            points = (layout[number] for number in range(first, first + of_system))
            tails = [_of_motion(context, point) for point in points]
        for tail in tails:
            digest = begun.copy()
            digest.update(tail)
            keys.append(digest.digest())
    return keys


def _of_motion(context: StudyContext, point: Point) -> bytes:
    """Content of the record, or why it cannot be read; scale and perturbation."""
    if context.plan.analysis != "timehistory":
        return b""
    assert point.record is not None, "points of histories have a record"
    factor = known_factor(context, point)
    change = struct.pack("<2d?", factor, point.restitution_change, context.plan.whole)
    return context.records.digest(point.record) + change


@dataclass(frozen=True, eq=False)
class Resume:
    """Where a run begins."""

    keys: list[bytes]
    """Of all points, in the order of the study."""
    pending: list[int]
    """Points to be computed, in the order of the study; equal points are computed once."""
    kept: int
    failed: int
    """Points that are stored, and those of them that failed and are not tried again."""
    unused: int
    """Stored points that are no longer in the study. They stay in the file, for the case
    that the study is changed back."""
    notes: tuple[str, ...]
    """What changed since the last run, for the user."""


def resume(layout: StudyPoints, keys: list[bytes], store: Store, *, retry_failed: bool) -> Resume:
    """Compare a study with its store."""
    known = store.outcomes()
    wanted = set(keys)
    done = {key for key, failed in known.items() if not (failed and retry_failed)}
    pending: list[int] = []
    seen = wanted & done
    kept = sum(key in seen for key in keys)
    failed = sum(known[key] for key in keys if key in seen)
    for number, key in enumerate(keys):
        if key not in seen:
            seen.add(key)
            pending.append(number)
    unused = len(known.keys() - wanted)
    before = store.meta("study")
    foreign = before is not None and known and not wanted & known.keys()
    if foreign and (name := store.meta("name")) != layout.study.name:
        raise Refused(
            f"{store.path} holds the results of another study ({name}); name another folder with"
            " -o, or discard them with --fresh"
        )
    notes = tuple(_notes(layout, store, before, kept, unused, len(keys) - kept))
    return Resume(keys, pending, kept, failed, unused, notes)


def remember(layout: StudyPoints, store: Store) -> None:
    """Write into the store which study its results belong to."""
    store.note(study=written(layout), name=layout.study.name, solver=layout.plan.solver)


def written(layout: StudyPoints) -> str:
    """The study and its case as they are written, with overrides."""
    content = {**layout.study.document.content, "base": layout.plan.base}
    return json.dumps(content, sort_keys=True)


def _notes(
    layout: StudyPoints, store: Store, before: str | None, kept: int, unused: int, added: int
) -> Iterator[str]:
    if before is None:
        return
    if (solver := store.meta("solver")) != layout.plan.solver:
        yield f"the solver changed from {solver} to {layout.plan.solver}: nothing of it applies"
    old, new = json.loads(before), json.loads(written(layout))
    changed = list(_differences(old, new, ""))
    if changed:
        yield "the study changed: " + "; ".join(changed[:6]) + ("; ..." if changed[6:] else "")
    if changed or unused:
        yield f"{kept} points still apply, {added} are to be computed"
    if unused:
        yield f"{unused} stored points are no longer in the study; they stay in {store.path}"


def _differences(old: Any, new: Any, path: str) -> Iterator[str]:
    """Where two documents differ, in words."""
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        for key in dict.fromkeys((*old, *new)):
            inner = f"{path}.{key}" if path else str(key)
            if key not in new:
                yield f"{inner} dropped"
            elif key not in old:
                yield f"{inner} = {shown(new[key])} added"
            else:
                yield from _differences(old[key], new[key], inner)
    elif isinstance(old, list) and isinstance(new, list):
        yield from _list_differences(old, new, path)
    elif old != new:
        yield f"{path}: {shown(old)} -> {shown(new)}"


def _list_differences(old: list[Any], new: list[Any], path: str) -> Iterator[str]:
    if len(old) == len(new) and any(isinstance(item, dict | list) for item in (*old, *new)):
        for index, (before, after) in enumerate(zip(old, new, strict=True)):
            yield from _differences(before, after, f"{path}.{index}")
        return
    dropped = [item for item in old if item not in new]
    added = [item for item in new if item not in old]
    if dropped:
        yield f"{path} drops {shown(dropped)}"
    if added:
        yield f"{path} adds {shown(added)}"
    if not dropped and not added and old != new:
        yield f"{path}: another order"
