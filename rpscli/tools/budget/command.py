"""`rps budget`: what moves each limited result of a case, and which
of it turns the verdict.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import click

from rpscli.commands import inputs
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, announce_compilation, counted
from rpscli.errors import AnalysisError, RpsError

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.records.ground_motion import MotionComponents
    from rpscli.tools.budget.report import Budget, BudgetRow

PERIOD_RATIO = 1.2
LOSSES = (0.3, 0.6, 0.9, 1.2)
FAR_FIELD = "fema_p695:farfield/*"

Wish = tuple[str, tuple[str, ...], inputs.MotionRequest | str]
"""Cause, values for `--set`, and the motion; or why there is none."""


@click.command("budget")
@options.case_options
@inputs.motion_options
@options.result_options
def command(
    request: options.CaseRequest,
    records: tuple[str, ...],
    out: options.Output,
    motion: inputs.MotionRequest,
) -> None:
    """Change of each limited result of CASE for one input at a time,
    in the unit of its limit.

    Numerics, loss at impacts, contact, the other component, damping, a tenth of the
    period, a fifth of strengths and devices, 1 % of the motion and of the dimensions,
    vertical motion, records: of several --record the first is the history itself, else
    the far-field set of FEMA P695 at its PGA shows the scatter. Each row names the
    options with which `rps timehistory CASE` gives its numbers. The exit code is 0
    whatever the verdicts are.
    """
    given = inputs.read_case(request, out.terminal)
    single = inputs.single_motions(records, motion, out.terminal.warn)
    motions = inputs.load_motions(given.case, single)
    folder = inputs.case_folder(given, out, "budget", motion=motions[0], records=records)
    announce_compilation(out.terminal)
    found = case_budget(given, motions, out.terminal)
    folder.add_all(found.files(out.look))
    plane = motions[0].ground.y is None
    inputs.conclude(
        given, folder, found.document(), found.tables(), out.terminal, plane=plane
    )


def case_budget(
    given: inputs.CaseInput, motions: Sequence[inputs.CaseMotion], terminal: Terminal
) -> Budget:
    """All rows of a case under the first of its motions."""
    from rpscli.tools.budget.report import Budget

    wishes = [("as it is", (), motions[0].request), *_wishes(given.case, motions)]
    rows = []
    with counted(f"{len(wishes)} histories", terminal) as tell:
        for wish in wishes:
            rows.append(_row(given, *wish))
            tell(len(rows), len(wishes))
    if rows[0].refused:
        raise AnalysisError(rows[0].refused)
    return Budget(given.case, rows)


def _row(
    given: inputs.CaseInput,
    cause: str,
    sets: tuple[str, ...],
    motion: inputs.MotionRequest | str,
) -> BudgetRow:
    """Row that `rps timehistory` would find; the sentence of a refusal."""
    from rpscli.analyses.timehistory import time_history
    from rpscli.case.case import case_from_mapping
    from rpscli.commands.timehistory_run import limited
    from rpscli.tools.budget.report import BudgetRow

    if isinstance(motion, str):
        return BudgetRow(cause, "", "", "", {}, "", motion)
    words = [*options.set_words((*given.request.overrides, *sets)), *motion.words]
    change = (
        re.sub(r"^[\w.]*\.|contact=|kind: |[{}]", "", sets[0])
        if sets
        else " ".join(words)
    )
    row = BudgetRow(cause, change, shlex.join(words), "", {}, "", "")
    case = given.case
    try:
        if sets:
            written = case.written or case.document
            case = case_from_mapping(written, case.source, case.folder, sets)
        ground = inputs.load_motion(case, motion)
        result = time_history(case.structure, ground, case.analysis)
        if result.failure:
            raise AnalysisError(result.failure)
    except RpsError as error:
        return row._replace(refused=str(error).replace("\n", "; "))
    source = ground.horizontal.source
    return row._replace(outcome=result.outcome, values=limited(result), record=source)


def _wishes(case: Case, motions: Sequence[inputs.CaseMotion]) -> Iterator[Wish]:
    """All changes, in the order of the tables."""
    motion, ground = motions[0]
    for cause, *texts in _values(case):
        yield cause, tuple(texts), motion
    given = [f"superstructure.{name}=null" for name in ("vertical_period", "vertical_damping")
             if getattr(case.file.superstructure, name) is not None]  # fmt: skip
    if given:
        yield "vertical period", tuple(given), motion
    if (damping := case.file.superstructure.damping) is None:
        yield "damping", (), "the case has no storeys, and no damping of theirs"
    elif not damping.ratio:
        yield "damping", (), "the case has none, of which there is no half or double"
    yield _direction(case, *motions[0])
    for factor in (0.99, 1.01):
        yield "1 % of the motion", (), _scaled(motion, factor * ground.scale)
    if ground.vertical is None:
        yield "vertical motion", (), _with_own_vertical(case, motion)
    else:
        without = ("record.vertical=null",) if motion.record is None else ()
        yield "without vertical motion", without, replace(motion, vertical=None)
    yield from _records(case, motions)


def _with_own_vertical(
    case: Case, motion: inputs.MotionRequest
) -> inputs.MotionRequest | str:
    """The motion with the vertical component of its recording, if that lies beside it."""
    from rpscli.records.loading import OWN

    try:
        inputs.load_motion(case, both := replace(motion, vertical=OWN))
    except RpsError:
        return "not known: no vertical component is named"
    return both


DIMENSIONS = (
    *("semi_diagonal", "slenderness", "wedge_slenderness", "curvature_ratio"),
    *("height", "width", "wedge_width", "radius"),
)
"""Of columns, by their keys: ratios and a semi-diagonal, or the lengths in
their place.
"""


def _values(case: Case) -> Iterator[tuple[str, ...]]:
    """Causes, and changes of values of the case."""
    file = case.file
    bearing = case.file.podium.bearing
    for factor in (2.0, 4.0):
        yield "numerics", f"analysis.accuracy={factor * file.analysis.accuracy:g}"
    for factor in (10.0, 0.1):
        tolerance = factor * file.analysis.recontact_tolerance
        yield "numerics", f"analysis.recontact_tolerance={tolerance:g}"
    yield from (("impact loss", f"podium.impact.loss={loss:g}") for loss in LOSSES)
    bed = case.structure.bed
    ratio = (bed and bed.period_ratio) or PERIOD_RATIO
    sizes = f"period_ratio: {ratio:g}, damping: {file.podium.contact.damping:g}"
    for kind in ("rigid", f"edges, {sizes}", f"plane, {sizes}"):
        yield "contact", f"podium.contact={{kind: {kind}}}"
    if (damping := file.superstructure.damping) is not None:
        for factor in (0.5, 2.0) if damping.ratio else ():
            yield (
                "damping ratio",
                f"superstructure.damping.ratio={factor * damping.ratio:g}",
            )
        rayleigh = f"[1, {min(2, file.superstructure.storeys)}]"
        modes = rayleigh if damping.modes is None else "null"
        yield "damping model", f"superstructure.damping.modes={modes}"
    if (period := file.superstructure.vertical_period) is not None:
        for factor in (0.5, 2.0):
            yield (
                "vertical period",
                f"superstructure.vertical_period={factor * period:g} s",
            )
    yield from _of_building_and_devices(case)
    yield from _of_twist(case)
    place = "podium.bearing.dimensions" if bearing.dimensions else "podium.bearing"
    for name in DIMENSIONS:
        given = getattr(bearing.dimensions or bearing, name, None)
        value = float(given) if isinstance(given, int | float) else 0.0
        for factor in (0.99, 1.01) if value else ():
            yield "1 % of dimensions", f"{place}.{name}={factor * value:.12g}"


def _of_building_and_devices(case: Case) -> Iterator[tuple[str, ...]]:
    """Changes of its periods and strengths, and of what devices do."""
    building = case.file.superstructure
    fifth = (0.8, 1.2)
    of_both = {"superstructure": building, "superstructure.y": building.y}
    periods = {
        key: of.period for key, of in of_both.items() if of is not None and of.period
    }
    for factor in (0.9, 1.1) if periods else ():
        yield (
            "period",
            *(f"{key}.period={factor * of:.12g}" for key, of in periods.items()),
        )
    if (strengths := building.yields) is not None:
        name = "ratio" if strengths.ratio is not None else "shears"
        given = getattr(strengths, name)
        for factor in fifth:
            each = [
                f"{factor * of:.12g}"
                for of in (given if isinstance(given, tuple) else [given])
            ]
            changed = f"[{', '.join(each)}]" if isinstance(given, tuple) else each[0]
            yield "strength of storeys", f"superstructure.yield.{name}={changed}"
    for n, device in enumerate(case.file.podium.devices):
        for name in ("coefficient", "force", "stiffness", "lever"):
            value = float(getattr(device, name) or 0.0)
            for factor in fifth if value else ():
                yield "devices", f"podium.devices.{n}.{name}={factor * value:.12g}"


LEVERS = 0.0, 0.005, 0.02
"""Of friction in pivoting [m], which nobody has measured."""
SEEDS = 5
USUAL_SCATTER = 0.02
USUAL_ECCENTRICITY = 0.05


def _of_twist(case: Case) -> Iterator[tuple[str, ...]]:
    """Changes of what a turn about the vertical depends on and nobody knows."""
    twist = case.structure.twist
    if twist is None:
        return
    for lever in LEVERS:
        if lever != twist.pivot_friction:
            yield "pivot friction", f"podium.twist.pivot_friction={lever:g}"
    for factor in (0.5, 2.0) if twist.seats else ():
        yield "seats", f"podium.twist.seats={factor * (twist.seats or 0.0):g}"
    if not twist.factors and not case.structure.bearing.is_spherical:
        first = twist.seed + bool(twist.scatter)
        for seed in range(first, twist.seed + SEEDS):
            drawn = (
                f"podium.twist.scatter={{slenderness: {USUAL_SCATTER:g}, seed: {seed}}}"
            )
            given = f"podium.twist.scatter.seed={seed}" if twist.scatter else drawn
            yield "scatter of slenderness", given
    if case.structure.superstructure is None:
        return
    x, y = twist.eccentricity
    if not (x or y):
        x = y = USUAL_ECCENTRICITY
    signs = {(a * x, b * y) for a in (1.0, -1.0) for b in (1.0, -1.0)}
    for e_x, e_y in sorted(signs - {twist.eccentricity}):
        given = f"[{e_x:g}, {e_y:g}]"
        yield "eccentricity of storeys", f"superstructure.torsion.eccentricity={given}"


def _scaled(motion: inputs.MotionRequest, scale: float) -> inputs.MotionRequest:
    """A motion by a factor that can be typed, which takes the
    place of any other scaling.
    """
    return replace(motion, scale=float(f"{scale:.12g}"), scale_to=None)


def _direction(
    case: Case, motion: inputs.MotionRequest, ground: MotionComponents
) -> Wish:
    """Of one component both, in which it keeps its direction; of a
    source of both its first.
    """
    from rpscli.records.source import Source

    own = case.record if motion.record is None else None
    of = case.record_source if own else Source.parse(motion.record or "")
    alike = _scaled(motion, ground.scale)
    unturned = ("record.rotation=null",) if ground.y is not None else ()
    if own and own.y is not None:
        alone = (f"record.source={of}", "record.x=null", "record.y=null", *unturned)
        return "first component alone", alone, alike
    if of.components is None:
        return "other component", (), "not known: the source names no second component"
    cause = "first component alone"
    other = str(of.components[0])
    if ground.y is None:
        angle = 90.0 if of.place.endswith("/b") else of.angle or 0.0
        both = of.without("angle").plus(both=None)
        if of.scheme:
            both = both.at(re.sub("/[ab]$", "", of.place))
        cause = "both components"
        other = str(both.turned(-angle))
    if motion.record is not None:
        return cause, (), replace(alike, record=other, pair=None)
    return cause, (f"record.source={other}", *unturned), alike


def _records(case: Case, motions: Sequence[inputs.CaseMotion]) -> Iterator[Wish]:
    """Those that are given; of a single one the far-field set, each
    alone at the PGA of that.
    """
    from rpscli.records.loading import expand_sources

    request, ground = motions[0]
    try:
        if len(motions) == 1:
            one = replace(request, scale=None, scale_to="PGA=1 m/s2")
            pga = ground.scale / inputs.load_motion(case, one).scale
            sources = expand_sources([FAR_FIELD + "?both" * (ground.y is not None)])
            aim = inputs.MotionRequest(scale_to=f"PGA={pga:.9g} m/s2")
            alone = [
                each
                for source in sources
                for each in inputs.single_motions((source,), aim)
            ]
            motions = [
                inputs.CaseMotion(each, inputs.load_motion(case, each)) for each in alone
            ]
        for motion, ground in motions:
            yield "records", (), _scaled(motion, ground.scale)
    except RpsError as error:
        yield "records", (), f"the far-field set at the same PGA: {error}"
