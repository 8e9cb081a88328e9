"""Make records and observations from the public files of the granite tests.

Run it as ``python convert.py FOLDER``, where FOLDER is ``data/Shake_Table_Response`` of the
repository ZhiangChen/virtual_shake_robot_pybullet (GPL-3.0). It needs openpyxl besides rps. It
writes beside itself ``motions/Test012.at2`` and so on, ``observed.csv`` (the outcomes of both
specimens) and ``published.csv`` (those of the discrete-element models in the same workbook).

The text files have eight columns without units; used is the second, the acceleration of the table
in g. Its median is its offset. What is kept is 0.1 to 25 Hz, at 200 Hz.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from scipy.signal import butter, sosfiltfilt

from rpscli.constants import STANDARD_GRAVITY
from rpscli.records.formats.at2 import at2_text
from rpscli.records.ground_motion import GroundMotion

RATE = 800.0  # Hz
KEPT = 4
BAND = (0.1, 25.0)  # Hz
SPECIMENS = ("specimen 1", "specimen 2")
WORKBOOK = "Results_Granite.xlsx"
Outcomes = dict[int, list[tuple[str, int]]]


def motion(path: Path) -> GroundMotion:
    """The table's acceleration in one of the text files."""
    time, acceleration = np.loadtxt(path, skiprows=1, usecols=(0, 1), unpack=True)
    if np.abs(time - np.arange(len(time)) / RATE).max() > 0.5 / RATE:  # they are rounded
        raise SystemExit(f"{path}: the times are not those of {RATE:g} Hz")
    sections = butter(4, BAND, "bandpass", fs=RATE, output="sos")
    kept = sosfiltfilt(sections, acceleration - np.median(acceleration))[::KEPT]
    return GroundMotion(
        kept * STANDARD_GRAVITY, KEPT / RATE, path.stem, path.name, "table motion"
    )


def outcomes(workbook: Path) -> Outcomes:
    """Of each test: titles of the columns, of which the first two are measured, and outcomes."""
    import openpyxl  # not among what rps needs

    sheet = openpyxl.load_workbook(workbook, data_only=True).worksheets[0]
    heads, *rows = sheet.iter_rows(values_only=True)
    return {
        int(str(test)): [
            (str(head), int(str(cell)))
            for head, cell in zip(heads[1:], cells, strict=False)
            if cell in (0, 1)
        ]
        for test, *cells in rows
        if test is not None
    }


def convert(source: Path, target: Path) -> int:
    """Write everything; returns the number of tests that have a motion and outcomes."""
    found = outcomes(source / WORKBOOK)
    tests = {}
    for path in sorted(source.glob("Test*.txt")):
        test = int(path.stem.removeprefix("Test"))
        if test in found:
            tests[test] = motion(path)
        else:
            print(f"{path.name}: has no outcome in {WORKBOOK}; left out", file=sys.stderr)
    write(tests, found, target)
    return len(tests)


def write(tests: Mapping[int, GroundMotion], found: Outcomes, target: Path) -> None:
    """Motions, and what specimens and models did under them."""
    folder = target / "motions"
    folder.mkdir(parents=True, exist_ok=True)
    observed: list[tuple[str, str, int]] = []
    published: list[tuple[str, str, int]] = []
    for test, record in tests.items():
        name = f"Test{test:03d}"
        (folder / f"{name}.at2").write_text(at2_text(record), encoding="utf-8")
        for head, outcome in found[test]:
            if head.startswith("Experimental"):
                observed.append((name, f"specimen {head.strip()[-1]}", outcome))
            else:
                published.append((name, head, outcome))
    _write(target / "observed.csv", ("record", "title", "overturned"), observed)
    _write(target / "published.csv", ("record", "model", "overturned"), published)


def _write(
    path: Path, head: tuple[str, ...], rows: Iterable[tuple[str, str, int]]
) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([head, *rows])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit("usage: python convert.py FOLDER-OF-THE-TEXT-FILES")
    here = Path(__file__).resolve().parent
    print(f"{convert(Path(sys.argv[1]), here)} tests, in {here}")
