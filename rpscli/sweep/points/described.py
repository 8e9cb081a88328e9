"""A point in the user's words: its varied keys, and the command that computes it alone."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rpscli.case.text.yaml_text import read_value
from rpscli.errors import RpsError
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point, RecordRequest
from rpscli.sweep.evaluation.systems import resolved
from rpscli.sweep.points.layout import StudyPoints


def described(layout: StudyPoints, point: Point) -> dict[str, Any]:
    """What tells the point from the others: columns of `points.csv` before the results.

    `scale` is missing: it is a result where records are scaled to a measure.
    """
    columns = dict(zip(layout.plan.keys, point.values, strict=True))
    if len(layout.members) > 1:
        columns |= {"member": point.member, "restitution_change": point.restitution_change}
    if layout.plan.measure is not None:
        columns[layout.plan.measure.measure] = point.scale
    if point.record is not None and layout.plan.analysis == "timehistory":
        columns["record"] = point.record.source
    return columns


def identifying_columns(layout: StudyPoints) -> tuple[str, ...]:
    """Names of these columns."""
    return tuple(described(layout, layout[0]))


def reproduction(layout: StudyPoints, context: StudyContext, point: Point, base_file: Path) -> str:
    """One line for the shell that computes the point alone.

    Parameters
    ----------
    base_file
        The case at the base of the study.
    """
    words = ["rps", layout.plan.analysis, str(base_file)]
    for text in (*_overrides(layout, point), *_restitution(layout, point)):
        words += ["--set", text]
    if point.record is not None and layout.plan.analysis == "timehistory":
        words += ["--record", _source(point.record)]
        if point.record.vertical:
            words += ["--vertical", _source(point.record._replace(source=point.record.vertical))]
        words += ["--scale", repr(_factor(context, point))]
    return shlex.join(words)


def _overrides(layout: StudyPoints, point: Point) -> Iterator[str]:
    if layout.study.base_file is not None:  # otherwise they are in the file that was written
        yield from layout.study.base_overrides
    for key, value in zip(layout.plan.keys, point.values, strict=True):
        yield f"{key}={yaml_scalar(value)}"


def _restitution(layout: StudyPoints, point: Point) -> Iterator[str]:
    if point.restitution_change != 1.0:
        law = dict(resolved(layout.plan, point.values).document["podium"]["impact"])
        law["factor"] *= point.restitution_change
        yield f"podium.impact={json.dumps(law)}"


def _factor(context: StudyContext, point: Point) -> float:
    try:
        return context.factor(point)
    except RpsError:
        return point.scale


def _source(request: RecordRequest) -> str:
    """The source as seen from the working folder."""
    place, mark, options = request.source.partition("?")
    file = Path(request.folder) / place
    if not file.exists():
        return request.source
    stated = [options] if mark else []
    stated += [f"dt={request.dt!r}"] if request.dt is not None else []
    stated += [f"units={request.units}"] if request.units is not None else []
    return f"{file}?{'&'.join(stated)}" if stated else str(file)


def yaml_scalar(value: Any) -> str:
    """A value as YAML that gives the same value again.

    >>> yaml_scalar(0.1), yaml_scalar("critical"), yaml_scalar("0.1"), yaml_scalar([1, 2])
    ('0.1', 'critical', '"0.1"', '[1, 2]')
    """
    if not isinstance(value, str):
        return json.dumps(value)
    try:
        plain = read_value(value, "value") == value
    except RpsError:
        plain = False
    return value if plain else json.dumps(value)
