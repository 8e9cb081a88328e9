"""`rps modal`: modes of a case in each of its states."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

import click

from rpscli.commands.inputs import (
    add_film,
    conclude,
    direction_folder,
    film_of,
    read_case,
)
from rpscli.commands.shell import options
from rpscli.errors import listed
from rpscli.report.derived import twist_texts
from rpscli.report.figures.look import FilmRequest
from rpscli.report.table import Heading, Part, Table, measured, shown

if TYPE_CHECKING:
    from rpscli.analyses.modal import FixedBaseModes, ModalResult


@click.command("modal")
@options.case_options
@options.direction_option
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
    direction: str,
    paper: bool,
) -> None:
    """Modes of CASE in full contact and, linearised where they
    begin, rolling and rocking.

    Writes modes.csv, shapes.csv, eigenvalues.csv and the figure modes.
    """
    given = read_case(request, out.terminal)
    folder = direction_folder(given, out, "modal", direction)
    title = given.titled(direction)
    from rpscli.analyses.modal import modal
    from rpscli.report.bundles import modal_files

    result = modal(given.seen(direction))
    folder.add_all(modal_files(result, title, out.look))
    if film is not None:
        draw = film_of("modes")(result, title, film, out.look)
        add_film(folder, film, draw, out)
    tables = _tables(result, title, () if paper else (FIRST_ORDER,))
    conclude(given, folder, result.results(), tables, out.terminal, direction=direction)


ORDER = (
    "Uplifted states are linearised exactly where they begin: rolling at 0, rocking at"
    " beta (0 for flat ends)."
)
NEVER_LIFTS = (
    "Both states are linearised exactly where they begin: rolling at 0, rocking at beta;"
    " ends without a flat part are never in full contact."
)
SAME = 0.01
"""Of a frequency and a damping ratio: vertical modes that change less are told in a
line.
"""

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
    yield from twist_texts(result.structure)
    yield from _full_contact(result)
    if (fixed := result.fixed_base) is None:
        return
    state = "fixed base" if rolls else result.fixed_base_state.replace("_", " ")
    yield _mode_table(state, fixed)
    if result.vertical is not None:
        yield _mode_table("vertical", result.vertical)
    yield _vibration_table(result).without(left_out)
    if same := _unchanged(result):
        names = listed([name.removesuffix("_vertical") for name in same], "and")
        most = 100.0 * max(same.values())
        yield (
            f"Vertical modes when {names} differ from those above by at most"
            f" {shown(most, 2)} % in frequency and damping."
        )
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
    heads = (
        "podium's own mode",
        "",
        "undamped p_ext rad/s",
        FIRST_ORDER,
        "rigid estimate",
    )
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
    """Vibrations of the building on uplifted columns; of vertical ones only those that
    uplift changes.
    """
    rows = []
    for name, uplifted in result.vibrations():
        if name in _unchanged(result):
            continue
        for i, (w, xi, ratio, over, *first) in enumerate(uplifted.tolist(), 1):
            percent = shown(100.0 * xi, 3), shown(100.0 * first[1], 3)
            period = shown(2.0 * math.pi / w)
            cells = shown(w), period, shown(first[0]), shown(ratio), *percent, shown(over)
            rows.append((name.replace("_", ", "), str(i), *cells))
    of_fixed = "of fixed base"
    heads = "rad/s", "T s", FIRST_ORDER, of_fixed, "xi %", FIRST_ORDER, of_fixed
    state = "on bearings" if result.structure.bearing.is_spherical else "uplifted"
    return Table.of_texts((state, "mode", *heads), rows, words=1, keys=2)


def _unchanged(result: ModalResult) -> dict[str, float]:
    """Blocks of vertical modes that are nearly those of full contact, and their largest
    change of frequency or damping.
    """
    changes = {
        name: [abs(ratio - 1.0) for ratio in modes[:, 2:4].ravel().tolist()]
        for name, modes in result.vibrations()
        if name.endswith("_vertical")
    }
    return {
        name: max(found)
        for name, found in changes.items()
        if all(change <= SAME for change in found)  # not a number without damping
    }


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
