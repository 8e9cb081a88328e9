"""Figures: drawn for every kind of result, the same for the same result."""

from __future__ import annotations

import io

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

from report.small_results import CURVED, FLAT, KINDS, ROLLER, structure
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.model.bearing import Bearing
from rpscli.report.bundles import modal_files, pushover_files, timehistory_files
from rpscli.report.figures import style
from rpscli.report.figures.animation import MOST_FRAMES, frame_plan
from rpscli.report.figures.displacement import shown_floors
from rpscli.report.figures.rotation import rotation_figure


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_history_is_drawn(kind: str) -> None:
    result = KINDS[kind]()
    sizes = {
        name: Image.open(io.BytesIO(content)).size
        for name, content in timehistory_files(result, "title")
        if isinstance(content, bytes)
    }
    assert len(sizes) == (5 if result.structure.storeys else 4)
    assert all(width >= 800 and height >= 450 for width, height in sizes.values())


@pytest.mark.parametrize(("bearing", "storeys"), [(CURVED, 5), (FLAT, 1), (ROLLER, 0)])
def test_modes_and_static_curves_are_drawn(bearing: Bearing, storeys: int) -> None:
    made = structure(bearing, storeys)
    files = [*modal_files(modal(made), "title"), *pushover_files(pushover(made), "title")]
    figures = [content for _, content in files if isinstance(content, bytes)]
    assert len(figures) == (3 if storeys else 2)
    assert all(Image.open(io.BytesIO(figure)).width >= 600 for figure in figures)


def test_a_figure_depends_on_its_result_alone() -> None:
    result = KINDS["rolls"]()
    first = rotation_figure(result, "title")
    with mpl.rc_context({"lines.linewidth": 9.0, "axes.facecolor": "black"}):
        assert rotation_figure(result, "title") == first


def test_a_title_is_no_formula() -> None:
    assert rotation_figure(KINDS["at rest"](), r"costs 5 $ or \frac$" + 200 * "x")


def test_floors_in_the_figure_are_floors_of_the_building() -> None:
    for storeys in range(60):
        floors = shown_floors(storeys)
        assert len(floors) == min(storeys, 3)
        assert all(1 <= floor <= storeys for floor in floors)
        assert not floors or floors[0] == storeys


def test_prefixes() -> None:
    for largest in (0.5, 1.0, 999.0, 1e3, 5e5, 1e6, 7e9):
        factor, prefix = style.engineering(largest)
        assert factor == {"": 1.0, "k": 1e-3, "M": 1e-6}[prefix]
        assert factor == 1.0 or largest * factor >= 1.0


@pytest.mark.parametrize("kind", KINDS)
def test_an_animation_shows_the_motion_from_its_first_to_its_last(kind: str) -> None:
    result = KINDS[kind]()
    plan = frame_plan(result)
    assert 2 <= len(plan.samples) <= MOST_FRAMES
    assert (np.diff(plan.samples) >= 0).all()
    assert plan.samples[-1] < len(result.trace.time)
    shown = np.abs(result.trace.rotation[plan.samples[0] : plan.samples[-1] + 1])
    assert shown.max() == np.abs(result.trace.rotation).max()
    assert plan.speed > 0.0
