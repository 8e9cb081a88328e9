"""Points come in the order of the study, each with what the study says of it."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from rpscli.case.study.schema import PerturbSection, RangeSection, SampleSection
from rpscli.records.loading import load_record
from rpscli.records.measures import intensity_measures
from rpscli.records.spectrum import spectral_acceleration
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import LARGEST_BATCH, all_keys, batches
from rpscli.sweep.systems import balance_note, changes, sample
from sweep.small_studies import STUDY, Make

PERTURB = ("scale: [", "perturb: {members: 4, seed: 7}\nscale: [")
SAMPLE = ("scale: [", "sample: {size: 8, ranges: {podium.cap_beam_mass_ratio: [5, 10]}}\nscale: [")


def test_the_last_axis_runs_fastest(study_of: Make) -> None:
    design = lay_out(study_of())
    expected = itertools.product(
        [(0.10, 0.20), (0.15, 0.30)], ["critical", 0.5, 0], [1, 2, 3], [0.5, 1.0]
    )
    points = [
        (*point.values, point.record and int(point.record.source[-1]), point.scale)
        for point in design
    ]
    assert points == [(*pair, rho, seed, scale) for pair, rho, seed, scale in expected]
    assert len(design) == 2 * 3 * 3 * 2
    assert [point.number for point in design] == list(range(len(design)))


def test_members_of_an_ensemble_multiply_and_begin_with_the_point_itself(study_of: Make) -> None:
    design = lay_out(study_of(STUDY, PERTURB))
    assert len(design) == 36 * 4
    first = [design[i] for i in range(4)]
    assert (first[0].scale_change, first[0].restitution_change) == (1.0, 1.0)
    assert len({point.scale_change for point in first}) == 4
    assert all(abs(point.scale_change - 1.0) <= 0.01 for point in first)
    # The same perturbations everywhere, so that points can be compared.
    assert design[5].scale_change == design[1].scale_change


def test_more_members_leave_the_earlier_ones() -> None:
    few, many = (changes(PerturbSection(members=n)) for n in (3, 9))
    assert many[:3] == few


def test_samples_are_one_more_axis_and_repeat(study_of: Make) -> None:
    first, second = (lay_out(study_of(STUDY, SAMPLE)) for _ in range(2))
    assert len(first) == 36 * 8
    assert first[100].values == second[100].values
    gamma = [first[i * first.points_of_system].values[-1] for i in range(8)]
    assert len(set(gamma)) == 8
    assert all(5.0 < value < 10.0 for value in gamma)


def test_distributions_have_the_moments_that_are_asked_for() -> None:
    kinds = ("uniform", "normal", "lognormal")
    ranges = {kind: RangeSection(distribution=kind, mean=2.0, cov=0.2) for kind in kinds}
    drawn = sample(SampleSection(method="sobol", size=4096, ranges=ranges))
    # The error of the mean of a scrambled Sobol sample of smooth functions is below 1/n^1.
    assert drawn.mean(axis=0) == pytest.approx([2.0] * 3, rel=1e-3)
    assert drawn.std(axis=0) == pytest.approx([0.4] * 3, rel=1e-2)
    assert np.log(drawn[:, 2]).std() == pytest.approx(math.sqrt(math.log1p(0.04)), rel=1e-2)


def test_latin_hypercube_has_one_value_in_each_stratum() -> None:
    section = SampleSection(method="latin_hypercube", size=10, ranges={"x": (0.0, 1.0)})
    assert sorted((sample(section)[:, 0] * 10).astype(int)) == list(range(10))


def test_uneven_sobol_sizes_are_remarked_on() -> None:
    ranges = {"x": (0.0, 1.0)}
    assert balance_note(SampleSection(size=64, ranges=ranges)) is None
    assert "64" in str(balance_note(SampleSection(size=100, ranges=ranges)))


@pytest.mark.parametrize("measure", ["PGV", "Arias"])
def test_records_are_scaled_to_a_measure(study_of: Make, measure: str) -> None:
    """Arias intensity grows with the square."""
    scale = f"scale: {{measure: {measure}, values: [0.3, 0.6]}}"
    design = lay_out(study_of(STUDY, ("scale: [0.5, 1.0]", scale)))
    for point in (design[0], design[9]):
        assert point.record is not None
        motion = load_record(point.record.source).scaled(design.context.factor(point))
        found = getattr(intensity_measures(motion), measure.lower())
        assert found == pytest.approx(point.scale, rel=1e-12)


def test_sa_is_taken_at_the_first_period_of_each_system(study_of: Make) -> None:
    sa = ("scale: [0.5, 1.0]", "scale: {measure: Sa, values: [2.0]}")
    vary = (
        "  - podium.bearing.curv",
        "  - superstructure.period: [0.3, 0.6]\n  - podium.bearing.curv",
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
        found = spectral_acceleration(motion, float(point.values[2]), 0.05)
        assert found == pytest.approx(2.0, rel=1e-9)
        periods.add(point.period)
    assert len(periods) == 2


def test_keys_do_not_depend_on_how_a_study_arrives_at_a_point(study_of: Make) -> None:
    whole = lay_out(study_of())
    turned = lay_out(study_of(STUDY, ("critical, 0.5, 0", "0, critical"), ("0.5, 1.0", "1.0")))
    first, second = (all_keys(design) for design in (whole, turned))
    assert len(set(first)) == len(first)
    assert set(second) < set(first)
    titled = lay_out(study_of(STUDY, ("Test", "Other")))
    assert all_keys(titled) == first


def test_batches_hold_every_point_once_and_one_size_of_building(study_of: Make) -> None:
    vary = (
        "  - podium.bearing.curv",
        "  - superstructure.storeys: [2, 3]\n  - podium.bearing.curv",
    )
    design = lay_out(study_of(STUDY, vary))
    pending = [number for number in range(len(design)) if number % 5]
    found = list(batches(design, pending, jobs=2))
    assert sorted(point.number for batch in found for point in batch) == pending
    assert max(map(len, found)) <= LARGEST_BATCH
    for batch in found:
        assert len({point.values[2] for point in batch}) == 1
