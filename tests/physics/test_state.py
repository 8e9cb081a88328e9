"""Records of the kernel: every field is named, has a unit and room, and is nowhere hidden."""

from __future__ import annotations

import numpy as np
import pytest

from rpscli.constants import MOST_STOREYS
from rpscli.physics import state
from rpscli.physics.state import LANES, PAGE, WHOLE, Field, describe, record_type, records

UNITS = {"-", "mixed", "1", "m", "rad", "s", "kg", "N", "J", "W", "sqrt", WHOLE}
"""What units are made of, with squares and rates of it."""


@pytest.mark.parametrize("table", ["SYSTEM", "REQUEST", "STATE", "RESULT", "SAMPLE", "EVENT"])
def test_every_field_has_a_name_a_unit_and_room(table: str) -> None:
    fields: tuple[Field, ...] = getattr(state, table)
    names = [field.name for field in fields]
    assert len(set(names)) == len(names)
    # numpy's own attributes of a record would hide it
    assert not [name for name in names if hasattr(np.record, name) or hasattr(np.recarray, name)]
    kind = record_type(fields, 2, LANES)
    sizes = {"ways": 2, "demands": 6, "stages": 9}
    least = {"modes": MOST_STOREYS, "rows": 2 * MOST_STOREYS, "lanes": LANES}
    for field, line in zip(fields, describe(fields).splitlines(), strict=True):
        parts = field.unit.replace("(", " ").replace(")", " ").replace("/", " ").split()
        assert parts not in ([], ["1"])
        assert {part.rstrip("23") or part for part in parts} <= UNITS, field
        assert line.split()[0] == field.name
        assert f"[{field.unit}]" in line
        inner = kind[field.name]
        assert inner.base == (np.int64 if field.unit == WHOLE else np.float64)
        for name, size in zip(field.sizes.split(), inner.shape, strict=True):
            assert size >= least[name] if name in least else size == sizes.get(name, size)
    made = records(fields, count=3)
    assert made.ctypes.data % PAGE == 0
    assert not any(made.tobytes())


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
    assert max(int(getattr(state, name)) for name in groups[3]) == state.EVENT_KINDS - 1
