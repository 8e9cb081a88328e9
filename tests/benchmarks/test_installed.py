"""Benchmarks name what cannot be loaded before anything is measured, and run to their end."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from paper_structures import needs_compiled_kernels
from shown_commands import ROOT, of_blocks

from benchmarks import accuracy, growth, histories, startup
from benchmarks.common import installed

LIBRARY_MISSING = """
try:
    raise ImportError("libblas.so.3: cannot open shared object file")
except ImportError:
    raise RuntimeError("failed to import")
"""


def test_the_first_cause_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "peer_without_library.py").write_text(LIBRARY_MISSING)
    monkeypatch.syspath_prepend(tmp_path)
    assert not installed("peer_without_library")
    assert "peer_without_library is left out: libblas.so.3" in capsys.readouterr().out
    assert not installed("peer_that_is_not_there.inside")
    assert "No module named 'peer_that_is_not_there'" in capsys.readouterr().out
    assert installed("numpy.linalg")
    assert capsys.readouterr().out == ""


def test_peers_are_asked_for_before_anything_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    def absent(module: str) -> bool:
        asked.append(module)
        return False

    def measured(count: int) -> None:
        raise InterruptedError

    monkeypatch.setattr(histories, "installed", absent)
    monkeypatch.setattr(histories, "motions", measured)
    with pytest.raises(InterruptedError):
        histories.main()
    assert asked == ["heyoka"]


LITTLE: dict[ModuleType, dict[str, Any]] = {
    histories: {"RECORDS": 2, "FEW": 1, "TIMES": 1},
    accuracy: {"RECORDS": 2, "COUNTED": 1},
    growth: {
        "SEEDS": range(1, 2), "STOREYS": (1, 3), "LENGTHS": (10, 20), "PEAKS": ("0.4g",),
        "POINTS": (10, 20), "CORE_POINTS": 64,
    },
    startup: {},
}  # fmt: skip
"""Each benchmark with a few histories in place of hundreds."""


@pytest.mark.long
@pytest.mark.posix
@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of a package that the records need
@needs_compiled_kernels
@pytest.mark.parametrize("module", LITTLE, ids=lambda module: module.__name__)
def test_a_little_of_each_benchmark_runs(
    module: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """All of the page's commands take twelve minutes and a machine that does nothing else."""
    lines = " ".join(of_blocks(Path(__file__).parent / "README.md"))
    named = re.findall(r"python -m (benchmarks\.\w+)", lines)
    assert named == [each.__name__ for each in LITTLE]
    monkeypatch.chdir(ROOT)
    for name, value in LITTLE[module].items():
        monkeypatch.setattr(module, name, value)
    if module is startup:
        monkeypatch.setattr(startup, "least", lambda words, there, _: startup.run(words, there))
    module.main()
    assert len(capsys.readouterr().out.splitlines()) > 5
