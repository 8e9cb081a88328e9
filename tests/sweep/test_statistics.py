"""Tables and fits against data whose answer is known."""

import math
from pathlib import Path

import numpy as np
import pytest
from report.small_results import curve, legend
from report.test_figures_of_studies import panels, same

from rpscli.errors import CaseError
from rpscli.report.study.heights import StoreyShearOptions, storey_shear, unlike_buildings
from rpscli.report.study.lines import IdaOptions, LinesOptions, ida, lines
from rpscli.report.study.rotation import RotationOptions, rotation
from rpscli.report.study.scatter import (
    DemandOptions,
    ScatterOptions,
    bilinear_fit,
    demand,
    scatter,
)
from rpscli.report.study.table import OVERTURNING, TABLE, OverturningOptions, TableOptions
from rpscli.report.table import Table, records
from rpscli.sweep.points import lay_out
from rpscli.tools.comparison.report import ComparisonOptions, comparison, uncomparable
from sweep.small_studies import (
    ALPHA,
    BROKEN,
    RHO,
    STUDY,
    WITHOUT_RECORDS,
    Stored,
    cells,
    csv_rows,
    fallen,
    fixed_base,
    made,
    stored,
)


@pytest.mark.parametrize("seed", range(3))
def test_no_other_break_fits_noisy_data_better(seed):
    random = np.random.default_rng(seed)
    x, (slope, knee, after) = random.uniform(0.0, 1.0, 80), random.uniform(0.2, 0.8, 3)
    y = 1.2 + 9.0 * slope * np.minimum(x, knee) + after * np.maximum(x - knee, 0.0)
    exact = bilinear_fit(x, y)
    assert exact is not None
    assert (exact.break_x, exact.break_y) == pytest.approx(
        (knee, 1.2 + 9.0 * slope * knee)
    )
    assert (exact.slope, exact.slope_after) == pytest.approx((9.0 * slope, after))
    y += 0.2 * random.normal(size=80)
    fit = bilinear_fit(x, y)
    assert fit is not None
    best = float(np.sum((y - fit(x)) ** 2))
    for at in np.linspace(np.sort(x)[3], np.sort(x)[-4], 300):
        columns = np.column_stack([x**0, np.minimum(x, at), np.maximum(x - at, 0.0)])
        squares = np.sum((y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]) ** 2)
        assert squares >= best * (1.0 - 1e-12)


def test_too_few_points_have_no_bilinear_fit():
    assert bilinear_fit(np.arange(7.0), np.arange(7.0)) is None
    assert bilinear_fit(np.repeat([1.0, 2.0, 3.0], 10), np.zeros(30)) is None


def test_overturning_and_lines_over_lists_of_devices(study_of):
    """Values of a study may be lists, which are no keys of a dictionary."""
    friction = "[{kind: friction, force: 300 kN}]"
    swap = "podium.bearing.curvature_ratio: [critical, 0.5, 0]"
    changes = (swap, f"podium.devices: [[], {friction}]")
    results = made(study_of, lambda _: stored(), changes)
    found = cells(OVERTURNING.make(results, OverturningOptions()))
    assert found["podium.devices=none;counted"] == [3] * 4
    assert [name for name in found if name.endswith(";number")] == [
        "podium.devices=none;number", "podium.devices=friction 300 kN;number"
    ]  # fmt: skip
    options = LinesOptions(
        x="scale", result=("max_rotation",), series=("podium.devices",)
    )
    rows = cells(lines(results, options))
    assert len({repr(devices) for devices in rows["podium.devices"]}) == 2


def test_the_overturning_table_counts_and_keeps_failures_apart(study_of):
    def answer(at):
        strong = at["scale"] == 1.0
        return BROKEN if strong and at["record"] == 3 else fallen(strong and at[RHO] == 0)

    results = made(study_of, answer)
    apart = OVERTURNING.make(results, OverturningOptions())
    found = cells(apart)
    assert apart.notes == ()
    assert (found[ALPHA], found["scale"]) == ([0.10, 0.10, 0.15, 0.15], [0.5, 1.0] * 2)
    assert found[f"{RHO}=0;number"] == [0, 2, 0, 2]
    assert found[f"{RHO}=0;counted"] == [3, 2, 3, 2]
    pooled = OVERTURNING.make(results, OverturningOptions(rows=(ALPHA,)))
    assert "pools 2 intensities" in pooled.notes[0]
    found = cells(pooled)
    assert found[ALPHA] == [0.10, 0.15]
    for rho, share in (("critical", 0.0), ("0.5", 0.0), ("0", 2 / 5)):
        assert found[f"{RHO}={rho}"] == [share] * 2
    assert (found["counted"], found["failed"]) == ([15, 15], [3, 3])
    turned = cells(
        OVERTURNING.make(results, OverturningOptions(rows=(RHO,), columns=("scale",)))
    )
    assert (turned["scale=0.5"][2], turned["scale=1"][2]) == (0.0, 1.0)


def test_tables_in_which_an_overturned_history_is_the_largest(study_of):
    def answer(at):
        falls = at["record"] == 3 and at["scale"] == 1.0
        return fallen(falls, rotation_ratio=float(at["record"]))

    results = made(study_of, answer)
    expected = {"median": [2.0, 2.0], "largest": [3.0, "inf"], "mean": [2, 1.5]}
    for statistic, values in expected.items():
        options = TableOptions(statistic=statistic, rows=("scale",), columns=(ALPHA,))
        found = cells(TABLE.make(results, options))
        assert found[f"{ALPHA}=0.1"] == found[f"{ALPHA}=0.15"] == values
        assert found[f"{ALPHA}=0.1;overturned"] == [0, 3]
        assert found[f"{ALPHA}=0.1;counted"] == [9, 9]
    own = OverturningOptions(rows=("scale",), columns=(ALPHA,))
    shares = TABLE.make(results, TableOptions(statistic="overturned", **dict(own)))
    assert cells(shares) == cells(OVERTURNING.make(results, own))


def test_scatter_holds_what_stood(study_of):
    outcomes = ("survived", "at_rest", "overturned_rolling")
    results = made(
        study_of,
        lambda at: stored(
            outcomes[at["number"] % 3], max_lift=at["number"], drift_ratio=1.0
        ),
    )
    found = scatter(results, ScatterOptions(x="max_lift", y="drift_ratio", series=(RHO,)))
    points = cells(found)
    assert sorted(points["max_lift"]) == [n for n in range(36) if n % 3 < 2]
    assert points["point"] == [int(n) + 1 for n in points["max_lift"]]
    assert set(points["outcome"]) == {"survived", "at_rest"}
    assert {ALPHA, RHO, "scale"} <= set(points)
    assert list(found.tables) == [""]


def test_rotations_are_paired_point_by_point(study_of):
    results = made(
        study_of, lambda at: fallen(at["number"] == 35, max_rotation=at["number"])
    )
    found = cells(rotation(results, RotationOptions(panels=())))
    assert (set(found[RHO]), set(found[f"reference {RHO}"])) == ({"critical", 0.5}, {0})
    # The second system, point 6, beside the reference, point 12; intensities are named.
    mine, alpha = found[RHO].index(0.5), math.atan(0.10)
    assert found["rotation_over_alpha"][mine] == pytest.approx(6 / alpha, rel=1e-12)
    assert found["reference_rotation_over_alpha"][mine] == pytest.approx(
        12 / alpha, rel=1e-12
    )
    assert found["scale"][mine : mine + 2] == [0.5, 1.0]
    assert math.isinf(found["reference_rotation_over_alpha"][-1])
    other = cells(rotation(results, RotationOptions(reference=0.5, panels=(ALPHA,))))
    assert set(other[RHO]) == {"critical", 0}


def test_demand_takes_what_lifted_off_and_stood(study_of):
    outcomes = ("survived", "at_rest", "overturned_rolling", "survived")

    def answer(at):
        n = at["number"]
        x = (n % 18) / 18.0 + n / 1000.0
        return stored(
            outcomes[n % 4], rotation_ratio=x, base_shear_ratio=1.0 + min(4.0 * x, 2.0)
        )

    found = cells(
        demand(made(study_of, answer), DemandOptions(panels=(), series=(ALPHA,)))
    )
    counts = ("counted", "at_rest", "overturned", "failed")
    assert [found[name] for name in counts] == [[18], [9], [9], [0]]
    assert found["saturation_rotation_ratio"] == pytest.approx([0.5], abs=1e-9)


def test_storey_profiles_leave_overturned_points_out(study_of):
    def answer(at):
        falls = at["record"] == 3
        return fallen(
            falls, storey_shears=[900.0] * 3 if falls else [1.0 * at["number"], 2.0, 1.0]
        )

    fixed = fixed_base(lay_out(study_of()), [10.0, 6.0, 3.0])
    results = made(study_of, answer, fixed=fixed)
    pooled = storey_shear(results, StoreyShearOptions(panels=(ALPHA, RHO)))
    assert "pools 2 intensities" in pooled.notes[0]
    assert "12 of 36 histories overturned" in pooled.notes[1]
    apart = cells(storey_shear(results, StoreyShearOptions()))
    assert (apart["scale"][0], apart["counted"][0], apart["overturned"][0]) == (0.5, 2, 1)
    found = cells(pooled)
    assert (found["counted"][0], found["overturned"][0]) == (4, 2)
    static = 600e3 * 9.80665 * 0.10
    for name, values in {
        "mean": [(0 + 1 + 2 + 3) / 4, 2.0, 1.0],
        "largest": [3.0, 2.0, 1.0],
        "fixed_largest": [10.0, 6.0, 3.0],
    }.items():
        assert found[f"{name}_shear"][:3] == pytest.approx(values, rel=1e-12)
        assert found[f"{name}_shear_ratio"][0] == pytest.approx(
            values[0] / static, rel=1e-12
        )


def test_buildings_of_different_height_have_no_common_profile(study_of):
    axis = "  - podium.bearing.curv"
    layout = lay_out(
        study_of(STUDY, (axis, f"  - superstructure.storeys: [2, 3]\n{axis}"))
    )
    faults = list(unlike_buildings(layout, StoreyShearOptions(panels=(RHO,))))
    assert len(faults) == 3
    assert "holds buildings of [2, 3] storeys" in faults[0]
    assert not list(unlike_buildings(layout, StoreyShearOptions()))
    in_kn = StoreyShearOptions(panels=(RHO, "superstructure.storeys"), unit="kN")
    assert "different V_st" in next(unlike_buildings(layout, in_kn))


def test_ida_fractiles_count_overturned_points_as_infinite(study_of):
    def answer(at):
        falls = at["scale"] == 1.0 and at["record"] > 1
        return fallen(falls, rotation_ratio=0.1 * at["record"])

    found = cells(ida(made(study_of, answer), IdaOptions()))
    assert found["scale"][:2] == [0.5, 1.0]
    fractiles = [found[f"rotation_ratio_{share}"] for share in (16, 50, 84)]
    assert [each[0] for each in fractiles] == pytest.approx([0.1, 0.2, 0.3])
    assert [each[1] for each in fractiles] == [pytest.approx(0.1), math.inf, math.inf]
    assert found["overturned"][:2] == [0, 2]


def test_lines_go_over_si_values_of_what_was_written_with_units(study_of):
    sizes = (
        f"{RHO}: [critical, 0.5, 0]",
        "podium.bearing.semi_diagonal: [1500 mm, 2.0, 2.5 m]",
    )
    options = LinesOptions(
        x="podium.bearing.semi_diagonal", result=("max_rotation",), series=()
    )
    found = cells(lines(made(study_of, lambda _: stored(), sizes), options))
    assert found["podium.bearing.semi_diagonal"] == [1.5, 2.0, 2.5]


def test_lines_are_of_values_of_any_kind_or_of_none(study_of):
    key, springs = "superstructure.yield", "superstructure.vertical_period"
    axes = f"{springs}: [null, 0.1]\n  - {key}: [null, {{ratio: 1.5}}]"
    study = made(study_of, lambda _: stored(), (f"{RHO}: [critical, 0.5, 0]", axes))
    found = lines(study, LinesOptions(x=springs, result=("max_rotation",), series=(key,)))
    assert cells(found)[springs] == ["none", 0.1] * 2
    assert cells(found)[key] == ["none"] * 2 + [{"ratio": 1.5}] * 2
    (axis,) = found.drawn("title").axes
    assert [text.get_text() for text in axis.get_xticklabels()] == ["none", "0.1"]


def test_lines_draw_one_curve_for_each_point_where_results_are_lists(study_of):
    def answer(at):
        curve = {"curve.force": [2.0, at["number"]], "curve.displacement": [0.0, 1.0]}
        return Stored("done", None, curve)

    results = made(study_of, answer, text=WITHOUT_RECORDS + "analysis: pushover\n")
    options = LinesOptions(
        x="curve.displacement", result=("curve.force",), panels=(ALPHA,)
    )
    found = cells(lines(results, options))
    assert found["value"][:6] == [2.0, 0.0, 2.0, 1.0, 2.0, 2.0]
    assert found["curve.displacement"][:2] == [0.0, 1.0]


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
def test_lines_say_what_stands_for_the_records(study_of, statistic, values):
    def answer(at):
        falls = at["record"] == 3 or (at[ALPHA] == 0.15 and at[RHO] == 0)
        return fallen(falls, max_rotation=at["record"])

    asked = LinesOptions(
        x=ALPHA, result=("max_rotation",), statistic=statistic, series=("scale",)
    )
    found = lines(made(study_of, answer), asked)
    assert f"pools 3 values of {RHO}" in found.notes[0]
    assert any("survivors: 16 of 36" in note for note in found.notes) == (
        statistic == "mean"
    )
    shown = cells(found)
    assert shown["scale"] == [0.5, 0.5, 1.0, 1.0]
    # 1, 1, 1, 2, 2, 2 and three overturned; 1, 1, 2, 2 and five overturned
    counts = [shown[name][:2] for name in ("counted", "overturned", "stood")]
    assert counts == [[9, 9], [3, 5], [6, 4]]
    assert [float(value) for value in shown["value"][:2]] == values


RECORDS = 8
OBSERVED = f"""\
rps: 1
base: base.yaml
vary:
  - title: [left, right]
  - {ALPHA}: [0.10, 0.15, 0.2]
    podium.bearing.wedge_slenderness: [0.20, 0.30, 0.4]
records:
  - {{source: "synthetic:?pga=0.5g&duration=2&dt=0.02", seed: [1, 2, 3, 4, 5, 6, 7, 8]}}
observed: seen.csv
reports: [comparison]
"""
SOURCE = "synthetic:?pga=0.5g&duration=2&dt=0.02&seed={}"


def seen(*rows, head="record,title,overturned"):
    Path("seen.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


def report(make, answer):
    results, options = made(make, answer, text=OBSERVED), ComparisonOptions()
    assert not list(uncomparable(results.table.layout, options))
    return comparison(results, options)


def overturns(at):
    """Overturned under more records the smaller the slenderness: 6, 4 and 2 of 8."""
    return fallen(at["record"] <= {0.10: 6, 0.15: 4, 0.2: 2}[at[ALPHA]])


def half(title, first):
    """Observed: overturned under the first so many records."""
    return [
        f"{SOURCE.format(n)},{title},{int(n <= first)}" for n in range(1, RECORDS + 1)
    ]


def test_outcomes_are_counted_for_each_system(study_of):
    seen(*half("left", 4), *half("right", 6))
    found = report(study_of, overturns)
    table = {(row["title"], row[ALPHA]): row for row in records(found.tables[""])}
    cells = ("both", "computed_only", "observed_only", "neither")
    assert [table["left", 0.15][cell] for cell in cells] == [4, 0, 0, 4]
    assert [table["left", 0.10][cell] for cell in cells] == [4, 2, 0, 2]
    assert [table["left", 0.2][cell] for cell in cells] == [2, 0, 2, 4]
    assert table["right", 0.2]["agreed"] == 4
    assert table["right", 0.10]["agreed_share"] == 1.0
    (shown, remark) = found.parts()
    assert isinstance(shown, Table)
    assert shown.rows[1][:5] == ("left", "0.15", "8", "1.00 (0.69 to 1.0)", "4")
    assert "95 %" in str(remark)
    drawn = found.drawn("a title")
    titles = {
        ("left", 0.10): "left, tan α = 0.1 75.0 % of 8 agree; overturned 6, observed 4",
        ("left", 0.2): "left, tan α = 0.2 75.0 % of 8 agree; overturned 2, observed 4",
    }
    for system, title in titles.items():
        axes, pairs = panels(drawn)[title], records(found.tables["_pairs"])
        pairs = [row for row in pairs if (row["title"], row[ALPHA]) == system]
        pairs.sort(key=lambda row: float(row["PGV"]))
        names = "PGV", "observed", "computed"
        at, saw, fell = (np.array([row[name] for row in pairs], float) for name in names)
        same(curve(axes, "observed"), (at, saw))
        same(curve(axes, "computed"), (at, fell))
        for label, height, alone in (
            ("above: computed only", 1.05, fell > saw),
            ("below: observed only", -0.05, fell < saw),
        ):
            places, heights = curve(axes, label)
            same(np.sort(places), at[alone])
            same(heights, [height] * alone.sum())
            assert label in legend(drawn)
        assert (axes.get_xlabel(), axes.get_ylabel()) == (
            "PGV [m/s]",
            "share that overturned",
        )


def test_maxima_have_ratios(study_of):
    seen(
        *(f"{SOURCE.format(n)},left,{10.0 * n}" for n in range(1, RECORDS + 1)),
        head="record,title,max_rotation [mrad]",
    )
    ratios = [0.5, 1.0, 2.0, 4.0, 1.0, 1.0, 1.0]

    def answer(at):
        n = at["record"]
        return fallen(n == RECORDS, max_rotation=0.01 * n * [*ratios, 1.0][n - 1])

    made_of = report(study_of, answer)
    found, *_ = records(made_of.tables["_maxima"])
    assert (found["counted"], found["overturned_computed"]) == (7, 1)
    assert found["median_ratio"] == pytest.approx(1.0, rel=1e-12)
    spread = np.std(np.log(ratios), ddof=1)
    assert found["dispersion"] == pytest.approx(spread, rel=1e-12)
    drawn = made_of.drawn("a title")
    title = f"ratio 1.00 in the median, dispersion {spread:.2f}, n = 7 1 overturned (triangles)"
    axes = panels(drawn)[f"left, tan α = 0.1 {title}"]
    points, equal, triangles = axes.lines
    observed = 0.01 * np.arange(1, RECORDS)
    same(points.get_data(), (observed, observed * ratios))
    same(equal.get_data(), ((0.005, 0.16), (0.005, 0.16)))
    same(triangles.get_data(), ([0.08], [1.3 * 0.16]))
    rotation = r"$|\theta_{max}|$ [rad]"
    assert axes.get_xlabel() == f"observed {rotation}"
    assert axes.get_ylabel() == f"computed {rotation}"


@pytest.mark.parametrize(
    ("head", "row", "told"),
    [
        ("title,overturned", "left,1", "seen.csv:1:1: has no column `record`"),
        ("record,overturnt", "a,1", "did you mean overturned?"),
        ("record,title", "a,left", "has no column of what was observed"),
        ("record,overturned", "a,2", "seen.csv:2:1: overturned = '2' must be 1 or 0"),
        ("record,overturned", "a,1,2", "has 3 cells and 2 titles"),
        ("record,max_rotation [m]", "a,1", "must be an angle"),
        ("record,max_rotation", "a,-1", "must be a number >= 0"),
        ("record,overturned,overturned", "a,1,1", "appears twice"),
        (
            "record,title,overturned",
            "a,left,1\na,left,0",
            "3:1: 'a' of this system is already in",
        ),
    ],
)
def test_faults_of_the_file_have_their_line(study_of, head, row, told):
    with pytest.raises(CaseError, match=r"observed: .*there is no such file"):
        study_of(OBSERVED)
    seen(row, head=head)
    with pytest.raises(CaseError) as error:
        study_of(OBSERVED)
    assert told in str(error.value)
    assert (
        "title" not in str(error.value) or "record" in head
    )  # another file: nothing of it


@pytest.mark.parametrize(
    ("change", "rows", "told"),
    [
        (("observed: seen.csv\n", ""), half("left", 4), "add `observed: FILE.csv`"),
        (
            ("observed:", "scale: [1, 2]\nobserved:"),
            half("left", 4),
            "add a column `scale`",
        ),
        (
            ("observed:", "observed:"),
            ["nothing,left,1"],
            "has a record and a system of the study",
        ),
    ],
)
def test_what_cannot_be_compared_is_told_before(study_of, change, rows, told):
    seen(*rows)
    layout = lay_out(study_of(OBSERVED, change))
    assert told in " ".join(uncomparable(layout, ComparisonOptions()))


def test_sweep_leaves_tables_and_says_what_it_found(sweep_json):
    seen(*half("left", 4))
    document = sweep_json("study.yaml", study=OBSERVED)
    assert "not conservative" in document["note"]
    rows = csv_rows("comparison.csv")
    assert [row["title [-]"] for row in rows] == ["left"] * 3
    assert len(document["reports"]["comparison"]["rows"]) == len(rows)
    assert len(csv_rows("comparison_pairs.csv")) == 3 * RECORDS
    assert any("have no observation" in warning for warning in document["warnings"])
