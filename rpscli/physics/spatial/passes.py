"""What happens near the upright position, and how a tilt begins and ends (Theory (13.11), (13.16)).

As x goes to 0 the motion is one on a cone: A and J/x^2 = K stay, and what passes near upright turns
its azimuth by pi/kappa in all, kappa = sqrt(K(0)/A(0)), however near. A real contact takes a time
t_c of its own. A pass whose own time x_min/|q|, q = x w, is short beside it loses what an impact in
one plane does and goes straight on; between the two stands a fit, the share l of that loss.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.lanes import log_event, time_of
from rpscli.physics.core.records import Record
from rpscli.physics.planar.devices.rest import begin_excursion
from rpscli.physics.planar.state import FULL_CONTACT, PASS, RECONTACT, ROCKING, ROLLING, UPLIFT
from rpscli.physics.spatial.devices import held_3d, mark_azimuth
from rpscli.physics.spatial.energy import lifting_energy, strain_energy, tilting_energy_3d
from rpscli.physics.spatial.equation_of_motion import beam_now, enter_phase_3d, place_of, renew_push
from rpscli.physics.spatial.state import UPLIFT_TILT, UPRIGHT_TILT
from rpscli.physics.spatial.steps import turn_by

FIRST_STEP = 3e-5
"""Longest step at the start of an uplift [s]."""

SLOW = 20.0
"""Below this times (|z| + limit) theta_c/A a v^2 does not carry a pass away from upright."""


@compiled
def loss_share(nearness: float) -> float:
    """l(s): of what an impact loses, what a pass of s = theta_min/(|q| t_c) does (Theory (13.14)).

    Fitted within .04 to passes of single columns on plastic contacts of t_c from 80 us to 8 ms.
    """
    if not nearness < 1e6:
        return 0.0
    return float(1.0 / (1.0 + 3.5 * nearness**1.04 + 2.0 * nearness**2.7))


@compiled
def log_event_3d(
    s: Record, l: int, log: Record, kind: int, before: float, after: float, lost: float
) -> int:
    """Count and log an event at the present state; returns its row, or -1."""
    theta = 0.0 if s.phase[l] == FULL_CONTACT else s.theta[l]
    row = log_event(s, l, log, time_of(s, l), kind, theta, before, after, lost)
    describe_event(log, row, math.atan2(s.sin_phi[l], s.cos_phi[l]), 0.0, 0.0, 0.0)
    return row


@compiled
def describe_event(
    log: Record, row: int, azimuth: float, least: float, nearness: float, share: float
) -> None:
    """Complete an entry of the log, if there was room for it."""
    if row >= 0:
        entry = log[row]
        entry.azimuth, entry.least_tilt, entry.nearness = azimuth, least, nearness
        entry.loss_share = share


@compiled
def move_floors(s: Record, l: int, before: tuple[float, float, float, float]) -> None:
    """The cap beam has left u_b and u_b' of `before` without the floors."""
    now, half = beam_now(s, l), s.storeys
    for r in range(s.n):
        axis, Gamma = (0 if r < half else 1), s.Gamma[r, l]
        velocity = s.dq[0, r, l] + Gamma * (before[2] if axis == 0 else before[3])
        jump = (before[0] - now[0]) if axis == 0 else (before[1] - now[1])
        s.q[r, l] += Gamma * jump
        s.dq[0, r, l] = velocity - Gamma * (now[2] if axis == 0 else now[3])


@compiled
def limit_of(s: Record, l: int, system: Record) -> float:
    """|z| at which a structure at rest uplifts [1/s2]."""
    g_up = s.g_up[l] + s.g_up_slope[l] * s.time[l]
    return float(math.tan(system.alpha) * g_up * s.weight_over_R[l]) + held_3d(s, l)


@compiled
def pass_upright(s: Record, l: int, system: Record, log: Record, near: int) -> None:
    """Lose at the closest approach what a contact of t_c does; `near`: by the map from theta_c.

    The map takes no time: in what it would take neither forces nor their work could be left out.
    """
    at, before, strain = place_of(s, l, s.theta[l]), beam_now(s, l), strain_energy(s, l)
    p, q = s.theta_dot[l], s.angular_momentum[l] / at.J * s.theta[l]
    if near == 0 and s.theta[l] <= 2.0 * UPLIFT_TILT and abs(q) < s.theta[l]:
        s.theta_dot[l] = 0.0
        return  # it has only begun to tilt, a little too early
    moving, kappa = tilting_energy_3d(s, l, at), s.cone[l]
    least, speed = s.theta[l], abs(q)
    if near > 0:
        speed = math.sqrt(p * p + kappa * kappa * q * q) / kappa
        least = s.theta[l] * abs(q) / speed
    nearness = (
        math.inf if s.contact_time[l] == 0.0 else least / max(speed * s.contact_time[l], 1e-300)
    )
    share, e = loss_share(nearness), s.restitution[l]
    left, sign = 1.0 - share * (1.0 - e * e), math.copysign(1.0, s.angular_momentum[l])
    keeps, turn = math.sqrt(left), math.pi / kappa - math.pi
    s.angular_momentum[l] *= keeps
    if near > 0:
        s.cos_phi[l], s.sin_phi[l] = -s.cos_phi[l], -s.sin_phi[l]
        if q != 0.0:
            inside = 2.0 * math.asin(min(1.0, least / s.theta[l])) / kappa
            turn_by(s, l, sign * (turn * (1.0 - share) - inside))
        s.theta_dot[l] = max(-keeps * p, 0.0)
    else:
        s.theta_dot[l] = 0.0
        turn_by(s, l, -sign * share * turn)
    move_floors(s, l, before)
    lost = (1.0 - left) * moving + strain - strain_energy(s, l)
    s.energy_lost[l] += lost
    s.energy_passes[l] += lost
    row = log_event_3d(s, l, log, PASS, p, s.theta_dot[l], lost)
    describe_event(log, row, math.atan2(s.sin_phi[l], s.cos_phi[l]), least, nearness, share)
    s.closest_pass[l] = min(s.closest_pass[l], least / system.alpha)
    s.shortest_pass[l] = min(s.shortest_pass[l], least / max(speed, 1e-300))
    s.passes_as_impacts[l] += 1.0 if share > 0.5 else 0.0


@compiled
def settles(s: Record, l: int, system: Record, log: Record, near: int) -> bool:
    """After a pass: True if the storey comes to rest; what is too slow to get away starts anew."""
    at = place_of(s, l, s.theta[l])
    z_x, z_y = renew_push(s, l)
    push, limit = math.sqrt(z_x * z_x + z_y * z_y), limit_of(s, l, system)
    q = s.cone[l] * s.theta[l] * s.angular_momentum[l] / at.J
    v2, low = s.theta_dot[l] * s.theta_dot[l] + q * q, system.recontact_tolerance * system.alpha
    if near > 0 and push >= limit and v2 < SLOW * (push + limit) * UPRIGHT_TILT / at.A:
        begin_tilt(s, l, system, z_x, z_y)
        return False
    slows = math.cos(system.alpha) * (limit - push) / at.A
    if slows <= 0.0 or v2 >= 2.0 * slows * low or s.theta[l] >= low:
        return False
    before, strain, rate = beam_now(s, l), strain_energy(s, l), s.theta_dot[l]
    lost, kept = tilting_energy_3d(s, l, at) + lifting_energy(s, l, at), s.bounces_kept[l]
    half = s.storeys
    for r in range(s.n):
        out, velocity = (before[0], before[2]) if r < half else (before[1], before[3])
        change = kept * velocity  # absolute velocities stay, or, of 0, relative ones
        # What the floors lose of u_b' is lost: the mean of both velocities times the change.
        s.q[r, l] += s.Gamma[r, l] * out
        s.dq[0, r, l] += s.Gamma[r, l] * change
        lost += (1.0 - kept) * velocity * s.Gamma[r, l] * s.dq[0, r, l]
    if kept == 0.0:
        lost += 0.5 * s.floors_mass[l] * (before[2] * before[2] + before[3] * before[3])
    lost += strain - strain_energy(s, l)
    s.energy_lost[l] += lost
    s.phase[l] = FULL_CONTACT
    log_event_3d(s, l, log, RECONTACT, rate, 0.0, lost)
    return True


@compiled
def begin_tilt(s: Record, l: int, system: Record, z_x: float, z_y: float) -> None:
    """Tilt by 1e-9 along z, at rest; floors stay where they are, and the work is booked."""
    size, strain, lifted = math.sqrt(z_x * z_x + z_y * z_y), strain_energy(s, l), 0.0
    if size == 0.0:  # what falls freely may tilt to any side
        z_x, size = 1.0, 1.0
    before = (0.0, 0.0, 0.0, 0.0)
    rise = UPLIFT_TILT
    if s.phase[l] != FULL_CONTACT:
        at = place_of(s, l, s.theta[l])
        before = beam_now(s, l)
        rise -= s.theta[l]
        lifted = lifting_energy(s, l, at) + tilting_energy_3d(s, l, at)
    enter_phase_3d(s, l, system, ROLLING if system.beta > 0.0 else ROCKING)
    s.cos_phi[l], s.sin_phi[l] = z_x / size, z_y / size
    s.theta[l], s.theta_dot[l], s.angular_momentum[l] = UPLIFT_TILT, 0.0, 0.0
    move_floors(s, l, before)
    s.energy_input[l] += lifting_energy(s, l, place_of(s, l, UPLIFT_TILT)) - lifted
    s.energy_input[l] += strain_energy(s, l) - strain
    arm = s.diameter[l] * math.cos(system.alpha) / s.shear_factor[l]
    s.energy_input[l] += held_3d(s, l) * arm * rise
    s.step_limit[l] = FIRST_STEP


@compiled
def uplift_3d(s: Record, l: int, system: Record, log: Record) -> None:
    """Leave full contact along z; the modes' state is set already."""
    z_x, z_y = renew_push(s, l)
    begin_tilt(s, l, system, z_x, z_y)
    log_event_3d(s, l, log, UPLIFT, 0.0, 0.0, 0.0)
    begin_excursion(s, l, log)
    mark_azimuth(s, l, log)
