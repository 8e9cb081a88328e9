"""Phases of motion on a bed, where the tilt leaves them, and what a bed stores."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.records import Record
from rpscli.physics.planar import plane_bed
from rpscli.physics.planar.bed import with_bed
from rpscli.physics.planar.state import (
    BEDDED,
    EVENT_KINDS,
    IMPACT,
    NO_EVENT,
    ROCKING,
    ROLLING,
    STUCK,
    UPLIFT,
)

PATCH_LEFT = EVENT_KINDS + 1
"""Kind of an event that is not logged: curved ends leave their flat part, or come back to it."""


@with_bed()
def load_bed(s: Record, l: int, system: Record, request: Record) -> None:
    """Begin a history on its bed."""
    s.bed_map[l] = request.bed_map
    s.compliant[l], s.bed_uplift[l] = system.compliant, system.bed_uplift
    s.bed_k[l], s.bed_c[l], s.sink[l], s.root[l], s.pace[l] = 0.0, 0.0, 0.0, 0.0, math.inf
    s.bed_energy[l], s.bedded_time[l], s.impact_number[l] = 0.0, 0.0, 0.0
    s.fade[l] = 0.0
    if system.bed_full > 0.0:
        s.fade[l] = 1.0 / (system.bed_full - system.bed_uplift)


@compiled
def first_phase(system: Record) -> int:
    """The phase in which a bed lifts."""
    return ROLLING if system.beta > 0.0 else ROCKING


@with_bed()
def enter_on_bed(s: Record, l: int, system: Record, phase: int) -> None:
    """What a bed changes in a phase of motion that is entered: constants, range, steps."""
    if system.compliant == 0:
        return
    s.bed_k[l], s.bed_c[l], s.sink[l], s.root[l], s.pace[l] = 0.0, 0.0, 0.0, 0.0, math.inf
    uplift, full, rate = system.bed_uplift, system.bed_full, system.uplifted_rate
    if phase == BEDDED:
        s.phase_p[l], s.phase_q[l], s.phase_c[l] = 0.0, 0.0, system.bed_height
        s.phase_u0[l], s.phase_v0[l] = 0.0, 0.0
        s.theta_low[l], s.theta_high[l] = -uplift, uplift
        s.bed_k[l], s.bed_c[l], rate = system.bed_k, system.bed_c, system.bedded_rate
    elif phase == first_phase(system):
        s.theta_low[l] = uplift
        lifts = s.theta[l] < full or (s.theta[l] == full and s.theta_dot[l] < 0.0)
        if full == 0.0 or lifts:
            s.sink[l], s.root[l] = system.sink, system.root
        if full > 0.0 and lifts:
            s.theta_high[l] = min(s.theta_high[l], full)
        elif full > 0.0:
            s.theta_low[l] = full
    steps = max(math.ceil(s.dt[l] * rate), 1)
    s.uplifted_step[l], s.uplifted_steps[l] = s.dt[l] / steps, steps


@with_bed(otherwise=NO_EVENT)
def bed_below(s: Record, l: int, system: Record) -> int:
    """What happens on a bed where the tilt falls below its range; NO_EVENT: as on rigid ends."""
    if system.compliant == 0 or s.theta_low[l] == system.beta:
        return NO_EVENT
    if s.phase[l] == BEDDED:
        return UPLIFT
    return IMPACT if s.theta_low[l] == system.bed_uplift else PATCH_LEFT


@with_bed(otherwise=NO_EVENT)
def bed_above(s: Record, l: int, system: Record) -> int:
    """The same where it rises above."""
    if s.phase[l] == BEDDED:
        return UPLIFT
    fades = system.bed_full > 0.0 and s.theta_high[l] == system.bed_full
    return PATCH_LEFT if fades and s.theta_high[l] < system.theta_limit else NO_EVENT


patch_integral = compiled(plane_bed.patch_integral)


def _lifted(_s: Record, _l: int, _system: Record, _weight: float, lift: float) -> float:
    return _weight * lift


@with_bed(otherwise=_lifted)
def potential(s: Record, l: int, system: Record, weight: float, lift: float) -> float:
    """Energy of the weight W, which rigid ends would lift by so much, and of a bed [J] [m]."""
    if system.compliant == 0:
        return weight * lift
    inertia = 0.125 * s.columns_mass[l] * s.diameter[l] * s.diameter[l]
    u, x = system.bed_uplift, s.theta[l]
    if s.bed_k[l] > 0.0:
        return float(inertia * s.bed_k[l] * (x * x))
    first = system.rolling if system.beta > 0.0 else system.rocking
    lift_there = s.diameter[l] * (first[4] + first[0] * math.sin(u) - first[1] * math.cos(u))
    end = min(x, system.bed_full) if system.bed_full > 0.0 else x
    sunk = patch_integral(end, u, s.fade[l]) - patch_integral(u, u, s.fade[l])
    stored = inertia * system.bed_k * (u * u)
    return float(stored + weight * (lift - lift_there - s.diameter[l] * system.sink * sunk))


@with_bed(otherwise=0.0)
def energy_of_bed(s: Record, l: int) -> float:
    """What the bed has dissipated so far [J]."""
    return float(s.bed_energy[l])


@with_bed()
def leave_bed(s: Record, l: int, result: Record) -> None:
    """Write what the bed of a lane leaves behind at the end of its history."""
    result.bed_energy, result.bedded_time = s.bed_energy[l], s.bedded_time[l]
    result.impact_number = s.impact_number[l]
    if s.phase[l] == STUCK and s.bed_k[l] > 0.0:
        result.phase = BEDDED


def _as_given(_s: Record, _l: int, phase: int) -> int:
    return phase


@with_bed(otherwise=_as_given)
def phase_on_bed(s: Record, l: int, phase: int) -> int:
    """The phase in which a stuck storey begins to move, of that on rigid ends."""
    return BEDDED if s.bed_k[l] > 0.0 else phase
