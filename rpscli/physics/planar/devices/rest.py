"""Devices at rest: what they hold, when friction sticks, and how a history begins with them."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.lanes import log_event, time_of
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import middle_of, sine_cosine
from rpscli.physics.planar.bed.passages import phase_on_bed
from rpscli.physics.planar.bed.terms import hold_of_bed, lift_arm
from rpscli.physics.planar.devices import with_devices
from rpscli.physics.planar.devices.events import has_friction, reset_yielded_tendons
from rpscli.physics.planar.devices.forces import (
    cap_beam_path,
    resistance,
    tendon_elongation,
    tension,
)
from rpscli.physics.planar.equation_of_motion import (
    contact_arm,
    contact_height,
    horizontal_action,
    phase_constants,
)
from rpscli.physics.planar.state import (
    AFTER_PHASE_CHANGE,
    BEYOND,
    DAMPER_EXPONENT,
    FRICTION,
    FRICTION_FORCE,
    IDLE,
    ROCKING,
    ROLLING,
    ROLLING_MOMENT,
    ROLLING_RESISTANCE,
    SLIDING,
    STICKING,
    STOP,
    STOP_GAP,
    STOP_MET,
    STUCK,
    TENDON,
    TENDON_PRESTRESS,
    TENDON_YIELD,
    VISCOUS,
    WORKING,
)


@with_devices()
def load_devices(s: Record, l: int, system: Record) -> None:
    """Begin a history with its devices as they are at rest and upright."""
    s.devices[l], s.columns[l] = system.devices, system.columns
    s.linear_speed[l] = system.linear_speed
    s.half_width[l], s.arc_end[l] = system.R * math.sin(system.alpha), system.beta
    s.arc_radius[l] = system.R * system.rolling[2] if system.beta > 0.0 else 0.0
    s.friction_force[l], s.friction_moment[l], s.tendons[l], s.nonsmooth_damper[l] = (
        0.0,
        0.0,
        0,
        0.0,
    )
    s.direction[l], s.next_device[l], s.next_push[l], s.next_pull[l] = 1.0, 0.0, 0.0, 0.0
    for m in range(s.device_terms.shape[0]):
        s.device_terms[m, l] = 0.0
    for i in range(system.devices):
        kind = system.device_kind[i]
        s.device_kind[i, l], s.device_branch[i, l], s.permanent[i, l] = kind, IDLE, 0.0
        s.device_force[i, l], s.device_velocity[i, l], s.device_energy[i, l] = 0.0, 0.0, 0.0
        for k in range(s.law.shape[1]):
            s.law[i, k, l] = system.device_constants[i, k]
        if kind == VISCOUS and system.device_constants[i, DAMPER_EXPONENT] != 1.0:
            s.nonsmooth_damper[l] = 1.0
        elif kind == FRICTION:
            s.friction_force[l] += system.device_constants[i, FRICTION_FORCE]
        elif kind == ROLLING_RESISTANCE:
            s.friction_moment[l] += system.device_constants[i, ROLLING_MOMENT]
        elif kind == TENDON:
            s.tendons[l] += 1
            s.device_branch[i, l] = WORKING
            s.device_force[i, l] = system.device_constants[i, TENDON_PRESTRESS]
            s.next_pull[l] += system.columns * system.device_constants[i, TENDON_PRESTRESS]


@with_devices()
def begin_excursion(s: Record, l: int, log: Record) -> None:
    """Leave x = 0: friction acts against growing tilts, and a stop without a gap is met at once."""
    s.direction[l] = 1.0
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == STOP:
            s.device_branch[i, l] = IDLE
            if s.law[i, STOP_GAP, l] == 0.0:
                s.device_branch[i, l], rate = WORKING, s.side[l] * s.theta_dot[l]
                log_event(s, l, log, time_of(s, l), STOP_MET, 0.0, rate, rate, 0.0)


@with_devices()
def release_devices(s: Record, l: int) -> None:
    """Be held at a tilt: stops push, and tendons that cannot hold it have yielded."""
    path, _, _ = cap_beam_path(s, l, s.theta[l], 0.0)
    e, _, _, _ = tendon_elongation(s, l, s.theta[l])
    for i in range(s.devices[l]):
        kind, first = s.device_kind[i, l], s.law[i, STOP_GAP, l]
        if kind == STOP and path > first:
            s.device_branch[i, l] = WORKING
        elif kind == TENDON and tension(s, l, i, e) > s.law[i, TENDON_YIELD, l]:
            s.device_branch[i, l] = BEYOND
    reset_yielded_tendons(s, l)
    s.direction[l] = 1.0


@with_devices(otherwise=(0.0, 0.0))
def force_at_rest(s: Record, l: int) -> tuple[float, float]:
    """Horizontal force at the cap beam against a tilt at rest [N].

    Returns: That of stops and tendons, towards smaller x, and what friction may add to either side.
    """
    path, _, C = cap_beam_path(s, l, s.theta[l], 0.0)
    e, lever, _, _ = tendon_elongation(s, l, s.theta[l])
    arm = s.diameter[l] * C
    elastic = 0.0
    for i in range(s.devices[l]):
        elastic += s.columns[l] * tension(s, l, i, e) * lever / arm
        if s.device_kind[i, l] == STOP:
            elastic += resistance(s, l, i, path, 0.0)
    return elastic, s.friction_force[l] + s.friction_moment[l] / arm


@compiled
def arms(s: Record, l: int) -> tuple[float, float]:
    """Contact arm B and contact height C of the present tilt."""
    sine, cosine = sine_cosine(s.theta[l])
    phase = phase_constants(s, l)
    return contact_arm(phase, cosine, sine), contact_height(phase, cosine, sine)


@compiled
def mobilised_friction(s: Record, l: int) -> float:
    """Share of its friction that a storey at rest asks for, against growing tilts: -1 to 1.

    In full contact the columns hold what they can, and friction dampers the rest: no less, or the
    columns would turn (Theory (11.13)). Reads V and the ground in `next_V`, `next_a_g` and
    `next_g_up`.
    """
    B, C = arms(s, l)
    elastic, friction = force_at_rest(s, l)
    action = horizontal_action(s, l, s.next_a_g[l], s.next_V[l]) / s.shear_factor[l]
    elastic = elastic + hold_of_bed(s, l, s.theta[l], 0.0, C) * 0.5 * s.columns_mass[l]
    B = lift_arm(s, l, s.theta[l], B)
    resists = B / C * s.next_g_up[l] * s.weight_over_R[l] / s.shear_factor[l] + elastic
    if s.phase[l] == STUCK:
        return float(-(resists + action) / friction)
    dampers = s.friction_force[l]
    beyond = min(max(abs(action) - (resists + friction - dampers), 0.0), dampers)
    return -math.copysign(beyond / dampers, action) if dampers > 0.0 else 0.0


@with_devices()
def write_push_at_rest(s: Record, l: int, block: Record, h: float, steps: int) -> None:
    """Write what devices push the cap beam with at rest, at instants of a block and between.

    Of a stuck storey friction dampers and rolling resistance hold in proportion to what each could.
    """
    if s.friction_force[l] == 0.0 and s.phase[l] != STUCK:
        return
    path, _, _ = cap_beam_path(s, l, s.theta[l], 0.0)
    e, _, sin_psi, _ = tendon_elongation(s, l, s.theta[l])
    steady = 0.0
    for i in range(s.devices[l]):
        steady += s.columns[l] * tension(s, l, i, e) * sin_psi
        if s.device_kind[i, l] == STOP:
            steady += resistance(s, l, i, path, 0.0)
    share, most = 0.0, 0.0
    for k in range(steps + 1):
        s.next_V[l], s.next_a_g[l], s.next_g_up[l] = block.V[k], block.a_g[k], block.g_up[k]
        share = mobilised_friction(s, l)
        most = max(most, abs(share))
        block.push[k] = -s.side[l] * (steady + share * s.friction_force[l])
        s.next_V[l] = middle_of(block.V[k], block.V[k + 1], h * block.dV[k], h * block.dV[k + 1])
        s.next_a_g[l] += 0.5 * h * block.a_g_slope[k]
        s.next_g_up[l] += 0.5 * h * block.g_up_slope[k]
        share = mobilised_friction(s, l)
        block.push_within[k] = -s.side[l] * (steady + share * s.friction_force[l])
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == FRICTION:
            s.device_force[i, l] = max(s.device_force[i, l], most * s.law[i, FRICTION_FORCE, l])


@with_devices(otherwise=0.0)
def pull_at_rest(s: Record, l: int) -> float:
    """What tendons pull the cap beam down with at rest [N]."""
    pull = 0.0
    if s.tendons[l] > 0:
        e, _, _, cos_psi = tendon_elongation(s, l, s.theta[l])
        for i in range(s.devices[l]):
            pull += s.columns[l] * tension(s, l, i, e) * cos_psi
    return pull


@with_devices(otherwise=False)
def at_reversal(s: Record, l: int, log: Record) -> bool:
    """After x' = 0 under friction: go on to the side that is pushed to; True if neither is.

    The acceleration of the lane is that with friction against its direction.
    """
    if not has_friction(s, l):
        return False
    _, _, C = cap_beam_path(s, l, s.theta[l], 0.0)
    moment = C * s.friction_force[l] + s.friction_moment[l] / s.diameter[l]
    held = s.per_A[l] * s.shear_factor[l] * moment
    direction = s.direction[l]
    free = s.theta_ddot[l] + direction * held
    if abs(free) > held:
        s.direction[l] = 1.0 if free > 0.0 else -1.0
        if s.direction[l] != direction:
            s.restart_after[l] = AFTER_PHASE_CHANGE
        return False
    rotation = s.side[l] * s.theta[l]
    s.phase[l], s.theta_ddot[l] = STUCK, 0.0
    log_event(s, l, log, time_of(s, l), STICKING, rotation, 0.0, 0.0, 0.0)
    return True


@with_devices()
def slide(s: Record, l: int, log: Record, side: float) -> None:
    """Leave a tilt that friction held, to the right or to the left."""
    s.phase[l] = phase_on_bed(s, l, ROLLING if s.phase_c[l] > 0.0 else ROCKING)
    s.direction[l], s.restart_after[l] = side * s.side[l], AFTER_PHASE_CHANGE
    rotation = s.side[l] * s.theta[l]
    log_event(s, l, log, time_of(s, l), SLIDING, rotation, 0.0, 0.0, 0.0)
