"""Tutorials: what they have a reader type runs in its order, and prints what they show."""

import math
import re

import pytest
import shown_commands as docs
from paper_structures import needs_compiled_kernels
from test_readme import at

from rpscli.case.case import load_case

FOLDER = docs.PACKAGE / "tutorials"
PAGES = sorted(FOLDER.glob("*.md"))
NEEDED = {"figure": 8, "verdict": 9}
"""Lines of output that each shows, at least."""


def saved(page, folder):
    """The files that a reader saves."""
    for block in docs.blocks(page):
        name = re.match(r"# (\S+\.yaml)\n", block.text)
        if block.language == "yaml":
            assert name, "a file begins with its name"
            (folder / name[1]).write_text(block.text, encoding="utf-8")


@needs_compiled_kernels
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_of_tutorials_run_and_print_what_is_shown(page, tmp_path, monkeypatch):
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"<svg/>")
    saved(page, at(tmp_path, monkeypatch))
    outputs = docs.run_all(docs.rps_lines(page))
    shown = docs.shown_outputs(docs.blocks(page))
    lines = 0
    for line, text in shown:
        assert docs.not_printed(text, outputs[line]) == []
        lines += len(text.splitlines())
    assert lines >= NEEDED[page.stem]


def test_there_are_both():
    assert {page.stem for page in PAGES} == set(NEEDED)


def test_hand_checks_of_the_verdict(tmp_path):
    """Each from the sizes on the drawing, beside what the program has."""
    page = FOLDER / "verdict.md"
    saved(page, tmp_path)
    structure = load_case(tmp_path / "drawing.yaml").structure
    g, tan_alpha, tan_wedge, rho = 9.80665, 360 / 2400, 720 / 2400, 1300 / 2400
    weight = (720 + 240 + 24 / 2) * g
    sin_beta = (tan_wedge - tan_alpha) / (2.0 * rho)
    cos_beta = math.sqrt(1.0 - sin_beta**2)
    theta = math.atan(tan_wedge / (1.0 - 2.0 * rho * (1.0 - cos_beta)))
    docs.told(page, "9.80665 m/s2 * 0.15 =", 720 * g * tan_alpha)
    docs.told(page, "24/2) t * 9.80665 m/s2 =", weight)
    docs.told(page, "`cos(beta) =", cos_beta)
    docs.told(page, "0.00963)) =", theta)
    assert structure.uplift_force == pytest.approx(1e3 * weight * tan_alpha, rel=1e-12)
    assert structure.static_base_shear == pytest.approx(720e3 * g * tan_alpha, rel=1e-12)
    assert structure.critical_rotation == pytest.approx(theta, rel=1e-9)


def test_hand_checks_of_the_figure(tmp_path):
    page = FOLDER / "figure.md"
    saved(page, tmp_path)
    structure = load_case(tmp_path / "frame.yaml").structure
    docs.told(page, "600 t * 9.80665 m/s2 * 0.15 =", 600 * 9.80665 * 0.15)
    theta = math.atan(0.30 / math.sqrt(1.0 - 0.15**2))
    docs.told(page, "atan(0.30/0.98869) =", theta)
    assert structure.critical_rotation == pytest.approx(theta, rel=1e-9)
    assert structure.static_base_shear == pytest.approx(600e3 * 9.80665 * 0.15)


def test_the_table_of_the_verdict_is_that_of_the_histories():
    """Products that stand in it, of numbers that the output has."""
    page = FOLDER / "verdict.md"
    (row,) = re.findall("^mean of maxima(.+)$", page.read_text("utf-8"), re.MULTILINE)
    moved, shear, drift, friction, _ = map(float, row.split())
    docs.told(page, "1.2 times the mean of", 1e3 * moved, 1.2e3 * moved)
    docs.told(page, "1.2 * 0.1303 m =", 1.2 * moved)
    docs.told(page, "the mean is", shear)
    docs.told(page, "* 1059 kN =", shear * 1059.1)
    docs.told(page, "`drift_ratio` |", drift)
    docs.told(page, "the demand of 0.157 is", friction)
