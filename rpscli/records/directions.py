"""Meaning of names of components: horizontal, with an azimuth where it is told, or up.

The one vocabulary of directions: of headers, titles of columns and names of files.
"""

from __future__ import annotations

import re
from typing import NamedTuple


class RecordDirection(NamedTuple):
    """A direction: vertical, or horizontal with its azimuth [deg] where that is known."""

    vertical: bool
    azimuth: float | None = None


UP = RecordDirection(vertical=True)
HORIZONTAL = RecordDirection(vertical=False)

_VERTICAL = re.compile(
    r"v|z|u|d|up|ud|du|dn|dwn|down|vrt|vert|vertical|vertic\w*|updown|upward\w*|downward\w*"
    r"|(?:gm|ch|comp|acc?|a)\d*z|[hbelsc][nhlgp]z\d*|hz|updn|vtcl|ve"
    r"|haut|hoch|vertikal|arriba|d[uü][sş]ey|верт\w*|上下|κατακ\w*",
    re.IGNORECASE,
)
_COMPASS = {"n": 0.0, "e": 90.0, "s": 180.0, "w": 270.0}
_AXIS = re.compile(r"ns|sn|ew|we|nsc|ewc|сю|юс|вз|зв", re.IGNORECASE)
_AXIS_AZIMUTHS = {**dict.fromkeys("nsсю", 0.0), **dict.fromkeys("ewвз", 90.0)}
_BEARING = re.compile(r"([ns])(\d{1,2})([ew])", re.IGNORECASE)
_NAMED = re.compile(
    r"x|y|l|t|r|h|h1|h2|h|long\w*|trans\w*|radial|tran|(?!ch\d)[hbelsc][nhlgp][nexy12]\d*"
    r"|(?:gm|ch|comp|acc?|a)\d*[xy]|north|south|east|west|northsouth|eastwest"
    r"|nord|norte|kuzey|север|ost|este?|do[gğ]u|восток|ouest|oeste|bat[ıi]|запад"
    r"|sud|süd|sur|g[uü]ney|юг|南北|東西|db|kg",
    re.IGNORECASE,
)
_AZIMUTH = re.compile(
    r"(?:az|azimuth)?(0|\d{2,3}|\d(?=d|°))(?:deg|°|degrees)?", re.IGNORECASE
)
"""An azimuth; 1, 2 and 3 alone are numbers of components."""


def direction_of(text: str) -> RecordDirection | None:
    """The direction that a word is; None for a word that is none that is known.

    >>> direction_of("U-D").vertical, direction_of("N00E").azimuth, direction_of("Pacoima")
    (True, 0.0, None)
    """
    word = re.sub(r"\([+-]?\)|[\s_.+-]", "", text).removeprefix("component")
    word = re.sub(r"^comp(?:onent)?(?=[a-z])", "", word, flags=re.IGNORECASE)
    if _VERTICAL.fullmatch(word):
        return UP
    small = word.lower()
    if small in _COMPASS:
        return RecordDirection(vertical=False, azimuth=_COMPASS[small])
    if match := _BEARING.fullmatch(word):
        return RecordDirection(vertical=False, azimuth=_of_bearing(*match.groups()))
    if _AXIS.fullmatch(word):
        return RecordDirection(vertical=False, azimuth=_AXIS_AZIMUTHS[small[0]])
    if (match := _AZIMUTH.fullmatch(word)) and float(match[1]) <= 360.0:
        return RecordDirection(vertical=False, azimuth=float(match[1]))
    return HORIZONTAL if _NAMED.fullmatch(word) else None


def _of_bearing(begin: str, degrees: str, towards: str) -> float:
    """The azimuth of a bearing such as S60W [deg]."""
    from_north = begin.lower() == "n"
    turned = float(degrees) * (1.0 if towards.lower() == "e" else -1.0)
    return (turned if from_north else 180.0 - turned) % 360.0


_QUALIFIED = re.compile(
    r"(?:ground[\s_]*)?(?:acc\w*?|a)[\s_.-]*([a-z]{1,3}|[ns]\d\d?[ew]|\d{3})",
    re.IGNORECASE,
)


def direction_in(name: str) -> RecordDirection | None:
    """The direction that a name is, or that stands behind `acc` in it, as in `acc_ns`."""
    if (found := direction_of(name)) is not None:
        return found
    match = _QUALIFIED.fullmatch(name.strip())
    return direction_of(match[1]) if match else None
