"""Annual rates against the closed form for a power law, quadrature, and the worst of input."""

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from conformance import conforms
from matplotlib.patches import Rectangle, StepPatch
from report.test_figures_of_studies import labelled, panels, same
from scipy.integrate import quad
from scipy.special import ndtr

from rpscli.case.conditions import parse_condition
from rpscli.errors import CaseError
from rpscli.report.study.report import with_band
from rpscli.report.study.statistics import verdict_lines
from rpscli.studies import load_study
from rpscli.sweep.statistics.hazard import (
    Hazard,
    annual_rate,
    exceeded,
    rate_of_shares,
    rates_above,
    read_hazard,
)
from rpscli.sweep.statistics.summary import summary
from rpscli.sweep.statistics.verdicts import judged
from sweep.small_studies import (
    STUDY,
    csv_rows,
    fallen,
    made,
)

KINKED = Hazard(
    np.array([0.1, 0.2, 0.4, 0.8, 1.6]), np.array([3e-2, 1e-2, 2e-3, 3e-4, 3e-5])
)
HEADER = "PGV [cm/s],rate [1/year]\n"


@pytest.mark.evidence("risk", "exact")
@pytest.mark.parametrize("slope", [0.0, 1.0, 2.5, 4.0])
@pytest.mark.parametrize("beta", [1e-3, 0.3, 0.6, 1.5])
def test_a_power_law_gives_the_closed_form(slope, beta):
    """Two points far apart are a power law throughout: H(median) exp(k^2 beta^2 / 2)."""
    median, ends = 0.7, np.array([1e-40, 1e40])
    hazard = Hazard(ends, 2e-4 * (ends / median) ** -slope)
    expected = 2e-4 * math.exp(0.5 * (slope * beta) ** 2)
    # Logarithms up to 370 lose three of sixteen digits.
    conforms(
        "risk", f"annual rate, slope {slope:g}, beta {beta:g}", expected,
        annual_rate(hazard, median, beta), 1e-12 * expected,
        "closed form", "H(median) exp(k^2 beta^2/2)",
    )  # fmt: skip


@pytest.mark.evidence("risk", "exact")
@pytest.mark.parametrize(
    ("median", "beta"), [(0.5, 0.4), (0.15, 0.7), (3.0, 0.2), (0.8, 0.02)]
)
def test_any_curve_gives_what_quadrature_gives(median, beta):
    x, y = np.log(KINKED.intensity), np.log(KINKED.rate)
    slopes = -np.diff(y) / np.diff(x)

    def density(at):
        piece = min(int(np.searchsorted(x, at, side="right")) - 1, len(slopes) - 1)
        rate = math.exp(y[piece] - slopes[piece] * (at - x[piece]))
        return float(ndtr((at - math.log(median)) / beta) * slopes[piece] * rate)

    def above(intensity):
        low, top = math.log(intensity), math.log(1.6) + 12.0
        middle = math.log(median)
        breaks = [*x[1:], *(middle + beta * step for step in (-6, -2, 0, 2, 6))]
        edges = [low, *sorted(b for b in breaks if low < b < top), top]
        parts = itertools.pairwise(edges)
        return sum(quad(density, a, b, epsabs=0.0, epsrel=1e-11)[0] for a, b in parts)

    at = np.array([0.1, 0.17, 0.4, 1.0, 1.6, 2.5])
    found = rates_above(KINKED, median, beta, at)
    # The tail that the quadrature leaves out is exp(-3.3 x 12) of the last rate.
    expected = np.array([above(float(value)) for value in at])
    conforms(
        "risk", f"annual rates above six intensities, median {median:g}, beta {beta:g}",
        expected, found, 1e-9 * expected, "closed form", "quadrature, scipy.integrate.quad",
    )  # fmt: skip
    assert annual_rate(KINKED, median, beta) == found[0]


@pytest.mark.evidence("risk", "exact")
def test_a_fragility_without_spread_has_the_rate_of_its_median():
    """Nor is a spread too wide, as bootstrap samples have: no rate exceeds the first of all."""
    assert annual_rate(KINKED, 0.4, 1e-9) == pytest.approx(2e-3, rel=1e-6)
    for beta in (20.0, 1e3, 1e8):
        assert 0.0 < annual_rate(KINKED, 0.5, beta) <= KINKED.rate[0]


@pytest.mark.evidence("risk", "exact")
def test_a_rate_straight_from_shares_is_what_quadrature_gives():
    """Shares between levels are linear in ln(im), and stay outside as they are at the ends."""
    levels, shares = (
        np.array([0.15, 0.3, 0.5, 2.0, 3.0]),
        np.array([0.1, 0.05, 0.4, 0.8, 0.9]),
    )
    # On a grid that holds every kink: mean share times the rate of each small step.
    points = np.concatenate([KINKED.intensity, levels, [1e4]])
    fine = np.exp(np.linspace(np.log(0.1), np.log(1e4), 400_001))
    at = np.unique(np.concatenate([points, fine]))
    x, y = np.log(KINKED.intensity), np.log(KINKED.rate)
    ends = np.interp(np.log(at), x, y)
    last = (y[-1] - y[-2]) / (x[-1] - x[-2])
    rate = np.exp(np.where(at > 1.6, y[-1] + last * (np.log(at) - x[-1]), ends))
    probable = np.interp(np.log(at), np.log(levels), shares)
    expected = float(-np.diff(rate) @ (probable[1:] + probable[:-1]) / 2.0)
    # Trapezoids over steps of 3e-5 of ln(im) are exact to their square.
    conforms(
        "risk", "annual rate from shares", expected, rate_of_shares(KINKED, levels, shares),
        1e-8 * expected, "closed form", "400,000 trapezoids on a grid with every kink",
    )  # fmt: skip
    assert rate_of_shares(KINKED, np.array([0.01]), np.array([0.3])) == pytest.approx(
        0.3 * 3e-2
    )
    flat = Hazard(np.array([0.1, 0.5, 1.0]), np.array([1e-2, 1e-2, 1e-3]))
    step = rate_of_shares(flat, np.array([0.1, 0.5]), np.array([0.0, 1.0]))
    assert step == pytest.approx(
        1e-2
    )  # up to 0.5 no motion is counted, from there on all


def test_a_study_judges_the_annual_rate_of_each_system(study_of, tmp_path):
    """None, one and all of three records overturn at 0.3, 0.6 and 1.2 m/s; H = 1e-3 / PGV.

    Between levels the mean of H over ln(PGV) is its difference over ln 2.
    """
    (tmp_path / "hazard.csv").write_text("PGV [m/s],rate [1/year]\n0.1,1e-2\n10,1e-4\n")
    scale = "scale: {measure: PGV, values: [1.2, 0.3, 0.6]}\nhazard: {file: hazard.csv,"
    scale += " measure: PGV}\nlimits: {annual_rate: 1.5e-3}"

    def answer(at):
        """All systems but the first, of nine points."""
        return fallen(
            at["scale"] > (0.5, 1.0, 1.0)[at["record"] - 1] and at["number"] >= 9
        )

    table = made(study_of, answer, ("scale: [0.5, 1.0]", scale)).table
    first, *others = judged(table, summary(table, {}))
    exact = (1e-3 / 0.3 - 1e-3 / 0.6) / 3.0 + 2.0 * (1e-3 / 0.6 - 1e-3 / 1.2) / 3.0
    assert (first.value, first.word) == (
        0.0,
        "met, not shown",
    )  # three records show little
    assert [verdict.value for verdict in others] == pytest.approx(
        [exact / math.log(2.0)] * 5
    )
    assert [verdict.word for verdict in others] == ["EXCEEDED"] * 5
    assert others[0].values == (0.10, 0.5, "all")
    assert len(verdict_lines(summary(table, {}).keys, [first, *others])) == 5
    strictly = judged(table, summary(table, {}), [parse_condition("not-shown")])
    line, *_ = lines = verdict_lines(summary(table, {}).keys, strictly)
    assert (line[:33], len(lines)) == ("limit not shown to be met: annual", 6)


def test_rates_of_the_motion_are_those_of_the_curve():
    found = exceeded(KINKED, np.array([0.1, 0.2, math.sqrt(0.08), 1.6, 3.2]))
    expected = [3e-2, 1e-2, math.sqrt(1e-2 * 2e-3), 3e-5, 3e-6]
    assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("zeros", [0, 2])
def test_units_comments_and_rates_of_zero_of_a_hazard_file(tmp_path, zeros):
    path = tmp_path / "hazard.csv"
    text = f"# a remark, with a comma\n{HEADER}10,0.1\n\n20, 0.01\n" + "40,0.0\n" * zeros
    path.write_text(text, encoding="utf-8")
    found = read_hazard(path, "PGV")
    assert found.intensity.tolist() == pytest.approx([0.1, 0.2])
    assert (found.rate.tolist(), found.left_out) == ([0.1, 0.01], zeros)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", ("at least two rows", "`PGV [cm/s],rate [1/year]`")),
        (HEADER + "10,0.1\n", ("at least two rows",)),
        (
            "PGA [g],rate [1/year]\n1,1\n2,1\n",
            (":1:", "the header", "PGA [g]", "PGV [cm/s]"),
        ),
        ("PGV [g],rate [1/year]\n1,1\n2,1\n", (":1:", "1 g", "a velocity")),
        (
            "PGV,rate\n1,1\n2,1\n",
            (":1:", "the header", "lacks the unit of 'PGV', 'rate'"),
        ),
        ("PGV,rate [1/year]\n1,1\n2,1\n", ("the unit of 'PGV': write `PGV [cm/s],rate",)),
        ("PGV [cm/s],rate [%]\n1,1\n2,1\n", ("the unit of rate must be one of 1/year",)),
        ("PGV [cm/s],rate [1/a],84 [1/a]\n1,1,1\n2,1,1\n", ("'84' must be a fractile",)),
        (
            "PGV [m/s],mean [1/a],0.84 [1/a]\n1,1,1\n2,1,2\n",
            (":3:", "'2'", "not more frequent"),
        ),
        (HEADER + "10,0.1\n5,0.01\n", (":3:", "'5'", "above the row before")),
        (HEADER + "10,0.1\n20,0.2\n", (":3:", "'0.2'", "not more frequent")),
        (HEADER + "10,0\n20,0.1\n", (":2:", "'10,0'", "two numbers > 0")),
        (HEADER + "10,0.1\n20,nan\n", (":3:", "two numbers > 0")),
        (HEADER + "10,0.1,3\n20,1\n", (":2:", "two numbers > 0")),
    ],
)
def test_hazard_files_that_are_refused(text, parts, tmp_path):
    path = tmp_path / "hazard.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as refused:
        read_hazard(path, "PGV")
    for part in ("hazard.csv", *parts):
        assert part in str(refused.value)


MEASURED = STUDY.replace(
    "scale: [0.5, 1.0]", "scale: {measure: PGV, values: [0.3, 0.9, 2.7]}"
)


def with_risk(options, hazard):
    """The study with this report, beside its hazard curve."""
    Path("hazard.csv").write_text(hazard, encoding="utf-8")
    return f"{MEASURED}reports:\n  - risk: {options}\n"


def shows_contributions(figure, written, parts):
    """Require that a figure shows the rates of one file and their parts of another."""
    labelled(figure, "PGV [m/s]", "share of the annual rate [%]")
    words = " ".join(figure.get_suptitle().split())
    assert "P in 50 years, 95 % bands of the choice of records" in words
    titles = {
        "rotation ratio > 0.2": "rotation_ratio > 0.2",
        "overturning": "overturning",
    }
    for title, axes in panels(figure).items():
        systems = [row for row in written if row["limit [-]"] == titles[title]]
        steps = [patch for patch in axes.patches if isinstance(patch, StepPatch)]
        drawn = [patch for patch in steps if patch.get_label()]
        beyond = [patch for patch in steps if not patch.get_label()]
        told = [text.get_text() for text in axes.texts]
        grey = [patch for patch in axes.patches if isinstance(patch, Rectangle)]
        *below, above = sorted(grey, key=Rectangle.get_x)
        assert above.get_x() == 2.7
        assert len(below) == (axes.get_xlim()[0] < 0.3)
        for patch in below:
            same(patch.get_x() + patch.get_width(), 0.3)
        for system, patch, last, words in zip(systems, drawn, beyond, told, strict=True):
            keys = ("limit [-]", *(key for key in system if key.startswith("podium")))
            of = [part for part in parts if all(part[key] == system[key] for key in keys)]
            shares = [100.0 * float(part["share [-]"]) for part in of]
            values, edges, _ = patch.get_data()
            same(values, shares[:-1])
            same(edges, [float(part["PGV_from [m/s]"]) for part in of])
            same(last.get_data()[0], shares[-1:])
            ends = (
                system[f"probability_in_50_years{end} [-]"]
                for end in ("", "_low", "_high")
            )
            assert words == f"P = {with_band(*(float(end or 'nan') for end in ends))}"
        same(axes.get_xlim()[1], 1.1 * 1.4 * edges[-1])


def are_margins(known, margins):
    """Require the margins of the rates: by 0.6 m/s and a spectral shape of 1.2."""
    for row, margin in zip(known, margins, strict=True):
        cmr = row["median"] / 0.6
        assert (margin["name"], margin["PGV"]) == ("MCE", pytest.approx(0.6))
        assert margin["CMR"] == pytest.approx(cmr)
        assert margin["ACMR"] == pytest.approx(1.2 * cmr)
        below = -math.log(1.2 * cmr)
        assert margin["probability"] == pytest.approx(ndtr(below / row["beta_total"]))
        assert margin["probability_of_records"] == pytest.approx(
            ndtr(below / row["beta"])
        )
        # Whose ACMR is that of 10 % has 10 %.
        for share in (10, 20):
            z = -math.log(margin[f"ACMR_{share}"]) / row["beta_total"]
            assert ndtr(z) == pytest.approx(0.01 * share)


@pytest.mark.evidence("risk", "published")
def test_rates_margins_and_dispersions_are_those_of_fema_p695(
    workplace, sweep_json, sweep, monkeypatch
):
    options = (
        "{hazard: {file: hazard.csv, measure: PGV, component: component}, at: {MCE: 60 cm/s},"
        " spectral_shape: 1.2, resamples: 50, limits: {rotation_ratio: 0.2},"
        " dispersion: {design_requirements: 0.2, test_data: 0.3, modelling: 0.4}}"
    )
    curves = "PGV [cm/s],mean [1/a],0.84 [1/a]\n1,1,3\n10,0.1,0.3\n100,1e-3,3e-3\n400,3e-4,9e-4\n"
    text = with_risk(options, curves).replace("[critical, 0.5, 0]", "[0.5, 0]")
    found = sweep_json("study.yaml", "-o", "out", study=text)["reports"]["risk"]
    known = [row for row in found["rows"] if row["median"] is not None]
    assert known
    hazard = read_hazard(workplace / "hazard.csv", "PGV")
    assert list(hazard.fractiles) == [0.84]
    written = [row for row in csv_rows("risk.csv", "out") if row["annual_rate [1/year]"]]
    for row, cells in zip(known, written, strict=True):
        total = math.sqrt(row["beta"] ** 2 + 0.2**2 + 0.3**2 + 0.4**2)
        assert row["beta_total"] == pytest.approx(total, rel=1e-12)
        assert row["annual_rate"] == pytest.approx(
            annual_rate(hazard, row["median"], total)
        )
        rate = float(cells["annual_rate [1/year]"])
        assert rate == pytest.approx(row["annual_rate"], rel=1e-8)
        assert float(cells["return_period [year]"]) == pytest.approx(1.0 / rate)
        low, high = (cells[f"annual_rate_{end} [1/year]"] for end in ("low", "high"))
        assert (low == "") == (high == "")
        assert not low or float(low) < rate < float(high)
        assert float(cells["probability_in_50_years [-]"]) == pytest.approx(
            -math.expm1(-50 * rate)
        )
        own = annual_rate(hazard, row["median"], row["beta"])
        assert row["annual_rate_of_records"] == pytest.approx(own)
        # Three times the mean curve throughout.
        assert row["annual_rate_of_hazard_84"] == pytest.approx(3.0 * row["annual_rate"])
        tail = float(rates_above(hazard, row["median"], total, np.array([2.7]))[0])
        assert row["share_beyond_computed"] == pytest.approx(tail / row["annual_rate"])
        above = float(rates_above(hazard, row["median"], total, np.array([0.3]))[0])
        below = 1.0 - above / row["annual_rate"]
        assert row["share_below_computed"] == pytest.approx(below, abs=1e-12)
        tail = float(rates_above(hazard, row["median"], total, np.array([4.0]))[0])
        assert row["share_beyond_hazard"] == pytest.approx(tail / row["annual_rate"])
    below = [row["share_below_computed"] for row in known]
    assert max(below) > 0.05
    are_margins(known, [m for m in found["at"] if m["CMR"] is not None])
    assert "modelling 0.4" in found["remark"]
    parts = csv_rows("risk_contributions.csv", "out")
    assert sum(float(part["share [-]"]) for part in parts) == pytest.approx(
        len(known), rel=1e-8
    )
    assert (workplace / "out" / "risk.png").exists()
    shows_contributions(load_study("study.yaml").run("out").draw("risk"), written, parts)
    monkeypatch.setenv("COLUMNS", "400")
    ran = sweep("study.yaml", "-o", "out")
    for words in (
        "beta total",
        "rate of hazard 84 %",
        "ACMR",
        "MCE",
        "95 % bands of the choice",
        f"{100.0 * max(below):.0f} % of the annual rate",
        "come from below the weakest intensity computed, by the fitted curve",
    ):
        assert words in " ".join((ran.stdout + ran.stderr).split())
    refused = sweep("study.yaml", "-o", "out", study=text.replace("60 cm/s", "60 cm"))
    assert "at: is a length, but must be a velocity" in refused.stderr


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (
            "{hazard: {file: no.csv, measure: PGV}}",
            ("study.yaml:12", "no.csv", "no such file"),
        ),
        ("{hazard: {file: hazard.csv, measure: Sa}}", ("one period", "`period`")),
        (
            "{hazard: {file: hazard.csv, measure: PGV}, measure: PGA}",
            ("remove the first",),
        ),
        ("{limits: {rotation_ratio: 0.2}}", ("hazard",)),
    ],
)
def test_a_risk_needs_a_hazard(options, parts, sweep):
    result = sweep(
        "study.yaml", "--dry-run", study=with_risk(options, HEADER + "1,1\n10,0.1\n")
    )
    assert result.exit_code == 3
    for part in parts:
        assert part in result.stderr
