"""A batch of points -> their results: the one place that decides about stored numbers.

What points share, systems and motions, is made or read once. What comes out for a
point depends on the point and the plan alone, not on its batch, the order, or the
process. A point that cannot be computed gives a row that says why. Results are columns
under their published names.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses import result_quantities as rq
from rpscli.analyses.demand import DemandRequest, histories
from rpscli.analyses.largest_demands import Demands
from rpscli.analyses.modal import modal
from rpscli.analyses.outcomes import failure_text, outcomes_of
from rpscli.analyses.pushover import pushover
from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import Case, case_from_mapping
from rpscli.case.study.schema import Analysis, MeasureScale
from rpscli.errors import RpsError
from rpscli.model.devices import own_laws
from rpscli.model.podium import Array, PodiumStructure
from rpscli.records.measures import USUAL, Measure, Of, factor_to
from rpscli.sweep.motions import Recent, RecordCache, RecordRequest
from rpscli.version import VERSION

Value = TypeVar("Value")

SYSTEMS_KEPT = 512
"""Systems held in memory with their modes of vibration; the
least recently used go first."""

DECIDING = ("superstructure", "podium", "analysis")
"""Sections of a resolved case on which results depend besides the record."""

PEAKS: tuple[Measure, ...] = ("PGA", "PGV")
"""Measures of each scaled motion in the table of a study."""

SOLVING = (
    *(
        "constants.py",
        "units.py",
        "registry.py",
        "physics",
        "model",
        "records",
        "analyses",
        "case",
    ),
    "sweep/evaluation.py",
    "sweep/motions.py",
)
"""Files and folders of the package whose sources decide about
what is stored under a key."""


@cache
def solver_version() -> str:
    """Version of rps and a digest of the sources that compute."""
    return f"{VERSION}+{digest_of_sources(Path(__file__).parents[1])[:16]}"


def digest_of_sources(package: Path) -> str:
    """SHA-256 of the names and contents of all sources that
    compute, in sub-folders too.
    """
    digest = hashlib.sha256()
    for name in SOLVING:
        place = package / name
        for source in [place] if place.is_file() else sorted(place.rglob("*.py")):
            digest.update(f"{source.relative_to(package).as_posix()}\0".encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()


class Point(NamedTuple):
    """One point, small enough to be sent anywhere.

    `number` is its place in the order of the study, from 0. `values` are those of the
    varied keys, in their order. `scale` is the factor on the record, or the value of the
    measure to scale it to; `period` is then the one of Sa and the like. The changes are
    factors of the perturbation, 1 where there is none.
    """

    number: int
    system: int
    values: tuple[Any, ...]
    record: RecordRequest | None
    scale: float
    scale_change: float
    restitution_change: float
    period: float | None


@dataclass(frozen=True)
class Plan:
    """Everything besides the points that a process needs to evaluate them.

    `keys` are the dotted keys of the values of a point; `base` is the case at the base as
    plain values, with its file and folder for messages and relative file names; `measure`
    is what the records are scaled to, if not by factors; `whole` histories are followed
    with all their samples; all results must come from one version of the `solver`.
    """

    analysis: Analysis
    keys: tuple[str, ...]
    base: dict[str, Any]
    base_name: str
    base_folder: str
    measure: MeasureScale | None
    whole: bool
    solver: str

    @property
    def of(self) -> Of:
        """Definition of measures of pairs."""
        return (self.measure and self.measure.of) or USUAL


@dataclass(frozen=True, eq=False)
class System:
    """One structure, settings of its analysis, digest of what in its
    case decides about results.
    """

    structure: PodiumStructure
    settings: TimeHistorySettings
    digest: bytes

    @classmethod
    def of_case(cls, case: Case) -> System:
        """The system that a case describes."""
        deciding = {name: case.document.get(name) for name in DECIDING}
        if own := own_laws(case.structure):
            deciding["sources"] = {name: law.sources for name, law in own.items()}
        digest = hashlib.sha256(json.dumps(deciding, sort_keys=True).encode()).digest()
        return cls(case.structure, case.analysis, digest)

    def perturbed(self, restitution_change: float) -> PodiumStructure:
        """The structure with its restitution times a factor; the building is shared."""
        if restitution_change == 1.0 or self.structure.bearing.is_spherical:
            return self.structure
        law = self.structure.impact_law
        law = replace(law, factor=law.factor * restitution_change)
        return replace(self.structure, impact_law=law)


def resolved(plan: Plan, values: Sequence[Any]) -> Case:
    """The case with values at the varied keys."""
    varied = dict(zip(plan.keys, values, strict=True))
    folder = Path(plan.base_folder)
    return case_from_mapping(plan.base, plan.base_name, folder, varied, label="vary")


class StudyContext:
    """Systems and ground motions of a plan, shared by all batches of a process."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.records = RecordCache()
        self._systems: Recent[int, System] = Recent(SYSTEMS_KEPT)

    def system(
        self, number: int, values: Sequence[Any], known: System | None = None
    ) -> System:
        """The system of a number with these values, resolved when it
        is needed if not `known`.
        """
        return self._systems.value(
            number, lambda: known or System.of_case(resolved(self.plan, values))
        )

    def factor(self, point: Point) -> float:
        """Factor on the record of a point."""
        measure = self.plan.measure
        if measure is None:
            return point.scale * point.scale_change
        assert point.record is not None, "points of histories have a record"
        unscaled = self.records.intensity(
            point.record, measure.measure, point.period, measure.damping, self.plan.of
        )
        factor = factor_to(point.scale, unscaled, measure.measure, point.record.source)
        return factor * point.scale_change

    def history(self, point: Point) -> DemandRequest:
        """The history of a point; its motion is shared, and scaled while it is used."""
        assert point.record is not None, "points of histories have a record"
        system = self.system(point.system, point.values)
        structure = system.perturbed(point.restitution_change)
        motion = self.records.motion(point.record)
        return DemandRequest(structure, motion, system.settings, scale=self.factor(point))

    def intensities(self, points: Sequence[Point], factors: Array) -> dict[str, Array]:
        """Peaks of the scaled motions of some points, (points,)."""
        requests = [point.record for point in points if point.record]
        peaks = dict[str, Array]()
        for measure in PEAKS:
            of: dict[RecordRequest, float] = {
                r: self.records.intensity(
                    r, measure, of=self.plan.of if r.is_pair else "component"
                )
                for r in set(requests)
            }
            peaks[measure.lower()] = np.abs(factors) * np.array([of[r] for r in requests])
        return peaks


Indices = NDArray[np.int64]

DONE = "done"
"""Outcome of an analysis that has no others."""

FAILED = "failed"

MISSING = ""
"""Outcome of a point that has not been computed."""

KEPT = (*rq.HISTORY, *rq.IMPACTS, rq.STOREY_SHEARS)
"""Results of a history that a study keeps besides its outcome, its
scale and its intensities."""

Named = dict[str, ResultQuantity]
"""Quantities by their dotted paths in the results of a point."""


def _named(
    quantities: Iterable[ResultQuantity], states: Iterable[str] = ("",), index: str = ""
) -> Named:
    known = tuple(quantities)
    return {f"{state}{q.name}{index}": q for state in states for q in known}


_FIXED = ("fixed_base.",)
_ROLLING = ("rolling.",)
_ROCKING = ("rocking.",)

SCALARS: dict[Analysis, Named] = {
    "timehistory": _named(
        (*rq.HISTORY, *rq.YIELDING, *rq.SAMPLED, *rq.IMPACTS, *rq.INTENSITIES)
    ),
    "modal": _named(rq.FIXED_BASE_MODES, _FIXED, ".0")
    | _named(rq.UPLIFTED_RATIOS, _ROLLING, ".0")
    | _named(rq.FREQUENCY_PARAMETERS, _ROLLING)
    | _named(rq.UPLIFTED_RATIOS, _ROCKING, ".0")
    | _named(rq.FREQUENCY_PARAMETERS, _ROCKING),
    "pushover": _named(rq.PUSHOVER),
}
"""Scalar results of each analysis, in the order of `points.csv`; modes count from 0."""

KNOWN: dict[Analysis, Named] = {
    "timehistory": SCALARS["timehistory"] | _named([rq.STOREY_SHEARS]),
    "modal": _named((*rq.FIXED_BASE_MODES, *rq.FIXED_BASE_SHAPES), _FIXED)
    | _named((*rq.LINEAR, *rq.UPLIFTED_SHAPES), _ROLLING + _ROCKING)
    | _named(rq.LINEAR, ("rolling.first_order.", "rocking.first_order."))
    | _named([rq.LEVEL]),
    "pushover": SCALARS["pushover"]
    | _named((*rq.STOREY_CURVE, *rq.STOREY_CURVE_RATIOS), ["curve."]),
}
"""Results that a report may name; elements of lists by their index, counted from 0."""


def quantity(analysis: Analysis, path: str) -> ResultQuantity | None:
    """The quantity at a dotted path; None if the analysis has no such result."""
    return KNOWN[analysis].get(split(path)[0])


class PointResults(NamedTuple):
    """Outcomes and results of some points, of which each has a row.

    `outcomes` are (points,) words; `messages` say by the number of the row
    why points failed; `columns` are (points, ...) under the names of results,
    NaN where a point has none.
    """

    outcomes: NDArray[np.str_]
    messages: dict[int, str]
    columns: dict[str, Array]

    @classmethod
    def alike(cls, count: int, outcome: str, message: str | None = None) -> PointResults:
        """Of points that all ended in one way, with one message if they failed."""
        messages = {} if message is None else dict.fromkeys(range(count), message)
        return cls(np.full(count, outcome, dtype="U20"), messages, {})

    def put(self, rows: Indices, name: str, values: Array) -> None:
        """Set a column at some rows; what is wider than the column so far widens it."""
        column = self.columns.get(name)
        shape = (len(self.outcomes), *values.shape[1:])
        if column is None:
            column = self.columns[name] = np.full(shape, np.nan)
        elif any(new > old for new, old in zip(shape, column.shape, strict=True)):
            before = column
            wider = map(max, shape, column.shape)
            column = self.columns[name] = np.full(tuple(wider), np.nan)
            column[_up_to(before.shape)] = before
        inner: Any = (rows, *_up_to(values.shape[1:]))
        column[inner] = values


def _up_to(shape: Sequence[int]) -> tuple[slice, ...]:
    return tuple(map(slice, shape))


def stacked(values: Sequence[Any]) -> Array:
    """Numbers, or arrays of as many dimensions, as (points, ...): NaN
    where one has no number.

    >>> stacked([[1.0, 2.0], None, [3.0]]).tolist()
    [[1.0, 2.0], [nan, nan], [3.0, nan]]
    """
    arrays = [
        None if value is None else np.asarray(value, np.float64) for value in values
    ]
    shapes = [array.shape for array in arrays if array is not None]
    column = np.full((len(arrays), *map(max, zip(*shapes, strict=True))), np.nan)
    for row, array in enumerate(arrays):
        if array is not None:
            inner: Any = (row, *_up_to(array.shape))
            column[inner] = array + 0.0  # no -0.0
    column[~np.isfinite(column)] = np.nan
    return column


def split(path: str) -> tuple[str, tuple[int, ...]]:
    """The name of a column and the indices in its rows that a dotted path stands for."""
    parts = path.split(".")
    indices = []
    while len(parts) > 1 and parts[-1].isdecimal():
        indices.append(int(parts.pop()))
    return ".".join(parts), tuple(reversed(indices))


def at_path(columns: Mapping[str, Array], path: str) -> Array | None:
    """Values of the points at a dotted path; None where none can have it."""
    name, indices = split(path)
    column = columns.get(name)
    if column is None or len(indices) > column.ndim - 1:
        return None
    if any(index >= size for index, size in zip(indices, column.shape[1:], strict=False)):
        return None
    inner: tuple[int | slice, ...] = (slice(None), *indices)
    return column[inner]


def run_batch(context: StudyContext, points: Sequence[Point]) -> PointResults:
    """Results of some points of the study, in the same order."""
    results = PointResults.alike(len(points), FAILED, "not computed")
    if context.plan.analysis != "timehistory":
        _static(context, points, results)
        return results
    requests: dict[int, DemandRequest] = {}
    for row, point in enumerate(points):
        request = _attempt(context.history, point)
        if isinstance(request, str):
            results.messages[row] = request
        else:
            requests[row] = request
    rows = np.array([*requests], np.int64)
    given = [*requests.values()]
    turns = any(request.structure.twist for request in given)
    run = _whole if context.plan.whole or turns else _together
    for members, ended, sampled in run(given):
        at = rows[members]
        if isinstance(ended, str):
            results.messages.update(dict.fromkeys(at.tolist(), ended))
        else:
            kept = (*KEPT, *(rq.YIELDING if ended.yields else ()))
            _keep(results, at, ended, ended.columns(kept) | sampled)
    done = np.flatnonzero(results.outcomes != FAILED)
    scales = np.array([requests[row].scale for row in done.tolist()])
    peaks = context.intensities([points[row] for row in done.tolist()], scales)
    for name, values in {"scale": scales, **peaks}.items():
        results.put(done, name, values)
    return results


def _keep(
    results: PointResults, at: Indices, ended: Demands, columns: dict[str, Array]
) -> None:
    """Add histories at some rows; of those that failed, why."""
    outcomes = outcomes_of(ended.left)
    good = outcomes != FAILED
    results.outcomes[at] = outcomes
    for row, left, of in zip(
        at[~good].tolist(), ended.left[~good], ended.number[~good], strict=True
    ):
        results.messages[row] = str(failure_text(left, ended.structures[of]))
    for row in at[good].tolist():
        del results.messages[row]
    for name, values in columns.items():
        results.put(at[good], name, values[good])


Run = tuple[list[int], Demands | str, dict[str, Array]]
"""Numbers of histories, what was found or why nothing was, and
what their samples tell."""


def _together(requests: list[DemandRequest]) -> Iterator[Run]:
    """Histories side by side."""
    every = _attempt(lambda: list(histories(requests)))
    if isinstance(
        every, str
    ):  # one of them cannot be had: which one shows when each is alone
        alone = (
            _attempt(lambda r: next(histories([r]))[1], request) for request in requests
        )
        yield from (([number], ended, {}) for number, ended in enumerate(alone))
    else:
        yield from ((members, ended, {}) for members, ended in every)


def _whole(requests: list[DemandRequest]) -> Iterator[Run]:
    """Each by itself, with what its samples tell."""
    for number, request in enumerate(requests):
        whole = _attempt(
            lambda r: time_history(r.structure, r.motion.scaled(r.scale), r.settings),
            request,
        )
        if isinstance(whole, str):
            yield [number], whole, {}
        else:
            sampled = rq.values_of(whole, rq.SAMPLED)
            if whole.twist is not None:  # of the column that tilts most
                worst = "max_rotation", "rotation_ratio"
                sampled |= {name: getattr(whole, name) for name in worst}
            ended = Demands.of_one(whole.structure, whole.history)
            yield (
                [number],
                ended,
                {name: stacked([value]) for name, value in sampled.items()},
            )


def _static(
    context: StudyContext, points: Sequence[Point], results: PointResults
) -> None:
    """Add the modes or the static curves of each point."""
    analysis = context.plan.analysis
    of = {"modal": _modal, "pushover": _pushover}[analysis]
    rows: list[dict[str, Any]] = [{}] * len(points)
    for row, point in enumerate(points):
        values = _attempt(
            lambda p: of(context.system(p.system, p.values).structure), point
        )
        if isinstance(values, str):
            results.messages[row] = values
        else:
            rows[row] = values
            results.outcomes[row] = DONE
            del results.messages[row]
    for name in KNOWN[analysis]:
        if any(name in row for row in rows):
            results.columns[name] = stacked([row.get(name) for row in rows])


def _modal(structure: PodiumStructure) -> dict[str, Any]:
    result = modal(structure)
    values: dict[str, Any] = {rq.LEVEL.name: range(structure.storeys + 1)}
    paper = {
        f"{name}.first_order": modes for name, (_, modes) in result.both_orders.items()
    }
    states: dict[str, Any] = {**result.uplifted, **paper, "fixed_base": result.fixed_base}
    for state, modes in states.items():
        if modes is not None:
            values |= {
                f"{state}.{name}": profile for name, profile in modes.profiles().items()
            }
            lists = rq.FIXED_BASE_MODES if state == "fixed_base" else rq.LINEAR
            values |= {f"{state}.{q.name}": getattr(modes, q.name) for q in lists}
    return values


def _pushover(structure: PodiumStructure) -> dict[str, Any]:
    result = pushover(structure)
    curve = {
        q.name: getattr(result.curve, q.name) for q in rq.STOREY_CURVE
    } | result.curve_ratios()
    scalars = {q.name: getattr(result, q.name) for q in rq.PUSHOVER}
    return scalars | {f"curve.{name}": values for name, values in curve.items()}


def _attempt(work: Callable[..., Value], *arguments: Any) -> Value | str:
    """The result of the work, or a text that says why there is none."""
    try:
        return work(*arguments)
    except RpsError as error:
        return str(error)
    except Exception as error:  # noqa: BLE001 -- one point must not take the study down
        return f"{type(error).__name__}: {error}"
