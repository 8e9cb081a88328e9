"""The folder of a study's results."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rpscli.report.files import OutputFolder, Run, require_writable
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.store import FILE


def study_folder(
    layout: StudyPoints,
    place: Path,
    overrides: Sequence[str],
    command: str = "sweep",
    *,
    force: bool = False,
) -> OutputFolder:
    """Claimed for a command on a study; a folder with a store belongs to its study."""
    # After a kill there may be files there that no `run.json` speaks of.
    require_writable(place)
    study, inputs = layout.study, study_inputs(layout, overrides)
    file = None if study.source.startswith("<") else Path(study.source)
    run = Run(command, study.name, file, study.digest, inputs)
    return OutputFolder(place, run, force=force or (place / FILE).exists())


def study_inputs(layout: StudyPoints, overrides: Sequence[str]) -> dict[str, Any]:
    """What `run.json` says that a study was made from."""
    return {
        "study": layout.study.document.content,
        "base": layout.plan.base,
        "overrides": list(overrides),
        "points": len(layout),
        "solver": layout.plan.solver,
    }
