"""Records of the kernel: every field is named, has a unit and room, and is nowhere hidden."""

from __future__ import annotations

import numpy as np
import pytest

from rpscli.constants import MOST_STOREYS
from rpscli.physics import state
from rpscli.physics.state import (
    EVENT,
    EVENT_KINDS,
    LANES,
    PAGE,
    REQUEST,
    RESULT,
    SAMPLE,
    STATE,
    SYSTEM,
    WHOLE,
    Field,
    describe,
    record_type,
    records,
)

TABLES = {
    "system": SYSTEM,
    "request": REQUEST,
    "state": STATE,
    "result": RESULT,
    "sample": SAMPLE,
    "event": EVENT,
}
every_table = pytest.mark.parametrize("fields", TABLES.values(), ids=TABLES)

UNITS = {"-", "mixed", "1", "m", "rad", "s", "kg", "N", "J", "W", "sqrt", WHOLE}
"""What units are made of, with squares and rates of it."""


@every_table
def test_every_field_has_a_unit(fields: tuple[Field, ...]) -> None:
    for field in fields:
        parts = field.unit.replace("(", " ").replace(")", " ").replace("/", " ").split()
        assert parts not in ([], ["1"])
        assert {part.rstrip("23") or part for part in parts} <= UNITS, field


@every_table
def test_every_name_stands_for_one_field(fields: tuple[Field, ...]) -> None:
    names = [field.name for field in fields]
    assert len(set(names)) == len(names)
    # numpy's own attributes of a record would hide it
    assert not [name for name in names if hasattr(np.record, name) or hasattr(np.recarray, name)]


@every_table
def test_a_record_has_room(fields: tuple[Field, ...]) -> None:
    kind = record_type(fields, 2, LANES)
    assert set(kind.names or ()) == {field.name for field in fields}
    sizes = {"ways": 2, "demands": 6, "stages": 9}
    for field in fields:
        inner = kind[field.name]
        assert inner.base == (np.int64 if field.unit == WHOLE else np.float64)
        named = field.sizes.split()
        assert len(inner.shape) == len(named)
        for name, size in zip(named, inner.shape, strict=True):
            least = {"modes": MOST_STOREYS, "rows": 2 * MOST_STOREYS, "lanes": LANES}.get(name)
            assert size >= least if least is not None else size == sizes.get(name, size)


@every_table
@pytest.mark.parametrize("count", [1, 3])
def test_records_are_zero_and_begin_with_a_page(fields: tuple[Field, ...], count: int) -> None:
    made = records(fields, count=count)
    assert made.shape == (count,)
    assert made.ctypes.data % PAGE == 0
    assert not any(made.tobytes())


@every_table
def test_what_is_written_to_one_field_stands_in_that_field_only(
    fields: tuple[Field, ...],
) -> None:
    """Attributes of a record are views, for numbers and for arrays."""
    for field in fields:
        made = records(fields)
        record = made[0]
        if field.sizes:
            getattr(record, field.name)[...] = 7
        else:
            setattr(record, field.name, 7)
        for other in fields:
            assert np.all(made[0][other.name] == (7 if other is field else 0)), (field, other)


@every_table
def test_a_description_lists_every_field_with_its_unit(fields: tuple[Field, ...]) -> None:
    lines = describe(fields).splitlines()
    assert len(lines) == len(fields)
    for line, field in zip(lines, fields, strict=True):
        assert line.split()[0] == field.name
        assert f"[{field.unit}]" in line
        assert field.meaning in line


def test_kinds_and_outcomes_are_distinct() -> None:
    kinds = "UPLIFT IMPACT RECONTACT ROLLING_TO_ROCKING ROCKING_TO_ROLLING CRITICAL_PASSAGE"
    changes = "STICKING SLIDING STOP_MET STOP_LEFT TENDON_YIELDING TENDON_SLACK TENDON_TAUT PASS"
    outcomes = "RUNNING AT_REST SURVIVED OVERTURNED_ROLLING OVERTURNED_ROCKING"
    failures = "FAILED_NOT_FINITE FAILED_TOO_MANY_EVENTS FAILED_STEP_TOO_SMALL"
    groups = [
        names.split()
        for names in (
            "FULL_CONTACT ROLLING ROCKING STUCK BEDDED",
            "VISCOUS FRICTION STOP TENDON ROLLING_RESISTANCE",
            "IDLE WORKING BEYOND",
            f"{kinds} {changes} OVERTURNING",
            f"{outcomes} {failures}",
            "NOTHING LOW HIGH NEAREST LET_GO CHANGE",
        )
    ]
    for names in groups:
        codes = [int(getattr(state, name)) for name in names]
        assert len(set(codes)) == len(codes)
    assert max(int(getattr(state, name)) for name in groups[3]) == EVENT_KINDS - 1
