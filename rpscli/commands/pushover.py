"""`rps pushover`: static characteristics of a case."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from rpscli.analyses.result_quantities import PUSHOVER
from rpscli.commands.inputs import conclude, direction_folder, read_case
from rpscli.commands.shell import options
from rpscli.errors import UsageError
from rpscli.report.derived import NEVER_LIFTS
from rpscli.report.table import Heading, Part, Table, measured, shown

if TYPE_CHECKING:
    from rpscli.analyses.pushover import PatternName, PushoverResult


@click.command("pushover")
@options.case_options
@options.direction_option
@click.option(
    "--pattern",
    "patterns",
    multiple=True,
    metavar="PATTERN",
    help=(
        "Floor forces: uniform, triangular, first_mode, or f1,f2,... from the bottom;"
        " repeatable. All three named ones by default."
    ),
)
@options.result_options
def command(
    request: options.CaseRequest,
    out: options.Output,
    patterns: tuple[str, ...],
    direction: str,
) -> None:
    """Restoring force of the podium of CASE, and capacity curves of the whole structure.

    Writes storey_curve.csv and, for a case with storeys, capacity.csv, a
    figure of each, and the figure bearing: columns at rest, where rolling ends
    and at the critical rotation.
    """
    given = read_case(request, out.terminal)
    from rpscli.analyses.pushover import PATTERNS, pushover
    from rpscli.report.bundles import pushover_files

    if patterns and given.case.structure.superstructure is None:
        raise UsageError("--pattern: the case has no storeys to push at")
    asked = [_pattern(text) for text in patterns] or PATTERNS
    folder = direction_folder(given, out, "pushover", direction, patterns=list(asked))
    title = given.titled(direction)
    try:
        result = pushover(given.seen(direction), patterns=asked)
    except ValueError as error:
        raise UsageError(f"--pattern: {error}") from None
    folder.add_all(pushover_files(result, title, out.look))
    conclude(
        given,
        folder,
        result.results(),
        _tables(result, title),
        out.terminal,
        direction=direction,
        doubts=result.warnings,
    )


def _pattern(text: str) -> PatternName | list[float]:
    from rpscli.analyses.pushover import PATTERNS

    try:
        known = next((name for name in PATTERNS if name == text), None)
        return known or [float(force) for force in text.split(",")]
    except ValueError:
        names = ", ".join(PATTERNS)
        remedy = f"write {names}, or floor forces from the bottom as in 1,2,3"
        raise UsageError(f"--pattern {text}: {remedy}") from None


def _tables(result: PushoverResult, title: str) -> Iterator[Part]:
    scalars = {
        q.name: (q.label, measured(getattr(result, q.name), q.unit)) for q in PUSHOVER
    }
    label, stiffness = scalars["initial_stiffness"]
    yield Heading(title)
    rolls = result.structure.bearing.is_spherical
    label = NEVER_LIFTS["initial_stiffness"] if rolls else label
    yield Table.listing([
        *([] if rolls else [scalars["uplift_force"]]),
        ("stiffness in full contact" if result.structure.bed else label, stiffness),
        *_largest_force(result),
        scalars["critical_rotation"],
        scalars["critical_displacement"],
        ("lift at the critical rotation", measured(float(result.curve.lift[-1]), "m")),
    ])  # fmt: skip
    if result.capacity:
        heads = ("pattern", "roof at uplift m", "largest sum of floor forces kN")
        capacity = []
        for curve in result.capacity:
            largest = shown(float(curve.sum_of_floor_forces.max()) * 1e-3)
            capacity.append(
                (curve.pattern, shown(curve.roof_displacement_at_uplift), largest)
            )
        table = Table.of_texts(heads, capacity)
        yield table.without(["roof at uplift m"] * rolls)
    yield from _yielding_tables(result)


def _largest_force(result: PushoverResult) -> Iterator[tuple[str, str]]:
    """The largest force that holds the cap beam, and what of it devices take."""
    most = int(result.curve.force.argmax())
    force = float(result.curve.force[most])
    bare = float(result.structure.path(result.curve.rotation)[0][most])
    at = measured(float(result.curve.displacement[most]), "m")
    yield "largest force at the cap beam", f"{measured(force, 'N')} at {at}"
    if result.structure.devices:
        yield "  of it by devices", measured(force - bare, "N")


def _yielding_tables(result: PushoverResult) -> Iterator[Part]:
    """Storeys that yield on the capacity curves, and where each begins."""
    building = result.structure.superstructure
    if building is None or building.strengths is None:
        return
    uplift = result.uplift_force or math.nan  # spherical ends have none
    rows = [
        (curve.pattern, str(storey), shown(1e-3 * force), shown(force / uplift))
        for curve in result.capacity
        for storey, force in sorted(curve.yielding.items(), key=lambda item: item[1])
    ]
    if not rows:
        first = "roll" if result.structure.bearing.is_spherical else "lift"
        yield f"columns {first} first: pushed slowly no storey ever yields, only in motion"
        return
    heads = "pattern", "storey yields", "at floor forces of kN", "of uplift force"
    table = Table.of_texts(heads, rows)
    yield table if result.uplift_force else table.without(heads[-1:])
    if building.hardening == 0.0:
        yield "without hardening a curve ends where the first storey yields: it is a mechanism then"
