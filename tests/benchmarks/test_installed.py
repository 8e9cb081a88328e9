"""The benchmark names what cannot be loaded before anything is measured, and runs to its end."""

from __future__ import annotations

from pathlib import Path

import pytest
from paper_structures import needs_compiled_kernels

from benchmarks import histories
from benchmarks.histories import installed

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
    assert installed("numpy.linalg")
    assert capsys.readouterr().out == ""


@pytest.mark.long
@needs_compiled_kernels
def test_a_little_of_the_benchmark_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(histories, "RECORDS", 2)
    monkeypatch.setattr(histories, "TIMES", 1)
    histories.main()
    assert len(capsys.readouterr().out.splitlines()) > 5
