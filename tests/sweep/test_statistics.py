"""Tables and fits against data whose answer is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from rpscli.report.study.labels import label
from rpscli.sweep.fits.bilinear import bilinear_fit
from rpscli.sweep.points.layout import lay_out
from rpscli.sweep.reports.contrast import ContrastOptions, contrast_report
from rpscli.sweep.reports.demand import DemandOptions, demand_report
from rpscli.sweep.reports.ida import IdaOptions, ida_report
from rpscli.sweep.reports.lines import LinesOptions, lines_report
from rpscli.sweep.reports.overturning import OverturningOptions, overturning_table
from rpscli.sweep.reports.rotation import RotationOptions, rotation_report
from rpscli.sweep.reports.storey_shear import (
    StoreyShearOptions,
    storey_shear_report,
    unlike_buildings,
)
from rpscli.sweep.table import groups
from sweep.made_up import ALPHA, RHO, Stored, place, reader, stored, table_of, tabulate
from sweep.small_studies import STUDY, Make


@settings(max_examples=30)
@given(
    start=st.floats(0.5, 2.0),
    slope=st.floats(2.0, 40.0),
    knee=st.floats(0.25, 0.75),
    after=st.floats(-0.5, 1.0),
    count=st.integers(30, 200),
)
def test_the_bilinear_fit_recovers_a_made_curve(
    start: float, slope: float, knee: float, after: float, count: int
) -> None:
    x = np.random.default_rng(1).uniform(0.0, 1.0, count)
    y = start + slope * np.minimum(x, knee) + after * np.maximum(x - knee, 0.0)
    fit = bilinear_fit(x, y)
    assert fit is not None
    assert fit.break_x == pytest.approx(knee, abs=1e-7)
    assert fit.break_y == pytest.approx(start + slope * knee, rel=1e-7)
    assert fit.slope == pytest.approx(slope, rel=1e-7)
    assert fit.slope_after == pytest.approx(after, abs=1e-6)
    assert fit(np.array([0.0]))[0] == pytest.approx(start, rel=1e-7)


def test_no_other_break_fits_noisy_data_better() -> None:
    random = np.random.default_rng(3)
    x = random.uniform(0.0, 1.0, 80)
    y = 1.2 + 5.0 * np.minimum(x, 0.3) + 0.2 * random.normal(size=80)
    fit = bilinear_fit(x, y)
    assert fit is not None
    best = float(np.sum((y - fit(x)) ** 2))
    for knee in np.linspace(np.sort(x)[3], np.sort(x)[-4], 300):
        columns = np.column_stack([x**0, np.minimum(x, knee), np.maximum(x - knee, 0.0)])
        squares = np.sum((y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]) ** 2)
        assert squares >= best * (1.0 - 1e-12)


def test_too_few_points_have_no_bilinear_fit() -> None:
    assert bilinear_fit(np.arange(7.0), np.arange(7.0)) is None
    assert bilinear_fit(np.repeat([1.0, 2.0, 3.0], 10), np.zeros(30)) is None


def test_groups_cover_the_study_once_in_its_order(study_of: Make) -> None:
    layout = lay_out(study_of())
    by_scale = groups(layout, ["scale", RHO])
    assert [group.values for group in by_scale] == [
        (scale, rho) for scale in (0.5, 1.0) for rho in ("critical", 0.5, 0)
    ]
    joined = np.sort(np.concatenate([group.points for group in by_scale]))
    assert joined.tolist() == list(range(36))
    assert all(
        place(layout, n)["scale"] == group.values[0] for group in by_scale for n in group.points
    )
    pair = groups(layout, [ALPHA, "podium.bearing.wedge_slenderness"])
    assert [group.values for group in pair] == [(0.10, 0.20), (0.15, 0.30)]


def test_an_overturning_table_over_lists_of_devices(study_of: Make) -> None:
    """Values of a study may be lists, which are no keys of a dictionary."""
    friction = "[{kind: friction, force: 300 kN}]"
    swap = "podium.bearing.curvature_ratio: [critical, 0.5, 0]"
    changes = (swap, f"podium.devices: [[], {friction}]")
    table = table_of(study_of, lambda _: stored(), changes)
    found = overturning_table(table, OverturningOptions())
    assert found.column_keys == ("podium.devices",)
    assert [label("podium.devices", values[0]) for values in found.columns] == [
        "no devices",
        "friction 300 kN",
    ]
    assert all(cell is not None for row in found.cells for cell in row)


def test_the_overturning_table_counts_and_keeps_failures_apart(study_of: Make) -> None:
    layout = lay_out(study_of())

    def answer(number: int) -> Stored:
        at = place(layout, number)
        if at["record"] == 3 and at["scale"] == 1.0:
            return Stored("failed", "why", {})
        return stored("overturned_rolling" if at[RHO] == 0 and at["scale"] == 1.0 else "survived")

    apart = overturning_table(table_of(study_of, answer), OverturningOptions())
    assert (apart.row_keys, apart.notes) == ((ALPHA, "scale"), ())
    assert apart.rows == ((0.10, 0.5), (0.10, 1.0), (0.15, 0.5), (0.15, 1.0))
    assert [row[2].overturned[:2] for row in apart.cells if row[2]] == [(0, 3), (2, 2)] * 2
    table = overturning_table(table_of(study_of, answer), OverturningOptions(rows=(ALPHA,)))
    assert table.rows == ((0.10,), (0.15,))
    assert table.pooled == ("2 intensities",)
    assert "pools 2 intensities" in table.notes[0]
    assert table.columns == (("critical",), (0.5,), (0,))
    for row in table.cells:
        assert [cell.overturned.fraction for cell in row if cell] == [0.0, 0.0, 2 / 5]
        assert [cell.failed for cell in row if cell] == [1, 1, 1]
    turned = OverturningOptions(rows=(RHO,), columns=("scale",))
    by_scale = overturning_table(table_of(study_of, answer), turned)
    assert [cell.overturned.fraction for cell in by_scale.cells[2] if cell] == [0.0, 1.0]


def test_rotations_are_paired_point_by_point(study_of: Make) -> None:
    def answer(number: int) -> Stored:
        return stored(
            "overturned_rocking" if number == 35 else "survived", max_rotation=float(number)
        )

    table = table_of(study_of, answer)
    report = rotation_report(table, RotationOptions())
    assert (report.key, report.reference, report.failed) == (RHO, 0, 0)
    (panel,) = report.panels
    assert [comparison.value for comparison in panel.comparisons] == ["critical", 0.5]
    mine, alpha = panel.comparisons[1], math.atan(0.10)
    assert mine.rotation[0] == pytest.approx(6 / alpha, rel=1e-12)
    assert mine.reference[0] == pytest.approx(12 / alpha, rel=1e-12)
    assert np.all(mine.reference_points - mine.points == 6)
    assert math.isinf(mine.reference[-1])
    other = rotation_report(table, RotationOptions(reference=0.5, panels=(ALPHA,)))
    assert (other.reference, len(other.panels)) == (0.5, 2)


def test_contrasts_are_medians_over_the_motions(study_of: Make) -> None:
    """Cells of the flat ends over rho = 0.5: what stood on both sides, the rest as shares."""
    layout = lay_out(study_of())

    def answer(number: int) -> Stored:
        at = place(layout, number)
        flat = at[RHO] == 0
        if flat and at["record"] == 3 and at["scale"] == 1.0:
            return stored("overturned_rocking", max_rotation=9.0)
        if at["record"] == 2 and at["scale"] == 0.5 and at[ALPHA] == 0.10:
            return Stored("failed", "why", {})
        size = (2.0 + float(str(at["record"]))) if flat else 2.0
        return stored("survived", rotation_ratio=size, base_shear_ratio=3.0 if flat else 4.0)

    options = ContrastOptions(
        key=RHO, reference=0.5, value=0, panels=(ALPHA,), rows=(ALPHA,), columns=("scale",)
    )
    report = contrast_report(table_of(study_of, answer), options)
    assert (report.reference, report.value, report.failed) == (0.5, 0, 1)
    cells = {(cell.values[0], cell.values[2]): cell for cell in report.cells}
    assert cells[0.10, 0.5].pairs == 2
    assert cells[0.15, 0.5].ratios[:, 1] == pytest.approx([2.0, 0.75], rel=1e-15)  # 3, 4, 5 over 2
    assert cells[0.10, 1.0].ratios[:, 1] == pytest.approx([1.75, 0.75], rel=1e-15)  # 3, 4 over 2
    assert cells[0.10, 1.0].overturned == pytest.approx(1 / 3)
    assert cells[0.10, 1.0].reference_overturned == 0.0
    plain = ContrastOptions(rows=(ALPHA,), columns=("scale",))
    first = contrast_report(table_of(study_of, answer), plain)
    assert (first.key, first.reference, first.value) == (RHO, "critical", 0.5)


def test_demand_takes_what_lifted_off_and_stood(study_of: Make) -> None:
    outcomes = ("survived", "at_rest", "overturned_rolling", "survived")

    def answer(number: int) -> Stored:
        x = (number % 18) / 18.0 + number / 1000.0
        return stored(
            outcomes[number % 4], rotation_ratio=x, base_shear_ratio=1.0 + min(4.0 * x, 2.0)
        )

    report = demand_report(table_of(study_of, answer), DemandOptions(panels=(), series=(ALPHA,)))
    (panel,) = report.panels
    assert (panel.counted, panel.at_rest, panel.overturned, panel.failed) == (18, 9, 9, 0)
    assert panel.fit is not None
    assert panel.fit.break_x == pytest.approx(0.5, abs=1e-9)
    assert sum(len(series.points) for series in panel.series) == 18


def test_storey_profiles_leave_overturned_points_out(study_of: Make) -> None:
    layout = lay_out(study_of())

    def answer(number: int) -> Stored:
        falls = place(layout, number)["record"] == 3
        shears = [900.0] * 3 if falls else [1.0 * number, 2.0, 1.0]
        return stored("overturned_rocking" if falls else "survived", storey_shears=shears)

    table = table_of(study_of, answer)
    fixed = {
        (system, request): np.array([10.0, 6.0, 3.0])
        for system in range(6)
        for request in layout.records
        if request
    }
    report = storey_shear_report(table, fixed, StoreyShearOptions(panels=(ALPHA, RHO)))
    assert report.pooled == ("2 intensities",)
    assert "12 of 36 histories overturned" in report.notes[1]
    apart = storey_shear_report(table, fixed, StoreyShearOptions())
    assert apart.panel_keys == (ALPHA, RHO, "scale")
    assert (apart.profiles[0].counted, apart.profiles[0].overturned) == (2, 1)
    first = report.profiles[0]
    static = first.static_base_shear
    assert static == pytest.approx(600e3 * 9.80665 * 0.10, rel=1e-12)
    assert (first.counted, first.overturned) == (4, 2)
    assert first.mean * static == pytest.approx([(0 + 1 + 2 + 3) / 4, 2.0, 1.0], rel=1e-12)
    assert first.largest * static == pytest.approx([3.0, 2.0, 1.0], rel=1e-12)
    assert first.fixed_largest * static == pytest.approx([10.0, 6.0, 3.0], rel=1e-12)


def test_buildings_of_different_height_have_no_common_profile(study_of: Make) -> None:
    storeys = (
        "  - podium.bearing.curv",
        "  - superstructure.storeys: [2, 3]\n  - podium.bearing.curv",
    )
    layout = lay_out(study_of(STUDY, storeys))
    faults = list(unlike_buildings(layout, StoreyShearOptions(panels=(RHO,))))
    assert len(faults) == 3
    assert "holds buildings of [2, 3] storeys" in faults[0]
    assert not list(unlike_buildings(layout, StoreyShearOptions()))
    in_kn = StoreyShearOptions(panels=(RHO, "superstructure.storeys"), unit="kN")
    assert "different V_st" in next(unlike_buildings(layout, in_kn))


def test_ida_fractiles_count_overturned_points_as_infinite(study_of: Make) -> None:
    layout = lay_out(study_of())

    def answer(number: int) -> Stored:
        at = place(layout, number)
        record = int(str(at["record"]))
        falls = at["scale"] == 1.0 and record > 1
        return stored("overturned_rolling" if falls else "survived", rotation_ratio=0.1 * record)

    report = ida_report(table_of(study_of, answer), IdaOptions())
    panel = report.panels[0]
    assert panel.levels.tolist() == [0.5, 1.0]
    assert panel.fractiles[:, 0].tolist() == pytest.approx([0.1, 0.2, 0.3])
    assert panel.fractiles[:, 1].tolist() == [pytest.approx(0.1), math.inf, math.inf]
    assert panel.overturned == (0, 2)


def test_lines_join_the_means_of_what_stood(study_of: Make) -> None:
    layout = lay_out(study_of())

    def answer(number: int) -> Stored:
        at = place(layout, number)
        falls = at["record"] == 2
        return stored(
            "overturned_rolling" if falls else "survived",
            max_rotation=1e3 if falls else float(str(at["scale"])),
        )

    table = table_of(study_of, answer)
    rows = [answer(number) for number in range(36)]
    options = LinesOptions(x="scale", y=("max_rotation",), panels=(ALPHA,))
    report = lines_report(table, reader(rows), options)
    assert report.series_keys == (RHO,)
    assert [len(panel.lines) for panel in report.panels] == [3, 3]
    assert report.panels[0].lines[0].x == (0.5, 1.0)
    assert report.panels[0].lines[0].y == (0.5, 1.0)


def test_lines_go_over_si_values_of_what_was_written_with_units(study_of: Make) -> None:
    sizes = (f"{RHO}: [critical, 0.5, 0]", "podium.bearing.semi_diagonal: [1500 mm, 2.0, 2.5 m]")
    table = table_of(study_of, lambda _: stored(), sizes)
    options = LinesOptions(x="podium.bearing.semi_diagonal", y=("max_rotation",), series=())
    (panel,) = lines_report(table, reader([stored()] * 36), options).panels
    assert panel.lines[0].x == (1.5, 2.0, 2.5)


def test_lines_draw_one_curve_for_each_point_where_results_are_lists(study_of: Make) -> None:
    begin = STUDY.index("records:")
    layout = lay_out(study_of(STUDY[:begin] + "analysis: pushover\n"))
    rows = [
        Stored("done", None, {"curve.force": [2.0, 1.0 * n], "curve.displacement": [0.0, 1.0]})
        for n in range(6)
    ]
    table = tabulate(layout, rows)
    options = LinesOptions(x="curve.displacement", y=("curve.force",), panels=(ALPHA,))
    first, _ = lines_report(table, reader(rows), options).panels
    assert [line.y for line in first.lines] == [(2.0, 0.0), (2.0, 1.0), (2.0, 2.0)]
    assert first.lines[0].x == (0.0, 1.0)


def test_missing_points_are_neither_counted_nor_forgotten(study_of: Make) -> None:
    layout = lay_out(study_of())
    table = tabulate(layout, [stored() if n else None for n in range(36)])
    shares: NDArray[np.bool_] = table.failed
    assert shares.tolist() == [True] + [False] * 35


@pytest.mark.parametrize(
    ("statistic", "values"),
    [
        ("mean", [1.5, 1.5]),
        ("median", [2.0, math.inf]),
        ("largest", [math.inf, math.inf]),
        (0.3, [1.0, 2.0]),
        (0.34, [2.0, 2.0]),
    ],
)
def test_lines_say_what_stands_for_the_records(
    study_of: Make, statistic: str | float, values: list[float]
) -> None:
    layout = lay_out(study_of())

    def answer(number: int) -> Stored:
        at = place(layout, number)
        record = int(str(at["record"]))
        falls = record == 3 or (at[ALPHA] == 0.15 and at[RHO] == 0)
        return stored("overturned_rolling" if falls else "survived", max_rotation=float(record))

    table = table_of(study_of, answer)
    rows = [answer(number) for number in range(36)]
    options = LinesOptions(x=ALPHA, y=("max_rotation",), statistic=statistic, series=("scale",))
    report = lines_report(table, reader(rows), options)
    assert report.pooled == (f"3 values of {RHO}",)
    (panel,) = report.panels
    assert [line.values for line in panel.lines] == [(0.5,), (1.0,)]
    line = panel.lines[0]
    # 1, 1, 1, 2, 2, 2 and three overturned; 1, 1, 2, 2 and five overturned
    assert (line.counted, line.overturned) == ((6, 4), (3, 5))
    assert list(line.y) == values
    assert any("survivors: 16 of 36" in note for note in report.notes) == (statistic == "mean")


def test_lines_keep_intensities_apart(study_of: Make) -> None:
    table = table_of(study_of, lambda _: stored())
    rows = reader([stored()] * 36)
    report = lines_report(table, rows, LinesOptions(x=ALPHA, y=("max_rotation",)))
    assert (report.series_keys, report.pooled) == ((RHO, "scale"), ())
