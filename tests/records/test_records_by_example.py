"""What small functions of `rpscli.records` give, by example."""

from __future__ import annotations

import numpy as np

from rpscli.records.formats.record_text import printed_resolution
from rpscli.records.ground_motion import Recording, is_usual, scale_warning
from rpscli.records.made import envelope
from rpscli.records.measures import (
    DIRECTIONS,
    factor_to,
    measure_label,
    needs_period,
    of_directions,
)
from rpscli.records.quantities import last_digit, unit_factor, why_no_numbers
from rpscli.records.recordings import _numbered, event_of
from rpscli.records.selection import misfit
from rpscli.records.sets import expand_set
from rpscli.records.source import Source


def test_events_of_recordings() -> None:
    assert event_of(Recording("NORTHRIDGE EQ 1/17/94, MULHOL, 009")) == "northridge 1994"
    assert event_of(Recording("Northridge-01, 1/17/1994")) == "northridge 1994"
    assert event_of(Recording("Northridge", origin="1994 01 17")) == "at 1994 01 17"


def test_formats_record_text() -> None:
    assert printed_resolution(
        np.array([0.0, 0.5, 1.0, 1.5]), ["0", "0.5", "1", "1.5"]
    ).tolist() == [0.1, 0.1, 0.1, 0.1]


def test_ground_motion() -> None:
    assert (is_usual(0.25), is_usual(-4.0), is_usual(4.01)) == (True, True, False)
    assert (
        scale_warning("quake.at2", 1720.0)[:56]
        == "quake.at2 is scaled by 1720, beyond the usual 0.25 to 4:"
    )


def test_measures() -> None:
    assert (needs_period("Sa"), needs_period("PGV"), needs_period(None)) == (True, False, False)
    assert (factor_to(4.0, 1.0, "PGA", ""), factor_to(4.0, 1.0, "Arias", "")) == (4.0, 2.0)


def test_pair_measure() -> None:
    assert (measure_label("PGV", "component"), measure_label("Sa", "rotd50", "T1")) == (
        "PGV",
        "Sa(T1, RotD50)",
    )
    plane = np.abs(np.cos(np.radians(DIRECTIONS)))  # all motion along the first component
    assert [
        round(float(of_directions(plane, of)), 3) for of in ("rotd50", "rotd100", "geomean")
    ] == [0.707, 1.0, 0.0]


def test_quantities() -> None:
    assert (why_no_numbers("0,005 0,123"), why_no_numbers("0.1; 0.2"), why_no_numbers("end")) == (
        " (decimal commas: write points)",
        " (semicolons: separate by commas or blanks)",
        "",
    )
    assert (last_digit(".0050"), last_digit("2.50E-02")) == (0.0001, 0.0001)
    assert (unit_factor("g"), unit_factor("gal")) == (9.80665, 0.01)


def test_selection() -> None:
    assert round(float(misfit(np.array([2.0, 0.5]), np.ones(2))), 6) == 0.693147


def test_sets() -> None:
    assert list(map(str, expand_set(Source.parse("fema_p695:farfield/1/*?normalised")))) == [
        "fema_p695:farfield/1/a?normalised",
        "fema_p695:farfield/1/b?normalised",
    ]


def test_synthetic() -> None:
    assert envelope(np.array([0.0, 0.2, 1.0])).round(3).tolist() == [0.0, 1.0, 0.01]


def test_numbers_of_clusters() -> None:
    assert _numbered([{"a"}, {"b"}, {"a", "c"}, {"c"}]) == [0, 1, 0, 0]
