"""The ground motions of a page, and their spectra."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rpscli.records.measures import intensity_measures
from rpscli.records.spectrum import ResponseSpectrum, response_spectrum
from rpscli.report.figures import style
from rpscli.report.figures.look import Look, figure_files
from rpscli.report.figures.motions import record_figure, spectra_figure
from rpscli.report.html.page import Block, Section
from rpscli.report.html.pictures import Picture, page_look
from rpscli.report.table import Table

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion

DAMPING = 0.05
MOST_ROWS = 100
MOST_SPECTRA = 200


def motion_pictures(motion: GroundMotion, look: Look) -> Picture:
    """Acceleration, velocity, displacement and response spectrum of a motion."""
    files = figure_files({"r": lambda: record_figure(motion, _spectrum(motion))}, page_look(look))
    return Picture(
        {name.removeprefix("r."): content for name, content in files.items()},
        f"{motion.name}: acceleration, velocity and displacement of the ground, and the response"
        f" spectrum at {style.percent(DAMPING)} of critical damping.",
    )


def motions_section(
    motions: Sequence[GroundMotion], unreadable: Sequence[str], title: str, look: Look
) -> Section:
    """Records of a study before they are scaled: peaks, digests and spectra."""
    blocks: list[Block] = [*unreadable]
    if motions:
        blocks.append(_table(motions[:MOST_ROWS]))
        shown = motions[:MOST_SPECTRA]
        files = figure_files(
            {"s": lambda: spectra_figure([_spectrum(each) for each in shown], title)},
            page_look(look),
        )
        files = {name.removeprefix("s."): content for name, content in files.items()}
        blocks.append(
            Picture(
                files,
                f"Response spectra of {len(shown)} records before they are scaled, at"
                f" {style.percent(DAMPING)} of critical damping, with their median.",
            )
        )
    if len(motions) > MOST_ROWS:
        blocks.append(f"The table shows the first {MOST_ROWS} of {len(motions)} records.")
    return Section("Ground motions", blocks)


def _table(motions: Sequence[GroundMotion]) -> Table:
    rows = []
    for motion in motions:
        found = intensity_measures(motion)
        numbers = (motion.duration, found.pga, found.pgv, found.d5_95)
        texts = [f"{number:.4g}" for number in numbers]
        rows.append((motion.source, motion.digest[:16], *texts))
    heads = (
        "record", "SHA-256 begins with", "duration [s]", "PGA [m/s2]", "PGV [m/s]", "5-95 % [s]"
    )  # fmt: skip
    return Table.of_texts(heads, rows, words=2)


def _spectrum(motion: GroundMotion) -> ResponseSpectrum:
    periods = np.concatenate([np.arange(0.0, 1.0, 0.02), np.arange(1.0, 4.01, 0.05)])
    return response_spectrum(motion, periods, DAMPING)
