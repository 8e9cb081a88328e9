"""Formats of the agencies that record earthquakes, as data, and the
one reader of all of them.

Corrected acceleration of COSMOS version 1, volume 2 of CSMIP and of GeoNet, SMC files of
the USGS, K-NET and KiK-net, ESM and ITACA (DYNA 1.x). A file holds one channel, or
several one after the other: a header, perhaps blocks of numbers, and the values.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from rpscli.records.formats.record_text import MOST_VALUES, Channel, RecordText, Stated
from rpscli.records.formats.statements import Statement, statements
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN

Said = dict[str, Statement]  # statements of a header, by the names of `Layout.says`


class Words(NamedTuple):
    """The words of a header for one thing: its name in messages, and
    the pattern of the line.
    """

    name: str
    pattern: str


@dataclass(frozen=True)
class Layout:
    """A format: how a channel begins, what its header says, and
    how the values are written.

    `begins` is the first line of a file, and of each channel in it, `corrected` that of a
    channel that can be read, `refusal` the message where others are possible. `header` is
    the number of its lines, or the line that announces the values, its last one. It
    `says` the `count`, `step` [s], `rate` [1/s], `duration` [s], `unit`, `peak`,
    `quantity` and `scale`, which may all be said again, alike, the `place` of the
    station, and what a `Recording` has; for what is `needed` of these, and missing,
    `lacks` is the message. `label` is the number and name of a channel in its header,
    empty for formats with one channel; `unit` that of all files, and `width` that of a
    row, None where the header says it. There may be several `series` of one length,
    without a line between, the first one acceleration; a line `ends` them. `numbers`
    reads the blocks of numbers before or behind the last line of the header, adds what
    they say, and tells where the values begin. Values are `centred` if they have the
    offset of the sensor, which is removed, and that is said.
    """

    name: str
    extensions: tuple[str, ...]
    begins: str
    header: int | str
    says: Mapping[str, Words]
    needed: tuple[str, ...]
    lacks: str = "the header lacks {}; fetch the file again"
    corrected: str = ""
    refusal: str = ""
    label: str = ""
    unit: str | None = None
    width: int | None = None
    series: int = 1
    ends: str | None = None
    numbers: Callable[[RecordText, int, Said], int] | None = None
    centred: bool = False

    def recognises(self, text: RecordText) -> bool:
        """True for a file that begins like one of this format."""
        return (
            re.match(self.begins, "\n".join(text.heads[:80]), re.IGNORECASE) is not None
        )

    def refused(self, text: RecordText) -> str:
        """The message for a file that holds no channel that can be read; else nothing."""
        found = self.channels(text)
        if found and re.match(self.corrected, text.heads[found[0].line], re.IGNORECASE):
            return ""
        return self.refusal.format(text.heads[0].partition("(")[0].strip()[:40])

    def contents(self, text: RecordText) -> list[Channel]:
        """Channels with what their headers state; of a file without any that can be read
        the reason.
        """
        if refusal := self.refused(text):
            return [Channel(refusal=refusal)]
        channels = self.channels(text)
        return [
            of._replace(recording=self.stated(text, of)[0].recording) for of in channels
        ]

    def channels(self, text: RecordText) -> list[Channel]:
        """Those that can be read."""
        if not self.label:
            return [Channel(1, 0, self.name)]
        found = list[Channel]()
        titles = (self.begins, self.corrected)
        for start, line in enumerate(text.heads):
            # Few of the many lines begin with a letter.
            if line[:1].isalpha() and all(
                re.match(of, line, re.IGNORECASE) for of in titles
            ):
                lines = text.heads[start : start + 20]
                matches = (re.search(self.label, each, re.IGNORECASE) for each in lines)
                match = next(filter(None, matches), None)
                number, label = match.groups() if match else ("", "unnamed")
                number = number if (number or "").isdigit() else f"{len(found) + 1}"
                found.append(Channel(int(number), start, " ".join(label.split())))
        return found

    def stated(self, text: RecordText, channel: Channel) -> tuple[Stated, int, Said]:
        """The statements of the header of a channel, and the
        line where its values begin.
        """
        start = channel.line
        heads = text.heads
        first = end = start + self.header if isinstance(self.header, int) else -1
        if isinstance(self.header, str):
            begins = re.compile(self.header, re.IGNORECASE).match
            end = next((at for at in range(start, len(heads)) if begins(heads[at])), -1)
            first = end + 1
            if end < 0:
                raise text.fault(self.lacks.format("the values"), start)
        said = Said()
        lines = [*enumerate(heads[start : end + 1], start)]
        for name, words in self.says.items():
            found = statements(*words, lines)
            said.update((name, each) for each in found[:1])
            if name not in Recording._fields:
                text.agreed(found, lambda each: each.value)
        if missing := [self.says[name].name for name in self.needed if name not in said]:
            raise text.fault(self.lacks.format(", ".join(missing)), start)
        if self.numbers is not None:
            first = self.numbers(text, end, said)
        return self._meant(text, said, channel), first, said

    def _meant(self, text: RecordText, said: Said, channel: Channel) -> Stated:
        """The statements as values."""
        unit = text.unit([said["unit"]]) if "unit" in said else self.unit
        if "quantity" in said and said["quantity"].value.upper() != "ACCELERATION":
            kind = said["quantity"].value.lower()
            raise text.fault(f"the file holds {kind}; give the acceleration (.ACC.) file")
        step = text.step(said["step"]) if "step" in said else None
        if "rate" in said:
            step = 1.0 / text.number(said["rate"], positive=True)
        known = {name: said[name].value for name in Recording._fields if name in said}
        if "date" in said:
            known["origin"] = " ".join(
                [said["date"].value, known.get("origin", "")]
            ).strip()
        if self.label:
            known["direction"] = channel.label.partition("(")[0].strip()
        recording = Recording(**known)  # type: ignore[arg-type]
        if "magnitude" in said:
            recording = recording._replace(magnitude=text.number(said["magnitude"]))
        return Stated(
            unit, step, 0.0, said.get("duration"), said.get("peak"), recording=recording
        )

    def read(self, text: RecordText) -> GroundMotion:
        """The acceleration of one channel."""
        if not self.label:
            text.single_channel()
        if self.recognises(text) and (refusal := self.refused(text)):
            raise text.fault(refusal, 0)
        channel = text.chosen(self.channels(text))
        stated, first, said = self.stated(text, channel)
        width = self.width or (int(said["width"].value) if "width" in said else None)
        count = text.count(said["count"])
        rows = -(-count // (width or 1))
        begin = [first + place * rows for place in range(self.series)]
        (values, _), *_ = (
            text.series(start, count, width=width, stop=stop, closed_by=self.ends)
            for start, stop in zip(begin, [*begin[1:], None], strict=True)
        )
        of = stated.recording
        place = said["place"].value if "place" in said else ""
        words = [
            of.event,
            of.origin,
            " ".join(filter(None, (of.station, place, of.direction))),
        ]
        if self.label:
            words.append(f"channel {channel.number}, {channel.label}")
        name = ""
        if "scale" in said:  # such as `3920(gal)/6182761`
            if (
                match := re.fullmatch(r"(.*)\(gal\)\s*/(.*)", said["scale"].value)
            ) is None:
                raise text.fault(
                    "the header lacks Scale Factor in the form of K-NET; fetch it again",
                    said["scale"].line,
                )
            parts = (said["scale"]._replace(value=part) for part in match.groups())
            gal, counts = (text.number(part, positive=True) for part in parts)
            values = values * (gal / counts)
        if self.centred:
            mean = float(values.mean())
            values = values - mean
            words.append(f"mean of {mean:.4g} {stated.unit} removed")
            name = text.path.name.replace(".", "_")  # the extension tells the component
        return text.motion(
            stated, values, self.name, "; ".join(filter(None, words)), name=name
        )


_NUMBER = rf"({NUMBER_PATTERN})"
_UNIT = rf"({UNIT_PATTERN})"
_MAGNITUDE = (
    rf"^(?:.*\bM(?:oment Mag|w)|(?!.*\bM(?:oment Mag|w)\s*=).*\bMl)\s*=\s*{_NUMBER}"
)
"""That of the moment, or the local one."""
_UNKNOWN = -999.0  # of COSMOS


def _cosmos_numbers(text: RecordText, end: int, said: Said) -> int:
    """Interval and peak are real-header values 62 and 64."""
    reals: list[float] = []
    for index in range(end, -1, -1):
        line = text.heads[index]
        if re.match(COSMOS.begins, line, re.IGNORECASE):
            break
        announced = re.match(r"\s*(\d+)\s+Real-header values follow", line, re.IGNORECASE)
        if announced:
            count = text.count(Statement("real-header values", announced[1], index))
            words = r"\s*(?:\|.*|.*[A-Za-z]{3})"
            reals = text.series(index + 1, count, closed_by=words)[0].tolist()
            break
    if len(reals) < 64 or reals[61] <= 0.0:
        raise text.fault(
            "real-header value 62, the sampling interval in ms, is missing; fetch the"
            " file again"
        )
    said["step"] = Statement("real-header value 62", f"{reals[61]} ms", end)
    if reals[63] != _UNKNOWN:
        said["peak"] = Statement("real-header value 64", f"{reals[63]}", end)
    return end + 1


def _smc_numbers(text: RecordText, end: int, said: Said) -> int:
    """48 integers and 50 reals, then comments."""
    integers, _ = text.series(end, 48, stop=end + 6)
    reals, _ = text.series(end + 6, 50, stop=end + 16)
    comments = int(integers[15])
    count = int(integers[16])
    rate = reals[1]
    if not (0 <= comments < MOST_VALUES and 0 < count < MOST_VALUES and 0.0 < rate < 1e4):
        raise text.fault(
            f"the headers give {count} values, {rate:g} a second, {comments} comments,"
            " which no record has; fetch the file again"
        )
    peak = max(abs(reals[29]), abs(reals[31]))
    for name, value in {"count": count, "rate": rate, "peak": peak}.items():
        said[name] = Statement(name, f"{value}", end)
    return end + 16 + comments


def _knet_numbers(text: RecordText, end: int, said: Said) -> int:
    """Their number is that of samples in the stated duration;
    KiK-net numbers its directions.
    """
    duration = said.pop("duration")
    rate = text.number(said["rate"], positive=True)
    count = text.number(duration, positive=True) * rate
    if not 0.5 < count < MOST_VALUES:
        raise text.fault(
            f"{duration.value} s at {rate:g} Hz are {count:.3g} values, which is more or"
            " less than a record can have; correct the header",
            duration.line,
        )
    said["count"] = duration._replace(value=f"{round(count)}")
    if origin := said.get("origin"):  # all their times are those of Japan
        said["origin"] = origin._replace(value=f"{origin.value} JST")
    if (direction := said.get("direction")) and direction.value in "123456":
        place = int(direction.value) - 1
        said["direction"] = direction._replace(value=("N-S", "E-W", "U-D")[place % 3])
        if place < 3 and "station" in said:
            said["station"] = said["station"]._replace(
                value=f"{said['station'].value} borehole"
            )
    return end


def _keys(behind: str, **names: str) -> dict[str, Words]:
    """Lines of a key, what stands behind it, and a value."""
    return {
        field: Words(key, rf"^{re.escape(key)}{behind}\s*(\S.*?)(?:\s*Hz)?\s*$")
        for field, key in names.items()
    }


COSMOS = Layout(
    "COSMOS v1",
    (".v1", ".v1c", ".v2c"),
    begins=r".*?\(Format v0?1\.",
    corrected="Corrected acceleration",
    refusal=(
        "the file holds {!r}; only corrected acceleration can be read, usually the file"
        " ending in .v1 or .V2c"
    ),
    header=rf"\s*\d+\s+acceleration p(?:oin)?ts.*?units\s*=\s*{_UNIT}",
    label=r"^Sta Cha[n:]?\s*(\d+|\?)?\s*:\s*(\S.*)",
    says={
        "count": Words("acceleration points", r"^\s*(\d+)\s+acceleration p(?:oin)?ts"),
        "unit": Words("units", rf"acceleration p(?:oin)?ts.*?units\s*=\s*{_UNIT}"),
        "width": Words("Format", r"acceleration p.*Format\s*=\s*\(\s*([1-9]\d?)[A-Z]"),
        "duration": Words("approx", rf"acceleration p.*\bapprox\s+{_NUMBER}\s*secs"),
        "station": Words("Code", r"^Statn No:.*?\bCode:\s*(\S+)"),
        "place": Words("place", r"^Statn No:.*?\bCode:\s*\S+\s+(\S.*)"),
        "event": Words("event", r"^(?:Rcrd|Record) of\s+(\S.*?\bEarthquake\b.*?)\s*$"),
        "origin": Words("Origin", r"^Origin:\s*(\d[\d/, :.]*)"),
        "start": Words("start time", r"^Rcrd start time:\s*(\d[\d/, :.]*)"),
        "magnitude": Words("M", _MAGNITUDE),
    },
    needed=("count",),
    lacks="no line announces acceleration values in a known unit",
    ends=r"\s*\||/&|End.of.data|.*\(Format v0?1\.|\s*\d+\s+[a-z]+ p(?:oin)?ts",
    numbers=_cosmos_numbers,
)

_ACCEL = r"POINTS OF ACCEL DATA EQUALLY SPACED AT"
CSMIP = Layout(
    "CSMIP volume 2",
    (".v2",),
    begins=r"CORRECTED ACCELEROGRAM\b.*\bCHAN\s+\d|UNCORRECTED ACCELEROGRAM\b|\* VOL1DS",
    corrected=r"CORRECTED ACCELEROGRAM\b.*\bCHAN\s+\d{1,9}:\s*\S",
    refusal=(
        "the file holds an uncorrected accelerogram (volume 1); give the corrected one"
        " of volume 2, usually the file ending in .V2"
    ),
    header=rf"\s*\d+\s+{_ACCEL}\s+{NUMBER_PATTERN}\s*SEC.*?(?:UNITS:|,\s*IN)\s*{_UNIT}",
    label=r"\bCHAN\s+(\d{1,9}):\s*(\S.*?)\s*(?:FROM)?\s*$",
    says={
        "count": Words("POINTS OF ACCEL DATA", rf"^\s*(\d+)\s+{_ACCEL}"),
        "step": Words("the spacing of the data", rf"{_ACCEL}\s+{_NUMBER}\s*SEC"),
        "unit": Words("UNITS", rf"{_ACCEL}.*?(?:UNITS:|,\s*IN)\s*{_UNIT}"),
        "peak": Words("PEAK ACCELERATION", rf"PEAK ACCELERATION\s*=\s*{_NUMBER}"),
        "station": Words("STATION", r"^STATION (?:NO|ID)\.\s*(\S+)"),
        "place": Words("place", r"^\d\S*\s+(\S.*?)\s+CHAN\s+\d+:"),
        "event": Words("event", r"^((?!UNCORRECTED).*\bEARTHQUAKE\b.*?)\s*$"),
        "origin": Words("ORIGIN", r"\(ORIGIN[^:]*:\s*(\d[\d/, :.]*)"),
        "start": Words("start time", r"(?:TRIGGER|START) TIME:\s*(\d[\d/, :.-]*)"),
        "magnitude": Words("M", _MAGNITUDE),
    },
    needed=("count", "step"),
    lacks="no line announces the acceleration data of this channel",
    width=8,
    ends=r"\s*\d+ POINTS OF |/&|CORRECTED ACCELEROGRAM\b",
)

GEONET = Layout(
    "GeoNet volume 2",
    (".v2a",),
    begins=r"Corrected accelerogram\b(?!.*\b(?:CHAN|COMP|FILE)\s+\S)",
    corrected=r"Corrected accelerogram\b",
    refusal="the file is {!r}; only corrected accelerograms can be read",
    header=26,  # ten rows of numbers included
    label=r"^()Component\s+(\S+)",
    says={
        "count": Words("Number of points", r"^Number of points\s+(\d+)"),
        "step": Words(
            "the interval of the data", rf"data at\s+{_NUMBER}\s*sec intervals"
        ),
        "duration": Words("Duration", rf"\bDuration\s+{_NUMBER}\s*sec"),
        "peak": Words("peak", rf"^Acceleration:\s*peak\s+{_NUMBER}"),
        "unit": Words("unit", rf"^Acceleration:\s*peak\s+{NUMBER_PATTERN}\s*{_UNIT}"),
        "station": Words("Site", r"^Site\s+(\S+)"),
        "event": Words("event", r"^(\d+ km [\w-]+ of \S.*?)\s*$"),
        "origin": Words("origin", r"^(\d{4}\s+[A-Z][a-z]+\s+\d+\s+\d+:\d+:\d+)\s+UT"),
        "start": Words("Accelerogram", r"^Accelerogram\s+(\d{8}_\d{6})"),
        "magnitude": Words("M", rf"\bM[A-Z]?\s+{_NUMBER}\s*$"),
    },
    needed=("count", "step", "peak", "unit"),
    lacks="the header lacks the number of points, the interval or the peak acceleration",
    width=10,
    series=3,
    ends=r"Corrected accelerogram\b",
)

KNET = Layout(
    "K-NET ASCII",
    tuple(f".{way}{place}" for place in ("", "1", "2") for way in ("ns", "ew", "ud")),
    begins=r"Origin Time(?=[\s\S]*Scale Factor)",
    header=17,
    says=_keys(
        r"(?=\s)",
        rate="Sampling Freq(Hz)", duration="Duration Time(s)", scale="Scale Factor",
        peak="Max. Acc. (gal)", station="Station Code", direction="Dir.", origin="Origin Time",
        start="Record Time", magnitude="Mag.",
    ),
    needed=("rate", "duration", "scale"),
    unit="gal",
    width=8,
    numbers=_knet_numbers,
    centred=True,
)  # fmt: skip

ESM = Layout(
    "ESM ASCII",
    (".asc",),
    begins=r"[A-Z][A-Z0-9_/^]*:(?=[\s\S]*\nSAMPLING_INTERVAL_S)",
    header=r"(?![A-Z][A-Z0-9_/^]*:)",
    says=_keys(
        ":",
        step="SAMPLING_INTERVAL_S", count="NDATA", unit="UNITS", quantity="DATA_TYPE",
        duration="DURATION_S", peak="PGA_CM/S^2", station="STATION_CODE", direction="STREAM",
        event="EVENT_NAME", origin="EVENT_TIME_HHMMSS", date="EVENT_DATE_YYYYMMDD",
        start="DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS",
    ) | {"magnitude": Words("MAGNITUDE", rf"^MAGNITUDE_[WL]:\s*{_NUMBER}")},
    needed=("step", "count", "unit"),
    width=1,
    numbers=lambda _text, end, _said: end,  # the line behind the keys is the first value
)  # fmt: skip

SMC = Layout(
    "SMC",
    (".smc",),
    begins=r"\s*[1-5]\s+(?:UNCORRECTED|CORRECTED|VELOCITY|DISPLACEMENT|RESPONSE)\b",
    corrected=r"\s*2\s+CORRECTED",
    refusal="the file is {!r}; only '2 CORRECTED ACCELEROGRAM' can be read",
    header=11,
    says={
        "station": Words("station", r"^station\s*=\s*(\S.*?)\s*component\s*="),
        "direction": Words("component", r"\bcomponent\s*=\s*(\S.*?)\s*$"),
        "origin": Words("origin", r"^\s*(\d{4}\s+\d+\s+\d+\s+\d{4})\s"),
        "event": Words("event", r"^\s*\d{4}\s+\d+\s+\d+\s+\d{4}\s+(\S.*?)\s*$"),
        "magnitude": Words("M", _MAGNITUDE),
    },
    needed=(),
    unit="cm/s2",
    width=8,
    numbers=_smc_numbers,
)

LAYOUTS = (COSMOS, CSMIP, GEONET, KNET, ESM, SMC)  # in the order of recognition
