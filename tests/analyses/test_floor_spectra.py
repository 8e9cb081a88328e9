"""Spectra of floors, against closed forms and an integrator of another kind."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from conformance import conforms
from paper_structures import known, needs_compiled_kernels
from scipy.integrate import solve_ivp
from sweep.small_studies import csv_rows

from rpscli.analyses.floor_spectra import (
    fixed_base_floor_spectra,
    floor_spectra,
    isolated_floor_spectra,
)
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.cli import program
from rpscli.records.loading import load_record

CASE = Path(__file__).parents[2] / "cases" / "six_storey.yaml"
PERIODS = np.array([0.3, 0.8, 2.0])


def shaken(source):
    case = load_case(str(CASE))
    return time_history(case.structure, load_record(source), case.analysis)


@pytest.mark.evidence("floor spectra", "exact")
def test_a_sudden_acceleration_counts_twice_without_damping():
    floors = np.ones((2001, 2)) * [1.0, 3.0]
    found = floor_spectra(floors, 0.01, PERIODS, 0.0)
    # Peaks between samples: fifty a period leave 0.2 %.
    wanted = np.array([[2.0], [6.0]]) * np.ones(3)
    moved = wanted * (PERIODS / (2 * np.pi)) ** 2
    for name, expected, mine in (
        ("Sa [m/s2]", wanted, found.pseudo_acceleration),
        ("Sd [m]", moved, found.displacement),
    ):
        conforms(
            "floor spectra", f"{name} of a sudden acceleration, undamped", expected, mine,
            2e-3 * expected, "closed form", "twice the acceleration",
        )  # fmt: skip


@pytest.mark.evidence("floor spectra", "exact")
@needs_compiled_kernels
def test_a_building_that_stands_has_the_spectra_of_a_fixed_base():
    result = shaken("synthetic:?pga=0.02g&seed=3&duration=8&dt=0.01")
    assert result.outcome == "at_rest"
    isolated, fixed = (
        isolated_floor_spectra(result),
        known(fixed_base_floor_spectra(result)),
    )
    # The free vibration after the record is cut at different times.
    np.testing.assert_allclose(
        isolated.pseudo_acceleration, fixed.pseudo_acceleration, rtol=5e-5
    )


@pytest.mark.evidence("floor spectra", "program")
@needs_compiled_kernels
def test_fixed_base_against_a_building_with_its_equipment():
    """Floors and an oscillator without mass on the roof, by one solver for all of them."""
    result = shaken("synthetic:?pga=0.3g&seed=4&duration=5&dt=0.005")
    record, building = result.record, known(result.structure.superstructure)
    n, period, ratio = building.storeys, 0.8, 0.05
    omega = 2.0 * np.pi / period

    def rate(t, y):
        ground = np.interp(t, record.time, record.acceleration, right=0.0)
        u, du = y[:n], y[n : 2 * n]
        elastic = building.stiffness_matrix @ u + building.damping_matrix @ du
        floors = -elastic / building.masses
        z, dz = y[-2:]
        ddz = -(omega**2) * z - 2.0 * ratio * omega * dz - floors[-1]
        return np.concatenate([du, floors - ground, [dz, ddz]])

    end = record.duration + 2.0
    solved = solve_ivp(
        rate, (0.0, end), np.zeros(2 * n + 2), rtol=1e-7, atol=1e-9, max_step=record.dt,
        t_eval=np.arange(0.0, end, record.dt),
    )  # fmt: skip
    wanted = float(np.max(np.abs(solved.y[-2])))
    found = known(fixed_base_floor_spectra(result, np.array([period]), ratio))
    # Floors are linear between samples in ours, 1/12 (omega_6 dt)^2 at the highest mode.
    conforms(
        "floor spectra", "Sd [m] on the roof, fixed base", wanted, found.displacement[-1, 0],
        2e-3 * wanted, "independent program", "scipy.integrate.solve_ivp, all in one system",
    )  # fmt: skip


@needs_compiled_kernels
def test_floor_spectra_of_the_command(tmp_path):
    source = "synthetic:?pga=0.5g&seed=1&duration=6&dt=0.01"
    words = [
        "timehistory",
        str(CASE),
        "--record",
        source,
        "-o",
        str(tmp_path / "made"),
        "-q",
    ]
    CliRunner().invoke(program, [*words, "--floor-spectra", "--figures", "png"])
    assert (tmp_path / "made/floor_spectra.png").read_bytes().startswith(b"\x89PNG")
    rows = csv_rows("floor_spectra.csv", tmp_path / "made")
    found = isolated_floor_spectra(shaken(source)).pseudo_acceleration
    assert [int(row["floor [-]"]) for row in rows] == np.repeat(range(1, 7), 50).tolist()
    np.testing.assert_allclose(
        [float(row["pseudo_acceleration [m/s2]"]) for row in rows],
        found.ravel(),
        rtol=1e-9,
    )
