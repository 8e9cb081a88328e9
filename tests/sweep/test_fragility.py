"""Fragility fits against statsmodels, and sense where the data are separated."""

import math
from pathlib import Path

import numpy as np
import pytest
from conformance import conforms

from rpscli.report.study.fragility import (
    fragilities,
    fragility,
)
from rpscli.report.study.fragility_options import FragilityOptions, LimitStates
from rpscli.report.study.scatter import (
    PulseSection,
    SpectrumOptions,
    overturning_spectrum,
    records_without_period,
)
from rpscli.sweep.statistics.lognormal import (
    Bootstrap,
    band,
    lognormal_fit,
    probit_fit,
)
from sweep.small_studies import (
    BROKEN,
    RHO,
    WITHOUT_RECORDS,
    cells,
    fallen,
    made,
    stored,
)

MEDIAN, BETA = 0.8, 0.4


def drawn(count, seed=0):
    """Intensities, and whether structures of a known fragility passed their limit."""
    random = np.random.default_rng(seed)
    im = np.exp(random.uniform(math.log(0.2), math.log(3.0), count))
    capacity = MEDIAN * np.exp(BETA * random.normal(size=count))
    return im, im > capacity


def fit(im, y, weight=1.0, *, resamples=200, confidence=0.9, seed=1):
    bootstrap = Bootstrap(resamples, confidence, seed)
    return lognormal_fit(im, y, np.arange(len(im)), weight, np.array([0.8]), bootstrap)


@pytest.mark.evidence("statistics and fragilities", "program")
@pytest.mark.parametrize(("count", "seed"), [(40, 1), (400, 2), (4000, 3)])
def test_maximum_likelihood_is_that_of_statsmodels(count, seed):
    models = pytest.importorskip("statsmodels.api")
    im, y = drawn(count, seed)
    theirs = models.Probit(y.astype(float), models.add_constant(np.log(im))).fit(
        disp=0, method="newton", tol=1e-14, maxiter=100
    )
    a, b = theirs.params
    ours = fit(im, y, resamples=0)
    assert ours.method == "maximum likelihood"
    # Both stop where the likelihood is flat to rounding: parameters agree to its square root.
    for name, expected, found in (
        ("median", math.exp(-a / b), ours.median),
        ("beta", 1.0 / b, ours.beta),
    ):
        conforms(
            "statistics and fragilities", f"{name} of {count} points", expected, found,
            1e-7 * expected, "independent program", "probit regression of statsmodels",
        )  # fmt: skip


@pytest.mark.evidence("statistics and fragilities", "exact")
def test_the_fit_finds_the_fragility_that_made_the_data():
    im, y = drawn(20_000)
    found = fit(im, y, resamples=0)
    # Standard errors at this size are 0.5 % of the median and 1 % of beta.
    assert found.median == pytest.approx(MEDIAN, rel=0.02)
    assert found.beta == pytest.approx(BETA, rel=0.04)


@pytest.mark.evidence("statistics and fragilities", "exact")
def test_bootstrap_bands_cover_the_truth_about_as_often_as_they_say():
    inside = 0
    for seed in range(40):
        low, high = fit(*drawn(150, seed), resamples=100, confidence=0.9).median_band
        inside += low <= MEDIAN <= high
    # Binomial with p = 0.9 and 40 trials: below 30 or at all 40 has a chance below 2 %.
    assert 30 <= inside <= 40


def test_separated_data_get_a_warning_and_a_sane_beta():
    im = np.array([0.2, 0.3, 0.5, 0.6, 0.9, 1.2, 1.5, 2.0])
    y = im > 0.7
    found = fit(im, y)
    assert found.method == "penalised"
    assert found.note is not None
    assert "separated: up to 0.6" in found.note
    assert 0.6 < found.median < 0.9
    # Far from the spike that an unpenalised fit ends in, and no wider than the data.
    assert 0.1 < found.beta < 1.0
    # Every resample would have the same penalty: the data alone say only where the median lies.
    assert found.between == (0.6, 0.9)
    assert np.isnan([*found.median_band, *found.beta_band, *np.ravel(found.band)]).all()


@pytest.mark.parametrize(
    ("beyond", "between", "words"),
    [
        # two of ten at the strongest level, nothing computed above
        ([0, 0, 2], (0.8, math.inf), "none at smaller ones, no larger one was computed"),
        ([3, 10, 10], (0.0, 0.8), "no smaller one was computed, all at larger ones"),
        ([0, 4, 10], (0.4, 1.6), "none at smaller ones, all at larger ones"),
    ],
)
@pytest.mark.parametrize("members", [1, 20])
def test_one_level_alone_with_both_outcomes_determines_no_beta(
    beyond, between, words, members
):
    """Nor do copies of every point under intensities that differ by 1 % at most."""
    random = np.random.default_rng(3)
    level = np.repeat([0.4, 0.8, 1.6], 10 * members)
    y = np.concatenate([np.repeat(np.arange(10) < n, members) for n in beyond])
    record = np.tile(np.repeat(np.arange(10), members), 3)
    im = level * random.uniform(0.99, 1.01, len(level)) if members > 1 else level
    bootstrap = Bootstrap(100, 0.95, 1)
    found = lognormal_fit(im, y, record, 1.0 / members, np.array([0.8]), bootstrap, level)
    assert found.method == "penalised"
    assert found.note is not None
    few = next(count for count in beyond if 0 < count < 10)
    counts = f"alone {few * members} of {10 * members} points exceed the limit, {words}"
    assert counts in found.note
    assert found.between == between
    assert np.isnan([*found.median_band, *found.beta_band, *np.ravel(found.band)]).all()


def test_samples_that_determine_nothing_count_beyond_both_ends():
    values = np.arange(1.0, 101.0)
    assert band(values, 0.9) == (5.0, 96.0)  # ranks of 5 % and 95 % of 99 steps, outwards
    values[[3, 50, 80]] = math.nan
    assert band(values, 0.9) == (2.0, 99.0)  # three less at either end
    values[:4] = math.nan
    assert np.isnan(band(values, 0.9)).all()  # more than a tail of 5 %


def test_a_share_that_hardly_grows_has_no_beta_beyond_all_sense():
    random = np.random.default_rng(3)
    im = np.exp(random.uniform(-1.0, 1.0, 60))
    found = fit(im, random.uniform(size=60) < 0.45 + 0.05 * im, resamples=400)
    assert found.fitted
    assert np.nanmax(found.resampled[1]) < 100.0
    assert np.isnan(found.beta_band).all()


def test_variations_of_the_same_motions_do_not_pretend_to_more_data():
    im = np.array([0.3, 0.5, 0.9, 1.5])
    once = fit(im, im > 0.7, resamples=0)
    often = fit(np.repeat(im, 50), np.repeat(im > 0.7, 50), weight=1 / 50, resamples=0)
    assert often.beta == pytest.approx(once.beta, rel=1e-6)
    assert (
        fit(np.repeat(im, 50), np.repeat(im > 0.7, 50), resamples=0).beta
        < 0.3 * once.beta
    )


@pytest.mark.evidence("statistics and fragilities", "exact")
def test_the_penalised_fit_is_the_maximum_of_its_objective():
    x = np.linspace(-1.0, 1.0, 12)
    y = x > 0.2
    ones = np.ones((1, 12))
    found = probit_fit(x, y, ones, np.array([True]))

    def objective(a, b):
        eta = a + b * x
        p = np.array([0.5 * math.erfc(-e / math.sqrt(2.0)) for e in eta])
        density = np.exp(-0.5 * eta**2) / math.sqrt(2.0 * math.pi)
        w = density**2 / (p * (1.0 - p))
        information = w.sum() * (w @ x**2) - (w @ x) ** 2
        return float(
            np.sum(np.log(np.where(y, p, 1.0 - p))) + 0.5 * math.log(information)
        )

    a, b = float(found.intercept[0]), float(found.slope[0])
    top = objective(a, b)
    for da, db in ((1e-3, 0.0), (-1e-3, 0.0), (0.0, 1e-3), (0.0, -1e-3), (1e-3, 1e-3)):
        assert objective(a + da, b + db) < top


@pytest.mark.parametrize(
    ("flags", "note"),
    [
        ([0, 0, 0, 0], "larger intensities"),
        ([1, 1, 1, 1], "smaller intensities"),
        ([1, 1, 0, 0], "does not grow"),
        ([1, 0, 1, 0], "does not grow"),
    ],
)
def test_hopeless_data_get_no_curve_but_a_reason(flags, note):
    found = fit(np.array([0.5, 1.0, 1.5, 2.0]), np.array(flags, dtype=bool))
    assert found.method == "none"
    assert found.note is not None
    assert note in found.note
    assert math.isnan(found.median)


def test_bands_leave_out_bootstrap_samples_without_a_fit():
    # A quarter of all samples has the second record twice, and thus one intensity alone.
    im, y = np.array([0.5, 1.0, 1.5, 2.0]), np.array([False, True, False, True])
    cluster = np.array([0, 0, 0, 1])
    words = "bootstrap samples of the records give no fragility"
    found, none = (
        lognormal_fit(im, y, cluster, 1.0, np.array([0.8]), Bootstrap(60, confidence, 1))
        for confidence in (0.1, 0.9)
    )
    assert found.note is not None
    lost = int(found.note.split()[0])
    # Binomial with p = 1/4 and 60 trials: outside of these has a chance below 0.1 %.
    assert 4 <= lost <= 27
    assert found.note == f"{lost} of 60 {words}"
    # Their slopes would be anything up to 1e275.
    assert np.abs(np.log(found.beta_band)).max() < 50.0
    assert 0.0 <= found.band[0][0] <= found.band[1][0] <= 1.0
    assert none.note == f"{lost} of 60 {words}: too many for bands"
    assert np.isnan([*none.median_band, *none.beta_band, *np.ravel(none.band)]).all()
    assert (none.median, none.beta) == (found.median, found.beta)


MEASURED = ("scale: [0.5, 1.0]", "scale: {measure: PGV, values: [0.2, 0.4, 0.8]}")


def test_overturned_points_exceed_every_limit_and_failed_ones_none(study_of):
    def answer(at):
        ratio = 0.9 if at["number"] % 2 else 0.1
        return (
            fallen(at["scale"] == 0.8, rotation_ratio=ratio) if at["number"] else BROKEN
        )

    options = FragilityOptions(
        limits=LimitStates(rotation_ratio=(0.5,), drift_ratio=(0.01,)),
        series=(),
        resamples=0,
    )
    report = fragilities(made(study_of, answer, MEASURED), options)
    assert [curve.limit.label for curve in report.curves] == [
        "rotation_ratio > 0.5",
        "drift_ratio > 0.01",
        "overturning",
    ]
    rotation, drift, overturning = report.curves
    assert report.intensity.measure == "PGV"
    assert (rotation.counted, rotation.failed) == (53, 1)
    assert (drift.exceeded, overturning.exceeded) == (18, 18)
    assert rotation.exceeded > 18
    assert rotation.observed.intensity.tolist() == pytest.approx(
        [0.2, 0.4, 0.8], rel=1e-12
    )
    # Each of three limits counts the 18 overturned histories; drift and overturning are separated.
    counts = f"36 of {rotation.exceeded + 18} histories beyond a limit overturned"
    notes = list(report.notes)
    assert len(notes) == 3
    said = "2 of 3 curves, such as drift_ratio > 0.01: the data are separated"
    assert notes[2].startswith(said)
    lost = ((curve, f"{n} of 400 fail") for n, curve in enumerate(report.curves))
    assert [*report.told(lost)] == [
        "3 of 3 curves, such as rotation_ratio > 0.5: 0 of 400 fail"
    ]
    assert notes[0].startswith(
        "pools 2 values of podium.bearing.slenderness and 3 values"
    )
    assert notes[1].endswith(counts)


@pytest.mark.parametrize(("one_in", "beyond"), [(5, True), (1, False)])
def test_a_median_beyond_all_intensities_is_called_extrapolated(study_of, one_in, beyond):
    every = {0.2: 1000, 0.4: 7, 0.8: one_in}

    def answer(at):
        high = at["number"] % every[at["scale"]] == 0 and at["scale"] > 0.2
        return stored(rotation_ratio=0.9 if high else 0.1)

    options = FragilityOptions(
        limits=LimitStates(rotation_ratio=(0.5,), overturning=False),
        series=(),
        resamples=0,
    )
    results = made(study_of, answer, MEASURED)
    (curve,) = fragilities(results, options).curves
    assert curve.fit.fitted
    assert (curve.fit.median > 0.8) == beyond
    assert ("extrapolated" in fragility(results, options).remark) == beyond


PULSES = """\
records: [{source: "pulse:sine?amplitude=1g", period: [0.5, 1.0]}, mine.txt]
scale: [0.2, 0.4]
"""


def test_overturning_spectra_are_dimensionless(study_of):
    text = WITHOUT_RECORDS + PULSES.replace(", mine.txt", "")
    results = made(
        study_of, lambda at: fallen(at["scale"] > 0.3, scale=at["scale"]), text=text
    )
    found = overturning_spectrum(results, SpectrumOptions())
    points, p = cells(found), results.table.layout.properties[0].frequency_parameter
    assert points["frequency_over_p"][:2] == pytest.approx(
        [4.0 * math.pi / p] * 2, rel=1e-12
    )
    # A sampled sine has its peak on a sample: the amplitude is exact to rounding.
    amplitudes = points["amplitude_over_g_tan_alpha"][:2]
    assert amplitudes == pytest.approx([0.2 / 0.10, 0.4 / 0.10], rel=1e-9)
    drawn = found.drawn("title")
    (least,) = [
        line for line in drawn.axes[0].lines if line.get_label() == "least that overturns"
    ]
    assert least.get_ydata() == pytest.approx([4.0, 4.0], rel=1e-9)


def test_a_file_has_its_place_in_a_spectrum_and_systems_share_the_axes(study_of):
    lines = [f"{0.01 * i} {math.sin(math.pi * i / 40.0)}" for i in range(81)]
    Path("mine.txt").write_text(
        "# Time (s) Acceleration (m/s2)\n" + "\n".join(lines) + "\n"
    )
    # Rounding decides at the border of uplift: 1e-9 of the critical rotation is none in a figure.
    low = stored(scale=0.4, rotation_ratio=1e-9)
    results = made(study_of, lambda _: low, text=WITHOUT_RECORDS + PULSES)
    layout = results.table.layout
    missing = list(records_without_period(layout, SpectrumOptions()))
    assert len(missing) == 1
    assert "mine.txt is not a pulse with a period" in missing[0]
    assert "pulses: {mine.txt: {period: 0.8, amplitude: 3.9}}" in missing[0]
    pulse = PulseSection(period=0.8, amplitude=1.0)
    options = SpectrumOptions(pulses={"mine.txt": pulse}, series=(RHO,))
    assert not list(records_without_period(layout, options))
    found = overturning_spectrum(results, options)
    points, properties = cells(found), layout.properties[0]
    assert set(points[RHO]) == {"critical", 0.5, 0}
    of_file = points[RHO].index(0.5) - 1  # the last point of the first series
    assert points["frequency_over_p"][of_file] == pytest.approx(
        2.0 * math.pi / 0.8 / properties.frequency_parameter, rel=1e-12
    )
    amplitude = points["amplitude_over_g_tan_alpha"][of_file]
    assert amplitude == pytest.approx(0.4 / (9.80665 * 0.10), rel=1e-9)
    assert set(points["outcome"]) == {"survived"}
    alone = overturning_spectrum(results, SpectrumOptions(pulses={"mine.txt": pulse}))
    drawn = alone.drawn("title")
    assert [line.get_label() for line in drawn.axes[0].lines] == [
        "at rest",
        "least that overturns",
    ]
