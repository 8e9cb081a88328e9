"""Numbers with units become SI; anything else names the dimension that is expected."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.case.case import parse_case
from rpscli.case.schema.units import COMMON_UNITS, KINDS, _parsed, si_value

# A factor of a unit is exact but for the rounding of one product.
ROUNDING = 1e-14


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("200 t", "kg", 2e5),
        ("200t", "kg", 2e5),
        ("1485 mm", "m", 1.485),
        ("1.5e0 m", "m", 1.5),
        ("30 kN/mm", "N/m", 3e7),
        ("1 MN/m", "N/m", 1e6),
        ("100 kip/in", "N/m", 100 * 4448.2216152605 / 0.0254),
        ("0.6 s", "s", 0.6),
        ("600 ms", "s", 0.6),
        ("981 cm/s2", "m/s2", 9.81),
        ("9.81 m/s^2", "m/s2", 9.81),
        ("9.81 m/s**2", "m/s2", 9.81),
        ("-5 µm", "m", -5e-6),
    ],
)
def test_si(text: str, unit: str, value: float) -> None:
    assert si_value(text, unit) == pytest.approx(value, rel=ROUNDING)


@given(st.floats(min_value=1e-3, max_value=1e9))
@settings(deadline=None)
def test_a_tonne_is_a_thousand_kilogrammes(mass: float) -> None:
    assert si_value(f"{mass!r} t", "kg") == pytest.approx(1000.0 * mass, rel=ROUNDING)


@pytest.mark.parametrize(
    ("text", "unit", "parts"),
    [
        ("200 kN", "kg", ["is a force", "must be a mass", "W/g"]),
        ("200 tons", "kg", ["has the unit 'tons'", "write t for 1000 kg"]),
        ("3 kg", "m", ["is a mass", "must be a length: m, cm, mm"]),
        ("3 kN m", "N/m", ["[length]", "must be a stiffness"]),
        ("3 kN/mmm", "N/m", ["'kN/mmm'", "did you mean kN/mm?"]),
        ("3 zorks", "m", ["unknown unit 'zorks'", "use m, cm"]),
        ("5 %", "m", ["unknown unit '%'"]),
        ("3", "s", ["without a unit", "write 3 (s) without quotes"]),
        ("1_000", "kg", ["must be a mass", "write 1000"]),
        ("1,485 mm", "m", ["write 1485 mm"]),
        ("tall", "m", ["must be a length", "'1.5 cm'"]),
        ("3 m; import os", "m", ["unknown unit"]),
        ("3 m**9999999999", "m", ["m"]),
        ("3 ((m", "m", ["unknown unit"]),
        ("3 2 m", "m", ["must be a length"]),
        ("1 g0", "m/s2", ["unknown unit 'g0'", "use m/s2"]),
        ("9.81 m/^s2", "m/s2", ["unknown unit"]),
    ],
)
def test_refusals_name_the_dimension(text: str, unit: str, parts: list[str]) -> None:
    with pytest.raises(ValueError, match=re.escape(parts[0])) as error:
        si_value(text, unit)
    for part in parts:
        assert part in str(error.value)


@given(st.from_regex(r"[0-9.]{1,3} ?[a-zA-Zµ0-9*/^() %.-]{0,12}", fullmatch=True))
@settings(deadline=None)
def test_any_text_is_a_number_or_refused(text: str) -> None:
    reason = ""
    try:
        assert isinstance(si_value(text, "m"), float)
    except ValueError as error:
        reason = str(error)
    assert "length" in reason or "unit" in reason or not reason


def test_the_place_is_that_of_the_text(building: str, faults: object) -> None:
    assert callable(faults)
    message = faults(building, "200 t", "200 kN")
    assert message.startswith("c.yaml:4:16: superstructure.storey_mass = '200 kN' is a force")


def test_units_make_the_same_case(building: str) -> None:
    plain = parse_case(building.replace("200 t", "2.0e5"), name="c.yaml")
    assert plain.document == parse_case(building, name="c.yaml").document


@pytest.mark.parametrize(
    ("written", "unit"),
    [(written, unit) for unit, factors in COMMON_UNITS.items() for written in factors],
)
def test_common_units_have_the_factors_of_pint(written: str, unit: str) -> None:
    # Where an acceleration is meant, g is not the gram.
    asked = "standard_gravity" if (written, unit) == ("g", "m/s2") else written
    expected = float(_parsed(asked).to(_parsed(unit).units).magnitude)
    assert COMMON_UNITS[unit][written] == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize("unit", KINDS)
def test_units_that_messages_propose_are_common(unit: str) -> None:
    assert set(KINDS[unit][1]) <= set(COMMON_UNITS[unit])


@pytest.mark.parametrize(("mass", "code"), [("200 t", 0), ("200 kN", 1), ("14 slug", 1)])
def test_pint_is_imported_only_for_unusual_units(mass: str, code: int) -> None:
    program = (
        "import sys; from rpscli.case.schema.units import si_value\n"
        f"try: si_value({mass!r}, 'kg')\n"
        "except ValueError: pass\n"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == code


def test_an_ordinary_case_needs_no_pint(building: str) -> None:
    program = (
        "import sys; from rpscli.case.case import parse_case;"
        f"parse_case({building!r}, name='c.yaml'); sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
