"""Things by name: ours, those of our tools, and those that other packages add by
entry points `rpscli.<kind>`.

A tool is a folder of `rpscli.tools`, whose `OFFERS` name by kind what it adds, as entry
points do: "module:attribute". No tool is imported before one of its names is wanted, and
one whose folder is not there adds nothing.

Other packages are looked for when a name is none of ours, and where all are listed. One
that is broken is named where it is asked for, and left out where others are.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from copy import copy
from dataclasses import is_dataclass, replace
from functools import cache, wraps
from pathlib import Path
from threading import local
from traceback import format_exception
from types import ModuleType
from typing import (
    TYPE_CHECKING,
    Any,
    Literal,
    NamedTuple,
    TextIO,
    TypeVar,
    get_args,
    get_origin,
    get_type_hints,
)

from rpscli.errors import (
    TRACEBACK,
    PluginError,
    RpsError,
    is_number,
    origin_of,
    visible,
    words_of,
)

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Item = TypeVar("Item")


TOOLS = "rpscli.tools"


@cache
def tools() -> list[ModuleType]:
    """The packages of all tools, which say what they offer: kind, name, target."""
    from importlib import import_module
    from pkgutil import iter_modules

    folder = str(Path(__file__).parent / "tools")
    names = sorted(each.name for each in iter_modules([folder]))
    return [import_module(f"{TOOLS}.{name}") for name in names]


def of_tools(kind: str) -> dict[str, str]:
    """Targets by name of what tools offer of a kind."""
    offered = [tool.OFFERS.get(kind, {}) for tool in tools()]
    return {name: target for each in offered for name, target in each.items()}


def loaded(target: str) -> Any:
    """Object that a target names, imported now."""
    from importlib import import_module

    module, _, attribute = target.partition(":")
    return getattr(import_module(module), attribute)


def all_of_tools(kind: str) -> dict[str, Any]:
    """By name what tools offer of a kind, imported now."""
    return {name: loaded(target) for name, target in of_tools(kind).items()}


class Offer(NamedTuple):
    """An item of another package; `fault` says why it cannot be used, empty if it can."""

    kind: str
    name: str
    package: str
    target: str
    meaning: str
    fault: str


class Registry(dict[str, Item]):
    """Ours by name, of one `kind`; subscripts also find what other packages add.

    Theirs must be an `item`, a dataclass or a `Callable[[...], ...]`, and their
    functions give what it says: all else is a `PluginError` that names the
    package. Some names are `taken`.
    """

    def __init__(
        self, kind: str, ours: dict[str, Item], item: Any, taken: Collection[str] = ()
    ) -> None:
        super().__init__(ours)
        self.kind = kind
        self._item = item
        self._taken = taken

    def __missing__(self, name: str) -> Item:
        point = _points(self.kind).get(name)
        if point is None:
            raise KeyError(name)
        with self.blaming(name):
            if fault := self._fault(name):
                raise ValueError(fault)
            item: Item = _sound(_loaded(point), self._item, "it", _named(point))
        return item

    def _fault(self, name: str) -> str:
        if name in self or name in self._taken:
            return "rps has one of this name, which is taken"
        known = name.replace("-", "_").isidentifier()
        return (
            "" if known else f"{name!r} must be letters, digits, _ and -, a letter first"
        )

    def blaming(self, name: str, *, aside: bool = True) -> AbstractContextManager[None]:
        """Errors of what follows are those of the package that adds a name.

        What it prints goes `aside`, to the standard error; a command's own results do not.
        """
        return blaming(self.owner(name), aside=aside)

    def owner(self, name: str) -> str:
        """The package that adds a name, as messages name it."""
        return _named(_points(self.kind)[name])

    def names(self) -> list[str]:
        """All names, ours first; nothing is imported."""
        return list({**self, **_points(self.kind)})

    def theirs(self) -> Iterator[tuple[str, Item]]:
        """Items of other packages that can be used."""
        for name in _points(self.kind):
            try:
                if name not in self:
                    yield name, self[name]
            except (
                PluginError
            ):  # told where it is asked for, and by `rps explain plugins`
                continue

    def everything(self) -> dict[str, Item]:
        """Ours, and what other packages add, as far as it can be used."""
        return {**self, **dict(self.theirs())}

    def offers(self) -> Iterator[Offer]:
        """Items of other packages, usable or not."""
        for name, point in _points(self.kind).items():
            meaning = ""
            fault = self._fault(name)
            if not fault:
                try:
                    with self.blaming(name):
                        meaning = _meaning(self[name])
                except PluginError as error:
                    fault = str(error)
            yield Offer(self.kind, name, _package(point), point.value, meaning, fault)


@cache
def _points(kind: str) -> dict[str, EntryPoint]:
    from importlib.metadata import entry_points  # takes 60 ms

    points = sorted(entry_points(group=f"rpscli.{kind}"), key=lambda point: point.name)
    return {point.name: point for point in points}


def _package(point: EntryPoint) -> str:
    return (
        f"{point.dist.name} {point.dist.version}" if point.dist else "an unknown package"
    )


def _named(point: EntryPoint) -> str:
    return f"{point.group}: {point.name} of {_package(point)} ({point.value})"


@cache
def _loaded(point: EntryPoint) -> Any:
    return point.load()


@contextmanager
def blaming(
    what: str, *passing: type[BaseException], aside: bool = True
) -> Iterator[None]:
    """Errors of what follows are told as those of `what`, but for
    ours and those `passing`; its traceback is shown if that is asked for.
    """
    try:
        with printed_aside() if aside else nullcontext():
            yield
    except BaseException as error:  # whatever others raise is theirs
        if isinstance(error, (RpsError, KeyboardInterrupt, *passing)):
            raise
        if os.environ.get(TRACEBACK) and sys.stderr is not None:
            with suppress(OSError):
                sys.stderr.write(visible("".join(format_exception(error))))
        raise PluginError(f"{what}: {words_of(error)}") from error


class _Printing(local):
    """Depth of a thread inside functions of packages."""

    depth = 0


_printing = _Printing()


@contextmanager
def printed_aside() -> Iterator[None]:
    """Send what this thread prints meanwhile to the standard error, if the standard
    output is `Shared`.
    """
    _printing.depth += 1
    try:
        yield
    finally:
        _printing.depth -= 1


class Shared:
    """The standard output, for results alone: what packages print goes elsewhere.

    Streams are of all threads, and packages may be asked in several.
    """

    def __init__(self, results: TextIO, others: TextIO) -> None:
        self._results = results
        self._others = others

    def _stream(self) -> TextIO:
        return self._others if _printing.depth else self._results

    def write(self, text: str) -> int:
        """To where it belongs."""
        return self._stream().write(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream(), name)


@contextmanager
def shared_output() -> Iterator[None]:
    """The standard output is `Shared` meanwhile."""
    before = sys.stdout
    if before is None or sys.stderr is None:
        yield
        return
    shared: Any = Shared(before, sys.stderr)
    sys.stdout = shared
    try:
        yield
    finally:
        if sys.stdout is shared:
            sys.stdout = before


def _sound(value: Any, kind: Any, name: str, what: str) -> Any:
    """A value of the kind that an annotation names; its
    functions give what theirs say.
    """
    origin = origin_of(kind)
    kinds = get_args(kind)
    if origin is Callable and callable(value):
        return _guarded(value, kinds[-1], what)
    if kind is None or type(None) in (kind, *kinds):
        # Functions that draw give nothing.
        return None if value is None or not kinds else _sound(value, kinds[0], name, what)
    if origin is bool or (origin is float and is_number(value)):
        return origin(value)
    if origin is Iterable:
        return [_sound(each, kinds[0], name, what) for each in value]
    fits = (
        value in kinds
        if origin is Literal
        else origin is Any or isinstance(value, origin)
    )
    if origin is float or not fits:
        shown = (
            f"{value}" if isinstance(value, float) else f"of type {type(value).__name__}"
        )
        known = {float: "a finite number", Callable: "a function"}
        wanted = known.get(origin) or getattr(origin, "__name__", kind)
        raise TypeError(f"{name} is {shown}, and must be {wanted}")
    hints = get_type_hints(origin) if is_dataclass(origin) else {}
    each = [part for kind in hints.values() for part in (kind, *get_args(kind))]
    if not any(get_origin(part) is Callable for part in each):
        return value  # which has guarded itself
    return replace(
        value, **{n: _sound(getattr(value, n), k, n, what) for n, k in hints.items()}
    )


GUARD = "guards"
"""Attribute of functions that check what another package's give: that package."""


def _guarded(function: Callable[..., Any], kind: Any, what: str) -> Callable[..., Any]:
    name = f"what {getattr(function, '__name__', 'it')} gives"

    @wraps(function)
    def guarded(*arguments: Any, **named: Any) -> Any:
        import numpy as np  # slow

        with blaming(what):
            given = [apart(each) for each in arguments]
            made = _sound(function(*given, **named), kind, name, what)
            if isinstance(made, np.ndarray):
                good = made.shape == np.shape(arguments[0]) and np.all(np.isfinite(made))
                if not good:
                    raise ValueError(
                        f"{name} must be finite, a number for each that it gets"
                    )
            return made

    setattr(guarded, GUARD, what)
    return guarded


def owner_of(function: Any, otherwise: str) -> str:
    """The package of a function that checks what it gives, as
    messages name it.
    """
    return str(getattr(function, GUARD, otherwise))


def apart(value: Any, copies: dict[int, Any] | None = None) -> Any:
    """A value that functions of packages may write to without
    changing ours: dataclasses copied, arrays of ours are read-only.
    """
    if not is_dataclass(value) or isinstance(value, type):
        return value
    copies = {} if copies is None else copies
    if id(value) in copies:
        return copies[id(value)]
    made = copies[id(value)] = copy(value)
    for name, inner in vars(value).items() if hasattr(value, "__dict__") else ():
        if is_dataclass(inner):
            object.__setattr__(made, name, apart(inner, copies))
    return made


def _meaning(item: Any) -> str:
    if text := getattr(item, "help", None):  # of a command
        return " ".join(text.split("\n\n")[0].split())
    functions = (
        filter(callable, vars(item).values()) if is_dataclass(item) else iter([item])
    )
    return summary_of(next(functions))


def summary_of(item: Any) -> str:
    """The first sentence of an object's docstring, in one line; empty without one."""
    first, *_ = (item.__doc__ or "").strip().split("\n\n")
    return " ".join(first.split())
