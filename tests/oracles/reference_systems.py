"""Structures and pulses on which the second integrator is tried."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from .crossings import Array
from .storey_lagrangian import OracleSystem

GRAVITY = 9.80665


def podium(storeys: int, tan_alpha: float, rho: float) -> OracleSystem:
    """Equal floors of 1 kg, T_1 = n/10 s, half a sine as first mode, 5 % in modes 1 and 2."""
    masses = np.ones(storeys)
    shape = np.sin(math.pi * np.arange(storeys + 1) / (2 * storeys))
    first = 2.0 * math.pi / (storeys / 10.0)
    stiffnesses = first**2 * np.cumsum(shape[:0:-1])[::-1] / np.diff(shape)
    between = np.eye(storeys) - np.eye(storeys, k=-1)
    stiffness_matrix = between.T @ np.diag(stiffnesses) @ between
    one, two = np.sqrt(np.linalg.eigvalsh(stiffness_matrix)[:2])
    damping = 0.1 / (one + two) * (one * two * np.eye(storeys) + stiffness_matrix)
    wedge = 2.0 * tan_alpha if rho else tan_alpha
    return OracleSystem(1.5, tan_alpha, wedge, rho, 4 / 3, 0.1, 1.0, masses, stiffnesses, damping)


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


def uniform_podium(
    storeys: int, tan_alpha: float, rho: float, period: float, damping: float = 0.05
) -> OracleSystem:
    """`podium` with floors on equal springs; one storey is damped in proportion to stiffness."""
    between = np.eye(storeys) - np.eye(storeys, k=-1)
    stiffness_matrix = between.T @ between
    spring = 1.0
    damping_matrix = np.zeros((storeys, storeys))
    if storeys > 0:
        rates = np.sqrt(np.linalg.eigvalsh(stiffness_matrix))
        spring = (2.0 * math.pi / (period * rates[0])) ** 2
        rates = rates[:2] * math.sqrt(spring)
        damping_matrix = 2.0 * damping / rates[0] * spring * stiffness_matrix
        if storeys > 1:
            mass_part = rates[0] * rates[1] * np.eye(storeys)
            damping_matrix = (
                2.0 * damping / (rates[0] + rates[1]) * (mass_part + spring * stiffness_matrix)
            )
    wedge = 2.0 * tan_alpha if rho else tan_alpha
    ones = np.ones(storeys)
    return OracleSystem(
        1.5, tan_alpha, wedge, rho, 4 / 3, 0.1, 1.0, ones, spring * ones, damping_matrix
    )
