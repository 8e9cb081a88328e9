"""Docstrings: their examples show what they say; arguments and fields of what is public are told.

Public is what `import rpscli` offers; elsewhere a line with shapes and units is enough.
"""

import ast
import doctest
import importlib
import re
from pathlib import Path

import pytest

import rpscli

ROOT = Path(__file__).parents[1]
WITH_EXAMPLES = [
    path
    for path in sorted((ROOT / "rpscli").rglob("*.py"))
    if ">>> " in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize(
    "path", WITH_EXAMPLES, ids=lambda path: str(path.relative_to(ROOT))
)
def test_examples(path):
    """Of whatever has a docstring: doctest itself finds none of cached properties."""
    text = path.read_text(encoding="utf-8")
    name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(
        ".__init__"
    )
    names = vars(importlib.import_module(name))
    runner, parser = doctest.DocTestRunner(), doctest.DocTestParser()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)):
            place = f"{name}.{getattr(node, 'name', '')}"
            examples = parser.get_doctest(
                ast.get_docstring(node) or "", names, place, None, None
            )
            runner.run(examples)
    assert runner.tries == text.count(">>> ")
    assert not runner.failures


PACKAGE = Path(rpscli.__file__).parent
HEAD = re.compile(r"(\w+(?:, \w+)*)(?: : .+)?")
"""Names of a section, and beside them perhaps a type."""


def described(docstring):
    """The names that Parameters or Attributes describe, with a line about them below."""
    lines = (docstring or "").splitlines()
    names, inside = set[str](), False
    for line, below in zip(lines, [*lines[1:], ""], strict=True):
        if below.startswith("---"):
            inside = line in {"Parameters", "Attributes"}
        elif inside and (head := HEAD.fullmatch(line)) and below.startswith("    "):
            names.update(head[1].split(", "))
    return names


def public(body):
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith(
            "_"
        ):
            yield node
            if isinstance(node, ast.ClassDef):
                yield from public(node.body)


def arguments(function):
    given = function.args
    names = [one.arg for one in given.posonlyargs + given.args + given.kwonlyargs]
    return [name for name in names if name not in {"self", "cls"}]


def fields(body):
    """Names of the fields, and those with a docstring of their own."""
    names, explained = list[str](), set[str]()
    for node, below in zip(body, [*body[1:], ast.Pass()], strict=True):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.append(node.target.id)
            if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
                explained.add(node.target.id)
    return names, explained


def unexplained(node, standing):
    known = described(ast.get_docstring(node))
    if isinstance(node, ast.FunctionDef):
        names, known = arguments(node), known | standing
    else:
        names, explained = fields(node.body)
        known |= explained
    open_to_all = {name for name in names if not name.startswith("_")}
    return open_to_all - known if len(names) > 1 else set()


def shared(node):
    """Arguments of the methods of a class, which are not its fields."""
    if isinstance(node, ast.FunctionDef):
        return set()
    methods = [each for each in public(node.body) if isinstance(each, ast.FunctionDef)]
    return {name for each in methods for name in arguments(each)} - set(
        fields(node.body)[0]
    )


def parsed(file):
    return ast.parse(file.read_text(encoding="utf-8"))


def public_nodes():
    """What `import rpscli` offers, with its modules.

    Beside each stand the names that its class explains for all its methods.
    """
    for module, names in rpscli._HOMES.items():
        file = PACKAGE.joinpath(*module.split(".")).with_suffix(".py")
        for node in parsed(file).body:
            if not isinstance(
                node, ast.FunctionDef | ast.ClassDef
            ) or node.name.startswith("_"):
                continue
            if node.name in names.split():
                # An answer to what a base class asks has no docstring; linters see to all others.
                for each in filter(ast.get_docstring, public([node])):
                    yield module, each, described(ast.get_docstring(node)) & shared(node)


def test_arguments_and_fields_are_explained():
    missing = {
        f"{module}: {node.name}": names
        for module, node, standing in public_nodes()
        if (names := unexplained(node, standing))
    }
    assert not missing
