"""The record that a `rps record` command works on, and the folder of its results."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.case_input import RESULTS
from rpscli.commands.shell.completions import FILE
from rpscli.commands.shell.options import Command, OutputRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.report.files.output_folder import OutputFolder, Run

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion


def source_options(function: Command) -> Command:
    """SRC, --dt, --units and --scale, as `motion`; the record's warnings go to the terminal."""

    @click.argument("source", metavar="SRC", type=FILE)
    @click.option("--dt", type=float, metavar="S", help="Time step of a file that states none [s].")
    @click.option(
        "--units", metavar="UNIT", help="Unit of the values of a file that states none, such as g."
    )
    @click.option(
        "--scale", type=float, default=1.0, metavar="FACTOR", help="Factor on the values."
    )
    @functools.wraps(function)
    def command(
        *,
        source: str,
        dt: float | None,
        units: str | None,
        scale: float,
        terminal: Terminal,
        **rest: Any,
    ) -> None:
        from rpscli.records.source import load_record

        motion = load_record(source, dt=dt, units=units)
        if scale != 1.0:
            motion = motion.scaled(scale)
        terminal.warn(motion.warnings)
        function(motion=motion, terminal=terminal, **rest)

    return command


def record_folder(
    motion: GroundMotion, output: OutputRequest, command: str, **inputs: Any
) -> OutputFolder:
    """The folder of a command's results; a record that is no file is known by its samples."""
    place = Path(motion.source.partition("?")[0])
    run = Run(
        f"record {command}",
        motion.name,
        place if place.is_file() else None,
        motion.digest,
        {"source": motion.source, **inputs},
    )
    folder = output.place or RESULTS / motion.name / f"record_{command}"
    return OutputFolder(folder, run, force=output.force)
