"""Loads of columns under a slab that warps: seats that sink (17.9)."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.state import Record

MOST_TRIES = 50

SLACK = 1e-9
"""Of its stiffness: what a seat that is open pulls with, so that a slab on two columns
knows its plane."""


@compiled
def set_loads(s: Record, columns: Record) -> None:
    """Set N of each column, of its lift; with `sinks` 0 each keeps its own weight.

    N = max(0, W + (W/delta) (2 R v - z_0 - z.d)), sum N = sum W, sum N d = 0: piecewise
    linear, by Newton's steps from the last z.
    """
    count = columns.shape[0]
    if s.sinks == 0.0:
        for i in range(count):
            columns[i].load = columns[i].weight
        return
    tries = 0
    missed = 1.0
    while missed > 0.0 and tries < MOST_TRIES:
        missed = step_of_seats(s, columns)
        tries += 1


@compiled
def step_of_seats(s: Record, columns: Record) -> float:
    """One of Newton's steps; 0 when columns that bear no longer change."""
    k = 0.0
    k_x = 0.0
    k_y = 0.0
    k_xx = 0.0
    k_xy = 0.0
    k_yy = 0.0
    r = 0.0
    r_x = 0.0
    r_y = 0.0
    for i in range(columns.shape[0]):
        c = columns[i]
        lifted = c.lift - s.seat[0] - s.seat[1] * c.x - s.seat[2] * c.y
        bears = s.sinks + lifted > 0.0
        stiffness = c.weight * (1.0 if bears else SLACK)
        k += stiffness
        k_x += stiffness * c.x
        k_y += stiffness * c.y
        k_xx += stiffness * c.x * c.x
        k_xy += stiffness * c.x * c.y
        k_yy += stiffness * c.y * c.y
        over = stiffness * (s.sinks + c.lift) - c.weight * s.sinks
        r += over
        r_x += over * c.x
        r_y += over * c.y
    # The plane on which the columns that bear stand in balance.
    det_0 = k_xx * k_yy - k_xy * k_xy
    det_1 = k_x * k_yy - k_xy * k_y
    det_2 = k_x * k_xy - k_xx * k_y
    det = k * det_0 - k_x * det_1 + k_y * det_2
    z_0 = (r * det_0 - r_x * det_1 + r_y * det_2) / det
    z_x = (-r * det_1 + r_x * (k * k_yy - k_y * k_y) - r_y * (k * k_xy - k_x * k_y)) / det
    z_y = (r * det_2 - r_x * (k * k_xy - k_x * k_y) + r_y * (k * k_xx - k_x * k_x)) / det
    changed = 0.0
    for i in range(columns.shape[0]):
        c = columns[i]
        before = s.sinks + c.lift - s.seat[0] - s.seat[1] * c.x - s.seat[2] * c.y
        left = s.sinks + c.lift - z_0 - z_x * c.x - z_y * c.y
        columns[i].load = c.weight / s.sinks * max(left, SLACK * left)
        changed += 1.0 if (before > 0.0) != (left > 0.0) else 0.0
    s.seat[0] = z_0
    s.seat[1] = z_x
    s.seat[2] = z_y
    return changed


@compiled
def strain_of_seats(s: Record, columns: Record) -> float:
    """Energy of lifts and seats [J], least over the slab's plane."""
    energy = 0.0
    for i in range(columns.shape[0]):
        c = columns[i]
        if s.sinks == 0.0:
            energy += c.weight * c.lift
        else:
            plane = s.seat[0] + s.seat[1] * c.x + s.seat[2] * c.y
            left = s.sinks + c.lift - plane
            energy += 0.5 * c.load * left - 0.5 * c.weight * s.sinks
            energy += c.weight * plane
    return energy
