"""Statements of plain files' headers on the recording: station, earthquake, direction."""

from __future__ import annotations

import re
from collections.abc import Iterable

from rpscli.records.directions import direction_of, says_up
from rpscli.records.ground_motion import Recording
from rpscli.records.when import days_of, has_clock, seconds_of
from rpscli.records.words import (
    DATES,
    DIRECTIONS,
    EARTHQUAKES,
    OF_THE_FILE,
    ORIGINS,
    PLACES,
    STRUCTURES,
    TIMES,
    folded,
    says_free_field,
    says_structure,
    speaks_of,
    words_of,
)

_VALUE = r"\s*[:=]\s*([^;|#]*?)\s*(?=$|[;|#]|,\s*[A-Za-z ]+[:=])"
_KEYS = {
    "station": rf"(?<![?&])\bstation(?:[\s_]*(?:code|name|id|no\.?))?{_VALUE}",
    "direction": (
        rf"(?<![?&])\b(?:component|comp|direction|dir|orientation|azimuth"
        rf"|channel)\b\.?{_VALUE}"
    ),
    "event": rf"(?<![?&])\b(?:event|earthquake|eq)(?:[\s_]*name)?{_VALUE}",
    "origin": rf"(?<![?&])\b(?:origin(?:[\s_]*time)?|event[\s_]*(?:time|date)){_VALUE}",
    "start": r"(?<![?&])\b(?:start[\s_]*time"
    r"|time[\s_]*of[\s_]*first[\s_]*sample){_VALUE}",
}
"""Keys of header lines by the fields of a `Recording`."""


def without_recording(line: str) -> str:
    """A line without what it says of the station, the earthquake and times."""
    if titled_recording(line):
        return ""
    for name, pattern in _KEYS.items():
        if name != "direction":
            line = re.sub(pattern, ";", line, flags=re.IGNORECASE)
    return line


def recording_of(lines: Iterable[str]) -> Recording:
    """The recording that lines with keys describe, or a title as the PEER flatfiles have.

    A title is `event, date, station, direction`, or of the first collection `EVENT date
    time, STATION, direction (agency)`. What stands behind a key counts before it.
    """
    lines = [*lines]
    said: dict[str, str] = {}
    titled: Recording | None = None
    place = ""
    for line in lines:
        place = place or place_of(line)
        for name, pattern in _KEYS.items():
            match = re.search(pattern, line, re.IGNORECASE)
            if match and match[1] and name not in said:
                said[name] = match[1][:80]
        known = direction_of(said.get("direction", ""))
        if known is None or not known.vertical:
            way = upright_word(line) or ("direction" not in said and _direction(line))
            said |= {"direction": way} if way else {}
        for name, text in _of_the_event(line).items():
            said.setdefault(name, text)
        titled = titled or (None if said else titled_recording(line))
    if "origin" in said and not days_of(said["origin"]):
        del said["origin"]  # a clock time, whose date stands elsewhere
    if "origin" not in said and (titled is None or not titled.origin):
        found_time = _origin_among(lines)
        named = "event" in said or (titled is not None and titled.event)
        if not named or seconds_of(found_time.get("origin", "")) is not None:
            said |= found_time
    found = (titled or Recording())._replace(**said)  # type: ignore[arg-type]
    if place:
        found = found._replace(station=f"{found.station} {place}".strip())
    return found


_ID = re.compile(r"^\W*(EQID|RSN)\b[^\d\w]*(\d+)\W*$", re.IGNORECASE)
_KEYED = re.compile(r"^\W*([^\d:=]{2,40}?)\s*[:=]\s*(.*\S)")


def _of_the_event(line: str) -> dict[str, str]:
    """The earthquake under a key of another language, its time, or its number."""
    if match := _ID.match(line):
        return {"event": f"{match[1].upper()} {match[2]}"}
    match = _KEYED.match(line)
    if not match or not speaks_of(match[1], EARTHQUAKES):
        return {}
    value = match[2].strip()[:80]
    if seconds_of(value) is not None:
        return {"origin": value}
    numbered = "id" in folded(match[1])
    named = numbered or re.fullmatch(r"[^\W\d_].*", value)
    return {"event": value} if named else {}


def _origin_among(lines: Iterable[str]) -> dict[str, str]:
    """The time of the earthquake under a key of any language, perhaps in two lines."""
    date = ""
    clock = ""
    for line in lines:
        for part in line.split("|"):
            match = _KEYED.match(part)
            if match is None or speaks_of(match[1], OF_THE_FILE):
                continue
            value = match[2].strip()[:80]
            value += " local" * ("local" in folded(match[1]))
            of_it = speaks_of(match[1], ORIGINS)
            timed = seconds_of(value) is not None
            about = of_it or speaks_of(match[1], TIMES | DATES)
            if about and (timed or days_of(value)):
                if of_it or timed:
                    return {"origin": value}
                date = date or value
            elif speaks_of(match[1], TIMES | ORIGINS) and has_clock(value):
                clock = clock or value
    return {"origin": f"{date} {clock}".strip()} if date else {}


_DIP = re.compile(
    r"\bdip\b\s*[:=]?\s*[+-]?90\b"
    r"|(?<![\d.])[+-]?90(?:\.0*)?\s*(?:deg\w*\s*)?dip\b(?!\s*[:=\d])"
    r"|\bcmpinc\b\s*[:=]?\s*(?:0|180)(?:\.0*)?\b",
    re.IGNORECASE,
)
_WORD = re.compile(
    r"^\W*(?:dir\.|channel|component|comp\.?|direction|angle|inc\w*)\s+(\S{1,12})\s*$",
    re.IGNORECASE,
)
_NAMES = frozenset(
    (
        "station",
        "estacion",
        "stazione",
        "istasyon",
        "event",
        "earthquake",
        "deprem",
        "sismo",
    )
)
"""Words of keys that are followed by a name, whatever it means elsewhere."""
_BELOW = re.compile(
    r"bore-?hole|down-?hole|in-?hole|below\s+(?:the\s+)?ground|\bwithin\b.*rock"
    r"|rock.*\bwithin\b|\b(?:GL|elevation|level"
    r"|position)\s*[:=]?\s*-\s*[1-9][\d.]*\s*m?\b"
    r"|\bstation[\s_]*height\b[^\d-]*-\s*[1-9]"
    r"|\bpozo\b|\bpozzo\b|\bforage\b|bohrloch|sondaj|\bkuyu\w*|скважин|chichu|地中|井下",
    re.IGNORECASE,
)
_DEPTH = re.compile(
    r"(?:depth|derinlik\w*|tiefe|profond\w*|profund\w*|глубина|глубина|深さ|深度)\b(?:_m)?"
    r"\s*(?:[\[(]\s*m\s*[\])]\s*[:=]?\s*-?0*[1-9]|[\s:=]*-?0*[1-9][\d.]*\s*m\b"
    r"|_m\s*[:=]\s*-?0*[1-9])|_depth_m\s*[:=]\s*-?0*[1-9]"
    r"|(?:burial|sensor|instrument|installation)[\s_]*depth\s*[:=]\s*-?0*[1-9]"
)
"""A depth in metres; that of an earthquake is in km."""
_STRUCTURE = re.compile(
    r"[:=]\s*(?:\w+\s+)?(?:basement|roof|(?:\d+(?:st|nd|rd|th)\s+)?floor|storey|story"
    r"|penthouse|bodrum|cati|kat \d+|keller|dach|techo|sotano|azotea|tetto|toit|крыша"
    r"|подвал)\b"
    r"|^\W*(?:roof|basement)\W*$|[:=]\s*floor\s*[:=]?\s*\d|\bfloor\s*[:=]\s*\d"
    r"|\b\d+(?:st|nd|rd|th)\s+floor\b"
)
"""Places in a building."""
_OF_AN_EARTHQUAKE = re.compile(r"hypo|focal|event|source|epi")
_OF_THE_EARTHQUAKE = re.compile(
    r"hypo|ipoc|focal|foco|focus|event|source|epi|earthquake|deprem|sismo|\bkm\b|hodnot"
    r"|bedrock|basement rock|rock depth|filter|vs\d|velocity|model|soil|layer"
)


def place_of(line: str) -> str:
    """Where a line puts the instrument: in a borehole, in a building; else nothing."""
    plain = folded(line)
    match = re.match(r"^\W*([^:=]{2,40}?)\s*[:=]\s*(.*\S)", plain)
    station = match is not None and speaks_of(match[1], _NAMES)
    if station:
        plain = f": {plain.split()[-1]}"  # a name says it at its end: Roof Butte, AZ
    if _BELOW.search(plain) or (not station and _BELOW.search(line)):
        return "" if _OF_AN_EARTHQUAKE.search(plain) else "borehole"
    if _OF_THE_EARTHQUAKE.search(plain) or says_free_field(plain):
        return ""
    if _DEPTH.search(plain):
        return "borehole"
    inside = _STRUCTURE.search(plain) or (
        not station and match and _is_inside(*match.groups())
    )
    return "in a building" if inside else ""


def _is_inside(key: str, value: str) -> bool:
    """True of a key of places whose value is one in a structure, or a height above
    ground.
    """
    if not speaks_of(key, PLACES | STRUCTURES):
        return False
    height = re.search(r"height|above ground|elevation above", key) is not None
    return says_structure(value) or (
        height and bool(re.match(r"0*[1-9][\d.]* ?m\b", value))
    )


def upright_word(line: str) -> str:
    """The word of a line that says that the component is vertical; else nothing.

    It is the value of any key, or stands at the end of the line.
    """
    if _DIP.search(line):
        return "UP"
    for part in re.split(r"[;|\t]", line):
        key, mark, value = part.rpartition(":") if ":" in part else part.rpartition("=")
        if speaks_of(key, _NAMES) or not value.strip():
            continue
        inside = re.findall(r"[\[(]\s*([^\])]+?)\s*[\])]", value)
        bare = re.sub(r"[\[(].*?[\])]", " ", value).strip(" .,-")
        words = [bare, re.split(r"[\s,_]+", bare)[-1], *inside]
        if found := next(filter(says_up, words), ""):
            return found
        of_direction = speaks_of(key, DIRECTIONS) or not (mark or " " in bare)
        way = direction_of(bare) if of_direction else None
        if way is not None and way.vertical:
            return bare
    return ""


def _direction(line: str) -> str:
    """The direction in lines such as `Dir. V`, `CHANNEL HNZ` and `Richtung: Nord`."""
    match = _WORD.match(line)
    if match and direction_of(match[1]) is not None:
        return match[1]
    first, _, last = line.strip().rpartition(" ")
    if len(words_of(first)) == 1 and speaks_of(first, DIRECTIONS) and direction_of(last):
        return last
    key, mark, value = line.partition(":") if ":" in line else line.partition("=")
    word = re.sub(r"[\[(].*?[\])]", " ", value).strip(" .,;")
    known = mark and speaks_of(key, DIRECTIONS) and len(word) <= 12
    return word if known and (direction_of(word) or re.fullmatch(r"\d", word)) else ""


_DATE = re.compile(
    r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}|\b\d{1,2} \w{3,9} \d{4}\b|\b(?:19|20)\d\d\b|^-$"
)


def titled_recording(line: str) -> Recording | None:
    """The recording of a title; None if a line is none."""
    parts = [part.strip() for part in line.split(",")]
    dated = [k for k, part in enumerate(parts[1:-2], 1) if _DATE.search(part)]
    if dated:
        at = dated[-1]
        date = parts[at]
        event = ", ".join(part for part in parts[: at + 1] if part != "-")
        return Recording(
            event,
            station=", ".join(part for part in parts[at + 1 : -1] if part != "-"),
            direction="" if parts[-1] == "-" else parts[-1],
            origin=date if re.search(r"\d:\d\d", date) else "",
        )
    direction = re.sub(r"\s*\(.*\)$", "", parts[-1])
    of_event = re.search(r"\d/\d+/\d|\b(?:19|20)\d\d\b", parts[0])
    if len(parts) == 3 and of_event and direction_of(direction) is not None:
        return Recording(parts[0], station=parts[1], direction=direction)
    return None
