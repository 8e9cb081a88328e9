"""What comes out for a point depends on the point alone."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    building,
    needs_compiled_kernels,
    podium,
    stillness,
    waves,
)
from pydantic import ValidationError

from rpscli.analyses.demand import DemandRequest, demands, histories
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.result_quantities import SAMPLED
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.conditions import Condition
from rpscli.case.study.schema import PerturbSection, RangeSection, SampleSection
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_components, load_record
from rpscli.records.measures import intensity_measures, measured
from rpscli.sweep.evaluation import SCALARS, at_path, resolved, run_batch
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import EARLY_BATCH, LARGEST_BATCH, all_keys, batches
from rpscli.sweep.statistics import summary
from rpscli.sweep.statistics.summary import step_notes
from rpscli.sweep.systems import balance_note, changes, sample
from sweep.small_studies import BASE, STUDY, WITHOUT_RECORDS

PERTURB = ("scale: [", "perturb: {members: 3}\nscale: [")


def rows(results):
    """Outcome, message and results of each point, None where it has none."""
    found = []
    for row, outcome in enumerate(results.outcomes.tolist()):
        told = {
            "outcome": outcome,
            "message": results.messages.get(row),
        }
        for name, column in results.columns.items():
            value = column[row]
            told[name] = (
                value.tolist()
                if value.ndim
                else None
                if np.isnan(value)
                else float(value)
            )
        found.append({name: value for name, value in told.items() if value is not None})
    return found


def test_bits_do_not_depend_on_the_batch(study_of):
    layout = lay_out(study_of())
    together = run_batch(layout.context, list(layout))
    backwards = run_batch(layout.context, list(layout)[::-1])
    alone = [run_batch(layout.context, [layout[number]]) for number in (0, 17, 35)]
    assert rows(backwards)[::-1] == rows(together)
    assert [rows(one)[0] for one in alone] == [
        rows(together)[number] for number in (0, 17, 35)
    ]


UPWARDS = "synthetic:?pga=0.3g&duration=4&dt=0.02&seed=2"


@pytest.mark.parametrize("vertical", [None, UPWARDS])
def test_results_are_those_of_a_single_time_history(study_of, workplace, vertical):
    layout = lay_out(study_of(STUDY, PERTURB))
    if vertical:  # which a case says beside its record
        record = f"record: {{source: '{UPWARDS[:-1]}1', vertical: '{UPWARDS}'}}\n"
        (workplace / "base.yaml").write_text(BASE + record, encoding="utf-8")
        layout = lay_out(study_of(WITHOUT_RECORDS + "perturb: {members: 3}\n"))
    context = layout.context
    for number in (3, len(layout) // 3 + 1, len(layout) - 2):
        point = layout[number]
        assert point.record is not None
        assert point.record.vertical == vertical
        case = resolved(layout.plan, point.values)
        structure = layout.system(point.system).perturbed(point.restitution_change)
        changed = case.structure.restitution * point.restitution_change
        assert structure.restitution == pytest.approx(changed, rel=1e-12)
        motion = load_components(point.record.source, vertical)
        motion = motion.scaled(point.scale * point.scale_change)
        single = time_history(structure, motion, case.analysis).scalars()
        (row,) = rows(run_batch(context, [point]))
        assert row["outcome"] == single["outcome"]
        for name in set(single) & set(SCALARS["timehistory"]):
            # Kernels for one and for many histories round differently; impacts amplify that.
            expected = (
                single[name]
                if single[name] is None
                else pytest.approx(single[name], rel=1e-6)
            )
            assert row.get(name) == expected, name


def test_whole_histories_tell_more_and_nothing_else(study_of):
    friction = ("podium.friction=0.12",)  # less than is asked of it: columns slide
    change = ("scale: [", "whole_histories: true\nscale: [")
    brief, whole = (
        lay_out(study_of(STUDY, *of, overrides=friction)) for of in ((), (change,))
    )
    context, more = brief.context, whole.context
    for number in (3, 20):
        (without,) = rows(run_batch(context, [brief[number]]))
        (row,) = rows(run_batch(more, [whole[number]]))
        assert {name: row[name] for name in without} == without
        history = context.history(brief[number])
        motion = history.motion.scaled(history.scale)
        single = time_history(history.structure, motion, history.settings)
        told = {quantity.name: getattr(single, quantity.name) for quantity in SAMPLED}
        assert {name: row.get(name) for name in told} == told
        assert set(row) - set(without) <= set(told)
    assert row["sliding_time"] is not None  # of the last one
    assert all_keys(brief)[3] != all_keys(whole)[3]


def test_points_that_cannot_be_computed_do_not_disturb_the_others(study_of, monkeypatch):
    """A record that is gone, and an exception of the kernel."""
    layout = lay_out(study_of())
    points = list(layout)[:3]
    whole = rows(run_batch(layout.context, points))
    assert points[0].record is not None
    gone = points[0]._replace(record=points[0].record._replace(source="gone.at2"))

    def fragile(requests):
        if any(request.scale == 1.0 for request in requests):
            raise FloatingPointError("boom")
        return histories(requests)

    monkeypatch.setattr("rpscli.sweep.evaluation.histories", fragile)
    first, boom, last, missing = rows(run_batch(layout.context, [*points, gone]))
    assert [first, last] == [whole[0], whole[2]]
    assert boom["message"] == "FloatingPointError: boom"
    assert "gone.at2" in str(missing["message"])
    for failed in (boom, missing):
        assert failed["outcome"] == "failed"
        assert set(failed) == {"outcome", "message", "storey_shears"}


def test_modal_points_have_the_modes(study_of):
    layout = lay_out(study_of(WITHOUT_RECORDS + "analysis: modal\n"))
    columns = run_batch(layout.context, list(layout)).columns
    assert np.isnan(columns["rolling.frequency_ratio"][2]).all()  # flat
    modes = modal(layout.system(0).structure)
    assert modes.rolling is not None
    found = at_path(columns, "rolling.frequency_ratio.0")
    assert found is not None
    assert found[0] == modes.rolling.frequency_ratio[0]
    assert at_path(columns, "rolling.frequency_ratio.7") is None
    shape = columns["fixed_base.shapes"][0, 0].tolist()
    assert shape == [0.0, *modes.fixed_base.shapes[:, 0]]


def test_pushover_points_have_the_curve(study_of):
    layout = lay_out(study_of(WITHOUT_RECORDS + "analysis: pushover\n"))
    found = run_batch(layout.context, [layout[0]])
    expected = pushover(layout.system(0).structure)
    assert found.outcomes.tolist() == ["done"]
    assert found.columns["uplift_force"][0] == expected.uplift_force
    assert found.columns["curve.force"][0].tolist() == expected.curve.force.tolist()


MEMBERS = ("scale: [", "perturb: {members: 4, seed: 7}\nscale: [")
SAMPLE = (
    "scale: [",
    "sample: {size: 8, ranges: {podium.cap_beam_mass_ratio: [5, 10]}}\nscale: [",
)


def test_the_last_axis_runs_fastest(study_of):
    design = lay_out(study_of())
    expected = itertools.product(
        [(0.10, 0.20), (0.15, 0.30)], ["critical", 0.5, 0], [1, 2, 3], [0.5, 1.0]
    )
    points = [(*p.values, p.record and int(p.record.source[-1]), p.scale) for p in design]
    assert points == [(*pair, rho, seed, scale) for pair, rho, seed, scale in expected]
    assert len(design) == 2 * 3 * 3 * 2
    assert [point.number for point in design] == list(range(len(design)))


def test_members_of_an_ensemble_multiply_and_begin_with_the_point_itself(study_of):
    design = lay_out(study_of(STUDY, MEMBERS))
    assert len(design) == 36 * 4
    first = [design[i] for i in range(4)]
    assert (first[0].scale_change, first[0].restitution_change) == (1.0, 1.0)
    assert len({point.scale_change for point in first}) == 4
    assert all(abs(point.scale_change - 1.0) <= 0.01 for point in first)
    # The same perturbations everywhere, so that points can be compared.
    assert design[5].scale_change == design[1].scale_change


def test_more_members_leave_the_earlier_ones():
    few, many = (changes(PerturbSection(members=n)) for n in (3, 9))
    assert many[:3] == few


def test_samples_are_one_more_axis_and_repeat(study_of):
    first, second = (lay_out(study_of(STUDY, SAMPLE)) for _ in range(2))
    assert len(first) == 36 * 8
    assert first[100].values == second[100].values
    gamma = [first[i * first.points_of_system].values[-1] for i in range(8)]
    assert len(set(gamma)) == 8
    assert all(5.0 < value < 10.0 for value in gamma)


def test_distributions_have_the_moments_that_are_asked_for():
    kinds = ("uniform", "normal", "lognormal")
    ranges = {kind: RangeSection(distribution=kind, mean=2.0, cov=0.2) for kind in kinds}
    drawn = sample(SampleSection(method="sobol", size=4096, ranges=ranges))
    # The error of the mean of a scrambled Sobol sample of smooth functions is below 1/n^1.
    assert drawn.mean(axis=0) == pytest.approx([2.0] * 3, rel=1e-3)
    assert drawn.std(axis=0) == pytest.approx([0.4] * 3, rel=1e-2)
    assert np.log(drawn[:, 2]).std() == pytest.approx(
        math.sqrt(math.log1p(0.04)), rel=1e-2
    )


def test_latin_hypercube_has_one_value_in_each_stratum():
    section = SampleSection(method="latin_hypercube", size=10, ranges={"x": (0.0, 1.0)})
    assert sorted((sample(section)[:, 0] * 10).astype(int)) == list(range(10))


def test_ranges_may_have_the_unit_of_their_key():
    width, period = "podium.bearing.dimensions.width", "superstructure.period"
    ranges = {width: ["323 mm", 0.337]}
    ranges[period] = {"distribution": "normal", "mean": "420 ms", "cov": 0.1}
    found = SampleSection(size=2, ranges=ranges).ranges
    assert (found[width].low, found[width].high, found[period].mean) == (
        0.323,
        0.337,
        0.42,
    )
    with pytest.raises(ValidationError, match=r"is a mass, but must be a length"):
        SampleSection(size=2, ranges={width: ["323 kg", 0.337]})


def test_uneven_sobol_sizes_are_remarked_on():
    ranges = {"x": (0.0, 1.0)}
    assert balance_note(SampleSection(size=64, ranges=ranges)) is None
    assert "64" in str(balance_note(SampleSection(size=100, ranges=ranges)))


@pytest.mark.parametrize("measure", ["PGV", "Arias"])
def test_records_are_scaled_to_a_measure(study_of, measure):
    """Arias intensity grows with the square."""
    scale = f"scale: {{measure: {measure}, values: [0.3, 0.6]}}"
    design = lay_out(study_of(STUDY, ("scale: [0.5, 1.0]", scale)))
    for point in (design[0], design[9]):
        assert point.record is not None
        motion = load_record(point.record.source).scaled(design.context.factor(point))
        found = getattr(intensity_measures(motion), measure.lower())
        assert found == pytest.approx(point.scale, rel=1e-12)


def test_sa_is_taken_at_the_first_period_of_each_system(study_of):
    sa = ("scale: [0.5, 1.0]", "scale: {measure: Sa, values: [2.0]}")
    vary = (
        "  - podium.bearing.c",
        "  - superstructure.period: [0.3, 0.6]\n  - podium.bearing.c",
    )
    design = lay_out(study_of(STUDY, sa, vary))
    context = design.context
    periods = set()
    for system in range(4):
        point = design[system * 3 * design.points_of_system]
        assert point.record is not None
        assert point.period == pytest.approx(point.values[2], rel=1e-12)
        motion = load_record(point.record.source).scaled(context.factor(point))
        # The measure is linear in the motion.
        found = measured(motion, "Sa", float(point.values[2]), 0.05)
        assert found == pytest.approx(2.0, rel=1e-9)
        periods.add(point.period)
    assert len(periods) == 2


def test_keys_do_not_depend_on_how_a_study_arrives_at_a_point(study_of):
    whole = lay_out(study_of())
    turned = lay_out(
        study_of(STUDY, ("critical, 0.5, 0", "0, critical"), ("0.5, 1.0", "1.0"))
    )
    first, second = (all_keys(design) for design in (whole, turned))
    assert len(set(first)) == len(first)
    assert set(second) < set(first)
    titled = lay_out(study_of(STUDY, ("Test", "Other")))
    assert all_keys(titled) == first


def test_batches_hold_every_point_once_and_one_size_of_building(study_of):
    vary = (
        "  - podium.bearing.c",
        "  - superstructure.storeys: [2, 3]\n  - podium.bearing.c",
    )
    design = lay_out(study_of(STUDY, vary))
    pending = [number for number in range(len(design)) if number % 5]
    found = list(batches(design, pending, jobs=2))
    assert sorted(point.number for batch in found for point in batch) == pending
    assert max(map(len, found)) <= LARGEST_BATCH
    many = lay_out(
        study_of(STUDY, ("seed: [1, 2, 3]", "seed: {low: 1, high: 99, count: 99}"))
    )
    sizes = [len(batch) for batch in batches(many, range(len(many)), jobs=2)]
    assert sizes[:4] == [EARLY_BATCH] * 4  # a rate is soon known
    assert sizes[4] > EARLY_BATCH
    assert sum(sizes) == len(many)
    for batch in found:
        assert len({point.values[2] for point in batch}) == 1


class Points:
    """What is asked of a table, its layout and its context: every fourth history is chaotic."""

    def __init__(self, count, limits=()):
        self.failed = np.zeros(count, bool)
        self.layout = self.context = self
        self.points_of_system = count
        self.properties = [self]  # of its only system
        self.limits = limits
        self.structure = podium(1, 0.15, FLAT, superstructure=building(1, 0.1))
        self.chaotic = waves(60.0, 0.01, 3.0 * self.structure.uplift_acceleration, seed=3)
        found = demands([self.history(number) for number in range(count)])
        self.outcomes = np.array([one.outcome for one in found])
        names = "max_rotation", "max_base_shear", "max_lift"
        self.columns = {
            name: np.array([getattr(one, name) for one in found]) for name in names
        }

    def __getitem__(self, number):
        return number

    def history(self, number):
        motion = self.chaotic if number % 4 == 2 else stillness(1.0)
        settings = TimeHistorySettings(free_vibration=1.0)
        return DemandRequest(self.structure, MotionComponents(motion), settings)


def notes(points):
    return list(step_notes(points))


@needs_compiled_kernels
def test_points_whose_limited_results_change_are_named():
    """Of one outcome; what is small beside its limit decides nothing."""
    after = demands([
        replace(of, settings=replace(of.settings, accuracy=2.0))
        for of in map(Points(4).history, range(4))
    ])  # fmt: skip
    for limit, named in ((1e-9, True), (1e9, False)):
        points = Points(4, [Condition("max_lift", limit, "")])
        points.outcomes = np.array([each.outcome for each in after])
        (found,) = notes(points)
        assert "max_rotation" in found
        assert ("max_lift" in found) == named


@needs_compiled_kernels
def test_points_that_change_with_half_the_steps_are_named(monkeypatch):
    (found,) = notes(Points(4))
    assert found.startswith("steps: of 4 points (of 4) computed again")
    assert "1 changed: point 3 (" in found
    assert notes(Points(2)) == []
    failed = Points(4)
    failed.failed[2] = True
    assert notes(failed) == []
    monkeypatch.setattr(summary, "COMPUTED_AGAIN", 2)
    (found,) = notes(Points(4))  # the first and the third
    assert found.startswith("steps: of 2 points (of 4) computed again")
    assert "point 3 (" in found
