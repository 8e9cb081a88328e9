"""The figure of floor spectra of a study, against made-up fractiles."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rpscli.analyses.floor_spectra import PERIODS
from rpscli.report.study.heights import Floors, floor_spectra_figure


def test_the_figure_has_a_panel_for_the_lowest_floor_and_the_roof(figures: list[Figure]) -> None:
    values = np.arange(1.0, 1.0 + 3 * 3 * len(PERIODS)).reshape(3, 3, -1)
    fallen = np.where(np.arange(3)[:, None, None] == 2, np.inf, values)
    states = np.array([fallen, values])
    both = np.stack([states, states], axis=1)  # pseudo-accelerations and displacements
    floors = [Floors((scale,), np.moveaxis(both, 2, 0)) for scale in (1.0, 2.0)]
    floor_spectra_figure(("scale",), floors, "")("title")
    (figure,) = figures
    drawn = [axes for axes in figure.axes if axes.axison]
    assert [axes.get_title() for axes in drawn] == [
        f"scale = {scale}, floor {floor}" for scale in (1, 2) for floor in (1, 3)
    ]
    for axes, floor in zip(drawn, (0, 2, 0, 2), strict=True):
        assert axes.get_xscale() == "log"
        assert axes.get_ylim()[0] == 0.0
        lines = {line.get_label(): line.get_ydata() for line in axes.lines}
        np.testing.assert_array_equal(lines["on bearings, median"], values[1, floor])
        np.testing.assert_array_equal(lines["fixed base, 84 % fractile"], values[2, floor])
        assert np.isnan(np.asarray(lines["on bearings, 84 % fractile"])).all()
