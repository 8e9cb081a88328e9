"""Bodies in contact against the program: they know no impact law, and tell which one holds."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels, oracle_system, stillness
from shown_commands import ROOT, of_blocks, run_in_shell

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactKind, ImpactLaw

from .multibody import simulate, turning_points
from .resolved_contact import LAWS, structure_of
from .storey_lagrangian import StoreyLagrangian

pytest.importorskip(
    "mujoco", reason="the physics engine is not installed: pip install rpscli[contact]"
)
pytestmark = [
    pytest.mark.long,
    needs_compiled_kernels,
    pytest.mark.evidence("impact laws", "program"),
]

RELEASED = 0.4 * math.atan(0.15)
STILL = np.zeros(2)


@pytest.mark.parametrize("rho", [0.0, 0.5, 1.5])
@pytest.mark.parametrize("building", ["block", "frame"])
def test_restitution_from_the_heights_of_swings(building: str, rho: float) -> None:
    """e^2 is the ratio of lifts before and after an impact where nothing else takes energy."""
    structure = structure_of(building, rho)
    columns = 1 if building == "block" else 2
    system = oracle_system(structure)
    found = simulate(system, STILL, 1.0, 2.8, initial_rotation=RELEASED, columns=columns)
    tops = turning_points(found.rotation)[:3]
    storey = StoreyLagrangian(system)
    lifts = np.array([storey.cap_beam(top, rolling=rho > 0.0)[0].imag for top in tops])
    # contacts that close within 0.1 ms of swings of half a second
    assert np.sqrt(lifts[1:] / lifts[:-1]) == pytest.approx(structure.restitution, abs=5e-4)


def differences(
    building: str, rho: float, *, level: bool = True, closing_damping: float = 1.0
) -> dict[ImpactKind, float]:
    """Root mean square difference of each law after a release, over the tilt at its start."""
    structure = structure_of(building, rho)
    resolved = simulate(
        oracle_system(structure), STILL, 1.0, 2.4, initial_rotation=RELEASED, level=level,
        closing_damping=closing_damping,
    )  # fmt: skip
    settings = TimeHistorySettings(free_vibration=2.4, initial_rotation=RELEASED)
    found: dict[ImpactKind, float] = {}
    for law in LAWS:
        ours = replace(structure, impact_law=ImpactLaw(law))
        trace = time_history(ours, stillness(2e-3), settings, with_fixed_base=False).trace
        gap = np.interp(resolved.time, trace.time, trace.rotation) - resolved.rotation
        found[law] = float(np.sqrt(np.mean(gap**2))) / RELEASED
    return found


@pytest.mark.parametrize("rho", [0.0, 0.5])
@pytest.mark.parametrize("building", ["1", "3", "6"])
def test_floors_do_not_jump_with_the_beam(building: str, rho: float) -> None:
    found = differences(building, rho)
    # contacts have a width: impacts last 0.1 ms, and columns are apart for a few after them
    assert found["flexible"] < 6e-4
    assert found["rigid"] > 2.5 * found["flexible"]


def test_the_columns_part_under_a_beam_that_may_tilt_where_contacts_rebound() -> None:
    """Equal columns under a beam that may tilt receive equal impulses if contacts stay closed."""
    level, tilting = differences("6", 0.0), differences("6", 0.0, level=False)
    assert tilting["flexible"] > 3.0 * level["flexible"]
    assert tilting["flexible"] < 0.03
    closed = [differences("6", 0.0, level=way, closing_damping=4.0) for way in (True, False)]
    assert closed[1]["flexible"] == pytest.approx(closed[0]["flexible"], rel=1e-3)
    assert closed[1]["flexible"] < level["flexible"]


def test_blocks_of_the_table_of_the_verification(tmp_path: Path) -> None:
    """The command of its section 11, which takes twenty minutes for all rows."""
    verification = ROOT / "rpscli" / "VERIFICATION.md"
    (line,) = (line for line in of_blocks(verification) if "oracles.resolved_contact" in line)
    line = line.replace("../.venv/bin/", "").replace("table.csv)", f"{tmp_path / 't.csv'} block)")
    printed = run_in_shell(f"cd {ROOT}; {line}").replace("| block | 0 |", "| block | flat |")
    rows = re.findall(r"^\| block .*$", verification.read_text("utf-8"), re.MULTILINE)
    told, found = ([row.split("|")[2:7] for row in t] for t in (rows, printed.splitlines()))
    assert [row[0] for row in found] == [row[0] for row in told]
    for ours, theirs in zip(found, told, strict=True):
        # the last digit that is shown, or a tenth between versions of the engine
        numbers = [float(cell) for cell in theirs[1:]]
        assert [float(cell) for cell in ours[1:]] == pytest.approx(numbers, rel=0.1, abs=0.15)
