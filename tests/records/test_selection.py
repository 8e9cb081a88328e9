"""The choice of motions for a target spectrum, against all choices that there are."""

from __future__ import annotations

import itertools
from collections import Counter

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.codes import load_target
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import intensity_measures
from rpscli.records.selection import PERIODS, SelectionRequest, choose, misfit, select
from rpscli.records.source import load_record
from rpscli.records.spectrum import response_spectrum

TARGET = "en1998:?ag=0.3g&soil=C"


def synthetic(count: int) -> list[GroundMotion]:
    """Motions of different frequencies, lengths and strengths."""
    return [
        load_record(
            f"synthetic:?pga={0.1 + 0.05 * (i % 5)}g&seed={i}&duration={6 + i % 4}"
            f"&dt=0.02&ground_frequency={1.0 + 0.6 * (i % 7)}"
        )
        for i in range(count)
    ]


def best_of_all(
    scaled: np.ndarray, wanted: np.ndarray, events: list[str], count: int, per_event: int
) -> tuple[float, list[int]]:
    """By looking at every choice."""
    return min(
        (float(misfit(scaled[list(places)].mean(axis=0), wanted)), list(places))
        for places in itertools.combinations(range(len(scaled)), count)
        if max(Counter(events[place] for place in places).values()) <= per_event
    )


@pytest.mark.parametrize("per_event", [1, 2, 9])
def test_against_all_choices_of_random_spectra(per_event: int) -> None:
    """Exchange is no proof of the best choice, but it finds it in all of these."""
    rng = np.random.default_rng(7)
    for _ in range(20):
        scaled = np.exp(rng.normal(0.0, 0.4, (12, 25)))
        wanted = np.ones(25)
        events = [str(event) for event in rng.integers(0, 5, 12)]
        count = min(4, len(set(events)))
        _, wanted_places = best_of_all(scaled, wanted, events, count, per_event)
        places = choose(scaled, wanted, events, count, per_event)
        assert max(Counter(events[place] for place in places).values()) <= per_event
        assert places == wanted_places


def test_against_all_choices_of_motions() -> None:
    motions, target = synthetic(10), load_target(TARGET)
    request = SelectionRequest(3, (0.2, 2.0), (0.5, 3.0))
    selection = select(motions, target, request)
    periods = np.geomspace(0.2, 2.0, PERIODS)
    wanted = target.acceleration(periods)
    spectra = [response_spectrum(motion, periods).pseudo_acceleration for motion in motions]
    # The best factor by a search that knows no formula.
    factors = np.geomspace(0.5, 3.0, 2001)
    chosen = [
        factors[np.argmin(misfit(factors[:, None] * spectrum, wanted))] for spectrum in spectra
    ]
    scaled = np.array([f * spectrum for f, spectrum in zip(chosen, spectra, strict=True)])
    least, places = best_of_all(scaled, wanted, [m.name for m in motions], 3, 1)
    assert [one.motion for one in selection.chosen] == [motions[place] for place in places]
    # Neighbouring factors of the search differ by 0.09 %.
    for one, place in zip(selection.chosen, places, strict=True):
        assert one.factor == pytest.approx(chosen[place], rel=1e-3)
    assert selection.misfit == pytest.approx(least, abs=1e-3)
    assert selection.least_ratio == pytest.approx(float((selection.mean / wanted).min()))


def test_one_pgv_for_all() -> None:
    motions, target = synthetic(10), load_target(TARGET)
    assert target.pgv is not None
    request = SelectionRequest(4, (0.2, 2.0), (0.01, 100.0), 1, target.pgv)
    selection = select(motions, target, request)
    for one in selection.chosen:
        scaled = intensity_measures(one.motion.scaled(one.factor))
        assert scaled.pgv == pytest.approx(target.pgv, rel=1e-5)
        assert scaled.pgd == pytest.approx(one.factor * one.pgd)
    assert selection.mean_pgv == pytest.approx(target.pgv, rel=1e-5)
    narrow = SelectionRequest(4, (0.2, 2.0), (0.9, 1.1), 1, target.pgv)
    with pytest.raises(RecordError, match=r"only \d of 10 .* wider bounds"):
        select(motions, target, narrow)


def test_factors_keep_within_bounds() -> None:
    selection = select(
        synthetic(6), load_target(TARGET), SelectionRequest(6, (0.2, 2.0), (1.9, 2.0))
    )
    assert {one.factor for one in selection.chosen} <= {1.9, 2.0}


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"periods": (2.0, 0.2)}, "--periods 2 0.2: must be > 0 and grow"),
        ({"factors": (0.0, 1.0)}, "--factors 0 1: must be > 0"),
        ({"count": 0}, "must be >= 1"),
        ({"pgv": -1.0}, "--pgv -1: must be > 0"),
    ],
)
def test_refuses(request_: dict[str, object], message: str) -> None:
    whole: dict[str, object] = {"count": 3, "periods": (0.2, 2.0)}
    with pytest.raises(RecordError, match=message):
        SelectionRequest(**(whole | request_))  # type: ignore[arg-type]


def test_periods_outside_the_target() -> None:
    with pytest.raises(RecordError, match="no value at 5 s; it is defined from 0 to 4 s"):
        load_target(TARGET).acceleration(np.array([1.0, 5.0]))
