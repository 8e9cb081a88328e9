"""CSV tables of the modes."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.modal import ModalResult
from rpscli.report.table import Column, columns_of


def mode_columns(result: ModalResult) -> list[Column]:
    """`modes.csv`: one row a vibration mode of each state."""
    heads = {"state": "-", "mode": "-", "frequency": "rad/s", "period": "s", "damping": "-"}
    ratios = {"frequency_ratio": "-", "damping_ratio": "-"}
    return columns_of(heads | ratios, _mode_rows(result))


def _mode_rows(result: ModalResult) -> Iterator[tuple[str | int | float, ...]]:
    if (fixed := result.fixed_base) is not None:
        for i, (w, xi) in enumerate(zip(fixed.frequencies, fixed.damping, strict=True)):
            yield "full_contact", i + 1, float(w), 2.0 * math.pi / w, float(xi), 1.0, 1.0
    for name, modes in result.uplifted.items():
        for i, (w, xi) in enumerate(zip(modes.frequencies, modes.damping, strict=True)):
            ratios = float(modes.frequency_ratio[i]), float(modes.damping_ratio[i])
            yield name, i + 1, float(w), 2.0 * math.pi / w, float(xi), *ratios


def shape_columns(result: ModalResult) -> list[Column]:
    """`shapes.csv`: one row a level of each mode.

    Mode 0 is the storey's own mode, level 0 the cap beam. `horizontal` is relative to the ground,
    `elastic` to the cap beam.
    """
    heads = dict.fromkeys(("state", "mode", "level", "horizontal", "elastic"), "-")
    return columns_of(heads, _shape_rows(result))


def _shape_rows(result: ModalResult) -> Iterator[tuple[str, int, int, float, float]]:
    fixed = result.fixed_base
    if fixed is not None:
        yield from _profile_rows("full_contact", 1, *2 * (fixed.profiles()["shapes"],))
    for name, modes in result.uplifted.items():
        yield from _profile_rows(name, 0, *modes.profiles().values())


def _profile_rows(
    state: str, first: int, shapes: NDArray[np.float64], elastic: NDArray[np.float64]
) -> Iterator[tuple[str, int, int, float, float]]:
    for mode, level in np.ndindex(*shapes.shape):
        yield state, first + mode, level, float(shapes[mode, level]), float(elastic[mode, level])


def eigenvalue_columns(result: ModalResult) -> list[Column]:
    """`eigenvalues.csv`: two rows a mode of each uplifted state, mode 0 the storey's own."""
    heads = {"state": "-", "mode": "-", "real": "1/s", "imaginary": "rad/s"}
    rows = [
        (name, index // 2, value.real, value.imag)
        for name, modes in result.uplifted.items()
        for index, value in enumerate(modes.eigenvalues.tolist())
    ]
    return columns_of(heads, rows)
