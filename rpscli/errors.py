"""Errors: one class for each exit code of the command line.

A message names the place, the value found, the rule that it breaks and a remedy. Nothing
here knows about terminals: the command line turns these into text and an exit status.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import fields
from functools import cache
from itertools import repeat
from numbers import Real
from pathlib import PurePath
from types import UnionType
from typing import Any, Literal, TypeGuard, TypeVar, get_args, get_origin, get_type_hints

Item = TypeVar("Item")
Made = TypeVar("Made")


class RpsError(Exception):
    """Base of every error that `rps` raises on purpose."""

    exit_code = 1


class UsageError(RpsError):
    """The command was called with options that do not fit together."""

    exit_code = 2


class CaseError(RpsError):
    """A case or study file is invalid; the text holds one line for each fault."""

    exit_code = 3


class RecordError(RpsError):
    """A ground motion cannot be read, or is not what it says it is."""

    exit_code = 3


class AnalysisError(RpsError):
    """The analysis ended as `failed`: the numbers cannot be trusted."""

    exit_code = 4


class StudyIncomplete(RpsError):
    """A study ran to its end, but some of its points failed."""

    exit_code = 5


class VerificationMismatch(RpsError):
    """A computed value lies outside its tolerance about the expected one."""

    exit_code = 6


class Refused(RpsError):
    """Going on would overwrite or mix results that are not ours to touch."""

    exit_code = 7


class LimitExceeded(RpsError):
    """An acceptance limit of the case, or of `--fail-on`, was exceeded."""

    exit_code = 10


class PluginError(RpsError):
    """An addition of another package cannot be used; the text names the package."""


class OutputError(RpsError):
    """A result cannot be written: no permission, a full disk, a file
    where a folder should be.
    """


@contextmanager
def refused_by_system(
    name: object, fault: type[RpsError], verb: str, remedy: str
) -> Iterator[None]:
    """Refusals of the system as errors of the program: no permission, a name too long."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        raise fault(f"{str(name)[:200]}: cannot be {verb}: {reason}; {remedy}") from None


def alike(word: str, known: Iterable[str], most: int, likeness: float = 0.0) -> list[str]:
    """The known words that are nearest to one, of which `likeness` is
    the part of equal letters.
    """
    import difflib  # needed by those who made a mistake only

    folded = {name.lower().replace("-", "_"): name for name in known}
    found = difflib.get_close_matches(
        word.lower().replace("-", "_"), folded, most, likeness
    )
    return [folded[name] for name in found]


def nearest(word: str, known: Iterable[str], likeness: float = 0.7) -> str | None:
    """The known word that was probably meant; None if `likeness` is less."""
    return next(iter(alike(word, known, 1, likeness)), None)


def foreign_letters(word: str) -> str:
    """Characters of a word that look like others, by their names; empty without such.

    >>> foreign_letters("m\u0430ss")
    " ('\u0430' in it is U+0430, CYRILLIC SMALL LETTER A)"
    """
    import unicodedata  # needed by those who made a mistake only

    odd = [
        each
        for each in word
        if not each.isascii()
        and (each.isalpha() or not each.isprintable() or each.isspace())
    ]
    told = [
        f"{each!r} in it is U+{ord(each):04X}, {unicodedata.name(each, 'without a name')}"
        for each in dict.fromkeys(odd)
    ]
    return f" ({'; '.join(told[:3])})" if told else ""


def hint(word: str, known: Iterable[str], otherwise: str, likeness: float = 0.7) -> str:
    """A remedy for a word that is not known: the nearest known one, or `otherwise`."""
    meant = nearest(word, known, likeness)
    return f"did you mean {meant}?{foreign_letters(word)}" if meant else otherwise


def all_made(
    make: Callable[[Item], Made], items: Iterable[Item], fault: type[RpsError]
) -> list[Made]:
    """Results of `make` for all items; its faults are raised
    together, a line for each.
    """
    made = []
    complaints = []
    for item in items:
        try:
            made.append(make(item))
        except fault as error:
            complaints.append(str(error))
    if complaints:
        raise fault("\n".join(complaints))
    return made


def listed(words: Iterable[str], last: str = "or") -> str:
    """Words as an enumeration."""
    *head, tail = words
    return f"{', '.join(head)} {last} {tail}" if head else tail


# Control characters but for tabulators, blanks and line ends, and marks that turn the
# direction of writing: a terminal obeys them.
_UNSEEN = re.compile(
    r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]"
)


def visible(text: str) -> str:
    """A text that only shows on a terminal, whoever wrote it."""
    return _UNSEEN.sub("\ufffd", text)


def words_of(error: BaseException) -> str:
    """Kind and text of an error that others raise, in one line that only shows."""
    try:
        text = str(error)
    except BaseException as another:  # noqa: BLE001 -- of others, as the first
        text = f"its text cannot be read: {type(another).__name__}"
    kind = type(error).__name__
    return visible(" ".join(f"{kind}: {text}".split())).removesuffix(":")


def beginning(line: str) -> str:
    """The part of a line that may be shown: the file may be another one, and a secret."""
    return repr(line) if len(line) <= 20 else f"{line[:20]!r}..."


def require_visible(name: str, fault: type[RpsError]) -> None:
    """Refuse names of files that hold line ends or what does not show."""
    if name != visible(name) or "\n" in name or "\t" in name:
        raise fault(
            f"{name[:200]!r}: the name holds characters that do not show; rename the file"
        )


def stem_of(path: PurePath) -> str:
    """The name of a file without its ending, as the name of a folder."""
    return path.stem if path.stem.strip(". ") else path.name


def is_number(value: object) -> TypeGuard[float]:
    """True of finite real numbers."""
    if not isinstance(value, Real) or isinstance(value, bool):
        return False
    with suppress(OverflowError):
        return math.isfinite(value)
    return False


TRACEBACK = "RPS_TRACEBACK"
"""Environment variable that asks for the traceback of an error
of the program, or of a package."""

SMALLEST = 1e-15
LARGEST = 1e15
"""Magnitudes outside are slips: no building has them in SI units,
and squares would overflow."""


def is_size(value: object) -> bool:
    """True if a value is a number above zero that follows from
    what a building may have.
    """
    return is_number(value) and SMALLEST**2 <= value <= LARGEST**2


def require_fields(made: Any, fault: type[Exception] = ValueError) -> None:
    """Refuse fields of a dataclass that are not what it annotates, in one sentence.

    Numbers are finite, and none that no building has; what a field is left at is right.
    """
    kinds = _kinds(made.__class__)
    for of in (each for each in fields(made) if each.init):
        value = getattr(made, of.name)
        infinite = isinstance(value, float) and value == math.inf == of.default
        if value is not of.default and not infinite and not _fits(value, kinds[of.name]):
            number = f"a finite number up to {LARGEST**2:g}"
            kind = str(of.type).replace("float", number).replace(" | ", " or ")
            raise fault(f"{of.name} = {told(value)[:60]} must be {kind}")


_kinds = cache(get_type_hints)


def origin_of(kind: Any) -> Any:
    """The class of an annotation, also behind an alias, as
    NDArray is one since numpy 2.5.
    """
    origin = get_origin(kind) or kind
    return get_origin(getattr(origin, "__value__", None)) or origin


def _fits(value: object, kind: Any) -> bool:
    origin = origin_of(kind)
    parts = get_args(kind)
    if origin is UnionType:
        return any(_fits(value, part) for part in parts)
    if origin is tuple:
        if not isinstance(value, tuple | list):
            return False
        each = repeat(parts[0]) if parts[-1] is ... else parts
        return (parts[-1] is ... or len(parts) == len(value)) and all(
            map(_fits, value, each)
        )
    if origin in {float, int}:
        return is_number(value) and abs(value) <= LARGEST**2
    if origin is Literal:
        return isinstance(value, str)
    return origin.__name__ == "ndarray" or isinstance(
        value, origin
    )  # any sequence makes an array


def told(value: object) -> str:
    """A value in a message: texts in quotes, numbers of numpy as any others."""
    return str(value) if isinstance(value, Real) else repr(value)


def require_kind(
    value: object, kinds: type | tuple[type, ...], what: str, remedy: str
) -> None:
    """Refuse what a function cannot take, in one sentence."""
    if not isinstance(value, kinds):
        raise UsageError(f"{what} was given as {type(value).__name__}; {remedy}")
