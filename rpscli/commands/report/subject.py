"""What a page is to be about: a case, a study, or the folder of earlier results."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rpscli.commands.case_input import CaseInput
from rpscli.commands.motion import MotionRequest
from rpscli.commands.shell.options import CaseRequest
from rpscli.errors import UsageError
from rpscli.report.files.output_folder import RUN_FILE

SUMMARY = "summary.json"
HISTORY, SWEEP = "timehistory", "sweep"


@dataclass(frozen=True)
class Earlier:
    """A folder of earlier results, and what its `run.json` says."""

    folder: Path
    run: Mapping[str, Any]

    @property
    def file(self) -> Path | None:
        """The case or the study, as seen from the working folder."""
        name = self.run["file"]
        return None if name is None else _shortened(self.folder / name)


def earlier_results(folder: Path) -> Earlier:
    """What a folder holds.

    Raises
    ------
    UsageError
        If it holds nothing that a page can be made of.
    """
    command = None
    try:
        run = json.loads((folder / RUN_FILE).read_text(encoding="utf-8"))
        command, inputs = run["command"], run["inputs"]
        needed = [*(run[key] for key in ("file", "name", "sha256")), inputs["overrides"]]
        if command == HISTORY:
            record = inputs["record"]
            needed += [inputs["case"], record["scale"], record["vertical"]]
            needed += [record["horizontal"][key] for key in ("source", "sha256")]
        if command in {HISTORY, SWEEP}:
            return Earlier(folder, run)
    except (OSError, ValueError, TypeError, KeyError):
        pass  # told below, together with folders of other commands
    inside = sorted(path.parent for path in folder.glob(f"*/{RUN_FILE}"))
    hint = f"; name one of the folders in it, such as {inside[0]}" if inside else ""
    what = f"holds results of `rps {command}`" if command else f"has no {RUN_FILE} of rps"
    raise UsageError(
        f"{folder}: {what}, and a report is made of one time history or one study{hint}"
    )


def is_study(source: str) -> bool:
    """Whether a file is a study: these have a case at their base."""
    if source == "-":
        return False
    from rpscli.case.text.files import read_text
    from rpscli.case.text.yaml_text import read_yaml

    return "base" in read_yaml(read_text(source), source).content


def earlier_case(earlier: Earlier) -> tuple[CaseInput, MotionRequest]:
    """The case and the motion of earlier results, as they were then."""
    from rpscli.case.case import parse_case

    run, file = earlier.run, earlier.file
    folder = earlier.folder if file is None else file.parent
    name = str(file or f"{run['name']}.yaml")
    # JSON is YAML too.
    case = parse_case(json.dumps(run["inputs"]["case"]), name=name, folder=folder)
    case = replace(case, digest=run["sha256"])
    request = CaseRequest(name, tuple(run["inputs"]["overrides"]))
    return CaseInput(case, request), _motion(earlier, None if not case.record else case.record)


def _motion(earlier: Earlier, own: Any) -> MotionRequest:
    given = earlier.run["inputs"]["record"]
    sources = {
        name: None if given[name] is None else str(given[name]["source"])
        for name in ("horizontal", "vertical")
    }
    horizontal, vertical = sources["horizontal"], sources["vertical"]
    if own is not None and own.source == horizontal:
        other = None if vertical == own.vertical else vertical
        return MotionRequest(None, other, given["scale"])
    return MotionRequest(horizontal, vertical, given["scale"])


def _shortened(path: Path) -> Path:
    """Without steps back and forth, and relative where that is shorter."""
    absolute = path.resolve()
    here = Path.cwd()
    return absolute.relative_to(here) if absolute.is_relative_to(here) else absolute
