"""Varied keys and their values, as figures and tables name them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rpscli.report.table import Column, columns_of
from rpscli.sweep.table import unit_of
from rpscli.units import Written, as_written, in_si

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
"""The paper's letters; other keys go by their last word. Plain text: matplotlib takes ten times as
long over formulae, and there is a title on every panel."""

CURVATURES = {"critical": "critical ρ", 0: "flat ends"}

Values = Sequence[object]


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
    return f"{symbol(key)} = {_with_unit(key, value)}"


def labels(keys: Iterable[str], values: Values) -> str:
    """Several keys with their values; empty without any."""
    return ", ".join(label(key, value) for key, value in zip(keys, values, strict=True))


def plain(value: object) -> str:
    """A value as text: numbers short, devices and contacts by their kinds, lists as written."""
    if isinstance(value, float):
        return as_written(value, "-")
    if isinstance(value, list) and all(isinstance(item, dict) and "kind" in item for item in value):
        return ", ".join(_device(item) for item in value) or "none"
    if isinstance(value, dict) and "kind" in value:
        return _device(value)
    return value if isinstance(value, str) else json.dumps(value)


def _device(device: dict[str, object]) -> str:
    """The kind of a device or a contact and the first of its values, with its unit."""
    values = [
        _with_unit(f"podium.devices.{key}", value) for key, value in device.items() if key != "kind"
    ]
    return " ".join([str(device["kind"]).replace("_", " "), *values[:1]])


def _with_unit(key: str, value: object) -> str:
    bare = isinstance(value, int | float) and not isinstance(value, Written)
    return f"{plain(value)} {unit_of(key) if bare else '-'}".removesuffix(" -")


def key_columns(keys: Sequence[str], rows: Sequence[Values]) -> list[Column]:
    """One column a key, from its values in each row."""
    return [
        Column(key, unit_of(key), [in_si(row[place], unit_of(key)) for row in rows])
        for place, key in enumerate(keys)
    ]


def key_cells(column: Column, name: str) -> tuple[str, list[str]]:
    """Head and cells of the column of a key: values as their file has them."""
    values = list(column.values)
    if any(isinstance(value, Written) for value in values):
        return name, [_with_unit(column.name, value) for value in values]
    return f"{name} {column.unit}".removesuffix(" -"), [plain(value) for value in values]


def keyed(
    keys: Sequence[str], heads: Mapping[str, str], rows: Iterable[Sequence[Any]]
) -> list[Column]:
    """Columns of some keys, and others by name and unit; a row begins with values of the keys."""
    known = list(rows)
    further = columns_of(heads, (row[1:] for row in known))
    return [*key_columns(keys, [row[0] for row in known]), *further]


def axis_label(key: str) -> str:
    """A key's letter or last word with its unit, if it has one."""
    unit = unit_of(key)
    return symbol(key) if unit == "-" else f"{symbol(key)} [{unit}]"
