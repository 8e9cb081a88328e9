"""Two numbers of a pull-back test: the slenderness that made them is among those that fit."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
import shown_commands as docs
from commands.conftest import write_case
from paper_structures import building, known, needs_compiled_kernels, podium

from rpscli.case.case import load_case
from rpscli.errors import UsageError
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.tools.identify.pull_back import (
    UNKNOWN,
    Pull,
    pull_back,
    time_to_rest,
)
from rpscli.tools.identify.pull_options import range_of

PAGE = docs.ROOT / "cases" / "pull_back" / "README.md"
WITHIN = 5e-3


@pytest.mark.evidence("identification", "exact")
@needs_compiled_kernels
@pytest.mark.parametrize("e", [0.7, 0.9, 0.95])
def test_a_slender_block_rests_when_the_closed_form_does(e):
    """theta'' = p^2 (theta - alpha) between impacts, each of which leaves e of the rate."""
    alpha, R, within = 0.02, 2.0, 4e-3
    bearing = Bearing(R, math.tan(alpha), math.tan(alpha), 0.0)
    block = PodiumStructure(bearing, 1e3, 0.0, None, ImpactLaw("value", e))
    p = math.sqrt(0.75 * block.gravity / R)
    amplitude, time, last = 0.6, 0.0, 0.0  # over alpha
    allowed = within / (2.0 * R * alpha)
    while amplitude > allowed:
        # from the top, 1 - phi = (1 - amplitude) cosh(p t)
        last = time + math.acosh((1.0 - allowed) / (1.0 - amplitude)) / p
        fall = math.acosh(1.0 / (1.0 - amplitude)) / p
        amplitude = 1.0 - math.sqrt(1.0 - e**2 * (1.0 - (1.0 - amplitude) ** 2))
        time += fall + math.acosh(1.0 / (1.0 - amplitude)) / p
    u = float(block.path(np.array([0.6 * alpha]))[1][0])
    found = time_to_rest(block, u, Pull((u, u), (last, last), within))
    # samples are 0.01 s apart; sines of 0.02 rad add 1e-4 of the last time
    assert found == pytest.approx(last, abs=0.012 + 2e-3 * last)


def test_what_never_rests_has_no_time():
    frame = podium(0, 0.05, 0.5)
    still = Pull((0.05, 0.05), (0.2, 0.2), WITHIN)
    assert time_to_rest(frame, 0.05, still) == math.inf  # seen for 2.3 s alone
    assert math.isnan(time_to_rest(frame, 1.0, still))  # beyond its critical displacement
    assert math.isnan(time_to_rest(None, 0.05, still))


def made_up(number):
    """A building whose properties lie within the ranges, and its displacement."""
    rng = np.random.default_rng(500 + number)
    R, rho = rng.uniform(1.0, 1.5), rng.uniform(0.3, 1.4)
    tan_alpha, loss = rng.uniform(0.035, 0.12), rng.uniform(0.4, 1.1)
    storeys = int(rng.choice([3, 6, 9]))
    above = building(storeys)
    stiffer = rng.uniform(0.9, 1.15) ** 2
    stiff = replace(above, stiffnesses=stiffer * above.stiffnesses)
    law = ImpactLaw(loss=loss)
    true = podium(storeys, tan_alpha, rho, R=R, law=law, superstructure=stiff)
    return true, float(rng.uniform(0.06, 0.1)), above


def rest_of(true, u):
    return time_to_rest(true, u, Pull((u, u), (40.0, 40.0), WITHIN))


def fitting(number, combinations):
    """What fits the history of a made-up building, of a case that has none of its numbers."""
    true, u, above = made_up(number)
    rest = rest_of(true, u)
    pull = Pull((0.95 * u, 1.05 * u), (0.9 * rest, 1.1 * rest), WITHIN)
    case = podium(3, 0.15, 0.5, R=1.25, law=ImpactLaw(), superstructure=above)
    return known(pull_back(case, pull, {}, combinations).slenderness)


def within(number, found):
    return found.low <= made_up(number)[0].bearing.slenderness <= found.high


@pytest.mark.evidence("identification", "program")
@needs_compiled_kernels
@pytest.mark.parametrize("number", [0, 1])
def test_the_slenderness_of_a_history_lies_in_its_interval(number):
    found = fitting(number, 10)
    assert within(number, found)
    assert found.low < found.value < found.high < 3.5 * found.low  # it says something


@pytest.mark.evidence("identification", "program")
@needs_compiled_kernels
@pytest.mark.long
def test_intervals_hold_the_slenderness_of_histories():
    """Of all but one at an edge of the ranges, which so few combinations do not reach."""
    rests = [n for n in range(2, 20) if math.isfinite(rest_of(*made_up(n)[:2]))]
    assert len(rests) > 8  # others rock for longer than is looked at
    assert sum(within(number, fitting(number, 16)) for number in rests[:8]) >= 7


@needs_compiled_kernels
def test_more_slender_columns_rest_later():
    case = podium(3, 0.1, 0.5, R=1.25, law=ImpactLaw())
    exact = {name: (each.of(case),) * 2 for name, each in UNKNOWN.items()}
    late, soon = (
        pull_back(case, Pull((0.08, 0.1), rest, WITHIN), exact, 4)
        for rest in ((8.0, 12.0), (3.0, 4.5))
    )
    assert known(late.slenderness).high < known(soon.slenderness).low
    assert known(late.lever).high < known(soon.lever).low
    stood = [row.median for row in late.by_slenderness if row.overturned == 0]
    assert len(stood) > 8
    assert all(b <= a for a, b in itertools.pairwise(stood))
    assert stood[0] > 5.0 * stood[-1]


CASE_NUMBERS = {
    (0.05, 0.25): (4.8, 7.0, 0), (0.05, 0.5): (5.6, 8.2, 0), (0.05, 1.5): (5.5, 8.8, 0),
    (0.03, 0.25): (8.3, 13.0, 3), (0.03, 0.5): (11.0, 17.0, 3), (0.03, 1.5): (6.8, 13.0, 3),
    (0.02, 0.25): (14.0, 16.0, 12), (0.02, 0.5): (19.0, 21.0, 12), (0.02, 1.5): (14.0, 15.0, 12),
}  # fmt: skip
"""Least and largest time, of 18, and how many overturn, as the page has them."""


@needs_compiled_kernels
@pytest.mark.parametrize(("tan_alpha", "rho"), CASE_NUMBERS)
def test_the_table_of_the_page(tan_alpha, rho):
    case = load_case(PAGE.with_name("sochi.yaml")).structure
    pull = Pull((0.1, 0.13), (30.0, 30.0), WITHIN)
    times = []
    for R, loss, u in itertools.product((1.0, 1.5), (0.3, 0.6, 1.0), (0.1, 0.115, 0.13)):
        bearing = Bearing(R, tan_alpha, 2.0 * tan_alpha, rho)
        made = replace(case, bearing=bearing, impact_law=ImpactLaw(loss=loss))
        times.append(time_to_rest(made, u, pull))
    stood = [time for time in times if not math.isnan(time)]
    least, largest, fallen = CASE_NUMBERS[tan_alpha, rho]
    assert len(times) - len(stood) == fallen
    # digits as printed
    assert min(stood) == pytest.approx(least, abs=0.06 if least < 10.0 else 0.6)
    assert max(stood) == pytest.approx(largest, abs=0.06 if largest < 10.0 else 0.6)


@needs_compiled_kernels
@pytest.mark.long
def test_the_page_shows_what_its_command_gives(monkeypatch):
    monkeypatch.chdir(docs.ROOT)
    outputs = docs.run_all(docs.rps_lines(PAGE))
    ((line, shown),) = docs.shown_outputs(docs.blocks(PAGE))
    assert docs.not_printed(shown, outputs[line]) == []
    (comment,) = docs.of_texts(PAGE.with_name("sochi.yaml"))
    assert comment == line


def test_a_range_has_one_unit():
    assert range_of("--rest", "10..15 s", "s") == (10.0, 15.0)
    assert range_of("--displacement", "10..13 cm", "m") == pytest.approx((0.1, 0.13))
    assert range_of("--displacement", "90 mm..13 cm", "m") == pytest.approx((0.09, 0.13))
    assert range_of("--displacement", "0.1", "m") == (0.1, 0.1)
    with pytest.raises(UsageError, match="write the lower end first"):
        range_of("--rest", "15..10", "s")


PULL = ("--displacement", "5..6 cm", "--rest", "2..3 s")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--rest", "2 s"), "needs --displacement; write --displacement '10..13 cm'"),
        (("--displacement", "5 cm"), "needs --rest"),
        ((*PULL, "--within", "6 cm"), "below the displacement of"),
        ((*PULL, "--range", "mass=1..2"), "'mass' is not known; known are semi_diagonal"),
        ((*PULL, "--range", "loss=0..1"), "loss: from 0 to 1 must be > 0 and finite"),
        ((*PULL, "--range", "period=1 m"), "--range period 1 m:"),
        ((*PULL, "--from", "1"), "--from and --to go with a file"),
        (("--displacement", "-5 cm", "--rest", "2 s"), "must be > 0 and finite"),
    ],
)
def test_numbers_that_no_test_has_are_refused(workplace, rps, words, said):
    rps("identify", "small.yaml", "pull-back", *words, exit_code=2, says=said)


def test_structures_that_it_is_not_for_are_refused(workplace, rps):
    write_case(
        "round.yaml",
        ("slenderness: 0.15", "slenderness: 0"),
        ("ratio: 0.5", "ratio: 0.6"),
    )
    words = ("pull-back", *PULL)
    rps(
        "identify", "round.yaml", *words, exit_code=2, says="have no flat part; give them"
    )
    bed = (
        "--set",
        "podium.contact.kind=edges",
        "--set",
        "podium.contact.period_ratio=1.2",
    )
    rps("identify", "small.yaml", *words, *bed, exit_code=2, says="is for rigid ends")
    rps(
        "identify",
        "small.yaml",
        "data.csv",
        exit_code=2,
        says="say behind it what was measured",
    )
    rps("identify", "small.yaml", "data.csv", "rocking", *PULL, exit_code=2,
        says="in place of a file")  # fmt: skip


@needs_compiled_kernels
def test_the_document_of_a_pull_back(workplace, rps, rps_json, monkeypatch):
    monkeypatch.setattr("rpscli.tools.identify.pull_back.COMBINATIONS", 3)
    monkeypatch.setattr(
        "rpscli.tools.identify.pull_back.SLENDERNESSES", np.geomspace(0.05, 0.2, 5)
    )
    monkeypatch.setattr("rpscli.tools.identify.pull_back.LEVERS", np.array([2e-3, 2e-2]))
    found = rps_json(
        "identify", "small.yaml", "pull-back", *PULL, "--range", "loss=0.9..1"
    )
    assert found["test"] == "pull-back"
    assert found["level"] is None
    assert found["measured"] == {
        "displacement": pytest.approx([0.05, 0.06]), "rest": [2.0, 3.0], "within": 5e-3
    }  # fmt: skip
    assert found["ranges"]["loss"] == [0.9, 1.0]
    assert found["combinations"] == 3
    assert found["histories"] == 3 * (5 + 2)
    (slenderness, *_) = found["estimates"]
    assert slenderness["name"] == "slenderness"
    assert (
        0.05 <= slenderness["low"] <= slenderness["value"] <= slenderness["high"] <= 0.2
    )
    assert len(found["rest_by_slenderness"]) == 5
    late = ("--displacement", "5 cm", "--rest", "50..60 s")
    none = rps("identify", "small.yaml", "pull-back", *late, exit_code=4)
    assert "no slenderness brings this building to rest after 50 to 60 s" in none.stderr
