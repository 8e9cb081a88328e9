"""Things by name: ours, and those that other packages add by entry points `rpscli.<kind>`.

Other packages are looked for when a name is none of ours, and where all are listed. One that is
broken is named where it is asked for, and left out where others are.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass, replace
from functools import cache, wraps
from inspect import isgenerator
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

from rpscli.errors import PluginError, RpsError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Item = TypeVar("Item")


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

    Each of theirs must be an `item`, or a function where that is None. Its functions are guarded:
    what they raise by mistake is a `PluginError` that names the package.
    """

    def __init__(self, kind: str, ours: dict[str, Item], item: type | None = None) -> None:
        super().__init__(ours)
        self.kind, self._item = kind, item

    def __missing__(self, name: str) -> Item:
        point = _points(self.kind).get(name)
        if point is None:
            raise KeyError(name)
        offered, what = _loaded(point), _named(point)
        fits = callable(offered) if self._item is None else isinstance(offered, self._item)
        if not fits:
            wanted = "a function" if self._item is None else f"a {self._item.__name__}"
            raise PluginError(f"{what} is a {type(offered).__name__}, and must be {wanted}")
        item: Item = _guarded(offered, what)
        return item

    def names(self) -> list[str]:
        """All names, ours first; nothing is imported."""
        return list({**self, **_points(self.kind)})

    def theirs(self) -> Iterator[tuple[str, Item]]:
        """Items of other packages that can be used."""
        for name in _points(self.kind):
            try:
                if name not in self:
                    yield name, self[name]
            except PluginError:  # told where it is asked for, and by `rps explain plugins`
                continue

    def everything(self) -> dict[str, Item]:
        """Ours, and what other packages add, as far as it can be used."""
        return {**self, **dict(self.theirs())}

    def among(self, names: Iterable[object]) -> dict[str, Item]:
        """Ours and, where others are named, what can be used; what is named must be usable."""
        others = [name for name in names if isinstance(name, str) and name not in self]
        if not others:
            return dict(self)
        named = {name: self[name] for name in others if name in self.names()}
        return {**self.everything(), **named}

    def offers(self) -> Iterator[Offer]:
        """Items of other packages, usable or not."""
        for name, point in _points(self.kind).items():
            meaning, fault = "", "rps has one of this name, which is taken" if name in self else ""
            if not fault:
                try:
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
    return f"{point.dist.name} {point.dist.version}" if point.dist else "an unknown package"


def _named(point: EntryPoint) -> str:
    return f"{point.group}: {point.name} of {_package(point)} ({point.value})"


@cache
def _loaded(point: EntryPoint) -> Any:
    try:
        return point.load()
    except Exception as error:
        raise PluginError(f"{_named(point)}: {type(error).__name__}: {error}") from error


def _parts(item: Any) -> dict[str, Any]:
    """Functions and classes that a dataclass holds."""
    values = {each.name: getattr(item, each.name) for each in fields(item)}
    return {name: value for name, value in values.items() if callable(value)}


def _guarded(item: Any, what: str) -> Any:
    if isinstance(item, type):
        return item
    if is_dataclass(item):
        parts = {name: _guarded(part, what) for name, part in _parts(item).items()}
        return replace(cast("Any", item), **parts)

    @wraps(item)
    def function(*arguments: Any, **named: Any) -> Any:
        try:
            made = item(*arguments, **named)
            return list(made) if isgenerator(made) else made
        except RpsError:
            raise
        except Exception as error:
            raise PluginError(f"{what}: {type(error).__name__}: {error}") from error

    return function


def _meaning(item: Any) -> str:
    described = next(iter(_parts(item).values())) if is_dataclass(item) else item
    return (described.__doc__ or "").strip().split("\n")[0]
