"""Functions: each once for every combination of kinds that it is
called with, in one program.
"""

from __future__ import annotations

import ast
import inspect
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from rpscli.compiler.expressions import Body, Scope, expression, is_true, placed
from rpscli.compiler.mathematics import EXTERNALS, INTRINSICS
from rpscli.compiler.statements import Statements, assign_name, assignments, statements
from rpscli.compiler.values import (
    DOUBLE,
    INT,
    Kind,
    Known,
    NotInLanguage,
    Places,
    Value,
    Widened,
    described,
    is_number,
    joined,
    kind_of,
    literal,
    number_kind,
    parts,
    rebuilt,
    refuse,
    types_of,
)

Function = TypeVar("Function", bound=Callable[..., Any])

_inlined: set[Any] = set()


def inlined(function: Function) -> Function:
    """Mark a function to be merged into its callers, and to know
    the numbers that they know.
    """
    _inlined.add(function)
    return function


SHORT = 60
"""Nodes of an expression's syntax tree: a function that returns one so small is
written in place of its call."""


@dataclass(slots=True, frozen=True)
class Version:
    """A function for some kinds of arguments: its name in the
    program, and what it returns.
    """

    name: str
    kind: Kind


class Program:
    """Functions as LLVM's text, with all that they call."""

    def __init__(self) -> None:
        self._within: list[Any] = []
        self._versions: dict[Any, Version | None] = {}
        self._texts: list[str] = []
        self._loops: list[str] = []
        self._constants: dict[int, tuple[str, Places, Any]] = {}

    def add(
        self,
        function: Callable[..., Any],
        kinds: Sequence[Kind],
        name: str,
        result: str | None = None,
    ) -> None:
        """Add a function that can be called from outside, by a name,
        with arguments of kinds.

        It returns a double (`result`) or nothing. Raises NotInLanguage.
        """
        arguments = [rebuilt(kind, iter(types_of(kind))) for kind in kinds]
        try:
            if len(tree_of(function).args.args) != len(kinds):
                refuse(
                    f"`{function.__name__}` takes another number of arguments than"
                    f" {len(kinds)}"
                )
            self._texts.append(written(self, function, arguments, name, "", result)[0])
        except RecursionError:
            raise NotInLanguage(
                "too much stands within each other: write several statements",
                function.__name__,
            ) from None

    def add_watched(
        self, function: Callable[..., Any], taken: int, given: int, name: str
    ) -> None:
        """Add a function of doubles that is given more than it takes.

        Where it returns no finite number of finite ones, the array
        ``<name>.refused`` is left with 1.0 and what it was given: the last such
        call. What follows from it is not its fault.
        """
        self.add(function, [DOUBLE] * taken, f"@{name}.plain", DOUBLE)
        names = [f"%a.{k}" for k in range(given)]
        outer = ", ".join(f"double {each}" for each in names)
        inner = ", ".join(f"double {each}" for each in names[:taken])
        room = f"[{given + 1} x double]"
        lines = [
            f"@{name}.refused = global {room} zeroinitializer",
            f"define double @{name}({outer}) nounwind {{",
            f"  %r = call double @{name}.plain({inner})",
            "  %size = call double @llvm.fabs.f64(double %r)",
            f"  %refused = fcmp uge double %size, {literal(math.inf, DOUBLE)}",
            "  %sum.0 = fadd double 0.0, 0.0",
        ]
        for k, each in enumerate(names):
            lines += [f"  %size.{k} = call double @llvm.fabs.f64(double {each})"]
            lines += [f"  %sum.{k + 1} = fadd double %sum.{k}, %size.{k}"]
        lines += [
            f"  %finite = fcmp olt double %sum.{given}, {literal(math.inf, DOUBLE)}",
            "  %kept = and i1 %refused, %finite",
            "  br i1 %kept, label %keep, label %end",
            "keep:",
        ]
        for k, value in enumerate(["1.0", *names]):
            place = f"getelementptr inbounds {room}, ptr @{name}.refused, i64 0, i64 {k}"
            lines += [f"  %p.{k} = {place}", f"  store double {value}, ptr %p.{k}"]
        self._texts.append(
            "\n".join([*lines, "  br label %end", "end:", "  ret double %r", "}"])
        )

    def text(self) -> str:
        """All of the program."""
        constants = [line for line, _, _ in self._constants.values()]
        known = [
            declaration(f"llvm.{name}.f64", taken)
            for name, taken in dict.fromkeys(INTRINSICS.values())
        ]
        known += [declaration(name, taken) for name, taken in EXTERNALS.items()]
        loops = [
            f'!{2 * k} = distinct !{{!{2 * k}, !{2 * k + 1}}}\n!{2 * k + 1} = !{{!"{name}"}}'
            for k, name in enumerate(self._loops)
        ]
        return "\n".join([*constants, *known, *self._texts, *loops, ""])

    # What is asked for while functions are written.

    def call(self, body: Body, function: Any, arguments: list[Value]) -> Value:
        """Write the call of a function, or in its place what it returns."""
        node = tree_of(function)
        given = [
            as_float(body, value) if takes_float(parameter) else value
            for parameter, value in zip(node.args.args, arguments, strict=True)
        ]
        if function in self._within:
            refuse(f"`{function.__name__}` calls itself: write a loop")
        self._within.append(function)
        found = in_place(body, function, node, given)
        self._within.pop()
        if found is not None:
            return found
        version = self.version(function, given)
        passed = [
            part
            for value in given
            if not belongs(function, value)
            for part in parts(value)
        ]
        names = ", ".join(f"{kind} {name}" for kind, name in passed)
        kinds = types_of(version.kind)
        if not kinds:
            body.put(f"call void {version.name}({names})")
            return rebuilt(version.kind, iter(()))
        result = body.get(f"call {structure(kinds)} {version.name}({names})")
        if len(kinds) == 1:
            return rebuilt(version.kind, iter([result]))
        taken = (
            body.get(f"extractvalue {structure(kinds)} {result}, {k}")
            for k in range(len(kinds))
        )
        return rebuilt(version.kind, taken)

    def version(self, function: Any, arguments: list[Value]) -> Version:
        """The version of a function for arguments like these,
        written at its first call.
        """
        key = function, tuple(known_part(function, value) for value in arguments)
        if key in self._versions:
            if (version := self._versions[key]) is None:
                refuse(f"`{function.__name__}` calls itself: write a loop")
            return version
        self._versions[key] = None
        name = f"@{function.__name__}.{len(self._versions)}"
        text, kind = written(self, function, arguments, name, "internal ")
        self._texts.append(text)
        version = self._versions[key] = Version(name, kind)
        return version

    def constant(self, array: Any) -> Places:
        """Keep a known array or tuple of numbers; each once."""
        if id(array) not in self._constants:
            numbers = np.asarray(array)
            if numbers.dtype not in (np.bool_, np.int64, np.float64):
                refuse(f"a known array of {numbers.dtype}: make it float64 or int64")
            kind = DOUBLE if numbers.dtype.kind == "f" else INT
            name = f"@constant.{len(self._constants)}"
            line = f"{name} = private unnamed_addr constant {initial(numbers, kind)}"
            self._constants[id(array)] = line, Places(kind, numbers.shape, name), array
        return self._constants[id(array)][1]

    def loop(self, name: str) -> str:
        """Metadata with which LLVM knows a loop by name: it says
        there what became of it.
        """
        self._loops.append(name)
        return f"!{2 * len(self._loops) - 2}"

    def arguments(
        self, function: Any, given: list[Value], by_name: dict[str, Value]
    ) -> list[Value]:
        """Arguments in the order of parameters, with those that have defaults."""
        if hasattr(function, "_fields"):
            names = list(function._fields)
            defaults = dict(function._field_defaults)
        else:
            names = [parameter.arg for parameter in tree_of(function).args.args]
            values = function.__defaults__ or ()
            defaults = dict(zip(names[len(names) - len(values) :], values, strict=True))
        found: dict[str, Value] = {name: Known(value) for name, value in defaults.items()}
        found |= dict(zip(names, given, strict=False)) | by_name
        if len(given) > len(names) or set(found) != set(names):
            refuse(f"`{function.__name__}` takes {', '.join(names)}")
        return [found[name] for name in names]


def declaration(name: str, taken: int) -> str:
    """A function of doubles that reads and writes nothing else."""
    return (
        f"declare double @{name}({', '.join([DOUBLE] * taken)}) nounwind willreturn"
        " memory(none)"
    )


def initial(numbers: Any, kind: str) -> str:
    """A constant array with its type."""
    if numbers.ndim == 0:
        return f"{kind} {literal(numbers.item(), kind)}"
    inner = [initial(each, kind) for each in numbers]
    of = inner[0][: inner[0].rindex(" [") if numbers.ndim > 1 else len(kind)]
    return f"[{len(inner)} x {of}] [{', '.join(inner)}]"


def structure(kinds: list[str]) -> str:
    """The type of what a function returns."""
    return kinds[0] if len(kinds) == 1 else "{" + ", ".join(kinds) + "}"


def is_known(value: Value) -> bool:
    """True if a value is a known number."""
    return isinstance(value, Known) and is_number(value.value)


def belongs(function: Any, value: Value) -> bool:
    """True if an argument is part of the version: a known number of a
    function that is inlined.
    """
    return function in _inlined and is_known(value)


def known_part(function: Any, value: Value) -> Any:
    """Part of an argument that tells versions apart."""
    if belongs(function, value):
        assert isinstance(value, Known)
        return number_kind(value.value), repr(value.value)
    return kind_of(value)


def takes_float(parameter: ast.arg) -> bool:
    """True if a parameter is annotated as a float: ints that
    it is given become floats.
    """
    return (
        isinstance(parameter.annotation, ast.Name) and parameter.annotation.id == "float"
    )


def as_float(body: Body, value: Value) -> Value:
    """A number as a float, known if it was."""
    if isinstance(value, Known) and is_number(value.value):
        return Known(float(value.value))
    return body.as_kind(value, DOUBLE)


# Sources.


@cache
def tree_of_module(name: str) -> ast.Module:
    """The syntax tree of a module."""
    try:
        return ast.parse(inspect.getsource(sys.modules[name]))
    except (OSError, TypeError, KeyError) as error:
        raise NotInLanguage(
            f"the source of `{name}` cannot be read ({error}): it must stand in a file",
            name,
        ) from None


@cache
def tree_of(function: Any) -> ast.FunctionDef:
    """The syntax tree of a function: one of a file, wherever it stands in it."""
    code = getattr(function, "__code__", None)
    if code is None:
        refuse(f"`{getattr(function, '__name__', function)}` is not written in Python")
    if hasattr(function, "__wrapped__"):
        refuse(f"`{function.__name__}` is decorated: call what it wraps")
    node = found_in_file(function, code)
    given = node.args
    if given.vararg or given.kwarg or given.kwonlyargs or given.posonlyargs:
        refuse(
            f"`{function.__name__}` has `*` or `/` among its parameters: write plain ones"
        )
    return node


def found_in_file(function: Any, code: Any) -> ast.FunctionDef:
    """A function in the syntax tree of its module."""
    lambdas = []
    for node in ast.walk(tree_of_module(function.__module__)):
        if isinstance(node, ast.FunctionDef) and node.name == function.__name__:
            lines = [node.lineno, *(each.lineno for each in node.decorator_list)]
            if code.co_firstlineno in lines:
                return node
        if isinstance(node, ast.Lambda) and is_lambda(function, node):
            returned = ast.copy_location(ast.Return(node.body), node)
            lambdas.append(
                ast.FunctionDef("lambda", node.args, [returned], [], lineno=node.lineno)
            )
    if len(lambdas) == 1:
        return lambdas[0]
    refuse(
        f"`{function.__name__}` is not found in its file: give it a name, at the file's"
        " top"
    )


def is_lambda(function: Any, node: ast.Lambda) -> bool:
    """True if a nameless function is that of a place in its file."""
    code = function.__code__
    if function.__name__ != "<lambda>" or node.lineno != code.co_firstlineno:
        return False
    return [each.arg for each in node.args.args] == list(
        code.co_varnames[: code.co_argcount]
    )


def scope_of(function: Any, names: dict[str, Value]) -> Scope:
    """Where a function looks up its names."""
    inner = function.__code__.co_freevars
    cells = [cell.cell_contents for cell in function.__closure__ or ()]
    module = {**function.__globals__, **dict(zip(inner, cells, strict=True))}
    own = frozenset(assignments(tree_of(function)))
    return Scope(Path(function.__code__.co_filename).name, dict(names), module, own)


# How a function is written.


def in_place(
    body: Body, function: Any, node: ast.FunctionDef, given: list[Value]
) -> Value | None:
    """Value of a function whose known tests leave one short expression; else None."""
    names = {of.arg: value for of, value in zip(node.args.args, given, strict=True)}
    outside = body.scope
    written_so_far = len(body.lines)
    allocated = len(body.allocas)
    body.scope = scope_of(function, names)
    try:
        following = list(node.body)
        while following:
            statement = following.pop(0)
            if isinstance(statement, ast.Return) and is_short(statement.value):
                assert statement.value is not None
                return expression(body, statement.value)
            if isinstance(statement, ast.If) and not has_effects(statement.test):
                test = expression(body, statement.test)
                if isinstance(test, Known):
                    chosen = statement.body if is_true(test) else statement.orelse
                    following = list(chosen) + following
                    continue
            if not is_text(statement):
                break
        del body.lines[written_so_far:]
        del body.allocas[allocated:]
        return None
    finally:
        body.scope = outside


def is_short(node: ast.expr | None) -> bool:
    """True if an expression is small enough to be written in place of a call."""
    return node is not None and sum(1 for _ in ast.walk(node)) <= SHORT


def has_effects(node: ast.expr) -> bool:
    """True if an expression may need more than the block that it begins in."""
    return any(isinstance(each, (ast.BoolOp, ast.IfExp)) for each in ast.walk(node))


def is_text(node: ast.stmt) -> bool:
    """True if a statement is a docstring."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def written(
    program: Program,
    function: Any,
    arguments: list[Value],
    name: str,
    linkage: str,
    result: str | None = None,
) -> tuple[str, Kind]:
    """The text of a version of a function, and what it returns."""
    widened: dict[str, Kind] = {}
    while True:
        try:
            return written_with(
                program, function, arguments, name, linkage, widened, result
            )
        except Widened as found:
            widened[found.name] = found.kind


def written_with(
    program: Program,
    function: Any,
    arguments: list[Value],
    name: str,
    linkage: str,
    widened: dict[str, Kind],
    result: str | None,
) -> tuple[str, Kind]:
    """A function written with some variables known to be of wider kinds."""
    node = tree_of(function)
    body = Statements(program, scope_of(function, {}), node, widened)
    taken: list[str] = []
    for parameter, value in zip(node.args.args, arguments, strict=True):
        inside = value
        if not belongs(function, value):
            names = [f"%a.{len(taken) + k}" for k, _ in enumerate(parts(value))]
            taken += [
                f"{of} {each}" for (of, _), each in zip(parts(value), names, strict=True)
            ]
            inside = rebuilt(kind_of(value), iter(names))
        if body.assigned[parameter.arg]:
            body.assigned[parameter.arg] += 1
            assign_name(body, parameter.arg, inside)
        else:
            body.scope.names[parameter.arg] = inside
    statements(body, node.body)
    if not body.ended:
        body.returns.append((len(body.lines), Known(None)))
        body.lines.append("")
    try:
        kind = returned(body, result)
    except NotInLanguage as error:
        raise placed(error, body, node) from None
    head = (
        f"define {linkage}{structure(types_of(kind)) if types_of(kind) else 'void'}"
        f" {name}"
    )
    merged = "alwaysinline " if function in _inlined and linkage else ""
    lines = [f"{head}({', '.join(taken)}) {merged}nounwind {{", "entry:"]
    return "\n".join([*lines, *body.allocas, *body.lines, "}"]), kind


def returned(body: Statements, result: str | None) -> Kind:
    """Write all returns, now that it is known what they have in common, or `result`."""
    kind: Kind = result
    for _, value in body.returns:
        mine = kind_of(value)
        both = mine if kind is None else joined(kind, mine)
        if both is None:
            refuse(
                f"`{body.name}` returns values of two kinds: return the same everywhere"
            )
        kind = both
        if mine[0] == "known" and mine[1].value.value is not None:
            refuse(f"`{body.name}` returns {described(value)}: return numbers, or tuples")
    kinds = types_of(kind)
    lines = body.lines
    for at, value in reversed(body.returns):
        body.lines = []
        given = [name for _, name in parts(body.as_kind(value, kind))]
        if not kinds:
            body.put("ret void")
        elif len(kinds) == 1:
            body.put(f"ret {kinds[0]} {given[0]}")
        else:
            whole = "undef"
            for k, (of, each) in enumerate(zip(kinds, given, strict=True)):
                whole = body.get(
                    f"insertvalue {structure(kinds)} {whole}, {of} {each}, {k}"
                )
            body.put(f"ret {structure(kinds)} {whole}")
        lines[at : at + 1] = body.lines
    body.lines = lines
    return kind
