"""What cannot be loaded is named before anything is measured, and left out."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import histories
from benchmarks.peers.installed import installed

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
    assert asked == ["heyoka", "openseespy.opensees"]
