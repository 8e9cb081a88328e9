"""Levels of evidence: the second table of CONFORMANCE.md, from marks on tests.

`@pytest.mark.evidence("devices", "exact")` on a test, or in `pytestmark` of a module, says what it
is evidence of, and of which kind. `cd tests; python -m evidence` writes the table again.
"""

import ast
import re
import sys
from collections import Counter
from pathlib import Path

TESTS = Path(__file__).parent
DOCUMENT = TESTS.parent / "rpscli" / "CONFORMANCE.md"
BEGIN, END = "<!-- evidence: from marks on tests -->", "<!-- end of evidence -->"

KINDS = {
    "exact": "exact solutions and identities",
    "program": "independent programs",
    "published": "numbers published by others",
    "measured": "measurements",
}
CAPABILITIES = (
    "geometry of columns",
    "equation of motion",
    "free-standing blocks",
    "buildings on bearings under earthquakes",
    "impact laws",
    "spherical ends",
    "compliant ends",
    "devices",
    "vertical motion",
    "floors on vertical springs",
    "storeys that yield",
    "both components",
    "turning slabs",
    "steps, events, energy",
    "modes",
    "pushover",
    "forces in columns, friction",
    "floor spectra",
    "measures and spectra of records",
    "selection of records",
    "synthetic motions",
    "statistics and fragilities",
    "risk",
    "design",
    "identification",
    "export",
    "error budget",
)


def marks(node):
    """Capability and kind of each mark in decorators or in a `pytestmark`."""
    for call in ast.walk(node):
        if (
            isinstance(call, ast.Call)
            and ast.unparse(call.func) == "pytest.mark.evidence"
        ):
            capability, kind = (ast.literal_eval(argument) for argument in call.args)
            if capability not in CAPABILITIES or kind not in KINDS:
                raise ValueError(f"{capability!r}, {kind!r}: add it to tests/evidence.py")
            yield capability, kind


def tests_of(path):
    """How many tests of a file are evidence of what."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    of_all = {
        mark
        for node in body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "pytestmark"
        for mark in marks(node)
    }
    found = Counter()
    for node in body:
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test"):
            own = {mark for decorator in node.decorator_list for mark in marks(decorator)}
            found.update(own | of_all)
    return found


def _cells():
    """Of each capability and kind the files, each with the number of its tests."""
    cells = {}
    for path in sorted(TESTS.rglob("test_*.py")):
        place = path.relative_to(TESTS.parent).as_posix()
        link = f"[{path.stem.removeprefix('test_')}](../{place})"
        for mark, count in tests_of(path).items():
            cells.setdefault(mark, []).append(f"{link} {count}")
    return cells


def without(kind):
    """Capabilities that have no evidence of a kind."""
    cells = _cells()
    return [each for each in CAPABILITIES if (each, kind) not in cells]


def table():
    """Rows by capability, columns by kind."""
    cells = _cells()
    lines = ["| capability | " + " | ".join(KINDS.values()) + " |", "|---" * 5 + "|"]
    for capability in CAPABILITIES:
        row = (", ".join(cells.get((capability, kind), ["**none**"])) for kind in KINDS)
        lines.append(f"| {capability} | " + " | ".join(row) + " |")
    for kind, name in KINDS.items():
        lacking = [each for each in CAPABILITIES if (each, kind) not in cells]
        there = [each for each in CAPABILITIES if each not in lacking]
        told = (
            "; ".join(lacking)
            if len(lacking) < len(there)
            else f"all but {'; '.join(there)}"
        )
        lines.append(f"\nWithout {name}: {told} ({len(lacking)} of {len(CAPABILITIES)}).")
    return "\n".join(lines)


def between(text, begin, end, made, name):
    """A document `name` with what is made between its two marks."""
    found = re.subn(f"{begin}[\\s\\S]*?{end}", lambda _: f"{begin}\n{made}\n{end}", text)
    if found[1] != 1:
        raise ValueError(f"{name} has no place `{begin}` ... `{end}`")
    return found[0]


def with_table(text):
    """A document with the table between its two marks."""
    return between(text, BEGIN, END, table(), DOCUMENT.name)


if __name__ == "__main__":
    DOCUMENT.write_text(
        with_table(DOCUMENT.read_text(encoding="utf-8")), encoding="utf-8"
    )
    sys.stdout.write(f"{table()}\n")
