"""Files whose names differ in one word: components of one recording, as people name them.

Three files of one length, or three columns of a table, are two horizontal components and
a vertical one. Where neither names nor headers tell which, it is asked for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, pairwise
from pathlib import Path, PurePath

import numpy as np

from rpscli.errors import RecordError
from rpscli.records.directions import (
    direction_in,
    direction_of,
    directions_of,
    says_up,
    with_axes,
)
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.recordings import channel_titles, clusters
from rpscli.records.source import FILE, Source

_WORD = re.compile(r"[^\W_]+")
_TAIL = re.compile(r"(.*?)([^\W\d_]+|\d+)")
_HEAD = re.compile(r"([^\W\d_]{1,2})(\d+)")
_MANY = 3


def forms_of(name: str) -> dict[str, str]:
    """Words of a name, or ends of words, by the name with a blank in their place."""
    found = {}
    name = re.sub(r"[-_ ]+", "_", with_axes(name)).replace("_.", ".")
    for match in _WORD.finditer(name):
        start, end = match.span()
        tail = _TAIL.fullmatch(match[0])
        behind = len(tail[1]) if tail else 0
        for at in {start, start + behind, end - 1}:
            found[f"{name[:at]} {name[end:]}"] = name[at:end]
        if head := _HEAD.fullmatch(match[0]):
            found[f"{name[:start]} {head[2]}{name[end:]}"] = head[1]
    return found


def of_one_name(one: str, other: str) -> bool:
    """True if two names of files differ in one word at most."""
    return bool(forms_of(one).keys() & forms_of(other).keys())


_AZIMUTH_TAIL = re.compile(r".*[^\W_][-_]?(\d{3})")
_SIGN = re.compile(r".*[-_. ]([NEVZ])")


def direction_by_name(name: str) -> str:
    """The word of a direction at the end of the name of a file; empty without one.

    >>> direction_by_name("STA_HLZ.csv"), direction_by_name("MUL279.AT2")
    ('HLZ', '279')
    >>> direction_by_name("run_001.txt"), direction_by_name("model_d.txt")
    ('', '')
    """
    name = with_axes(name)
    stem = PurePath(name).stem
    ending = PurePath(name).suffix[1:].rstrip("0123456789")
    if len(ending) == 2 and direction_of(ending) is not None:
        return ending
    last = re.split(r"[-_. ]", stem)[-1]
    if len(last) > 1 and not last.isdigit() and _is_clear(last):
        return last
    if (match := _AZIMUTH_TAIL.fullmatch(stem)) and 9 < int(match[1]) <= 360:
        return match[1]
    if stem.endswith(("000", "00")) and (match := _AZIMUTH_TAIL.fullmatch(stem)):
        return match[1] if match[1] == "000" else ""
    match = _SIGN.fullmatch(stem)
    return match[1] if match else ""


def _is_clear(word: str) -> bool:
    """True of a word that can hardly be anything but a direction."""
    if says_up(word):
        return True
    way = direction_of(word)
    whole = way is not None and (way.azimuth is not None or len(word) > 2)
    return whole and (word.isupper() or not word[-1].isdigit())


def require_two(motions: Mapping[Source, GroundMotion], folder: Path | None) -> None:
    """Refuse three motions of one name, or recording, that are nearly as long.

    A recording has two horizontal components: of three, one is vertical, or they are
    turned copies.
    """
    real = {
        of: motion
        for of, motion in motions.items()
        if of.scheme == FILE and "channel" not in of.values
        and "not a recording" not in motion.description.lower()
    }  # fmt: skip
    for three in _threes(real, folder):
        told = [motions[of].recording for of in three]
        if _of_one_direction(three, motions) or _are_multiples(three, motions):
            continue
        if len({each.station for each in told if each.station}) > 1:
            continue
        events = {each.event or each.origin for each in told}
        if len(events - {""}) > 1:
            continue
        names = ", ".join(PurePath(of.place).name for of in three)
        raise RecordError(
            f"{names}: are of one length, as two horizontal components and a vertical"
            " one are, and neither names nor headers tell which is vertical. Call"
            " that one ...-UP, or name the records that are meant one by one"
        )


NEARLY = 0.02
"""Of the length: components are cut to lengths that differ by less."""


def _threes(
    motions: Mapping[Source, GroundMotion], folder: Path | None
) -> Iterator[list[Source]]:
    """Three sources of one step and nearly one length, of one name or recording."""
    groups: dict[tuple[object, ...], list[tuple[Source, str]]] = {}
    number = dict(zip(motions, clusters([*motions], folder), strict=True))
    for of, motion in motions.items():
        size = (round(motion.dt, 7), str(PurePath(of.place).parent))
        name = PurePath(of.place).name
        for key, word in forms_of(name).items():
            groups.setdefault((*size, key), []).append((of, word))
        word = direction_by_name(name)
        groups.setdefault((*size, number[of]), []).append((of, word))
    counted = _of_a_series(motions)
    for every in groups.values():
        for members in _nearly_as_long(every, motions):
            if len(members) != _MANY or _have_names_of_their_own(members):
                continue
            by_number = all(word.isdigit() for _, word in members)
            series = by_number and counted & dict(members).keys()
            if not series and _may_be_components(members):
                yield [of for of, _ in members]
    yield from _thirds(motions)


def _thirds(motions: Mapping[Source, GroundMotion]) -> Iterator[list[Source]]:
    """Both horizontal components of a beginning, and a third file of it whose rest is no
    horizontal direction.
    """
    pairs: dict[tuple[str, str], list[Source]] = {}
    level = {}
    for of in motions:
        path = PurePath(with_axes(of.place))
        word = direction_by_name(path.name)
        way = direction_of(word) if word else None
        if way is not None and not way.vertical:
            level[of] = way
            beginning = path.name[: path.name.rindex(word)]
            pairs.setdefault((str(path.parent), beginning), []).append(of)
    for (folder, beginning), members in pairs.items():
        if len(members) != _MANY - 1 or not beginning:
            continue
        longest = max(motions[of].npts for of in members)
        for of, motion in motions.items():
            path = PurePath(with_axes(of.place))
            rest = path.stem.removeprefix(beginning)
            near = abs(motion.npts - longest) <= NEARLY * longest
            of_it = path.name.startswith(beginning) and str(path.parent) == folder
            if near and of_it and of not in level and len(rest) <= _LONGEST_WORD:
                yield [*members, of]


_LONGEST_WORD = 10
"""Letters of a word that may be a direction."""


_LABEL = re.compile(r"[a-z]|(?:[a-z]{1,2}|comp|chan|channel)?0*[0-3]", re.IGNORECASE)
_OF_SERIES = re.compile(
    r"(?:eq|gm|art|rec|record|motion|run|seed|case|sim|test|wave|set|no|quake|th|sample|site"
    r"|event|scenario|realization|suite|input|history|file|data|ground|earthquake|station)"
    r"[-_ ]?$",
    re.IGNORECASE,
)


def _may_be_components(members: Sequence[tuple[Source, str]]) -> bool:
    """True of words that tell two directions at least, or are labels of components."""
    words = [word for _, word in members]
    if sum(direction_of(word) is not None for word in words) > 1:
        return True
    of, word = members[0]
    stem = PurePath(of.place).stem
    before, _, behind = stem.partition(word)
    if direction_of(before) is not None or direction_of(behind.strip("-_. ")) is not None:
        return False  # E1, E2, E3 and GM1_x, GM2_x, GM3_x
    named = bool(
        re.search(_OF_SERIES, re.sub(r".*[-_ .](?=[^-_ .]+[-_ ]?$)", "", before))
    )
    return not named and all(_LABEL.fullmatch(word) for word in words)


def _of_one_direction(
    three: Sequence[Source], motions: Mapping[Source, GroundMotion]
) -> bool:
    """True of files that all tell one horizontal direction: those of three stations."""
    by_name = {
        with_axes(direction_by_name(PurePath(of.place).name)).lower() for of in three
    }
    by_header = {motions[of].recording.direction.lower() for of in three}
    return any(
        len(told) == 1 and _is_level(next(iter(told))) for told in (by_name, by_header)
    )


def _is_level(word: str) -> bool:
    way = direction_in(word) if word else None
    return word == "horizontal" or (way is not None and not way.vertical)


MULTIPLE = 0.9999
"""Correlation of samples that are those of one motion times a factor."""


def _are_multiples(
    three: Sequence[Source], motions: Mapping[Source, GroundMotion]
) -> bool:
    """True of three motions of which two are one times a factor."""
    for one, other in combinations((motions[of].acceleration for of in three), 2):
        size = min(one.size, other.size)
        a = one[:size]
        b = other[:size]
        if abs(float(a @ b)) > MULTIPLE * float(np.linalg.norm(a) * np.linalg.norm(b)):
            return True
    return False


def _nearly_as_long(
    members: Sequence[tuple[Source, str]], motions: Mapping[Source, GroundMotion]
) -> Iterator[list[tuple[Source, str]]]:
    """Members in groups whose lengths follow each other closely."""
    ordered = sorted(members, key=lambda each: motions[each[0]].npts)
    group = ordered[:1]
    for before, each in pairwise(ordered):
        longest = motions[each[0]].npts
        if longest - motions[before[0]].npts > NEARLY * longest:
            yield group
            group = []
        group.append(each)
    yield group


def _have_names_of_their_own(members: Iterable[tuple[Source, str]]) -> bool:
    """True of files that share no part of a name, and whose names are no directions."""
    return all(
        PurePath(of.place).stem == word
        and not word.isdigit()
        and direction_of(word) is None
        for of, word in members
    )


def _of_a_series(sources: Iterable[Source]) -> set[Source]:
    """Files that are numbered with more than two others: some may be of one length."""
    series: dict[tuple[str, str], list[Source]] = {}
    for of in sources:
        path = PurePath(of.place)
        for form, word in forms_of(path.name).items():
            if word.isdigit():
                series.setdefault((str(path.parent), form), []).append(of)
    return {of for members in series.values() if len(members) > _MANY for of in members}


def require_horizontal_titles(sources: Iterable[Source], folder: Path | None) -> None:
    """Refuse a table of three accelerations whose titles do not tell directions."""
    for place in dict.fromkeys(of.place for of in sources if "channel" in of.values):
        own = [of for of in sources if of.place == place]
        titles = channel_titles(own[0], folder)
        if len(own) < _MANY or len(titles) != len(own):
            continue
        ways = [direction_in(title) for title in titles]
        together = directions_of(titles)
        known = [b if b is not None else a for a, b in zip(ways, together, strict=True)]
        unknown = [t for t, way in zip(titles, known, strict=True) if way is None]
        upright = any(way is not None and way.vertical for way in known)
        if unknown and not (upright and len(own) == _MANY):
            first = ",".join(str(of.values["channel"]) for of in own[:2])
            raise RecordError(
                f"{place}: has {len(own)} columns of acceleration, and the titles"
                f" {', '.join(unknown[:3])} do not tell their directions; name the"
                f" horizontal ones: ?channel={own[0].values['channel']}, or two by"
                f" ?channel={first}&both"
            )
