"""What small functions of `rpscli.report` give, by example."""

from __future__ import annotations

import math
from typing import Any

import pytest

from rpscli.report import table
from rpscli.report.derived import greek, numeric, symbolic
from rpscli.report.figures import floors, history, style
from rpscli.report.study.fragility import LimitState
from rpscli.report.study.panels import over
from rpscli.report.study.report import add_notes, label, plain, symbol, with_band

RHO = "podium.bearing.curvature_ratio"
STOP = {"kind": "stop", "gap": 0.2, "stiffness": 1e6}
EXAMPLES: dict[str, list[tuple[Any, Any]]] = {
    "floors": [
        ([floors.shown_floors(n) for n in (1, 2, 6)], [[1], [1, 2], [1, 4, 6]]),
        ([history.shown_floors(n) for n in (0, 2, 9)], [[], [2, 1], [9, 6, 3]]),
    ],
    "style": [
        ([style.percent(share) for share in (0.05, 0.975)], ["5 %", "97.5 %"]),
        (style.typeset("PGA [m/s2]"), "PGA [m/s²]"),
        (style.folded(r"$|\theta_{max}|$ [-], flat", 0.6, 8.0), "$|\\theta_{max}|$ [-],\nflat"),
        (style.folded("a_name_of_many_letters", 0.6, 8.0), "a_name_of\n_many_let\nters"),
        *((style.engineering(size), (1e-6, "M")) for size in (1e6, 3.2e6, 7e9)),
        *((style.engineering(size), (1e-3, "k")) for size in (1e3, 4e4, 5e5)),
        *((style.engineering(size), (1.0, "")) for size in (0.5, 15.0, 999.0)),
    ],
    "limit states": [
        (LimitState("rotation_ratio", 0.5).label, "rotation_ratio > 0.5"),
        (LimitState("min_column_force", 1e5).label, "min_column_force < 100000"),
        (LimitState("drift_ratio", 0.002).title, "drift ratio > 0.002"),
        (LimitState("max_lift", 0.1).title, "lift of the building > 0.1 m"),
    ],
    "labels": [
        (symbol("superstructure.storeys"), "n"),
        (symbol("podium.impact.law"), "law"),
        (label("superstructure.storeys", 3), "n = 3"),
        (label(RHO, 0), "flat ends"),
        (label("title", "tower A"), "tower A"),
        (label("superstructure.period", 0.3), "T₁ = 0.3 s"),
        (label("superstructure.period", "300 ms"), "T₁ = 300 ms"),
        ([plain(value) for value in (0.25, [], [STOP])], ["0.25", "none", "stop 0.2 m"]),
    ],
    "remarks": [
        (over(("3 intensities", "4 members")), "over 3 intensities and 4 members"),
        (over(()), ""),
        (with_band(0.25, 0.125, 0.5), "0.250 (0.12 to 0.50)"),
        (with_band(0.25, math.nan, math.nan), "0.250 (no band)"),
        (with_band(*[math.nan] * 3), "-"),
    ],
    "numbers": [
        ([table.shown(value) for value in (0.10501282, 17321.4, 3)], ["0.1050", "17321", "3"]),
        ([table.shown(value) for value in (None, 2.4e-9)], ["-", "2.400e-09"]),
        (table.large(1.5e6, "N"), (1500.0, "kN")),
        (table.large(0.1, "rad"), (0.1, "rad")),
        (table.large(None, "s"), (None, "s")),
        (table.large(0.2, "-"), (0.2, "")),
        (table.headed("base shear", "N"), "base shear kN"),
        (table.headed("rotation ratio", "-"), "rotation ratio"),
        (table.measured(1.5e6, "N"), "1500 kN"),
        (table.measured(None, "s"), "-"),
        (table.measured(0.2, "-"), "0.2000"),
        (table.percent(1.0, 3.0), "33.3 %"),
        (table.percent(1.0, 0.0), "-"),
    ],
    "formulas": [
        (symbolic("atan(tan_alpha / (1 - 2 * rho))"), "atan(tan α / (1 − 2 ρ))"),
        (symbolic("sin(alpha)^2"), "sin(α)²"),
        (numeric("2 * R * cos(alpha)", {"R": 1.5, "alpha": 0.1488899}), "2 · 1.5 · cos(0.14889)"),
        (greek("gamma (1 + eta)"), "γ (1 + η)"),
        (greek("alpha'"), "α′"),
    ],
}


@pytest.mark.parametrize("of", EXAMPLES)
def test_examples(of: str) -> None:
    for found, wanted in EXAMPLES[of]:
        assert found == wanted


def test_notes_of_several_reports_are_said_once() -> None:
    notes = ["fragility: the data are separated"]
    add_notes(notes, "risk", ["the data are separated", "the hazard curve is continued"])
    assert notes == ["fragility: the data are separated", "risk: the hazard curve is continued"]
