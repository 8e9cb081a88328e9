"""Figures 1c to 6: what pushover and modal analyses say, always checked."""

import numpy as np
import pytest
from shown_commands import told

from reproduction.conftest import CASES
from rpscli.analyses.modal import modal
from rpscli.case.case import load_case

RHO = "podium.bearing.curvature_ratio"
SIZE = "podium.bearing.semi_diagonal"
OWN = "first_order.frequency_parameter"


def values(rows, **wanted):
    """The column `value` of the rows that hold what is wanted; `rho` and `R` are short names."""
    keys = {"rho": RHO, "R": SIZE}
    found = [
        float(row["value"])
        for row in rows
        if all(row[keys.get(key, key)] == value for key, value in wanted.items())
    ]
    assert found
    return found


@pytest.mark.evidence("pushover", "published")
def test_figure_1c_stiffness_is_negative_zero_positive(reproduce):
    rows = reproduce("figure_1c", "figure_1c")

    def start(rho):
        """Slope of F/W against u_b at the start, times 2 R: 2 rho - 1 to first order [-]."""
        u = [float(row["curve.displacement"]) for row in rows if row[RHO] == rho][:2]
        force = values(rows, rho=rho)[:2]
        return (force[1] - force[0]) / (u[1] - u[0]) * 2.0 * 1.5

    for name, number in (("critical", 0.25), ("0.5", 0.5), ("1.5", 1.5), ("0", 0.0)):
        # terms of tan(alpha)^2 = .0225 are left out, and the curve bends over the first step
        assert start(name) == pytest.approx(2.0 * number - 1.0, abs=0.05)
    for rho in ("critical", "0.5", "1.5", "0"):
        force = values(rows, rho=rho)
        assert force[0] == pytest.approx(0.15, rel=1e-9)  # tan(alpha)
        assert force[-1] == pytest.approx(0.0, abs=1e-9)  # theta_cr
    assert max(values(rows, rho="1.5")) > 0.2
    assert max(values(rows, rho="critical")) <= 0.15 + 1e-12


@pytest.mark.evidence("modes", "published")
def test_figure_3_amplification(reproduce):
    frequency = reproduce("figure_3", "figure_3_frequency")
    damping = reproduce("figure_3", "figure_3_damping")

    def factor(rows, phase, rho):
        name = "frequency" if rows is frequency else "damping"
        return np.array(
            values(rows, rho=rho, result=f"{phase}.first_order.{name}_ratio.0")
        )

    critical, half, large = (
        factor(frequency, "rolling", r) for r in ("critical", "0.5", "1.5")
    )
    for rho in ("critical", "0.5", "1.5"):
        # larger while rolling than while rocking
        rolling, rocking = (
            factor(frequency, phase, rho) for phase in ("rolling", "rocking")
        )
        assert np.all(rolling > rocking)
        # Larger in frequency than in damping. With stiffness-proportional damping (n = 1) both
        # are the same but for gravity, which adds to one what it takes from the other: 5e-4.
        for phase in ("rolling", "rocking"):
            ratio = factor(damping, phase, rho) / factor(frequency, phase, rho)
            assert np.all(ratio[1:] < 1.0)
            assert ratio[0] == pytest.approx(1.0, abs=1e-3)
    # damping in rolling against rocking: the first n for which it is smaller
    for rho, first in (("critical", 11), ("0.5", 8), ("1.5", 5)):
        less = factor(damping, "rolling", rho) < factor(damping, "rocking", rho)
        assert less.tolist() == [n >= first for n in range(1, 11)]
    # rho_cr and 0.5 alike, 1.5 larger: more so the more storeys there are
    assert np.max(half / critical - 1.0) < 0.012
    assert np.all(large > half)
    assert large[-1] / half[-1] > 1.04
    assert np.all(np.diff(large / half) > 0.0)


@pytest.mark.evidence("modes", "published")
def test_figure_4a_size(reproduce):
    rolling = reproduce("figure_4a", "figure_4a_rolling")
    assert set(values(rolling, rho="0.5", result=f"rolling.{OWN}")) == {0.0}

    def excess(rho):
        """How far the rigid estimate is above the model, from R = 0.5 to 3 m."""
        model = np.array(values(rolling, rho=rho, result=f"rolling.{OWN}"))
        rigid = np.array(values(rolling, rho=rho, result=f"rolling.{OWN}_rigid"))
        return np.asarray(rigid / model - 1.0)

    assert np.all(np.abs(excess("critical")) < 0.015)
    assert np.all(np.diff(excess("1.5")) < 0.0)  # the smaller, the worse
    told(
        CASES / "README.md",
        "off for R < 1.5 and rho > 1.5 |",
        100 * excess("1.5")[0],
        0.5,
        1.5,
    )
    # less than while rocking, for every size
    rocking = reproduce("figure_4a", "figure_4a_rocking")
    slow = np.array(values(rolling, rho="critical", result=f"rolling.{OWN}"))
    fast = np.array(values(rocking, rho="critical", result=f"rocking.{OWN}"))
    assert np.all(slow < fast)


@pytest.mark.evidence("modes", "published")
def test_figure_4b_radius(reproduce):
    rows = reproduce("figure_4b", "figure_4b")
    for size in ("0.5", "1", "1.5", "3"):
        rho = np.array([float(row[RHO]) for row in rows if row[SIZE] == size])
        model = np.array(values(rows, R=size, result=f"rolling.{OWN}"))
        rigid = np.array(values(rows, R=size, result=f"rolling.{OWN}_rigid"))
        rho = rho[: len(model)]
        assert model[rho == 0.5] == 0.0
        negative = rho < 0.5
        assert rigid[negative] == pytest.approx(model[negative], rel=0.015)
        excess = rigid[rho > 0.5] / model[rho > 0.5] - 1.0
        assert np.all(np.diff(excess) > 0.0)  # the larger the radius, the worse
        # off for small columns with large radii
        assert (excess[-1] > 0.05) == (float(size) <= 1.5)


@pytest.mark.evidence("modes", "published")
def test_figure_5_number_of_storeys(reproduce):
    rows = reproduce("figure_5", "figure_5")
    for size in ("1", "1.5", "2", "3"):
        negative, positive = (
            np.array(values(rows, rho=rho, R=size, result=f"rolling.{OWN}"))
            for rho in ("critical", "1.5")
        )
        assert np.ptp(negative) / np.mean(negative) < 0.02
        assert np.all(np.diff(positive) < 0.0)
        assert positive[-1] / positive[0] < 0.97
    spread = [
        np.ptp(values(rows, rho="1.5", R=size, result=f"rolling.{OWN}"))
        for size in ("1", "3")
    ]
    assert spread[0] > 4.0 * spread[1]  # mostly for small columns


@pytest.mark.evidence("modes", "published")
def test_figure_6_elastic_parts():
    def states(rho):
        override = f"podium.bearing.curvature_ratio={rho}"
        result = modal(load_case(CASES / "figure_6.yaml", [override]).structure)
        assert result.rolling is not None
        return [result.rolling, result.rocking]

    found = [modes for rho in ("critical", "0.5", "1.5") for modes in states(rho)]
    for modes in found:
        elastic = np.abs(modes.elastic_shapes)
        assert elastic[:, 0].max() < 0.03  # negligible in the podium's own mode
        assert np.all(elastic[:, 1:].max(axis=0) > 0.5)  # and in no other one
    # the radius leaves the shapes as they are: 3 % of the largest component
    rolling = found[::2]
    for modes in rolling[1:]:
        assert modes.shapes == pytest.approx(rolling[0].shapes, abs=0.03)
