"""The text of a record file, with what the user said of it, and the time step of its samples."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError, stem_of
from rpscli.records.quantities import KNOWN_UNITS, canonical_unit, last_digit, unit_factor

_BINARY_KINDS = {
    b"PK\x03\x04": "a ZIP archive; unpack it first",
    b"\x1f\x8b": "a gzip archive; unpack it first",
    b"\x89HDF": "an HDF5 file; export the record as text",
    b"%PDF": "a PDF document",
    b"\x89PNG": "a picture",
    b"\xd0\xcf\x11\xe0": "an old Excel or Word file; save the sheet as CSV",
}
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_SPREADSHEET = re.compile(rb"\APK\x03\x04.*?(?:xl/|opendocument\.spreadsheet)", re.DOTALL)
_SHEET = "a spreadsheet under another name; save the sheet as CSV"
_HEADER_WIDTH = 1000  # letters
_LARGEST_FILE = 200_000_000  # bytes; a day at a hundred samples a second has a tenth
_SHORTEST_STEP, _LONGEST_STEP = 1e-6, 100.0  # s
_MARKUP = re.compile(rb"\s*<(?:!doctype|html|head|\?xml)", re.IGNORECASE)


@dataclass(frozen=True)
class RecordText:
    """Lines of a record file, and the options that came with its source."""

    path: Path
    """Where the lines were read."""
    source: str
    """The source as the user wrote it."""
    lines: tuple[str, ...]
    """Without line ends; a stray carriage return counts as part of a line end."""
    dt: float | None = None
    """Sampling interval that the user gave [s]."""
    units: str | None = None
    """Canonical unit of acceleration that the user gave."""
    channel: str | None = None
    """The channel wanted from a file that holds several: its number, from 1, or its name."""

    @cached_property
    def heads(self) -> tuple[str, ...]:
        """The lines as far as a header goes, so that searching them takes a bounded time."""
        return tuple(line[:_HEADER_WIDTH] for line in self.lines)

    @property
    def name(self) -> str:
        """File name without its extension, and the channel if one was asked for."""
        if self.channel is None:
            return stem_of(self.path)
        return f"{stem_of(self.path)}_ch{re.sub(r'[^A-Za-z0-9]+', '_', self.channel[:40])}"

    def fault(self, message: str, line: int | None = None) -> RecordError:
        """An error that names this file and, if given, the line (counted from zero)."""
        place = f"{self.path}" if line is None else f"{self.path}:{line + 1}"
        return RecordError(f"{place}: {message}")

    def agreed_factor(self, stated: str | None, header: str = "") -> tuple[str, float]:
        """The unit of the values and its size in m/s2, from the file or from the user."""
        if stated is None and self.units is None:
            raise self.fault(
                f"the file does not state the units of its values"
                f"{f' (its header: {header[:60]!r})' if header else ''} and none were given; say "
                f"?units=g (or another of {KNOWN_UNITS}) after the file name, "
                f"or write a header line 'units: g'"
            )
        unit = stated or self.units
        assert unit is not None
        if self.units is not None and unit_factor(self.units) != unit_factor(unit):
            raise self.fault(
                f"units = {self.units} contradicts the file, which says {unit}; leave the units "
                f"out, or correct the file if its header is wrong"
            )
        return unit, unit_factor(unit)

    def agreed_dt(self, stated: float | None, tolerance: float = 1e-9) -> float:
        """The sampling interval [s], from the file or from a user who does not contradict it."""
        if stated is None and self.dt is None:
            raise self.fault(
                "the file does not state its sampling interval and none was given; say "
                "?dt=0.005 after the file name, or write a header line 'dt: 0.005'"
            )
        dt = stated if self.dt is None else self.dt
        assert dt is not None
        if dt <= 0.0:
            raise self.fault(f"dt = {dt} s must be positive")
        if not _SHORTEST_STEP <= dt <= _LONGEST_STEP:
            raise self.fault(
                f"dt = {dt:g} s cannot be the time step of an acceleration record, which lies"
                f" between {_SHORTEST_STEP:g} s and {_LONGEST_STEP:g} s; correct the file or ?dt="
            )
        if stated is not None and abs(dt - stated) > tolerance * dt:
            raise self.fault(
                f"dt = {dt} s contradicts the file, which says {stated} s; leave dt out, "
                f"or correct the file if its header is wrong"
            )
        return dt

    def single_channel(self) -> None:
        """Refuse a channel number: the format holds one channel."""
        if self.channel is not None:
            raise self.fault(
                f"channel = {self.channel[:60]}: this file holds one channel; leave it out"
            )


def read_text(
    path: Path,
    source: str,
    *,
    dt: float | None = None,
    units: str | None = None,
    channel: str | None = None,
) -> RecordText:
    """Read a record file as text."""
    unit = None if units is None else canonical_unit(units)
    if units is not None and unit is None:
        raise RecordError(f"{source}: units = {units!r} is not known; use one of {KNOWN_UNITS}")
    try:
        if (size := path.stat().st_size) > _LARGEST_FILE:
            raise RecordError(
                f"{path}: {size / 1e6:.0f} MB are more than a record has (at most"
                f" {_LARGEST_FILE / 1e6:.0f} MB); cut out the strong motion"
            )
        data = path.read_bytes()
    except OSError as error:
        raise RecordError(f"{path}: cannot be read: {error.strerror}") from error
    if not data.startswith(_UTF_16):
        data = data.rstrip(b"\0")  # padding of old systems
    _refuse_foreign(path, data)
    text = re.sub(r"\r+\n?", "\n", _decoded(data)).rstrip("\x1a\n")
    if not text.strip():
        raise RecordError(
            f"{path}: the file is empty; fetch it again, or export the record as text"
        )
    return RecordText(path, source, tuple(text.split("\n")), dt, unit, channel)


def _refuse_foreign(path: Path, data: bytes) -> None:
    for magic, kind in _BINARY_KINDS.items():
        if data.startswith(magic):
            sheet = _SPREADSHEET.search(data)
            raise RecordError(f"{path}: not a record but {_SHEET if sheet else kind}")
    if _MARKUP.match(data.removeprefix(b"\xef\xbb\xbf")):
        raise RecordError(
            f"{path}: not a record but a web page, perhaps the log-in page of the database; "
            f"download the record itself"
        )
    if b"\x00" in data and not data.startswith(_UTF_16):
        raise RecordError(f"{path}: not a text file; export the record as text")


def _decoded(data: bytes) -> str:
    if data.startswith(_UTF_16):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:  # station names of older files; every byte is a Latin-1 letter
        return data.decode("latin-1")


_SUMMED = (1e-6, 1e-3)
"""Shares of a step by which times may be off besides their rounding, from summing steps in double
and in single precision."""

_COARSEST = 0.25
"""Share of a step beyond which rounding can no longer tell uniform times from others."""


def printed_resolution(
    printed: NDArray[np.float64], numerals: Iterable[str]
) -> NDArray[np.float64]:
    """The unit of the last digit of each time of a column, dropped zeros included."""
    # Of so many decimals or significant digits: one a decade, and growing by no more than ten.
    times = np.abs(printed)
    units = np.fromiter(map(last_digit, numerals), dtype=np.float64, count=times.size)
    decades = np.floor(np.log10(np.maximum(times, 1e-12)))
    result = np.empty_like(units)
    finest = math.inf
    for decade in np.unique(decades[times > 0.0]):
        inside = decades == decade
        finest = min(10.0 * finest, float(units[inside].min()))
        result[inside] = finest
    result[times == 0.0] = result[times > 0.0].min(initial=1.0)
    return result


def uniform_step(times: NDArray[np.float64], resolution: NDArray[np.float64] | float) -> float:
    """The step of uniform times, the shortest decimal number that fits all of them."""
    steps = np.diff(times)
    if not steps.min() > 0.0:
        after = int(np.argmin(steps)) + 1
        raise ValueError(
            f"the times do not increase after sample {after}; sort them, or print more digits"
        )
    typical = _median(steps)
    rounding = np.minimum(0.5 * np.asarray(resolution), _COARSEST * typical)
    for summed in _SUMMED:
        step = _shortest_step(times, rounding + summed * typical)
        if step is not None:
            return step
    off = np.abs(steps - typical)
    first = int(np.argmax(off > 0.5 * off.max()))
    raise ValueError(
        f"the step after sample {first + 1} is {steps[first]:.6g} s, most others {typical:.6g} s;"
        " resample the record to a uniform step first"
    )


def _median(values: NDArray[np.float64]) -> float:
    # What numpy's function gives, without the masked arrays that it imports.
    ordered = np.sort(values)
    return 0.5 * float(ordered[(values.size - 1) // 2] + ordered[values.size // 2])


def _shortest_step(times: NDArray[np.float64], allowance: NDArray[np.float64]) -> float | None:
    # Each time bounds the step from both sides; the bounds close in as the samples go on.
    allowance = np.broadcast_to(allowance, times.shape)
    count = np.arange(1, times.size)
    elapsed = times[1:] - times[0]
    either = allowance[1:] + (allowance[0] if times[0] else 0.0)  # a printed zero is exact
    lowest = float(np.max((elapsed - either) / count))
    highest = float(np.min((elapsed + either) / count))
    if not 0.0 < lowest <= highest:
        return None
    middle = 0.5 * (lowest + highest)
    candidates = (round(middle, decimals) for decimals in range(17))
    return next((step for step in candidates if lowest <= step <= highest), middle)
