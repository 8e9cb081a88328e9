"""Texts damaged at random: by slips of the hand, by transfer, and on purpose."""

from __future__ import annotations

import re
from collections.abc import Callable
from random import Random

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?")
NUMBERS = [
    "0", "-1", "1", "2", "1e-320", "1E999", "-1e300", "1e20", "0.0", "nan", "inf", ".", "-",
    "1.2.3", "0,5", "1_000", "٣", "4000000000", "9" * 30, "9" * 400, "1E+99999999999999999999",
    "0x10", "1e",
]  # fmt: skip
PIECES = [
    "", " ", "\t", ":", "-", "{", "}", "[", "]", ",", ";", "#", "'", '"', "&a", "*a", "!!python/x",
    "<<", "null", "true", "~", "|", "?", "units: g", "NPTS= 3, DT= .1", "dt: 0.01", "END", "\x1a",
    "é", "建物", "\x00", "\x85", "\u2028", "1 2 3", "x" * 3000, "--- a", "storeys: 6",
    "@", "%", "`",
]  # fmt: skip


def mutated(text: str, random: Random) -> str:
    """The text after one to four damages."""
    for _ in range(random.choice([1, 1, 1, 2, 4])):
        text = random.choice(DAMAGES)(text, random)
    return text


def _number(text: str, random: Random) -> str:
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    # The numbers of a header are worth more than the thousands that follow.
    match = random.choice(found[:60] if random.random() < 0.7 else found)
    return text[: match.start()] + random.choice(NUMBERS) + text[match.end() :]


def _scaled_number(text: str, random: Random) -> str:
    found = list(NUMBER.finditer(text))[:60]
    if not found:
        return text
    match = random.choice(found)
    factor = random.choice([-1.0, 0.5, 2.0, 1e3, 1e-3, 1e9])
    value = float(re.sub("[dD]", "e", match[0])) * factor
    return f"{text[: match.start()]}{value:g}{text[match.end() :]}"


def _lines(change: Callable[[list[str], int, Random], list[str]]) -> Callable[[str, Random], str]:
    def damage(text: str, random: Random) -> str:
        lines = text.split("\n")
        place = random.randrange(min(len(lines), 60) if random.random() < 0.7 else len(lines))
        return "\n".join(change(lines, place, random))

    return damage


def _swapped(lines: list[str], i: int, random: Random) -> list[str]:
    j = random.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return lines


def _indented(lines: list[str], i: int, random: Random) -> list[str]:
    lines[i] = random.choice(["", " ", "  ", "\t", "        "]) + lines[i].lstrip()
    return lines


def _letter(text: str, random: Random) -> str:
    if not text:
        return text
    place = random.randrange(min(len(text), 2000) if random.random() < 0.7 else len(text))
    letter = chr(random.choice([random.randrange(32, 127), random.randrange(0, 0x250)]))
    return text[:place] + letter + text[place + random.randrange(2) :]


def _piece(text: str, random: Random) -> str:
    place = random.randrange(min(len(text), 2000) + 1)
    return text[:place] + random.choice(PIECES) + text[place:]


def _word(text: str, random: Random) -> str:
    words = list(re.finditer(r"\w+", text[:4000]))
    if not words:
        return text
    here, other = random.choice(words), random.choice(words)
    return text[: here.start()] + other[0] + text[here.end() :]


DAMAGES: list[Callable[[str, Random], str]] = [
    _number,
    _number,
    _scaled_number,
    _letter,
    _letter,
    _piece,
    _word,
    _lines(lambda lines, i, _: [*lines[:i], *lines[i + 1 :]]),
    _lines(lambda lines, i, _: [*lines[: i + 1], *lines[i:]]),
    _lines(_swapped),
    _lines(_indented),
    lambda text, random: text[: random.randrange(len(text) + 1)],
    lambda text, random: text + text[random.randrange(len(text) + 1) :],
    lambda text, random: text.replace(
        *random.choice([(".", ","), (" ", ";"), (":", ""), ("\n", "")])
    ),
    lambda text, random: text.replace("\n", random.choice(["\r\n", "\r", "\n\n", " \n"])),
]
