"""What the benchmarks share: structures and motions, wall time, accuracy, tables."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from rich import box
from rich.console import Console
from rich.table import Table

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping, Superstructure, profile_stiffnesses
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record

SECONDS = 40.0
STEP = 0.005
ALONE = 1_000_000_000
"""Histories from which on lanes would be worth while: never."""
CLOSE = 1e-4
"""Relative error in max|theta| that counts as the same history: single ones are chaotic."""
_CONSOLE = Console(width=132, highlight=False)


def settings(accuracy: float = 1.0) -> TimeHistorySettings:
    """Without free vibration, so that every history is as long as its record."""
    return TimeHistorySettings(free_vibration=0.0, accuracy=accuracy)


def structure(storeys: int, rho: float = 0.5, period: float | None = None) -> PodiumStructure:
    """The paper's building: T_1 = n/10 s or `period`, gamma = 10, eta = n, the rigid law."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, period or storeys / 10, "sine")
    building = Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))
    return PodiumStructure(Bearing(1.5, 0.15, 0.30, rho), 2e4, 2e5, building, ImpactLaw("rigid"))


def motion(seed: int, *, duration: float = SECONDS, peak: str = "0.5g") -> GroundMotion:
    """A synthetic record at 200 Hz."""
    return load_record(f"synthetic:?pga={peak}&duration={duration}&dt={STEP}&seed={seed}")


def motions(count: int) -> list[GroundMotion]:
    """Synthetic records of 40 s, seeds from 1 up."""
    return [motion(seed) for seed in range(1, count + 1)]


def seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Least wall time of some repeats [s], after a first call, which may compile.

    Garbage collection stays on: it is part of what a user waits for.
    """
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def agreeing(
    found: Sequence[float], exact: Sequence[float], limit: float | NDArray[np.float64]
) -> tuple[int, int]:
    """How many of how many are close; those whose reference overturns are left out."""
    a, b = np.array(found), np.array(exact)[: len(found)]
    standing = b < limit
    close = np.abs(a[standing] / b[standing] - 1.0) < CLOSE
    return int(close.sum()), int(standing.sum())


def share(close: int, count: int) -> str:
    """As text."""
    return f"{close / count:.0%} of {count}" if count else "none"


def show(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a table that Markdown understands, as wide on a terminal as in a file."""
    table = Table(*columns, title=title, title_justify="left", box=box.MARKDOWN)
    for row in rows:
        table.add_row(*row)
    _CONSOLE.print(table)


def say(line: str) -> None:
    """Print a line beside the tables."""
    _CONSOLE.print(line, soft_wrap=True, markup=False)


def installed(module: str) -> bool:
    """Whether a peer can be imported; says so at once if not, with the first cause.

    Some answer a missing system library by a RuntimeError that does not name it.
    """
    try:
        importlib.import_module(module)
    except (ImportError, OSError, RuntimeError) as error:
        cause: BaseException = error
        while cause.__context__ is not None:
            cause = cause.__context__
        say(f"{module} is left out: {cause} (pip install -e '.[bench]' brings all)")
        return False
    return True
