"""When the free vibration after the record can be left off: nothing new can come."""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.energy import inertia_unit, lifted_mass, total_energy
from rpscli.physics.floors import row_along, rows_of
from rpscli.physics.friction import grip_of, is_gripped
from rpscli.physics.lane import felt, pushed_by, ways_of
from rpscli.physics.state import BEDDED, FULL_CONTACT, STUCK, Record

REST_EVERY = 8
"""After the record, so many samples pass between looks at whether
anything can still happen."""

WOBBLES = 20.0
"""So long after the record a wobbling structure is left, once no
larger tilt can come [s]."""


@compiled
def is_over(s: Record, l: int, systems: Record) -> bool:
    """True if no later moment of the free vibration can bring a new maximum.

    Of what wobbles only the tilt is looked at: rigid ends lose nothing as it goes on.

    At rest each mode decays from its present energy, which bounds every demand and the
    push that could uplift the storey again. Uplifted in one plane a history is never
    over: impacts excite the building until the storey is down.
    """
    system = systems[0]
    free = s.interval[l] + 1 - s.npts[l]
    if system.until_rest == 0 or free <= 0 or free % REST_EVERY != 0:
        return False
    if s.phase[l] in (FULL_CONTACT, STUCK):
        return stays_down(s, l) and demands_stand(s, l, systems) and weights_stand(s, l)
    if s.phase[l] == BEDDED:
        return rests_on_bed(s, l, systems) and weights_stand(s, l)
    return ways_of(s) == 2 and free * s.dt[l] >= WOBBLES and tilts_no_more(s, l, system)


@compiled
def modal_speed(s: Record, l: int, r: int) -> float:
    """sqrt(2 E_r): mode r never moves faster than this, nor farther than this over w.

    It vibrates about what plastic drifts leave.
    """
    q = s.q[r, l] - s.freed[r, l] / s.omega2[r, l]
    return math.sqrt(s.dq[r, l] * s.dq[r, l] + s.omega2[r, l] * (q * q))


@compiled
def largest_force(s: Record, l: int, axis: int) -> float:
    """Bound on the force of the springs and dampers under the
    freely vibrating floors [N].
    """
    largest = 0.0
    for r in range(axis * s.n, (axis + 1) * s.n):
        force = math.sqrt(s.omega2[r, l]) + s.two_xi_omega[r, l]
        largest += abs(s.Gamma[r, l]) * force * modal_speed(s, l, r)
    return largest


@compiled
def stays_down(s: Record, l: int) -> bool:
    """True if the freely vibrating building can never again
    push hard enough to let go.
    """
    square = 0.0
    up = ways_of(s)
    for axis in range(up):
        largest = largest_force(s, l, axis)
        square += largest * largest
    most = pushed_by(s, l, math.sqrt(square))
    lightest = s.gravity[l]
    if s.axes > up:
        lightest = felt(s, l, lightest, largest_force(s, l, up))
    if is_gripped(s, l):
        grip = grip_of(s, l, (0.0, 0.0), (0.0, 0.0), (lightest, 0.0), most)
        return s.n == 0 or bool(
            most < pushed_by(s, l, s.friction_force[l]) and grip.margin > 0.0
        )
    limit = lightest * s.limit_right[l] + s.held_right[l]
    limit = min(limit, lightest * s.limit_left[l] + s.held_left[l])
    return s.n == 0 or bool(0.5 * s.diameter[l] * most < limit)


@compiled
def weights_stand(s: Record, l: int) -> bool:
    """True if free vibration upwards can bring no new force of a contact."""
    if s.axes == ways_of(s):
        return True
    upper = s.cap_beam_mass[l] + s.floors_mass[l]
    change = largest_force(s, l, ways_of(s)) / (upper * s.gravity[l])
    return bool(s.normal_top[l] <= 1.0 - change and s.heavy_top[l] >= 1.0 + change)


@compiled
def spare_strength(s: Record, l: int, r: int) -> float:
    """Strength that a storey without force still has before it yields again, to either
    side [N].
    """
    back = s.hardening[l] * s.stiffness[r, l] * abs(s.middle[r, l])
    return s.strength[r, l] - back  # type: ignore[no-any-return]


@compiled
def demands_stand(s: Record, l: int, systems: Record) -> bool:
    """True if free vibration in full contact can raise no storey
    shear and no acceleration.
    """
    rows = rows_of(s)
    for i in range(s.n):
        shears = 0.0
        accelerations = 0.0
        for axis in range(ways_of(s)):
            system = systems[axis]
            row = row_along(s, axis)
            shear = 0.0
            acceleration = 0.0
            for of in range(s.n):
                r = axis * s.n + of
                omega = system.omega[of]
                speed = modal_speed(s, l, r)
                shear += abs(system.storey_shear_of[of, i]) * speed / omega
                force = omega + system.two_xi_omega[of]
                acceleration += abs(system.phi[of, i]) * force * speed
            if shear > s.largest[row, l, i]:
                return False
            if acceleration > s.largest[rows + row, l, i]:
                return False
            if s.yields[l] > 0 and shear >= spare_strength(s, l, axis * s.n + i):
                return False
            shears = shears + shear * shear
            accelerations = accelerations + acceleration * acceleration
        if math.sqrt(shears) > s.largest[0, l, i]:
            return False
        if math.sqrt(accelerations) > s.largest[rows, l, i]:
            return False
    return True


@compiled
def tilts_no_more(s: Record, l: int, system: Record) -> bool:
    """True if the energy no longer suffices for a larger tilt, or for theta_cr."""
    level = min(s.max_theta[l], s.theta_cr[l])
    of = system.rolling if level < system.beta else system.rocking
    lift = s.diameter[l] * (of[4] + of[0] * math.sin(level) - of[1] * math.cos(level))
    least = lifted_mass(s, l) * s.gravity[l] * lift
    return s.x[l] < level and bool(total_energy(s, l, system) < least)


@compiled
def hardened_energy(s: Record, l: int) -> float:
    """Energy that plastic drifts keep stored in a building without forces [J]."""
    energy = 0.0
    for r in range(ways_of(s) * s.n if s.yields[l] > 0 else 0):
        back = s.hardening[l] * (1.0 - s.hardening[l]) * s.stiffness[r, l]
        energy += 0.5 * back * (s.middle[r, l] * s.middle[r, l])
    return energy


@compiled
def rests_on_bed(s: Record, l: int, systems: Record) -> bool:
    """True if free vibration in full contact can bring nothing new:
    energy bounds all of it.

    All springs together hold no more than the energy, nor do all masses: with E = v^2/2
    the tilt is below v/sqrt(N m_c R^2 k), a storey's shear below v sqrt(k_i), and the
    force of mode r below w_r v, with what its dampers add at velocities against the beam
    of v (1 + Gamma/sqrt(m_0)). Both directions share the energy: resultants are below
    the larger of both bounds.
    """
    system = systems[0]
    v = math.sqrt(2.0 * (total_energy(s, l, system) - hardened_energy(s, l)))
    per_tilt = math.sqrt(inertia_unit(s, l))
    farthest = v / (per_tilt * math.sqrt(system.bed_k))
    if farthest >= min(system.bed_uplift, s.max_theta[l]):
        return False
    C = system.bed_height
    A = s.io_1[l] + s.one[l] * C * C
    per_beam = s.diameter[l] * C / (per_tilt * math.sqrt(A))  # 1/sqrt(m_0)
    for axis in range(ways_of(s)):
        for i in range(s.n):
            shear, acceleration = bounds_on_bed(s, systems[axis], i, v, per_beam)
            for row in (0, row_along(s, axis)):
                if (
                    shear > s.largest[row, l, i]
                    or acceleration > s.largest[rows_of(s) + row, l, i]
                ):
                    return False
            if s.yields[l] > 0 and shear >= spare_strength(s, l, axis * s.n + i):
                return False
    return True


@compiled
def bounds_on_bed(
    s: Record, system: Record, i: int, v: float, per_beam: float
) -> tuple[float, float]:
    """Bounds on shear [N] and acceleration [m/s2] of a storey and its floor,
    of v and 1/sqrt(m_0).
    """
    stiffness = 0.0
    spring = 0.0
    damper = 0.0
    beam = 0.0
    for r in range(s.n):
        shear = system.storey_shear_of[r, i] / system.omega[r]
        force = system.phi[r, i] * system.omega[r]
        damped = system.phi[r, i] * system.two_xi_omega[r]
        stiffness = stiffness + shear * shear
        spring = spring + force * force
        damper += damped * damped
        beam += abs(damped * system.Gamma[r]) * per_beam
    return v * math.sqrt(stiffness), v * (math.sqrt(spring) + math.sqrt(damper) + beam)
