"""What a panel is asked to draw, examined: a message in place of what Python would make of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any

from rpscli.errors import UsageError


def require(what: str, value: object, known: Iterable[object]) -> None:
    """Refuse what is not there: an index from the end would draw another panel than was asked for.

    Parameters
    ----------
    what
        Is chosen, in the plural.
    value
        What was asked for.
    known
        What there is.

    Raises
    ------
    UsageError
        If it is not among these.
    """
    there = list(known)
    if value not in there:
        names = ", ".join(map(str, there[:3])) + (f" to {there[-1]}" if len(there) > 3 else "")
        raise UsageError(
            f"{str(value)[:60]!r} is none of the {what}; there are {names or 'none to be drawn'}"
        )


def examined(draw: Callable[..., None]) -> Callable[..., None]:
    """A panel that refuses other axes and another result than it is annotated with."""
    axes_name, drawn_name, *_ = (*draw.__annotations__.values(), "")

    @wraps(draw)
    def panel(axes: Any, drawn: Any, *arguments: Any, **named: Any) -> None:
        for value, kind in ((axes, axes_name), (drawn, drawn_name)):
            known = {parent.__name__ for parent in type(value).__mro__}
            if kind.isidentifier() and kind not in known:
                home = "matplotlib" if kind == "Axes" else "rpscli"
                raise UsageError(
                    f"{draw.__name__.replace('draw_', 'a panel of ')}: needs {kind} of {home}"
                    f" where a {type(value).__name__} was given; see help(rpscli.figures)"
                )
        draw(axes, drawn, *arguments, **named)

    return panel
