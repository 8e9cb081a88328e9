"""`podium.devices`: what the format takes and refuses, and what becomes of it."""

from __future__ import annotations

import math

import pytest

from rpscli.analyses.kernels.systems import DEVICE_KINDS
from rpscli.case.case import parse_case
from rpscli.case.schema.case_file import DEVICE_KEYS, DeviceSection
from rpscli.case.schema.keys import unit
from rpscli.errors import CaseError
from rpscli.model import devices
from rpscli.model.devices import (
    DEVICES,
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.physics import state

from .conftest import Faults

ALL = """\
  devices:
    - {kind: viscous, coefficient: 2 MN s/m, exponent: 0.5}
    - {kind: friction, force: 400 kN}
    - {kind: stop, gap: 200 mm, stiffness: 50 kN/mm, damping: 100 kN s/m}
    - {kind: tendon, prestress: 100 kN, stiffness: 20 kN/mm, yield_force: 300 kN}
    - {kind: rolling_resistance, lever: 2 mm}
record"""
COLUMNS = "  column_mass: 5 t\n  columns: 4\n"


@pytest.fixture
def equipped(building: str) -> str:
    return building.replace("record", ALL, 1).replace("  cap_beam_mass_ratio: 10\n", COLUMNS)


def test_every_kind(equipped: str) -> None:
    case = parse_case(equipped, name="c.yaml")
    assert case.structure.columns == 4
    assert case.structure.devices == (
        ViscousDamper(2e6, 0.5),
        FrictionDamper(4e5),
        Stop(0.2, 5e7, 1e5),
        Tendon(1e5, 2e7, 3e5),
        RollingResistance(2e-3),
    )
    again = parse_case(str(case.document), name="again")
    assert again.structure.devices == case.structure.devices


def test_what_may_be_left_out(equipped: str) -> None:
    short = equipped.replace(", exponent: 0.5", "").replace(", yield_force: 300 kN", "")
    viscous, _, _, tendon, _ = parse_case(short, name="c.yaml").structure.devices
    assert viscous == ViscousDamper(2e6, 1.0)
    assert tendon == Tendon(1e5, 2e7, math.inf)


def test_without_devices(building: str) -> None:
    case = parse_case(building, name="c.yaml")
    assert case.structure.devices == ()
    assert "devices" not in case.document["podium"]


def test_a_value_may_vary(equipped: str) -> None:
    case = parse_case(equipped, name="c.yaml", overrides=["podium.devices.1.force=0.5 MN"])
    assert case.structure.devices[1] == FrictionDamper(5e5)
    case = parse_case(equipped, name="c.yaml", overrides=["podium.devices=[]"])
    assert case.structure.devices == ()
    assert unit("podium.devices.1.force") == "N"
    assert unit("podium.devices.0.coefficient") == "N s/m"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("force: 400 kN", "force: -1", "c.yaml:21:31: podium.devices.1.force = -1 must be > 0 N"),
        ("force: 400 kN", "force: 4 t", "podium.devices.1.force = '4 t' is a mass, but must"),
        (", force: 400 kN", "", "c.yaml:21:7: podium.devices.1.force is missing: friction: F_d"),
        (
            "force: 4",
            "gap: 1, force: 4",
            "podium.devices.1.gap is not a key of kind: friction, which",
        ),
        ("exponent: 0.5", "exponent: 3", "must be >= 0.2 and <= 2 (a); 1 is a linear damper"),
        ("kind: friction", "kind: fiction", "did you mean friction?"),
        ("kind: friction, ", "", "podium.devices.1.kind is missing: viscous or friction damper"),
        ("force: 4", "forse: 4", "podium.devices.1.forse is not a key of the format; did you mean"),
        ("yield_force: 300 kN", "yield_force: 90 kN", "must be > prestress = 100 kN (line 23)"),
        (COLUMNS, "  cap_beam_mass_ratio: 10\n", "podium.devices.3 is in each column, but"),
    ],
)
def test_refusals(equipped: str, faults: Faults, old: str, new: str, expected: str) -> None:
    told = faults(equipped, old, new)
    assert expected in told
    assert len(told.splitlines()) == 1


def test_too_many(equipped: str, faults: Faults) -> None:
    friction = "    - {kind: friction, force: 400 kN}\n"
    assert "podium.devices has 13 devices, at most 8" in faults(equipped, friction, 9 * friction)


def test_an_index_beyond_the_list(equipped: str) -> None:
    with pytest.raises(CaseError, match=r"podium\.devices has 5 values, counted from 0"):
        parse_case(equipped, name="c.yaml", overrides=["podium.devices.5.force=1"])


def test_kinds_and_keys_are_those_of_the_model() -> None:
    kinds = DeviceSection.model_fields["kind"].annotation
    assert tuple(DEVICES) == kinds.__args__  # type: ignore[union-attr]
    needed, optional = DEVICE_KEYS["stop"]
    assert (needed, optional) == (("gap", "stiffness"), ("damping",))
    known = {key for pair in DEVICE_KEYS.values() for keys in pair for key in keys}
    assert known == set(DeviceSection.model_fields) - {"kind"}


def test_codes_of_the_kernels() -> None:
    assert [DEVICE_KINDS[DEVICES[name]] for name in DEVICES] == [
        getattr(state, name.upper()) for name in DEVICES
    ]


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("viscous", (0.0, 1.0)),
        ("viscous", (1.0, 0.1)),
        ("friction", (math.inf,)),
        ("stop", (-0.1, 1.0, 0.0)),
        ("stop", (0.1, 0.0, 0.0)),
        ("tendon", (2.0, 1.0, 1.0)),
        ("tendon", (-1.0, 1.0, 1.0)),
        ("rolling_resistance", (0.0,)),
    ],
)
def test_the_model_refuses_too(kind: str, values: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="must be"):
        devices.DEVICES[kind](*values)


def test_names() -> None:
    assert Stop(0.1, 1e6).kind == "stop"
