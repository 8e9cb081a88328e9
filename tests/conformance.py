"""Numbers that tests compare with an authority: `conforms` asserts and records each as a row.

`cd tests; python -m conformance` runs the tests that call it and writes rpscli/conformance.json,
a row a line, and rpscli/CONFORMANCE.md. In every other run the rows of a test are compared with
those of the file as soon as the test has passed (`conftest.py`).
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import evidence
import numpy as np

TESTS = Path(__file__).parent
ROOT = TESTS.parent
DATA = ROOT / "rpscli" / "conformance.json"
DOCUMENT = evidence.DOCUMENT
WRITING = "RPS_CONFORMANCE"
"""Names a folder in which each process leaves its rows, to be joined."""
COLUMNS = (
    "capability", "quantity", "expected", "computed", "tolerance", "share", "count",
    "authority", "source", "test",
)  # fmt: skip
AUTHORITIES = (
    "closed form",
    "identity",
    "hand calculation",
    "independent program",
    "published",
    "measurement",
)
MOVES = 0.25
"""What a row may move by, in shares of its tolerance."""
ROUNDING = 1e-8
"""Where the tolerance is less than this of the number, another processor may use all of it."""
BEGIN, END = "<!-- rows: from conformance.json -->", "<!-- end of rows -->"

_recorded = []


def conforms(capability, quantity, expected, computed, tolerance, authority, source):
    """Assert that computed numbers are as near to the expected as the tolerance says; record it.

    Of arrays the number that uses most of its tolerance is the row, and their size its `count`.
    `authority` is one of `AUTHORITIES`, `source` says which.
    """
    if capability not in evidence.CAPABILITIES or authority not in AUTHORITIES:
        raise ValueError(
            f"{capability!r}, {authority!r}: tests/evidence.py, conformance.py"
        )
    wanted, found, within = np.broadcast_arrays(
        np.asarray(expected, dtype=float),
        np.asarray(computed, dtype=float),
        np.asarray(tolerance, dtype=float),
    )
    assert np.shape(computed) == np.shape(expected), quantity
    assert wanted.size > 0, quantity
    assert np.all(within > 0.0), f"{quantity}: a tolerance must be positive"
    shares = np.abs(found - wanted) / within
    worst = np.unravel_index(np.argmax(np.nan_to_num(shares, nan=np.inf)), shares.shape)
    row = tuple(float(each[worst]) for each in (wanted, found, within, shares))
    assert row[3] <= 1.0, f"{quantity}: {row[1]!r} is not {row[0]!r} within {row[2]:.3g}"
    test = os.environ["PYTEST_CURRENT_TEST"].rpartition(" (")[0]
    key = capability, quantity, test
    if any(
        (each["capability"], each["quantity"], each["test"]) == key for each in _recorded
    ):
        raise ValueError(f"{quantity!r} is named twice in {test}")
    numbers = _rounded(*row)
    of_row = capability, quantity, *numbers, wanted.size, authority, source, test
    _recorded.append(dict(zip(COLUMNS, of_row, strict=True)))


def _rounded(expected, computed, tolerance, share):
    """Numbers down to a hundredth of the tolerance, with six digits at least."""
    size = max(abs(expected), abs(computed), 1e-300)
    digits = min(max(math.ceil(math.log10(size / tolerance)) + 3, 6), 17)
    cut = (float(f"{value:.{digits}g}") for value in (expected, computed))
    return *cut, float(f"{tolerance:.3g}"), float(f"{share:.2g}")


def rows_of_file():
    """Rows of the file that have numbers."""
    document = json.loads(DATA.read_text("utf-8"))
    rows = (dict(zip(document["columns"], row, strict=True)) for row in document["rows"])
    return [row for row in rows if row["authority"] != "none"]


def begin():
    """Forget the rows of the test before."""
    _recorded.clear()


def conclude(test, known):
    """What is wrong with the rows of a test that passed; `known` are those of the file."""
    if folder := os.environ.get(WRITING):
        with (Path(folder) / f"{os.getpid()}.jsonl").open("a", encoding="utf-8") as file:
            file.writelines(f"{json.dumps(row)}\n" for row in _recorded)
        return []
    return differences(
        [row for row in known if row["test"] == test],
        [row for row in _recorded if row["test"] == test],
    )


def differences(known, found):
    """Rows that vanished, came or moved, each in words."""
    before, now = (
        {(row["capability"], row["quantity"]): row for row in rows}
        for rows in (known, found)
    )
    told = [f"vanished: {', '.join(key)}" for key in before if key not in now]
    told += [f"not in the file: {', '.join(key)}" for key in now if key not in before]
    for key in before.keys() & now.keys():
        told += _moved(before[key], now[key])
    return told


def _moved(before, now):
    """Of arrays another number may be the worst where all are close: their share alone counts."""
    name = now["quantity"]
    for word in ("authority", "source", "count"):
        if before[word] != now[word]:
            yield f"{name}: {word} is {now[word]!r}, was {before[word]!r}"
    size = abs(before["expected"])
    rounds = max(before["tolerance"], now["tolerance"]) < ROUNDING * size
    limit = 1.0 if rounds else MOVES
    if abs(now["share"] - before["share"]) > limit:
        yield f"{name}: uses {now['share']} of its tolerance, used {before['share']}"
    if now["count"] > 1:
        return
    if abs(now["tolerance"] / before["tolerance"] - 1.0) > 1e-2:
        yield f"{name}: the tolerance is {now['tolerance']}, was {before['tolerance']}"
    if abs(now["expected"] - before["expected"]) > 1e-6 * size + limit * now["tolerance"]:
        yield f"{name}: {now['expected']} is expected, {before['expected']} was"


def without_program():
    """A row for each capability that no independent program has."""
    for capability in evidence.without("program"):
        yield dict.fromkeys(COLUMNS) | {
            "capability": capability,
            "quantity": "all",
            "authority": "none",
            "source": "no independent program",
        }


def text_of(rows):
    """The file: a row a line, in the order of capabilities and tests."""
    order = {name: place for place, name in enumerate(evidence.CAPABILITIES)}
    keys = [
        (order[row["capability"]], row["test"] or "", row["quantity"], row)
        for row in rows
    ]
    lines = [
        json.dumps([row[name] for name in COLUMNS], separators=(",", ":"))
        for *_, row in sorted(keys, key=lambda key: key[:3])
    ]
    head = json.dumps({"columns": COLUMNS})[:-1]
    return f'{head},\n"rows": [\n' + ",\n".join(lines) + "\n]}\n"


def link(test):
    """A test's file and function as a link."""
    path, _, name = re.sub(r"\[.*", "", test).partition("::")
    return f"[{name.removeprefix('test_')}](../{path})"


def table():
    """Of each capability how many rows, their authorities, and the row that is off most."""
    rows = rows_of_file()
    lines = [
        "| capability | rows | authorities | largest share of a tolerance | of which row |",
        "|---|---|---|---|---|",
    ]
    lacking = evidence.without("program")
    for capability in evidence.CAPABILITIES:
        own = [row for row in rows if row["capability"] == capability]
        counts = Counter(row["authority"] for row in own)
        told = [f"{name} {counts[name]}" for name in AUTHORITIES if counts[name]]
        if capability in lacking:
            told.append("independent program: **none**")
        line = f"| {capability} | {len(own)} | {', '.join(told) or 'not in rows'} | "
        if own:
            # Tolerances of rounding are used to any share, and no two processors alike.
            clear = [r for r in own if r["tolerance"] >= ROUNDING * abs(r["expected"])]
            worst = max(clear or own, key=lambda row: row["share"])
            quantity = worst["quantity"].replace("|", "\\|")
            line += f"{worst['share']:.2g} | {quantity}: {link(worst['test'])} |"
        else:
            line += "| |"
        lines.append(line)
    lines.append(f"\n{len(rows)} rows, of {len({r['test'] for r in rows})} tests.")
    return "\n".join(lines)


def with_tables(text):
    """The document with both tables between their marks."""
    own = evidence.between(text, BEGIN, END, table(), DOCUMENT.name)
    return evidence.with_table(own)


def files():
    """Tests that record rows; those of this module record none of the file."""
    return [
        path
        for path in sorted(TESTS.rglob("test_*.py"))
        if path.name != "test_conformance.py"
        and re.search(r"^\s+conforms\(", path.read_text("utf-8"), re.MULTILINE)
    ]


def write(arguments):
    """Run these tests, join the rows of all processes, and write both files again."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pytest", "-q", *arguments, *map(str, files())]
        code = subprocess.run(
            command, cwd=ROOT, env={**os.environ, WRITING: folder}, check=False
        ).returncode
        if code:
            return code
        parts = [path.read_text("utf-8") for path in Path(folder).glob("*.jsonl")]
    rows = [json.loads(line) for part in parts for line in part.splitlines()]
    DATA.write_text(text_of([*rows, *without_program()]), encoding="utf-8")
    DOCUMENT.write_text(with_tables(DOCUMENT.read_text("utf-8")), encoding="utf-8")
    sys.stdout.write(f"{table()}\n")
    return 0


if __name__ == "__main__":
    sys.exit(write(sys.argv[1:]))
