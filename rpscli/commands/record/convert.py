"""`rps record convert`: a ground motion in another format."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpscli.commands.record.files import FORMATS, write_record
from rpscli.commands.record.input import source_options
from rpscli.commands.shell.options import OutputRequest, output_options, terminal_options
from rpscli.commands.shell.terminal import Terminal

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion


@click.command("convert")
@terminal_options
@source_options
@click.option(
    "--to",
    "form",
    type=click.Choice(tuple(FORMATS)),
    help="at2: PEER AT2, in g. text: two columns, s and m/s2. By default what the name after -o"
    " says, else at2.",
)
@click.option(
    "--resample", type=float, metavar="S", help="Time step to sample it at, linear between [s]."
)
@output_options
def command(
    motion: GroundMotion,
    output: OutputRequest,
    terminal: Terminal,
    form: str | None,
    resample: float | None,
) -> None:
    """Write SRC as a PEER AT2 file or as two columns of text, with another time step if asked.

    The name after -o may also be that of a file: -o motion.at2, -o motion.txt.
    """
    if resample is not None:
        known = motion.warnings
        motion = motion.resampled(resample)
        terminal.warn(text for text in motion.warnings if text not in known)
    write_record("convert", motion, output, terminal, form)
