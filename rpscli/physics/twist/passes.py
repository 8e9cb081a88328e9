"""What columns lose that pass near upright, one by one or together (17.11)."""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.laws.place import length
from rpscli.physics.state import Record
from rpscli.physics.twist.slab import Masses, kinetic, solved
from rpscli.physics.upright import loss_share

LEFT = 1.1
"""Of its least distance from upright: farther out a head has passed, and may again."""

HARDLY = 1e-3
"""Share of an impact's loss below which a pass is let go by."""


TOGETHER = 0.5
"""Of t_c: heads that are nearest to upright within it pass together, as their impulses
overlap; equal columns so stay together whatever rounding does."""


@compiled
def share_of_pass(s: Record, c: Record) -> float:
    """l of (13.14) of a head on its way past upright; 0 where it has just passed, or only
    trembles.
    """
    speed = length(c.w_x, c.w_y)
    if c.passed > 0.0 or not speed * s.contact_time > 2.0 * s.bowl:
        return 0.0
    least = abs(c.u_x * c.w_y - c.u_y * c.w_x) / speed
    return loss_share(least / (speed * s.contact_time))


@compiled
def approach(s: Record, c: Record) -> float:
    """u.w over |w| [m]: below zero before a head is nearest to upright."""
    return (c.u_x * c.w_x + c.u_y * c.w_y) / max(length(c.w_x, c.w_y), 1e-300)  # type: ignore[no-any-return]


@compiled
def part_of_loss(s: Record, share: float) -> float:
    """lambda of a pass with that share of an impact's loss."""
    e = s.restitution
    if e == 1.0:
        return 0.0
    return s.loss * (1.0 - math.sqrt(1.0 - share * (1.0 - e * e))) / (1.0 - e)  # type: ignore[no-any-return]


@compiled
def pass_together(s: Record, columns: Record, modes: Record) -> None:
    """Take what all columns lose that are nearest to upright at the present instant.

    (M + sum S P^T P) s'+ = (M + sum (1 - 2 lambda) S P^T P) s'-, with P the direction of
    a head's velocity times its ways, M without the vertical parts S. `M` is that where
    heads move across their displacement; of a head at upright it holds none either.
    """
    M = s.M[0], s.M[1], s.M[2], s.M[3], s.M[4], s.M[5]
    lost = 0.0, 0.0, 0.0
    cosine = math.cos(s.way[2])
    sine = math.sin(s.way[2])
    any_passes = False
    for i in range(columns.shape[0]):
        c = columns[i]
        speed = length(c.w_x, c.w_y)
        share = share_of_pass(s, c)
        if abs(approach(s, c)) > TOGETHER * speed * s.contact_time or share < HARDLY:
            continue
        any_passes = True
        c.passed = LEFT * length(c.u_x, c.u_y) + s.bowl
        p = c.w_x / speed, c.w_y / speed
        d_x = cosine * c.x - sine * c.y
        d_y = sine * c.x + cosine * c.y
        p_t = p[1] * d_x - p[0] * d_y
        M = with_part(M, c.vertical, (p[0], p[1], p_t))
        taken = 2.0 * part_of_loss(s, share) * c.vertical * speed
        lost = lost[0] + taken * p[0], lost[1] + taken * p[1], lost[2] + taken * p_t
    if not any_passes:
        return
    before = kinetic(s)
    back = solved(M, lost)
    for axis, change in ((0, back[0]), (1, back[1]), (2, back[2])):
        s.rate[axis] -= change
        for r in range(modes.shape[0]):  # floors keep their velocities
            modes[r].dq += modes[r].Gamma[axis] * change
    s.lost_in_passes += before - kinetic(s)


@inlined
def with_part(M: Masses, S: float, p: tuple[float, float, float]) -> Masses:
    """Masses with a part S P^T P more."""
    return (
        M[0] + S * p[0] * p[0],
        M[1] + S * p[0] * p[1],
        M[2] + S * p[1] * p[1],
        M[3] + S * p[0] * p[2],
        M[4] + S * p[1] * p[2],
        M[5] + S * p[2] * p[2],
    )
