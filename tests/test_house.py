"""What a stranger feels in the house: counted, so that it stays."""

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "rpscli"
FILES = sorted(PACKAGE.rglob("*.py"))
CORE = [path for path in FILES if "tools" not in path.relative_to(PACKAGE).parts[:1]]
TREES = {path: ast.parse(path.read_text("utf-8")) for path in FILES}


def of(kind, paths):
    return [
        (path, node)
        for path in paths
        for node in ast.walk(TREES[path])
        if isinstance(node, kind)
    ]


def is_packed(node):
    both = node.targets[0], node.value
    return all(isinstance(each, ast.Tuple) for each in both) and len(node.value.elts) > 1


def imports_of_tools():
    for path, node in of((ast.Import, ast.ImportFrom), FILES):
        place = path.relative_to(PACKAGE).parts
        mine = place[1].removesuffix(".py") if place[0] == "tools" else ""
        names = (
            [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else [a.name for a in node.names]
        )
        for name in names:
            if name.startswith("rpscli.tools.") and name.split(".")[2] != mine:
                yield path, name


BRANCH = r"(?:ways_of\(s\)|\bways) *(?:==|!=|>|<)"

COUNTS = {
    "imports of tools": (lambda: [*imports_of_tools()], 0),
    "tools behind the wall": (lambda: [*(PACKAGE / "tools").glob("*/__init__.py")], 7),
    "functions above 45 lines": (
        lambda: [f for _, f in of((ast.FunctionDef, ast.AsyncFunctionDef), FILES)
                 if f.end_lineno - f.lineno + 1 > 45], 0,
    ),
    "files above 600 lines": (
        lambda: [f for f in FILES if len(f.read_text("utf-8").splitlines()) > 600], 0,
    ),
    "packed assignments": (lambda: [n for _, n in of(ast.Assign, CORE) if is_packed(n)], 20),
    "lines above 90 characters": (
        lambda: [x for f in CORE for x in f.read_text("utf-8").splitlines() if len(x) > 90], 200,
    ),
    "branches on directions in physics": (
        lambda: [x for f in (PACKAGE / "physics").rglob("*.py")
                 for x in re.findall(BRANCH, f.read_text("utf-8"))], 55,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", COUNTS)
def test_the_house_keeps_its_counts(name):
    found, most = COUNTS[name]
    assert len(found()) <= most, found()
