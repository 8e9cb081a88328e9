"""Histories in lanes: step - check - observe - accept - switch.

Each lane follows one history at a time; when it is over the lane takes the next one. All lanes
make their Taylor steps together, each from its own time with its own length, so that the processor
works on them at once; whatever is particular to one - full contact, the location of an event, a
switch of phase - is done for that lane alone. No number passes from one lane to another: a history
does not depend on its neighbours.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from threading import Event, Thread, current_thread, main_thread

import numpy as np

from rpscli.physics.core.compile import by_record, compiled, kernel, uncounted
from rpscli.physics.core.lanes import set_ground
from rpscli.physics.core.records import LANES, NO_HISTORY, Record, scratch
from rpscli.physics.planar.bed.passages import leave_bed, load_bed
from rpscli.physics.planar.bed.terms import check_bed, watch_pace
from rpscli.physics.planar.bed_block import follow_on_bed, stands_on_bed
from rpscli.physics.planar.bed_events import observe_bed
from rpscli.physics.planar.demands import (
    observe_ends,
    raise_contacts_within,
    raise_floors,
)
from rpscli.physics.planar.devices.events import check_devices
from rpscli.physics.planar.devices.flows import book_devices, leave_devices, observe_devices
from rpscli.physics.planar.devices.rest import load_devices, release_devices
from rpscli.physics.planar.energy import book_energy, building_energy, uplifted_energy
from rpscli.physics.planar.equation_of_motion import load_factors
from rpscli.physics.planar.events import go_on_restarted, next_interval, raise_peak, resolve_step
from rpscli.physics.planar.full_contact.follow import follow_full_contact
from rpscli.physics.planar.run import Output, Run, variant_of
from rpscli.physics.planar.samples import store_sample, store_within
from rpscli.physics.planar.state import (
    AFTER_RELEASE,
    AT_REST,
    BEDDED,
    BLOCKS,
    EVENT_KINDS,
    FAILED_TOO_MANY_STEPS,
    FOLLOW_CONTACT,
    FULL_CONTACT,
    GOES_ON,
    IS_OVER,
    NOT_ACCEPTED,
    NOTHING_NEW,
    ROCKING,
    ROLLING,
    RUNNING,
    STATES,
    SURVIVED,
    UPLIFT,
)
from rpscli.physics.planar.steps import (
    accept_steps,
    check_steps,
    plan_next_step,
    plan_steps,
    take_steps,
)
from rpscli.physics.planar.transitions import enter_phase

HEARS = 0.1
"""A Ctrl-C is heard within so many seconds."""


def integrate(run: Run, lanes: int = LANES, *, interruptible: bool = False) -> None:
    """Follow every history of `run.requests` from rest; writes `run.results`.

    Machine code hears no signal: to be `interruptible` by Ctrl-C it runs in another thread, which
    costs a tenth of a millisecond.
    """
    systems = run.systems.view(np.ndarray)  # fields of records take ten times as long
    state, block = scratch(STATES[variant_of(run)]), scratch(BLOCKS[variant_of(run)])
    storeys, plain = systems["n"][0], state.view(np.ndarray)
    plain["n"], plain["lanes"], plain["stop"] = storeys, lanes, 0
    if "fading" in (plain.dtype.names or ()):
        plain["fading"] = int((systems["bed_full"] > 0.0).any())
    block.view(np.ndarray)["n"] = storeys
    run_interruptible(integrate_lanes, state, block, run, interruptible=interruptible)


def run_interruptible(
    lanes_of: Callable[[Record, Record, Run], None],
    state: Record,
    block: Record,
    run: Run,
    *,
    interruptible: bool,
) -> None:
    """Call a kernel, in another thread if it is to hear Ctrl-C.

    Of many histories the longest begin first, so that no lane is left with one at the end.
    """
    if len(run.requests) > LANES and not run.output.samples.size:
        given = run.requests.view(np.ndarray)
        order = np.argsort(-given["npts"] * given["dt"], kind="stable")
        if np.any(order[1:] < order[:-1]):
            ordered = run._replace(requests=run.requests[order], results=run.results[order])
            run_interruptible(lanes_of, state, block, ordered, interruptible=interruptible)
            run.results[order] = ordered.results
            return
    if not interruptible or current_thread() is not main_thread():
        lanes_of(state, block, run)
        return
    plain, ended = state.view(np.ndarray), Event()

    def work() -> None:
        try:
            lanes_of(state, block, run)
        finally:
            ended.set()

    Thread(target=work, daemon=True).start()
    try:
        # Not Thread.join: interrupted, it takes a running thread for ended before Python 3.13.
        while not ended.wait(HEARS):
            pass
    except BaseException:
        plain["stop"] = 1
        ended.wait()
        raise


@kernel
def integrate_lanes(state: Record, block: Record, run: Run) -> None:  # noqa: C901, PLR0912 -- see below
    """The same, in lanes and a block of steps that are made already: arrays of one record.

    What becomes of a lane is decided here: in a function of its own it would cost a tenth of the
    speed, and all that it calls would be compiled once more.
    """
    s = state[0]
    run = without_owners(run)
    systems, acceleration, output = run.systems, run.acceleration, run.output
    s.audited = 1 if output.samples.shape[0] > 0 else 0
    s.waiting, active = 0, s.lanes
    begun = False
    while active > 0 and s.stop == 0:
        if begun:
            advance_lanes(state, systems, block, output)
        for l in range(s.lanes):
            next_action = IS_OVER
            if not begun:  # each takes its first history
                s.history[l], s.accepted[l], s.restart_after[l] = NO_HISTORY, 0.0, NOTHING_NEW
            elif s.needs_attention[l] == 0.0 or s.history[l] == NO_HISTORY:
                continue
            elif s.accepted[l] == 0.0:
                next_action = NOT_ACCEPTED
            elif s.steps_left[l] > 0.0:
                plan_next_step(s, l)
                if s.steps[l] <= systems[s.system[l]].most_steps:
                    next_action = GOES_ON
                else:
                    s.outcome[l] = FAILED_TOO_MANY_STEPS
            else:
                next_action = next_interval(s, l, systems[s.system[l]], acceleration)
                if s.audited > 0:
                    keep_sample(s, l, systems, output)
            while next_action != GOES_ON or s.restart_after[l] != NOTHING_NEW:
                system = systems[s.system[l]]
                if next_action == NOT_ACCEPTED:
                    next_action = resolve_step(s, l, system, block[0], output)
                elif next_action == FOLLOW_CONTACT and stands_on_bed(s, l):
                    next_action = follow_on_bed(s, l, system, block[0], acceleration, output)
                elif next_action == FOLLOW_CONTACT:
                    next_action = follow_full_contact(s, l, system, block[0], acceleration, output)
                elif next_action == GOES_ON:
                    next_action = go_on_restarted(s, l, system, output)
                else:
                    next_action = next_history(s, l, run)
            active -= s.history[l] == NO_HISTORY
        begun = True


@compiled
def without_owners(run: Run) -> Run:
    """The same run, of arrays that are `uncounted`."""
    output = Output(
        uncounted(run.output.samples),
        uncounted(run.output.floors),
        uncounted(run.output.log),
        uncounted(run.output.devices),
        run.output.finer,
    )
    return Run(
        uncounted(run.systems),
        uncounted(run.requests),
        uncounted(run.acceleration),
        uncounted(run.results),
        output,
    )


@kernel
def advance_lanes(state: Record, systems: Record, blocks: Record, output: Output) -> None:
    """A step of all lanes together, as far as it holds no event."""
    s = state[0]
    take_steps(s)
    check_steps(s)
    check_devices(s)
    check_bed(s)
    observe_ends(s)
    observe_lanes(s, systems, blocks[0], output)
    accept_steps(s)
    watch_pace(s)


@compiled
def keep_sample(s: Record, l: int, systems: Record, output: Output) -> None:
    """Store the sample at which a lane has arrived."""
    store_sample(s, l, systems[s.system[l]], output)


@kernel
def next_history(s: Record, l: int, run: Run) -> int:
    """A lane's history is over: FOLLOW_CONTACT or GOES_ON with the next, if there is one."""
    if s.history[l] != NO_HISTORY:
        finish_history(s, l, run.systems[s.system[l]], run.results)
    if s.waiting < run.requests.shape[0]:
        s.waiting += 1
        next_action = begin_history(s, l, run, s.waiting - 1)
        if next_action == GOES_ON:
            plan_steps(s, l)
        return next_action
    idle(s, l)
    return GOES_ON


@compiled
def observe_lanes(s: Record, systems: Record, block: Record, output: Output) -> None:
    """What few steps ask for, lane by lane."""
    for l in range(s.lanes):
        if s.accepted[l] == 0.0:
            continue
        system = system_of(s, l, systems)
        if s.audited > 0:
            book_energy(s, l, 1.0)
            if output.finer > 1:
                store_within(s, l, system, output, 1.0)
        if s.devices[l] > 0:
            book_devices(s, l, 1.0)
            observe_devices(s, l, 1.0)
        observe_bed(s, l, 1.0)
        if s.peak_inside[l] > 0.0:
            raise_peak(s, l, block, output.log)
        if s.demands_rise[l] > 0.0:
            raise_floors(s, l, system)
        raise_contacts_within(s, l, 1.0)


@by_record
def system_of(s: Record, l: int, systems: Record) -> Record:
    """The structure of a lane."""
    return systems[s.system[l]]


@compiled
def idle(s: Record, l: int) -> None:
    """Leave a lane without a history: it makes empty steps."""
    s.history[l], s.devices[l], s.nonsmooth_damper[l] = NO_HISTORY, 0, 0.0
    s.restart_after[l], s.step[l], s.system[l] = NOTHING_NEW, 0.0, 0


@compiled
def begin_history(s: Record, l: int, run: Run, history: int) -> int:
    """Load a history into a lane, at rest: FOLLOW_CONTACT, or GOES_ON if it is tilted."""
    request = run.requests[history]
    system = run.systems[request.system]
    s.history[l], s.system[l] = history, request.system
    load_system(s, l, system)
    load_modes(s, l, system, 0)
    load_request(s, l, request, system)
    load_devices(s, l, system)
    load_bed(s, l, system, request)
    enter_phase(s, l, system, ROLLING if system.beta > 0.0 else ROCKING)
    s.phase[l] = FULL_CONTACT
    clear_results(s, l)
    set_ground(s, l, run.acceleration)
    if system.initial_rotation != 0.0 or system.alpha == 0.0 or system.compliant > 0:
        release(s, l, system)
        return GOES_ON
    s.next_a_g[l], s.next_g_up[l], s.next_V[l] = s.a_g[l], s.g_up[l], 0.0
    store_sample(s, l, system, run.output)
    return FOLLOW_CONTACT


@compiled
def load_request(s: Record, l: int, request: Record, system: Record) -> None:
    """What is followed, at rest, and in which steps."""
    s.record[l], s.npts[l], s.vertical[l] = request.record, request.npts, request.vertical
    s.scale[l], s.dt[l], s.sampling_rate[l] = request.scale, request.dt, 1.0 / request.dt
    s.outcome[l], s.restart_after[l] = RUNNING, NOTHING_NEW
    s.interval[l] = 0
    s.intervals[l] = request.npts - 1 + math.ceil(system.free_vibration / request.dt - 1e-9)
    steps = max(math.ceil(request.dt * system.uplifted_rate), 1)
    s.uplifted_step[l], s.uplifted_steps[l] = request.dt / steps, steps
    steps = max(math.ceil(request.dt * system.contact_rate), 1)
    s.contact_step[l], s.contact_steps[l] = request.dt / steps, steps
    s.side[l], s.theta[l], s.theta_dot[l], s.theta_ddot[l] = 1.0, 0.0, 0.0, 0.0
    s.no_event[l], s.stalled[l] = 0.0, 0


@compiled
def load_system(s: Record, l: int, system: Record) -> None:
    """Constants of the structure, folded as the equation of motion wants them."""
    ground_factor, building = load_factors(system.gamma, system.eta)
    s.diameter[l], s.io_1[l] = 2.0 * system.R, system.Io - 1.0
    s.one_4gamma[l], s.four_gamma_eta[l] = 1.0 + 4.0 * system.gamma, 2.0 * building
    s.weight_over_R[l] = (ground_factor + building) / system.R
    s.ground_over_R[l] = ground_factor / system.R
    s.shear_factor[l] = 2.0 / (system.columns_mass * system.R)
    s.columns_mass[l], s.cap_beam_mass[l] = system.columns_mass, system.cap_beam_mass
    s.floors_mass[l], s.gravity[l] = system.floors_mass, system.gravity
    s.theta_cr[l], s.last_term[l] = system.theta_cr, system.last_term
    s.bend_ratio[l] = system.bend_ratio


@compiled
def load_modes(s: Record, l: int, system: Record, first: int) -> None:
    """The building's modes at rest, from a row on."""
    for of in range(system.n):
        r = first + of
        s.omega2[r, l], s.two_xi_omega[r, l] = system.omega2[of], system.two_xi_omega[of]
        s.Gamma[r, l], s.shear_weight[r, l] = system.Gamma[of], system.shear_weight[of]
        s.acceleration_weight[r, l] = system.acceleration_weight[of]
        s.q[r, l], s.dq[0, r, l], s.seen_q[r, l], s.seen_force[r, l] = 0.0, 0.0, 0.0, 0.0


@compiled
def clear_results(s: Record, l: int) -> None:
    """Nothing has happened yet."""
    s.max_theta[l], s.max_theta_time[l], s.critical_time[l] = 0.0, 0.0, -1.0
    s.friction_top[l], s.friction_bottom[l] = 0.0, 0.0
    s.normal_top[l], s.normal_bottom[l] = math.inf, math.inf
    s.heavy_top[l], s.heavy_bottom[l] = 0.0, 0.0
    s.shear_top[l], s.shear_bottom[l] = 0.0, 0.0
    clear_floors(s, l)
    s.energy_input[l], s.energy_damped[l] = 0.0, 0.0
    s.energy_lost[l], s.energy_created[l] = 0.0, 0.0
    s.steps[l], s.creating_impacts[l] = 0.0, 0
    for i in range(EVENT_KINDS):
        s.events[l, i] = 0


@by_record
def clear_floors(s: Record, l: int) -> None:
    """The same of storeys and floors."""
    s.shear_below_all_maxima[l], s.acceleration_below_all_maxima[l] = 0.0, 0.0
    s.shear_room[l], s.acceleration_room[l] = 0.0, 0.0
    for i in range(s.n):
        s.storey_shear[l, i], s.floor_acceleration[l, i] = 0.0, 0.0
        s.last_shear[l, i], s.last_acceleration[l, i] = 0.0, 0.0


@compiled
def release(s: Record, l: int, system: Record) -> None:
    """Start from rest at a rotation, the building unstrained; without a flat part perhaps at 0."""
    theta = abs(system.initial_rotation)
    s.side[l] = math.copysign(1.0, system.initial_rotation)
    s.theta[l], s.max_theta[l], s.restart_after[l] = theta, theta, AFTER_RELEASE
    phase = ROLLING if theta < system.beta else ROCKING
    enter_phase(s, l, system, BEDDED if theta < system.bed_uplift else phase)
    release_devices(s, l)


@compiled
def finish_history(s: Record, l: int, system: Record, results: Record) -> None:
    """Write what the history leaves behind [results (P,)]."""
    result = results[s.history[l]]
    if s.phase[l] == FULL_CONTACT:
        result.energy_stored = building_energy(s, l, 0.0)
    else:
        result.energy_stored = uplifted_energy(s, l, system)
    if s.outcome[l] == RUNNING:
        released = system.initial_rotation != 0.0 or s.max_theta[l] > system.bed_uplift
        moved = released or s.events[l, UPLIFT] > 0
        s.outcome[l] = SURVIVED if moved else AT_REST
    leave_result(s, l, result)
    leave_devices(s, l, result)
    leave_bed(s, l, result)


@compiled
def leave_result(s: Record, l: int, result: Record) -> None:
    """Write what both kernels know of the end."""
    result.outcome, result.phase, result.intervals = s.outcome[l], s.phase[l], s.interval[l]
    result.steps, result.creating_impacts = int(s.steps[l]), s.creating_impacts[l]
    result.time = s.interval_start[l] + s.time[l]
    result.rotation = s.side[l] * s.theta[l]
    result.max_theta, result.max_theta_time = s.max_theta[l], s.max_theta_time[l]
    result.critical_time = s.critical_time[l]
    result.friction_top, result.friction_bottom = s.friction_top[l], s.friction_bottom[l]
    result.normal_top, result.normal_bottom = s.normal_top[l], s.normal_bottom[l]
    result.heavy_top, result.heavy_bottom = s.heavy_top[l], s.heavy_bottom[l]
    result.shear_top, result.shear_bottom = s.shear_top[l], s.shear_bottom[l]
    result.energy_input, result.energy_damped = s.energy_input[l], s.energy_damped[l]
    result.energy_lost, result.energy_created = s.energy_lost[l], s.energy_created[l]
    leave_floors(s, l, result)
    for i in range(EVENT_KINDS):
        result.events[i] = s.events[l, i]


@by_record
def leave_floors(s: Record, l: int, result: Record) -> None:
    """Write the demands of storeys and floors."""
    for i in range(s.n):
        result.storey_shear[i] = s.storey_shear[l, i]
        result.floor_acceleration[i] = s.floor_acceleration[l, i]
