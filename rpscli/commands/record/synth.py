"""`rps record synth`: a ground motion that nobody recorded."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpscli.commands.record.files import write_record
from rpscli.commands.record.input import source_options
from rpscli.commands.shell.options import OutputRequest, output_options, terminal_options
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import UsageError

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion

MADE = ("synthetic", "pulse")


@click.command("synth")
@terminal_options
@source_options
@output_options
def command(motion: GroundMotion, output: OutputRequest, terminal: Terminal) -> None:
    """Make the motion that SRC describes, and write it as an AT2 file that says so.

    SRC is synthetic:?pga=0.4g&seed=1 (also duration, dt, ground_frequency, ground_damping,
    cut_frequency, cut_damping, pulse_velocity, pulse_period, pulse_cycles) or a pulse such as
    pulse:ricker?amplitude=0.4g&period=1. The same seed gives the same motion.
    """
    if motion.format not in MADE:
        raise UsageError(
            f"{motion.source}: is {motion.format}, not made here; use `rps record convert`"
        )
    write_record("synth", motion, output, terminal, "at2")
