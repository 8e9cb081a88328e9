"""Options of `rps identify CASE pull-back`, as they are typed."""

from __future__ import annotations

from typing import NamedTuple

import click

from rpscli.commands.shell.options import gathered
from rpscli.errors import UsageError, hint
from rpscli.units import WITH_UNIT, bare_or_si


class PullRequest(NamedTuple):
    """What the command line says of a pull-back test."""

    displacement: str | None = None
    rest: str | None = None
    within: str = "5 mm"
    ranges: tuple[str, ...] = ()


pull_options = gathered(
    "pull",
    PullRequest,
    click.option(
        "--displacement",
        metavar="LOW..HIGH",
        help="pull-back: how far the cap beam was pushed, as '10..13 cm', or one number.",
    ),
    click.option(
        "--rest",
        metavar="LOW..HIGH",
        help="pull-back: time from the release to rest, as '10..15 s', or one number.",
    ),
    click.option(
        "--within",
        metavar="DISTANCE",
        default="5 mm",
        show_default=True,
        help="pull-back: motion of the cap beam that counts as rest.",
    ),
    click.option(
        "--range",
        "ranges",
        multiple=True,
        metavar="NAME=LOW..HIGH",
        help=(
            "pull-back: range of what is not known, semi_diagonal, curvature_ratio,"
            " round_curvature_ratio, wedge_ratio, loss or period; repeatable."
        ),
    ),
)
"""As `pull`."""


def range_of(name: str, text: str, unit: str) -> tuple[float, float]:
    """Two ends in SI, of `10..13 cm` both in cm; of one number both are equal."""
    low, dots, high = (part.strip() for part in text.partition(".."))
    with_unit = WITH_UNIT.match(high)
    bare = WITH_UNIT.match(low)
    if not dots:
        high = low
    elif with_unit and with_unit[2] and bare and not bare[2]:
        low = f"{low} {with_unit[2]}"
    try:
        ends = bare_or_si(low, unit), bare_or_si(high, unit)
    except ValueError as error:
        raise UsageError(
            f"{name} {text}: {error}; write LOW..HIGH, as 10..13 cm"
        ) from None
    if ends[0] > ends[1]:
        raise UsageError(f"{name} {text}: must not fall; write the lower end first")
    return ends


def ranges_given(texts: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Ranges of what is not known, by name."""
    from rpscli.tools.identify.pull_back import UNKNOWN

    found = {}
    for text in texts:
        name, _, wanted = (part.strip() for part in text.partition("="))
        if name not in UNKNOWN:
            known = f"known are {', '.join(UNKNOWN)}"
            raise UsageError(
                f"--range {text}: {name!r} is not known; {hint(name, UNKNOWN, known)}"
            )
        found[name] = range_of(f"--range {name}", wanted, UNKNOWN[name].unit)
    return found
