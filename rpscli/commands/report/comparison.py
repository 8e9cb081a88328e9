"""Results that are stored beside the same results computed anew."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from rpscli.analyses.result_quantities import plain
from rpscli.commands.report.subject import SUMMARY
from rpscli.report.html.page import Block, Notice
from rpscli.report.table import Table

MADE_ANEW = frozenset(
    ("files", "rps_version", "case", "verdicts", "passed", "exit_code", "command")
)
"""Keys that are no results."""


def compared(folder: Path, document: Mapping[str, Any]) -> list[Block]:
    """What became of the stored results: how many are the same, and those that are not."""
    try:
        stored = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
        before = dict(_leaves(stored))
    except (OSError, ValueError, AttributeError) as error:
        return [Notice(f"{folder / SUMMARY} cannot be read, so nothing was compared: {error}")]
    now = dict(_leaves(plain(document)))
    names = [name for name in before if name in now]
    differing = [(n, _text(before[n]), _text(now[n])) for n in names if before[n] != now[n]]
    same = len(names) - len(differing)
    text = (
        f"The results in {folder} were computed anew from what {folder / 'run.json'} says:"
        f" {same} of {len(names)} stored results are the same to the last digit."
    )
    if not differing:
        return [text]
    warning = f"{text} {len(differing)} differ; this page shows what was computed anew."
    return [
        Notice(warning),
        Table.of_texts(("result", "stored", "computed anew"), differing, words=1),
    ]


def _leaves(document: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in document.items():
        if not prefix and name in MADE_ANEW:
            continue
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


def _text(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:57]}..."
