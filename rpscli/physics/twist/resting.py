"""Full contact of all columns: what it holds, and when it is entered (17.10).

Pushed with Q and turned with T, columns hold as long as no motion of the slab gains more
than it lifts: Q.v + T omega <= sum W tan(alpha) |v + omega J d| + lever W |omega|, the limit
surface of a plate that slides on its supports (S. Goyal, A. Ruina and J. Papadopoulos, Wear
143 (1991) 307-330 and 331-352). A motion is a turn about a point c, v = -omega J c, of which
the worst is sought, or a translation, c at infinity.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.laws.place import length
from rpscli.physics.state import Record

MOST_TRIES = 60
LEAST = 1e-300


@compiled
def spare_torque(s: Record, columns: Record, Q_x: float, Q_y: float, T: float) -> float:
    """Least torque that is missing for any turn of the slab [N m]; below zero it moves.

    Where the push alone is more than all columns hold it is minus infinity.
    """
    held = 0.0
    for i in range(columns.shape[0]):
        held += columns[i].weight * columns[i].tan_a
    if not length(Q_x, Q_y) < held:
        return -math.inf
    left = least_of_turns(columns, -Q_y, Q_x) - T
    right = least_of_turns(columns, Q_y, -Q_x) + T
    return float(s.pivot + min(left, right))


@compiled
def least_of_turns(columns: Record, g_x: float, g_y: float) -> float:
    """Least of sum W tan(alpha) |d - c| - g.c over all points c [N m].

    A column is the point if what the others pull it by does not exceed its own W
    tan(alpha); else Newton's steps, kept to where the sum falls.
    """
    best = math.inf
    first = 0
    for k in range(columns.shape[0]):
        value = sum_of_arms(columns, columns[k].x, columns[k].y, g_x, g_y)
        if value < best:
            best = value
            first = k
    o = columns[first]
    p_x, p_y = slope_but(columns, first, o.x, o.y, g_x, g_y)
    pulled = length(p_x, p_y)
    own = o.weight * o.tan_a
    if not pulled > own:
        return best
    # From there a little downhill, off the kink.
    c_x = o.x
    c_y = o.y
    part = 0.1 * reach_of(columns)
    value = best
    while not value < best and part > 1e-14:
        c_x = o.x - part * p_x / pulled
        c_y = o.y - part * p_y / pulled
        value = sum_of_arms(columns, c_x, c_y, g_x, g_y)
        part *= 0.5
    return descend(columns, c_x, c_y, g_x, g_y)


@compiled
def reach_of(columns: Record) -> float:
    """Largest distance of a column from the centre [m]."""
    reach = 0.0
    for i in range(columns.shape[0]):
        reach = max(reach, length(columns[i].x, columns[i].y))
    return reach


@compiled
def sum_of_arms(columns: Record, x: float, y: float, g_x: float, g_y: float) -> float:
    """The sum at a point."""
    total = -(g_x * x + g_y * y)
    for i in range(columns.shape[0]):
        c = columns[i]
        total += c.weight * c.tan_a * length(c.x - x, c.y - y)
    return total


@compiled
def slope_but(
    columns: Record, but: int, x: float, y: float, g_x: float, g_y: float
) -> tuple[float, float]:
    """Slope of the sum at a point, without one column."""
    p_x = -g_x
    p_y = -g_y
    for i in range(columns.shape[0]):
        c = columns[i]
        if i != but:
            away = length(x - c.x, y - c.y)
            share = c.weight * c.tan_a / max(away, LEAST)
            p_x += share * (x - c.x)
            p_y += share * (y - c.y)
    return p_x, p_y


@compiled
def descend(columns: Record, c_x: float, c_y: float, g_x: float, g_y: float) -> float:
    """Least of the sum, by Newton's steps from a point."""
    x = c_x
    y = c_y
    value = sum_of_arms(columns, x, y, g_x, g_y)
    for _ in range(MOST_TRIES):
        p_x = -g_x
        p_y = -g_y
        h_xx = 0.0
        h_xy = 0.0
        h_yy = 0.0
        for i in range(columns.shape[0]):
            c = columns[i]
            r_x = x - c.x
            r_y = y - c.y
            away = max(length(r_x, r_y), LEAST)
            share = c.weight * c.tan_a / away
            p_x += share * r_x
            p_y += share * r_y
            e_x = r_x / away
            e_y = r_y / away
            h_xx += share * e_y * e_y
            h_xy -= share * e_x * e_y
            h_yy += share * e_x * e_x
        det = h_xx * h_yy - h_xy * h_xy
        step_x = -(h_yy * p_x - h_xy * p_y) / det
        step_y = -(h_xx * p_y - h_xy * p_x) / det
        if not (det > 0.0 and math.isfinite(step_x + step_y)):
            return value
        part = 1.0
        lower = sum_of_arms(columns, x + step_x, y + step_y, g_x, g_y)
        while not lower < value and part > 1e-12:
            part *= 0.5
            lower = sum_of_arms(columns, x + part * step_x, y + part * step_y, g_x, g_y)
        if not lower < value:
            return value
        x += part * step_x
        y += part * step_y
        value = lower
    return value


@compiled
def load_share(s: Record, columns: Record, Q_x: float, Q_y: float, T: float) -> float:
    """Push and torque over those along them that full contact just holds."""
    low = 0.0
    high = 1.0
    while spare_torque(s, columns, high * Q_x, high * Q_y, high * T) > 0.0 and high < 1e9:
        low = high
        high *= 2.0
    while high - low > 1e-13 * high:
        middle = 0.5 * (low + high)
        if spare_torque(s, columns, middle * Q_x, middle * Q_y, middle * T) > 0.0:
            low = middle
        else:
            high = middle
    return 1.0 / high
