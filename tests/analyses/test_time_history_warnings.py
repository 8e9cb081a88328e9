"""What the user is told beside the numbers, and what the numbers are compared with."""

from __future__ import annotations

import math

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    building,
    ground,
    needs_compiled_kernels,
    podium,
    stillness,
    waves,
)

from rpscli.analyses.fixed_base import fixed_base_response, fixed_base_shears
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw
from rpscli.model.superstructure import RayleighDamping
from rpscli.records.ground_motion import MotionComponents


@needs_compiled_kernels
@pytest.mark.parametrize(("law", "creates"), [("rigid", True), ("flexible", False)])
def test_energy_created_by_a_release_is_told_with_a_remedy(law: str, creates: bool) -> None:
    """A tall building of short period against the rigid law; no ground motion supplies energy."""
    structure = podium(
        30,
        0.15,
        FLAT,
        superstructure=building(30, 0.5),
        law=ImpactLaw("rigid" if law == "rigid" else "flexible"),
    )
    settings = TimeHistorySettings(free_vibration=1.5, initial_rotation=0.03)
    result = time_history(structure, stillness(0.01), settings)
    assert result.energy.input == 0.0
    assert (result.energy.created > 0.02 * result.trace.energy_stored[0]) is np.bool_(creates)
    assert any("law: flexible" in warning for warning in result.warnings) is creates
    assert any("still moves at the end" in warning for warning in result.warnings)
    if not creates:
        assert result.energy.created == result.history.creating_impacts == 0


@needs_compiled_kernels
def test_a_storey_that_never_stops_is_told() -> None:
    """Without loss the free vibration `auto` gives up after its longest time."""
    above = building(1, damping=RayleighDamping(0.0))
    structure = podium(1, 0.15, 0.5, law=ImpactLaw("value", 1.0), superstructure=above)
    result = time_history(structure, stillness(0.05), TimeHistorySettings(initial_rotation=0.1))
    assert result.duration == pytest.approx(0.05 + LONGEST_FREE_VIBRATION, rel=1e-12)
    assert any("not at rest" in warning for warning in result.warnings)


def test_the_yardstick_sees_the_whole_record_when_the_structure_falls() -> None:
    structure = podium(2, 0.10, FLAT)
    record = waves(6.0, 0.02, 10.0, seed=1)
    result = time_history(structure, record)
    assert result.overturned
    assert result.fixed_base is not None
    swaying = np.abs(result.fixed_base.floor_displacements[:, 0])
    assert len(swaying) == record.npts
    assert record.dt * np.argmax(swaying) > result.duration + 0.1
    stout = time_history(podium(2, 0.9, 1.5), record)
    assert not stout.overturned
    assert stout.fixed_base is not None
    assert result.fixed_base.base_shear == stout.fixed_base.base_shear
    assert result.fixed_base.floor_accelerations.tolist() == (
        stout.fixed_base.floor_accelerations.tolist()
    )


def test_the_yardstick_goes_on_through_the_free_vibration() -> None:
    """A pulse just before the end of the record: the building answers after it."""
    record = ground(np.concatenate((np.zeros(20), [0.0, 1.0, 1.0])), 0.02)
    result = time_history(podium(3), record, TimeHistorySettings(free_vibration=0.5))
    assert result.fixed_base is not None
    swaying = np.abs(result.fixed_base.floor_displacements[:, 0])
    assert len(swaying) == len(result.trace.time) == record.npts + 25
    assert np.argmax(swaying) >= record.npts
    assert result.fixed_base.drifts[0] == pytest.approx(np.max(swaying), rel=0.02)
    building = result.structure.superstructure
    assert building is not None
    shears = fixed_base_shears(result.structure, MotionComponents(record), record.npts + 24)
    assert shears.tolist() == result.fixed_base.storey_shears.tolist()


def test_a_frame_has_no_yardstick() -> None:
    record = ground([0.0, 1.0, 0.0], 0.02)
    assert (
        time_history(podium(0), record, TimeHistorySettings(free_vibration=0.1)).fixed_base is None
    )
    assert time_history(podium(1), record, with_fixed_base=False).fixed_base is None
    with pytest.raises(ValueError, match="without superstructure"):
        fixed_base_response(podium(0), MotionComponents(record), 2)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("free_vibration", -1.0),
        ("free_vibration", math.inf),
        ("recontact_tolerance", -1e-9),
        ("recontact_tolerance", math.nan),
        ("overturning_limit", math.nan),
        ("accuracy", 0.0),
        ("accuracy", math.nan),
        ("accuracy", math.inf),
        ("max_events", 0),
        ("initial_rotation", math.nan),
    ],
)
def test_settings_that_no_history_ends_with_are_refused(name: str, value: object) -> None:
    with pytest.raises(ValueError, match=rf"{name} = .* must be"):
        TimeHistorySettings(**{name: value})  # type: ignore[arg-type]
