"""The documentation site: pages lead somewhere, the reference leaves nothing out."""

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

import rpscli
from rpscli.analyses.result_quantities import EVERY
from rpscli.commands.explain import _formats
from rpscli.commands.registry import OURS
from rpscli.registry import of_tools

DOCS = Path(__file__).parents[1] / ".ci" / "docs"


@pytest.fixture(scope="module")
def modules():
    """Those that make the site, of which none needs Sphinx."""
    sys.path.insert(0, str(DOCS))
    try:
        yield {
            name: importlib.import_module(name)
            for name in ("formulas", "pages", "reference")
        }
    finally:
        sys.path.remove(str(DOCS))


def test_links_of_pages_lead_to_pages(modules, tmp_path):
    stage = modules["pages"].Stage(tmp_path)
    stage.add_all()
    assert stage.missing == []
    pages = modules["pages"].PAGES.values()
    texts = [(tmp_path / f"{page}.md").read_text("utf-8") for page in pages]
    linked = {link for text in texts for link in re.findall(r"\]\(/([^)#\s]+)", text)}
    assert len(linked) > 40
    assert [link for link in linked if not (tmp_path / link).is_file()] == []


def test_formulas_have_anchors_and_citations_lead_to_them(modules, tmp_path):
    stage = modules["pages"].Stage(tmp_path)
    theory = stage.page("rpscli/THEORY.md")
    anchors = re.findall(r'id="(eq-[\d.]+)"', theory)
    assert len(anchors) == len(set(anchors)) > 100
    numbers = {
        anchor for anchor in modules["pages"].THEORY.values() if anchor.startswith("eq-")
    }
    assert set(anchors) == numbers
    cited = re.findall(r'href="#(eq-[\d.]+)"', theory)
    assert len(cited) > 20
    assert set(cited) <= numbers
    elsewhere = stage.page("rpscli/VERIFICATION.md")
    assert set(re.findall(r"theory\.html#(eq-[\d.]+)", elsewhere)) <= numbers


@pytest.mark.parametrize(
    ("plain", "letters"),
    [
        ("theta_cr", "<i>θ</i><sub>cr</sub>"),
        ("w_1^2/(2 d)", "<i>w</i><sub>1</sub><sup>2</sup>/(2 <i>d</i>)"),
        ("1 - e <= 2 rho", "1 − <i>e</i> ≤ 2 <i>ρ</i>"),
        ("K^-1 x_(m-1)", "<i>K</i><sup>−1</sup> <i>x</i><sub><i>m</i>−1</sub>"),
        # after an impact, and the square of the rate before one, which is no power of -2
        ("u_b'+", "<i>u</i><sub><i>b</i></sub>′<sup>+</sup>"),
        ("theta'-^2", "(<i>θ</i>′<sup>−</sup>)<sup>2</sup>"),
        # the vector of ones, a sum, and the word
        ("M 1 a_g", "<i>M</i> <b>1</b> <i>a</i><sub><i>g</i></sub>"),
        ("sum m_i v_i", "∑ <i>m</i><sub><i>i</i></sub> <i>v</i><sub><i>i</i></sub>"),
        ("a sum = Y", "<i>a</i> sum = <i>Y</i>"),
        ("g = 9.81 m/s2", "<i>g</i> = 9.81 m/s²"),
    ],
)
def test_formulas_are_set_as_they_read(modules, plain, letters):
    assert modules["formulas"].typeset(plain) == letters


def test_code_that_is_no_formula_stays_code(modules):
    is_formula = modules["formulas"].is_formula
    words = (
        "podium.plan",
        "max_events",
        "loss",
        "1e-6",
        "--set a=1",
        "rps budget",
        "state.py",
    )
    assert [code for code in words if is_formula(code)] == []
    assert all(
        map(is_formula, ("e", "tan(alpha)", "u_b", "V_b/V_st", "x < beta", "N m_c R^2"))
    )


def test_the_reference_has_every_command_key_result_and_name(modules):
    reference = modules["reference"]
    commands = reference.commands()
    for name in [*OURS, *of_tools("commands")]:
        assert f"# rps {name}\n" in commands[f"reference/commands/rps-{name}"]
    keys = "\n".join(reference.keys({})[0].values())
    for key in _formats():
        limit = key.key.split(".") if key.key.startswith("limits.") else []
        named = f"| `{limit[1]}` |" if len(limit) == 2 else f"confval}} {key.key}\n"
        assert named in keys or len(limit) > 2, key.key
    results = reference.results()["reference/results"]
    assert [
        each.name for each in EVERY.values() if f"| `{each.name}` |" not in results
    ] == []
    python = "\n".join(reference.python().values())
    public = {*rpscli.__all__} - {"__version__"}
    assert [name for name in public if f":: rpscli.{name}\n" not in python] == []


@pytest.mark.long
def test_the_site_is_built_without_a_warning(tmp_path):
    """All but the gallery's pictures, of which test_readme.py runs the commands."""
    pytest.importorskip("sphinx", reason="needs pip install --group docs")
    built = subprocess.run(
        [sys.executable, str(DOCS / "build"), str(tmp_path), "--no-gallery"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert built.returncode == 0, built.stderr
    assert "0 broken links" in built.stdout


def test_names_of_the_reference_are_those_of_the_program(modules):
    for layer, (_, names) in modules["reference"].PYTHON.items():
        for name in names:
            module, _, attribute = f"rpscli.{layer}.{name}".rpartition(".")
            assert hasattr(importlib.import_module(module), attribute), name
