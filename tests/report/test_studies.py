"""Studies from Python: the same numbers and files as those of `rps sweep`."""

import json
import runpy
from pathlib import Path
from shutil import rmtree

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure

import rpscli
from rpscli.cli import program
from rpscli.sweep.store import Store

ROOT = Path(__file__).parents[2]
LARGEST = "largest"

SMALL = {
    "rps": 1,
    "title": "A small study",
    "base": str(ROOT / "cases" / "six_storey.yaml"),
    "vary": [
        {"podium.bearing.curvature_ratio": ["critical", 0.5]},
        {"superstructure.storey_mass": ["200 t", "250 t"]},
    ],
    "records": [{"source": "synthetic:?pga=0.5g&duration=4&dt=0.02", "seed": [1, 2, 3]}],
    "scale": [0.5, 1.0],
    "limits": {"rotation_ratio": 0.01},
    "reports": [
        "overturning",
        {
            "lines": {
                "x": "scale",
                "y": "rotation_ratio",
                "series": "record",
                "statistic": LARGEST,
            }
        },
    ],
}


@pytest.fixture(scope="module")
def result():
    return rpscli.load_study(SMALL).run(jobs=1)


def points(study):
    return [(p.values, p.record and p.record.source, p.scale) for p in study.layout]


def test_a_mapping_and_a_file_say_the_same(tmp_path):
    file = tmp_path / "small.yaml"
    file.write_text(json.dumps(SMALL), encoding="utf-8")
    one, other = rpscli.load_study(SMALL), rpscli.load_study(file)
    assert points(one) == points(other)
    assert (len(one), one.title) == (len(other), other.title) == (24, "A small study")
    assert list(one.reports) == ["overturning", "lines"]
    arrays = SMALL | {"scale": np.array([0.5, 1.0])}
    assert points(rpscli.load_study(arrays)) == points(one)
    assert len(rpscli.load_study(SMALL, ["scale=[1]"])) == 12


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"vari": []}, "<study>: vari is not a key of the format; did you mean vary?"),
        ({"vary": [{"podium.bearing.slendernes": [1, 2]}]}, "slendernes"),
        ({"limits": {"max_stop_force": 1.0}}, "max_stop_force needs a stop"),
        ({"reports": ["overturned"]}, "overturned"),
        (
            {"reports": [{"scatter": {"x": "PGW", "y": "superstructure.storey_mass"}}]},
            "x = PGW is no demand, no measure and no varied number; did you mean PGV?",
        ),
    ],
)
def test_what_is_wrong_is_told(change, says):
    with pytest.raises(rpscli.RpsError, match=says.replace("?", r"\?")):
        rpscli.load_study(SMALL | change)


def test_what_a_report_draws_is_its_result():
    """The words of before are understood: `demand` of `ida`, and `y` of `lines`."""
    words = {"ida": ("demand", {}), "lines": ("y", {"x": "scale"})}
    for kind, (before, others) in words.items():
        for word in ("result", before):
            reports = [{kind: {**others, word: "max_base_shear"}}]
            change = {
                "scale": {"measure": "PGV", "values": [0.1, 0.2]},
                "reports": reports,
            }
            (request,) = rpscli.load_study(SMALL | change).reports.values()
            options = request.options
            assert "max_base_shear" in options.result


def test_columns_are_those_of_the_points(result):
    columns = result.columns
    assert {len(column) for column in columns.values()} == {24}
    assert list(columns)[:5] == [
        "podium.bearing.curvature_ratio", "superstructure.storey_mass", "system", "record", "scale"
    ]  # fmt: skip
    assert (
        result["podium.bearing.curvature_ratio"].tolist()
        == ["critical"] * 12 + [0.5] * 12
    )
    assert (
        result["superstructure.storey_mass"].tolist() == ([200e3] * 6 + [250e3] * 6) * 2
    )
    assert result["scale"].tolist() == [0.5, 1.0] * 12
    assert result.units["superstructure.storey_mass"] == "kg"
    assert set(result.units) == set(columns)
    number = 23
    point = result.study.layout[number]
    one = rpscli.demand(
        result.study.layout.system(point.system).structure,
        rpscli.load_record(result["record"][number]).scaled(1.0),
    )
    assert result["max_rotation"][number] == one.max_rotation
    with pytest.raises(KeyError, match=r"did you mean max_rotation\?"):
        result["max_rotatoin"]


def test_pandas_takes_the_columns(result):
    pytest.importorskip("pandas")
    frame = result.to_dataframe()
    assert list(frame.columns) == list(result.columns)
    assert len(frame) == 24
    means = frame.groupby("scale")["rotation_ratio"].mean()
    wanted = [
        result["rotation_ratio"][result["scale"] == scale].mean() for scale in (0.5, 1.0)
    ]
    np.testing.assert_allclose(means.to_numpy(), wanted, rtol=1e-14)


def test_the_files_are_those_of_the_command(result, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("study.yaml").write_text(json.dumps(SMALL), encoding="utf-8")
    swept = CliRunner().invoke(program, ["sweep", "study.yaml", "-o", "swept", "-q"])
    assert swept.exit_code == 10, swept.output
    files = [Path(file) for file in result.write("written")]
    again = []
    rpscli.load_study("study.yaml").run("swept", progress=again.append)
    assert again == []  # the command has computed them all
    names = {file.name for file in files}
    assert names | {"study.sqlite", "base.yaml"} >= {
        file.name for file in Path("swept").iterdir()
    }
    for name in names - {"run.json"}:
        written = Path("written", name).read_bytes()
        assert written == Path("swept", name).read_bytes(), name
    assert not result.passed
    assert result.verdicts["exceeded"].any()
    # without figures none is drawn
    assert not any(file.endswith("png") for file in result.write("plain", figures=()))


def test_references_take_no_more_threads_than_asked(monkeypatch):
    asked = []

    def references(*given):
        asked.append(given[-1])
        return {}

    monkeypatch.setattr("rpscli.sweep.table.fixed_base_references", references)
    _ = rpscli.load_study(SMALL | {"scale": [0.1], "vary": []}).run(jobs=1).statistics
    assert asked == [1]


def test_a_run_goes_on_where_another_ended(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = rpscli.load_study(SMALL)
    done = []

    def stop(progress):
        done.append(progress.done)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study.run("here", jobs=1, progress=stop)
    assert 0 < done[0] <= 24
    kept = []
    whole = study.run(
        "here", jobs=2, progress=lambda progress: kept.append(progress.kept)
    )
    assert set(kept) <= {done[0]}
    again = []
    rpscli.load_study(SMALL).run("here", progress=again.append)
    assert again == []  # nothing was left to compute
    alone = study.run("there", jobs=1)
    for name, column in whole.columns.items():
        np.testing.assert_array_equal(column, alone.columns[name])


def test_folders_of_others_are_left_alone(result, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = result.study
    Path("taken").mkdir()
    Path("taken", "run.json").write_text("{}", encoding="utf-8")
    with pytest.raises(rpscli.RpsError, match="not a description of a run of rps"):
        study.run("taken")
    assert not Path("taken", "study.sqlite").exists()
    Path("here").mkdir()
    with Store(Path("here")), pytest.raises(rpscli.RpsError, match="in use"):
        study.run("here")
    with pytest.raises(rpscli.RpsError, match="name a folder"):
        result.write()


def test_a_store_that_is_gone_is_not_made_anew(tmp_path):
    result = rpscli.load_study(SMALL).run(tmp_path / "gone", jobs=1)
    rmtree(tmp_path / "gone")
    with pytest.raises(rpscli.RpsError, match="no longer exists; run the study again"):
        _ = result.statistics
    assert not (tmp_path / "gone").exists()


def test_a_temporary_store_ends_with_its_result():
    study = rpscli.load_study(SMALL | {"scale": [0.1], "vary": []})
    result = study.run(jobs=1)
    folder = result.folder
    assert (folder / "study.sqlite").is_file()
    del result
    assert not folder.exists()


@pytest.mark.parametrize("name", ["overturning", "lines"])
def test_reports_are_drawn_into_figures_and_axes(result, name):
    own = result.draw(name)
    assert isinstance(own, Figure)
    assert own.get_suptitle().startswith("A small study")
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    left, right = figure.subfigures(1, 2, squeeze=False)[0]
    assert result.draw(name, right) is right
    assert right.axes
    assert not left.axes
    figure = Figure(layout="constrained")
    one, two = figure.subplots(1, 2)
    part = result.draw(name, two)
    assert part in figure.subfigs
    assert figure.axes[0] is one
    assert two not in figure.axes
    assert len(part.axes) == len(own.axes)
    figure.draw_without_rendering()
    plain = Figure(figsize=(6.0, 5.0))
    result.draw(name, plain)
    assert plain.get_size_inches().tolist() == [6.0, 5.0]


def test_what_cannot_be_drawn_is_told(result):
    with pytest.raises(
        rpscli.RpsError, match="demand is not a report of the study; it has over"
    ):
        result.draw("demand")
    loose = Figure().add_axes((0.1, 0.1, 0.8, 0.8))
    with pytest.raises(rpscli.RpsError, match="no subplot"):
        result.draw("overturning", loose)


def test_what_must_be_read_is_told(result):
    odd = rpscli.load_study(
        SMALL | {"scale": [9.0]}, ["podium.bearing.semi_diagonal=150"]
    )
    assert any("150" in text or "m high" in text for text in odd.warnings), odd.warnings
    pooled = SMALL | {
        "scale": [9.0],
        "reports": [
            {"overturning": {"columns": [], "rows": ["podium.bearing.curvature_ratio"]}}
        ],
    }
    assert result.study.warnings == []
    assert any(
        "beyond the usual" in note for note in rpscli.load_study(pooled).run().notes
    )


def test_tables_of_many_values_draw_the_first_and_hold_all(tmp_path):
    values = [round(0.2 + 0.005 * k, 3) for k in range(112)]
    vary = [
        {"superstructure.storey_mass": ["200 t"]},
        {"podium.bearing.curvature_ratio": values},
    ]
    record = {"source": "synthetic:?pga=0.5g&duration=1&dt=0.02", "seed": [1]}
    study = {
        "rps": 1,
        "title": "Many",
        "base": SMALL["base"],
        "vary": vary,
        "records": [record],
    }
    found = rpscli.load_study(study | {"reports": ["overturning"]}).run(jobs=1)
    target = Figure(figsize=(2.0, 3.0))  # names alone are wider
    assert not found.failures
    found.draw("overturning", target)
    assert len(target.axes[0].get_xticks()) == 1
    assert len(found.draw("overturning").axes[0].get_xticks()) == 9
    shares = [
        column
        for column in found.report("overturning").tables[""]
        if ";" not in column.name
    ]
    assert len(shares) == 1 + 112 + 2
    assert str(tmp_path / "overturning.png") in found.write(tmp_path)


def test_studies_without_histories_have_no_statistics():
    vary = [{"superstructure.period": [0.3, 0.6]}]
    study = {"rps": 1, "analysis": "modal", "base": SMALL["base"], "vary": vary}
    result = rpscli.load_study(study).run()
    assert result.passed
    assert "fixed_base.periods.0" in result.columns
    np.testing.assert_allclose(result["fixed_base.periods.0"], [0.3, 0.6], rtol=1e-12)
    with pytest.raises(rpscli.RpsError, match="timehistory"):
        _ = result.statistics


def test_they_show_themselves_in_a_line(result):
    assert repr(result.study).startswith(
        "Study(title=A small study, points=24, systems=4, "
    )
    assert repr(result).startswith(
        "StudyResult(title=A small study, points=24, survived="
    )
    assert "<td>A small study</td>" in result._repr_html_()


def test_changes_of_the_impact_law_are_mapped(tmp_path):
    """By a script beside the study: the median of what stood twice, and who overturned."""
    variables = runpy.run_path(str(ROOT / "cases/studies/impact_law/changes.py"))
    heads = [
        variables[name] for name in ("ENDS", "STOREYS", "PERIOD", "SLENDERNESS", "MASSES")
    ]
    heads += [variables["LAW"], "outcome [-]", *variables["RESULTS"]]
    rows = [
        ["0.5", "3", "0.3", "0.1", "3", law, end, str(rotation), "2"]
        for law, rotations in {
            "flexible": (1.0, 2.0, 4.0),
            "rigid": (1.5, 4.0, 4.0),
        }.items()
        for rotation, end in zip(
            rotations, ("survived", "survived", f"{law} stood"), strict=True
        )
    ]
    rows[-1][6] = "overturned_rocking"
    (tmp_path / "points.csv").write_text(
        "\n".join(",".join(row) for row in [heads, *rows]) + "\n"
    )
    variables["main"](tmp_path)
    assert (tmp_path / "changes.png").is_file()
    pairs = [
        (
            (
                row[6].startswith("over"),
                {n: float(row[7 + i]) for i, n in enumerate(heads[7:])},
            )
        )
        for row in rows
    ]
    assert variables["changes"](list(zip(pairs[:3], pairs[3:], strict=True))) == [
        75.0, 0.0, pytest.approx(100.0 / 3.0)
    ]  # fmt: skip


def test_many_systems_print_few_lines(tmp_path, monkeypatch):
    """What limits and reports ask for, verdicts once; the rest with `--all`."""
    monkeypatch.chdir(tmp_path)
    alphas = [0.10, 0.12, 0.15]
    vary = [
        {"podium.bearing.slenderness": alphas},
        {"podium.bearing.curvature_ratio": [0.4, 0.5]},
    ]
    vary.append({"superstructure.period": [0.4, 0.5, 0.6]})
    study = SMALL | {
        "vary": vary,
        "limits": {"rotation_ratio": 1e-3},
        "reports": ["overturning"],
    }
    records = ["synthetic:?pga=0.5g&duration=2&dt=0.02&seed=1"]
    study |= {"records": records, "scale": [0.5, 0.6, 0.7, 0.8]}
    (tmp_path / "many.yaml").write_text(json.dumps(study), encoding="utf-8")
    words = ["sweep", "many.yaml", "--figures", "none"]
    short, whole = (
        CliRunner().invoke(program, [*words, *more]) for more in ([], ["--all"])
    )
    assert short.exit_code == whole.exit_code == 10, short.stderr
    assert short.stdout.count("\n") <= 60 < whole.stdout.count("\n")
    assert whole.stdout.count("EXCEEDED") == 72 > short.stdout.count("EXCEEDED") > 3
    counted = next(line for line in short.stdout.splitlines() if "at most 0.001" in line)
    assert counted.split()[-3:] == ["72", "0", "0"]
    assert "rows are shown; all are in the CSV files; --all prints them" in short.stdout
    assert "base shear" in whole.stdout
    assert "base shear" not in short.stdout  # nothing asks for it
    assert short.stderr.splitlines()[-1] == "error: 72 of 72 limits exceeded."


def test_what_was_asked_is_printed_whole_and_verdicts_are_counted_once(
    tmp_path, monkeypatch
):
    """24 fragilities, one of each system: all of them, before rows of verdicts."""
    monkeypatch.chdir(tmp_path)
    alphas = [round(0.1 + 0.005 * n, 3) for n in range(12)]
    study = SMALL | {
        "vary": [
            {"podium.bearing.slenderness": alphas},
            {"podium.bearing.curvature_ratio": [0.4, 0.5]},
        ],
        "limits": {"rotation_ratio": 1e-3, "drift_ratio": 1e-6},
        "reports": [{"fragility": {"resamples": 0}}],
        "records": ["synthetic:?pga=0.5g&duration=2&dt=0.02&seed=1"],
        "scale": {"measure": "PGA", "values": ["0.2 g", "1.2 g", "2 g"]},
    }
    (tmp_path / "many.yaml").write_text(json.dumps(study), encoding="utf-8")
    words = ["sweep", "many.yaml", "--figures", "none"]
    done = CliRunner().invoke(program, words)
    assert done.exit_code == 10, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) <= 60
    assert sum("overturning" in line for line in lines) == 24
    assert sum("at most 0.001" in line for line in lines) == 1
    reports = [{"fragility": {"resamples": 0, "name": name}} for name in "abcd"]
    again = json.dumps(study | {"reports": reports})
    (tmp_path / "many.yaml").write_text(again, encoding="utf-8")
    several = CliRunner().invoke(program, words).stdout
    assert several.count("\n") <= 60
    printed = [name for name in "abcd" if f"\n{name}\n" in several]
    assert 1 < len(printed) < 4
    assert several.count("overturning") >= 4 * len(printed)
    assert "d: d.csv; --all prints them" in several
