"""The notebook runs from its first cell to its last."""

from __future__ import annotations

import runpy
import shutil
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest
from paper_structures import needs_compiled_kernels

CASES = Path(__file__).parents[1] / "cases"


@needs_compiled_kernels
def test_the_notebook_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copytree(CASES, "cases")
    plt.switch_backend("Agg")
    try:
        left: dict[str, Any] = runpy.run_path("cases/notebook.py")
        drawn = [plt.figure(number) for number in plt.get_fignums()]
    finally:
        plt.close("all")
    printed = capsys.readouterr().out
    assert f"{left['history'].rotation_ratio:.2f} of the critical rotation" in printed
    assert len(left["result"]) == 36
    assert len(drawn) == 3
    assert [axes.get_ylabel() for axes in drawn[0].axes] == [
        "rotation $\\theta$ [rad]", "energy [MJ]"
    ]  # fmt: skip
    assert [len(part.axes) for part in drawn[2].subfigs] == [1, 1]
    written = {file.name for file in Path("results/notebook").iterdir()}
    assert written >= {"points.csv", "statistics.csv", "overturning.svg", "lines.svg", "run.json"}
    assert left["study"].layout.study.title in Path("results/notebook/run.json").read_text("utf-8")
