"""Writes numbers into the certified problems: `cd tests; python -m certified.make`.

Pages keep their text; both tables, the sentence on how far the roads agree, cases, motions and the
file of answers are written anew. Names on the command line limit it to these pages and cases.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Sequence

import numpy as np
from oracles.crossings import Array

from rpscli.analyses.verification import ANSWERS, FOLDER

from .problems import DT, FINE, MOTIONS, STARTS, Change, Problem, problems

MOST = 12
FRACTILES = (0.1, 0.25, 0.5, 0.75, 0.9)
UNCHANGED: Change = lambda structure: structure  # noqa: E731


def shared(first: float, second: float) -> int:
    """Digits that two values share."""
    off = abs(second / first - 1.0)
    return MOST if off < 10.0**-MOST else math.floor(-math.log10(off))


def distance(a: Array, b: Array) -> float:
    """Kolmogorov's, by its definition."""
    places = np.concatenate((a, b))
    return max(abs(float(np.mean(a <= x)) - float(np.mean(b <= x))) for x in places)


class WorkedOut:
    """A problem, its answers by both roads, and what a page and the file of answers say of them."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.first = np.array([float(z) for z in problem.first()])
        self.second = np.array([float(z) for z in problem.second(UNCHANGED)])

    @property
    def answers(self) -> list[tuple[str, str, str, int]]:
        """Quantity, unit, value and digits."""
        if self.problem.members:
            ((quantity, unit),) = self.problem.units.items()
            return [(quantity, unit, f"{z:.6g}", 0) for z in np.sort(self.first)]
        pairs = zip(self.first, self.second, strict=True)
        digits = [shared(a, b) for a, b in pairs]
        told = zip(self.problem.units.items(), self.first, digits, strict=True)
        return [(name, unit, f"{z:.{n + 1}g}", n) for (name, unit), z, n in told]

    def table(self) -> str:
        if self.problem.members:
            heads = "".join(f" {100 * share:g} % |" for share in FRACTILES)
            lines = [f"| quantity: {self.answers[0][0]} [rad] |{heads}", "|---" * 6 + "|"]
            for name, sample in (("the first road", self.first), ("the second", self.second)):
                told = "".join(f" {z:.4f} |" for z in np.quantile(sample, FRACTILES))
                lines.append(f"| {name} |{told}")
            return "\n".join(lines)
        lines = ["| quantity | certified | digits |", "|---|---|---|"]
        lines += [f"| {name} [{unit}] | {z} | {n} |" for name, unit, z, n in self.answers]
        return "\n".join(lines)

    def agreement(self) -> str:
        if self.problem.members:
            apart = int(np.sum(np.abs(self.first - self.second) > 0.01))
            return (
                f"Both roads differ by more than 0.01 rad in {apart} of {len(STARTS)} motions; the"
                f" distance of their samples is {distance(self.first, self.second):.2f}, and below"
                " 0.23 for 99 % of such pairs of one distribution."
            )
        off = float(np.max(np.abs(self.second / self.first - 1.0)))
        return f"Both roads agree within {off:.0e} of each number."

    def page(self, text: str) -> str:
        text = re.sub(r"\| \| \|\n(\|.*\n)+", lambda _: self.problem.podium.table() + "\n", text)
        text = re.sub(r"\| quantity.*\n(\|.*\n)+", lambda _: self.table() + "\n", text)
        return re.sub(r"Both roads [\s\S]*", lambda _: self.agreement() + "\n", text)


def main(only: Sequence[str]) -> None:
    for name, values in MOTIONS.items():
        dt = FINE if name == "still" else DT
        lines = (f"{i * dt:.10g},{float(z)!r}\n" for i, z in enumerate(values))
        text = f"time [s],acceleration [m/s2]\n{''.join(lines)}"
        (FOLDER / f"ground_{name}.csv").write_text(text, encoding="utf-8")
    table: list[Sequence[object]] = [("problem", "quantity", "unit", "value", "digits")]
    for name, problem in problems().items():
        if only and name not in only:
            continue
        page = FOLDER / f"{name}.md"
        text = page.read_text(encoding="utf-8")
        case = problem.case(text.partition("\n")[0].removeprefix("# "))
        (FOLDER / f"{name}.yaml").write_text(case, encoding="utf-8")
        found = WorkedOut(problem)
        page.write_text(found.page(text), encoding="utf-8")
        table += [(name, *answer) for answer in found.answers]
        sys.stdout.write(f"{name}: {found.agreement()}\n")
    if not only:
        rows = "".join(f"{','.join(map(str, row))}\n" for row in table)
        (FOLDER / ANSWERS).write_text(rows, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
