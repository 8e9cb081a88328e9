"""`rps report`: pages of cases, of studies, and of folders of results."""

import base64
import json
import math
import re
from html import unescape
from pathlib import Path

import pytest
from paper_structures import python
from sweep.small_studies import ROOT

from rpscli.case.case import load_case
from rpscli.report.table import shown
from rpscli.sweep.run import Progress

from .conftest import write_case

STUDY = """\
rps: 1
title: A small study
base: small.yaml
vary: [{podium.bearing.curvature_ratio: [0.5, 0]}]
records: [{source: "synthetic:?pga=0.5g&duration=4&dt=0.02", seed: [1, 2]}]
limits: {rotation_ratio: 0.5}
reports: [overturning]
"""

DRAWING = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 2 1"/>'


@pytest.fixture(autouse=True)
def _drawings_cost_nothing(figures, monkeypatch):
    """Real figures on a page are looked at in tests/report."""
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: DRAWING)


def text_of(file):
    """The page without its tags."""
    text = Path(file).read_text(encoding="utf-8")
    text = re.sub(r"<style>.*?</style>|<svg.*?</svg>", "", text, flags=re.DOTALL)
    return " ".join(re.sub(r"<[^>]*>", " ", text).split())


def compared(text):
    """How many stored results are the same as on a page, which is all."""
    (found,) = re.findall(
        r"(\d+) of (\d+) stored results are the same to the last digit", text
    )
    assert found[0] == found[1]
    return int(found[0])


@pytest.fixture
def page(rps):
    """Write a page, on which all of these stand; its text."""

    def made(*arguments, exit_code=0, shows=()):
        rps("report", *arguments, "-o", "out.html", exit_code=exit_code)
        text = text_of("out.html")
        assert [part for part in shows if part not in text] == []
        return text

    return made


@pytest.fixture
def study(workplace):
    (workplace / "study.yaml").write_text(STUDY, encoding="utf-8")
    return "study.yaml"


def test_a_case_and_its_history_are_on_one_page(rps, rps_json):
    document = rps_json(
        "report", "small.yaml", "-o", "out.html", "--set", "limits.drift_ratio=0.9"
    )
    assert document["command"] == "report"
    assert document["files"] == ["out.html"]
    text = text_of("out.html")
    # The same numbers as those of the history itself, and how much one history says.
    history = rps_json("timehistory", "small.yaml", "-o", "history")
    assert document["max_rotation"] == history["max_rotation"]
    for part in (
        "In short", "The structure", "Input", "Derived quantities", "Ground motion",
        "superstructure.storey_height 3", "atan(0.15)", "columns never slide",
        "rps timehistory small.yaml --set limits.drift_ratio=0.9", "restitution at impact: e = ",
        f"{shown(history['max_rotation'])} rad", "ne horizontal direction at a time",
        "one history: with 1 % less or more motion", "judge by several records",
    ):  # fmt: skip
        assert part in text
    assert Path("out.html").stat().st_size < 1_000_000
    assert len(document["neighbours"]) == 7


def test_a_case_without_a_record_ends_with_statics(page):
    write_case("bare.yaml", ("record:", "# record:"))
    text = page(
        "bare.yaml", shows=("The case names no ground motion", "Derived quantities")
    )
    assert "rps timehistory" not in text


def test_limits_are_judged_and_the_page_is_there_all_the_same(page):
    limit = ("--fail-on", "rotation_ratio=1e-6")
    page("small.yaml", *limit, exit_code=10, shows=("1 of 1 limits exceeded", "EXCEEDED"))


def test_a_folder_is_computed_anew_and_compared(rps, page):
    slenderness = "podium.bearing.slenderness=0.14"
    rps("timehistory", "small.yaml", "-o", "old", "--scale", "1.2", "--set", slenderness)
    assert compared(page("old", shows=(f"--set {slenderness}", "--scale 1.2"))) > 40


def test_a_folder_whose_numbers_or_case_have_changed_says_so(rps, page):
    rps("timehistory", "small.yaml", "-o", "old")
    summary = Path("old/summary.json")
    document = json.loads(summary.read_text(encoding="utf-8"))
    summary.write_text(json.dumps(document | {"max_rotation": 0.5}), encoding="utf-8")
    write_case("small.yaml", ("0.15", "0.12"))
    found = ("Different: 1;", "max_rotation 0.5", "podium.bearing.slenderness 0.15")
    page("old", shows=("small.yaml has changed since", *found))


def changed(document, path, value):
    """The document as JSON with another value at a dotted place."""
    *above, last = path.split(".")
    place = document
    for key in above:
        place = place[key]
    place[last] = value
    return json.dumps(document)


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("inputs.overrides", 5, "overrides must be a list"),
        ("inputs.overrides", [5], "overrides[0] must be a text"),
        ("inputs.record.scale", "x", "scale must be a number"),
        ("inputs.record.scale", 10**400, "scale must be a number"),
        ("inputs.record.horizontal", ["x"], "horizontal must be a mapping"),
        ("inputs.record", None, "inputs must have a record"),
        ("inputs.case", [], "case must be a mapping"),
        ("inputs", None, "inputs must be a mapping"),
        ("file", "a\0b", "file must be a text that shows"),
        ("name", "../../x", "name must be that of a file"),
    ],
)
def test_what_a_folder_says_is_checked(rps, path, value, said):
    rps("timehistory", "small.yaml", "-o", "old", "--figures", "none")
    run = Path("old/run.json")
    run.write_text(
        changed(json.loads(run.read_text("utf-8")), path, value), encoding="utf-8"
    )
    result = rps("report", "old", "-o", "out.html", exit_code=3)
    assert (
        f"run.json: is no description of a run of rps, or is damaged: {said}"
        in result.stderr
    )
    assert not Path("out.html").exists()


@pytest.mark.parametrize(
    ("damaged", "said"),
    [
        (b'{"command": ', "the file is no JSON at line 1, column 13"),
        (b"\xff\xfe\x00", "the file is no text in UTF-8"),
        (b"[" * 100_000, "the file is nested too deeply"),
        (b"5", "the file must be a mapping"),
    ],
)
def test_a_damaged_description_is_told_in_words(rps, damaged, said):
    Path("old").mkdir()
    Path("old/run.json").write_bytes(damaged)
    told = rps("report", "old", "-o", "out.html", exit_code=3).stderr
    assert said in told
    assert "restore the file" in told


@pytest.mark.parametrize(
    "text", ["[1]", "{", "[" * 100_000, '{"max_rotation": ' + "9" * 400 + "}"]
)
def test_results_that_cannot_be_compared_are_said(rps, text):
    rps("timehistory", "small.yaml", "-o", "old", "--figures", "none")
    Path("old/summary.json").write_text(text, encoding="utf-8")
    rps("report", "old", "-o", "out.html")
    shown = text_of("out.html")
    assert "so nothing was compared" in shown or "Different: 1;" in shown


def test_the_record_of_the_command_line_is_found_again(rps, page):
    pulse = "pulse:sine?amplitude=0.2g&period=0.8"
    rps("timehistory", "small.yaml", "-o", "old", "--record", pulse)
    text = page("old")
    assert compared(text)
    assert "Different:" not in text
    assert "any more" not in text


def test_a_study_is_computed_once(rps, study, rps_json):
    first = rps(
        "report", study, "-o", "out.html", exit_code=None, says="computed 4 points"
    )
    assert first.exit_code in {0, 10}, first.stderr
    document = rps_json("report", study, "-o", "out.html", exit_code=first.exit_code)
    assert document["points"] == {
        "total": 4,
        "computed": 0,
        "kept": 4,
        "failed": 0,
        "unused": 0,
    }
    text = text_of("out.html")
    assert "The first of 2 systems: ρ = 0.5." in text
    for part in (
        "Statistics",
        "synthetic:?pga=0.5g",
        "at most 0.5 in every record",
        "rps sweep",
        "one horizontal direction at a time, not conservative",
    ):
        assert part in text
    # The folder of the study holds points that `rps sweep` goes on with, and no files of it.
    rps("sweep", study, "--report-only", "--figures", "none", exit_code=first.exit_code)
    rps("report", "results/study/sweep", "-o", "again.html", exit_code=first.exit_code)
    assert text_of("again.html").replace("again", "out")[200:400] == text[200:400]


def test_only_an_earlier_page_of_the_same_is_replaced(rps):
    Path("mine.html").write_text("my notes", encoding="utf-8")
    rps("report", "small.yaml", "-o", "mine.html", exit_code=7)
    assert Path("mine.html").read_text(encoding="utf-8") == "my notes"
    rps("report", "small.yaml", "-o", "mine.html", "--force")
    rps("report", "small.yaml", "-o", "mine.html")
    write_case("other.yaml")
    rps("report", "other.yaml", "-o", "mine.html", exit_code=7)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("old", "--set", "podium.bearing.slenderness=0.2"), "leave --set out"),
        (("old", "--scale", "2"), "a stored history has its record"),
        (("study.yaml", "--record", "x.at2"), "a study has records of its own"),
        (("empty",), "has no run.json of rps"),
        (("above",), "name one of the folders in it"),
        (("modes",), "holds results of `rps modal`"),
        (("begun",), "`rps sweep STUDY -o begun` goes on with it"),
        (("design.yaml", "--record", "x.at2"), "a design has records of its own"),
        (("design.yaml", "--fail-on", "uplift"), "limits of its own"),
        (("study.yaml", "--budget"), "--budget is about one history"),
        (
            ("small.yaml", "--set", "record=null", "--budget"),
            "--budget needs a ground motion",
        ),
    ],
)
def test_what_makes_no_page(rps, study, words, said):
    rps("timehistory", "small.yaml", "-o", "old", "--figures", "none")
    rps("timehistory", "small.yaml", "-o", "above/one", "--figures", "none")
    rps("modal", "small.yaml", "-o", "modes", "--figures", "none")
    Path("empty").mkdir()
    Path("begun").mkdir()
    Path("begun/study.sqlite").touch()
    Path("design.yaml").write_text(DESIGN, encoding="utf-8")
    rps("report", *words, exit_code=2, says=said)
    assert not list(Path().rglob("*.html"))


def test_titles_with_tags_are_harmless(rps):
    write_case("small.yaml", ("Three storeys [test]", "<script>x</script> & co"))
    rps("report", "small.yaml", "-o", "out.html")
    assert "<script" not in Path("out.html").read_text(encoding="utf-8")


def test_a_stopped_study_goes_on(rps, study, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr("rpscli.studies.run", lambda *_: Progress(9, 0, 1, 0, 1.0))
        result = rps("report", study, "-o", "out.html", exit_code=130)
    assert "the same command continues" in result.stderr
    assert not Path("out.html").exists()
    assert rps("report", study, "-o", "out.html", exit_code=None).exit_code in {0, 10}


@pytest.mark.posix
def test_a_ctrl_c_in_the_study_of_a_page_is_heard_and_the_command_goes_on(study, rps):
    """A signal of the system, in a process of its own."""
    Path(study).write_text(STUDY.replace("[1, 2]", "{low: 1, high: 18, count: 18}"))
    program = ROOT / "tests" / "sweep" / "interrupted.py"
    words = ("report", study, "-o", "out.html")
    stopped = python(str(program), *words, folder=Path.cwd(), exit_code=130)
    assert "the same command continues" in stopped.stderr
    assert not Path("out.html").exists()
    assert rps(*words, exit_code=None).exit_code in {0, 10}
    assert "A small study" in text_of("out.html")


PULSES = [f"--record=pulse:sine?amplitude={size}g&period=1" for size in (0.2, 0.3)]


def test_several_records_are_on_one_page(rps, rps_json):
    """Every record, mean and largest: the numbers of the time histories."""
    document = rps_json(
        "report", "small.yaml", *PULSES, "--scale", "1.1", "-o", "out.html"
    )
    text = text_of("out.html")
    found = rps_json("timehistory", "small.yaml", *PULSES, "--scale", "1.1", "-o", "set")
    assert document["sets"] == found["sets"]
    demands = found["sets"][0]["demands"]["rotation_ratio"]
    for name in ("mean_of_maxima", "largest"):
        assert shown(demands[name]) in text
    assert "mean of maxima" in text
    assert "Time histories under 2 records" in text
    worst = max(found["histories"], key=lambda each: each["rotation_ratio"])
    assert f"largest rotation of the columns, {worst['record']['name']}" in text
    assert "--scale 1.1" in text
    # The folder of these makes the same page, and knows that it is the same.
    rps("report", "set", "-o", "again.html")
    again = text_of("again.html")
    assert compared(again) > 4
    typed = " ".join(f"--record '{pulse.removeprefix('--record=')}'" for pulse in PULSES)
    assert f"rps timehistory small.yaml {typed} --scale 1.1 rps report set" in unescape(
        again
    )


def test_verdicts_come_first_then_one_table_in_the_units_of_the_limits(rps, rps_json):
    """Results with limits, then main ones; each record by one name."""
    limits = "limits={max_lift: 30 cm, drift_ratio: 0.9}"
    given = ("small.yaml", *PULSES, "--set", limits)
    document = rps_json("report", *given, "-o", "out.html")
    text = text_of("out.html")
    labels = document["sets"][0]["records"]
    heads = "record lift of the building cm drift ratio rotation ratio cap beam"
    assert text.index("All 3 limits are met") < text.index("at most 30 cm in every")
    assert text.index("at most 30 cm in every") < text.index(heads)
    for label, history in zip(labels, document["histories"], strict=True):
        lift = shown(100.0 * history["max_lift"])
        ratio = shown(history["drift_ratio"])
        assert f"{label} survived {lift} {ratio}" in text
    assert f"{labels[0]} {PULSES[0].removeprefix('--record=')}" in unescape(text)
    moved = max(each["max_cap_beam_displacement"] for each in document["histories"])
    assert f"cap beam displacement {shown(1e3 * moved)} mm" in text


def file_of(page):
    """The case that a page holds as a file."""
    html = Path(page).read_text(encoding="utf-8")
    (found,) = re.findall(r'href="data:text/plain;charset=utf-8;base64,([^"]*)"', html)
    return base64.b64decode(found)


@pytest.mark.parametrize("title", ["A <b>", "1e5", "on", "0o17", "a: b # c"])
def test_the_case_on_a_page_is_a_file_with_what_was_overridden(rps, title):
    changed = ("--set", "podium.bearing.slenderness=0.14", "--set", f"title='{title}'")
    rps("report", "small.yaml", *changed, "-o", "out.html")
    Path("copy.yaml").write_bytes(file_of("out.html"))
    assert (
        load_case("copy.yaml").document == load_case("small.yaml", changed[1::2]).document
    )
    # That of a folder is the case as it was then.
    rps("timehistory", "small.yaml", *changed, "-o", "old", "--figures", "none")
    rps("report", "old", "-o", "again.html")
    Path("copy.yaml").write_bytes(file_of("again.html"))
    assert (
        load_case("copy.yaml").document == load_case("small.yaml", changed[1::2]).document
    )


def test_the_mean_as_a_criterion_stands_on_pages(rps, study):
    """Of several records, and of a study of two, whose largest is judged."""
    rule = "limits={drift_ratio: {at_most: 0.5, of: mean}}"
    pulses = [f"pulse:half_sine?amplitude=0.{n}g&period=0.6" for n in range(1, 8)]
    asked = [word for pulse in pulses for word in ("--record", pulse)]
    rps("report", "small.yaml", *asked, "--set", rule, "-o", "set.html")
    text = text_of("set.html")
    assert "at most 0.5 in the mean" in text
    assert "mean 0.0" in text
    rps("report", "study.yaml", "--set", rule, "-o", "study.html")
    text = text_of("study.html")
    assert "at most 0.5 in the mean" in text
    assert "judged in place of the mean: fewer than 7 recordings (EN 1998-1)" in text


def test_what_moves_the_worst_history_stands_on_its_page(rps, rps_json, monkeypatch):
    """As `rps budget` tells it of the record that turns the columns most."""
    write_case("small.yaml", more="limits: {rotation_ratio: 0.2}\n")
    weak, strong = (f"pulse:sine?amplitude=0.{peak}g&period=0.8" for peak in (2, 4))
    given = ("--record", weak, "--record", strong)
    rps("report", "small.yaml", *given, "--budget", "-o", "out.html", exit_code=10)
    found = rps_json("budget", "small.yaml", *given[2:], *given[:2], "--figures", "none")
    text = text_of("out.html")
    assert "What moves the results under sine_T0.8s_a0.4g" in text
    for result in found["results"]:
        assert result["sentences"] in text
    assert re.search(r"rps report small.yaml --record '.*0.2g.*0.4g.*' --budget", text)
    rps("report", "small.yaml", *given, "-o", "plain.html", exit_code=10)
    assert "What moves" not in text_of("plain.html")

    # A folder is asked like the case that it came from.
    monkeypatch.setattr("rpscli.tools.budget.command._records", lambda *_: ())
    rps(
        "timehistory",
        "small.yaml",
        *given[2:],
        "-o",
        "old",
        "--figures",
        "none",
        exit_code=10,
    )
    rps("report", "old", "--budget", "-o", "old.html", exit_code=10)
    of_case = rps_json("budget", "small.yaml", *given[2:], "--figures", "none")
    assert of_case["results"][1]["sentences"] in text_of("old.html")


def test_values_stand_as_they_were_written(rps):
    rps(
        "report",
        "small.yaml",
        "-o",
        "out.html",
        "--set",
        "superstructure.storey_mass=210 t",
    )
    assert "superstructure.storey_mass 210 t 210000" in text_of("out.html")
    rps(
        "timehistory",
        "small.yaml",
        "-o",
        "old",
        "--set",
        "superstructure.storey_mass=210 t",
    )
    rps("report", "old", "-o", "again.html")
    assert "superstructure.storey_mass 210000" in text_of("again.html")


def test_whoever_signs_is_named_or_signs_on_paper(rps):
    rps(
        "report",
        "small.yaml",
        "-o",
        "out.html",
        "--project",
        "17 <b>",
        "--checker",
        "C. Hecker",
    )
    text = text_of("out.html")
    assert "project 17 &lt;b&gt; made by date, signature: checked by C. Hecker" in text
    assert 'class="signed"' in Path("out.html").read_text(encoding="utf-8")
    own = "document={project: '18', author: A. Uthor, checker: C}"
    rps("report", "small.yaml", "-o", "own.html", "--set", own, "--checker", "D")
    assert "project 18 made by A. Uthor date, signature: checked by D" in text_of(
        "own.html"
    )
    rps("report", "small.yaml", "-o", "bare.html")
    assert 'class="signed paper"' in Path("bare.html").read_text(encoding="utf-8")


DESIGN = """\
rps: 1
title: A small design
base: small.yaml
variables: {podium.bearing.semi_diagonal: [1.0, 2.0]}
minimise: podium.bearing.semi_diagonal
records: [{source: "synthetic:?pga=0.5g&duration=4&dt=0.02", seed: [1, 2, 3, 4]}]
limits: {rotation_ratio: 0.9}
search: {first: 4, most: 8}
validate: {share: 0.25}
"""


SOFT = ("--set", "podium.impact.factor=0.5")
"""A restitution below 0.5, so that what half of the loss makes of the design is shown."""


def test_a_design_has_a_page(rps):
    Path("design.yaml").write_text(DESIGN, encoding="utf-8")
    result = rps(
        "report", "design.yaml", "-o", "out.html", "--json", *SOFT, exit_code=None
    )
    document = json.loads(result.stdout)
    text = text_of("out.html")
    assert f"Design: {document['designs']['looked_at']} examined" in text
    assert "rps design design.yaml --set podium.impact.factor=0.5" in text
    value = f"{document['best']['values']['podium.bearing.semi_diagonal']:.10g}"
    assert f"podium.bearing.semi_diagonal {value} {value} m" in text
    (verdict,) = document["requirements"]
    assert verdict["counted"] == 3  # one is held back
    rps("design", "design.yaml", "--figures", "none", *SOFT, exit_code=result.exit_code)
    rps("report", "results/design/design", "-o", "again.html", exit_code=result.exit_code)
    assert "A small design" in text_of("again.html")


def test_a_page_of_both_components_has_what_they_assume(workplace, page):
    """As the terminal has it."""
    time = [0.01 * i for i in range(101)]
    for name, size in (("x", 3.0), ("y", 2.0)):
        rows = (f"{t:.2f},{size * math.sin(8.0 * t):.6f}" for t in time)
        text = "\n".join(["time [s],acceleration [m/s2]", *rows])
        (workplace / f"{name}.csv").write_text(text, encoding="utf-8")
    page(
        "small.yaml",
        "--record",
        "x.csv?second=y.csv&both",
        shows=["columns are taken as round", "near upright"],
    )


def test_a_page_in_russian_has_the_same_numbers(rps, workplace):
    words = ("report", "small.yaml", "--record", "pulse:sine?amplitude=0.3g&period=0.8")
    rps(*words, "-o", "en.html")
    rps(*words, "--set", "document.language=ru", "-o", "ru.html")
    english, russian = (text_of(f"{name}.html") for name in ("en", "ru"))
    assert "Производные величины" in russian
    assert "критический угол наклона" in russian
    numbers = re.compile(
        r"\d+\.\d+(?:e[-+]\d+)?"
    )  # of results; times of making have none

    def found(text):
        return sorted(numbers.findall(text.replace("document.language", "")))

    assert found(russian) == found(english)
    rps(
        "check",
        "small.yaml",
        "--set",
        "document.language=de",
        exit_code=3,
        says="must be en or ru",
    )
