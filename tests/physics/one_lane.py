"""A structure in one lane of the kernels, put where a test wants it."""

from __future__ import annotations

import numpy as np
from paper_structures import Array, stillness

from rpscli.analyses.history import empty_results, shape_of_one
from rpscli.analyses.kernel_input import podium_parameters
from rpscli.analyses.kernel_tables import joined, point, points, stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics import layout, switch
from rpscli.physics.driver import refresh
from rpscli.physics.energy import phase_of, powers_after, uplifted_energy
from rpscli.physics.geometry import cap_beam_displacement
from rpscli.physics.lane import lane_of
from rpscli.physics.loading import begin
from rpscli.physics.series import step
from rpscli.physics.terms import integral, modal_terms, slope, tilt_terms, value
from rpscli.physics.workspace import empty_lanes

LEAST_DT = 0.01


class OneLane:
    """The buffer of a single lane after `begin`, in a phase of motion at theta = 0.

    States are [x, u_1 ... u_n] and their rates: the tilt x = |theta| first, then the floors.
    """

    def __init__(
        self,
        structure: PodiumStructure,
        motion: int,
        side: float = 1.0,
        settings: TimeHistorySettings | None = None,
    ) -> None:
        n = self.storeys = structure.storeys
        self.structure = structure
        self.shape = shape_of_one(structure)
        systems = stacked_systems([(structure, settings or TimeHistorySettings())])
        still = stillness(LEAST_DT)
        given = points([point(0, still, 0, None, 1.0)])
        self.lanes = empty_lanes(joined([still])[0], self.shape, empty_results(1, n))
        self.buffer = self.lanes.buffer
        begin(self.lanes, 1, 0, 0, systems, given)
        self.lane = lane_of(self.lanes, 0)
        self.podium = podium_parameters(structure, settings or TimeHistorySettings())
        self.buffer[layout.SIDE] = side
        switch.enter_phase(self.lane, motion)

    @property
    def shapes(self) -> Array:
        """Mode shapes (n, n), a column each."""
        above = self.structure.superstructure
        return np.zeros((0, 0)) if above is None else above.shapes

    @property
    def side(self) -> float:
        """Sign of theta."""
        return float(self.buffer[layout.SIDE])

    @property
    def base(self) -> float:
        """u_b [m]."""
        s, x = self.buffer, self.buffer[layout.TILT]
        way = cap_beam_displacement(phase_of(s), x, np.cos(x), np.sin(x))
        return float(s[layout.SIDE] * s[layout.DIAMETER] * way)

    @property
    def base_rate(self) -> float:
        """u_b' [m/s]."""
        s, x = self.buffer, self.buffer[layout.TILT]
        phase = phase_of(s)
        C = phase.c + phase.p * np.sin(x) - phase.q * np.cos(x)
        return float(s[layout.SIDE] * s[layout.DIAMETER] * C * s[layout.RATE])

    @property
    def position(self) -> Array:
        """The tilt and the floors' displacements."""
        floors = self.base + self.shapes @ self.lane.blocks[layout.Q]
        return np.array([self.buffer[layout.TILT], *floors])

    @property
    def velocity(self) -> Array:
        """Their rates."""
        floors = self.base_rate + self.shapes @ self.lane.blocks[layout.DQ]
        return np.array([self.buffer[layout.RATE], *floors])

    def place(self, position: Array, velocity: Array) -> None:
        """Put it somewhere."""
        self.buffer[layout.TILT], self.buffer[layout.RATE] = position[0], velocity[0]
        if (above := self.structure.superstructure) is not None:
            weights = self.shapes.T * above.masses
            self.lane.blocks[layout.Q] = weights @ (position[1:] - self.base)
            self.lane.blocks[layout.DQ] = weights @ (velocity[1:] - self.base_rate)

    def accelerations(self, horizontal: float = 0.0, vertical: float = 0.0) -> Array:
        """x'' and u'' at the present state while the ground moves with these accelerations."""
        s = self.buffer
        s[layout.ACROSS] = horizontal
        s[layout.UPWARDS] = self.podium.gravity + vertical
        refresh(self.lanes, self.shape, 0)
        B, C, turn = s[layout.LEVER], s[layout.HEIGHT], s[layout.TURN]
        across = s[layout.SIDE] * s[layout.DIAMETER] * (C * turn + B * s[layout.RATE] ** 2)
        blocks = self.lane.blocks
        modes = -blocks[layout.PARTICIPATION] * (across + horizontal) - blocks[layout.PULL]
        return np.array([turn, *(across + self.shapes @ modes)])

    def step(self, h: float) -> None:
        """Take a step of length h [s]; the accelerations must be known."""
        self.buffer[layout.STEP] = h
        step(self.buffer, self.shape)

    def go_along(self, t: float) -> tuple[float, Array]:
        """Put it where it is a fraction t into the step that was taken; x'' and q'' there."""
        s, x, h = self.buffer, self.lane.blocks, self.buffer[layout.STEP]
        rates = tilt_terms(s)
        modes = [modal_terms(x, r) for r in range(self.storeys)]
        s[layout.TILT] += h * integral(rates, t)
        s[layout.RATE] = value(rates, t)
        for r, terms in enumerate(modes):
            x[layout.Q, r] += h * integral(terms, t)
            x[layout.DQ, r] = value(terms, t)
        s[layout.TIME] += t * h
        return slope(rates, t) / h, np.array([slope(terms, t) / h for terms in modes])

    def powers(self) -> tuple[float, float]:
        """Power of the ground and of the dampers at the present state [W]."""
        self.buffer[layout.RATES] = self.buffer[layout.RATE]
        return powers_after(self.lane, 0.0)

    def energy(self) -> float:
        """Kinetic, strain and potential energy [J]."""
        return float(uplifted_energy(self.lane))

    def go_over(self) -> float:
        """Let the storey go over to its other edge; returns the energy lost [J]."""
        return float(switch.go_over(self.lane))

    def lock(self) -> float:
        """Let the storey come to rest; returns the energy lost [J]."""
        return float(switch.lock(self.lane))
