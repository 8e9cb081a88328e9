"""Meaning of names of components: horizontal, with an azimuth where it is told, or up.

The one vocabulary of directions: of headers, titles of columns and names of files. Words
are compared without accents and case.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from rpscli.records.words import folded


class RecordDirection(NamedTuple):
    """A direction: vertical, or horizontal with its azimuth [deg] where that is known."""

    vertical: bool
    azimuth: float | None = None


UP = RecordDirection(vertical=True)
HORIZONTAL = RecordDirection(vertical=False)

_VERTICAL_WORDS = re.compile(
    r"up|ud|updn|updo|updown|upward\w*|dwn|down|downward\w*|vrt|vrtcl|vert"
    r"|verti[ck]\w*|vtcl"
    r"|vertic\w*|haut|hoch|senkrecht|lotrecht|arriba|alto|[cz]enit(?:h|al)?|hohe|gravity|plumb|hautbas|pysty|상하|dusey|dikey|dus|верт\w*"
    r"|отвесн\w*"
    r"|上下|垂直|竖直|竖向|鉛直|铅直|수직|上|joge|jouge|enchoku|chui?zhi|shuxiang|shangxia"
    r"|katak\w*|κατακ\w*|pionow\w*|svisl\w*|vertikaln\w*|okomit\w*|verdikal|lodret"
    r"|fugg\w*"
    r"|thangdung|qaim|tegak|عمودي|אנכי|nadir"
)
"""Words for up and down, of two letters and more, that say nothing else."""
_VERTICAL_SIGNS = re.compile(
    r"v|z|u|d|du|dn|ve|vt|hz|v\d|cz|sx|(?:gm|ch|comp|acc?|a)\d*z|(?:acc?|a|comp)\d*v"
    r"|[hbelsc][nhlgp]z\d*"
)


def _at(azimuth: float, words: str) -> dict[str, float]:
    return dict.fromkeys(words.split(), azimuth)


_COMPASS = {
    **_at(0.0, "n north nord norte kuzey север с βορρασ kita bei 北"),
    **_at(90.0, "e east ost este est dogu восток в oost higashi dong 東 东"),
    **_at(180.0, "s south sud sued sur guney юг ю zuid minami nan 南"),
    **_at(270.0, "w west ouest oeste ovest bati запад з nishi xi 西"),
}
_AXES = {
    **_at(0.0, "ns sn nsc сю юс kg gk northsouth nanboku nambok beinan nanbei 南北 北南"),
    **_at(0.0, "nordsud nortesur kuzeyguney севюг сев"),
    **_at(90.0, "ew we ewc вз зв db bd eastwest tozai touzai dongxi xidong 東西 东西"),
    **_at(90.0, "ostwest esteoeste dogubati вост oe eo"),
}
"""Words of both ends of an axis, at the azimuth of one of them."""
_UP_AND_DOWN = frozenset(("ud", "du", "zd", "vt"))
"""Both ends of the vertical axis."""
_BEARING = re.compile(r"([ns])(\d{1,2})([ew])")
_NAMED = re.compile(
    r"x|y|l|t|r|h|h1|h2|nb|dx|fn|fp|long\w*|trans\w*|radial|tran|hcomp|horiz\w*|yatay"
    r"|(?!ch\d)[hbelsc][nhlgp][12]\d*|(?:gm|ch|comp|acc?|a)\d*[xy]"
)
_SEED = re.compile(r"(?!ch\d)[hbelsc][nhlgp]([nesw])\d*|[hbelsc][nhlgp]([xy])\d*")
_AZIMUTH = re.compile(r"(?:az|azimuth)?(0|\d{2,3}|\d(?=d|°))(?:deg|°|degrees)?")
"""An azimuth; 1, 2 and 3 alone are numbers of components."""


_DECIMAL = re.compile(r"\d[.,]0*[1-9]")
"""What is a number and no azimuth."""


def _word(text: str) -> str:
    """A name without punctuation, and without `component` before it."""
    bare = re.sub(r"\([+-]?\)|[\s_.+-]", "", folded(text)).removeprefix("component")
    return re.sub(r"^comp(?:onent)?(?=[a-z])", "", bare)


def direction_of(text: str) -> RecordDirection | None:
    """The direction that a word is; None for a word that is none that is known.

    >>> direction_of("U-D").vertical, direction_of("N00E").azimuth, direction_of("Pacoima")
    (True, 0.0, None)
    """
    word = "" if _DECIMAL.search(text) else _word(text)
    if _VERTICAL_WORDS.fullmatch(word) or _VERTICAL_SIGNS.fullmatch(word):
        return UP
    azimuth = _COMPASS.get(word, _AXES.get(word))
    if azimuth is not None:
        return RecordDirection(vertical=False, azimuth=azimuth)
    if match := _BEARING.fullmatch(word):
        return RecordDirection(vertical=False, azimuth=_of_bearing(*match.groups()))
    if match := _SEED.fullmatch(word):
        return RecordDirection(vertical=False, azimuth=_COMPASS.get(match[1] or ""))
    if (match := _AZIMUTH.fullmatch(word)) and float(match[1]) <= 360.0:
        return RecordDirection(vertical=False, azimuth=float(match[1]))
    return HORIZONTAL if _NAMED.fullmatch(word) else None


_HALVES = re.compile(
    "|".join(
        rf"(?<![^\W_]){word[0]}[-_]{word[1]}(?![^\W_])"
        for word in sorted({*_AXES, *_UP_AND_DOWN})
        if len(word) == 2 and word.isascii()
    ),
    re.IGNORECASE,
)


def with_axes(name: str) -> str:
    """A name in which an axis of two letters is one word.

    >>> with_axes("STA_E-W.txt"), with_axes("a_N_S"), with_axes("v-1_X-Y")
    ('STA_EW.txt', 'a_NS', 'v-1_X-Y')
    """
    return _HALVES.sub(lambda match: match[0][0] + match[0][2], name)


def says_up(text: str) -> bool:
    """True of a word for up or down that can hardly mean anything else.

    >>> says_up("Düşey"), says_up("VERTICALE"), says_up("D")
    (True, True, False)
    """
    return bool(_VERTICAL_WORDS.fullmatch(_word(text)))


def directions_of(words: Sequence[str]) -> list[RecordDirection | None]:
    """Directions of words that stand beside each other.

    D beside K, G or B is the east in Turkish, and V beside Z, with S or alone, in Slavic
    languages; of H1, H2, 3 and the like the third is not known.
    """
    small = {_word(word) for word in words}
    east = set[str]()
    if len(small) > 1 and small <= {"k", "g", "d", "b"}:
        return [
            RecordDirection(vertical=False, azimuth={"k": 0.0, "d": 90.0, "g": 180.0}.get(
                _word(word), 270.0)) for word in words
        ]  # fmt: skip
    if {"z", "v"} <= small:
        east = {"v"}
    return [
        RecordDirection(vertical=False, azimuth=90.0)
        if _word(word) in east
        else direction_of(word)
        for word in words
    ]


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
    """The direction that a name is, that stands behind `acc` in it, as in `acc_ns`, or is
    its last word, as in `Acc. UD`.
    """
    name = with_axes(name)
    if (found := direction_of(name)) is not None:
        return found
    if match := _QUALIFIED.fullmatch(name.strip()):
        return direction_of(match[1])
    words = re.split(r"[\s_.,-]+", name.strip())
    if says_up(words[-1]):
        return UP
    known = [way for word in words if (way := direction_of(word)) is not None]
    others = [word for word in words if direction_of(word) is None]
    remarks = all(_REMARK.fullmatch(folded(word)) for word in others)
    return known[0] if len(known) == 1 and remarks else None


_REMARK = re.compile(r"acc\w*|ground|filt\w*|corr\w*|proc\w*|comp\w*|dir\w*|data|deg")
"""Words beside that of a direction, which say nothing of it."""
