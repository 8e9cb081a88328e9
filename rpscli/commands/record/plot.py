"""`rps record plot`: a ground motion at a glance."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpscli.commands.case_input import write
from rpscli.commands.record.info import record_tables
from rpscli.commands.record.input import record_folder, source_options
from rpscli.commands.shell.options import (
    OutputRequest,
    figure_options,
    output_options,
    terminal_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion

DAMPING = 0.05


@click.command("plot")
@terminal_options
@source_options
@figure_options
@output_options
def command(motion: GroundMotion, output: OutputRequest, terminal: Terminal, look: Look) -> None:
    """Draw SRC: acceleration, velocity, displacement and its response spectrum at 5 % damping.

    Writes record.csv, spectrum.csv and the figure record.
    """
    import numpy as np

    from rpscli.records.measures import intensity_measures
    from rpscli.records.spectrum import response_spectrum
    from rpscli.report.bundles import record_files
    from rpscli.report.tables.record import record_document

    folder = record_folder(motion, output, "plot")
    periods = np.concatenate([np.arange(0.0, 1.0, 0.02), np.arange(1.0, 4.01, 0.05)])
    spectrum = response_spectrum(motion, periods, DAMPING)
    for name, content in record_files(motion, spectrum, look):
        folder.add(name, content)
    write(folder, terminal)
    measures = intensity_measures(motion)
    document = {
        **heading(),
        "command": "record plot",
        **record_document(motion, measures),
        "files": folder.files,
    }
    terminal.result(document, record_tables(motion, measures))
