"""Figures of reports, selections and designs, from numbers made by hand."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from report.small_results import curve, drawn, legend
from report.test_figures_of_studies import ALPHA, same
from rpscli.analyses.floor_spectra import PERIODS
from rpscli.case.conditions import Condition
from rpscli.case.design import Term
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.selection import Candidate, Selection
from rpscli.records.target import RULES, TargetSpectrum
from rpscli.report.design import region_figure, requirements_figure
from rpscli.report.figures.motions import selection_figure
from rpscli.report.study.heights import Floors, floor_spectra_figure
from rpscli.sweep.design import Answer, Requirement

Array = NDArray[np.float64]

INF, NAN = np.inf, np.nan
NO_SAMPLES = (np.empty(0), np.empty(0))
SIZE = "podium.bearing.semi_diagonal"


def has_edges(axes: Axes, place: int, x: object, *edges: object) -> None:
    """Require that a filled band runs through the points of its edges."""
    bands = [found for found in axes.collections if isinstance(found, PolyCollection)]
    (path,) = bands[place].get_paths()
    corners = np.asarray(path.vertices)
    for edge in edges:
        points = np.column_stack([np.asarray(x, float), np.asarray(edge, float)])
        assert np.abs(corners[:, None] - points).sum(axis=2).min(axis=0).max() < 1e-9


def a_selection() -> Selection:
    """Two motions for a target, the second at the bound of its factor."""
    periods, wanted = np.array([0.1, 0.5, 2.0]), np.array([3.0, 6.0, 1.5]) / 1.01
    target = TargetSpectrum("EN 1998", "", lambda _: wanted, 0.5, 0.2, span=(0.1, 2.0))
    first, second = (GroundMotion(np.ones(2), 0.1, name) for name in ("first", "second"))
    chosen = (
        Candidate((first,), "one", 1.0, 0.2, 0.03, np.array([1.0, 2.0, 0.5]), 2.0),
        Candidate((second,), "two", 1.0, 1.2, 0.5, np.array([8.0, 16.0, 4.0]), 0.5, clamped=True),
    )
    return Selection(target, "component", periods, chosen, 9, 1, requirements=RULES["en1998"])


def test_a_selection_beside_its_target() -> None:
    selection = a_selection()
    periods, wanted, mean = selection.periods, selection.wanted, selection.mean
    scaled = [(2.0, 4.0, 1.0), (4.0, 8.0, 2.0)]
    figure = drawn(selection_figure, selection, "title")
    assert "2 of 9, single components; misfit of the mean 0.010" in figure.get_suptitle()
    assert "factors at a bound: 1" in figure.get_suptitle()
    assert {*legend(figure)} == {"first", "second", "mean", "EN 1998", "90 % of it"}
    left, right = figure.axes
    for line, values in zip(left.lines[:2], scaled, strict=True):
        same(line.get_data(), (periods, values))
    same(curve(left, "mean"), (periods, mean))
    same(curve(left, "EN 1998"), (periods, wanted))
    same(curve(left, "90 % of it"), (periods, 0.9 * wanted))
    looks = {(line.get_color(), line.get_linestyle()) for line in left.lines}
    assert len(looks) == len(left.lines) == 5  # all told apart
    assert left.get_xlabel() == "period [s]"
    assert left.get_ylabel() == "pseudo-acceleration, 5 % damping [m/s²]"
    same(curve(right, "motions"), ((0.4, 0.6), (0.06, 0.25)))
    same(curve(right, "mean"), ([0.5], [0.155]))
    same(curve(right, "target"), ((0.5, 0.5), (0.0, 1.0)))
    same(right.lines[-1].get_data(), ((0.0, 1.0), (0.2, 0.2)))
    assert (right.get_xlabel(), right.get_ylabel()) == ("PGV [m/s]", "PGD [m]")
    assert legend(right) == ["motions", "mean", "target"]


def answer_of(
    keys: Sequence[str],
    values: object,
    passes: object,
    aim: object,
    *,
    requirements: Sequence[Requirement] = (),
    demands: Sequence[Any] = (),
    valid: object = True,
    linked: int = 0,
) -> Answer:
    """An answer of a search: designs by keys, whose last `linked` follow from the others.

    `passes` has a row for the records and one for each resample, `demands` such of requirements.
    """
    at, met = np.array(values), np.array(passes, dtype=bool)
    low, high = at.min(axis=0), at.max(axis=0)
    task: Any = SimpleNamespace(
        keys=keys,
        unknowns=keys[: len(keys) - linked],
        file=SimpleNamespace(minimise={ALPHA: Term()}),
    )
    return Answer(
        task,
        tuple(requirements),
        places=(at - low) / (high - low),
        values=at,
        valid=np.broadcast_to(np.array(valid, dtype=bool), len(at)),
        results=np.array(demands, dtype=float),
        met=met[None],
        excess=np.zeros((1, len(at))),
        objectives=np.repeat(np.array(aim, dtype=float)[None], len(met), axis=0),
    )


def of_one_unknown() -> Answer:
    """Three designs; the one at 0.2 fails in one of two resamples."""
    uplift = Requirement(Condition("uplift", 0.0, "limits", share=0.5), 0)
    shear = Requirement(Condition("max_base_shear", 2e6, "limits"), 0, "PGA", 3.0)
    demands = [
        [[0.25, 1.0, 0.5], [0.0, 1.0, 0.5], [0.25, 1.0, 0.75]],
        [[1.5e6, INF, 1.8e6], [1.2e6, INF, 1.7e6], [1.6e6, 1e6, 1.9e6]],
    ]
    return answer_of(
        [ALPHA], [[0.3], [0.1], [0.2]], [[1, 0, 1], [1, 0, 0], [1, 0, 1]], [0.3, 0.1, 0.2],
        requirements=[uplift, shear], demands=demands,
    )  # fmt: skip


def test_requirements_along_one_unknown() -> None:
    figure = drawn(requirements_figure, of_one_unknown(), "title")
    assert "2 of 3 designs pass" in figure.get_suptitle()
    order = (0.1, 0.2, 0.3)
    above, below = figure.axes
    same(curve(above, "designs"), (order, (1.0, 0.5, 0.25)))
    same(curve(below, "designs"), (order, (NAN, 1.8e6, 1.5e6)))
    same(curve(above, "best design"), ([0.3], [0.25]))
    same(curve(below, "best design"), ([0.3], [1.5e6]))
    for axes, bound in ((above, 0.5), (below, 2e6)):
        same(curve(axes, "admissible"), ((0.0, 1.0), (bound, bound)))
    has_edges(above, 0, order, (1.0, 0.5, 0.0), (1.0, 0.75, 0.25))
    has_edges(below, 0, order, (1e6, 1.7e6, 1.2e6), (1e9, 1.9e6, 1.6e6))
    for axes in (above, below):
        (span,) = axes.patches
        shaded = axes.transData.inverted().transform_bbox(span.get_window_extent())
        same(shaded.intervalx, (0.2, 0.3))
    assert (above.get_title(), below.get_title()) == ("uplift", "base shear at PGA = 3 m/s²")
    assert (above.get_ylabel(), below.get_ylabel()) == ("share of records", "$V_b$ [N]")
    assert (above.get_xlabel(), below.get_xlabel()) == ("", "tan α")
    same(curve(below, "off the scale, or overturned"), ([0.1], [1.05 * 4e6]))
    assert set(legend(figure)) == {
        "95 % of resamples", "designs", "admissible", "best design", "best of 95 % of resamples",
        "off the scale, or overturned",
    }  # fmt: skip


def of_two_unknowns() -> Answer:
    """Five designs, of which one is no valid case, and a third key that is linked."""
    corners = [(x, y, 2.0 * x) for x, y in ((0.1, 0.8), (0.1, 2), (0.3, 0.8), (0.3, 2), (0.2, 1.2))]
    passes = [[0, 0, 1, 1, 0], [0, 0, 1, 1, 0], [0, 0, 1, 0, 0]]
    return answer_of(
        [ALPHA, SIZE, "podium.bearing.wedge_slenderness"], corners, passes, [1, 1, 3, 2, 1],
        valid=[True, False, True, True, True], linked=1,
    )  # fmt: skip


def test_the_region_that_passes() -> None:
    figure = drawn(region_figure, of_two_unknowns(), "title")
    assert "2 of 5 designs pass" in figure.get_suptitle()
    axes, scale = figure.axes
    same(curve(axes, "best design"), ([0.3], [0.8]))
    # Shares stand where designs were computed, and nowhere else.
    found: dict[Any, Any] = {each.get_label(): each for each in axes.collections}
    assert {name: each.get_offsets().tolist() for name, each in found.items()} == {
        "no valid case": [[0.1, 2.0]],
        "fails": [[0.1, 0.8], [0.2, 1.2]],
        "passes": [[0.3, 0.8], [0.3, 2.0]],
    }
    assert found["no valid case"].get_array() is None
    shares = [found[name].get_array().tolist() for name in ("fails", "passes")]
    assert shares == [[0.0, 0.0], [1.0, 0.5]]
    same(found["passes"].norm.boundaries, (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0))
    assert scale.get_ylabel() == "share of resamples of the records that pass"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("tan α", "R [m]")
    assert legend(figure) == ["no valid case", "fails", "passes", "best design"]


def test_spectra_of_the_lowest_floor_and_the_roof() -> None:
    values = np.arange(1.0, 1.0 + 3 * 3 * len(PERIODS)).reshape(3, 3, -1)
    fallen = np.where(np.arange(3)[:, None, None] == 2, np.inf, values)
    states = np.array([fallen, values])
    both = np.stack([states, states], axis=1)  # pseudo-accelerations and displacements
    floors = [Floors((scale,), np.moveaxis(both, 2, 0)) for scale in (1.0, 2.0)]
    figure = drawn(floor_spectra_figure(("scale",), floors, "")("title"))
    shown = [axes for axes in figure.axes if axes.axison]
    assert [axes.get_title() for axes in shown] == [
        f"scale = {scale}, floor {floor}" for scale in (1, 2) for floor in (1, 3)
    ]
    for axes, floor in zip(shown, (0, 2, 0, 2), strict=True):
        lines = {line.get_label(): line.get_ydata() for line in axes.lines}
        np.testing.assert_array_equal(lines["on bearings, median"], values[1, floor])
        np.testing.assert_array_equal(lines["fixed base, 84 % fractile"], values[2, floor])
        assert np.isnan(np.asarray(lines["on bearings, 84 % fractile"])).all()
