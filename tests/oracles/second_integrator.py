"""A second road through a time history, for comparison with the program's own.

Everything that can differ does: the unknowns are the tilt and the inter-storey drifts, the mass
matrix is full and solved at each evaluation (`storey_lagrangian`), the steps are those of DOP853
restarted at every sample of the record (the ground acceleration is linear in between, so that the
right-hand side is smooth), and full contact is the matrix exponential. Events are searched between
the turning points of the dense output, then met by a new integration that ends on them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from scipy.integrate import DOP853

from .crossings import NODES, Array, first_crossing, monotone_pieces, through_nodes
from .full_contact import FullContact, LinearGround
from .storey_lagrangian import Contact, OracleSystem, StoreyLagrangian

__all__ = ["OracleResult", "OracleSystem", "simulate"]

_REMAINDER = 1e-13  # of an interval: less than this is not integrated any more


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
    max_rotation_at_samples: float
    max_base_shear_at_samples: float
    max_storey_shears_at_samples: Array
    impacts: int
    uplifts: int
    overturned: bool
    energy_lost: float


class _Simulation:
    """The state y = [theta, d, theta', d'] and its contact (None: full contact)."""

    def __init__(
        self,
        system: OracleSystem,
        *,
        recontact: float,
        overturning: float,
        locking: Literal["relative", "limit"],
        rtol: float,
    ) -> None:
        self.lagrangian = StoreyLagrangian(system)
        self.full_contact = FullContact(self.lagrangian)
        self.negligible = recontact * np.arctan(system.tan_alpha)
        self.limit = overturning * self.lagrangian.critical_rotation
        self.locking, self.rtol = locking, rtol
        self.y: Array = np.zeros(2 * self.lagrangian.storeys + 2)
        self.contact: Contact | None = None
        self.step = np.inf  # the last free step of DOP853
        self.max_rotation = self.energy_lost = 0.0
        self.impacts = self.uplifts = 0
        self.overturned = False

    def advance(self, ground: LinearGround, duration: float) -> None:
        """Through one interval of the record, however many events it holds."""
        tau = 0.0
        while duration - tau > _REMAINDER * duration and not self.overturned:
            passed = self.stand if self.contact is None else self.move
            tau += passed(ground.later(tau), duration - tau)

    def stand(self, ground: LinearGround, duration: float) -> float:
        """Full contact until uplift or the end; returns the time that passed."""
        n = self.lagrangian.storeys
        pieces = max(1, int(np.ceil(duration * self.full_contact.fastest)))
        h = duration / pieces
        drifts = np.r_[self.y[1 : n + 1], self.y[n + 2 :]]
        z = np.r_[drifts, ground.horizontal, ground.horizontal_rate]
        for piece in range(pieces):
            lifted = self.full_contact.uplift(z, ground.later(piece * h), h)
            z = self.full_contact.over(z, h if lifted is None else lifted[0])
            self.y[1 : n + 1], self.y[n + 2 :] = z[:n], z[n : 2 * n]
            if lifted is not None:
                self.uplifts += 1
                self.contact = Contact(lifted[1], rolling=self.lagrangian.beta > 0.0)
                return piece * h + lifted[0]
        return duration

    def solver(self, ground: LinearGround, contact: Contact, start: float, end: float) -> DOP853:
        motion, n1 = self.lagrangian, self.lagrangian.storeys + 1
        gravity = motion.system.gravity

        def rates(tau: float, y: Any) -> Any:
            a_g = ground.horizontal + tau * ground.horizontal_rate
            g = gravity + ground.vertical + tau * ground.vertical_rate
            return np.concatenate((y[n1:], motion.acceleration(contact, y, a_g, g)))

        return DOP853(
            rates,
            start,
            self.y,
            end,
            rtol=self.rtol,
            atol=1e-3 * self.rtol,
            first_step=min(self.step, end - start),
        )

    def run(self, solver: DOP853) -> None:
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(f"DOP853: {message}")

    def levels(self, contact: Contact) -> list[tuple[float, int]]:
        """Values of |theta| that end this contact, with the direction of passing."""
        beta = self.lagrangian.beta
        if contact.rolling:
            return [(0.0, -1), (beta, 1), (self.limit, 1)]
        return [(beta, -1), (self.limit, 1)]

    def move(self, ground: LinearGround, duration: float) -> float:
        """Rolling or rocking until an event or the end; returns the time that passed."""
        contact = self.contact
        assert contact is not None
        solver = self.solver(ground, contact, 0.0, duration)
        while solver.status == "running":
            self.run(solver)
            assert solver.t_old is not None
            h = solver.t - solver.t_old
            x_end = contact.side * float(solver.y[0])
            inner = solver.dense_output()(solver.t_old + h * NODES)[0]
            curve = through_nodes(contact.side * float(self.y[0]), contact.side * inner)
            pieces = monotone_pieces(curve)
            end, level = self.first_event(contact, curve, pieces, x_end)
            turns = [z for z in pieces if z < end]
            peaks = np.polynomial.polynomial.polyval(np.array(turns), curve)
            self.max_rotation = max(self.max_rotation, float(np.max(peaks)))
            if level is not None:
                tau = self.meet(ground, contact, solver.t_old, solver.t_old + end * h, level)
                self.max_rotation = max(self.max_rotation, level)
                self.switch(contact, level, ground.later(tau))
                return tau
            self.y = solver.y.copy()
            self.max_rotation = max(self.max_rotation, x_end)
            if x_end < (0.0 if contact.rolling else self.lagrangian.beta):
                raise RuntimeError("an event was passed unseen")
            # the last step of an interval is cut short by its end, not by the error
            cut = solver.t >= duration
            self.step = max(h, min(self.step, 10.0 * h)) if cut else h
        return duration

    def first_event(
        self, contact: Contact, curve: Array, pieces: list[float], x_end: float
    ) -> tuple[float, float | None]:
        """Fraction of the step and level of |theta|; (1, None) if the step runs to its end."""
        noise = 1e-12 * float(np.sum(np.abs(curve[1:])))
        crossings = [
            (root, level)
            for level, direction in self.levels(contact)
            if (root := first_crossing(curve, pieces, level, direction, end=x_end, noise=noise))
            is not None
        ]
        return min(crossings, default=(1.0, None))

    def meet(
        self, ground: LinearGround, contact: Contact, start: float, event: float, level: float
    ) -> float:
        """Integrate to |theta| = level itself: the dense output is less accurate than the step."""
        tau = event
        for _ in range(8):
            arrival = self.solver(ground, contact, start, tau)
            while arrival.status == "running":
                self.run(arrival)
            miss = contact.side * float(arrival.y[0]) - level
            if abs(miss) < 1e-15:
                break
            correction = -miss / (contact.side * float(arrival.y[self.lagrangian.storeys + 1]))
            if abs(correction) < 1e-14:
                break
            tau += correction
        else:
            raise RuntimeError(f"no convergence to |theta| = {level}")
        self.y = arrival.y.copy()
        self.y[0] = contact.side * level
        return tau

    def switch(self, contact: Contact, level: float, ground: LinearGround) -> None:
        """What an event does to the contact and to the velocities."""
        if level == self.limit:
            self.overturned = True
        elif level > 0.0:
            self.contact = Contact(contact.side, not contact.rolling)
        else:
            self.impact(contact, ground)

    def impact(self, contact: Contact, ground: LinearGround) -> None:
        motion, n1 = self.lagrangian, self.lagrangian.storeys + 1
        before = sum(motion.energies(contact, self.y))
        self.impacts += 1
        self.y = motion.after_impact(self.y)
        beyond = Contact(-contact.side, contact.rolling)
        gravity = motion.system.gravity + ground.vertical
        back = -beyond.side * float(
            motion.acceleration(beyond, self.y, ground.horizontal, gravity)[0]
        )
        if back > 0.0 and self.y[n1] ** 2 / (2.0 * back) < self.negligible:
            self.lock()
        else:
            self.contact = beyond
        self.energy_lost += before - sum(motion.energies(beyond, self.y))

    def lock(self) -> None:
        """Full contact instead of the endless rest of shrinking excursions.

        "relative" keeps the drift rates. "limit" adds what the excursions left out would have done
        to them: between impacts absolute floor velocities stay, so each excursion of speed w turns
        u_b' = c w into -c w and the first drift rate gains 2 c w; over the alternating series with
        ratio -e that is 2 c w/(1 + e) if impacts keep the drift rates, and c w if they do not.
        """
        motion, n1 = self.lagrangian, self.lagrangian.storeys + 1
        if self.locking == "limit" and motion.storeys > 0:
            rigid = motion.system.law == "rigid"
            share = 2.0 / (1.0 + motion.restitution) if rigid else 1.0
            self.y[n1 + 1] += share * 2.0 * motion.half_height * self.y[n1]
        self.y[n1] = 0.0
        self.contact, self.step = None, np.inf


def simulate(
    system: OracleSystem,
    ag: Array,
    dt: float,
    *,
    av: Array | None = None,
    free_vibration: float = 10.0,
    recontact_tolerance: float = 1e-6,
    overturning_limit: float = 2.0,
    rtol: float = 1e-10,
    initial_rotation: float = 0.0,
    locking: Literal["relative", "limit"] = "relative",
) -> OracleResult:
    """Response to ground acceleration samples [m/s2], then to none for `free_vibration` seconds.

    The acceleration is linear between samples and drops to zero at the last one. It starts from
    rest: in full contact, or tilted by `initial_rotation` [rad] with the springs at ease.
    `recontact_tolerance` is the least excursion after an impact that is still followed, over alpha;
    `locking` says what becomes of the drift rates then (`_Simulation.lock`).
    """
    run = _Simulation(
        system,
        recontact=recontact_tolerance,
        overturning=overturning_limit,
        locking=locking,
        rtol=rtol,
    )
    if initial_rotation:
        run.y[0] = initial_rotation
        tilt = abs(initial_rotation)
        run.max_rotation = tilt
        run.contact = Contact(1 if initial_rotation > 0.0 else -1, tilt < run.lagrangian.beta)
    vertical = np.zeros_like(ag) if av is None else av
    states = [run.y.copy()]
    for j in range(len(ag) - 1 + round(free_vibration / dt)):
        ground = LinearGround(0.0, 0.0, 0.0, 0.0)
        if j < len(ag) - 1:
            rates = [float(a[j + 1] - a[j]) / dt for a in (ag, vertical)]
            ground = LinearGround(float(ag[j]), rates[0], float(vertical[j]), rates[1])
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
        max_rotation_at_samples=float(np.max(np.abs(history[:, 0]))),
        max_base_shear_at_samples=float(shears[0]) if n else 0.0,
        max_storey_shears_at_samples=shears,
        impacts=run.impacts,
        uplifts=run.uplifts,
        overturned=run.overturned,
        energy_lost=run.energy_lost,
    )
