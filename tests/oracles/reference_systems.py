"""Structures and pulses on which the second integrator is tried."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from .crossings import Array
from .storey_lagrangian import OracleSystem

GRAVITY = 9.80665


def _system(
    tan_alpha: float, rho: float, stiffnesses: Array, period: float, damping: float
) -> OracleSystem:
    """Floors of 1 kg on storeys in this proportion; damped in modes 1 and 2, or by stiffness."""
    storeys = len(stiffnesses)
    between = np.eye(storeys) - np.eye(storeys, k=-1)
    damping_matrix = np.zeros((storeys, storeys))
    if storeys:
        matrix = between.T @ np.diag(stiffnesses) @ between
        scale = (2.0 * math.pi / period) ** 2 / np.linalg.eigvalsh(matrix)[0]
        stiffnesses, matrix = scale * stiffnesses, scale * matrix
        one, *others = np.sqrt(np.linalg.eigvalsh(matrix)[:2])
        damping_matrix = 2.0 * damping / one * matrix
        for two in others:
            mass_part = one * two * np.eye(storeys)
            damping_matrix = 2.0 * damping / (one + two) * (mass_part + matrix)
    wedge = 2.0 * tan_alpha if rho else tan_alpha
    masses = np.ones(storeys)
    return OracleSystem(
        1.5, tan_alpha, wedge, rho, 4 / 3, 0.1, 1.0, masses, stiffnesses, damping_matrix
    )


def podium(storeys: int, tan_alpha: float, rho: float) -> OracleSystem:
    """T_1 = n/10 s, half a sine as first mode, 5 % in modes 1 and 2."""
    shape = np.sin(math.pi * np.arange(storeys + 1) / (2 * storeys))
    stiffnesses = np.cumsum(shape[:0:-1])[::-1] / np.diff(shape)
    return _system(tan_alpha, rho, stiffnesses, storeys / 10.0, 0.05)


def uniform_podium(
    storeys: int, tan_alpha: float, rho: float, period: float, damping: float = 0.05
) -> OracleSystem:
    """Floors on equal springs; one storey is damped in proportion to stiffness."""
    return _system(tan_alpha, rho, np.ones(storeys), period, damping)


def block(half_width: float, half_height: float, restitution: float | None = None) -> OracleSystem:
    """A rigid block that stands alone."""
    slope, none = half_width / half_height, np.zeros(0)
    size = math.hypot(half_width, half_height)
    alone = OracleSystem(size, slope, slope, 0.0, 4 / 3, 1.0, 0.0, none, none, np.zeros((0, 0)))
    return replace(alone, restitution=restitution)


def slender_block(p: float, restitution: float | None = None) -> OracleSystem:
    """A block of frequency parameter p whose alpha = 1e-3 makes the linear theory exact to 1e-6."""
    size = 0.75 * GRAVITY / p**2
    return block(size * math.sin(1e-3), size * math.cos(1e-3), restitution)


def pulse(peak: float, period: float, dt: float) -> Array:
    return np.asarray(
        peak * np.sin(2.0 * math.pi * np.arange(round(period / dt) + 1) * dt / period)
    )
