"""Ends that give way: full contact with a stiffness, and gradual
uplift (Theory, section 12).

In full contact, BEDDED, the tilt is a signed number within -phi_u and phi_u, or any
vector within, with B = 0 and C = C_u: constants of a phase like others, with `bed_k`
and `bed_c`. Beyond it a plane end lifts gradually, by `sink` and `root` of what
`laws` takes from both arms.

phi_u is that of the weight. Where the ground accelerates upwards, lifted ends may turn
back what the bed pushes out: then the storey is held there, STUCK with `bed_back`,
until either lets it go.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.lane import lanes_of, new_tilt_of, patch, polar, ways_of
from rpscli.physics.state import BEDDED, ROCKING, ROLLING, Record


@compiled
def set_patches(s: Record) -> None:
    """Write w and its slope of all lanes at a stage."""
    for l in range(lanes_of(s)):
        x, _, _, _, _ = polar(s, l, new_tilt_of(s, l), (0.0, 0.0))
        s.w[l], s.dw[l] = patch(s, l, x)


@compiled
def load_bed(s: Record, l: int, system: Record) -> None:
    """Begin a history on its bed, or on rigid ends."""
    s.bed_u[l] = system.bed_uplift
    s.fade[l] = 0.0
    s.bed_energy[l] = 0.0
    s.bedded_time[l] = 0.0
    s.impact_number[l] = 0.0
    s.bed_back[l] = 0.0
    s.turned[l] = 0.0
    s.bed_k[l] = 0.0
    smooth = system.compliant > 0 or system.alpha == 0.0
    s.cone[l] = 0.0 if smooth or ways_of(s) == 1 else 1.0
    if system.bed_full > 0.0:
        s.fade[l] = 1.0 / (system.bed_full - system.bed_uplift)


@compiled
def first_phase(system: Record) -> int:
    """The phase in which a tilt grows from zero: rolling, unless the edges are sharp."""
    return ROLLING if system.beta > 0.0 else ROCKING


@compiled
def enter_on_bed(s: Record, l: int, system: Record, phase: int) -> None:
    """Set what a bed changes in a phase of motion that is entered: constants, range,
    steps.
    """
    s.bed_k[l] = 0.0
    s.bed_c[l] = 0.0
    s.sink[l] = 0.0
    s.root[l] = 0.0
    s.rim[l] = 0.0
    if system.compliant == 0:
        return
    uplift = system.bed_uplift
    full = system.bed_full
    if phase == BEDDED:
        s.p[l] = 0.0
        s.q0[l] = 0.0
        s.c[l] = system.bed_height
        s.u0[l] = 0.0
        s.v0[l] = 0.0
        s.x_low[l] = -uplift
        s.x_high[l] = uplift
        s.bed_k[l] = system.bed_k
        s.bed_c[l] = system.bed_c
        s.h_most[l] = 1.0 / system.bedded_rate
        return
    s.rim[l] = system.bed_c * uplift
    if phase == first_phase(system):
        s.x_low[l] = uplift
        lifts = s.x[l] < full or (s.x[l] == full and s.v[l] < 0.0)
        if full == 0.0 or lifts:
            s.sink[l] = system.sink
            s.root[l] = system.root
        if full > 0.0 and lifts:
            s.x_high[l] = min(s.x_high[l], full)
        elif full > 0.0:
            s.x_low[l] = full


@compiled
def impact_number(system: Record, rate: float) -> float:
    """chi of a re-entry at a rate of the tilt [rad/s]."""
    half_width = system.R * math.sin(system.alpha)
    return abs(rate) * math.sqrt(2.0 * half_width / (system.gravity * system.bed_uplift))
