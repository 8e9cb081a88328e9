"""rps record: look, draw, convert, make."""

from pathlib import Path

import numpy as np
import pytest
from paper_structures import known

import rpscli
from rpscli.records.loading import expand_sources, load_components, load_record
from rpscli.records.measures import intensity_measures

NOISE = "synthetic:?pga=0.3g&seed=5&duration=8"
SINE = "pulse:sine?amplitude=0.3g&period=1"


def test_info(rps_json, rps):
    document = rps_json("record", "info", NOISE)
    motion = load_record(NOISE)
    measures = intensity_measures(motion)
    for key in ("pga", "pgv", "pgd", "arias", "cav", "d5_95"):
        assert document[key] == getattr(measures, key)
    for key in ("source", "format", "npts", "dt", "duration"):
        assert document[key] == getattr(motion, key)
    table = rps("record", "info", NOISE).stdout
    assert "m/s2 = 0.3000 g" in table


def test_a_file_that_states_neither_step_nor_unit(rps, rps_json):
    Path("bare.txt").write_text("0.0\n0.1\n-0.2\n0.05\n", encoding="utf-8")
    rps("record", "info", "bare.txt", exit_code=3)
    document = rps_json("record", "info", "bare.txt", "--dt", "0.02", "--units", "g")
    assert document["pga"] == pytest.approx(0.2 * 9.80665, rel=1e-12)
    assert document["duration"] == pytest.approx(0.06, rel=1e-12)


def test_both_components_are_told_drawn_and_written(rps, rps_json):
    """What is written is a pair again; turned by 90 deg, what acted along x acts along y."""
    for name, seed in (("a.txt", 6), ("b.txt", 7)):
        rps("record", "convert", NOISE.replace("seed=5", f"seed={seed}"), "-o", name)
    source = "a.txt?second=b.txt&both&rotation=90"
    told = rps_json("record", "info", source, "--scale", "2")
    along, across = -load_record("b.txt").acceleration, load_record("a.txt").acceleration
    peaks = [2.0 * np.abs(values).max() for values in (along, across)]
    assert [told["pga"], told["y"]["pga"]] == peaks
    drawn = rps_json("record", "plot", source, "-o", "drawn", "--figures", "none")
    assert sorted(Path(file).name for file in drawn["files"]) == [
        "run.json", "x_record.csv", "x_spectrum.csv", "y_record.csv", "y_spectrum.csv"
    ]  # fmt: skip
    written = rps_json("record", "convert", source, "-o", "both", "--resample", "0.005")
    names = sorted(Path(file).name for file in written["files"])
    assert names == ["a_90deg_x.at2", "a_90deg_y.at2", "run.json"]
    (again,) = expand_sources(["both?both"])
    pair = load_components(again)
    for values, read in ((along, pair.horizontal), (across, known(pair.y))):
        # AT2 has seven digits of g
        np.testing.assert_allclose(
            read.acceleration[: 2 * len(values) : 2], values, atol=2e-6
        )
    rps("record", "convert", source, "-o", "both.at2", exit_code=2, says="name a folder")


@pytest.mark.usefixtures("figures")
def test_plot(rps_json):
    document = rps_json("record", "plot", NOISE, "-o", "drawn")
    assert sorted(Path(file).name for file in document["files"]) == [
        "record.csv", "record.png", "run.json", "spectrum.csv"
    ]  # fmt: skip
    spectrum = Path("drawn/spectrum.csv").read_text(encoding="utf-8").splitlines()
    assert spectrum[0] == (
        "period [s],pseudo_acceleration [m/s2],total_acceleration [m/s2],displacement [m]"
    )
    at_zero = [float(cell) for cell in spectrum[1].split(",")]
    assert at_zero[:2] == pytest.approx([0.0, document["pga"]], rel=1e-9)
    head = Path("drawn/record.csv").read_text(encoding="utf-8").partition("\n")[0]
    assert head == "time [s],acceleration [m/s2],velocity [m/s],displacement [m]"


@pytest.mark.parametrize(
    ("options", "file", "digits"),
    [
        (["--to", "at2"], "results/{name}/record_convert/{name}.at2", 1e-7),
        (["--to", "text"], "results/{name}/record_convert/{name}.txt", 1e-8),
        (["-o", "there.AT2"], "there.AT2", 1e-7),
        (["-o", "there.txt"], "there.txt", 1e-8),
        (["-o", "folder", "--to", "text"], "folder/{name}.txt", 1e-8),
    ],
)
def test_a_converted_record_is_the_same_record(rps_json, options, file, digits):
    document = rps_json("record", "convert", NOISE, *options)
    path = file.format(name=document["name"])
    assert str(Path(path)) in document["files"]
    before, after = load_record(NOISE), load_record(path)
    assert (after.npts, after.dt) == (before.npts, before.dt)
    assert np.abs(after.acceleration - before.acceleration).max() <= digits * before.pga


def test_a_scaled_conversion(rps):
    rps("record", "convert", SINE, "--scale", "2", "-o", "twice.at2")
    assert load_record("twice.at2").pga == pytest.approx(
        2.0 * load_record(SINE).pga, rel=1e-7
    )


def test_a_file_is_not_overwritten(rps):
    Path("mine.at2").write_text("precious", encoding="utf-8")
    rps("record", "convert", SINE, "-o", "mine.at2", exit_code=7, says="--force")
    assert Path("mine.at2").read_text(encoding="utf-8") == "precious"
    rps("record", "convert", SINE, "-o", "mine.at2", "--force")
    assert load_record("mine.at2").npts == load_record(SINE).npts


def test_synth_says_that_nobody_recorded_it(rps):
    rps("record", "synth", NOISE, "-o", "made.at2")
    assert "SYNTHETIC, NOT A RECORDING" in Path("made.at2").read_text(encoding="utf-8")
    rps("record", "synth", "made.at2", exit_code=2, says="convert")


SELECT = (
    "record",
    "select",
    "--target",
    "en1998:?ag=0.2g&soil=B",
    "--per-event",
    "1",
    "-n",
    "2",
)


def test_select(rps_json, rps):
    Path("pool").mkdir()
    for seed in (1, 2, 3, 4):
        synthetic = f"synthetic:?pga=0.2g&seed={seed}&duration=6"
        rps("record", "synth", synthetic, "-o", f"pool/m{seed}.at2")
    few = ("--rules", "mean90", "--periods", "0.2", "1.5")
    document = rps_json(*SELECT, "pool", "-o", "made/inside", *few)
    assert len(document["motions"]) == 2
    assert (document["component"], document["clamped"]) == ("component", 0)
    assert [rule["verdict"] for rule in document["requirements"]["rules"]] == [
        "met",
        "met",
    ]
    assert document["least_ratio"] >= 0.9
    assert document["candidates"] == 4
    assert document["target"]["pgd"] == pytest.approx(0.025 * 0.24 * 9.80665 * 0.5 * 2.0)
    assert {Path(file).name for file in document["files"]} >= {
        "selection.txt", "selection.csv", "spectra.csv", "selection.png",
    }  # fmt: skip
    first = document["motions"][0]
    (scaled, _) = expand_sources(["list:made/inside/selection.txt"])
    measures = intensity_measures(load_record(scaled))
    assert measures.pgv == pytest.approx(first["pgv"], rel=1e-9)
    assert measures.pgd == pytest.approx(first["pgd"], rel=1e-9)
    # What has a factor already has one in the end, not two.
    document = rps_json(*SELECT, "list:made/inside/selection.txt", "-o", "again", *few)
    (again, _) = expand_sources(["list:again/selection.txt"])
    assert again.count("factor=") == 1
    pgv = intensity_measures(load_record(again)).pgv
    assert pgv == pytest.approx(document["motions"][0]["pgv"], rel=1e-5)  # six digits
    # EN 1998-1 asks for three.
    made = rps(*SELECT, "pool", "-o", "made/inside", exit_code=10)
    said = " ".join(made.stdout.split())
    assert "Sa(T1) is a poor measure for rocking" in said
    assert "number of motions >= 3 2 NOT MET" in said
    assert "not met: number of motions, 2; required >= 3" in made.stderr
    by_pgv = rps_json(
        *SELECT,
        "pool",
        "-o",
        "made/inside",
        "--scale-by",
        "PGV",
        "--pgv",
        "0.2",
        "--rules",
        "none",
    )
    assert by_pgv["mean_pgv"] == pytest.approx(0.2, rel=1e-5)
    assert by_pgv["requirements"] is None


def test_select_for_a_case(rps_json, rps):
    """From 0.2 T1 to the secant period of M u/F at the limit; candidates by their duration."""
    Path("pool").mkdir()
    for seed, duration in enumerate((6, 6, 20)):
        synthetic = f"synthetic:?pga=0.2g&seed={seed}&duration={duration}"
        rps("record", "synth", synthetic, "-o", f"pool/m{seed}.at2")
    case = Path("case.yaml")
    rps("init", str(case))
    longest = max(
        intensity_measures(load_record(s)).d5_95 for s in expand_sources(["pool"])
    )
    shorter = f"d5_95=..{longest - 0.01} s"
    document = rps_json(
        *SELECT, "pool", "--case", str(case), "--rules", "none", "--where", shorter
    )
    assert document["left_out"] == {shorter: {"outside": 1, "not_known": 0}}
    structure = rpscli.load_case(str(case)).structure
    curve = rpscli.pushover(structure, points=2001).curve
    limit = 0.5 * structure.critical_rotation  # limits.rotation_ratio
    force = np.interp(limit, curve.rotation, curve.force)
    displacement = np.interp(limit, curve.rotation, curve.displacement)
    mass = structure.weight / 9.80665
    secant = 2.0 * np.pi * np.sqrt(mass * displacement / force)
    first = 0.2 * known(structure.superstructure).periods[0]
    assert document["periods"] == pytest.approx([first, min(secant, 4.0)], rel=1e-5)
    period = "superstructure.period=0.2"
    more = ("--case", str(case), "--rules", "none", "--set", period, "-o", "other")
    other = rps_json(*SELECT, "pool", *more)
    assert other["periods"][0] == pytest.approx(0.04, rel=1e-5)
