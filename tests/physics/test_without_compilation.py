"""The kernels as plain Python do what they do as machine code."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels

from rpscli.physics.state import (
    IMPACT,
    LANES,
    RECONTACT,
    SLIDING,
    STICKING,
    STOP_LEFT,
    STOP_MET,
    TENDON_YIELDING,
    UPLIFT,
)

from . import history_without_compilation

Histories: TypeAlias = dict[str, list[dict[str, Any]]]

TESTS = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def interpreted() -> Histories:
    paths = [str(TESTS), str(TESTS.parent), os.environ.get("PYTHONPATH", "")]
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(paths)}
    command = [sys.executable, "-W", "error", str(history_without_compilation.__file__)]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    found: Histories = json.loads(done.stdout)
    return found


@needs_compiled_kernels
@pytest.mark.parametrize("kind", ["one", "several", "sampled"])
def test_python_and_machine_code_agree(interpreted: Histories, kind: str) -> None:
    """To the last bit: machine code in as many lanes as it has, Python in few."""
    compiled = history_without_compilation.everything(LANES)[kind]
    assert len(interpreted[kind]) == len(compiled)
    for slow, fast in zip(interpreted[kind], compiled, strict=True):
        assert slow.keys() == fast.keys()
        for name, values in fast.items():
            np.testing.assert_array_equal(slow[name], values, err_msg=name)


def test_lanes_side_by_side_give_the_bits_of_one_without_compilation(
    interpreted: Histories,
) -> None:
    assert json.dumps(interpreted["one"]) == json.dumps(interpreted["several"])


def test_the_histories_compared_are_not_trivial(
    interpreted: Histories,
) -> None:
    events = np.array([found["events"] for found in interpreted["one"]])
    assert np.count_nonzero(events[:, UPLIFT]) >= 4
    assert np.count_nonzero(events[:, IMPACT]) >= 4
    assert events[:, IMPACT].sum() >= 10
    assert events[:, RECONTACT].any()
    for kind in (STICKING, SLIDING, STOP_MET, STOP_LEFT, TENDON_YIELDING):
        assert events[0, kind] > 0
    assert not events[-1].any()  # one stays in full contact
