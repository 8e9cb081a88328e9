"""Which components are of one recording, by the names of their files."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePath

from rpscli.errors import RecordError
from rpscli.records.source import FILE, SET, Source

_PEER_NUMBER = re.compile(r"(RSN\d+)_.*", re.IGNORECASE)
_CHANNEL_CODE = re.compile(r"(?<=[._])([A-Z]{2})[ENXY12](?=[._])")
_WAY = re.compile(r"_[xy](?=\.\w+$)")  # as `rps record convert` calls both components
_KNET = re.compile(r"\.(?:EW|NS)([12]?)$", re.IGNORECASE)
_AZIMUTH = re.compile(r"(.*\D)(\d{3}|(?<=-)[NESW])(\.at2)", re.IGNORECASE)
_COMPASS = {"N": 0, "E": 90, "S": 180, "W": 270}
VERTICAL_MARK = re.compile(
    r"(.*?)(?:[-_.]?(?:UP|UD|DWN|VERT?)|[-_][VZ]|(?<=[A-Z])V(?=\.at2)|(?<=\.[A-Z]{2})Z)[12]?(?:\.\w+)*",
    re.IGNORECASE,
)
"""The name of a vertical component: what it shares with others of its recording, and the rest."""
VERTICAL = re.compile(r".*(?:UP|UD|DWN|VER|V|Z)(?:\.\w+)?", re.IGNORECASE)


def right_angles(files: Iterable[str]) -> set[str]:
    """What the names of two files begin with that end with azimuths of 90 deg between them."""
    by_azimuth: dict[str, list[int]] = {}
    for match in filter(None, map(_AZIMUTH.fullmatch, sorted(set(files)))):
        azimuth = _COMPASS.get(match[2].upper())
        by_azimuth.setdefault(match[1], []).append(int(match[2]) if azimuth is None else azimuth)
    return {stem for stem, at in by_azimuth.items() if len(at) == 2 and (at[1] - at[0]) % 180 == 90}


def family(of: Source, place: str, apart: set[str]) -> str:
    """The name of a recording: a place of a source without what tells its components apart."""
    if of.scheme == SET:
        return f"{SET}:{re.sub('/[ab]$', '', place)}"
    if of.scheme == "synthetic":
        return f"synthetic:{dict(of.options).get('seed', place)}"
    if of.scheme:
        return str(of)
    folder, name = PurePath(place).parent, PurePath(place).name
    if (azimuth := _AZIMUTH.fullmatch(place)) and azimuth[1] in apart:
        return azimuth[1]
    if number := _PEER_NUMBER.fullmatch(name):
        return str(folder / number[1].upper())
    return str(folder / _KNET.sub(r".\1", _CHANNEL_CODE.sub(r"\1", _WAY.sub("", name))))


def verticals_beside(files: Iterable[str]) -> set[str]:
    """Vertical components, by their names, of recordings whose other components lie beside."""
    names = sorted(set(files))
    marked = {name: match for name in names if (match := VERTICAL_MARK.fullmatch(name))}
    others = [name for name in names if name not in marked]
    return {
        name
        for name, match in marked.items()
        if any(other.startswith(match[1]) for other in others)
    }


def pairs_among(single: Iterable[Source], text: str) -> list[Source]:
    """Pairs of the components of each recording, under their common options.

    Of a set either component names its pair. Of files both have to be there.
    """
    given = list(dict.fromkeys(single))
    places = [of.place for of in given if of.scheme == FILE]
    apart, members = right_angles(places), dict[str, list[Source]]()
    for of in given:
        if of.of_pair:
            raise RecordError(f"{of}: is of two components already, which {text} asks for again")
        if of.scheme not in (FILE, SET):
            raise RecordError(f"{of}: has no second component, which {text} asks for")
        members.setdefault(family(of, of.place, apart), []).append(of)
    found = []
    for of_one in members.values():
        first, *rest = of_one
        if any(each.options != first.options for each in rest):
            raise RecordError(
                f"{text}: {first} and {rest[0]} are of one recording and differ in their options;"
                " both act together under one factor"
            )
        if first.scheme == SET:
            found.append(first.at(re.sub("/[ab]$", "", first.place)))
            continue
        horizontal = [each for each in of_one if not VERTICAL.fullmatch(each.place)]
        if len(horizontal) != 2:
            some = ", ".join(each.place for each in of_one[:3])
            raise RecordError(
                f"{text}: {some}: names do not tell two horizontal components of one recording, as"
                " MUL009.AT2 and MUL279.AT2, AOM001.EW and AOM001.NS do; leave it out, or name each"
                " pair, as in x.at2?second=y.at2&both"
            )
        one, other = horizontal
        found.append(one.plus(second=PurePath(other.place).name))
    return found
