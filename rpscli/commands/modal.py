"""`rps modal`: modes of a case in each of its states."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

import click

from rpscli.commands.inputs import add_film, case_folder, conclude, film_of, read_case
from rpscli.commands.shell import options
from rpscli.errors import listed
from rpscli.report.figures.look import FilmRequest
from rpscli.report.table import Heading, Part, Table, measured, shown

if TYPE_CHECKING:
    from rpscli.analyses.modal import FixedBaseModes, ModalResult


@click.command("modal")
@options.case_options
@options.film_options
@click.option(
    "--first-order", "paper", is_flag=True, help="Also show the values of the paper."
)
@options.result_options
def command(
    request: options.CaseRequest,
    out: options.Output,
    film: FilmRequest | None,
    *,
    paper: bool,
) -> None:
    """Modes of CASE in full contact and, linearised where they
    begin, rolling and rocking.

    Writes modes.csv, shapes.csv, eigenvalues.csv and the figure modes.
    """
    given = read_case(request, out.terminal)
    folder = case_folder(given, out, "modal")
    from rpscli.analyses.modal import modal
    from rpscli.report.bundles import modal_files

    result = modal(given.case.structure)
    folder.add_all(modal_files(result, given.case.title, out.look))
    if film is not None:
        draw = film_of("modes")(result, given.case.title, film, out.look)
        add_film(folder, film, draw, out)
    tables = _tables(result, given.case.title, () if paper else (FIRST_ORDER,))
    conclude(given, folder, result.results(), tables, out.terminal)


ORDER = (
    "Uplifted states are linearised exactly where they begin: rolling at 0, rocking at"
    " beta (0 for flat ends)."
)
NEVER_LIFTS = (
    "Both states are linearised exactly where they begin: rolling at 0, rocking at beta;"
    " ends without a flat part are never in full contact."
)
FIRST_ORDER = "first order"
"""Head of the paper's values: small alpha, rocking continued to 0."""


def _tables(result: ModalResult, title: str, left_out: Collection[str]) -> Iterator[Part]:
    """The podium's own mode, full contact, the fixed base, uplifted, and first yield."""
    yield Heading(title)
    yield _own_mode_table(result).without(left_out)
    rolls = result.structure.bearing.is_spherical
    yield NEVER_LIFTS if rolls else ORDER
    if result.left_out:
        yield f"Not in the modes: {listed(result.left_out, 'and')}."
    yield from _full_contact(result)
    if (fixed := result.fixed_base) is None:
        return
    state = "fixed base" if rolls else result.fixed_base_state.replace("_", " ")
    yield _mode_table(state, fixed)
    if result.vertical is not None:
        yield _mode_table("vertical", result.vertical)
    yield _vibration_table(result).without(left_out)
    at = [
        f"{name.replace('_', ' ')} {measured(first['base_shear'], 'N')} (storey"
        f" {first['storey']})"
        for name, first in result.first_yield.items()
    ]
    if at:
        yield (
            "Modes are those of the elastic building, and end where a storey yields: in"
            f" the first mode at a base shear of {', '.join(at)}."
        )


def _own_mode_table(result: ModalResult) -> Table:
    """The podium's own mode in each uplifted state."""
    rows = []
    for name, (modes, paper) in result.both_orders.items():
        numbers = modes.frequency_parameter, paper.frequency_parameter
        rigid = modes.frequency_parameter_rigid
        rows.append((name, modes.own_motion, *map(shown, (*numbers, rigid))))
    heads = ("podium's own mode", "", "p_ext rad/s", FIRST_ORDER, "rigid estimate")
    return Table.of_texts(heads, rows, words=2)


def _full_contact(result: ModalResult) -> Iterator[Part]:
    """Modes on compliant ends in full contact, and the first period over the fixed one."""
    if (full := result.full_contact) is None:
        return
    yield _mode_table("full contact", full)
    if result.fixed_base is not None and (bed := result.structure.bed) is not None:
        ratio = full.periods[0] / result.fixed_base.periods[0]
        yield (
            f"First period {shown(full.periods[0])} s in full contact, {ratio:.3f} of"
            f" the fixed base, {bed.period_ratio:.3f} without damping. Uplifted"
            " states are linearised as on rigid ends."
        )


def _vibration_table(result: ModalResult) -> Table:
    """Vibrations of the building on uplifted columns."""
    rows = []
    for name, uplifted in result.vibrations():
        for i, (w, xi, ratio, over, *first) in enumerate(uplifted.tolist(), 1):
            percent = shown(100.0 * xi, 3), shown(100.0 * first[1], 3)
            cells = shown(w), shown(first[0]), shown(ratio), *percent, shown(over)
            rows.append((name.replace("_", ", "), str(i), *cells))
    heads = "rad/s", FIRST_ORDER, "of fixed base", "xi %", FIRST_ORDER, "of fixed base"
    state = "on bearings" if result.structure.bearing.is_spherical else "uplifted"
    return Table.of_texts((state, "mode", *heads), rows, words=1, keys=2)


def _mode_table(state: str, modes: FixedBaseModes) -> Table:
    rows = [
        (
            str(i + 1),
            shown(w),
            shown(modes.periods[i]),
            shown(100.0 * modes.damping[i], 3),
        )
        for i, w in enumerate(modes.frequencies)
    ]
    return Table.of_texts((state, "rad/s", "T s", "xi %"), rows)
