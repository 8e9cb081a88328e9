"""What comes out for a point depends on the point alone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from rpscli.analyses.demand import Request, histories
from rpscli.analyses.largest_demands import Histories
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.result_quantities import SAMPLED
from rpscli.analyses.timehistory import time_history
from rpscli.records.loading import load_components
from rpscli.sweep.context import resolved
from rpscli.sweep.evaluation import SCALARS, PointResults, at_path, run_batch
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import all_keys
from sweep.small_studies import BASE, STUDY, WITHOUT_RECORDS, Make

PERTURB = ("scale: [", "perturb: {members: 3}\nscale: [")


def rows(results: PointResults) -> list[dict[str, object]]:
    """Outcome, message and results of each point, None where it has none."""
    found = []
    for row, outcome in enumerate(results.outcomes.tolist()):
        told: dict[str, object] = {"outcome": outcome, "message": results.messages.get(row)}
        for name, column in results.columns.items():
            value = column[row]
            told[name] = value.tolist() if value.ndim else None if np.isnan(value) else float(value)
        found.append({name: value for name, value in told.items() if value is not None})
    return found


def test_bits_do_not_depend_on_the_batch(study_of: Make) -> None:
    layout = lay_out(study_of())
    together = run_batch(layout.context, list(layout))
    backwards = run_batch(layout.context, list(layout)[::-1])
    alone = [run_batch(layout.context, [layout[number]]) for number in (0, 17, 35)]
    assert rows(backwards)[::-1] == rows(together)
    assert [rows(one)[0] for one in alone] == [rows(together)[number] for number in (0, 17, 35)]


UPWARDS = "synthetic:?pga=0.3g&duration=4&dt=0.02&seed=2"


@pytest.mark.parametrize("vertical", [None, UPWARDS])
def test_results_are_those_of_a_single_time_history(
    study_of: Make, workplace: Path, vertical: str | None
) -> None:
    layout = lay_out(study_of(STUDY, PERTURB))
    if vertical:  # which a case says beside its record
        record = f"record: {{source: '{UPWARDS[:-1]}1', vertical: '{UPWARDS}'}}\n"
        (workplace / "base.yaml").write_text(BASE + record, encoding="utf-8")
        layout = lay_out(study_of(WITHOUT_RECORDS + "perturb: {members: 3}\n"))
    context = layout.context
    for number in (3, len(layout) // 3 + 1, len(layout) - 2):
        point = layout[number]
        assert point.record is not None
        assert point.record.vertical == vertical
        case = resolved(layout.plan, point.values)
        structure = layout.system(point.system).perturbed(point.restitution_change)
        changed = case.structure.restitution * point.restitution_change
        assert structure.restitution == pytest.approx(changed, rel=1e-12)
        motion = load_components(point.record.source, vertical)
        motion = motion.scaled(point.scale * point.scale_change)
        single = time_history(structure, motion, case.analysis).scalars()
        (row,) = rows(run_batch(context, [point]))
        assert row["outcome"] == single["outcome"]
        for name in set(single) & set(SCALARS["timehistory"]):
            # Kernels for one and for many histories round differently; impacts amplify that.
            expected = (
                single[name] if single[name] is None else pytest.approx(single[name], rel=1e-6)
            )
            assert row.get(name) == expected, name


def test_whole_histories_tell_more_and_nothing_else(study_of: Make) -> None:
    brief = lay_out(study_of())
    whole = lay_out(study_of(STUDY, ("scale: [", "whole_histories: true\nscale: [")))
    context, more = brief.context, whole.context
    for number in (3, 20):
        (without,) = rows(run_batch(context, [brief[number]]))
        (row,) = rows(run_batch(more, [whole[number]]))
        assert {name: row[name] for name in without} == without
        history = context.history(brief[number])
        motion = history.motion.scaled(history.scale)
        single = time_history(history.structure, motion, history.settings)
        told = {quantity.name: getattr(single, quantity.name) for quantity in SAMPLED}
        assert {name: row.get(name) for name in told} == told
        assert set(row) - set(without) <= set(told)
    assert all_keys(brief)[3] != all_keys(whole)[3]


def test_whole_histories_tell_when_columns_slide(study_of: Make) -> None:
    changes = ("base: base.yaml", "base: base.yaml\nwhole_histories: true")
    layout = lay_out(study_of(STUDY, changes, overrides=("podium.friction=0.12",)))
    point = layout[20]  # tan(alpha) = 0.15 and more than that is asked of the friction
    results = run_batch(layout.context, [point]).columns
    assert results["friction_ratio"][0] > 1.0
    assert 0.0 < results["sliding_time"][0] < results["max_rotation_time"][0]


def test_a_point_that_cannot_be_computed_does_not_disturb_the_others(study_of: Make) -> None:
    layout = lay_out(study_of())
    points = list(layout)[:4]
    assert points[0].record is not None
    bad = points[1]._replace(record=points[0].record._replace(source="gone.at2"))
    found = rows(run_batch(layout.context, [points[0], bad, points[2]]))
    assert found[1]["outcome"] == "failed"
    assert "gone.at2" in str(found[1].pop("message"))
    assert set(found[1]) == {"outcome", "storey_shears"}
    whole = rows(run_batch(layout.context, points))
    assert [found[0], found[2]] == [whole[0], whole[2]]


def test_an_exception_of_the_kernel_is_told_for_its_point_only(
    study_of: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    layout = lay_out(study_of())
    points = list(layout)[:3]

    def fragile(requests: list[Request]) -> Iterator[tuple[list[int], Histories]]:
        if any(request.scale == 1.0 for request in requests):
            raise FloatingPointError("boom")
        return histories(requests)

    monkeypatch.setattr("rpscli.sweep.evaluation.histories", fragile)
    found = run_batch(layout.context, points)
    assert (found.outcomes == "failed").tolist() == [False, True, False]
    assert found.messages == {1: "FloatingPointError: boom"}


def test_modal_points_have_the_modes(study_of: Make) -> None:
    layout = lay_out(study_of(WITHOUT_RECORDS + "analysis: modal\n"))
    columns = run_batch(layout.context, list(layout)).columns
    assert np.isnan(columns["rolling.frequency_ratio"][2]).all()  # flat
    modes = modal(layout.system(0).structure)
    assert modes.rolling is not None
    found = at_path(columns, "rolling.frequency_ratio.0")
    assert found is not None
    assert found[0] == modes.rolling.frequency_ratio[0]
    assert at_path(columns, "rolling.frequency_ratio.7") is None
    shape = columns["fixed_base.shapes"][0, 0].tolist()
    assert shape == [0.0, *modes.fixed_base.shapes[:, 0]]  # type: ignore[union-attr]


def test_pushover_points_have_the_curve(study_of: Make) -> None:
    layout = lay_out(study_of(WITHOUT_RECORDS + "analysis: pushover\n"))
    found = run_batch(layout.context, [layout[0]])
    expected = pushover(layout.system(0).structure)
    assert found.outcomes.tolist() == ["done"]
    assert found.columns["uplift_force"][0] == expected.uplift_force
    assert found.columns["curve.force"][0].tolist() == expected.curve.force.tolist()
