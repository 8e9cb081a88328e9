"""`rps sweep --dry-run`: what a study would do."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from rpscli.commands.shell.tables import listing, title
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.sweep.input import StudyInput, SweepChoices, study_heading
from rpscli.commands.sweep.progress import duration
from rpscli.report.documents import heading

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rpscli.sweep.points.layout import StudyPoints

POINTS_SHOWN = 3
"""At each end of the study."""

GUESSED_POINT_SECONDS = 0.01
"""Where trying would mean compiling first: some 40 s of motion of a few storeys."""


def show_dry_run(given: StudyInput, choices: SweepChoices, terminal: Terminal) -> None:
    """Count, first and last points, and an estimate of the time."""
    from rpscli.sweep.run.threads import available_cores

    layout = given.layout
    jobs = choices.jobs or available_cores()
    count = len(layout)
    first = range(min(POINTS_SHOWN, count))
    last = range(max(0, count - POINTS_SHOWN), count)
    points = {n: {"point": n + 1, **_described(layout, n)} for n in {*first, *last}}
    seconds, source = _estimate(given, jobs)
    document: dict[str, Any] = {
        **heading(),
        "command": "sweep",
        "study": study_heading(given),
        "dry_run": True,
        "analysis": layout.plan.analysis,
        "points": count,
        "systems": len(layout.combinations),
        "records": len(layout.records),
        "scales": len(layout.scales),
        "members": len(layout.members),
        "first_points": [points[n] for n in first],
        "last_points": [points[n] for n in last],
        "estimate": {"seconds": seconds, "jobs": jobs, "source": source},
        "warnings": given.doubts,
    }
    terminal.warn(document["warnings"])
    shown = [points[n] for n in sorted(points)]
    terminal.result(document, _tables(document, shown))


def _described(layout: StudyPoints, number: int) -> dict[str, Any]:
    """A point with its factor on the record, where no measure decides about it."""
    from rpscli.sweep.points.described import described

    point = layout[number]
    factor = point.scale * point.scale_change
    known = layout.plan.measure is None and layout.plan.analysis == "timehistory"
    return described(layout, point) | ({"scale": factor} if known else {})


def _estimate(given: StudyInput, jobs: int) -> tuple[float, str]:
    """Time of the whole study [s], and where the number comes from."""
    from rpscli.analyses.kernels.compilation import is_ready
    from rpscli.sweep.run.estimate import estimated_seconds

    if given.layout.plan.analysis == "timehistory" and not is_ready():
        seconds = GUESSED_POINT_SECONDS * len(given.layout) / jobs
        return seconds, "a guess, since the kernel is not compiled yet"
    return estimated_seconds(given.layout, given.context, jobs), "trying some of the points"


def _tables(document: dict[str, Any], points: list[dict[str, Any]]) -> Iterator[RenderableType]:
    from rpscli.report.study.labels import label

    yield title(document["study"]["title"])
    counts = [(name, str(document[name])) for name in ("points", "systems", "records", "scales")]
    counts.append(("members", str(document["members"])))
    expected = document["estimate"]
    text = f"about {duration(expected['seconds'])} on {expected['jobs']} cores"
    yield listing([*counts, ("time", f"{text}, by {expected['source']}")])
    rows = []
    for point in points:
        varied = (label(key, value) for key, value in point.items() if key != "point")
        rows.append((f"point {point['point']}", ", ".join(varied)))
    yield listing(rows)
