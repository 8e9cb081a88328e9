"""The beginning of a history: structure, modes and request in a lane at rest."""

from __future__ import annotations

import math

from rpscli.physics.bed import first_phase, load_bed
from rpscli.physics.compile import compiled
from rpscli.physics.demands import observe_start
from rpscli.physics.devices.acting import has_friction, load_devices
from rpscli.physics.devices.branches import release_devices
from rpscli.physics.ground import azimuth_of, set_ground
from rpscli.physics.lane import place_of, set_vector, ways_of
from rpscli.physics.next_step import plan
from rpscli.physics.run import KernelOutput
from rpscli.physics.samples import store_sample
from rpscli.physics.state import (
    BEDDED,
    EVENT_KINDS,
    FULL_CONTACT,
    NO_HISTORY,
    NOTHING,
    ROCKING,
    ROLLING,
    RUNNING,
    Floats,
    Record,
)
from rpscli.physics.step import renew
from rpscli.physics.storeys import load_storeys
from rpscli.physics.switches import reverse, stop_or_turn
from rpscli.physics.upright import enter_phase


@compiled
def idle(s: Record, l: int) -> None:
    """Leave a lane without a history: it takes steps of zero length."""
    s.history[l] = NO_HISTORY
    s.devices[l] = 0
    s.outcome[l] = RUNNING
    s.kinks[l] = 0.0
    s.branched[l] = 0.0
    s.yields[l] = 0
    s.marked[l] = 0
    s.kind[l] = NOTHING
    s.wanted[l] = NOTHING
    s.phase[l] = FULL_CONTACT
    s.moves[l] = 0.0
    s.time[l] = 0.0
    s.dt[l] = 1.0
    s.h[l] = 0.0
    s.h_most[l] = 1.0
    s.h_limit[l] = 0.0
    s.x[l] = 0.0
    s.v[l] = 0.0
    s.a[l] = 0.0
    s.interval[l] = 0
    s.npts[l] = 2
    for axis in range(ways_of(s)):
        s.tilt[axis, l] = 0.0
        s.tilt_rate[axis, l] = 0.0
        s.bend[axis, l] = 0.0
        s.a_g[axis, l] = 0.0
        s.a_g_slope[axis, l] = 0.0
        s.shaking[axis, l] = 0.0
    for r in range(s.axes * s.n):
        s.q[r, l] = 0.0
        s.dq[r, l] = 0.0
        s.freed[r, l] = 0.0
    calm_springs(s, l)


@compiled
def calm_springs(s: Record, l: int) -> None:
    """No force of springs, in any axis."""
    for axis in range(s.V.shape[0]):
        s.V[axis, l] = 0.0
        s.dV[axis, l] = 0.0
        s.ddV[axis, l] = 0.0
        s.new_V[axis, l] = 0.0
        s.new_dV[axis, l] = 0.0
        s.new_ddV[axis, l] = 0.0
        s.shaking[axis, l] = 0.0


@compiled
def begin_history(
    s: Record,
    l: int,
    systems: Record,
    requests: Record,
    history: int,
    acceleration: Floats,
    output: KernelOutput,
) -> None:
    """Load a history into a lane, at rest in full contact or released from a tilt."""
    request = requests[history]
    s.history[l] = history
    s.system[l] = s.axes * request.system
    both = systems[s.system[l] : s.system[l] + s.axes]
    system = both[0]
    load_system(s, l, system)
    calm_springs(s, l)
    for axis in range(s.axes):
        load_modes(s, l, both[axis], axis)
    load_request(s, l, request, system)
    load_devices(s, l, system)
    load_bed(s, l, system)
    clear_results(s, l)
    s.factors_h[l] = -1.0
    s.within_h[l] = -1.0
    stand_upright(s, l)
    set_ground(s, l, acceleration)
    enter_phase(s, l, system, first_phase(system))
    load_turning(s, l, system)
    if system.initial_rotation != 0.0 or system.alpha == 0.0 or system.compliant > 0:
        release(s, l, system, output.log)
    else:
        enter_phase(s, l, system, FULL_CONTACT)
        renew(s, l)
    observe_start(s, l)
    store_sample(s, l, both, output)
    s.h[l] = plan(s, l)


@compiled
def stand_upright(s: Record, l: int) -> None:
    """No tilt and no rate."""
    s.side[l] = 1.0
    s.x[l] = 0.0
    s.v[l] = 0.0
    set_vector(s, s.tilt, l, 0.0, 0.0)
    set_vector(s, s.tilt_rate, l, 0.0, 0.0)


@compiled
def load_turning(s: Record, l: int, system: Record) -> None:
    """Set kappa of a tilt to any side that goes round upright, and K on a bed."""
    s.kappa[l] = 1.0
    if ways_of(s) == 1:
        return
    upright = place_of(s, l, 0.0)
    u = system.bed_uplift
    s.kappa[l] = math.sqrt(upright.K / upright.A)
    if system.compliant > 0:  # K goes on from A of full contact
        bedded = s.io_1[l] + s.one[l] * (system.bed_height * system.bed_height)
        s.turned[l] = u * u * (bedded - place_of(s, l, u).K)


@compiled
def load_system(s: Record, l: int, system: Record) -> None:
    """Constants of the structure, folded as the laws want them."""
    ground = 1.0 + 2.0 * system.gamma
    building = 2.0 * system.gamma * system.eta
    s.diameter[l] = 2.0 * system.R
    s.io_1[l] = system.Io - 1.0
    s.i_3[l] = system.inertia_axial
    springs = s.axes > ways_of(s)
    s.one[l] = 1.0 + 4.0 * system.gamma
    s.four[l] = 0.0 if springs else 2.0 * building
    s.weigh[l] = (ground + building) / system.R
    s.load[l] = ground / system.R
    s.share[l] = 2.0 / (system.columns_mass * system.R)
    s.riding[l] = 0.0 if springs else system.floors_mass
    s.spared[l] = s.share[l] / s.weigh[l] if springs else 0.0
    s.columns_mass[l] = system.columns_mass
    s.cap_beam_mass[l] = system.cap_beam_mass
    s.floors_mass[l] = system.floors_mass
    s.gravity[l] = system.gravity
    s.sin_a[l] = math.sin(system.alpha)
    s.tan_a[l] = math.tan(system.alpha)
    s.spin[l] = system.rolling[2] if system.beta > 0.0 else 0.0
    s.beta[l] = system.beta
    s.sin_beta[l] = math.sin(system.beta)
    s.excess_beta[l] = system.beta - math.sin(system.beta)
    s.half_width[l] = system.R * math.sin(system.alpha)
    s.arc_radius[l] = system.R * system.rolling[2] if system.beta > 0.0 else 0.0
    s.theta_cr[l] = system.theta_cr
    s.contact_time[l] = system.contact_time
    s.shock_time[l] = system.shock_time
    s.step_error[l] = system.step_error
    s.bend_ratio[l] = system.bend_ratio


@compiled
def load_modes(s: Record, l: int, system: Record, axis: int) -> None:
    """The building's modes at rest, in a direction."""
    for of in range(system.n):
        r = axis * system.n + of
        s.omega2[r, l] = system.omega2[of]
        s.two_xi_omega[r, l] = system.two_xi_omega[of]
        s.Gamma[r, l] = system.Gamma[of]
        s.shear_weight[r, l] = system.shear_weight[of]
        s.acceleration_weight[r, l] = system.acceleration_weight[of]
        s.q[r, l] = 0.0
        s.dq[r, l] = 0.0
        s.seen_q[r, l] = 0.0
        s.seen_force[r, l] = 0.0
    load_storeys(s, l, system, axis)
    if axis < ways_of(s):
        s.bend_ratio[l] = max(s.bend_ratio[l], system.bend_ratio)


@compiled
def load_request(s: Record, l: int, request: Record, system: Record) -> None:
    """Load what is to be followed, and for how long."""
    for axis in range(ways_of(s)):
        s.record[axis, l] = request.record if axis == 0 else request.record_y
    s.npts[l] = request.npts
    s.vertical[l] = request.vertical
    s.scale[l] = request.scale
    s.dt[l] = request.dt
    s.rate[l] = 1.0 / request.dt
    s.outcome[l] = RUNNING
    s.kind[l] = NOTHING
    s.wanted[l] = NOTHING
    s.which[l] = 0
    s.interval[l] = 0
    s.h_limit[l] = math.inf
    s.stalled[l] = 0
    s.intervals[l] = (
        request.npts - 1 + math.ceil(system.free_vibration / request.dt - 1e-9)
    )


@compiled
def clear_results(s: Record, l: int) -> None:
    """Nothing has happened yet."""
    for i in range(s.kept.shape[0]):
        s.kept[i, l] = 0
    s.critical_time[l] = -1.0
    s.normal_top[l] = math.inf
    s.normal_bottom[l] = math.inf
    s.closest_pass[l] = math.inf
    s.shortest_pass[l] = math.inf
    s.contacts_near[l] = 1.0
    s.directionless[l] = 0
    for k in range(s.room.shape[0]):
        s.room[k, l] = 0.0
        for i in range(s.n):
            s.largest[k, l, i] = 0.0
            s.last[k, l, i] = 0.0
    for axis in range(ways_of(s)):
        s.max_beam[axis, l] = 0.0
    s.steps[l] = 0.0
    for i in range(EVENT_KINDS):
        s.events[i, l] = 0


@compiled
def release(s: Record, l: int, system: Record, log: Record) -> None:
    """Start from rest at a rotation, the building unstrained; without
    a flat part perhaps at 0.
    """
    theta = abs(system.initial_rotation)
    s.side[l] = math.copysign(1.0, system.initial_rotation)
    s.x[l] = theta
    s.max_theta[l] = theta
    s.tilt[0, l] = s.side[l] * theta
    s.max_azimuth[l] = azimuth_of(s, l)
    set_vector(s, s.tilt_rate, l, 0.0, s.tilt[0, l] * system.initial_turning)
    phase = ROLLING if theta < system.beta else ROCKING
    bedded = theta < system.bed_uplift
    enter_phase(s, l, system, BEDDED if bedded else phase)
    release_devices(s, l)
    renew(s, l)
    if has_friction(s, l) and ways_of(s) == 2:
        stop_or_turn(s, l, system, log)
    elif has_friction(s, l):
        reverse(s, l, system, log)
