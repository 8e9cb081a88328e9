"""CSV tables of the modes."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rpscli.analyses.modal import ModalResult, UpliftedModes
from rpscli.report.csv_text import Column


def uplifted_states(result: ModalResult) -> list[tuple[str, UpliftedModes]]:
    """The uplifted states that exist, with their names."""
    states = [("rolling", result.rolling), ("rocking", result.rocking)]
    return [(name, modes) for name, modes in states if modes is not None]


def mode_columns(result: ModalResult) -> list[Column]:
    """`modes.csv`: one row a vibration mode of each state."""
    rows = list(_mode_rows(result))
    return [
        Column("state", "-", [row[0] for row in rows]),
        Column("mode", "-", [row[1] for row in rows]),
        Column("frequency", "rad/s", [row[2] for row in rows]),
        Column("period", "s", [2.0 * math.pi / row[2] for row in rows]),
        Column("damping", "-", [row[3] for row in rows]),
        Column("frequency_ratio", "-", [row[4] for row in rows]),
        Column("damping_ratio", "-", [row[5] for row in rows]),
    ]


def _mode_rows(result: ModalResult) -> Iterator[tuple[str, int, float, float, float, float]]:
    if (fixed := result.fixed_base) is not None:
        for i, (w, xi) in enumerate(zip(fixed.frequencies, fixed.damping, strict=True)):
            yield "full_contact", i + 1, float(w), float(xi), 1.0, 1.0
    for name, modes in uplifted_states(result):
        for i, (w, xi) in enumerate(zip(modes.frequencies, modes.damping, strict=True)):
            ratios = float(modes.frequency_ratio[i]), float(modes.damping_ratio[i])
            yield name, i + 1, float(w), float(xi), *ratios


def shape_columns(result: ModalResult) -> list[Column]:
    """`shapes.csv`: one row a level of each mode.

    Mode 0 is the storey's own mode, level 0 the cap beam. `horizontal` is relative to the ground,
    `elastic` to the cap beam.
    """
    rows = list(_shape_rows(result))
    return [
        Column("state", "-", [row[0] for row in rows]),
        Column("mode", "-", [row[1] for row in rows]),
        Column("level", "-", [row[2] for row in rows]),
        Column("horizontal", "-", [row[3] for row in rows]),
        Column("elastic", "-", [row[4] for row in rows]),
    ]


def _shape_rows(result: ModalResult) -> Iterator[tuple[str, int, int, float, float]]:
    if (fixed := result.fixed_base) is not None:
        for mode, shape in enumerate(fixed.shapes.T, start=1):
            for level, value in enumerate([0.0, *shape]):
                yield "full_contact", mode, level, float(value), float(value)
    for name, modes in uplifted_states(result):
        elastic = np.vstack([np.zeros(modes.shapes.shape[1]), modes.elastic_shapes])
        for mode, (shape, relative) in enumerate(zip(modes.shapes.T, elastic.T, strict=True)):
            for level, (value, part) in enumerate(zip(shape, relative, strict=True)):
                yield name, mode, level, float(value), float(part)


def eigenvalue_columns(result: ModalResult) -> list[Column]:
    """`eigenvalues.csv`: two rows a mode of each uplifted state, mode 0 the storey's own."""
    rows = [
        (name, index // 2, value)
        for name, modes in uplifted_states(result)
        for index, value in enumerate(modes.eigenvalues.tolist())
    ]
    return [
        Column("state", "-", [row[0] for row in rows]),
        Column("mode", "-", [row[1] for row in rows]),
        Column("real", "1/s", [row[2].real for row in rows]),
        Column("imaginary", "rad/s", [row[2].imag for row in rows]),
    ]
