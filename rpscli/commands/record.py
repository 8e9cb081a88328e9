"""`rps record`: ground motions by themselves."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell.lazy import LazyGroup, Member
from rpscli.commands.shell.options import (
    FILE,
    Command,
    OutputRequest,
    figure_options,
    output_options,
    terminal_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import Refused, UsageError
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look
from rpscli.report.files import OutputFolder, Run, encoded, write_whole

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion


FORMATS = {"at2": ".at2", "text": ".txt"}
"""Formats that can be written, and how their files are called."""


def source_options(function: Command) -> Command:
    """SRC, --dt, --units, --scale as `motions`, those of a pair x and y; warnings are told."""

    @click.argument("source", metavar="SRC", type=FILE)
    @click.option("--dt", type=float, metavar="S", help="Time step of a file that states none [s].")
    @click.option(
        "--units", metavar="UNIT", help="Unit of the values of a file that states none, such as g."
    )
    @click.option(
        "--scale", type=float, default=1.0, metavar="FACTOR", help="Factor on the values."
    )
    @functools.wraps(function)
    def command(*, source: str, scale: float, terminal: Terminal, dt: float | None,
                units: str | None, **rest: Any) -> None:  # fmt: skip
        from rpscli.records.loading import load_components

        read = load_components(source, dt=dt, units=units)
        read = read if scale == 1.0 else read.scaled(scale)
        motions, stem = [read.horizontal], read.horizontal.name.replace("_both", "", 1)
        if read.y is not None:
            named = zip("xy", (read.horizontal, read.y), strict=True)
            motions = [replace(each, name=f"{stem}_{way}") for way, each in named]
        terminal.warn(dict.fromkeys(text for each in motions for text in each.warnings))
        function(motions=motions, terminal=terminal, **rest)

    return command


def record_folder(
    motions: Sequence[GroundMotion], output: OutputRequest, command: str, **inputs: Any
) -> OutputFolder:
    """The folder of a command's results; a record that is no file is known by its samples."""
    from rpscli.records.source import Source

    motion, *others = motions
    file = Path(Source.parse(motion.source).place)
    name = f"{motion.name.removesuffix('_x')}_both" if others else motion.name
    inputs |= {"source": motion.source} | ({"y": others[0].digest} if others else {})
    run = Run(f"record {command}", name, file if file.is_file() else None, motion.digest, inputs)
    place = output.place or RESULTS / name / f"record_{command}"
    return OutputFolder(place, run, force=output.force)


def _result(
    command: str, motions: Sequence[GroundMotion], terminal: Terminal, **more: Sequence[str]
) -> None:
    """The motion that was read and its strength, as document or table."""
    from rpscli.records.measures import intensity_measures
    from rpscli.report.tables.motions import record_document, record_table

    measured = [(motion, intensity_measures(motion)) for motion in motions]
    own, *others = (record_document(*each) for each in measured)
    other = {"y": others[0]} if others else {}
    document = {**heading(f"record {command}"), **own, **other, **more}
    terminal.result(document, [record_table(*each) for each in measured])


@click.command("info")
@terminal_options
@source_options
def info(motions: Sequence[GroundMotion], terminal: Terminal) -> None:
    """How SRC was read, and its intensity measures in SI units."""
    _result("info", motions, terminal)


@click.command("plot")
@terminal_options
@source_options
@figure_options
@output_options
def plot(
    motions: Sequence[GroundMotion], output: OutputRequest, terminal: Terminal, look: Look
) -> None:
    """Draw SRC: acceleration, velocity, displacement and its response spectrum at 5 % damping.

    Writes record.csv, spectrum.csv and the figure record; of a pair x_record.csv, y_record.csv, ...
    """
    from rpscli.records.measures import drawn_spectrum
    from rpscli.report.bundles import record_files

    folder = record_folder(motions, output, "plot")
    for motion, way in zip(motions, ("x_", "y_") if len(motions) > 1 else ("",), strict=True):
        files = record_files(motion, drawn_spectrum(motion), look)
        folder.add_all((f"{way}{name}", content) for name, content in files)
    write(folder, terminal)
    _result("plot", motions, terminal, files=folder.files)


def write_record(
    command: str,
    motions: Sequence[GroundMotion],
    output: OutputRequest,
    terminal: Terminal,
    form: str | None,
) -> None:
    """Write the motions into the folder, or the file, that the command line names."""
    from rpscli.records.formats.at2 import at2_text
    from rpscli.report.tables.motions import two_column_text

    place = Path() if output.place is None else output.place
    endings = {} if place.is_dir() else {ending: form for form, ending in FORMATS.items()}
    named = endings.get(place.suffix.lower())
    if named and form not in {None, named}:
        raise UsageError(f"--to {form}: contradicts the file name {place}")
    if named and len(motions) > 1:
        raise UsageError(f"-o {place}: both components are two files; name a folder, and --to")
    wanted = named or form or "at2"
    contents = [(at2_text if wanted == "at2" else two_column_text)(motion) for motion in motions]
    if named:
        if place.exists() and not output.force:
            raise Refused(f"{place} exists; name another file, or overwrite it with --force")
        write_whole({place: encoded(contents[0])})
        terminal.note(f"written to {place}")
        return _result(command, motions, terminal, files=[str(place)])
    folder = record_folder(motions, output, command, format=wanted)
    names = (f"{motion.name}{FORMATS[wanted]}" for motion in motions)
    folder.add_all(zip(names, contents, strict=True))
    write(folder, terminal)
    return _result(command, motions, terminal, files=folder.files)


@click.command("convert")
@terminal_options
@source_options
@click.option(
    "--to",
    "form",
    type=click.Choice(tuple(FORMATS)),
    help="at2: PEER AT2, in g. text: two columns, s and m/s2. By default by the name after -o,"
    " otherwise at2.",
)
@click.option(
    "--resample", type=float, metavar="S", help="New time step, by linear interpolation [s]."
)
@output_options
def convert(
    motions: Sequence[GroundMotion],
    output: OutputRequest,
    terminal: Terminal,
    form: str | None,
    resample: float | None,
) -> None:
    """Write SRC as a PEER AT2 file or as two columns of text, with another time step if asked.

    The name after -o may also be that of a file: -o motion.at2, -o motion.txt. Of a pair each
    component has a file.
    """
    if resample is not None:
        known = {text for motion in motions for text in motion.warnings}
        motions = [motion.resampled(resample) for motion in motions]
        terminal.warn({text for motion in motions for text in motion.warnings} - known)
    write_record("convert", motions, output, terminal, form)


@click.command("synth")
@terminal_options
@source_options
@output_options
def synth(motions: Sequence[GroundMotion], output: OutputRequest, terminal: Terminal) -> None:
    """Make the motion that SRC describes, and write it as an AT2 file that says so.

    SRC is synthetic:?pga=0.4g&seed=1 (also duration, dt, ground_frequency, ground_damping,
    cut_frequency, cut_damping, pulse_velocity, pulse_period, pulse_cycles) or a pulse such as
    pulse:ricker?amplitude=0.4g&period=1. The same seed gives the same motion.
    """
    motion = motions[0]
    if (form := motion.format) not in ("synthetic", "pulse"):
        raise UsageError(f"{motion.source}: is {form}, not made here; use `rps record convert`")
    write_record("synth", motions, output, terminal, "at2")


MEMBERS = {
    "info": Member("rpscli.commands.record", "what was read, and its intensity measures", "info"),
    "plot": Member("rpscli.commands.record", "time histories and response spectrum", "plot"),
    "select": Member("rpscli.commands.record_select", "motions and factors that fit a spectrum"),
    "convert": Member("rpscli.commands.record", "write it as AT2 or as two columns", "convert"),
    "synth": Member("rpscli.commands.record", "make a pulse or a synthetic motion", "synth"),
}


@click.command("record", cls=LazyGroup, members=MEMBERS)
def command() -> None:
    """Read, draw, select, convert and make ground motions.

    SRC is a file (PEER AT2, columns of numbers, and more; options as in rec.txt?dt=0.01&units=g),
    a member of a set (fema_p695:farfield/1/b), two components at an angle in degrees
    (fema_p695:farfield/1?angle=30, x.at2?second=y.at2&angle=30; `both` in place of the angle has
    them act together in time histories), a pulse
    (pulse:sine?amplitude=0.4g&period=1.2) or a synthetic motion (synthetic:?pga=0.4g&seed=1).
    """
