"""Numbers with units become SI; anything else names the dimension that is expected."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpscli.case.schema.fields import ValueRange
from rpscli.case.schema.scale_to import scale_to_of
from rpscli.constants import STANDARD_GRAVITY
from rpscli.tools.comparison.observed import comparable
from rpscli.units import (
    FOOT,
    INCH,
    KINDS,
    POUND,
    POUND_FORCE,
    computed_remedy,
    si_factor,
    si_value,
)

# A factor of a unit is exact but for the rounding of one product.
ROUNDING = 1e-14
KIP = 1e3 * POUND_FORCE

FACTORS = {
    "m": {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "km": 1e3, "ft": FOOT, "in": INCH},
    "kg": {"kg": 1.0, "t": 1e3, "Mg": 1e3, "lb": POUND},
    "s": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "N/m": {
        "N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6, "GN/m": 1e9, "N/cm": 1e2, "kN/cm": 1e5, "MN/cm": 1e8,
        "N/mm": 1e3, "kN/mm": 1e6, "MN/mm": 1e9, "lbf/in": POUND_FORCE / INCH,
        "lbf/ft": POUND_FORCE / FOOT, "kip/in": KIP / INCH, "kip/ft": KIP / FOOT,
    },
    "N s/m": {"N s/m": 1.0, "kN s/m": 1e3, "MN s/m": 1e6, "kN s/mm": 1e6},
    "m/s2": {"g": STANDARD_GRAVITY, "m/s2": 1.0, "cm/s2": 0.01, "mm/s2": 1e-3, "ft/s2": FOOT,
             "in/s2": INCH},
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 1e-3, "ft/s": FOOT, "in/s": INCH},
    "N": {"N": 1.0, "kN": 1e3, "MN": 1e6, "lbf": POUND_FORCE, "kip": KIP},
    "N m": {"N m": 1.0, "kN m": 1e3, "MN m": 1e6, "N mm": 1e-3, "kip ft": KIP * FOOT},
    "Pa": {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "kN/cm2": 1e7},
    "rad": {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0},
    "deg": {"deg": 1.0, "rad": 180.0 / math.pi},
    "1/s": {"1/s": 1.0, "1/ms": 1e3, "1/min": 1.0 / 60.0},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180.0, "rpm": math.pi / 30.0},
    "N s2/m2": {"N s2/m2": 1.0, "kN s2/m2": 1e3},
}  # fmt: skip

UNUSUAL = {
    "m": {"µm": 1e-06, "kilometres": 1000.0, "inches": 0.0254, "feet": 0.30479999999999996,
        "yards": 0.9144, "millimeter": 0.001},
    "kg": {"mg": 1e-06, "g": 0.001, "kilograms": 1.0, "pounds": 0.4535923700000001,
        "lbs": 0.4535923700000001, "slugs": 14.59390293720637, "oz": 0.028349523125000005,
        "kN s2/m": 1000.0},
    "s": {"us": 1e-06, "milliseconds": 0.001, "hours": 3600.0},
    "N/m": {"kgf/mm": 9806.65, "tf/cm": 980665.0, "kips/inch": 175126.83524647643,
        "psi ft": 2101.522022957717, "MPa*mm": 1000.0, "kJ/m^2": 1000.0, "t/s**2": 1000.0,
        "kN*m^-1": 1000.0, "kN · m-1": 1000.0},
    "N s/m": {"kip s/in": 175126.83524647643, "lbf s/ft": 14.59390293720637, "MN*ms/mm": 1000000.0,
        "kN/m s": 1000.0, "kg/s": 1.0},
    "m/s2": {"m/s/s": 1.0, "cm/sec^2": 0.01, "Gal": 0.01, "mGal": 1e-05, "N/kg": 1.0},
    "m/s": {"mph": 0.44704, "knots": 0.5144444444444445, "km / h": 0.2777777777777778},
    "N": {"kilonewtons": 1000.0, "lbf": 4.4482216152605, "kgf": 9.80665, "dyn": 1e-05,
        "kg m/s2": 1.0},
    "rad": {"degrees": 0.017453292519943295, "arcmin": 0.00029088820866572163,
        "gon": 0.015707963267948967, "mm/m": 0.001},
}  # fmt: skip
"""What pint 0.25 makes of them."""


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("200t", "kg", 2e5), ("1485 mm", "m", 1.485), ("1.5e0 m", "m", 1.5), ("-5 µm", "m", -5e-6),
        ("30 kN/mm", "N/m", 3e7), ("981 cm/s2", "m/s2", 9.81), ("9.81 m/s^2", "m/s2", 9.81),
    ],
)  # fmt: skip
def test_si(text, unit, value):
    assert si_value(text, unit) == pytest.approx(value, rel=ROUNDING)


@pytest.mark.parametrize(
    ("text", "unit", "parts"),
    [
        ("200 kN", "kg", ["is a force", "must be a mass", "W/g"]),
        ("200 tons", "kg", ["has the unit 'tons'", "write t for 1000 kg"]),
        ("3 kg", "m", ["is a mass", "must be a length: m, cm, mm"]),
        ("3 kN m", "N/m", ["is a moment", "must be a stiffness"]),
        ("3 kN m2", "N/m", ["is another quantity", "must be a stiffness"]),
        ("500 kN", "N s/m", ["is a force", "N s/m, kN s/m, MN s/m or kN s/mm"]),
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
def test_refusals_name_the_dimension(text, unit, parts):
    with pytest.raises(ValueError, match=re.escape(parts[0])) as error:
        si_value(text, unit)
    for part in parts:
        assert part in str(error.value)
    assert ("W/g" in str(error.value)) == ("W/g" in parts)


@given(st.from_regex(r"[0-9.]{1,3} ?[a-zA-Zµ0-9*/^() %.-]{0,12}", fullmatch=True))
def test_any_text_is_a_number_or_refused(text):
    reason = ""
    try:
        assert isinstance(si_value(text, "m"), float)
    except ValueError as error:
        reason = str(error)
    assert "length" in reason or "unit" in reason or not reason


@pytest.mark.parametrize(("unit", "written"), FACTORS.items())
def test_factors_are_those_of_the_definitions(unit, written):
    # Units of the first rank agree in every digit, whichever way they are written.
    for name, factor in written.items():
        assert si_factor(name, unit) == factor, name


@pytest.mark.parametrize(("unit", "written"), UNUSUAL.items())
def test_unusual_units_are_those_of_pint(unit, written):
    for name, factor in written.items():
        assert si_factor(name, unit) == pytest.approx(factor, rel=ROUNDING), name


@pytest.mark.parametrize("unit", KINDS)
def test_units_that_messages_propose_are_common(unit):
    assert set(KINDS[unit][1]) <= set(FACTORS[unit])


def test_turns_and_radians_are_not_mixed_up():
    assert si_value("0.3 1/s", "1/s") == 0.3
    assert si_value("2 1/min", "1/s") == 2.0 / 60.0
    assert si_value("3 deg/s", "rad/s") == 3.0 * (math.pi / 180.0)
    for text, unit in (("1 Hz", "rad/s"), ("2 rpm", "1/s"), ("2 rad/s", "1/s")):
        with pytest.raises(ValueError, match="counts turns or angles otherwise"):
            si_value(text, unit)


def test_values_at_equal_spaces():
    assert ValueRange(low=0.1, high=0.3, count=3).values == (0.1, 0.2, 0.3)
    assert ValueRange(low=0.1, high=10.0, count=3, spacing="log").values == (
        0.1,
        1.0,
        10.0,
    )


def test_what_a_record_is_scaled_to():
    assert (scale_to_of("PGV=50 cm/s").value, scale_to_of("Sa(0.6 s)=0.5 g").period) == (
        0.5,
        0.6,
    )
    assert scale_to_of("PGV(RotD100)=0.5").of == "rotd100"
    assert scale_to_of("Sa(0.6 s, geomean)=1 g").of == "geomean"


def test_values_of_observed_systems():
    diagonal = "podium.bearing.semi_diagonal"
    assert comparable(diagonal, "1500 mm") == comparable(diagonal, 1.5) == "1.5"
    assert (comparable("title", "tower A"), comparable("scale", "0.50")) == (
        "tower A",
        "0.5",
    )


@pytest.mark.parametrize(
    ("text", "unit", "said"),
    [
        ("8.5 deg", "1", "; an angle? tan(8.5 deg) = 0.149"),
        ("150 mrad", "1", "; an angle? tan(150 mrad) = 0.151"),
        ("120 deg", "1", ""),
        ("2.5 Hz", "s", "; a frequency? 1/(2.5 Hz) = 0.4 s"),
        ("0 Hz", "s", ""),
        ("500 kN", "kg", "; a weight? 500 kN/g = 50.99 t"),
        ("3 m", "kg", ""),
        ("3 parsec", "s", ""),
        ("much", "kg", ""),
    ],
)
def test_what_another_kind_of_value_may_have_meant(text, unit, said):
    assert computed_remedy(text, unit) == said
