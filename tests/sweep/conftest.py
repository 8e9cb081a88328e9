"""Small studies, and the ways to run them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from rpscli.case.study.study import Study, parse_study
from rpscli.cli import program
from rpscli.report.study.registry import REPORTS
from sweep.small_studies import BASE, STUDY, Make, Sweep, SweepJson, document_of


@pytest.fixture
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with a case and a study."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("COLUMNS", raising=False)
    (tmp_path / "base.yaml").write_text(BASE, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    return tmp_path


@pytest.fixture
def study_of(workplace: Path) -> Make:
    """The study of a text, after replacements in it."""

    def make(
        text: str = STUDY, *changes: tuple[str, str], overrides: tuple[str, ...] = ()
    ) -> Study:
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        return parse_study(text, name="study.yaml", kinds=REPORTS, overrides=overrides)

    return make


@pytest.fixture
def no_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures cost nothing; what they look like is not what is tested."""
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"a figure")


@pytest.fixture
def sweep(workplace: Path, no_figures: None) -> Sweep:
    """Run `rps sweep` in this process, perhaps on another text of the study or its base."""

    def invoke(*arguments: str, study: str = "", base: str = "") -> Result:
        for name, text in (("study.yaml", study), ("base.yaml", base)):
            if text:
                (workplace / name).write_text(text, encoding="utf-8")
        return CliRunner().invoke(program, ["sweep", *arguments])

    return invoke


@pytest.fixture
def sweep_json(sweep: Sweep) -> SweepJson:
    """Run `rps sweep ... --json`; the standard output holds one document."""

    def invoke(*arguments: str, exit_code: int = 0, **texts: str) -> dict[str, Any]:
        return document_of(sweep(*arguments, "--json", **texts), exit_code)

    return invoke
