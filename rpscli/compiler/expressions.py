"""Expressions: the text that computes a value."""

from __future__ import annotations

import ast
import builtins
import math
import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from rpscli.compiler.mathematics import (
    BUILT_IN,
    call_of_numbers,
    external,
    fma,
    known,
    two,
    whole_division,
)
from rpscli.compiler.values import (
    BOOL,
    DOUBLE,
    INT,
    Code,
    Kind,
    Known,
    Matrix,
    NotInLanguage,
    Number,
    Places,
    Record,
    Rows,
    Tuple,
    Value,
    described,
    elements_of,
    joined,
    kind_of,
    parts,
    rebuilt,
    refuse,
    types_of,
)


@dataclass(slots=True)
class Slot:
    """Where a variable stands on the stack, and in which block
    of statements that began.
    """

    kind: Kind
    rooms: list[str]
    region: int


@dataclass(slots=True)
class Scope:
    """Where the names of a function are looked up."""

    file: str
    names: dict[str, Value | Slot]
    module: dict[str, Any]
    own: frozenset[str] = frozenset()
    """Names that are assigned to somewhere in the function: none of the module."""


class Writer(Protocol):
    """Methods of the other modules: calls of functions, and arrays that are known."""

    def call(self, body: Body, function: Any, arguments: list[Value]) -> Value:
        """Write the call of a function of Python."""

    def constant(self, array: Any) -> Places:
        """Keep a known array of numbers in the program."""

    def loop(self, name: str) -> str:
        """Metadata with which LLVM knows a loop by name."""

    def arguments(
        self, function: Any, given: list[Value], by_name: dict[str, Value]
    ) -> list[Value]:
        """Put arguments in order."""


class Body(Code):
    """A function while it is written, within a program."""

    def __init__(self, program: Writer, scope: Scope) -> None:
        super().__init__()
        self.program = program
        self.scope = scope


def expression(body: Body, node: ast.expr) -> Value:
    """Write what computes an expression."""
    write = EXPRESSIONS.get(type(node))
    try:
        if write is None:
            refuse(f"`{ast.unparse(node)}`: write it with what the language has")
        return write(body, node)
    except NotInLanguage as error:
        raise placed(error, body, node) from None


def placed(error: NotInLanguage, body: Body, node: ast.AST) -> NotInLanguage:
    """An error with file and line, which it may have already."""
    if len(error.args) == 1:
        return NotInLanguage(
            error.args[0], f"{body.scope.file}:{getattr(node, 'lineno', 0)}"
        )
    return error


def read_name(body: Body, node: ast.Name) -> Value:
    """A variable, a name of the module, or of Python."""
    name = node.id
    found = body.scope.names.get(name)
    if isinstance(found, Slot):
        loaded = (
            body.get(f"load {kind}, ptr {room}")
            for kind, room in zip(types_of(found.kind), found.rooms, strict=True)
        )
        return rebuilt(found.kind, loaded)
    if found is not None:
        return found
    if name in body.scope.own:
        refuse(f"`{name}` has no value yet: assign it before, of one kind")
    if name in body.scope.module:
        return Known(body.scope.module[name])
    if hasattr(builtins, name):
        return Known(getattr(builtins, name))
    refuse(f"`{name}` has no value yet: assign it before, of one kind")


# Fields, rows, places.


def array_type(kind: str, shape: Sequence[int]) -> str:
    """An array's type in LLVM."""
    for size in reversed(shape):
        kind = f"[{size} x {kind}]"
    return kind


def field(body: Body, record: Record, name: str) -> Places:
    """A field of a record, as a place: a number is one of shape ()."""
    if record.dtype.fields is None or name not in record.dtype.fields:
        refuse(f"`{name}` is no field of that record")
    found, offset = record.dtype.fields[name][:2]
    base, shape = found.subdtype or (found, ())
    if base not in (np.float64, np.int64):
        refuse(f"the field `{name}` is {base}: make it float64 or int64")
    address = record.name
    if offset:
        address = body.get(f"getelementptr inbounds i8, ptr {record.name}, i64 {offset}")
    return Places(DOUBLE if base.kind == "f" else INT, tuple(shape), address)


def read_attribute(body: Body, node: ast.Attribute) -> Value:
    """A field of a record or of a NamedTuple, a shape, or a name of a module."""
    value = expression(body, node.value)
    name = node.attr
    if isinstance(value, Known) and hasattr(value.value, name):
        return Known(getattr(value.value, name))
    if isinstance(value, Tuple) and name in getattr(value.of, "_fields", ()):
        fields: tuple[str, ...] = value.of._fields
        return value.elements[fields.index(name)]
    if name == "shape" and isinstance(value, Places):
        return Known(value.shape)
    if name == "shape" and isinstance(value, (Rows, Matrix)):
        sizes = (value.count,) if isinstance(value, Rows) else value.sizes
        return Tuple(tuple(Number(INT, size) for size in sizes))
    if isinstance(value, Record):
        place = field(body, value, name)
        return place if place.shape else load(body, place)
    refuse(
        f"`.{name}` of {described(value)}: records and NamedTuples have fields, arrays a"
        " shape"
    )


def load(body: Body, place: Places) -> Number:
    """The number at a place."""
    return Number(place.kind, body.get(f"load {place.kind}, ptr {place.name}"))


def row(body: Body, rows: Rows, i: str) -> str:
    """The address of a row."""
    offset = body.get(f"mul i64 {i}, {rows.dtype.itemsize}")
    return body.get(f"getelementptr inbounds i8, ptr {rows.name}, i64 {offset}")


def element(body: Body, array: Value, indices: list[Value]) -> Places | Matrix | Record:
    """A place in an array, or an array of what fewer indices leave open."""
    names = [body.index(i) for i in indices]
    sizes = array.shape if isinstance(array, Places) else (math.inf,) * len(indices)
    for i, most in zip(indices, sizes, strict=False):
        if isinstance(i, Known) and not 0 <= i.value < most:
            refuse(f"the index {i.value}: indices are from 0 to one below the size")
    if isinstance(array, Rows) and len(names) == 1:
        return Record(array.dtype, row(body, array, names[0]))
    if isinstance(array, Places) and 0 < len(names) <= len(array.shape):
        steps = ", ".join(f"i64 {i}" for i in ["0", *names])
        whole = array_type(array.kind, array.shape)
        address = body.get(f"getelementptr inbounds {whole}, ptr {array.name}, {steps}")
        return Places(array.kind, array.shape[len(names) :], address)
    if isinstance(array, Matrix) and len(names) <= len(array.sizes):
        flat = names[0]
        for k, size in enumerate(array.sizes[1:], 1):
            flat = body.get(f"mul i64 {flat}, {size}")
            if k < len(names):
                flat = body.get(f"add i64 {flat}, {names[k]}")
        address = body.get(f"getelementptr inbounds double, ptr {array.name}, i64 {flat}")
        left = array.sizes[len(names) :]
        return Matrix(address, left) if left else Places(DOUBLE, (), address)
    refuse(
        f"{described(array)} with {len(names)} indices: index arrays, tuples, rows of"
        " records"
    )


def read_element(body: Body, node: ast.Subscript) -> Value:
    """An element of a tuple or an array, a record of rows, or a part of rows."""
    value = expression(body, node.value)
    if isinstance(node.slice, ast.Slice):
        return part_of_rows(body, value, node.slice)
    nodes = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    indices = [expression(body, each) for each in nodes]
    known = [i.value for i in indices if isinstance(i, Known)]
    elements = elements_of(value)
    if len(known) == len(indices):
        try:
            if isinstance(value, Known):
                return Known(value.value[tuple(known) if len(known) > 1 else known[0]])
            if elements is not None:
                place: int = known[0]
                return elements[place]
        except (IndexError, TypeError, KeyError) as error:
            refuse(f"the index {known[0]}: {error}")
    if elements is not None:
        return one_of(body, elements, indices[0])
    of_bools = (
        isinstance(value, Known) and getattr(value.value, "dtype", None) == np.bool_
    )
    if isinstance(value, Known):
        value = body.program.constant(value.value)
    found = element(body, value, indices)
    if not isinstance(found, Places) or found.shape:
        return found
    number = load(body, found)
    return Number(BOOL, body.number(number, BOOL)) if of_bools else number


def part_of_rows(body: Body, value: Value, part: ast.Slice) -> Value:
    """Rows from one up to another."""
    if not isinstance(value, Rows) or not part.lower or not part.upper or part.step:
        refuse(
            "slices are of rows of records, `rows[first : end]`: use indices elsewhere"
        )
    first = body.index(expression(body, part.lower))
    end = body.index(expression(body, part.upper))
    return Rows(value.dtype, row(body, value, first), body.get(f"sub i64 {end}, {first}"))


def one_of(body: Body, elements: tuple[Value, ...], index: Value) -> Number:
    """An element of a tuple of numbers by an index that is known when the code runs."""
    kind: Kind = INT
    for each in elements:
        kind = joined(kind, kind_of(each))
    if not isinstance(kind, str):
        refuse("a tuple is indexed by a variable: all its elements must be numbers")
    room = body.room(array_type(kind, [len(elements)]))
    array = Places(kind, (len(elements),), room)
    for k, each in enumerate(elements):
        place = element(body, array, [Known(k)])
        assert isinstance(place, Places)
        body.put(f"store {kind} {body.number(each, kind)}, ptr {place.name}")
    place = element(body, array, [index])
    assert isinstance(place, Places)
    return load(body, place)


# Operators.

ARITHMETIC: dict[type, tuple[str, str, Callable[[Any, Any], Any]]] = {
    ast.Add: ("fadd", "add nsw", operator.add),
    ast.Sub: ("fsub", "sub nsw", operator.sub),
    ast.Mult: ("fmul", "mul nsw", operator.mul),
    ast.Div: ("fdiv", "", operator.truediv),
    ast.FloorDiv: ("", "", operator.floordiv),
    ast.Mod: ("", "", operator.mod),
    ast.Pow: ("", "", operator.pow),
    ast.BitAnd: ("", "and", operator.and_),
    ast.BitOr: ("", "or", operator.or_),
}
COMPARISONS: dict[type, tuple[str, str, Callable[[Any, Any], Any]]] = {
    ast.Lt: ("olt", "slt", operator.lt),
    ast.LtE: ("ole", "sle", operator.le),
    ast.Gt: ("ogt", "sgt", operator.gt),
    ast.GtE: ("oge", "sge", operator.ge),
    ast.Eq: ("oeq", "eq", operator.eq),
    ast.NotEq: ("une", "ne", operator.ne),
}


def binary(body: Body, of: type, one: Value, other: Value) -> Value:
    """The text of an operator between two numbers."""
    if of not in ARITHMETIC:
        refuse("this operator: use + - * / // % ** & |")
    of_doubles, of_ints, in_python = ARITHMETIC[of]
    if (found := known(in_python, one, other)) is not None:
        return found
    kinds = {kind_of(one), kind_of(other)}
    if of is ast.Pow:
        return external(body, "pow", [one, other])
    if kinds == {BOOL} and of not in {ast.BitAnd, ast.BitOr}:
        refuse(
            "arithmetic of two bools, which numpy has otherwise: write `1 if test else 0`"
        )
    if of in {ast.BitAnd, ast.BitOr}:
        if DOUBLE in kinds:
            refuse("& and | are of bools or of ints")
        kind = BOOL if kinds == {BOOL} else INT
        return Number(kind, two(body, of_ints, kind, one, other))
    if of is ast.Div or (DOUBLE in kinds and of_doubles):
        return Number(DOUBLE, two(body, of_doubles, DOUBLE, one, other))
    if of_ints:
        return Number(INT, two(body, of_ints, INT, one, other))
    if DOUBLE in kinds:
        refuse("// and % are of ints: write x - y * math.floor(x / y)")
    return whole_division(body, of, body.number(one, INT), body.number(other, INT))


def unary(body: Body, node: ast.UnaryOp) -> Value:
    """A sign, or `not`."""
    value = expression(body, node.operand)
    if isinstance(node.op, ast.Not):
        if isinstance(value, Known):
            return Known(not is_true(value))
        return Number(BOOL, body.get(f"xor i1 {body.number(value, BOOL)}, true"))
    if isinstance(node.op, ast.UAdd):
        return (
            Number(DOUBLE, body.number(value, DOUBLE))
            if kind_of(value) == DOUBLE
            else value
        )
    if kind_of(value) == BOOL:
        refuse("a sign before a bool: write `-1 if test else 0`")
    if (found := known(operator.neg, value)) is not None and isinstance(
        node.op, ast.USub
    ):
        return found
    if not isinstance(node.op, ast.USub):
        refuse("`~`: write it in another way")
    if kind_of(value) == DOUBLE:
        return Number(DOUBLE, body.get(f"fneg double {body.number(value, DOUBLE)}"))
    return Number(INT, body.get(f"sub nsw i64 0, {body.number(value, INT)}"))


OF_KNOWN: dict[type, Callable[[Any, Any], Any]] = {
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.In: lambda one, others: one in others,
    ast.NotIn: lambda one, others: one not in others,
}
"""Comparisons of what is known, such as words."""


def is_true(value: Known) -> bool:
    """True if something known counts as true."""
    try:
        return bool(value.value)
    except ValueError as error:
        refuse(f"{described(value)} as a test: {error}")


def compared(body: Body, of: ast.cmpop, one: Value, other: Value) -> Value:
    """True if a comparison holds."""
    if isinstance(one, Known) and isinstance(other, Known) and type(of) in OF_KNOWN:
        return Known(bool(OF_KNOWN[type(of)](one.value, other.value)))
    if isinstance(of, (ast.In, ast.NotIn)):
        return contained(body, of, one, elements_of(other))
    if type(of) not in COMPARISONS:
        refuse("`is`: compare with ==")
    of_doubles, of_ints, in_python = COMPARISONS[type(of)]
    if (found := known(in_python, one, other)) is not None:
        return found
    kind = joined(kind_of(one), kind_of(other))
    kind = joined(kind, INT) if isinstance(kind, str) else DOUBLE
    test = f"fcmp {of_doubles}" if kind == DOUBLE else f"icmp {of_ints}"
    return Number(BOOL, two(body, test, kind, one, other))


def contained(
    body: Body, of: ast.cmpop, one: Value, others: tuple[Value, ...] | None
) -> Value:
    """True if a number is one of a tuple's."""
    if others is None:
        refuse("`in`: followed by a tuple")
    found: Value = Known(False)  # noqa: FBT003 -- a number
    for each in others:
        found = binary(body, ast.BitOr, found, compared(body, ast.Eq(), one, each))
    if isinstance(of, ast.In):
        return found
    if isinstance(found, Known):
        return Known(not found.value)
    return Number(BOOL, body.get(f"xor i1 {body.number(found, BOOL)}, true"))


SLOW = ast.Call, ast.Subscript, ast.Div, ast.Pow, ast.FloorDiv, ast.Mod


def is_simple(node: ast.expr) -> bool:
    """True if an expression may be computed where its value is not needed."""
    return not any(isinstance(each, SLOW) for each in ast.walk(node))


def has_call(node: ast.expr) -> bool:
    """True if an expression calls a function."""
    return any(isinstance(each, ast.Call) for each in ast.walk(node))


def compare(body: Body, node: ast.Compare) -> Value:
    """A comparison, or a chain of them: as `and` of each, the middle computed once."""
    one = expression(body, node.left)
    held: Value = Known(True)  # noqa: FBT003 -- a number
    for of, right in zip(node.ops, node.comparators, strict=True):
        if held != Known(True) and has_call(right):  # noqa: FBT003
            refuse("a chain of comparisons ends with a call: write it with `and`")
        other = expression(body, right)
        test = compared(body, of, one, other)
        held = test if held == Known(True) else binary(body, ast.BitAnd, held, test)  # noqa: FBT003
        one = other
    return held


def truth(body: Body, node: ast.expr) -> Value:
    """An operand of `and` and `or`, which must be a bool: Python would
    give the operand itself.
    """
    value = expression(body, node)
    if kind_of(value) != BOOL:
        refuse(
            f"`{ast.unparse(node)}` beside `and` or `or` is no bool: write a comparison"
        )
    return value


def choose(body: Body, node: ast.BoolOp) -> Value:
    """`and`, `or`: what follows is computed only where it decides."""
    is_and = isinstance(node.op, ast.And)
    value = truth(body, node.values[0])
    for following in node.values[1:]:
        if isinstance(value, Known):
            if bool(value.value) != is_and:
                return value
            value = truth(body, following)
            continue
        name = body.number(value, BOOL)
        if is_simple(following):
            other = body.number(truth(body, following), BOOL)
            both = f"{other}, i1 false" if is_and else f"true, i1 {other}"
            value = Number(BOOL, body.get(f"select i1 {name}, i1 {both}"))
            continue
        on = body.new("and")
        end = body.new("decided")
        before = body.block
        body.branch(name, *((on, end) if is_and else (end, on)))
        body.label(on)
        other = body.number(truth(body, following), BOOL)
        after = body.block
        body.jump(end)
        body.label(end)
        decided = "false" if is_and else "true"
        value = Number(
            BOOL, body.get(f"phi i1 [{decided}, %{before}], [{other}, %{after}]")
        )
    return value


def conditional(body: Body, node: ast.IfExp) -> Value:
    """One value or the other; both are computed where that is as quick as to choose."""
    test = expression(body, node.test)
    if isinstance(test, Known):
        return expression(body, node.body if is_true(test) else node.orelse)
    name = body.number(test, BOOL)
    if is_simple(node.body) and is_simple(node.orelse):
        one = expression(body, node.body)
        other = expression(body, node.orelse)
        kind = common(kind_of(one), kind_of(other))
        pairs = zip(
            parts(body.as_kind(one, kind)), parts(body.as_kind(other, kind)), strict=True
        )
        chosen = (
            body.get(f"select i1 {name}, {of} {x}, {of} {y}") for (of, x), (_, y) in pairs
        )
        return rebuilt(kind, chosen)
    yes = body.new("yes")
    no = body.new("no")
    end = body.new("chosen")
    body.branch(name, yes, no)
    body.label(yes)
    one = expression(body, node.body)
    first = body.block
    written = len(body.lines)
    body.label(no)
    other = expression(body, node.orelse)
    kind = common(kind_of(one), kind_of(other))
    other = body.as_kind(other, kind)
    second = body.block
    body.jump(end)
    later = body.lines[written:]
    del body.lines[written:]
    one = body.as_kind(one, kind)  # known only now, at the end of its own block
    body.put(f"br label %{end}")
    body.lines += later
    body.label(end)
    pairs = zip(parts(one), parts(other), strict=True)
    chosen = (
        body.get(f"phi {of} [{x}, %{first}], [{y}, %{second}]")
        for (of, x), (_, y) in pairs
    )
    return rebuilt(kind, chosen)


def common(one: Kind, other: Kind) -> Kind:
    """The kind of either of two values."""
    kind = joined(one, other)
    if kind is None or (kind != one and isinstance(kind, tuple) and kind[0] == "known"):
        refuse("of two kinds: give both the same number of numbers")
    return kind


# Calls.


def call(body: Body, node: ast.Call) -> Value:
    """The call of a function of the language, of `math`, or of one
    that is compiled with it.
    """
    called = expression(body, node.func)
    if not isinstance(called, Known) or not callable(called.value):
        refuse(f"`{ast.unparse(node.func)}` is no function that is known")
    function = called.value
    given = [expression(body, each) for each in node.args]
    by_name = {each.arg or "": expression(body, each.value) for each in node.keywords}
    if hasattr(function, "_fields"):
        if function.__mro__[1] is not tuple:
            refuse(f"`{function.__name__}` is derived from a NamedTuple: use that itself")
        return Tuple(tuple(body.program.arguments(function, given, by_name)), function)
    of_math = function is fma or isinstance(function, np.ufunc)
    of_math = of_math or getattr(function, "__module__", "") == "math"
    if not of_math and function not in BUILT_IN:
        arguments = body.program.arguments(function, given, by_name)
        return body.program.call(body, function, arguments)
    return call_of_numbers(body, function, given, by_name)


EXPRESSIONS: dict[type, Callable[[Body, Any], Value]] = {
    ast.Constant: lambda _, node: Known(node.value),
    ast.Name: read_name,
    ast.Tuple: lambda body, node: Tuple(
        tuple(expression(body, each) for each in node.elts)
    ),
    ast.Attribute: read_attribute,
    ast.Subscript: read_element,
    ast.UnaryOp: unary,
    ast.BinOp: lambda body, node: binary(
        body, type(node.op), expression(body, node.left), expression(body, node.right)
    ),
    ast.Compare: compare,
    ast.BoolOp: choose,
    ast.IfExp: conditional,
    ast.Call: call,
}
