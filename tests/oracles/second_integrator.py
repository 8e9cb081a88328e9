"""A second road through a time history, for comparison with the program's own.

Everything that can differ does: the unknowns are the tilt and the inter-storey drifts, the mass
matrix is full and solved at each evaluation (`storey_lagrangian`), the steps are those of DOP853
restarted at every sample of the record (the ground acceleration is linear in between, so that the
right-hand side is smooth), and full contact is the matrix exponential. Events are searched between
the turning points of the dense output, then met by a new integration that ends on them. Devices
(`devices`) are functions whose kinks the steps find; friction holds a tilted storey as the ground
holds a standing one, with the same matrix exponential.
"""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from .crossings import Array, Curve, Stepper
from .devices import Equipment
from .full_contact import Exit, FullContact, LinearGround
from .storey_lagrangian import Contact, OracleSystem, StoreyLagrangian

__all__ = ["OracleResult", "OracleSystem", "simulate"]

_REMAINDER = 1e-13  # of an interval: less than this is not integrated any more
TURN = -1.0  # in place of a level: the rate changes its sign


@dataclass(frozen=True, eq=False)
class OracleResult:
    """What happened; histories at the record's samples and on into the free vibration.

    `max_rotation` includes the turning points between samples, `max_storey_shears_at_samples` are
    elastic (k_j d_j). `impacts` counts every passage of theta = 0 with contact, also the one that
    is followed by locking. A history that overturns ends before the limit is passed.
    """

    time: Array
    theta: Array
    drifts: Array
    max_rotation: float
    max_storey_shears_at_samples: Array
    impacts: int
    uplifts: int
    overturned: bool
    energy_lost: float
    device_work: Array
    """What each device took up [J], in its stiffness or for good."""
    plastic: tuple[float, ...]
    """Of each tendon, the elongation that stays [m]."""


class _Simulation(Stepper):
    """The state y = [theta, d, theta', d'] and its contact (None: full contact)."""

    def __init__(self, system, *, recontact, overturning, rtol, devices=()):
        self.lagrangian = StoreyLagrangian(system)
        self.full_contact = FullContact(self.lagrangian)
        self.negligible = recontact * np.arctan(system.tan_alpha)
        self.limit = overturning * self.lagrangian.critical_rotation
        self.rtol = rtol
        self.equipment = Equipment(self.lagrangian, devices)
        moving = 2 * self.lagrangian.storeys + 2
        self.y = np.zeros(moving + len(devices))
        self.tolerance = np.full(len(self.y), 1e-3 * rtol)
        # the work of devices follows from the motion and shall not shorten its steps
        self.tolerance[moving:] = np.inf
        self.contact = None
        self.stuck, self.direction = False, 1
        self.max_rotation = self.energy_lost = 0.0
        self.impacts = self.uplifts = 0
        self.overturned = False

    def advance(self, ground, duration):
        """Through one interval of the record, however many events it holds."""
        tau = 0.0
        while duration - tau > _REMAINDER * duration and not self.overturned:
            passed = self.stand if self.contact is None or self.stuck else self.move
            tau += passed(ground.later(tau), duration - tau)

    def exits(self):
        """Which push, in either direction, moves the storey that stands or is stuck."""
        motion = self.lagrangian
        ways = []
        for direction in (1, -1):
            contact = self.contact or Contact(direction, rolling=motion.beta > 0.0)
            theta = float(self.y[0])
            slope = motion.cap_beam(abs(theta), rolling=contact.rolling)[1]
            active, held = self.equipment.at_rest(contact, theta)
            lift = direction * contact.side * motion.lifted_mass * slope.imag / slope.real
            ways.append(Exit(direction, lift, (held - direction * active) / slope.real))
        return ways

    def ground_state(self, ground):
        """z of `full_contact`: drifts, their rates and the ground."""
        n = self.lagrangian.storeys
        drifts = np.r_[self.y[1 : n + 1], self.y[n + 2 : 2 * n + 2]]
        return np.asarray(np.r_[drifts, ground.horizontal, ground.horizontal_rate])

    def stand(self, ground, duration):
        """No tilt rate, until uplift, sliding or the end; returns the time that passed."""
        n = self.lagrangian.storeys
        pieces = max(1, int(np.ceil(duration * self.full_contact.fastest)))
        h = duration / pieces
        z, exits = self.ground_state(ground), self.exits()
        for piece in range(pieces):
            left = self.full_contact.leaving(z, ground.later(piece * h), h, exits)
            z = self.full_contact.over(z, h if left is None else left[0])
            self.y[1 : n + 1], self.y[n + 2 : 2 * n + 2] = z[:n], z[n : 2 * n]
            if left is not None:
                self.leave(left[1])
                return piece * h + left[0]
        return duration

    def leave(self, direction):
        """Uplift, or the end of sticking."""
        self.direction = direction
        if self.contact is None:
            self.uplifts += 1
            self.contact = Contact(direction, rolling=self.lagrangian.beta > 0.0)
        self.stuck = False
        if direction != self.contact.side:
            tilt = self.contact.side * float(self.y[0])
            self.equipment.unload(tilt, rolling=self.contact.rolling)

    def rates(self, ground, contact):
        """y' as a function of the time since `ground` and y."""
        motion, n1 = self.lagrangian, self.lagrangian.storeys + 1
        gravity, direction = motion.system.gravity, self.direction

        def rates(tau, y):
            a_g = ground.horizontal + tau * ground.horizontal_rate
            g = gravity + ground.vertical + tau * ground.vertical_rate
            pairs = self.equipment.moments(contact, float(y[0]), float(y[n1]), direction)
            moments = np.array([active + frictional for active, frictional in pairs])
            moved = motion.acceleration(contact, y, a_g, g, float(np.sum(moments)))
            return np.concatenate((y[n1 : 2 * n1], moved, -moments * y[n1]))

        return rates

    def levels(self, contact):
        """Values of |theta| that end this contact, with the direction of passing."""
        beta = self.lagrangian.beta
        if contact.rolling:
            return [(0.0, -1), (beta, 1), (self.limit, 1)]
        return [(beta, -1), (self.limit, 1)]

    def move(self, ground, duration):
        """Rolling or rocking until an event or the end; returns the time that passed."""
        contact, n1 = self.contact, self.lagrangian.storeys + 1
        assert contact is not None
        rates, least = (
            self.rates(ground, contact),
            0.0 if contact.rolling else self.lagrangian.beta,
        )
        for step in self.steps(rates, duration):
            tilt = Curve.through(contact.side * step.states[0])
            events = [
                (root, level)
                for level, way in self.levels(contact)
                if (root := tilt.crossing(level, way, tilt.noise)) is not None
            ]
            if self.equipment.turns:
                rate = Curve.through(self.direction * step.states[n1])
                if (root := rate.crossing(0.0, -1, rate.noise)) is not None:
                    events.append((root, TURN))
            at, event = min(events, default=(1.0, np.nan))
            self.max_rotation = max(self.max_rotation, tilt.highest(at))
            if events:
                tau = self.meet(rates, partial(self.miss, contact, event), step, at)
                self.y[n1 if event == TURN else 0] = (
                    0.0 if event == TURN else contact.side * event
                )
                self.max_rotation = max(self.max_rotation, abs(float(self.y[0])))
                self.switch(contact, event, ground.later(tau))
                return tau
            self.max_rotation = max(self.max_rotation, tilt.end)
            if tilt.end < least:
                raise RuntimeError("an event was passed unseen")
        return duration

    def miss(self, contact, event, y):
        """What vanishes at the event: a level of |theta|, or a turn."""
        if event == TURN:
            return float(y[self.lagrangian.storeys + 1])
        return contact.side * float(y[0]) - event

    def switch(self, contact, event, ground):
        """What an event does to the contact, to the velocities and to the devices."""
        if event == TURN:
            self.turn(ground)
        elif event == self.limit:
            self.overturned = True
        elif event > 0.0:
            self.contact = Contact(contact.side, not contact.rolling)
        else:
            self.impact(contact, ground)

    def turn(self, ground):
        """At rest for an instant, or for longer if friction holds what acts otherwise."""
        push = self.full_contact.push(self.ground_state(ground))
        gravity = self.lagrangian.system.gravity + ground.vertical
        for way in self.exits():
            if way.direction * push > way.lift * gravity + way.held:
                self.leave(way.direction)
                return
        self.stuck = True

    def impact(self, contact, ground):
        motion, n1 = self.lagrangian, self.lagrangian.storeys + 1
        before = sum(motion.energies(contact, self.y))
        self.impacts += 1
        self.y = motion.after_impact(self.y)
        beyond = Contact(-contact.side, contact.rolling)
        back = -beyond.side * float(self.rates(ground, beyond)(0.0, self.y)[n1])
        if back > 0.0 and self.y[n1] ** 2 / (2.0 * back) < self.negligible:
            self.lock(beyond, back)
        else:
            self.contact = beyond
        self.energy_lost += before - sum(motion.energies(beyond, self.y))

    def lock(self, beyond, back):
        """Full contact instead of the endless rest of shrinking excursions."""
        motion, n1 = self.lagrangian, self.lagrangian.storeys + 1
        if motion.storeys > 0:
            beam_rate = 2.0 * motion.half_height * self.y[n1]
            self.y[n1 + 1] += self.left_out(beyond, back) * beam_rate
        self.y[n1] = 0.0
        self.contact, self.step = None, np.inf

    def left_out(self, beyond, back):
        """What excursions that are not followed add to the first drift rate, over u_b'.

        Between impacts absolute floor velocities stay, so each excursion of speed w turns
        u_b' = c w into -k c w, where k^2 is the ratio of the accelerations to zero and from it: 1
        without friction, and 0 if that holds the storey where it stops. The first drift rate gains
        (1 + k) c w; over the alternating series with ratio -e k that is (1 + k) c w/(1 + e k) if
        impacts keep the drift rates, and c w if they do not.
        """
        motion = self.lagrangian
        if motion.system.law != "rigid":
            return 1.0
        _, held = self.equipment.at_rest(beyond, 0.0)
        mass = motion.mass_matrix(motion.cap_beam(0.0, rolling=beyond.rolling)[1])
        friction = float(held * np.linalg.inv(mass)[0, 0])
        k = math.sqrt(max(0.0, 1.0 - 2.0 * friction / back))
        return (1.0 + k) / (1.0 + motion.restitution * k)


def simulate(
    system,
    ag,
    dt,
    *,
    av=None,
    free_vibration=10.0,
    recontact_tolerance=1e-6,
    overturning_limit=2.0,
    rtol=1e-10,
    initial_rotation=0.0,
    devices=(),
):
    """Response to ground acceleration samples [m/s2], then to none for `free_vibration` seconds.

    The acceleration is linear between samples and drops to zero at the last one. It starts from
    rest: in full contact, or tilted by `initial_rotation` [rad] with the springs at ease.
    `recontact_tolerance` is the least excursion after an impact that is still followed, over alpha.
    """
    run = _Simulation(
        system,
        recontact=recontact_tolerance,
        overturning=overturning_limit,
        rtol=rtol,
        devices=devices,
    )
    if initial_rotation:
        run.y[0] = initial_rotation
        tilt = abs(initial_rotation)
        run.max_rotation = tilt
        run.contact = Contact(
            1 if initial_rotation > 0.0 else -1, tilt < run.lagrangian.beta
        )
        run.equipment.unload(tilt, rolling=run.contact.rolling)
    vertical = np.zeros_like(ag) if av is None else av
    states = [run.y.copy()]
    for j in range(len(ag) - 1 + round(free_vibration / dt)):
        ground = LinearGround(0.0, 0.0, 0.0, 0.0)
        if j < len(ag) - 1:
            rates = [float(a[j + 1] - a[j]) / dt for a in (ag, vertical)]
            ground = LinearGround(float(ag[j]), rates[0], float(vertical[j]), rates[1])
        if j == 0 and run.contact is not None:
            run.turn(ground)
        run.advance(ground, dt)
        if run.overturned:
            break
        states.append(run.y.copy())
    history = np.array(states)
    n = len(system.masses)
    drifts = history[:, 1 : n + 1]
    shears = np.max(np.abs(drifts * system.stiffnesses), axis=0)
    return OracleResult(
        time=np.arange(len(states), dtype=np.float64) * dt,
        theta=history[:, 0],
        drifts=drifts,
        max_rotation=run.max_rotation,
        max_storey_shears_at_samples=shears,
        impacts=run.impacts,
        uplifts=run.uplifts,
        overturned=run.overturned,
        energy_lost=run.energy_lost,
        device_work=run.y[2 * n + 2 :].copy(),
        plastic=tuple(run.equipment.plastic),
    )
