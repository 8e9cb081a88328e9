"""Which components are of one recording, by the names of their files."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePath

from rpscli.errors import RecordError
from rpscli.records import sets, synthetic

_SEED = re.compile(r"[?&]seed=([^&]*)")
OTHER_SCHEME = re.compile(r"[A-Za-z][\w.+-]+:")  # two letters at least: C: is a drive
_PEER_NUMBER = re.compile(r"(RSN\d+)_.*", re.IGNORECASE)
_CHANNEL_CODE = re.compile(r"(?<=[._])([A-Z]{2})[ENXY12](?=[._])")
_WAY = re.compile(r"_[xy](?=\.\w+$)")  # as `rps record convert` calls both components
_KNET = re.compile(r"\.(?:EW|NS)([12]?)$", re.IGNORECASE)
_AZIMUTH = re.compile(r"(.*\D)(\d{3}|(?<=-)[NESW])(\.at2)", re.IGNORECASE)
_COMPASS = {"N": 0, "E": 90, "S": 180, "W": 270}
VERTICAL = re.compile(r".*(?:UP|UD|DWN|VER|V|Z)(?:\.\w+)?", re.IGNORECASE)


def right_angles(files: Iterable[str]) -> set[str]:
    """What the names of two files begin with that end with azimuths of 90 deg between them."""
    by_azimuth: dict[str, list[int]] = {}
    for match in filter(None, map(_AZIMUTH.fullmatch, sorted(set(files)))):
        azimuth = _COMPASS.get(match[2].upper())
        by_azimuth.setdefault(match[1], []).append(int(match[2]) if azimuth is None else azimuth)
    return {stem for stem, at in by_azimuth.items() if len(at) == 2 and (at[1] - at[0]) % 180 == 90}


def family(place: str, source: str, apart: set[str]) -> str:
    """The name of a recording: a place without what tells its components apart."""
    if place.startswith(f"{sets.SCHEME}:"):
        return re.sub("/[ab]$", "", place)
    if place.startswith(f"{synthetic.SCHEME}:"):
        seed = _SEED.search(source)
        return f"{synthetic.SCHEME}:{seed[1] if seed else place}"
    if OTHER_SCHEME.match(place):
        return source
    folder, name = PurePath(place).parent, PurePath(place).name
    if (azimuth := _AZIMUTH.fullmatch(place)) and azimuth[1] in apart:
        return azimuth[1]
    if number := _PEER_NUMBER.fullmatch(name):
        return str(folder / number[1].upper())
    return str(folder / _KNET.sub(r".\1", _CHANNEL_CODE.sub(r"\1", _WAY.sub("", name))))


def two_by_two(files: Iterable[str], source: str) -> list[tuple[str, str]]:
    """Both horizontal components of each recording; the second as seen from the first."""
    names = [file for file in files if not VERTICAL.fullmatch(file)]
    apart, members = right_angles(names), dict[str, list[str]]()
    for name in names:
        members.setdefault(family(name, name, apart), []).append(name)
    for of_one in members.values():
        if len(of_one) != 2:
            raise RecordError(
                f"{source}: {', '.join(of_one[:3])}: names do not tell two horizontal components of"
                " one recording, as MUL009.AT2 and MUL279.AT2, AOM001.EW and AOM001.NS do; leave it"
                " out, or name each pair, as in x.at2?second=y.at2&both"
            )
    return [(first, PurePath(second).name) for first, second in members.values()]
