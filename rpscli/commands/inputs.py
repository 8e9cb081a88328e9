"""From what stands on the command line to cases, their ground
motions and folders of results.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, counted, passing_time
from rpscli.errors import CaseError, RpsError, UsageError, all_made
from rpscli.registry import loaded, of_tools
from rpscli.report.figures.look import FilmRequest
from rpscli.report.files import CommandRun, Drawing, OutputFolder, heading
from rpscli.report.table import Part
from rpscli.units import as_written

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.case.schema.scale_to import ScaleToSection
    from rpscli.model.podium import PodiumStructure
    from rpscli.records.ground_motion import GroundMotion, MotionComponents
    from rpscli.records.recordings import Pair


RESULTS = Path("results")
"""Default folder of results, below the working folder."""


@dataclass(frozen=True, eq=False)
class CaseInput:
    """A case, and where it came from."""

    case: Case
    request: options.CaseRequest

    def seen(self, direction: str) -> PodiumStructure:
        """The structure as a motion along x or y meets it."""
        structure = self.case.structure
        return structure.in_y() if direction == "y" else structure

    def titled(self, direction: str) -> str:
        """The title of the case, with the direction where this is not x."""
        return f"{self.case.title}{', in y' * (direction == 'y')}"

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
    out: options.Output,
    command: str,
    *,
    motion: CaseMotion | None = None,
    record_source: Path | str | None = None,
    **inputs: Any,
) -> OutputFolder:
    """The folder of a command's results, claimed before the work begins."""
    case = given.case
    resolved = {"case": case.document, "overrides": list(given.request.overrides)}
    if motion is not None:
        record_source = motion_source(case, motion.request)
        resolved["record"] = motion_inputs(motion.ground)
    resolved |= inputs
    run = CommandRun(command, case.name, given.file, case.digest, resolved, record_source)
    place = out.place or RESULTS / case.name / command
    return OutputFolder(place, run, force=out.force)


def direction_folder(
    given: CaseInput, out: options.Output, command: str, direction: str, **inputs: Any
) -> OutputFolder:
    """The folder of results in one direction: y has one beside that of x."""
    if direction == "y":
        inputs["direction"] = direction
        place = out.place or RESULTS / given.case.name / f"{command}_y"
        out = replace(out, place=place)
    return case_folder(given, out, command, **inputs)


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
    if folder.kept:
        terminal.note(f"kept, of an earlier run: {', '.join(folder.kept)}")


Draw = Callable[[Callable[[int, int], None]], bytes]
"""Draws an animation, and tells how many of its frames are done, of how many."""


def film_of(subject: str) -> Callable[..., Draw]:
    """Function that makes the animation of a subject from a result, a title, a request
    and a look.

    What cannot be drawn is refused then, before anything is written.
    """
    made: Callable[..., Draw] = loaded(of_tools("films")[subject])
    return made


def add_film(
    folder: OutputFolder,
    film: FilmRequest,
    draw: Draw,
    out: options.Output,
) -> None:
    """Collect an animation, which is told how many of its frames are drawn."""

    def drawn() -> bytes:
        with counted("drawing the animation", out.terminal) as tell:
            return draw(tell)

    folder.add_at(film.file, Drawing(film.file.name, drawn))


def conclude(
    given: CaseInput,
    folder: OutputFolder,
    results: Mapping[str, Any],
    tables: Iterable[Part],
    terminal: Terminal,
    *,
    plane: bool = True,
    direction: str | None = None,
    doubts: Sequence[str] = (),
) -> None:
    """Write the files of a command about one case, and give its
    result with doubts about it; of one `direction` where it may be asked for.
    """
    write(folder, terminal)
    terminal.warn(doubts)
    warnings = [*given.case.warnings, *folder.undrawn, *doubts]
    in_y = given.case.structure.superstructure_y is not None and direction != "y"
    if plane and in_y:
        other = (
            "put --set superstructure.period=... in its place for y"
            if direction is None
            else "--direction y shows the other"
        )
        warnings.append(f"superstructure.y is left out: this is the direction x; {other}")
        terminal.warn(warnings[-1:])
    document = {
        **heading(folder.run.command),
        "case": case_heading(given),
        **({} if direction is None else {"direction": direction}),
        **results,
        "warnings": warnings,
        "files": folder.files,
    }
    terminal.result(document, tables)


def case_heading(given: CaseInput) -> dict[str, str]:
    """The case in a JSON document."""
    return {
        "name": given.case.name,
        "title": given.case.title,
        "source": given.case.source,
    }


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
            raise UsageError(
                "--scale and --scale-to both fix the factor; keep one of them"
            )

    @property
    def words(self) -> list[str]:
        """The motion on a command line."""
        known = {
            "--record": self.record,
            "--vertical": self.vertical,
            "--scale": self.scale,
            "--scale-to": self.scale_to,
        }
        given = [
            (name, str(value)) for name, value in known.items() if value not in (None, "")
        ]
        return [word for option in given for word in option]


class CaseMotion(NamedTuple):
    """A ground motion as it was asked for, and as it was read."""

    request: MotionRequest
    ground: MotionComponents


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
    click.option(
        "--scale", type=FACTOR, metavar="FACTOR", help="Factor on the acceleration."
    ),
    click.option(
        "--scale-to",
        metavar="MEASURE=VALUE",
        **options.completing(options.measures),
        help=(
            "Scale each record to PGA=0.4g, PGV='50 cm/s', 'Sa(0.6 s)=1g', AvgSa, FIV3,"
            " PGD, Housner, CAV or Arias."
        ),
    ),
)
"""--record as `records`; --vertical, --scale and --scale-to as `motion`."""


def single_motions(
    records: tuple[str, ...],
    request: MotionRequest,
    tell: Callable[[Iterable[str]], None] = lambda _: None,
) -> Iterator[MotionRequest]:
    """One request for each motion that the sources stand for, sets
    and folders taken apart.
    """
    if not records:
        yield request
        return
    from rpscli.records.loading import OWN, expanded
    from rpscli.records.recordings import pairs

    single, notes = expanded(records)
    tell(f"--record {text}" for text in notes)
    if len(single) > 1 and request.vertical not in {None, OWN}:
        raise UsageError(
            f"--vertical {request.vertical}: belongs to one record, not {len(single)}"
        )
    of = None if request.scale_to is None else parsed_target(request.scale_to).of
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


def load_motions(
    case: Case, requests: Iterable[MotionRequest], fault: type[RpsError] = RpsError
) -> list[CaseMotion]:
    """All motions; faults of this kind are told together."""
    return all_made(
        lambda each: CaseMotion(each, load_motion(case, each)), requests, fault
    )


def load_motion(case: Case, request: MotionRequest) -> MotionComponents:
    """Read the motion; a `--record` stands in place of the whole
    `record` section of the case.
    """
    from rpscli.records.loading import OWN, load_components, load_record

    given = case.record if request.record is None else None
    how: dict[str, Any] = {}
    if request.record is not None:
        motion = load_components(request.record, request.vertical)
    elif given is None:
        raise UsageError(
            f"{case.source}: the case names no record; give one with --record"
        )
    else:
        own = {None: given.vertical, OWN: OWN}.get(request.vertical)
        how = {"folder": case.folder, "dt": given.dt, "units": given.units}
        motion = load_components(
            case.record_source, own, given.y, given.rotation or 0.0, **how
        )
        if request.vertical is not None and request.vertical != OWN:
            motion = replace(motion, vertical=load_record(request.vertical))
    if motion.y is not None and (why := case.structure.planar_only):
        raise CaseError(
            f"{case.source}: both components of {motion.horizontal.source}: {why}"
        )
    scale = request.scale
    asker = f"{case.source}: record.scale_to"
    aim = given.scale_to if given is not None else None
    if request.scale_to is not None:
        aim = parsed_target(request.scale_to)
        asker = f"--scale-to {request.scale_to}"
    if scale is None and aim is not None:
        pair = request.pair if given is None else case.record_pair(aim.of)
        of = [load_record(each, **how) for each in pair or ()] or [motion.horizontal]
        return _scaled_to(case, motion, of, aim, asker)
    if scale is None:
        scale = 1.0 if given is None else given.scale
    return motion if scale == 1.0 else motion.scaled(scale)


def _scaled_to(
    case: Case,
    motion: MotionComponents,
    of: Sequence[GroundMotion],
    target: ScaleToSection,
    asker: str,
) -> MotionComponents:
    """A motion by the factor that brings a measure of one
    component or a pair to a value.
    """
    from rpscli.records import measures

    measure = target.measure
    period = target.period
    at_period = measures.needs_period(measure)
    if at_period and period is None:
        building = case.structure.superstructure
        if building is None:
            raise UsageError(
                f"{asker}: without storeys {measure} has no T1 to be taken at"
            )
        period = float(building.periods[0])
    (one, *others), how = of, None
    if others:
        how = target.of or measures.USUAL
        unscaled = measures.pair_measure(
            one, others[0], measure, how, period, target.damping
        )
    else:
        unscaled = measures.measured(one, measure, period, target.damping)
    factor = measures.factor_to(target.value, unscaled, measure, motion.horizontal.source)
    name = measures.measure_label(measure, how, f"{period:g} s" if at_period else "")
    aim = f"{name} = {as_written(target.value, measures.MEASURES[measure].unit)}"
    return replace(motion.scaled(factor), scaled_to=aim)


def parsed_target(text: str) -> ScaleToSection:
    """Target of `--scale-to`: ``PGA=0.4g``, ``PGV=0.5 m/s``, or ``Sa(0.6 s)=1 g``."""
    from rpscli.case.schema.scale_to import scale_to_of

    try:
        return scale_to_of(text)
    except ValueError as error:
        raise UsageError(f"--scale-to {text}: {error}") from None
