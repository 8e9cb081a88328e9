"""From what stands on the command line to cases, their ground motions and folders of results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import passing_time
from rpscli.errors import CaseError, UsageError
from rpscli.report.documents import heading
from rpscli.report.files import OutputFolder, Run
from rpscli.report.table import Part
from rpscli.units import as_written

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.case.schema.scale_to import ScaleToSection
    from rpscli.records.ground_motion import MotionComponents
    from rpscli.records.recordings import Pair


RESULTS = Path("results")
"""Default folder of results, below the working folder."""


@dataclass(frozen=True, eq=False)
class CaseInput:
    """A case, and where it came from."""

    case: Case
    request: options.CaseRequest

    @property
    def file(self) -> Path | None:
        """The case file; None if it came through the standard input."""
        return None if self.request.source == "-" else Path(self.request.source)


def read_case(request: options.CaseRequest, terminal: Terminal) -> CaseInput:
    """Read and check a case; its warnings go to the terminal."""
    from rpscli.case.case import load_case

    case = load_case(request.source, request.overrides)
    terminal.warn(case.warnings)
    return CaseInput(case, request)


def case_folder(
    given: CaseInput,
    output: options.OutputRequest,
    command: str,
    *,
    record_source: Path | str | None = None,
    **inputs: Any,
) -> OutputFolder:
    """The folder of a command's results, claimed before the work begins."""
    resolved: Mapping[str, Any] = {
        "case": given.case.document,
        "overrides": list(given.request.overrides),
        **inputs,
    }
    run = Run(command, given.case.name, given.file, given.case.digest, resolved, record_source)
    place = output.place or RESULTS / given.case.name / command
    return OutputFolder(place, run, force=output.force)


def write(folder: OutputFolder, terminal: Terminal) -> None:
    """Write all that was collected, draw figures, and say where."""
    replaced = folder.replaces_other_inputs
    with passing_time("writing and drawing", terminal):
        folder.write()
    terminal.warn(folder.undrawn)
    note = "; replaces results of the same case with other inputs" if replaced else ""
    terminal.note(f"written to {folder.folder}{note}")
    if folder.removed:
        terminal.note(f"removed, of an earlier run: {', '.join(sorted(folder.removed))}")


def conclude(
    given: CaseInput,
    folder: OutputFolder,
    results: Mapping[str, Any],
    tables: Iterable[Part],
    terminal: Terminal,
    *,
    plane: bool = True,
    doubts: Sequence[str] = (),
) -> None:
    """Write the files of a command about one case, and give its result with doubts about it."""
    write(folder, terminal)
    terminal.warn(doubts)
    warnings = [*given.case.warnings, *folder.undrawn, *doubts]
    if plane and given.case.structure.superstructure_y is not None:
        warnings.append(
            "superstructure.y is left out: this is the direction x; put --set"
            " superstructure.period=... in its place for y"
        )
        terminal.warn(warnings[-1:])
    document = {
        **heading(folder.run.command),
        "case": case_heading(given),
        **results,
        "warnings": warnings,
        "files": folder.files,
    }
    terminal.result(document, tables)


def case_heading(given: CaseInput) -> dict[str, str]:
    """The case in a JSON document."""
    return {"name": given.case.name, "title": given.case.title, "source": given.case.source}


FACTOR = options.FiniteRange("; scale to an intensity by --scale-to PGA=0.4g")


@dataclass(frozen=True)
class MotionRequest:
    """The ground motion as the command line has it; None leaves it to the case.

    A record that is measured as a pair has both components of that.
    """

    record: str | None = None
    vertical: str | None = None
    scale: float | None = None
    scale_to: str | None = None
    pair: Pair | None = None

    def __post_init__(self) -> None:
        if self.scale is not None and self.scale_to is not None:
            raise UsageError("--scale and --scale-to both fix the factor; keep one of them")


motion_options = options.gathered(
    "motion",
    MotionRequest,
    options.records_option,
    click.option(
        "--vertical",
        metavar="SRC",
        type=options.FILE,
        help="Vertical component, with the same time step; own: that of the recording.",
    ),
    click.option("--scale", type=FACTOR, metavar="FACTOR", help="Factor on the acceleration."),
    click.option(
        "--scale-to",
        metavar="MEASURE=VALUE",
        **options.completing(options.measures),
        help="Scale each record to PGA=0.4g, PGV='50 cm/s', 'Sa(0.6 s)=1g', AvgSa, FIV3, PGD,"
        " Housner, CAV or Arias.",
    ),
)
"""--record as `records`; --vertical, --scale and --scale-to as `motion`."""


def single_motions(
    records: tuple[str, ...],
    request: MotionRequest,
    tell: Callable[[Iterable[str]], None] = lambda _: None,
) -> Iterator[MotionRequest]:
    """One request for each motion that the sources stand for, sets and folders taken apart."""
    if not records:
        yield request
        return
    from rpscli.records.loading import OWN, expanded
    from rpscli.records.recordings import pairs

    single, notes = expanded(records)
    tell(f"--record {text}" for text in notes)
    if len(single) > 1 and request.vertical not in {None, OWN}:
        raise UsageError(f"--vertical {request.vertical}: belongs to one record, not {len(single)}")
    of = None if request.scale_to is None else _parsed_target(request.scale_to).of
    for source, pair in zip(single, pairs(single, of), strict=True):
        yield replace(request, record=source, pair=pair)


def motion_inputs(motion: MotionComponents) -> dict[str, Any]:
    """Identity of a motion in `run.json`; digests are those of the scaled samples."""
    sources = {
        name: {"source": component.source, "sha256": component.digest}
        for name, component in motion.named.items()
    }
    return {"scale": motion.scale, "horizontal": None, "vertical": None, **sources}


def motion_source(case: Case, request: MotionRequest) -> Path | str:
    """The record of a motion, whatever its scale: a file, or a source that is none."""
    from rpscli.records.source import Source

    own = request.record is None
    given = case.record_source if own else Source.parse(request.record or "")
    file = (case.folder if own else Path()) / given.place
    return file if file.is_file() else given


def load_motion(case: Case, request: MotionRequest) -> MotionComponents:
    """Read the motion; a `--record` stands in place of the whole `record` section of the case."""
    from rpscli.records.loading import OWN, load_components, load_record

    given = case.record if request.record is None else None
    how: dict[str, Any] = {}
    if request.record is not None:
        motion = load_components(request.record, request.vertical)
    elif given is None:
        raise UsageError(f"{case.source}: the case names no record; give one with --record")
    else:
        own = given.vertical if request.vertical is None else None
        own = OWN if request.vertical == OWN else own
        how = {"folder": case.folder, "dt": given.dt, "units": given.units}
        rotation = given.rotation or 0.0
        motion = load_components(case.record_source, own, given.y, rotation, **how)
        if request.vertical is not None and request.vertical != OWN:
            motion = replace(motion, vertical=load_record(request.vertical))
    if motion.y is not None and (why := case.structure.planar_only):
        raise CaseError(f"{case.source}: both components of {motion.horizontal.source}: {why}")
    if (aim := _target(case, request)) is not None:
        return _scaled_to(case, request, motion, *aim, how)
    scale = request.scale
    if scale is None:
        scale = 1.0 if given is None else given.scale
    return motion if scale == 1.0 else motion.scaled(scale)


def _target(case: Case, request: MotionRequest) -> tuple[ScaleToSection, str] | None:
    """The measure to scale to, and who asks for it: command line or case."""
    if request.scale is not None:
        return None
    if request.scale_to is not None:
        return _parsed_target(request.scale_to), f"--scale-to {request.scale_to}"
    own = case.record if request.record is None else None
    if own is None or own.scale_to is None:
        return None
    return own.scale_to, f"{case.source}: record.scale_to"


def _scaled_to(
    case: Case,
    request: MotionRequest,
    motion: MotionComponents,
    target: ScaleToSection,
    source: str,
    how: dict[str, Any],
) -> MotionComponents:
    """A motion by the factor that brings a measure of it, or of its pair, to a value."""
    from rpscli.records.loading import load_record
    from rpscli.records.measures import (
        MEASURES,
        USUAL,
        factor_to,
        measure_label,
        measured,
        needs_period,
        pair_measure,
    )

    measure, period = target.measure, target.period
    if needs_period(measure) and period is None:
        building = case.structure.superstructure
        if building is None:
            raise UsageError(f"{source}: without storeys {measure} has no T1 to be taken at")
        period = float(building.periods[0])
    pair = request.pair
    if request.record is None and case.record is not None:
        pair = case.record_pair(target.of)
    if pair is None:
        unscaled, of = measured(motion.horizontal, measure, period, target.damping), None
    else:
        of = target.of or USUAL
        one, other = (load_record(each, **how) for each in pair)
        unscaled = pair_measure(one, other, measure, of, period, target.damping)
    factor = factor_to(target.value, unscaled, measure, motion.horizontal.source)
    name = measure_label(measure, of, f"{period:g} s" if needs_period(measure) else "")
    aim = f"{name} = {as_written(target.value, MEASURES[measure].unit)}"
    return replace(motion.scaled(factor), scaled_to=aim)


def _parsed_target(text: str) -> ScaleToSection:
    """Target of `--scale-to`: ``PGA=0.4g``, ``PGV=0.5 m/s``, or ``Sa(0.6 s)=1 g``."""
    from rpscli.case.schema.scale_to import scale_to_of

    try:
        return scale_to_of(text)
    except ValueError as error:
        raise UsageError(f"--scale-to {text}: {error}") from None
