"""Records in machine code as addresses with a type; in Python they are numpy's.

numba takes a field of a record for an array like any other, with shape, strides, owner and negative
indices, built anew wherever a number of it is read. As a place behind a known address it is two
instructions. `fields_of` and `records_of` make the change where a kernel begins; indices are never
negative.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_global
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_builtin,
    lower_getattr_generic,
    lower_setattr_generic,
    models,
    overload,
    register_model,
)


class Fields(types.Type):
    """A record by its address."""

    def __init__(self, record: types.Record) -> None:
        self.record = record
        super().__init__(name=f"Fields({record.name})")

    @property
    def mangling_args(self) -> tuple[str, tuple[Any, ...]]:
        """What stands for it in the names of machine code."""
        name, arguments = self.record.mangling_args
        return f"{type(self).__name__}{name}", arguments

    def of(self, name: str) -> types.Type:
        """The type of a field: a number, or places in a row."""
        kind = self.record.fields[name].type
        return Places(kind.dtype, kind.shape) if isinstance(kind, types.NestedArray) else kind


class Rows(Fields):
    """Records one after the other: the address of the first, and how many there are."""


class Places(types.Type):
    """Numbers one after the other, by the address of the first; of a known shape."""

    def __init__(self, dtype: types.Type, shape: tuple[int, ...]) -> None:
        self.dtype, self.shape = dtype, shape
        super().__init__(name=f"Places({dtype}, {shape})")


@register_model(Fields)
@register_model(Places)
class _Address(models.OpaqueModel):
    """An address."""


@register_model(Rows)
class _AddressAndCount(models.StructModel):
    def __init__(self, manager: Any, kind: Rows) -> None:
        super().__init__(manager, kind, [("first", types.voidptr), ("count", types.intp)])


# Fields of a record, by name.


@infer_getattr
class _FieldTypes(AttributeTemplate):
    key = Fields

    def generic_resolve(self, kind: Fields, name: str) -> Any:  # type: ignore[override]
        return kind.of(name) if name in kind.record.fields else None


@lower_getattr_generic(Fields)
def _read_field(context: Any, builder: Any, kind: Fields, address: Any, name: str) -> Any:
    there, found = cgutils.pointer_add(builder, address, kind.record.offset(name)), kind.of(name)
    if isinstance(found, Places):
        return there
    return builder.load(builder.bitcast(there, context.get_value_type(found).as_pointer()))


@lower_setattr_generic(Fields)
def _write_field(context: Any, builder: Any, signature: Any, given: Any, name: str) -> None:
    (kind, value_type), (address, value) = signature.args, given
    there = cgutils.pointer_add(builder, address, kind.record.offset(name))
    value = context.cast(builder, value, value_type, kind.of(name))
    builder.store(value, builder.bitcast(there, value.type.as_pointer()))


# Shapes: of a field known to the compiler.


@infer_getattr
class _ShapeOfPlaces(AttributeTemplate):
    key = Places

    def resolve_shape(self, kind: Places) -> types.Type:
        return types.UniTuple(types.intp, len(kind.shape))


@infer_getattr
class _ShapeOfRows(AttributeTemplate):
    key = Rows

    def resolve_shape(self, _kind: Rows) -> types.Type:
        return types.UniTuple(types.intp, 1)


@lower_getattr_generic(Places)
@lower_getattr_generic(Rows)
def _read_shape(context: Any, builder: Any, kind: Any, value: Any, _name: str) -> Any:
    if isinstance(kind, Rows):
        sizes = [builder.extract_value(value, 1)]
    else:
        sizes = [context.get_constant(types.intp, size) for size in kind.shape]
    return context.make_tuple(builder, types.UniTuple(types.intp, len(sizes)), sizes)


# Entries, by index.


def _kinds(index: types.Type) -> tuple[types.Type, ...]:
    """Types of the integers that an index is made of; none of others."""
    kinds: tuple[types.Type, ...] = getattr(index, "types", (index,))
    return kinds if all(isinstance(kind, types.Integer) for kind in kinds) else ()


@infer_global(operator.getitem)
class _EntryTypes(AbstractTemplate):
    def generic(self, given: Any, _names: Any) -> Any:
        kind, index = given
        if isinstance(kind, Rows) and isinstance(index, types.Integer):
            return Fields(kind.record)(kind, types.intp)
        if isinstance(kind, Rows) and isinstance(index, types.SliceType):
            return kind(kind, index)
        if isinstance(kind, Places) and (kinds := _kinds(index)):
            left = kind.shape[len(kinds) :]
            return (Places(kind.dtype, left) if left else kind.dtype)(kind, index)
        return None


@infer_global(operator.setitem)
class _WrittenTypes(AbstractTemplate):
    def generic(self, given: Any, _names: Any) -> Any:
        kind, index, _ = given
        if isinstance(kind, Places) and len(_kinds(index)) == len(kind.shape):
            return types.none(kind, index, kind.dtype)
        return None


def _place(context: Any, builder: Any, signature: Any, given: Any) -> Any:
    """Pointer to an entry, or to the first of some."""
    (kind, index_type), (address, index) = signature.args[:2], given[:2]
    one = isinstance(index_type, types.Integer)
    numbers = [index] if one else cgutils.unpack_tuple(builder, index)
    pairs = zip(numbers, _kinds(index_type), strict=True)
    shape = context.get_value_type(kind.dtype)
    for size in reversed(kind.shape):
        shape = ir.ArrayType(shape, size)
    indices = [context.cast(builder, number, of, types.intp) for number, of in pairs]
    start = context.get_constant(types.intp, 0)
    pointer = builder.bitcast(address, shape.as_pointer())
    return builder.gep(pointer, [start, *indices], inbounds=True)


@lower_builtin(operator.getitem, Places, types.Any)
def _read_entry(context: Any, builder: Any, signature: Any, given: Any) -> Any:
    there, kind = _place(context, builder, signature, given), signature.return_type
    if isinstance(kind, Places):
        return builder.bitcast(there, context.get_value_type(kind))
    return builder.load(there)


@lower_builtin(operator.setitem, Places, types.Any, types.Any)
def _write_entry(context: Any, builder: Any, signature: Any, given: Any) -> Any:
    builder.store(given[2], _place(context, builder, signature, given))
    return context.get_dummy_value()


def _row(builder: Any, kind: Rows, rows: Any, index: Any) -> Any:
    """Address of a record."""
    size = ir.Constant(index.type, kind.record.size)
    return cgutils.pointer_add(builder, builder.extract_value(rows, 0), builder.mul(index, size))


@lower_builtin(operator.getitem, Rows, types.Integer)
def _read_row(_context: Any, builder: Any, signature: Any, given: Any) -> Any:
    return _row(builder, signature.args[0], *given)


@lower_builtin(operator.getitem, Rows, types.SliceType)
def _read_rows(context: Any, builder: Any, signature: Any, given: Any) -> Any:
    kind, cut = signature.args
    part = context.make_helper(builder, cut, given[1])
    count = builder.sub(part.stop, part.start)
    first = builder.insert_value(given[0], _row(builder, kind, given[0], part.start), 0)
    return builder.insert_value(first, count, 1)


# Where a kernel begins.


def fields_of(record: Any) -> Any:
    """A record by its address."""
    return record


def records_of(records: Any) -> Any:
    """An array (count,) of records by its address."""
    return records


@intrinsic
def _fields_of(_typing: Any, record: Any) -> Any:
    kind = Fields(record)

    def code(context: Any, builder: Any, _signature: Any, given: Any) -> Any:
        return builder.bitcast(given[0], context.get_value_type(kind))

    return kind(record), code


@intrinsic
def _rows_of(_typing: Any, records: Any) -> Any:
    kind = Rows(records.dtype)

    def code(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, given[0])
        rows = cgutils.create_struct_proxy(kind)(context, builder)
        rows.first, rows.count = builder.bitcast(array.data, rows.first.type), array.nitems
        return rows._getvalue()  # noqa: SLF001 -- as numba's manual has it

    return kind(records), code


_record: Any = _fields_of
_records: Any = _rows_of
overload(fields_of)(lambda record: lambda record: _record(record))  # noqa: ARG005, PLW0108
overload(records_of)(lambda records: lambda records: _records(records))  # noqa: ARG005, PLW0108
