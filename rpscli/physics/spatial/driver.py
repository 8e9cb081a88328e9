"""Histories under two horizontal components, in lanes: as `planar.driver`, with other pieces."""

from __future__ import annotations

import math

import numpy as np

from rpscli.physics.core.compile import compiled, exact_kernel, variant
from rpscli.physics.core.lanes import set_ground
from rpscli.physics.core.records import LANES, NO_HISTORY, Record, scratch
from rpscli.physics.planar.devices.events import check_devices
from rpscli.physics.planar.devices.flows import leave_devices
from rpscli.physics.planar.devices.rest import load_devices, release_devices
from rpscli.physics.planar.driver import (
    clear_floors,
    clear_results,
    leave_floors,
    leave_result,
    load_modes,
    load_request,
    load_system,
    observe_lanes,
    run_interruptible,
    system_of,
    without_owners,
)
from rpscli.physics.planar.energy import building_energy
from rpscli.physics.planar.run import Output, Run
from rpscli.physics.planar.samples import store_sample
from rpscli.physics.planar.state import (
    AT_REST,
    BLOCK,
    FAILED_TOO_MANY_STEPS,
    FOLLOW_CONTACT,
    FULL_CONTACT,
    GOES_ON,
    IS_OVER,
    NOT_ACCEPTED,
    ROCKING,
    ROLLING,
    RUNNING,
    SURVIVED,
    UPLIFT,
)
from rpscli.physics.spatial import samples  # noqa: F401 -- which tell planar functions of theirs
from rpscli.physics.spatial.demands import observe_ends_3d, observe_start_3d
from rpscli.physics.spatial.devices import check_speeds, load_3d
from rpscli.physics.spatial.energy import uplifted_energy_3d
from rpscli.physics.spatial.equation_of_motion import enter_phase_3d, place_of
from rpscli.physics.spatial.events import next_interval_3d, resolve_step_3d
from rpscli.physics.spatial.full_contact import follow_full_contact_3d
from rpscli.physics.spatial.state import STATES_3D, variant_of_pairs
from rpscli.physics.spatial.steps import accept_steps, check_steps, grow, plan_step, take_steps


def integrate_pairs(run: Run, lanes: int = LANES, *, interruptible: bool = False) -> None:
    """Follow every history of `run.requests` from rest; writes `run.results`.

    `run.systems` holds two records of each structure, of its directions x and y.
    """
    systems = run.systems.view(np.ndarray)
    state, storeys = scratch(STATES_3D[variant_of_pairs(run)]), systems["n"][0]
    blocks, plain = scratch(BLOCK, 2), state.view(np.ndarray)
    plain["n"], plain["storeys"], plain["lanes"], plain["stop"] = 2 * storeys, storeys, lanes, 0
    blocks.view(np.ndarray)["n"] = storeys
    run_interruptible(integrate_lanes_3d, state, blocks, run, interruptible=interruptible)


@exact_kernel
def integrate_lanes_3d(state: Record, blocks: Record, run: Run) -> None:  # noqa: C901, PLR0912 -- see `planar.driver`
    """The same, in lanes and two blocks of steps that are made already."""
    s, run = state[0], without_owners(run)
    systems, acceleration, output = run.systems, run.acceleration, run.output
    s.audited = 1 if output.samples.shape[0] > 0 else 0
    s.waiting, active = 0, s.lanes
    begun = False
    while active > 0 and s.stop == 0:
        if begun:
            advance_lanes_3d(state, systems, blocks, output)
        for l in range(s.lanes):
            next_action = IS_OVER
            if not begun:  # each takes its first history
                s.history[l], s.accepted[l] = NO_HISTORY, 0.0
            elif s.needs_attention[l] == 0.0 or s.history[l] == NO_HISTORY:
                continue
            elif s.accepted[l] == 0.0:
                next_action = NOT_ACCEPTED
            else:
                grow(s, l)
                plan_step(s, l)
                next_action = GOES_ON
                if s.steps[l] > systems[s.system[l]].most_steps:
                    s.outcome[l], next_action = FAILED_TOO_MANY_STEPS, IS_OVER
            while next_action != GOES_ON or s.steps_left[l] == 0.0:
                both = system_of(s, l, systems)
                if next_action == NOT_ACCEPTED:
                    next_action = resolve_step_3d(s, l, both, blocks[0], output)
                elif next_action == FOLLOW_CONTACT:
                    next_action = follow_full_contact_3d(s, l, both, blocks, acceleration, output)
                elif next_action == GOES_ON:
                    next_action = next_interval_3d(s, l, both[0], acceleration)
                    if s.audited > 0:
                        store_sample(s, l, both, output)
                else:
                    next_action = next_history_3d(s, l, run)
            active -= s.history[l] == NO_HISTORY
        begun = True


@exact_kernel
def advance_lanes_3d(state: Record, systems: Record, blocks: Record, output: Output) -> None:
    """A step of all lanes together, as far as it holds no event."""
    s = state[0]
    take_steps(s)
    check_steps(s)
    check_devices(s)
    check_speeds(s)
    observe_ends_3d(s)
    observe_lanes(s, systems, blocks[0], output)
    accept_steps(s)


@exact_kernel
def next_history_3d(s: Record, l: int, run: Run) -> int:
    """A lane's history is over: FOLLOW_CONTACT or GOES_ON with the next, if there is one."""
    if s.history[l] != NO_HISTORY:
        finish_history_3d(s, l, run)
    if s.waiting < run.requests.shape[0]:
        s.waiting += 1
        return begin_history_3d(s, l, run, s.waiting - 1)
    # It makes steps of nothing, of a tilt at rest.
    s.history[l], s.step[l], s.steps_left[l], s.system[l] = NO_HISTORY, 1e-9, 1.0, 0
    s.devices[l] = 0
    s.theta[l], s.theta_dot[l], s.angular_momentum[l] = 0.1, 0.0, 0.0
    s.cos_phi[l], s.sin_phi[l] = 1.0, 0.0
    return GOES_ON


@variant(system_of, "cos_phi")
def systems_of(s: Record, l: int, systems: Record) -> Record:
    """The structure of a lane, in x and in y."""
    return systems[s.system[l] : s.system[l] + 2]


@compiled
def begin_history_3d(s: Record, l: int, run: Run, history: int) -> int:
    """Load a history into a lane, at rest: FOLLOW_CONTACT, or GOES_ON if it is tilted."""
    request = run.requests[history]
    s.history[l], s.system[l] = history, 2 * request.system
    both = system_of(s, l, run.systems)
    system = both[0]
    load_system(s, l, system)
    load_request(s, l, request, system)
    for axis in range(2):
        load_modes(s, l, both[axis], axis * s.storeys)
    s.bend_ratio[l], s.record_y[l] = max(system.bend_ratio, both[1].bend_ratio), request.record_y
    s.inertia_axial[l], s.restitution[l] = system.inertia_axial, system.restitution
    s.contact_time[l] = system.contact_time
    s.bounces_kept[l] = 1.0 if system.bounces > 0.0 else 0.0
    s.push_x[l], s.push_y[l], s.pull[l] = 0.0, 0.0, 0.0
    load_devices(s, l, system)
    load_3d(s, l)
    s.angular_momentum[l], s.cos_phi[l], s.sin_phi[l] = 0.0, 1.0, 0.0
    s.turning_rate[l], s.tilt_terms[0, l], s.per_J[l] = 0.0, 0.0, 0.0
    s.step_limit[l], s.series_ratio[l] = 0.0, 1.0
    enter_phase_3d(s, l, system, ROLLING if system.beta > 0.0 else ROCKING)
    sine = math.cos(system.alpha)
    s.cone[l] = math.sqrt((s.io_1[l] + s.one_4gamma[l] * sine * sine) / place_of(s, l, 0.0).A)
    s.phase[l] = FULL_CONTACT
    clear_results(s, l)
    s.max_azimuth[l], s.critical_azimuth[l] = 0.0, 0.0
    s.max_beam[0, l], s.max_beam[1, l], s.torsion_lever[l] = 0.0, 0.0, 0.0
    s.passes_as_impacts[l], s.energy_passes[l] = 0.0, 0.0
    s.closest_pass[l], s.shortest_pass[l] = math.inf, math.inf
    set_ground(s, l, run.acceleration)
    if system.initial_rotation != 0.0:
        release_3d(s, l, system)
        plan_step(s, l)
        store_sample(s, l, both, run.output)
        return GOES_ON
    store_sample(s, l, both, run.output)
    return FOLLOW_CONTACT


@compiled
def release_3d(s: Record, l: int, system: Record) -> None:
    """Start at a tilt in x that may turn, the building unstrained."""
    theta = abs(system.initial_rotation)
    s.theta[l], s.cos_phi[l] = theta, math.copysign(1.0, system.initial_rotation)
    s.max_theta[l], s.max_azimuth[l] = theta, math.acos(s.cos_phi[l])
    enter_phase_3d(s, l, system, ROLLING if theta < system.beta else ROCKING)
    s.angular_momentum[l] = place_of(s, l, theta).J * system.initial_turning
    release_devices(s, l)
    observe_start_3d(s, l)


@variant(clear_floors, "cos_phi")
def clear_floors_3d(s: Record, l: int) -> None:
    """Nothing was demanded of storeys and floors."""
    for k in range(6):
        s.room[k, l], s.below[k, l] = 0.0, 0.0
        for i in range(s.storeys):
            s.largest[k, l, i], s.last[k, l, i] = 0.0, 0.0


@variant(leave_floors, "cos_phi")
def leave_floors_3d(s: Record, l: int, result: Record) -> None:
    """Write the demands of storeys and floors."""
    for i in range(s.storeys):
        result.storey_shear[i], result.floor_acceleration[i] = (
            s.largest[0, l, i],
            s.largest[3, l, i],
        )
        result.storey_shear_x[i], result.storey_shear_y[i] = s.largest[1, l, i], s.largest[2, l, i]
        result.floor_acceleration_x[i] = s.largest[4, l, i]
        result.floor_acceleration_y[i] = s.largest[5, l, i]


@compiled
def finish_history_3d(s: Record, l: int, run: Run) -> None:
    """Write what the history leaves behind."""
    result, stands = run.results[s.history[l]], s.phase[l] == FULL_CONTACT
    azimuth = 0.0 if stands else math.atan2(s.sin_phi[l], s.cos_phi[l])
    if not stands and s.theta[l] > s.max_theta[l]:
        s.max_theta[l], s.max_theta_time[l] = s.theta[l], s.interval_start[l] + s.time[l]
        s.max_azimuth[l] = azimuth
    if s.outcome[l] == RUNNING:
        moved = s.max_theta[l] > 0.0 or s.events[l, UPLIFT] > 0
        s.outcome[l] = SURVIVED if moved else AT_REST
    result.energy_stored = building_energy(s, l, 0.0) if stands else uplifted_energy_3d(s, l)
    s.theta[l] = 0.0 if stands else s.theta[l]
    leave_result(s, l, result)
    leave_devices(s, l, result)
    result.azimuth, result.max_azimuth = azimuth, s.max_azimuth[l]
    result.critical_azimuth = s.critical_azimuth[l]
    result.max_x, result.max_y = s.max_beam[0, l], s.max_beam[1, l]
    result.passes_as_impacts = int(s.passes_as_impacts[l])
    result.closest_pass, result.shortest_pass = s.closest_pass[l], s.shortest_pass[l]
    result.energy_passes, result.torsion_lever = s.energy_passes[l], s.torsion_lever[l]
