"""Response spectra of several records."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rpscli.errors import UsageError
from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.records.spectrum import ResponseSpectrum


def spectra_figure(spectra: Sequence[ResponseSpectrum], title: str) -> bytes:
    """Spectra of several records under a title."""

    def draw(figure: Figure) -> None:
        style.heading(figure, title)
        draw_spectra(figure.subplots(), spectra)

    return style.picture(draw, 3.2)


def draw_spectra(axes: Axes, spectra: Sequence[ResponseSpectrum]) -> None:
    """Pseudo-acceleration against period: each record thin, the median thick.

    Parameters
    ----------
    spectra
        At the same periods and damping.
    """
    if not spectra:
        raise UsageError("no spectra to be drawn; give `response_spectrum` of a record at least")
    periods, damping = spectra[0].periods, spectra[0].damping
    values = np.array([spectrum.pseudo_acceleration for spectrum in spectra])
    for place, each in enumerate(values):
        label = f"{len(values)} records" if place == 0 else None
        axes.plot(periods, each, color=style.GREY, lw=0.6, alpha=0.7, label=label)
    axes.plot(periods, np.median(values, axis=0), color=style.RED, lw=1.6, label="median")
    axes.set_xlabel("period [s]")
    axes.set_ylabel(f"pseudo-acceleration, {style.percent(damping)} damping [m/s²]")
    axes.set_xlim(0.0, periods[-1])
    axes.set_ylim(bottom=0.0)
    style.legend_above(axes, 2)
