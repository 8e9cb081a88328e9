"""The record formats that can be read: told apart by content
first, by extension second.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import PluginError, RecordError
from rpscli.records.formats.agencies import LAYOUTS
from rpscli.records.formats.at2 import FORMAT, contents_of_at2, read_at2, recognises_at2
from rpscli.records.formats.columns import (
    contents_of_columns,
    read_columns,
    recognises_columns,
)
from rpscli.records.formats.record_text import Channel, RecordText, read_text
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.source import FILE, Source
from rpscli.registry import Registry


@dataclass(frozen=True)
class RecordFormat:
    """A file format: what it is called, how it is recognised, how it is read.

    `contents` tells from headers alone what a file holds; without it the file is read.
    """

    name: str
    extensions: tuple[str, ...]
    recognises: Callable[[RecordText], bool]
    read: Callable[[RecordText], GroundMotion]
    contents: Callable[[RecordText], Sequence[Channel]] | None = None


_OURS = (
    RecordFormat(FORMAT, (".at2",), recognises_at2, read_at2, contents_of_at2),
    *(
        RecordFormat(of.name, of.extensions, of.recognises, of.read, of.contents)
        for of in LAYOUTS
    ),
)
_PLAIN = RecordFormat(
    "columns",
    (".txt", ".dat", ".csv", ".tsv"),
    recognises_columns,
    read_columns,
    contents_of_columns,
)
"""Accepts most, so it comes last."""

FORMATS = Registry(
    "formats", {form.name: form for form in (*_OURS, _PLAIN)}, RecordFormat
)
"""In the order of recognition."""

_OTHER_QUANTITIES = {".vt2": "velocity", ".dt2": "displacement"}
_STRONGEST = 4.0  # g
_WEAKEST = 1e-3
_NONSENSE = 1e9  # g; raw counts taken for g have a hundredth, and squares stay finite
_FINEST = 1e-4  # s
_COARSEST = 0.1
_OFFSET = 0.1  # of the peak, samples
_MANY = 100
_AT_REST = 0.1  # of the peak; 115 real records begin and end below half of it


def read_record(path: Path, of: Source) -> GroundMotion:
    """Read one record file of any known format, with the options of its source."""
    extension = path.suffix.lower()
    if quantity := _OTHER_QUANTITIES.get(extension):
        raise RecordError(
            f"{path}: {path.suffix} files hold {quantity}; give the acceleration record"
            f" of the same station, {path.with_suffix('.AT2').name}"
        )
    text = read_text(path, of)
    form = _by_content(text)
    try:
        # By its extension, the format of that name says what is missing.
        named = (form for form in _in_order() if extension in form.extensions)
        motion = (form or next(named, _PLAIN)).read(text)
    except RecordError as error:
        unusable = [] if form in _OURS else [o.fault for o in FORMATS.offers() if o.fault]
        raise RecordError("\n".join([str(error), *unusable])) from error
    peak = motion.pga / STANDARD_GRAVITY
    mean = abs(float(motion.acceleration.mean()))
    long = motion.npts >= _MANY
    offset = long and mean > _OFFSET * motion.pga
    with_ends = long and not offset
    first, last = np.abs(motion.acceleration[[0, -1]]) / max(motion.pga, 1e-300)
    if peak > _NONSENSE:
        raise text.fault(
            f"the largest value is {peak:.3g} g, which is not a ground acceleration; the"
            " file is damaged, fetch it again"
        )
    doubts = {
        f"the mean is {mean / max(motion.pga, 1e-300):.2g} of the peak: an offset of the"
        " instrument? Correct the record": offset,
        f"the first value is {first:.2g} of the peak: the beginning of the motion is not"
        " in the file": with_ends and first > _AT_REST,
        f"the last value is {last:.2g} of the peak: the end of the motion is not in the"
        " file": with_ends and last > _AT_REST,
        f"dt = {motion.dt:g} s is unusual for an accelerograph ({_FINEST:g} s to"
        f" {_COARSEST:g} s): check the time step": not _FINEST <= motion.dt <= _COARSEST,
        f"PGA = {peak:.3g} g is beyond any recorded earthquake: check the units": peak
        > _STRONGEST,
        f"PGA = {peak:.3g} g is weaker than can be felt: check the units": peak
        < _WEAKEST,
    }
    told = (doubt for doubt, doubtful in doubts.items() if doubtful)
    return replace(motion, warnings=(*motion.warnings, *told))


def contents(path: Path) -> tuple[Channel, ...]:
    """The channels of a file that is recognised as a record; empty for others."""
    if path.suffix.lower() in _OTHER_QUANTITIES:
        return ()
    try:
        state = path.stat()
    except OSError:
        return ()
    return _contents(path, state.st_mtime_ns, state.st_size)


@lru_cache(maxsize=4096)
def _contents(path: Path, _changed: int, _size: int) -> tuple[Channel, ...]:
    form = None
    with suppress(RecordError):
        text = read_text(path, Source(FILE, str(path), {}))
        form = _by_content(text)
    if form is None:
        return ()
    try:
        own = form.contents
        return tuple(own(text) if own else [Channel(recording=form.read(text).recording)])
    except RecordError:
        return (Channel(),)  # told where it is read


def _in_order() -> Iterator[RecordFormat]:
    yield from _OURS
    yield from (form for _, form in FORMATS.theirs())
    yield _PLAIN


def _by_content(text: RecordText) -> RecordFormat | None:
    for form in _in_order():
        with suppress(PluginError):  # a fault of one format is none of other files
            if form.recognises(text):
                return form
    return None
