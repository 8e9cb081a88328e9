"""The text of a record file, and what its header states: numbers,
channels, rows of values.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError, stem_of
from rpscli.records.formats.statements import Statement, unit_behind, whole_number
from rpscli.records.ground_motion import UNKNOWN, GroundMotion, Recording
from rpscli.records.quantities import (
    ACCELERATIONS,
    KNOWN_UNITS,
    NUMBER_PATTERN,
    TIME_UNITS,
    UNIT_PATTERN,
    canonical_unit,
    last_digit,
    numbers_in,
    to_float,
    why_no_numbers,
)
from rpscli.records.source import Source
from rpscli.records.words import LIMITS, look_alikes, speaks_of

Array = NDArray[np.float64]
Meant = TypeVar("Meant")

_BEHIND_A_UNIT = re.compile(
    r"\s*[\])]?\s*(?:$|[,;.:|#]|[(\[][^)\]0-9]*[)\]]|[A-Za-z_]+[\w\s.]{0,20}[=:]"
    r"|-\s*[A-Za-z])"
)
"""What may stand behind a unit: the end, a bracket without numbers, another key."""
_MULTIPLE = re.compile(
    r"(?<![?&])\b(?:scale|scaling|multipl\w*|conversion|calibration|gain|factor)\b"
    rf"[^=:?&\d]{{0,24}}(?:[=:]|\s)\s*({NUMBER_PATTERN})(?![\d:/-])",
    re.IGNORECASE,
)
"""A factor on the values."""

_JOINING = {
    "and",
    "with",
    "for",
    "at",
    "in",
    "units",
    "unit",
    "format",
    "points",
    "apart",
}
"""Words that go on with a sentence behind a time step."""

MOST_VALUES = 10_000_000  # of one series: more than a day at a hundred samples a second
_SHOWN = 40  # letters of a value in a message
_HEADER_WIDTH = 1000  # letters
_LARGEST_FILE = 200_000_000  # bytes; a day at a hundred samples a second has a tenth
_SHORTEST_STEP = 1e-6  # s
_LONGEST_STEP = 0.5


class Channel(NamedTuple):
    """A channel of a file: its number, the line where it begins, what it calls itself.

    Its header states a `recording`; `refusal` says why a file of a known format is not
    used, such as an uncorrected record.
    """

    number: int = 1
    line: int = 0
    label: str = ""
    recording: Recording = UNKNOWN
    refusal: str = ""


@dataclass(frozen=True)
class Stated:
    """All that a file says of its values; None where it is silent.

    `unit` is a canonical one of acceleration, `step` [s] that of the samples,
    `resolution` [s] what its printing leaves open, `peak` in a unit behind it
    or in that of the values.
    """

    unit: str | None = None
    step: float | None = None
    resolution: float = 0.0
    duration: Statement | None = None
    peak: Statement | None = None
    recording: Recording = UNKNOWN


STEP_REMEDY = (
    "or say the step, or what the columns are: ?columns=time,acceleration [UNIT]"
)
_MULTIPLE_OF_UNIT = re.compile(
    rf"(?<![\w.])({NUMBER_PATTERN})\s*\*?\s*({UNIT_PATTERN})", re.IGNORECASE
)


def _multiple_in(text: str) -> str:
    """The multiple of a known unit that a text names, else an example of one."""
    match = _MULTIPLE_OF_UNIT.search(text)
    unit = canonical_unit(match[2]) if match else None
    return f"{match[1]} {unit}" if match and unit else "0.001 g, for example"


@dataclass(frozen=True)
class RecordText:
    """Lines of a record file without their ends, and the options
    that came with its source.

    A stray carriage return counts as part of a line end. `dt` [s], the
    canonical unit `units`, the `channel`, its number, from 1, or its name, and titles
    of the `columns` are those that the user gave.
    """

    path: Path
    source: str
    lines: tuple[str, ...]
    dt: float | None = None
    units: str | None = None
    channel: str | None = None
    columns: str | None = None
    multiple: float | None = None
    dt_counts: bool = False
    """True if `dt` is given with its unit, and counts whatever the file says."""

    @cached_property
    def heads(self) -> tuple[str, ...]:
        """The lines as far as a header goes, so that searching
        them takes a bounded time.
        """
        return tuple(line[:_HEADER_WIDTH] for line in self.lines)

    @property
    def name(self) -> str:
        """File name without its extension, and the channel if one was asked for."""
        if self.channel is None:
            return stem_of(self.path)
        return (
            f"{stem_of(self.path)}_ch{re.sub(r'[^A-Za-z0-9]+', '_', self.channel[:40])}"
        )

    def fault(self, message: str, line: int | None = None) -> RecordError:
        """An error that names this file and, if given, the line (counted from zero)."""
        place = f"{self.path}" if line is None else f"{self.path}:{line + 1}"
        return RecordError(f"{place}: {message}")

    def agreed_factor(self, stated: str | None) -> tuple[str, float]:
        """The unit of the values and its size in m/s2, from the file or from the user."""
        if (unit := stated or self.units) is None:
            raise self.fault(
                "the file does not state the units of its values and none were given;"
                f" say ?units=g (or another of {KNOWN_UNITS}) after the file name, or"
                " write a header line 'units: g'"
            )
        if self.units is not None and ACCELERATIONS[self.units] != ACCELERATIONS[unit]:
            raise self.fault(
                f"units = {self.units} contradicts the file, which says {unit}; leave the"
                " units out, or correct the file if its header is wrong"
            )
        multiple = 1.0 if self.multiple is None else self.multiple
        return unit, multiple * ACCELERATIONS[unit]

    def agreed_dt(self, stated: float | None, tolerance: float = 1e-9) -> float:
        """The sampling interval [s], from the file or from a user
        who does not contradict it.
        """
        dt = stated if self.dt is None else self.dt
        stated = None if self.dt_counts else stated
        fault = ""
        if dt is None:
            raise self.fault(
                "the file does not state its sampling interval and none was given; say "
                "?dt=0.005 after the file name, or write a header line 'dt: 0.005'"
            )
        if dt <= 0.0:
            fault = " must be positive"
        elif not _SHORTEST_STEP <= dt <= _LONGEST_STEP:
            fault = (
                " cannot be the time step of an acceleration record, which lies between"
            )
            fault += (
                f" {_SHORTEST_STEP:g} s and {_LONGEST_STEP:g} s; correct the file or ?dt="
            )
        elif stated is not None and abs(dt - stated) > tolerance * dt:
            fault = (
                f" contradicts the file, which says {stated} s; leave dt out, or say"
                f" ?dt={dt:g} s if the file is wrong"
            )
        if fault:
            raise self.fault(f"dt = {dt} s{fault}")
        return dt

    def single_channel(self) -> None:
        """Refuse a channel number: the format holds one channel."""
        if self.channel is not None:
            raise self.fault(
                f"channel = {self.channel[:60]}: this file holds one channel; leave it"
                " out"
            )

    def chosen(self, channels: Sequence[Channel]) -> Channel:
        """The channel whose number the user asked for, or the only one."""
        if not channels:
            raise self.fault(
                "no series of accelerations begins in this file; if it is of another"
                " format than its name says, give it another ending (.txt for columns of"
                " numbers)"
            )
        listing = "; ".join(
            f"{channel.number}: {channel.label[:60]}" for channel in channels
        )
        if self.channel is None:
            if len(channels) == 1:
                return channels[0]
            raise self.fault(
                f"the file holds {len(channels)} channels; say which one by "
                f"?channel={channels[0].number} after the file name ({listing})"
            )
        asked = self.channel.strip().lower()
        shown = self.channel[:60]
        wanted = [
            of for of in channels if asked in (str(of.number), of.label.strip().lower())
        ]
        if not wanted:
            raise self.fault(f"there is no channel {shown}; the file has {listing}")
        if len(wanted) > 1:
            raise self.fault(f"channel {shown} comes {len(wanted)} times: {listing}")
        return wanted[0]

    def number(self, stated: Statement, *, positive: bool = False) -> float:
        """The finite number that a header states."""
        numeral = stated.value.strip()
        fault = ""
        shown = numeral[:_SHOWN]
        if re.fullmatch(r"[+-]?[0-9]*,[0-9]+", numeral):
            fault = f"{shown} has a decimal comma; write {shown.replace(',', '.')}"
            fault += " in the file, or say it behind its name, as in ?dt=0.005"
        elif not re.fullmatch(NUMBER_PATTERN, numeral) or not math.isfinite(
            to_float(numeral)
        ):
            fault = (
                f"{shown!r} is not a finite number; correct the header, or fetch the file"
                " again"
            )
        elif positive and to_float(numeral) <= 0.0:
            fault = f"{shown} must be positive; correct the header"
        if fault:
            raise self.fault(f"{stated.name} = {fault}", stated.line)
        return to_float(numeral)

    def count(self, stated: Statement) -> int:
        """The number of values that a header announces."""
        numeral = stated.value.strip().replace(",", "")
        count = int(numeral) if re.fullmatch("[0-9]{1,9}", numeral) else 0
        if not 0 < count <= MOST_VALUES:
            raise self.fault(
                f"{stated.name} = {numeral[:_SHOWN]!r} should be a number of values, a"
                f" whole number from 1 to {MOST_VALUES}; correct the header",
                stated.line,
            )
        return count

    def step(self, stated: Statement) -> float:
        """The time step that a header states [s]: its number, and
        perhaps a unit behind it.
        """
        number, _, unit = whole_number(stated.value).partition(" ")
        value = self.number(stated._replace(value=number), positive=True)
        factor = self.time_factor(unit, stated.line)
        return value if factor == 1.0 else float(f"{factor * value:.15g}")

    def understood_steps(self, said: Sequence[Statement]) -> list[Statement]:
        """Statements of the step; where the user gives it, only those that are clear."""
        if self.dt is None:
            return [*said]
        return [
            each
            for each in said
            if unit_behind(whole_number(each.value)) in TIME_UNITS
            and re.fullmatch(NUMBER_PATTERN, whole_number(each.value).partition(" ")[0])
        ]

    def refuse_multiples(self, lines: Sequence[tuple[int, str]], key: str) -> None:
        """Refuse a factor on the values, unless the user says what a value is."""
        if self.multiple is not None:
            return
        for index, line in lines:
            if speaks_of(line, LIMITS):
                continue  # the range of an instrument
            match = _MULTIPLE.search(line)
            found = match[1] if match and to_float(match[1]) != 1.0 else ""
            for unit in re.finditer(key, line, re.IGNORECASE):
                known = any(canonical_unit(group or "-") for group in unit.groups())
                if known and not _BEHIND_A_UNIT.match(line[unit.end() :]):
                    found = line[unit.end() :].strip()
            if found:
                raise self.fault(
                    f"{line.strip()[:60]!r} has {found[:20]!r} beside the unit, a"
                    f" factor on"
                    " the values perhaps; say what the values are in, as in"
                    " ?units=0.001 g"
                    " or ?units=1 g",
                    index,
                )

    def time_factor(self, unit: str, line: int, *, is_unit: bool = False) -> float:
        """The size of a unit of time [s]; words that join say nothing where none has to
        stand.
        """
        factor = TIME_UNITS.get(unit.strip(" .").lower())
        if factor is None and (is_unit or unit.strip(" .").lower() not in _JOINING):
            columns = "what the columns are: ?columns=time,acceleration [UNIT]"
            raise self.fault(
                f"a time in {unit[:_SHOWN]!r}{look_alikes(unit)} is not known; write s,"
                f" or ms, or say {columns if is_unit else 'the step: ?dt=0.005'}",
                line,
            )
        return factor or 1.0

    def agreed(
        self,
        said: Sequence[Statement],
        meaning: Callable[[Statement], Meant],
        remedy: str = "",
    ) -> Meant | None:
        """The meaning that several statements of a header
        share; None if there is none.
        """
        for other in said[1:]:
            if meaning(other) != meaning(said[0]):
                raise self.fault(
                    f"{other.name} = {other.value.strip()[:_SHOWN]} contradicts"
                    f" {said[0].name} = {said[0].value.strip()[:_SHOWN]} of line"
                    f" {said[0].line + 1}; correct the header{remedy}",
                    other.line,
                )
        return meaning(said[0]) if said else None

    def unit(self, statements: Sequence[Statement]) -> str | None:
        """The one unit of acceleration that several statements name."""
        if self.multiple is not None:  # the user says what a value is
            known = {unit for each in statements if (unit := canonical_unit(each.value))}
            return self.units if len(known) != 1 else known.pop()

        def meaning(each: Statement) -> str:
            if (unit := canonical_unit(each.value)) is None:
                raise self.fault(
                    f"{each.name} says {each.value.strip()[:_SHOWN]!r}"
                    f"{look_alikes(each.value)}, which is not a unit of acceleration that"
                    f" is known ({KNOWN_UNITS}); give the acceleration file, or say"
                    f" what a value is: ?units={_multiple_in(each.value)}",
                    each.line,
                )
            return unit

        first = canonical_unit(statements[0].value) if statements else None
        remedy = f", or say what a value is, as in ?units=1 {first}"
        return self.agreed(statements, meaning, remedy)

    def series(
        self,
        start: int,
        count: int,
        *,
        width: int | None = None,
        stop: int | None = None,
        closed_by: str | None = None,
    ) -> tuple[Array, int]:
        """Exactly `count` numbers of the lines from `start` on, and the line behind them.

        Rows but the last have `width` numbers, if that is given; blank lines are
        skipped. Behind the values stands the line `stop`, the end of the file, or a
        line `closed_by` a pattern.
        """
        values = list[float]()
        last = start
        index = start
        end = min(stop or len(self.lines), len(self.lines))
        while index < end and (row := numbers_in(self.lines[index])) is not None:
            short = width and values and len(values) % width
            if width and row and (short or len(row) > width):
                at, held = (last, len(values) % width) if short else (index, len(row))
                raise self.fault(
                    f"{held} value(s) in a row where the format has {width}; the file is"
                    " damaged, fetch it again",
                    at,
                )
            values += row
            index, last = index + 1, index if row else last
        line = "".join(self.lines[index : index + 1])
        ended = closed_by is not None and re.match(closed_by, line, re.IGNORECASE)
        if len(values) != count or not (index == end or ended):
            before = (
                f"{line.strip()[:_SHOWN]!r}{why_no_numbers(line)}" if line else "the end"
            )
            raise self.fault(
                f"the header announces {count} values, and {len(values)} stand before"
                f" {before}; keep one record in a file, fetch it again if it is damaged,"
                " or correct the count",
                min(index, len(self.lines) - 1),
            )
        return np.array(values), index

    def motion(
        self,
        stated: Stated,
        values: Array,
        form: str,
        words: str,
        *doubts: str,
        name: str = "",
    ) -> GroundMotion:
        """The motion of values in their unit, held against what
        the header states of them.
        """
        unit, factor = self.agreed_factor(stated.unit)
        tolerance = 0.51 * stated.resolution / stated.step if stated.step else 0.0
        dt = self.agreed_dt(stated.step, max(tolerance, 1e-9))
        if (said := stated.duration) is not None:
            off = abs(self.number(said) - (values.size - 0.5) * dt)
            if off > 0.51 * dt + last_digit(said.value):
                raise self.fault(
                    f"{said.name} = {said.value[:_SHOWN]} s, but {values.size} values"
                    f" {dt:g} s apart last {values.size * dt:g} s; correct the header,"
                    " or fetch the file again",
                    said.line,
                )
        if (said := stated.peak) is not None:
            numeral, _, own = said.value.replace(",", ".").partition(" ")
            of_peak = ACCELERATIONS[canonical_unit(own) or unit] / factor
            wanted = of_peak * abs(self.number(said._replace(value=numeral)))
            peak = float(np.max(np.abs(values)))
            if abs(peak - wanted) > 0.51 * of_peak * last_digit(numeral) + 1e-3 * wanted:
                doubts += (
                    f"the values peak at {peak:.6g} and the header says {wanted:.6g}",
                )
        # A file that was written by rps says the unit of the one before it too.
        each = unit if self.multiple is None else f"{self.multiple:g} {unit}"
        words = f"{re.sub('; values in [^;]*', '', words)}; values in {each}"
        return GroundMotion(
            values * factor, dt, name or self.name, self.source, form, words, doubts,
            stated.recording,
        )  # fmt: skip


_FOREIGN = {
    rb"PK\x03\x04.*?(?:xl/|opendocument\.spreadsheet)": "a spreadsheet under another name; save the"
    " sheet as CSV",
    rb"PK\x03\x04": "a ZIP archive; unpack it first",
    rb"\x1f\x8b": "a gzip archive; unpack it first",
    rb"\x89HDF": "an HDF5 file; export the record as text",
    rb"%PDF": "a PDF document",
    rb"\x89PNG": "a picture",
    rb"\xd0\xcf\x11\xe0": "an old Excel or Word file; save the sheet as CSV",
    rb"(?:\xef\xbb\xbf)?\s*<(?i:!doctype|html|head|\?xml)": (
        "a web page, perhaps the log-in page of the database; download the record itself"
    ),
}
_TYPESET = {
    0x2212: "-",
    0xA0: " ",
    **dict.fromkeys((0x200B, 0x200C, 0x200D, 0x2060, 0xFEFF)),
}
"""Minus signs and blanks as word processors set them."""
_PADDING = re.compile(rb"\0{2,}|\0\Z")  # of old systems, to the ends of their blocks


def _units_given(of: Source) -> tuple[str | None, float | None]:
    """The unit that the user gives, and the multiple of it where one is written."""
    units = of.values.get("units")
    if units is None:
        return None, None
    match = re.fullmatch(rf"\s*({NUMBER_PATTERN})?\s*(\D.*)", units)
    unit = canonical_unit(match[2]) if match else None
    multiple = to_float(match[1]) if match and match[1] else None
    if unit is None or multiple == 0.0:
        raise RecordError(
            f"{of}: units = {units!r} is not known; use one of {KNOWN_UNITS}, or a"
            " multiple, as in 0.001 g"
        )
    return unit, multiple


def read_text(path: Path, of: Source) -> RecordText:
    """Read a record file as text, with what its source says of it."""
    of.query("dt", "units", "channel", "columns")
    dt = of.quantity("dt", "time") if "dt" in of.values else None
    unit, multiple = _units_given(of)
    try:
        if (size := path.stat().st_size) > _LARGEST_FILE:
            raise RecordError(
                f"{path}: {size / 1e6:.0f} MB are more than a record has (at most"
                f" {_LARGEST_FILE / 1e6:.0f} MB); cut out the strong motion"
            )
        data = path.read_bytes()
    except OSError as error:
        raise RecordError(f"{path}: cannot be read: {error.strerror}") from error
    for pattern, kind in _FOREIGN.items():
        if re.match(pattern, data, re.DOTALL):
            raise RecordError(f"{path}: not a record but {kind}")
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        text = data.decode("utf-16", errors="replace")
    elif b"\0" in (data := _PADDING.sub(b"", data)):
        raise RecordError(f"{path}: not a text file; export the record as text")
    else:
        try:
            text = data.decode("utf-8-sig")
        except (
            UnicodeDecodeError
        ):  # station names of older files; all bytes are Latin-1 letters
            text = data.decode("latin-1")
    text = re.sub(r"\r+\n?", "\n", text).rstrip("\x1a\n").translate(_TYPESET)
    if not text.strip():
        raise RecordError(
            f"{path}: the file is empty; fetch it again, or export the record as text"
        )
    return RecordText(
        path,
        of,
        tuple(text.split("\n")),
        dt,
        unit,
        of.values.get("channel"),
        of.values.get("columns"),
        multiple,
        re.search(r"[^\W\d_]\s*$", of.values.get("dt") or "") is not None,
    )


_SUMMED = (1e-6, 1e-3)
"""Shares of a step by which times may be off besides their rounding, from summing steps
in double and in single precision."""

_COARSEST = 0.25
"""Share of a step beyond which rounding can no longer tell uniform times from others."""


def printed_resolution(printed: Array, numerals: Iterable[str]) -> Array:
    """The unit of the last digit of each time of a column, dropped zeros included."""
    # Of so many decimals or significant digits: one a decade, and growing by no more than
    # ten.
    units = np.fromiter(map(last_digit, numerals), dtype=np.float64, count=printed.size)
    decades = np.floor(np.log10(np.maximum(np.abs(printed), 1e-12)))
    finest = math.inf
    for decade in np.unique(decades[printed != 0.0]):
        inside = decades == decade
        finest = units[inside] = min(10.0 * finest, float(units[inside].min()))
    units[printed == 0.0] = units[printed != 0.0].min(initial=1.0)
    return units


def uniform_step(times: Array, resolution: Array | float) -> float:
    """The step of uniform times, the shortest decimal number that fits all of them."""
    steps = np.diff(times)
    if not steps.min() > 0.0:
        after = int(np.argmin(steps)) + 1
        raise ValueError(
            f"the times do not increase after sample {after}; sort them, or print more"
            " digits"
        )
    ordered = np.sort(steps)  # numpy's median imports masked arrays
    typical = 0.5 * float(ordered[(steps.size - 1) // 2] + ordered[steps.size // 2])
    rounding = np.minimum(0.5 * np.asarray(resolution), _COARSEST * typical)
    for summed in _SUMMED:
        # Each time bounds the step from both sides; the bounds close in as the samples go
        # on.
        allowance = np.broadcast_to(rounding + summed * typical, times.shape)
        either = allowance[1:] + (
            allowance[0] if times[0] else 0.0
        )  # a printed zero is exact
        elapsed = times[1:] - times[0]
        count = np.arange(1, times.size)
        lowest = float(np.max((elapsed - either) / count))
        highest = float(np.min((elapsed + either) / count))
        if 0.0 < lowest <= highest:
            middle = 0.5 * (lowest + highest)
            rounded = (round(middle, decimals) for decimals in range(17))
            return next((step for step in rounded if lowest <= step <= highest), middle)
    off = np.abs(steps - typical)
    first = int(np.argmax(off > 0.5 * off.max()))
    raise ValueError(
        f"the step after sample {first + 1} is {steps[first]:.6g} s, most others"
        f" {typical:.6g} s; resample the record to a uniform step first"
    )
