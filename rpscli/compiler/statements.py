"""Statements: variables, places that are stored to, branches, loops, returns."""

from __future__ import annotations

import ast
import math
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rpscli.compiler.expressions import (
    Body,
    Scope,
    Slot,
    Writer,
    binary,
    element,
    expression,
    field,
    is_true,
    load,
    placed,
    read_name,
)
from rpscli.compiler.values import (
    INT,
    Kind,
    Known,
    NotInLanguage,
    Number,
    Places,
    Record,
    Value,
    Widened,
    described,
    elements_of,
    is_number,
    joined,
    kind_of,
    named,
    parts,
    refuse,
    types_of,
)


class Statements(Body):
    """A function while its statements are written."""

    def __init__(
        self,
        program: Writer,
        scope: Scope,
        node: ast.FunctionDef,
        widened: dict[str, Kind],
    ) -> None:
        super().__init__(program, scope)
        self.name = node.name
        self.widened = widened
        self.assigned = assignments(node)
        self.returns: list[tuple[int, Value]] = []
        """Lines at which the function is left, and with what:
        written when its kind is known."""
        self.loops: list[tuple[str, str]] = []
        """Blocks where `continue` and `break` go, of all loops around."""
        self.regions = [0]
        """Blocks of statements around, by running numbers; the function's own is 0."""
        self.shadowed: dict[int, set[str]] = {}
        """Names that in a region stand for something else than before it."""
        self._begun = 0

    @contextmanager
    def region(self) -> Iterator[None]:
        """Around the statements of a branch or a loop."""
        self._begun += 1
        self.regions.append(self._begun)
        yield
        for name in self.shadowed.pop(self.regions.pop(), ()):
            del self.scope.names[name]


def assignments(node: ast.FunctionDef | ast.For) -> Counter[str]:
    """Counts of assignments to each name of a function; two, if at once read."""
    found: Counter[str] = Counter()
    for each in ast.walk(node):
        if each is node and isinstance(node, ast.For):
            continue
        if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
            found[each.id] += 1
        if isinstance(each, ast.AugAssign) and isinstance(each.target, ast.Name):
            found[each.target.id] += 1
        if isinstance(each, ast.For) and not isinstance(each.iter, ast.Call):
            found.update(assignments(each))  # once for each element of a tuple
    return found


def statements(body: Statements, nodes: list[ast.stmt]) -> None:
    """Write statements up to the first that leaves their block."""
    for node in nodes:
        if body.ended:
            return
        write = STATEMENTS.get(type(node))
        try:
            if write is None:
                words = (
                    "`raise`"
                    if isinstance(node, ast.Try)
                    else "if, for, while and return"
                )
                refuse(f"`{ast.unparse(node).splitlines()[0]}`: write it with {words}")
            write(body, node)
        except NotInLanguage as error:
            raise placed(error, body, node) from None


def block(body: Statements, nodes: list[ast.stmt]) -> None:
    """Write the statements of a branch or a loop."""
    with body.region():
        statements(body, nodes)


# Variables and places.


def assign(body: Statements, target: ast.expr, value: Value) -> None:
    """Give a variable, several, or a place a value."""
    if isinstance(target, ast.Name):
        assign_name(body, target.id, value)
    elif isinstance(target, ast.Tuple):
        elements = elements_of(value)
        if elements is None or len(elements) != len(target.elts):
            refuse(
                f"{len(target.elts)} names for {described(value)}: give each its value"
            )
        for each, of in zip(target.elts, elements, strict=True):
            assign(body, each, of)
    else:
        store(body, place_of(body, target), value)


def assign_name(body: Statements, name: str, value: Value) -> None:
    """Give a variable a value: kept as it is, or on the stack where it may change."""
    once = body.assigned[name] == 1 and name not in body.widened
    if once and (len(body.regions) == 1 or isinstance(value, Known)):
        body.scope.names[name] = value
        return
    kind = kind_of(value)
    if isinstance(kind, tuple) and kind[0] == "known":
        refuse(
            f"`{name}` is set to {described(value)}, not to a number: name it once, first"
        )
    if name in body.widened:
        kind = joined(body.widened[name], kind) or kind
    slot = body.scope.names.get(name)
    if isinstance(slot, Slot):
        both = joined(slot.kind, kind)
        if both is None:
            shadow(body, name, slot)
            slot = None
        elif both != slot.kind:
            raise Widened(name, both)
    if not isinstance(slot, Slot):
        slot = Slot(kind, [body.room(part) for part in types_of(kind)], body.regions[-1])
        body.scope.names[name] = slot
    given = parts(body.as_kind(value, slot.kind))
    for (part, found), room in zip(given, slot.rooms, strict=True):
        body.put(f"store {part} {found}, ptr {room}")


def shadow(body: Statements, name: str, slot: Slot) -> None:
    """Let a name stand for something else from here to the end of
    its block of statements.
    """
    here = body.regions[-1]
    if slot.region == here:
        return
    if slot.region in body.regions:
        refuse(f"`{name}` is something else outside of this block: use two names")
    body.shadowed.setdefault(here, set()).add(name)


def place_of(body: Statements, target: ast.expr) -> Places:
    """The place of a number that a field or an element names."""
    if isinstance(target, ast.Attribute):
        record = expression(body, target.value)
        if isinstance(record, Record):
            return field(body, record, target.attr)
    if isinstance(target, ast.Subscript) and not isinstance(target.slice, ast.Slice):
        array = expression(body, target.value)
        of = target.slice
        nodes = of.elts if isinstance(of, ast.Tuple) else [of]
        found = element(body, array, [expression(body, each) for each in nodes])
        if isinstance(found, Places) and found.shape == ():
            return found
    refuse(
        f"`{ast.unparse(target)}` is set: numbers in records and arrays can be, and names"
    )


def store(body: Statements, place: Places, value: Value) -> None:
    """Store a number."""
    if place.shape:
        refuse("a whole array is set: set its numbers in a loop")
    body.put(f"store {place.kind} {body.number(value, place.kind)}, ptr {place.name}")


def assign_all(body: Statements, node: ast.Assign) -> None:
    """`x = y = value`."""
    value = expression(body, node.value)
    for target in node.targets:
        assign(body, target, value)


def assign_annotated(body: Statements, node: ast.AnnAssign) -> None:
    """`x: float = value`; the annotation is for readers."""
    if node.value is not None:
        assign(body, node.target, expression(body, node.value))


def assign_changed(body: Statements, node: ast.AugAssign) -> None:
    """`x += value`: what x was is read first."""
    if isinstance(node.target, ast.Name):
        before = read_name(body, node.target)
        after = binary(body, type(node.op), before, expression(body, node.value))
        assign_name(body, node.target.id, after)
        return
    place = place_of(body, node.target)
    was = load(body, place)
    store(body, place, binary(body, type(node.op), was, expression(body, node.value)))


# What is done, how often, and what is returned.


def branch(body: Statements, node: ast.If) -> None:
    """`if`; a test that is known leaves one branch, and the other is not looked at."""
    test = expression(body, node.test)
    if isinstance(test, Known):
        statements(body, node.body if is_true(test) else node.orelse)
        return
    yes = body.new("then")
    no = body.new("else")
    end = body.new("endif")
    body.branch(body.number(test, "i1"), yes, no if node.orelse else end)
    body.label(yes)
    block(body, node.body)
    left = body.ended
    body.jump(end)
    if node.orelse:
        body.label(no)
        block(body, node.orelse)
        left = left and body.ended
        body.jump(end)
    body.label(end)
    if left and node.orelse:
        body.put("unreachable")
        body.ended = True


def loop(body: Statements, node: ast.For) -> None:
    """`for` over a range, or over a tuple: then written once for each of its elements."""
    if node.orelse:
        refuse("`else` of a loop: write a variable that tells")
    call = node.iter
    if isinstance(call, ast.Call) and expression(body, call.func) == Known(range):
        loop_over_range(body, node, [expression(body, each) for each in call.args])
        return
    elements = elements_of(expression(body, node.iter))
    if elements is None:
        refuse("a loop is over a range or a tuple")
    end = body.new("tuple.end")
    with body.region():
        for each in elements:
            following = body.new("tuple.next")
            body.loops.append((following, end))
            name_in_pass(body, node.target, each)
            statements(body, node.body)
            body.jump(following)
            body.loops.pop()
            body.label(following)
    body.jump(end)
    body.label(end)


def name_in_pass(body: Statements, target: ast.expr, value: Value) -> None:
    """Name an element of a tuple; one that is no number has its
    name within the loop alone.
    """
    whole = (
        value.value if isinstance(value, Known) and not is_number(value.value) else None
    )
    of_function = whole is not None and (
        not isinstance(whole, tuple) or named(whole) is not None
    )
    if isinstance(target, ast.Name) and of_function:
        body.scope.names[target.id] = value
        body.shadowed.setdefault(body.regions[-1], set()).add(target.id)
    else:
        assign(body, target, value)


def loop_over_range(body: Statements, node: ast.For, limits: list[Value]) -> None:
    """`for i in range(first, end, step)`, the step known."""
    step = limits[2] if len(limits) == 3 else Known(1)
    if not isinstance(step, Known) or type(step.value) is not int or step.value == 0:
        refuse("the step of a range must be a known number")
    if not 0 < len(limits) < 4 or getattr(node.iter, "keywords", None):
        refuse("a range has one to three limits, without names")
    first, limit = (Known(0), limits[0]) if len(limits) == 1 else limits[:2]
    begin = body.index(first)
    end = body.index(limit)
    name = body.new(f"{body.name}.{node.lineno}.loop")
    before = body.block
    inside = f"{name}.in"
    following = f"{name}.next"
    out = f"{name}.out"
    body.jump(name)
    body.label(name)
    i = f"%{name}.i"
    more = f"%{name}.i.next"
    body.put(f"{i} = phi i64 [{begin}, %{before}], [{more}, %{following}]")
    test = "slt" if step.value > 0 else "sgt"
    body.branch(body.get(f"icmp {test} i64 {i}, {end}"), inside, out)
    body.label(inside)
    body.loops.append((following, out))
    with body.region():
        assign(body, node.target, Number(INT, i))
        statements(body, node.body)
    body.loops.pop()
    body.jump(following)
    body.label(following)
    body.put(f"{more} = add nsw i64 {i}, {step.value}")
    body.put(
        f"br label %{name}, !llvm.loop {body.program.loop(f'{body.name}:{node.lineno}')}"
    )
    body.label(out)


def repeat(body: Statements, node: ast.While) -> None:
    """`while`."""
    if node.orelse:
        refuse("`else` of a loop: write a variable that tells")
    if expression_is_false(body, node.test):
        return
    name = body.new(f"{body.name}.{node.lineno}.while")
    inside = f"{name}.in"
    out = f"{name}.out"
    body.jump(name)
    body.label(name)
    written = len(body.lines)
    test = expression(body, node.test)
    if isinstance(test, Known) and is_true(test):
        body.jump(inside)
    else:
        body.branch(body.number(test, "i1"), inside, out)
    body.label(inside)
    body.loops.append((name, out))
    block(body, node.body)
    body.loops.pop()
    body.jump(name)
    body.label(out)
    if not any(f"%{out}" in line for line in body.lines[written:]):
        body.put("unreachable")
        body.ended = True


def expression_is_false(body: Statements, node: ast.expr) -> bool:
    """True if a test without variables is known to fail: then its
    statements are not looked at.
    """
    if any(
        isinstance(each, (ast.Call, ast.Subscript, ast.BoolOp)) for each in ast.walk(node)
    ):
        return False
    written = len(body.lines)
    test = expression(body, node)
    del body.lines[written:]
    return isinstance(test, Known) and not is_true(test)


def leave(body: Statements, node: ast.Return) -> None:
    """`return`."""
    value = Known(None) if node.value is None else expression(body, node.value)
    give_back(body, value)


def give_back(body: Statements, value: Value) -> None:
    """Leave the function with a value."""
    body.returns.append((len(body.lines), value))
    body.lines.append("")
    body.ended = True


def fail(body: Statements, node: ast.Raise) -> None:
    """`raise`: the function gives no number, and Python is asked what it says."""
    give_back(body, Known(math.nan))


def ignore_text(body: Statements, node: ast.Expr) -> None:
    """A call for what it does; or a text, which does nothing."""
    if not isinstance(node.value, ast.Constant):
        expression(body, node.value)


STATEMENTS: dict[type, Callable[[Statements, Any], None]] = {
    ast.Assign: assign_all,
    ast.AnnAssign: assign_annotated,
    ast.AugAssign: assign_changed,
    ast.If: branch,
    ast.For: loop,
    ast.While: repeat,
    ast.Continue: lambda body, _: body.jump(body.loops[-1][0]),
    ast.Break: lambda body, _: body.jump(body.loops[-1][1]),
    ast.Return: leave,
    ast.Raise: fail,
    ast.Expr: ignore_text,
    ast.Pass: lambda *_: None,
}
