"""Every law of a device answers every question, and a law that leaves one open cannot be made."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import get_args

import numpy as np
import pytest
from paper_structures import podium

from rpscli.analyses.result_quantities import HISTORY
from rpscli.case.schema.case_file import DEVICE_KEYS, DeviceSection
from rpscli.model.devices import (
    DEVICES,
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.podium import AtRest, Device, Linear
from rpscli.model.uplifted_state import uplifted_state
from rpscli.report.figures.devices import DRAWN

EXAMPLES: tuple[Device, ...] = (
    ViscousDamper(1e5),
    ViscousDamper(1e5, 0.5),
    FrictionDamper(1.2e5),
    Stop(0.15, 2e6, 1e5),
    Stop(0.0, 3e4),
    Tendon(3e4, 5e5, 4e4),
    Tendon(0.0, 2e5),
    RollingResistance(0.02),
)
QUESTIONS = frozenset(getattr(Device, "__abstractmethods__"))  # noqa: B009


def test_every_law_is_tested_and_named_once() -> None:
    assert {device.kind: type(device) for device in EXAMPLES} == DEVICES


@pytest.mark.parametrize("question", sorted(QUESTIONS))
def test_a_law_that_leaves_a_question_open_cannot_be_made(question: str) -> None:
    whole = type("Whole", (Device,), dict.fromkeys(QUESTIONS, None))
    assert whole()
    open_law = type("Open", (Device,), dict.fromkeys(QUESTIONS - {question}, None))
    with pytest.raises(TypeError, match=question):
        open_law()


@pytest.mark.parametrize("device", EXAMPLES, ids=repr)
def test_every_question_is_answered(device: Device) -> None:
    structure = replace(podium(2, 0.15, 0.5), devices=(device,), columns=6)
    x = np.linspace(0.0, 0.3, 7)
    answers = {
        "kind": device.kind,
        "results": device.results,
        "constants": device.constants(structure),
        "at_rest": device.at_rest(structure, x, 0.1),
        "stiffness_after_uplift": device.stiffness_after_uplift(structure),
        "linear": device.linear(structure, uplifted_state(structure.bearing, rolling=True)),
        "bounds": device.bounds(structure),
        "consequences": list(device.consequences(structure)),
        "stroke": device.stroke(structure, x),
        "beam_forces": device.beam_forces(structure, x, np.ones_like(x)),
        "remaining_prestress": device.remaining_prestress(0.0),
    }
    assert answers.keys() >= QUESTIONS
    assert all(np.all(np.asarray(force) >= 0.0) for force in device.at_rest(structure, x, 0.0))
    assert isinstance(answers["at_rest"], AtRest)
    assert isinstance(answers["linear"], Linear)
    assert device.stroke(structure, x).shape == x.shape
    assert {part.shape for part in device.beam_forces(structure, x, x)} == {x.shape}
    assert set(device.results) <= {quantity.name for quantity in HISTORY}
    assert 1 <= len(device.constants(structure)) <= 4
    assert answers["consequences"]


@pytest.mark.parametrize("device", EXAMPLES, ids=repr)
def test_what_is_not_linear_is_said(device: Device) -> None:
    """Friction, gaps and powers either stand in the modes, or are named as left out."""
    structure = replace(podium(2, 0.15, 0.5), devices=(device,), columns=6)
    found = device.linear(structure, uplifted_state(structure.bearing, rolling=True))
    assert found.left_out or found.stiffness or found.damping


@pytest.mark.parametrize("device", EXAMPLES, ids=repr)
def test_bounds_cover_the_stiffness_at_rest(device: Device) -> None:
    structure = replace(podium(2, 0.15, 0.5), devices=(device,), columns=6)
    x = np.linspace(0.0, structure.critical_rotation, 2001)
    force = np.broadcast_to(device.at_rest(structure, x, 0.0).restoring, x.shape)
    slope = np.diff(force) / np.diff(structure.path(x)[1])
    prestress = 0.0 if device.remaining_prestress(0.0) is None else 6.0 * 3e4
    curvature = prestress / structure.bearing.half_height  # what a constant tension adds
    assert np.max(slope) <= device.bounds(structure)[0] * (1.0 + 1e-9) + curvature


@pytest.mark.parametrize("name", DEVICES)
def test_a_law_can_be_written_and_drawn(name: str) -> None:
    assert DRAWN.keys() == set(DEVICES.values())
    assert get_args(DeviceSection.model_fields["kind"].annotation) == tuple(DEVICES)
    needed, optional = DEVICE_KEYS[name]
    assert {*needed, *optional} == {field.name for field in fields(DEVICES[name])}
    assert {*needed, *optional} <= set(DeviceSection.model_fields)
