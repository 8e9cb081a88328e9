"""`rps compare`: what differs is told with its noise, and nothing else."""

from __future__ import annotations

import csv
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from paper_structures import needs_compiled_kernels

from .conftest import SMALL_CASE, Invoke

pytestmark = needs_compiled_kernels

Json = Callable[..., dict[str, Any]]
STUDY = """\
rps: 1
base: small.yaml
vary: [{podium.bearing.slenderness: [0.1, 0.15]}]
records: ["pulse:sine?amplitude=0.3g&period=0.5", "pulse:sine?amplitude=0.3g&period=0.7"]
"""
NONE = ("--figures", "none")


def test_stored_results_are_those_of_the_case(rps: Invoke, rps_json: Json) -> None:
    assert rps("timehistory", "small.yaml", *NONE, "-o", "stored").exit_code == 0
    found = rps_json("compare", "stored", "small.yaml", "--tolerance", "0")
    assert found["passed"]
    assert found["compared"] > 50
    assert [found[key] for key in ("inputs", "versions", "results", "only_a", "only_b")] == [[]] * 5


@pytest.mark.evidence("error budget and comparison", "exact")
def test_a_change_is_told_with_what_one_percent_of_the_motion_does(
    workplace: Path, rps_json: Json
) -> None:
    changed = SMALL_CASE.replace("period: 0.3", "period: 0.33")
    (workplace / "other.yaml").write_text(changed, encoding="utf-8")
    sides = ("small.yaml", "other.yaml")
    found = rps_json("compare", *sides, "--tolerance", "0.01", exit_code=10)
    assert not found["passed"]
    assert found["inputs"] == [{"name": "case.superstructure.period", "a": 0.3, "b": 0.33}]
    by_name = {each["name"]: each for each in found["results"]}
    # by hand: each case, and its motion a percent weaker and stronger
    runs = {
        (side, factor): rps_json(
            "timehistory", side, *NONE, "--scale", factor, "-o", "x", "--force"
        )
        for side in sides
        for factor in ("1", "0.99", "1.01")
    }
    for name in ("max_base_shear", "max_floor_acceleration", "max_lift"):
        own = [runs[side, "1"][name] for side in sides]
        assert [by_name[name]["a"], by_name[name]["b"]] == own
        assert by_name[name]["relative"] == abs(own[1] - own[0]) / max(own)
        moved = [abs(run[name] - runs[side, "1"][name]) for (side, _), run in runs.items()]
        assert by_name[name]["noise"] == pytest.approx(max(moved), rel=1e-6)
    shears = by_name["storey_shears"]
    assert (shears["of"], shears["unit"], shears["noise"]) == (3, "N", None)


def test_folders_of_two_versions(workplace: Path, rps: Invoke, rps_json: Json) -> None:
    rps("timehistory", "small.yaml", *NONE, "-o", "new")
    shutil.copytree("new", "old")
    for name, key in (("run.json", "versions"), ("summary.json", "energy")):
        document = json.loads((workplace / "old" / name).read_text(encoding="utf-8"))
        document[key] |= {"rps": "0.0.9"} if key == "versions" else {"input": 1.0}
        (workplace / "old" / name).write_text(json.dumps(document), encoding="utf-8")
    found = rps_json("compare", "old/run.json", "new/summary.json")
    assert [each["name"] for each in found["versions"]] == ["rps"]
    assert [each["name"] for each in found["results"]] == ["energy.input"]
    shown = rps("compare", "old", "new", "--tolerance", "0.5")
    assert shown.exit_code == 10
    assert "EXCEEDED" in shown.stdout
    assert '"0.0.9"' in shown.stdout


def test_points_are_matched_by_what_they_are(workplace: Path, rps: Invoke, rps_json: Json) -> None:
    (workplace / "study.yaml").write_text(STUDY, encoding="utf-8")
    (workplace / "turned.yaml").write_text(STUDY.replace("0.1, 0.15", "0.15, 0.1"), "utf-8")
    folders = [f"results/{name}/sweep" for name in ("study", "turned", "other")]
    found = rps_json("compare", "study.yaml", "turned.yaml", "--tolerance", "0")
    for name in ("study", "turned"):
        assert not (workplace / f"results/{name}/sweep/run.json").exists()
        assert rps("sweep", f"{name}.yaml", *NONE).exit_code == 0
        same = rps_json("compare", f"{name}.yaml", f"results/{name}/sweep", "--tolerance", "0")
        assert [same[key] for key in ("inputs", "results", "only_a", "only_b")] == [[]] * 4
    assert rps_json("compare", *folders[:2])["compared"] == found["compared"]
    assert found["results"] == []
    assert [each["name"] for each in found["inputs"]] == ["study.vary.0.podium.bearing.slenderness"]
    steeper = STUDY.replace("small.yaml\n", "steeper.yaml\n")
    (workplace / "other.yaml").write_text(steeper, encoding="utf-8")
    (workplace / "steeper.yaml").write_text(SMALL_CASE.replace("storeys: 3\n", "storeys: 3\n"
        "  profile: uniform\n"), encoding="utf-8")  # fmt: skip
    assert rps("sweep", "other.yaml", *NONE).exit_code == 0
    found = rps_json("compare", folders[0], folders[2])
    (shear,) = (each for each in found["results"] if each["name"] == "points.csv: max_lift [m]")
    lifts = []
    for name in ("study", "other"):
        rps_json("sweep", f"{name}.yaml", *NONE, "--force")
        text = (workplace / f"results/{name}/sweep/points.csv").read_text(encoding="utf-8")
        lifts.append([float(row["max_lift [m]"]) for row in csv.DictReader(text.splitlines())])
    ratios = sorted(b / a for a, b in zip(*lifts, strict=True))
    assert shear["of"] == len(ratios) == 4
    assert shear["ratios"] == [ratios[2], ratios[0], ratios[3]]  # 4 values: those next to it
    assert shear["relative"] == abs(ratios[2] - 1.0)


def test_cases_without_a_record_are_compared_by_what_follows(
    workplace: Path, rps_json: Json
) -> None:
    (workplace / "a.yaml").write_text(SMALL_CASE.partition("record:")[0], encoding="utf-8")
    (workplace / "b.yaml").write_text(
        SMALL_CASE.partition("record:")[0].replace("slenderness: 0.15", "slenderness: 0.18"),
        encoding="utf-8",
    )
    by_name = {each["name"]: each for each in rps_json("compare", "a.yaml", "b.yaml")["results"]}
    assert by_name["static_base_shear"]["b"] == rps_json("check", "b.yaml")["static_base_shear"]
    pulses = (f"pulse:sine?amplitude={peak}g&period=1" for peak in (0.2, 0.3))
    records = [word for pulse in pulses for word in ("--record", pulse)]
    names = [e["name"] for e in rps_json("compare", "a.yaml", "b.yaml", *records)["results"]]
    assert "records.csv: max_base_shear [N]" in names
    assert any(name.startswith("statistics.csv: ") for name in names)
    rps_json("compare", "a.yaml", "small.yaml", exit_code=2)  # one of them names a record
    rps_json("compare", "a.yaml", "missing.yaml", exit_code=3)


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("small.yaml", "."), "cannot be compared: No such file"),
        (("small.yaml", "damaged"), "it is damaged"),
        (("design.yaml", "small.yaml"), "run both by `rps design`"),
        (("study.yaml", "small.yaml"), "study.yaml is of `rps sweep`, small.yaml of"),
        (("study.yaml", "study.yaml", "--record", "x.at2"), "leave --record out"),
        (("modes", "stored", "--record", "x.at2"), "leave --record out"),
        (("modes", "stored"), "is of `rps modal`, stored of `rps timehistory`"),
    ],
)
def test_refusals_say_what_to_do(
    workplace: Path, rps: Invoke, words: tuple[str, ...], reason: str
) -> None:
    (workplace / "damaged").mkdir()
    (workplace / "damaged" / "run.json").write_text("{}", encoding="utf-8")
    (workplace / "design.yaml").write_text("base: small.yaml\nvariables: {}\n", encoding="utf-8")
    (workplace / "study.yaml").write_text(STUDY, encoding="utf-8")
    if "modes" in words:
        rps("modal", "small.yaml", *NONE, "-o", "modes")
        rps("timehistory", "small.yaml", *NONE, "-o", "stored")
    result = rps("compare", *words)
    assert result.exit_code == 2
    assert reason in result.stderr
