"""`rps identify`: from a file of measurements to values of the case."""

import json
import math

import pytest
from commands.conftest import columns, write_case
from paper_structures import needs_compiled_kernels

pytestmark = needs_compiled_kernels

FRAME = """\
rps: 1
superstructure: {storeys: 0}
podium:
  bearing: {semi_diagonal: 1.5, slenderness: 0.15, curvature_ratio: 0}
  cap_beam_mass: 100 t     # weighed
  cap_beam_mass_ratio: 10
  impact: {loss: 1}        # not measured yet
"""
RELEASED = ("--record", "pulse:sine?amplitude=1e-9g&period=0.1&dt=0.005", "--figures", "none",
            "--set", "analysis.initial_rotation=0.06", "--set", "podium.impact.loss=0.6",
            "--set", "analysis.free_vibration=12")  # fmt: skip


SLOW = "time [min],rotation [mrad]\n" + "".join(
    f"{0.01 * i:.2f},{100.0 * math.cos(0.09 * i):.4f}\n" for i in range(500)
)
"""As from a wrong unit: swings of 42 s, and no energy is lost."""


def history(folder, quantity):
    """Times and values of a history."""
    table = columns(folder / "timehistory.csv")
    return list(zip(table["time [s]"], table[quantity], strict=True))


@pytest.fixture
def measured(workplace, rps):
    """A frame, and a release of one of another loss at impacts; mm and ms, as sensors have them."""
    (workplace / "frame.yaml").write_text(FRAME, encoding="utf-8")
    rps("timehistory", "frame.yaml", *RELEASED, "-o", "r")
    swings = history(workplace / "r", "cap_beam_displacement [m]")
    lines = [f"{1e3 * float(time)},{1e3 * float(moved):.2f}" for time, moved in swings]
    file = workplace / "release.csv"
    file.write_text(
        "\n".join(["time [ms],cap_beam_displacement [mm]", *lines]), encoding="utf-8"
    )
    return file


def test_a_release_gives_a_loss(measured, rps_json, rps):
    found = rps_json("identify", "frame.yaml", "release.csv", "rocking")
    by_name = {each["name"]: each for each in found["estimates"]}
    # hundredths of a millimetre are rounded, of 180
    assert by_name["loss"]["value"] == pytest.approx(0.6, rel=2e-3)
    assert by_name["loss"]["low"] < 0.6 < by_name["loss"]["high"]
    e = rps_json("check", "frame.yaml", "--set", "podium.impact.loss=0.6")["restitution"]
    assert by_name["restitution"]["low"] < e < by_name["restitution"]["high"]
    assert len(found["residuals"]) == 12
    shown = rps(
        "identify", "frame.yaml", "release.csv", "rocking", "--from", "0.001"
    ).stdout
    assert "residuals are" in shown
    assert "--set podium.impact.loss=0.6" in shown


def test_the_period_of_a_pull(workplace, rps, rps_json):
    shake = ("--record", "pulse:sine?amplitude=0.02g&period=0.3&dt=0.005", "--figures", "none",
             "--set", "analysis.free_vibration=8")  # fmt: skip
    rps("timehistory", "small.yaml", *shake, "-o", "r")
    lines = map(",".join, history(workplace / "r", "floor_3_acceleration [m/s2]"))
    text = "\n".join(["time [s],floor_acceleration [m/s2]", *lines])
    (workplace / "floor.csv").write_text(text, encoding="utf-8")
    found = rps_json("identify", "small.yaml", "floor.csv", "release", "--from", "0.31")
    by_name = {each["name"]: each for each in found["estimates"]}
    assert by_name["period"]["value"] == pytest.approx(0.3, rel=1e-3)
    assert by_name["period_ratio"]["value"] == pytest.approx(1.0, rel=1e-3)
    assert by_name["damping"]["value"] == pytest.approx(0.05, rel=0.02)


def test_a_longer_period_tells_how_ends_bear(workplace, rps_json):
    """Three storeys of the paper at r = 1.2: 63.4 MN/m and 47 um, from another derivation."""
    masses = ("[200000, 200000, 150000]", "20 t")
    write_case("paper.yaml", masses, ("curvature_ratio: 0.5", "curvature_ratio: 0"))
    times = [0.005 * i for i in range(2000)]
    w, zeta = 2.0 * math.pi / 0.36, 0.05
    damped = w * math.sqrt(1.0 - zeta**2)
    floor = (math.exp(-zeta * w * t) * math.cos(damped * t) for t in times)
    lines = [f"{t:.3f},{a:.6f}" for t, a in zip(times, floor, strict=True)]
    text = "\n".join(["time [s],floor_acceleration [g]", *lines])
    (workplace / "floor.csv").write_text(text, encoding="utf-8")
    found = rps_json("identify", "paper.yaml", "floor.csv", "release")
    contact = {"podium.contact.kind": "plane", "podium.contact.period_ratio": "1.2"}
    assert found["keys"] == contact
    by_name = {each["name"]: each["value"] for each in found["estimates"]}
    assert by_name["period_ratio"] == pytest.approx(1.2, rel=1e-4)
    assert by_name["stiffness"] == pytest.approx(63.4e6, rel=2e-3)
    assert by_name["settlement"] == pytest.approx(47e-6, rel=2e-2)


@pytest.mark.parametrize(
    ("words", "text", "code", "reason"),
    [
        (("rocking",), "time [s],tilt [rad]\n0,1\n", 3, "no column `rotation [rad]` or"),
        (("rocking",), "time [s],rotation [m]\n0,1\n", 3, "column rotation:"),
        (("rocking",), "time [s],rotation [rad]\n0,a\n", 3, "write numbers, in rad"),
        (("rocking",), "time [s],rotation [rad]\n0,0\n1,1\n", 3, "at even times"),
        (
            ("rocking",),
            "time [s],rotation [rad]\n0,0\n1\r,1\n",
            3,
            "column time: is empty; write numbers",
        ),
        (("rocking",), "", 3, "no column `time [s]`"),
        (("ambient",), "time [s],floor_acceleration [g]\n", 2, "no period before uplift"),
        (("rocking",), "time [s],rotation [mrad]\n", 4, "four are needed"),
        (
            ("rocking",),
            "time [s],rotation [rad]\n",
            4,
            "2 rad is beyond the critical one of",
        ),
        (
            ("rocking",),
            "time [s],rotation [rad]\n0,0\n1,nan\n",
            3,
            "csv:3: column rotation: 'nan'",
        ),
        (
            ("rocking",),
            SLOW,
            4,
            "no structure of this kind rocks in this way: the swings of",
        ),
        (
            ("rocking", "--from", "9"),
            "time [s],rotation [rad]\n",
            2,
            "between --from and --to",
        ),
    ],
)
def test_refusals_say_what_to_do(workplace, rps, words, text, code, reason):
    (workplace / "frame.yaml").write_text(FRAME, encoding="utf-8")
    if text.count("\n") == 1:
        text += "".join(f"{0.1 * i:.1f},{i % 3}\n" for i in range(40))
    (workplace / "data.csv").write_text(text, encoding="utf-8")
    rps("identify", "frame.yaml", "data.csv", *words, exit_code=code, says=reason)


def write_decay(folder, period, damping=0.05):
    """The acceleration of a floor that was let go."""
    w = 2.0 * math.pi / period
    damped = w * math.sqrt(1.0 - damping**2)
    times = [0.005 * i for i in range(2000)]
    floor = (math.exp(-damping * w * t) * math.cos(damped * t) for t in times)
    lines = [f"{t:.3f},{a:.6f}" for t, a in zip(times, floor, strict=True)]
    text = "\n".join(["time [s],floor_acceleration [g]", *lines])
    (folder / "floor.csv").write_text(text, encoding="utf-8")


def test_a_period_below_that_of_the_fixed_base_says_so(workplace, rps):
    write_decay(workplace, 0.285)
    shown = " ".join(rps("identify", "small.yaml", "floor.csv", "release").stdout.split())
    assert "the period is shorter than the case on a fixed base" in shown
    assert "is not excluded" not in shown
    assert "period 0.28500 0.28500" in shown


@pytest.mark.parametrize("damping", [0.05, 0.02])
def test_period_and_damping_are_printed_where_no_contact_has_them(
    workplace, rps, damping
):
    """Ends without a flat part have no bed."""
    changes = ("slenderness: 0.15", "slenderness: 0"), ("ratio: 0.5", "ratio: 0.6")
    write_case("spherical.yaml", *changes)
    write_decay(workplace, 0.36, damping)
    found = rps("identify", "spherical.yaml", "floor.csv", "release", exit_code=4)
    assert "ends without a flat part have nothing" in found.stderr
    shown = " ".join(found.stdout.split())
    assert "period 0.36000 " in shown
    assert f"damping {damping:.4f}"[:-1] in shown
    told = rps(
        "identify", "spherical.yaml", "floor.csv", "release", "--json", exit_code=4
    )
    document = json.loads(told.stdout)
    assert document["estimates"][0]["value"] == pytest.approx(0.36, rel=1e-3)
    assert document["exit_code"] == 4


def test_a_fit_that_is_refused_has_its_period_and_damping(workplace, rps):
    write_decay(workplace, 0.1)
    refused = rps("identify", "small.yaml", "floor.csv", "release", exit_code=4)
    assert "the best has a period of" in refused.stderr
    assert "and a damping ratio of" in refused.stderr
