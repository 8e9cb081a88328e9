"""Long histories take the memory that the ceiling counts, and are refused before work begins."""

from __future__ import annotations

import re
import tracemalloc
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from numpy.typing import NDArray
from paper_structures import ground, needs_compiled_kernels, podium

from rpscli.analyses.kernels.history import MOST_NUMBERS, numbers_of_a_sample
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.errors import CaseError
from rpscli.model.devices import ViscousDamper
from rpscli.model.podium import PodiumStructure
from rpscli.report.bundles import timehistory_files
from rpscli.report.figures.look import Look

SHORT = TimeHistorySettings(free_vibration=0.0)
DAMPED = replace(podium(3), devices=(ViscousDamper(1e5),))
DT = 1e-5


def swaying(samples: int) -> NDArray[np.float64]:
    acceleration: NDArray[np.float64] = 3.0 * np.sin(np.arange(samples) * DT * 12.0)
    return acceleration


@needs_compiled_kernels
@pytest.mark.parametrize("structure", [podium(6), DAMPED], ids=["six storeys", "damper"])
def test_memory_is_what_the_ceiling_counts(structure: PodiumStructure) -> None:
    samples = 100_000
    record = ground(swaying(samples), DT)
    time_history(structure, ground(swaying(100), DT), SHORT)  # loads the kernels
    tracemalloc.start()
    try:
        result = time_history(structure, record, SHORT)
        files = dict(timehistory_files(result, "", Look(formats=())))
        written = files["timehistory.csv"]
        assert isinstance(written, Iterator)
        pieces = [str(piece) for piece in islice(written, 11)]
        assert "".join(pieces).count("\n") > 5000
        held, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    counted = 8.0 * samples * numbers_of_a_sample(structure)
    lines = 1e7  # numbers and text of some thousand
    assert 0.9 * counted < held < 1.02 * counted + lines
    # Above it stands what is in the making: the floors on a fixed base, or a block of everything.
    assert peak < 1.3 * counted + lines


def test_histories_over_the_ceiling_are_refused() -> None:
    many = podium(40)
    record = ground(np.zeros(2), 1e-5)
    rows = 12_000_003
    assert rows * numbers_of_a_sample(many) > MOST_NUMBERS
    with pytest.raises(CaseError, match=re.escape(f"{rows} samples of 40 storeys")) as refusal:
        time_history(many, record)
    assert "GB" in str(refusal.value)
    assert "give a shorter analysis.free_vibration" in str(refusal.value)
