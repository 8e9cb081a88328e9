"""Spectra of the floors as a table, isolated beside fixed base."""

from __future__ import annotations

import numpy as np

from rpscli.analyses.floor_spectra import FloorSpectra
from rpscli.report.table import Column


def floor_spectra_columns(isolated: FloorSpectra, fixed: FloorSpectra | None) -> list[Column]:
    """`floor_spectra.csv`: one row a floor, from the bottom, and period."""
    floors, periods = isolated.displacement.shape
    columns = [
        Column("floor", "-", np.repeat(np.arange(1, floors + 1), periods)),
        Column("period", "s", np.tile(isolated.periods, floors)),
    ]
    for prefix, spectra in (("", isolated), ("fixed_base_", fixed)):
        if spectra is not None:
            columns += [
                Column(f"{prefix}pseudo_acceleration", "m/s2", spectra.pseudo_acceleration.ravel()),
                Column(f"{prefix}displacement", "m", spectra.displacement.ravel()),
            ]
    return columns
