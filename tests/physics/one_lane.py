"""A structure in one lane of the kernels, put where a test wants it."""

from __future__ import annotations

import numpy as np
from paper_structures import Array, stillness

from rpscli.analyses.kernels.history import Request, run_of
from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics.core.compile import kernel
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import integral, slope, value
from rpscli.physics.planar.demands import observe_ends
from rpscli.physics.planar.driver import begin_history
from rpscli.physics.planar.energy import powers_within, uplifted_energy
from rpscli.physics.planar.equation_of_motion import (
    cap_beam_acceleration,
    cap_beam_displacement,
    contact_height,
    modal_terms,
    phase_constants,
    renew_accelerations,
    rotation_terms,
)
from rpscli.physics.planar.run import empty_state, variant_of
from rpscli.physics.planar.steps import take_steps
from rpscli.physics.planar.transitions import change_edge, enter_phase, recontact
from rpscli.records.ground_motion import MotionComponents

LEAST_DT = 0.01


@kernel
def renew_first(state: Record) -> None:
    """Compute the accelerations of the first lane anew."""
    renew_accelerations(state[0], 0)


@kernel
def step_first(state: Record) -> None:
    """Take a step in the first lane."""
    take_steps(state[0])


@kernel
def observe_first(state: Record) -> None:
    """Observe the end of a step in the first lane."""
    observe_ends(state[0])


class OneLane:
    """The state of a single lane after `begin_history`, in a phase of motion at theta = 0.

    `s` is the record, whose lane 0 is meant. Positions are [x, u_1 ... u_n]: the tilt x = |theta|
    first, then the floors.
    """

    def __init__(
        self,
        structure: PodiumStructure,
        phase: int,
        side: float = 1.0,
        settings: TimeHistorySettings | None = None,
    ) -> None:
        self.storeys = structure.storeys
        self.structure = structure
        systems = stacked_systems([(structure, settings or TimeHistorySettings())])
        self.run = run_of(systems, [MotionComponents(stillness(LEAST_DT))], [Request(0, 0)])
        self.system = systems[0]
        self.state = empty_state(self.storeys, lanes=1, variant=variant_of(self.run))
        self.s = self.state[0]
        begin_history(self.s, 0, self.run, 0)
        self.s.side[0] = side
        enter_phase(self.s, 0, self.system, phase)

    def modes(self, name: str) -> Array:
        """A field of the modes in this lane, (n,): a view."""
        rows: Array = self.s[name][: self.storeys, 0]
        return rows

    @property
    def q(self) -> Array:
        """Modal displacements."""
        return self.modes("q")

    @property
    def dq(self) -> Array:
        """Modal velocities."""
        rates: Array = self.s.dq[0, : self.storeys, 0]
        return rates

    @property
    def shapes(self) -> Array:
        """Mode shapes (n, n), a column each."""
        above = self.structure.superstructure
        return np.zeros((0, 0)) if above is None else above.shapes

    @property
    def side(self) -> float:
        """Sign of theta."""
        return float(self.s.side[0])

    @property
    def base(self) -> float:
        """u_b [m]."""
        s, x = self.s, self.s.theta[0]
        way = cap_beam_displacement(phase_constants(s, 0), x, np.cos(x), np.sin(x))
        return float(s.side[0] * s.diameter[0] * way)

    @property
    def base_velocity(self) -> float:
        """u_b' [m/s]."""
        s, x = self.s, self.s.theta[0]
        C = contact_height(phase_constants(s, 0), np.cos(x), np.sin(x))
        return float(s.side[0] * s.diameter[0] * C * s.theta_dot[0])

    @property
    def position(self) -> Array:
        """The tilt and the floors' displacements."""
        return np.array([self.s.theta[0], *(self.base + self.shapes @ self.q)])

    @property
    def velocity(self) -> Array:
        """Their rates."""
        return np.array([self.s.theta_dot[0], *(self.base_velocity + self.shapes @ self.dq)])

    def place(self, position: Array, velocity: Array) -> None:
        """Put it somewhere."""
        self.s.theta[0], self.s.theta_dot[0] = position[0], velocity[0]
        if (above := self.structure.superstructure) is not None:
            weights = self.shapes.T * above.masses
            self.q[:] = weights @ (position[1:] - self.base)
            self.dq[:] = weights @ (velocity[1:] - self.base_velocity)

    def accelerations(self, horizontal: float = 0.0, vertical: float = 0.0) -> Array:
        """x'' and u'' at the present state while the ground moves with these accelerations."""
        s = self.s
        s.a_g[0], s.g_up[0] = horizontal, s.gravity[0] + vertical
        renew_first(self.state)
        across, _ = self.cap_beam_acceleration()
        modes = -self.modes("Gamma") * (across + horizontal) - self.modes("modal_force")
        return np.array([s.theta_ddot[0], *(across + self.shapes @ modes)])

    def cap_beam_acceleration(self) -> tuple[float, float]:
        """u_b'' and v_b'' [m/s2]; the accelerations must be known."""
        s = self.s
        found: tuple[float, float] = cap_beam_acceleration(
            s.side[0],
            s.diameter[0],
            s.phase_c[0],
            s.B[0],
            s.C[0],
            s.theta_dot[0],
            s.theta_ddot[0],
        )
        return found

    def step(self, h: float) -> None:
        """Take a step of length h [s]; the accelerations must be known."""
        self.s.step[0] = h
        step_first(self.state)

    def observe(self) -> None:
        """Observe the end of the step that was taken."""
        observe_first(self.state)

    def go_along(self, t: float) -> tuple[float, Array]:
        """Put it where it is a fraction t into the step that was taken; x'' and q'' there."""
        s, h = self.s, self.s.step[0]
        tilt = rotation_terms(s, 0)
        modes = [modal_terms(s, r, 0) for r in range(self.storeys)]
        s.theta[0] += h * integral(tilt, t)
        s.theta_dot[0] = value(tilt, t)
        for r, terms in enumerate(modes):
            self.q[r] += h * integral(terms, t)
            self.dq[r] = value(terms, t)
        s.time[0] += t * h
        return slope(tilt, t) / h, np.array([slope(terms, t) / h for terms in modes])

    def powers(self) -> tuple[float, float]:
        """Power of the ground and of the dampers at the present state [W]."""
        self.s.dtheta_terms[0, 0] = self.s.theta_dot[0]
        return powers_within(self.s, 0, 0.0)

    def energy(self) -> float:
        """Kinetic, strain and potential energy [J]."""
        return float(uplifted_energy(self.s, 0, self.system))

    def change_edge(self) -> float:
        """Let the storey go over to its other edge; returns the energy lost [J]."""
        return float(change_edge(self.s, 0, self.system))

    def recontact(self) -> float:
        """Let the storey come to rest; returns the energy lost [J]."""
        return float(recontact(self.s, 0, self.system))
