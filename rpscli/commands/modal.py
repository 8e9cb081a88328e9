"""`rps modal`: modes of a case in each of its states."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import click

from rpscli.commands.inputs import case_folder, conclude, read_case
from rpscli.commands.shell.options import (
    CaseRequest,
    OutputRequest,
    case_options,
    film_options,
    result_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import counted
from rpscli.errors import listed
from rpscli.report.figures.film import FilmRequest
from rpscli.report.figures.look import Look, drawn_with
from rpscli.report.table import Heading, Part, Table, shown

if TYPE_CHECKING:
    from rpscli.analyses.modal import ModalResult


@click.command("modal")
@case_options
@film_options
@result_options
def command(
    request: CaseRequest,
    output: OutputRequest,
    terminal: Terminal,
    look: Look,
    film: FilmRequest | None,
) -> None:
    """Modes of CASE in full contact and, linearised, rolling and rocking.

    Writes modes.csv, shapes.csv, eigenvalues.csv and the figure modes.
    """
    given = read_case(request, terminal)
    folder = case_folder(given, output, "modal")
    from rpscli.analyses.modal import modal
    from rpscli.report.bundles import modal_files

    result = modal(given.case.structure)
    folder.add_all(modal_files(result, given.case.title, look))
    if film is not None:
        from rpscli.report.figures.animation import modes_film

        with counted("drawing the animation", terminal) as progress:
            draw = partial(modes_film, result, given.case.title, film, progress)
            folder.add_at(film.file, drawn_with(look, film.ending, draw))
    conclude(given, folder, result.results(), _tables(result, given.case.title), terminal)


def _tables(result: ModalResult, title: str) -> Iterator[Part]:
    storey = []
    for name, modes in result.uplifted.items():
        numbers = modes.frequency_parameter, modes.frequency_parameter_rigid
        storey.append((name, modes.own_motion, *map(shown, numbers)))
    yield Heading(title)
    yield Table.of_texts(
        ("storey's own mode", "", "p_ext rad/s", "rigid estimate rad/s"), storey, words=2
    )
    if result.left_out:
        yield f"Not linear, and left out: {listed(result.left_out, 'and')}."
    if (fixed := result.fixed_base) is None:
        return
    rows = [
        (str(i + 1), shown(w), shown(fixed.periods[i]), shown(100.0 * fixed.damping[i], 3))
        for i, w in enumerate(fixed.frequencies)
    ]
    yield Table.of_texts(("full contact", "rad/s", "T s", "xi %"), rows)
    for name, modes in result.uplifted.items():
        states = []
        for i, w in enumerate(modes.frequencies):
            damping = shown(100.0 * modes.damping[i], 3), shown(modes.damping_ratio[i])
            states.append((str(i + 1), shown(w), shown(modes.frequency_ratio[i]), *damping))
        yield Table.of_texts((name, "rad/s", "of fixed base", "xi %", "of fixed base"), states)
