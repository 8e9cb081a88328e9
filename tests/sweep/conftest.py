"""Small studies, and the ways to run them."""

import pytest
from click.testing import CliRunner

from rpscli.case.study.study import parse_study
from rpscli.cli import program
from rpscli.report.study.registry import REPORTS
from sweep.small_studies import BASE, STUDY, document_of


@pytest.fixture
def workplace(tmp_path, monkeypatch):
    """A working folder with a case and a study."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("COLUMNS", raising=False)
    (tmp_path / "base.yaml").write_text(BASE, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    return tmp_path


@pytest.fixture
def study_of(workplace):
    """The study of a text, after replacements in it."""

    def make(text=STUDY, *changes, overrides=()):
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        return parse_study(text, name="study.yaml", kinds=REPORTS, overrides=overrides)

    return make


@pytest.fixture
def no_figures(monkeypatch):
    """Figures cost nothing; what they look like is not what is tested."""
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"a figure")


@pytest.fixture
def sweep(workplace, no_figures):
    """Run `rps sweep` in this process, perhaps on another text of the study or its base."""

    def invoke(*arguments, study="", base=""):
        for name, text in (("study.yaml", study), ("base.yaml", base)):
            if text:
                (workplace / name).write_text(text, encoding="utf-8")
        return CliRunner().invoke(program, ["sweep", *arguments])

    return invoke


@pytest.fixture
def sweep_json(sweep):
    """Run `rps sweep ... --json`; the standard output holds one document."""

    def invoke(*arguments, exit_code=0, **texts):
        return document_of(sweep(*arguments, "--json", **texts), exit_code)

    return invoke
