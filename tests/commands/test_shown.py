"""`import rpscli` as a library, and what a prompt and a notebook show: short, whatever it is."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from paper_structures import known
from report.small_results import CURVED, KINDS, structure

import rpscli
from rpscli.records.measures import MEASURES, measured, needs_period

LONGEST = 600
ROOT = Path(__file__).parents[2]


def shown():
    result, made = KINDS["rolls"](), structure(CURVED, 40)
    modes, static = rpscli.modal(made), rpscli.pushover(made)
    return [
        result, result.trace, known(result.fixed_base), result.record, made,
        known(made.superstructure), modes, known(modes.fixed_base), modes.rocking, static,
        static.curve, static.capacity[0],
    ]  # fmt: skip


def test_results_are_short():
    for one in shown():
        line = repr(one)
        assert line.startswith(f"{type(one).__name__}(")
        assert len(line) < LONGEST
        assert "\n" not in line
        assert "[[" not in line
        assert len(one._repr_html_()) < 6000


def test_a_history_and_a_case_say_what_they_are_about():
    case = rpscli.load_case(ROOT / "cases" / "free_standing_block.yaml")
    assert case.title in repr(case)
    assert len(repr(case)) < LONGEST
    result = KINDS["rolls"]()
    line = repr(result)
    assert line.startswith(
        f"TimeHistoryResult(record={result.record.name}, outcome=survived, "
    )
    assert f"rotation_ratio={result.rotation_ratio:.4g}" in line
    table = result._repr_html_()
    assert f"<th>max_base_shear</th><td>{result.max_base_shear:.4g} N</td>" in table


def test_names_are_no_tags():
    motion = rpscli.GroundMotion(
        np.array([0.0, 1.0]), 0.1, name="<script>alert(1)</script>"
    )
    tags = {tag.removeprefix("/") for tag in re.findall("<(.*?)>", motion._repr_html_())}
    assert tags == {"table", "caption", "tr", "th", "td"}


def test_a_motion_of_an_array_needs_no_names():
    motion = rpscli.GroundMotion(np.array([0.0, 2.0, -3.0]), 0.5)
    assert (motion.name, motion.source, motion.format) == ("motion", "array", "array")
    assert rpscli.demand(structure(CURVED, 0), motion).outcome == "survived"


@pytest.mark.parametrize("measure", MEASURES)
def test_a_motion_scales_itself_to_a_measure(measure):
    motion = rpscli.load_record("pulse:sine?amplitude=0.3g&period=0.8")
    period = 0.5 if needs_period(measure) else None
    scaled = motion.scaled_to(measure, 0.7, period=period)
    # a scaled motion is measured by the same sums
    assert measured(scaled, measure, period) == pytest.approx(0.7, rel=1e-12)


@pytest.mark.parametrize("name", rpscli.__all__)
def test_every_public_name_exists(name):
    assert getattr(rpscli, name) is not None
    assert name in dir(rpscli)


def test_samples_as_a_table(monkeypatch):
    case = rpscli.load_case(ROOT / "cases" / "six_storey.yaml")
    motion = rpscli.load_record("pulse:sine?amplitude=0.3g&period=0.5")
    result = rpscli.time_history(case.structure, motion, case.analysis)
    table = result.to_dataframe()
    assert table["rotation"].tolist() == result.trace.rotation.tolist()
    assert table["storey_6_shear"].tolist() == result.trace.storey_shears[:, 5].tolist()
    assert table.attrs["units"]["storey_6_shear"] == "N"
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="needs pandas: pip install pandas"):
        result.to_dataframe()


def test_other_names_do_not():
    with pytest.raises(AttributeError, match="no attribute 'pushower'"):
        rpscli.pushower  # noqa: B018
