"""The record sources of a study: what stands in its list, as single sources."""

from __future__ import annotations

import itertools
import math
from pathlib import Path as Folder

from rpscli.case.study.fields import ValueRange, spaced
from rpscli.case.study.sizes import MOST_SOURCES
from rpscli.case.text.document import Document
from rpscli.case.text.faults import Fault, Path, dotted, shown
from rpscli.errors import RecordError
from rpscli.records.source import expand_sources


def sources_of(document: Document, folder: Folder) -> tuple[tuple[str, ...], list[Fault]]:
    """Single sources of the list `records`, in order, each once; and what is wrong with it.

    Whether a source exists is seen here; whether it can be read is seen when it is.
    """
    written = document.content.get("records")
    if written is None:
        return (), []
    if not isinstance(written, list) or not written:
        text = f"records = {shown(written)} must be a list of sources, as in [fema_p695:*]"
        return (), [Fault(("records",), text)]
    sources: list[str] = []
    faults: list[Fault] = []
    for index, item in enumerate(written):
        path: Path = ("records", index)
        try:
            patterns = [item] if isinstance(item, str) else _product(item, path)
            sources += expand_sources(patterns, folder=folder)
        except (RecordError, ValueError) as error:
            faults.append(Fault(path, str(error)))
    return tuple(dict.fromkeys(sources)), faults


def _product(item: object, path: Path) -> list[str]:
    """Sources of a mapping: every option may have several values, the first varies slowest."""
    source = item.get("source") if isinstance(item, dict) else None
    if not isinstance(item, dict) or not isinstance(source, str):
        raise ValueError(  # noqa: TRY004 -- a fault of the file, not of the program
            f"{dotted(path)} = {shown(item)} must be a source, or a mapping with a source and"
            " options: {source: 'pulse:sine?amplitude=1 g', period: [0.5, 1]}"
        )
    options = [
        [f"{key}={_text(value)}" for value in _several(value, (*path, key))]
        for key, value in item.items()
        if key != "source"
    ]
    if (count := math.prod(map(len, options))) > MOST_SOURCES:
        raise ValueError(
            f"{dotted(path)} stands for {count} ground motions, which must not be more than"
            f" {MOST_SOURCES}; use fewer values of its options"
        )
    mark = "&" if "?" in source and not source.endswith("?") else "?" * (not source.endswith("?"))
    return [
        f"{source}{mark if chosen else ''}{'&'.join(chosen)}"
        for chosen in itertools.product(*options)
    ]


def _several(value: object, path: Path) -> list[object]:
    if isinstance(value, dict):
        try:
            return list(spaced(ValueRange.model_validate(value)))
        except ValueError:
            raise ValueError(
                f"{dotted(path)} = {shown(value)} is no range {{low, high, count, spacing}}"
            ) from None
    values = value if isinstance(value, list) else [value]
    if not values or not all(isinstance(v, int | float | str) for v in values):
        raise ValueError(f"{dotted(path)} = {shown(value)} must be a value or a list of values")
    return list(values)


def _text(value: object) -> str:
    """A value as an option is written: whole numbers without a fraction.

    >>> _text(20.0), _text(0.5), _text("0.4 g")
    ('20', '0.5', '0.4 g')
    """
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value)
