"""Ground motions as the text of PEER AT2 files."""

from __future__ import annotations

import re
from importlib.metadata import PackageNotFoundError, version

from rpscli.constants import STANDARD_GRAVITY
from rpscli.records.ground_motion import GroundMotion

_VALUES_PER_LINE = 5
_TITLE_WIDTH = 240
_MADE = ("synthetic", "pulse")


def at2_text(motion: GroundMotion) -> str:
    """The content of the AT2 file of a motion, in g, to eight digits.

    Its first line says that it is synthetic, or what it was converted from; DT is written with all
    its digits.

    Examples
    --------
    >>> motion = GroundMotion([0.0, 9.80665], 0.01, "m", "m.txt", "one-column text")
    >>> lines = at2_text(motion).splitlines()
    >>> lines[0].partition(" BY ")[0]
    'PEER AT2 LAYOUT, CONVERTED FROM ONE-COLUMN TEXT'
    >>> lines[1:]  # doctest: +NORMALIZE_WHITESPACE
    ['m', 'ACCELERATION TIME SERIES IN UNITS OF G', 'NPTS=      2, DT= 0.01 SEC',
     '  0.0000000E+00  1.0000000E+00']
    """
    made = motion.format in _MADE
    origin = (
        "SYNTHETIC, NOT A RECORDING, MADE" if made else f"CONVERTED FROM {motion.format.upper()}"
    )
    title = "; ".join(filter(None, [motion.source if made else motion.name, motion.description]))
    values = motion.acceleration / STANDARD_GRAVITY
    rows = [
        "".join(f"{value:15.7E}" for value in values[start : start + _VALUES_PER_LINE])
        for start in range(0, motion.npts, _VALUES_PER_LINE)
    ]
    header = [
        f"PEER AT2 LAYOUT, {origin} BY RPS {_version()}",
        _one_line(title),
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {motion.npts:6d}, DT= {motion.dt!r} SEC",
    ]
    return "\n".join([*header, *rows]) + "\n"


def _one_line(title: str) -> str:
    # A title must not be taken for one of the header lines that carry numbers.
    line = "".join(letter for letter in " ".join(title.split()) if letter.isprintable())
    line = re.sub(r"\b(n)(pts)\b", r"\1-\2", line, flags=re.IGNORECASE)
    line = re.sub(r"(?<![?&])\b(d)(t\s*=)", r"\1-\2", line, flags=re.IGNORECASE)
    line = re.sub(r"\b(u)(nits?\s*(?:of|in|[=:]))", r"\1-\2", line, flags=re.IGNORECASE)
    line = re.sub(r"\b(velocity|displacement)\s+time\b", r"\1-time", line, flags=re.IGNORECASE)
    return line[:_TITLE_WIDTH]


def _version() -> str:
    try:
        return version("rpscli")
    except PackageNotFoundError:  # run from a source tree
        return "(not installed)"
