"""Certified problems, which come as data: their answers by rps, and
correct digits of any answers.

Each problem was solved by two roads that share nothing; `rpscli/analyses/certified` has a
page and a case for each. Where motions part the answers are a sample, and its
distribution is what counts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rpscli.analyses.demand import demand
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.trace import Trace
from rpscli.errors import CaseError, hint
from rpscli.model.podium import Array, PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.titled_table import titled_table

FOLDER = Path(__file__).with_name("certified")
ANSWERS = "answers.csv"
COLUMNS = ("problem", "quantity", "unit", "value")
Key = tuple[str, str]
"""Problem and quantity."""

LEFT_OUT = ("free_wobble", "parting_motions")
"""Problems that rps does not compute for `rps verify`: the first turns at its start,
which no case says, the second has a hundred histories of 90 s."""

ONE_PERCENT = 1.628
"""Kolmogorov's distance of two large samples of one
distribution, over sqrt(1/n + 1/m)."""


@dataclass(frozen=True)
class Comparison:
    """An answer beside the certified one, in one unit; NaN where it is missing.

    `certified_digits` are 0 of the distance between two samples.
    """

    group: str
    quantity: str
    unit: str
    expected: float
    computed: float
    tolerance: float
    certified_digits: int = 0

    @property
    def holds(self) -> bool:
        """True if the computed value is close enough; one that
        is not a number never is.
        """
        return abs(self.computed - self.expected) <= self.tolerance

    @property
    def digits(self) -> float | None:
        """Correct ones, at most those that are certified; None of
        samples and missing answers.
        """
        if not self.certified_digits or math.isnan(self.computed):
            return None
        off = abs(self.computed / self.expected - 1.0)
        return max(-math.log10(max(off, 10.0**-self.certified_digits)), 0.0)

    @property
    def verdict(self) -> str:
        """In a word, or how many digits are correct."""
        if self.digits is not None:
            return f"{self.digits:.1f} digits"
        return (
            "agrees"
            if self.holds
            else "missing"
            if math.isnan(self.computed)
            else "DIFFERS"
        )


def _rows(text: str, source: str) -> Iterator[tuple[int, Key, dict[str, str]]]:
    """Line, problem and quantity, and cells."""
    table = titled_table(text, source, CaseError)
    heads = table.names
    if lacking := {"problem", "quantity", "value"} - {*heads}:
        raise CaseError(
            f"{source}: line 1 names no column {min(lacking)}; begin with"
            f" `{','.join(COLUMNS)}`"
        )
    for line, cells in table.rows:
        row = dict.fromkeys(heads, "") | dict(zip(heads, cells, strict=False))
        yield line, (row["problem"].strip(), row["quantity"].strip()), row


def certified() -> dict[Key, tuple[str, int, list[float]]]:
    """Of each quantity the unit, how many digits are certified,
    and its value or sample.
    """
    known: dict[Key, tuple[str, int, list[float]]] = {}
    for _, key, row in _rows((FOLDER / ANSWERS).read_text(encoding="utf-8"), ANSWERS):
        known.setdefault(key, (row["unit"], int(row["digits"]), []))[2].append(
            float(row["value"])
        )
    return known


def problem_files() -> dict[str, bytes]:
    """Pages, cases and motions by their names, and the file of answers without values."""
    files = {path.name: path.read_bytes() for path in sorted(FOLDER.iterdir())}
    rows = [COLUMNS, *((*key, unit, "") for key, (unit, _, _) in certified().items())]
    return {**files, ANSWERS: "".join(f"{','.join(row)}\n" for row in rows).encode()}


def answers_of_file(text: str, source: str) -> dict[Key, list[float]]:
    """Answers of a CSV file; quantities without one are left out."""
    known = certified()
    given = dict[Key, list[float]]()
    for line, key, row in _rows(text, source):
        place = f"{source}: line {line}"
        if key not in known:
            meant = hint(", ".join(key), map(", ".join, known), "the pages name what is")
            raise CaseError(f"{place}: {', '.join(key)} is not asked; {meant}")
        if written := row["value"].strip():
            try:
                number = float(written)
            except ValueError:
                number = math.nan
            if not math.isfinite(number):
                raise CaseError(
                    f"{place}: the value {written[:40]!r} must be a finite number"
                )
            given.setdefault(key, []).append(number)
    return given


def scored(
    given: Mapping[Key, Sequence[float]], digits: float
) -> tuple[list[Comparison], list[str]]:
    """Answers of which so many digits should be right; and the
    problems that have none.
    """
    known = certified()
    begun = {problem for problem, _ in given}
    compared = [
        _compared(key, *answer, given.get(key, ()), digits)
        for key, answer in known.items()
        if key[0] in begun
    ]
    return compared, [
        *dict.fromkeys(problem for problem, _ in known if problem not in begun)
    ]


def _compared(
    key: Key,
    unit: str,
    certain: int,
    values: list[float],
    given: Sequence[float],
    digits: float,
) -> Comparison:
    if certain:
        value = values[0]
        computed = given[-1] if given else math.nan
        tolerance = abs(value) * 10.0 ** -min(digits, certain)
        return Comparison(*key, unit, value, computed, tolerance, certain)
    from scipy.stats import ks_2samp  # slow

    distance = float(ks_2samp(values, given).statistic) if given else math.nan
    limit = ONE_PERCENT * math.sqrt(1.0 / len(values) + 1.0 / max(len(given), 1))
    return Comparison(key[0], f"{key[1]}, distance of samples", "-", 0.0, distance, limit)


def answers(
    problem: str,
    structure: PodiumStructure,
    motion: MotionComponents | None,
    settings: TimeHistorySettings,
) -> dict[Key, list[float]]:
    """Answers of rps to a problem, from what its case says; the motion is scaled.

    Events that do not come, and samples after an early end, are NaN.
    """
    asked = [quantity for name, quantity in certified() if name == problem]
    if problem == "capacity":
        values = dict(zip(asked, _capacity(structure), strict=True))
    elif problem == "uplifted_modes":
        values = dict(zip(asked, _modes(structure), strict=True))
    else:
        assert motion is not None, "all other cases name a record"
        if problem == "block_overturning":
            values = {asked[0]: _least_peak(structure, motion, settings)}
        else:
            result = time_history(structure, motion, settings, with_fixed_base=False)
            values = {quantity: of_history(result, quantity) for quantity in asked}
    return {(problem, quantity): [float(value)] for quantity, value in values.items()}


def _capacity(structure: PodiumStructure) -> Iterable[float]:
    """Uplift; rotation, displacement and lift at the critical;
    force at 0.1 rad; energy.
    """
    static = pushover(structure)
    forces, moved, lifts = structure.path(np.array([0.1, static.critical_rotation]))
    critical = static.critical_rotation, moved[1], lifts[1]
    return static.uplift_force, *critical, forces[0], structure.weight * lifts[1]


def _modes(structure: PodiumStructure) -> Iterable[float]:
    """The podium's own mode, then frequency and damping of each vibration, rolling."""
    rolling = modal(structure).uplifted["rolling"]
    pairs = zip(rolling.frequencies, rolling.damping, strict=True)
    return rolling.frequency_parameter, *(value for pair in pairs for value in pair)


def _least_peak(
    structure: PodiumStructure, motion: MotionComponents, settings: TimeHistorySettings
) -> float:
    """Peak of the least motion of this shape that overturns [m/s2], by bisection."""
    low = 5.0
    high = 12.0
    while high - low > 1e-14 * high:
        middle = 0.5 * (low + high)
        shaken = motion.horizontal.scaled(middle / motion.horizontal.pga)
        fell = demand(structure, shaken, settings).outcome.startswith("overturned")
        low, high = (low, middle) if fell else (middle, high)
    return 0.5 * (low + high)


def _towards(trace: Trace) -> Array:
    """X + iY of the tilt."""
    assert trace.azimuth is not None, "both components act"
    return np.asarray(trace.rotation * np.exp(1j * trace.azimuth))


SAMPLED: dict[str, Callable[[Trace], Array]] = {
    "tilt": lambda t: t.rotation,
    "drift of the first storey": lambda t: t.drifts[:, 0],
    "roof displacement": lambda t: t.floor_displacements[:, -1],
    "tilt towards x": lambda t: _towards(t).real,
    "tilt towards y": lambda t: _towards(t).imag,
}
"""Quantities that a problem asks for at some time, by their names."""


def of_history(result: TimeHistoryResult, quantity: str) -> float:
    """A quantity of a history, by its name, as in ``tilt at 2 s``
    or ``time of impact 3``.
    """
    what, _, when = quantity.removesuffix(" s").partition(" at ")
    if when:
        samples = SAMPLED[what](result.trace)
        row = round(float(when) / result.record.dt)
        return float(samples[row]) if row < len(samples) else math.nan
    if quantity == "largest tilt":
        return result.max_rotation
    name, kind, number = re.fullmatch(r"(.+) (uplift|impact) ?(\d*)", quantity).groups()  # type: ignore[union-attr]
    events = [each for each in result.events if each.kind == kind][int(number or 1) - 1 :]
    if not events:
        return math.nan
    return events[0].time if name == "time of" else abs(events[0].rotation_rate_before)
