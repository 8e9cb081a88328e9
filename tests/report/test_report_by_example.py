"""What small functions of `rpscli.report` give, by example."""

from __future__ import annotations

import math

from rpscli.report.figures.animation import _pace
from rpscli.report.figures.floors import shown_floors
from rpscli.report.figures.history import shown_floors as history_shown_floors
from rpscli.report.figures.motions import _second_tick
from rpscli.report.figures.style import _letters, engineering, in_rows, percent, typeset
from rpscli.report.html.page import element, written
from rpscli.report.study.fragility import LimitState, limit_name
from rpscli.report.study.labels import label, plain, symbol
from rpscli.report.study.lines import _distinct, _staggered
from rpscli.report.study.panels import over
from rpscli.report.study.report import add_notes, with_band
from rpscli.report.table import headed, large, measured, shown
from rpscli.report.table import percent as table_percent
from rpscli.report.tables.derivation import greek, numeric, symbolic


def test_figures_animation() -> None:
    assert (_pace(2.13), _pace(1.0), _pace(0.5)) == (
        "2.1 times faster than real",
        "in real time",
        "2 times slower than real",
    )


def test_figures_floors() -> None:
    assert (shown_floors(1), shown_floors(2), shown_floors(6)) == ([1], [1, 2], [1, 4, 6])


def test_figures_history() -> None:
    assert (history_shown_floors(0), history_shown_floors(2), history_shown_floors(9)) == (
        [],
        [2, 1],
        [9, 6, 3],
    )


def test_figures_motions() -> None:
    assert (_second_tick(0.2), _second_tick(0.4), _second_tick(50.0)) == ("0.2", "", "50")


def test_figures_style() -> None:
    assert (percent(0.05), percent(0.975)) == ("5 %", "97.5 %")
    assert typeset("PGA [m/s2]") == "PGA [m/s²]"
    assert in_rows("abcde", 3) == ["a", "d", "b", "e", "c"]
    assert _letters(r"$\theta_{cr}$ = 0.3") == 9
    assert (engineering(3.2e6), engineering(15.0), engineering(4e4)) == (
        (1e-06, "M"),
        (1.0, ""),
        (0.001, "k"),
    )


def test_html_page() -> None:
    assert (
        written(element("p", "a < b, ", element("b", "or not"), " & so on", class_="x"))
        == '<p class="x">a &lt; b, <b>or not</b> &amp; so on</p>'
    )


def test_study_fragility() -> None:
    assert (LimitState("rotation_ratio", 0.5).label, LimitState("min_column_force", 1e5).label) == (
        "rotation_ratio > 0.5",
        "min_column_force < 100000",
    )
    assert (
        limit_name(LimitState("drift_ratio", 0.002)),
        limit_name(LimitState("max_lift", 0.1)),
    ) == ("drift ratio > 0.002", "lift of the building > 0.1 m")


def test_study_labels() -> None:
    assert (symbol("superstructure.storeys"), symbol("podium.impact.law")) == ("n", "law")
    assert (label("superstructure.storeys", 3), label("podium.bearing.curvature_ratio", 0)) == (
        "n = 3",
        "flat ends",
    )
    assert label("title", "tower A") == "tower A"
    assert (label("superstructure.period", 0.3), label("superstructure.period", "300 ms")) == (
        "T₁ = 0.3 s",
        "T₁ = 300 ms",
    )
    assert (plain(0.25), plain([]), plain([{"kind": "stop", "gap": 0.2, "stiffness": 1e6}])) == (
        "0.25",
        "none",
        "stop 0.2 m",
    )


def test_study_lines() -> None:
    assert _distinct(("rolling.frequency_ratio.0", "rocking.frequency_ratio.0")) == [
        "rolling",
        "rocking",
    ]
    assert (_staggered(0, 1), _staggered(1, 3)) == ("--", (2, (2, 4)))


def test_study_panels() -> None:
    assert (over(("3 intensities", "4 members")), over(())) == (
        "over 3 intensities and 4 members",
        "",
    )


def test_study_report() -> None:
    assert (
        with_band(0.25, 0.125, 0.5),
        with_band(0.25, math.nan, math.nan),
        with_band(*[math.nan] * 3),
    ) == ("0.250 (0.12 to 0.50)", "0.250 (no band)", "-")
    notes = ["fragility: the data are separated"]
    add_notes(notes, "risk", ["the data are separated", "the hazard curve is continued"])
    assert notes == ["fragility: the data are separated", "risk: the hazard curve is continued"]


def test_table() -> None:
    assert (shown(0.10501282), shown(17321.4), shown(3), shown(None), shown(2.4e-9)) == (
        "0.1050",
        "17321",
        "3",
        "-",
        "2.400e-09",
    )
    assert (large(1.5e6, "N"), large(0.1, "rad"), large(None, "s"), large(0.2, "-")) == (
        (1500.0, "kN"),
        (0.1, "rad"),
        (None, "s"),
        (0.2, ""),
    )
    assert (headed("base shear", "N"), headed("rotation ratio", "-")) == (
        "base shear kN",
        "rotation ratio",
    )
    assert (measured(1.5e6, "N"), measured(None, "s"), measured(0.2, "-")) == (
        "1500 kN",
        "-",
        "0.2000",
    )
    assert (table_percent(1.0, 3.0), table_percent(1.0, 0.0)) == ("33.3 %", "-")


def test_tables_derivation() -> None:
    assert (symbolic("atan(tan_alpha / (1 - 2 * rho))"), symbolic("sin(alpha)^2")) == (
        "atan(tan α / (1 − 2 ρ))",
        "sin(α)²",
    )
    assert numeric("2 * R * cos(alpha)", {"R": 1.5, "alpha": 0.1488899}) == "2 · 1.5 · cos(0.14889)"
    assert (greek("gamma (1 + eta)"), greek("alpha'")) == ("γ (1 + η)", "α′")
