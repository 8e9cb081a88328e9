"""The theory as a reference: formulas are numbered, citations of them are right."""

import re
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import numpy as np
import pytest
from oracles.test_assumptions import SIZES
from paper_structures import known, podium
from scipy.optimize import brentq
from shown_commands import ROOT, THEORY

from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.contact import Contact
from rpscli.model.impact import ImpactLaw
from rpscli.model.superstructure import profile_stiffnesses

TEXT = re.sub(
    r"^```.*?^```$", "", THEORY.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL
)
LABEL = re.compile(r"^(?: {4,6}|\|).* \((\d+)\.(\d+)\)(?: \|)?$", re.MULTILINE)
"""At the right of a formula, or in the last column of a table of formulas."""

LABELS = [(int(section), int(number)) for section, number in LABEL.findall(TEXT)]
SECTIONS = [int(number) for number in re.findall(r"^## (\d+)\. ", TEXT, re.MULTILINE)]
KNOWN = {
    r"\(\d+\.\d+\)": {f"({section}.{number})" for section, number in LABELS},
    r"\d+": set(map(str, SECTIONS)),
}
"""Numbers that are cited: those of formulas and of sections."""

PRINTED = {
    "springs pass no impulse": ("springs", "base shear {most:.0f} to {least:.1f} %"),
    "contacts that stay closed": ("contact is never lost", None),
    "friction of 1.3": ("columns never slide", None),
    "level, closed": ("the beam stays level", None),
    "level, rebound": (
        "the beam stays level",
        "rotation {low:.0f} to {high:+.0f} %, base shear {least:.0f} to {most:+.0f} %",
    ),
    "level, lifts off": (
        "the beam stays level",
        "rotation {high:+.0f} %, base shear {least:.0f} %",
    ),
    "vertical": (
        "floors ride on the beam",
        "rotation {low:.0f} to {high:.0f} %, base shear {least:.0f} to {most:+.0f} %",
    ),
}
"""Where the table of section 2 has sizes of assumptions, and how; nothing but 0.1 % where None."""


def cited_by(text, number):
    """Numbers after "Theory", perhaps of sections, also over line ends of docstrings, comments."""
    joined = re.sub(r"\s*\n\s*(?:#:?\s*)?", " ", text)
    lists = (
        rf"T(?:heory|HEORY\.md),? (?:sections? )?({number}(?:(?:, | and | to ){number})*)"
    )
    return {
        each for group in re.findall(lists, joined) for each in re.findall(number, group)
    }


SOURCES = sorted(
    path
    for folder in ("rpscli", "tests", "cases")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in {".py", ".yaml", ".md"} and path not in {Path(__file__), THEORY}
)


def test_formulas_are_numbered_in_order():
    expected = [
        (section, number)
        for section, group in groupby(LABELS, key=lambda label: label[0])
        for number in range(1, len(list(group)) + 1)
    ]
    assert expected == LABELS
    assert len(LABELS) > 100
    parts = re.split(r"^## \d+\. .*$", TEXT, flags=re.MULTILINE)[1:]
    for section, part in zip(SECTIONS, parts, strict=True):
        assert {int(found[0]) for found in LABEL.findall(part)} <= {section}


def test_every_displayed_formula_has_a_number():
    """An indented block ends with one; lines above may be parts of the same formula."""
    blocks = re.findall(r"\n\n((?: {4}.*\n)+)", TEXT)
    assert len(blocks) > 60
    assert [block for block in blocks if not LABEL.search(block.splitlines()[-1])] == []


@pytest.mark.parametrize("number", KNOWN)
def test_what_is_cited_exists(number):
    assert [*range(1, len(SECTIONS) + 1)] == SECTIONS
    assert set(re.findall(r"\(\d+\.\d+\)", TEXT)) <= KNOWN[r"\(\d+\.\d+\)"]
    cited = {path: cited_by(path.read_text("utf-8"), number) for path in SOURCES}
    assert sum(path.suffix == ".py" for path, numbers in cited.items() if numbers) > 10
    missing = {
        path.name: of
        for path, numbers in cited.items()
        if (of := numbers - KNOWN[number])
    }
    assert missing == {}


@pytest.mark.parametrize(("storeys", "per_cent"), [(3, 0.5), (9, 1.7)])
def test_weight_on_drifting_storeys(storeys, per_cent):
    """Weight above over height and stiffness of the softest storey, buildings of section 7."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10)
    weights = STANDARD_GRAVITY * np.cumsum(masses[::-1])[::-1]
    share = float((weights / (3.0 * stiffnesses)).max())
    assert 100.0 * share == pytest.approx(per_cent, abs=0.05)
    assert f"{per_cent} %" in TEXT


@pytest.mark.parametrize("assumption", sorted({size.assumption for size in SIZES}))
def test_sizes_of_assumptions_are_those_that_are_computed(assumption):
    """Rotation and base shear of bodies in contact, of which a long test computes each."""
    sizes = [size for size in SIZES if size.assumption == assumption]
    expected, number = PRINTED[assumption]
    (row,) = (line for line in TEXT.splitlines() if line.startswith(f"| {expected}"))
    if number is None:
        assert {(size.rotation, size.base_shear, size.within) for size in sizes} == {
            (0, 0, 0.1)
        }
    else:
        rotations = [size.rotation for size in sizes]
        shears = [size.base_shear for size in sizes]
        ends = {"low": min(rotations), "high": max(rotations)}
        assert number.format(**ends, least=min(shears), most=max(shears)) in row


@pytest.mark.parametrize("share", [0.02, 2.0 / 30.0, 0.2])
def test_edges_that_crush_take_their_share_of_the_moment(share):
    """Fibres of a flat end that yield at f and do not pull, turned far; forces over N, B."""
    place = np.linspace(-1.0, 1.0, 20_001)

    def pressure(settlement):
        return np.clip(settlement + 1e5 * place, 0.0, 1.0 / share)

    settlement = brentq(lambda d: pressure(d).mean() - 1.0, -1e5, 1e5)
    assert (pressure(settlement) * place).mean() == pytest.approx(1.0 - share, abs=2e-4)


@pytest.mark.parametrize("rho", [0.0, 0.25, 1.5])
@pytest.mark.parametrize(("kind", "share"), [("plane", 3.0), ("edges", 1.0)])
def test_where_soft_ends_lift_to_first_order(kind, share, rho):
    """The bearing itself has the stiffness (2 rho - 1) W/2H, which joints add to."""
    soft = Contact(kind, period_ratio=1.5)
    structure = replace(podium(6, 0.15, rho, law=ImpactLaw()), contact=soft)
    bed = known(structure.bed)
    relative = 2.0 * structure.bearing.half_height * bed.stiffness / structure.weight
    first = 0.15 / (share * (1.0 - 2.0 * rho + relative))
    # what the text says of the rest: a seventh of it is of a higher order still
    missing = 1.0 - bed.uplift_rotation / first
    assert missing == pytest.approx(2.0 * bed.uplift_rotation * 0.15, rel=0.17)
    assert "tan(alpha)/(3 (1 - 2 rho + 2 H K_s/W))" in TEXT
