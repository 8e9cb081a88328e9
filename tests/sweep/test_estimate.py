"""The estimate of a dry run: the kernel of the study, and what is too long tried in parts."""

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels

from rpscli.analyses.demand import WORTH_LANES
from rpscli.analyses.kernels import history
from rpscli.physics.state import LANES
from rpscli.sweep import estimate
from rpscli.sweep.estimate import estimated_seconds
from rpscli.sweep.points import lay_out
from sweep.small_studies import STUDY

pytestmark = needs_compiled_kernels


@pytest.fixture
def lanes(monkeypatch):
    """Of each run of the kernel; nothing is followed otherwise than it is."""
    seen = []
    follow = history.prepare

    def noted(ways, lanes):
        seen.append(lanes)
        follow(ways, lanes)

    monkeypatch.setattr(history, "prepare", noted)
    return seen


def test_a_dry_run_asks_for_the_kernel_of_the_study_alone(study_of, lanes):
    """Also where each building has fewer points among those that are tried than in lanes."""
    heights = "  - superstructure.storeys: [1, 2, 3, 4, 5]\n  - podium.bearing.c"
    layout = lay_out(study_of(STUDY, ("  - podium.bearing.c", heights)))
    assert len(layout) / 5 >= WORTH_LANES
    seconds, source = estimated_seconds(layout, 2)
    assert source == "trying some of the points"
    assert 0.0 < seconds < 600.0
    assert {*lanes} == {LANES}


def test_few_points_are_tried_one_by_one_as_the_study_computes_them(study_of, lanes):
    text = ("scale: [0.5, 1.0]", "scale: [1.0]"), ("seed: [1, 2, 3]", "seed: [1]")
    layout = lay_out(study_of(STUDY, *text))
    assert len(layout) < WORTH_LANES
    estimated_seconds(layout, 1)
    assert {*lanes} == {1}


def test_what_takes_long_is_tried_in_parts(study_of, monkeypatch):
    """With half of each record the estimate is near that of whole histories."""
    layout = lay_out(study_of(STUDY))
    whole, _ = estimated_seconds(layout, 1)
    monkeypatch.setattr(
        estimate, "_most_seconds", lambda *_: 2.1 * estimate.LONGEST_PROBING
    )
    parts, source = estimated_seconds(layout, 1)
    assert source == "trying parts of some histories"
    assert whole / 10.0 < parts < 10.0 * whole


def test_a_part_is_that_about_the_peak(study_of):
    layout = lay_out(study_of(STUDY))
    request = layout.context.history(layout[0])
    part = estimate._part(request, 0.25)
    own, cut = (each.motion.horizontal.acceleration for each in (request, part))
    assert len(cut) == len(own) // 4
    assert np.abs(cut).max() == np.abs(own).max()
    assert part.settings.free_vibration == 0.0
    assert part.scale == request.scale
