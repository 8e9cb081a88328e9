"""Values: what a name may stand for while a function is written,
and how it stands in LLVM.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NoReturn, TypeAlias

import numpy as np

DOUBLE = "double"
INT = "i64"
BOOL = "i1"
POINTER = "ptr"


class NotInLanguage(Exception):
    """A function cannot be compiled; the text names the file, the
    line, and what to write.
    """


class Widened(Exception):
    """A variable turned out to be of a wider kind: its function is
    to be written once more.
    """

    def __init__(self, name: str, kind: Kind) -> None:
        super().__init__(name)
        self.name = name
        self.kind = kind


@dataclass(slots=True, frozen=True)
class Known:
    """A value known while compiling: number, tuple, array, function or module."""

    value: Any


@dataclass(slots=True, frozen=True)
class Number:
    """A number: a `double`, an `i64` or an `i1`, by its name in LLVM."""

    kind: str
    name: str


@dataclass(slots=True, frozen=True)
class Tuple:
    """A tuple, or a NamedTuple of a class; never in memory."""

    elements: tuple[Value, ...]
    of: Any = None


@dataclass(slots=True, frozen=True)
class Record:
    """A record of numpy, by its address."""

    dtype: Any
    name: str


@dataclass(slots=True, frozen=True)
class Rows:
    """Records one after the other: the address of the first, and how many there are."""

    dtype: Any
    name: str
    count: str


@dataclass(slots=True, frozen=True)
class Places:
    """Numbers in memory, of a shape that is known while compiling."""

    kind: str
    shape: tuple[int, ...]
    name: str


@dataclass(slots=True, frozen=True)
class Matrix:
    """Doubles in memory, of sizes that are known when the code runs."""

    name: str
    sizes: tuple[str, ...]


class Itself:
    """Something known in a kind: equal to itself alone, whatever it is."""

    def __init__(self, value: Known) -> None:
        self.value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Itself) and self.value.value is other.value.value

    def __hash__(self) -> int:
        return id(self.value.value)


Value: TypeAlias = Known | Number | Tuple | Record | Rows | Places | Matrix
Kind: TypeAlias = Any
"""A number's LLVM type, or a tuple that begins with what it is; it
can be compared and hashed."""


NUMBERS = bool, int, float, np.bool_, np.int64, np.float64


def is_number(value: object) -> bool:
    """True if something known is a number of the language: no
    narrower one, nothing derived.
    """
    return type(value) in NUMBERS


def number_kind(value: object) -> str:
    """The LLVM type of a known number."""
    if isinstance(value, (bool, np.bool_)):
        return BOOL
    return INT if isinstance(value, (int, np.integer)) else DOUBLE


def literal(value: Any, kind: str) -> str:
    """A known number in LLVM's text; doubles by their bits."""
    try:
        if kind == DOUBLE:
            return f"0x{struct.unpack('<Q', struct.pack('<d', float(value)))[0]:016X}"
        whole = int(value)
    except (OverflowError, ValueError) as error:
        refuse(f"{value}: {error}")
    if kind == BOOL:
        return "true" if value else "false"
    if not -(2**63) <= whole < 2**63:
        refuse(f"{whole} is no int of 64 bits: write a float")
    return str(whole)


def elements_of(value: Value) -> tuple[Value, ...] | None:
    """The elements of a tuple, else None."""
    if isinstance(value, Tuple):
        return value.elements
    if isinstance(value, Known) and isinstance(value.value, tuple):
        return tuple(map(Known, value.value))
    return None


def kind_of(value: Value) -> Kind:
    """Kind of a value: all that code for others like it depends on."""
    if isinstance(value, Number):
        return value.kind
    if isinstance(value, Known) and is_number(value.value):
        return number_kind(value.value)
    if (elements := elements_of(value)) is not None:
        of = value.of if isinstance(value, Tuple) else named(value.value)  # type: ignore[union-attr]
        return "tuple", tuple(map(kind_of, elements)), of
    if isinstance(value, Known):
        return "known", Itself(value)
    if isinstance(value, (Record, Rows)):
        return type(value).__name__, value.dtype
    if isinstance(value, Places):
        return "Places", value.kind, value.shape
    assert isinstance(value, Matrix)
    return "Matrix", len(value.sizes)


def named(value: object) -> Any:
    """The class of a NamedTuple, else None."""
    return type(value) if hasattr(value, "_fields") else None


def parts(value: Value) -> Iterator[tuple[str, str]]:
    """LLVM types and names of the numbers and addresses that a value consists of."""
    if (elements := elements_of(value)) is not None:
        for element in elements:
            yield from parts(element)
    elif isinstance(value, Number):
        yield value.kind, value.name
    elif isinstance(value, Known):
        if is_number(value.value):
            kind = number_kind(value.value)
            yield kind, literal(value.value, kind)
    else:
        assert not isinstance(value, Tuple)
        yield POINTER, value.name
        if isinstance(value, Rows):
            yield INT, value.count
        elif isinstance(value, Matrix):
            yield from ((INT, size) for size in value.sizes)


def types_of(kind: Kind) -> list[str]:
    """LLVM types of the parts of a value of a kind."""
    if isinstance(kind, str):
        return [kind]
    of = kind[0]
    if of == "tuple":
        return [part for element in kind[1] for part in types_of(element)]
    if of == "known":
        return []
    sizes = {"Record": 0, "Places": 0, "Rows": 1}.get(of)
    return [POINTER] + [INT] * (kind[1] if sizes is None else sizes)


def rebuilt(kind: Kind, names: Iterator[str]) -> Value:
    """A value of a kind, of parts with these names."""
    if isinstance(kind, str):
        return Number(kind, next(names))
    of = kind[0]
    if of == "tuple":
        return Tuple(tuple(rebuilt(element, names) for element in kind[1]), kind[2])
    if of == "known":
        return kind[1].value  # type: ignore[no-any-return]
    if of == "Record":
        return Record(kind[1], next(names))
    if of == "Rows":
        return Rows(kind[1], next(names), next(names))
    if of == "Places":
        return Places(kind[1], kind[2], next(names))
    return Matrix(next(names), tuple(next(names) for _ in range(kind[1])))


def joined(one: Kind, other: Kind) -> Kind:
    """The kind that holds both: of numbers the wider one; None if there is none."""
    if one == other:
        return one
    if isinstance(one, str) and isinstance(other, str):
        return DOUBLE if DOUBLE in {one, other} else INT
    if isinstance(one, str) or isinstance(other, str) or one is None or other is None:
        return None
    if one[0] == other[0] == "tuple" and len(one[1]) == len(other[1]):
        elements = tuple(map(joined, one[1], other[1]))
        same = one[2] is other[2] or None in {
            one[2],
            other[2],
        }  # fields of two classes differ
        return (
            ("tuple", elements, one[2] or other[2])
            if same and None not in elements
            else None
        )
    return None


def refuse(what: str) -> NoReturn:
    """Say what is not in the language, and what to write; place
    and line are added outside.
    """
    raise NotInLanguage(what)


class Code:
    """The text of a function while it is written: instructions, labels, variables."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.allocas: list[str] = []
        self.block = "entry"
        self.ended = False
        """True if the present block is left: what follows is never reached."""
        self._count = 0

    def new(self, name: str) -> str:
        """A name that no other place of the function has."""
        self._count += 1
        return f"{name}.{self._count}"

    def put(self, instruction: str) -> None:
        """Write an instruction without a result."""
        self.lines.append(f"  {instruction}")

    def get(self, instruction: str) -> str:
        """Write an instruction; the name of its result."""
        self._count += 1
        name = f"%t{self._count}"
        self.lines.append(f"  {name} = {instruction}")
        return name

    def room(self, kind: str) -> str:
        """A place on the stack, made once where the function begins, of zeros."""
        name = "%" + self.new("v")
        self.allocas.append(f"  {name} = alloca {kind}")
        self.allocas.append(f"  store {kind} zeroinitializer, ptr {name}")
        return name

    def label(self, name: str) -> None:
        """Begin a block."""
        self.lines.append(f"{name}:")
        self.block = name
        self.ended = False

    def jump(self, name: str) -> None:
        """Go on at a block, unless the present one is left already."""
        if not self.ended:
            self.put(f"br label %{name}")
            self.ended = True

    def branch(self, test: str, yes: str, no: str) -> None:
        """Go on at one of two blocks."""
        self.put(f"br i1 {test}, label %{yes}, label %{no}")
        self.ended = True

    def number(self, value: Value, kind: str) -> str:
        """The name of a number, as a double, an i64 or an i1 (whether it is not zero)."""
        if isinstance(value, Known) and is_number(value.value):
            return literal(value.value, kind)
        if not isinstance(value, Number):
            refuse(f"{described(value)} is no number: write a number here")
        if value.kind == kind:
            return value.name
        if kind == DOUBLE:
            signed = "uitofp" if value.kind == BOOL else "sitofp"
            return self.get(f"{signed} {value.kind} {value.name} to double")
        if kind == INT:
            change = "zext" if value.kind == BOOL else "fptosi"
            return self.get(f"{change} {value.kind} {value.name} to i64")
        if value.kind == DOUBLE:
            return self.get(f"fcmp une double {value.name}, 0.0")
        return self.get(f"icmp ne i64 {value.name}, 0")

    def index(self, value: Value) -> str:
        """The name of an int: no float is one."""
        if kind_of(value) not in {INT, BOOL}:
            refuse(f"{described(value)} is no int: write int(...)")
        return self.number(value, INT)

    def as_kind(self, value: Value, kind: Kind) -> Value:
        """A value as one of a wider kind."""
        if isinstance(kind, str):
            return (
                value
                if kind_of(value) == kind
                else Number(kind, self.number(value, kind))
            )
        elements = elements_of(value)
        if kind[0] == "tuple" and elements is not None:
            return Tuple(tuple(map(self.as_kind, elements, kind[1])), kind[2])
        return value


def described(value: Value) -> str:
    """Words for a value in a message."""
    if isinstance(value, Known):
        return f"`{getattr(value.value, '__name__', value.value)!s}`"
    words = {
        Number: "a number",
        Tuple: "a tuple",
        Record: "a record",
        Rows: "rows of records",
    }
    return words.get(type(value), "an array")
