"""The paper has the form of its journal, and each number in it is computed again.

``python -m pytest tests/test_paper.py -m "long or not long"`` computes all of them, in some ten
seconds beyond the compilation. Two come from elsewhere: counts of the study of impact laws, and
the outcome of the shaking-table tests, whose data are not shipped; both are read from where they
are documented.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
import yaml
from oracles.second_integrator import simulate
from oracles.test_second_integrator import ROWS
from paper_structures import (
    block,
    known,
    needs_compiled_kernels,
    oracle_system,
    podium,
)
from physics.test_free_rocking import SINE, least_amplitude
from reproduction.test_histories import PRINTED
from shown_commands import ROOT, THEORY, table

import rpscli
from rpscli.model.bearing import Bearing

PAPER = ROOT / "rpscli" / "paper.md"
_, HEAD, BODY = re.split(
    r"^---\n", PAPER.read_text("utf-8"), maxsplit=2, flags=re.MULTILINE
)
TEXT = " ".join(BODY.split())

REQUIRED = (
    "Summary", "Statement of need", "State of the field", "Software design",
    "Research impact statement", "AI usage disclosure", "Acknowledgements", "References",
)  # fmt: skip
"""Sections that the Journal of Open Source Software asks for, in its order."""

NUMBERS = {
    "six storeys": ("undergo 106 impacts", "by 36 % of", "shear is 19 % of", "acceleration 53 %"),
    "energy": ("within 1e-8 of the energy",),
    "errors in print": (
        "jumps by 1.0, 2.2 and 3.9 % at slendernesses of 0.10, 0.15 and 0.20", "three errors",
    ),
    "a published pulse": ("a block of 1 m by 3 m is 0.46873 g",),
    "second integrator": ("motion of 223 impacts", "less than 1e-9 of"),
    "Table 3": (
        "36 probabilities of overturning from 3600 histories", "mean difference of 0.017",
        "44 % of all impacts",
    ),
    "documented": ("in 90 % of the half", "44 motions for 576 buildings"),
}  # fmt: skip
"""The phrases that hold numbers, by the test that computes them."""


SCOPE = {
    "Columns are rigid": "columns, beam and ground are rigid",
    "and alike": "all columns alike",
    "friction prevents sliding": "columns never slide",
    "contact is never lost": "contact is never lost",
    "the beam does not turn about the vertical unless a case asks for it": "the beam does not turn",
    "elastic unless its storeys are given strengths": "linear building",
    "its floors ride on the beam unless they are put on springs": "floors ride on the beam",
}
"""What the paper says of its scope, and where the table of assumptions of the theory has it."""

REMOVED = {
    "the beam does not turn": "podium.twist",
    "elastic": "superstructure.yield",
    "its floors": "superstructure.vertical_period",
}
"""Assumptions that a key removes, which the paper makes with "unless"."""


def test_the_scope_is_that_of_the_theory():
    """No claim that the theory does not make, and none that a key has made untrue."""
    heads, *rows = table(THEORY, "**Assumptions, what each one hides")
    assert heads[0] == "assumed"
    scope = TEXT.partition("The main trade-off is scope. ")[2].partition(" The theory")[0]
    hides = {row[0]: " ".join(row) for row in rows}
    for claim, assumed in SCOPE.items():
        assert scope.count(claim) == 1, claim
        (name,) = (each for each in hides if each.startswith(assumed))
        keys = [key for word, key in REMOVED.items() if claim.startswith(word)]
        assert [key for key in keys if f"`{key}`" not in hides[name]] == []
        assert ("unless" in claim) == bool(keys) == (" removes it" in hides[name])
    left = scope
    for claim in SCOPE:
        left = left.replace(claim, "")
    words = {"and", "the", "building", "is", "a", "shear"}
    assert set(re.findall(r"[a-z]+", left.lower())) <= words
    assert "linear shear" not in TEXT


def test_form():
    head = yaml.safe_load(HEAD)
    assert {"title", "tags", "authors", "affiliations", "date", "bibliography"} <= set(
        head
    )
    assert re.fullmatch(r"\d{1,2} [A-Z][a-z]+ \d{4}", head["date"])
    sections = re.findall(r"^# (.*)$", BODY, re.MULTILINE)
    assert [name for name in sections if name in REQUIRED] == list(REQUIRED)
    assert (
        750
        <= len(re.sub(r"!?\[|\]\([^)]*\)|\[?-?@[\w;, @-]+\]?", " ", BODY).split())
        <= 1750
    )
    figures = re.findall(r"\]\((\S+\.png)\)", BODY)
    assert len(figures) == 2
    assert all((PAPER.parent / figure).is_file() for figure in figures)


def test_references_are_cited_and_citations_have_references():
    bibliography = PAPER.with_suffix(".bib").read_text("utf-8")
    entries = re.findall(r"^@\w+\{(\w+),", bibliography, re.MULTILINE)
    cited = set(re.findall(r"@(\w+)", BODY))
    assert len(entries) == len(set(entries))
    assert set(entries) == cited


def test_each_number_belongs_to_a_test():
    text = TEXT
    for phrase in (phrase for phrases in NUMBERS.values() for phrase in phrases):
        assert text.count(phrase) == 1, phrase
        text = text.replace(phrase, "")
    names = r"@\w+|FEMA P695|Table 3|\]\([^)]*\)"
    assert re.findall(r"\S*\d\S*", re.sub(names, "", text)) == []


def said(of, numbers):
    """The phrases hold these numbers, in this order."""
    joined = " ".join(NUMBERS[of])
    assert re.findall(r"\d[\d.]*(?:e-\d+)?", joined) == list(numbers)


@needs_compiled_kernels
def test_six_storeys(fema_record):
    case = rpscli.load_case(ROOT / "cases" / "six_storey.yaml")
    record = fema_record("farfield/1/b")
    result = rpscli.time_history(case.structure, record, case.analysis)
    fixed, acceleration = (
        known(result.fixed_base),
        known(result.floor_acceleration_over_fixed),
    )
    said(
        "six storeys",
        (
            f"{result.impacts}",
            f"{100.0 * result.max_rotation / case.structure.bearing.critical_rotation:.0f}",
            f"{100.0 * result.max_base_shear / max(fixed.storey_shears):.0f}",
            f"{100.0 * acceleration:.0f}",
        ),
    )
    assert abs(result.energy.residual) < 1e-8 * result.energy.input


def test_errors_in_print():
    said("errors in print", ("1.0", "2.2", "3.9", "0.10", "0.15", "0.20"))
    for tan_alpha, jump in ((0.10, 1.0), (0.15, 2.2), (0.20, 3.9)):
        at = Bearing(
            1.5, tan_alpha, 2.0 * tan_alpha, 0.5
        ).critical_curvature_ratio_of_paper
        below, above = (
            Bearing(
                1.5, tan_alpha, 2.0 * tan_alpha, at + shift
            ).critical_rotation_of_paper
            for shift in (-1e-9, 1e-9)
        )
        assert f"{100.0 * abs(above / below - 1.0):.1f}" == f"{jump:.1f}"


@needs_compiled_kernels
def test_a_published_pulse():
    structure = replace(block(0.5, 1.5), gravity=9.81)
    least = least_amplitude(structure, structure.gravity * SINE, 0.4, 0.7)
    said("a published pulse", ("1", "3", f"{least:.5f}"))


@needs_compiled_kernels
@pytest.mark.long
def test_second_integrator(fema_record):
    row = ROWS[4]
    structure, record = (
        podium(row.storeys, row.tan_alpha, row.rho),
        fema_record(row.record),
    )
    other = simulate(oracle_system(structure), record.acceleration, record.dt)
    settings = rpscli.TimeHistorySettings(free_vibration=10.0, accuracy=16.0)
    ours = rpscli.demand(structure, record, settings)
    said("second integrator", (f"{ours.impacts}", "1e-9"))
    assert other.impacts == ours.impacts
    assert ours.max_rotation == pytest.approx(other.max_rotation, rel=1e-9)


@needs_compiled_kernels
@pytest.mark.long
def test_table_3(tmp_path, fema_record):
    points = rpscli.load_study(ROOT / "cases" / "compdyn2021" / "table_3.yaml").run(
        tmp_path
    )
    fallen = np.char.startswith(np.asarray(points["outcome"], dtype=str), "overturned")
    counts = fallen.reshape((*PRINTED.shape, 100)).sum(axis=-1)
    difference = np.mean(np.abs(counts - PRINTED)) / 100.0
    creating = np.sum(points["creating_impacts"]) / np.sum(points["impacts"])
    said(
        "Table 3",
        (
            f"{PRINTED.size}",
            f"{fallen.size}",
            f"{difference:.3f}",
            f"{100.0 * creating:.0f}",
        ),
    )


def test_what_is_documented():
    granite = (ROOT / "cases" / "granite" / "README.md").read_text("utf-8")
    law = " ".join(
        (ROOT / "cases/studies/impact_law/README.md").read_text("utf-8").split()
    )
    assert re.search(r"nine runs within 3 % .*\| 89\.5 % \|", granite)
    assert "The same 576 buildings" in law
    assert "under the 44 far-field motions" in law
    said("documented", ("90", "44", "576"))
