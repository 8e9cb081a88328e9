"""Varied keys, their values and systems as people read them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Self

from rpscli.case.schema.keys import unit as key_unit
from rpscli.case.study.schema import Axis
from rpscli.records.measures import MEASURES
from rpscli.units import Written, as_written, in_si

SYSTEM = "system"
"""The column with the names of systems."""

NONE = "none"
"""For the value of a varied key that is taken out."""

SYMBOLS = {
    "superstructure.storeys": "n",
    "superstructure.period": "T₁",
    "superstructure.damping.ratio": "ξ",
    "superstructure.yield.ratio": "F₁/V_st",
    "superstructure.yield.hardening": "h",
    "podium.bearing.semi_diagonal": "R",
    "podium.bearing.slenderness": "tan α",
    "podium.bearing.wedge_slenderness": "tan α′",
    "podium.bearing.curvature_ratio": "ρ",
    "podium.cap_beam_mass_ratio": "γ",
    "podium.superstructure_mass_ratio": "η",
}
"""The paper's letters; other keys go by their last word. Plain text: matplotlib takes ten
times as long over formulae, and there is a title on every panel."""

CURVATURES = {"critical": "critical ρ", 0: "flat ends"}

Values = Sequence[object]


class NamedKey(str):
    """A key of an axis whose rows have names."""

    __slots__ = ("axis",)
    axis: Axis

    def __new__(cls, key: str, axis: Axis) -> Self:
        """The key and its axis."""
        made = super().__new__(cls, key)
        made.axis = axis
        return made

    def name_of(self, values: Mapping[str, object]) -> str | None:
        """The name of the rows that have these values; None if they have several."""
        keys = self.axis.keys
        wanted = {
            keys.index(key): _same(key, values[key]) for key in values if key in keys
        }
        names = {
            name
            for name, row in zip(self.axis.labels, self.axis.rows, strict=True)
            if all(_same(keys[at], row[at]) == value for at, value in wanted.items())
        }
        return names.pop() if len(names) == 1 else None


def _same(key: str, value: object) -> str:
    """A text that is the same for the same values, lists and mappings too."""
    return repr(cell_of(key, value))


def with_names(axes: Iterable[Axis], key: str) -> str:
    """The key, with the names of its axis if that has any."""
    found = (NamedKey(key, axis) for axis in axes if axis.labels and key in axis.keys)
    return next(found, key)


def names_of_rows(axis: Axis) -> tuple[str, ...]:
    """A name for each row of an axis, its own or what its values are called; values that
    would be called alike are written out.
    """
    if axis.labels:
        return axis.labels
    naming = axis.naming
    rows = [row[: len(naming)] for row in axis.rows]
    names = [labels(naming, row) for row in rows]
    counts = Counter(names)
    return tuple(
        name if counts[name] == 1 else _in_full(naming, row)
        for name, row in zip(names, rows, strict=True)
    )


def tick_of(key: str, value: object) -> str:
    """A value at the axis of its key: its name, or the value alone."""
    name = key.name_of({key: value}) if isinstance(key, NamedKey) else None
    return name or plain(value)


def _in_full(keys: Sequence[str], values: Values) -> str:
    pairs = zip(keys, values, strict=True)
    return ", ".join(f"{symbol(key)} = {json.dumps(value)}" for key, value in pairs)


def symbol(key: str) -> str:
    """A key's letter or its last word."""
    return SYMBOLS.get(key, key.rpartition(".")[2])


def label(key: str, value: object) -> str:
    """A key with its value and unit."""
    if key.endswith("curvature_ratio") and not isinstance(value, list | dict | bool):
        known = CURVATURES.get(value) if isinstance(value, str | int | float) else None
        if known:
            return known
    if key == "podium.devices":
        return plain(value) if value else "no devices"
    if key == "title":
        return plain(value)
    if key == "floor":
        return f"floor {plain(value)}"
    return f"{symbol(key)} = {with_unit(key, value)}"


def label_parts(keys: Iterable[str], values: Values) -> list[str]:
    """Several keys with their values, those of one axis by its own name for them."""
    pairs = list(zip(keys, values, strict=True))
    parts = []
    told = []
    for key, value in pairs:
        axis = key.axis if isinstance(key, NamedKey) else None
        name = key.name_of(dict(pairs)) if isinstance(key, NamedKey) else None
        if name is None or axis not in told:
            parts.append(name or label(key, value))
        told += [axis] * (name is not None)
    return parts


def labels(keys: Iterable[str], values: Values) -> str:
    """The same as one text; empty without any."""
    return ", ".join(label_parts(keys, values))


def plain(value: object) -> str:
    """A value as text: numbers short, devices and contacts by their
    kinds, lists as written.
    """
    if isinstance(value, float):
        return as_written(value, "-")
    if value is None:
        return NONE
    if isinstance(value, list) and all(
        isinstance(item, dict) and "kind" in item for item in value
    ):
        return ", ".join(_device(item) for item in value) or NONE
    if isinstance(value, dict) and "kind" in value:
        return _device(value)
    return value if isinstance(value, str) else json.dumps(value)


def _device(device: dict[str, object]) -> str:
    """The kind of a device or a contact and the first of its values, with its unit."""
    values = [
        with_unit(f"podium.devices.{key}", value)
        for key, value in device.items()
        if key != "kind"
    ]
    return " ".join([str(device["kind"]).replace("_", " "), *values[:1]])


def with_unit(key: str, value: object) -> str:
    """A value of a key as text; a bare number with the unit of the key."""
    bare = isinstance(value, int | float) and not isinstance(value, Written)
    return f"{plain(value)} {unit_of(key) if bare else '-'}".removesuffix(" -")


def cell_of(key: str, value: object) -> object:
    """A value of a key in SI units; the word for one that is taken out."""
    return NONE if value is None else in_si(value, unit_of(key))


def unit_of(name: str) -> str:
    """SI unit of a measure or of a varied key; ``-`` for plain numbers and words."""
    alone = name.partition("(")[0]
    # Keys have dots, all but those that a study varies besides them.
    if alone in MEASURES or ("." not in name and alone in MEASURES.names()):
        return MEASURES[alone].unit
    return key_unit(name)
