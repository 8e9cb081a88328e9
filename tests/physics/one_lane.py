"""A structure in one lane of the kernel, put where a test wants it; nothing is compiled."""

from __future__ import annotations

import numpy as np
from paper_structures import Array

from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics.bed import load_bed
from rpscli.physics.devices import load_devices
from rpscli.physics.follow import clear_results, load_modes, load_system
from rpscli.physics.laws import RATES, Place, beam_now, place_of, total_energy
from rpscli.physics.state import EVENT, STATE, records
from rpscli.physics.step import book_power, renew
from rpscli.physics.upright import come_to_rest, enter_phase, impact, set_polar


class OneLane:
    """The state of a single lane in a phase of motion at theta = 0.

    `s` is the record, whose lane 0 is meant. Positions are [x, u_1 ... u_n]: the tilt x = |theta|
    first, then the floors.
    """

    def __init__(self, structure: PodiumStructure, phase: int, side: float = 1.0) -> None:
        self.storeys, self.structure = structure.storeys, structure
        self.system = stacked_systems([(structure, TimeHistorySettings())])[0]
        self.state, self.log = records(STATE), records(EVENT, 0)
        s = self.s = self.state[0]
        s.n, s.axes, s.side[0], s.dt[0] = structure.storeys, 1, side, 0.01
        load_system(s, 0, self.system)
        load_modes(s, 0, self.system, 0)
        load_devices(s, 0, self.system)
        load_bed(s, 0, self.system)
        clear_results(s, 0)
        s.g_up[0] = s.gravity[0]
        enter_phase(s, 0, self.system, phase)

    def modes(self, name: str) -> Array:
        """A field of the modes in this lane, (n,): a view."""
        rows: Array = self.s[name][: self.storeys, 0]
        return rows

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
        return float(beam_now(self.s, 0)[0])

    @property
    def base_velocity(self) -> float:
        """u_b' [m/s]."""
        return float(beam_now(self.s, 0)[RATES])

    @property
    def position(self) -> Array:
        """The tilt and the floors' displacements."""
        return np.array([self.s.x[0], *(self.base + self.shapes @ self.modes("q"))])

    @property
    def velocity(self) -> Array:
        """Their rates."""
        return np.array([self.s.v[0], *(self.base_velocity + self.shapes @ self.modes("dq"))])

    def place(self, position: Array, velocity: Array) -> None:
        """Put it somewhere."""
        set_polar(self.s, 0, position[0], self.side, 0.0, velocity[0], 0.0)
        if (above := self.structure.superstructure) is not None:
            weights = self.shapes.T * above.masses
            self.modes("q")[:] = weights @ (position[1:] - self.base)
            self.modes("dq")[:] = weights @ (velocity[1:] - self.base_velocity)

    def at(self, x: float) -> Place:
        """Geometry and inertia at a tilt."""
        return place_of(self.s, 0, x)

    def accelerations(self, horizontal: float = 0.0, vertical: float = 0.0) -> Array:
        """x'' and u'' at the present state while the ground moves with these accelerations."""
        s = self.s
        s.a_g[0, 0], s.g_up[0] = horizontal, s.gravity[0] + vertical
        renew(s, 0)
        forces = self.modes("omega2") * self.modes("q") + self.modes("two_xi_omega") * self.modes(
            "dq"
        )
        modes = -self.modes("Gamma") * s.shaking[0, 0] - forces
        return np.array([s.a[0], *(s.shaking[0, 0] - horizontal + self.shapes @ modes)])

    def powers(self) -> tuple[float, float]:
        """Power of the ground and of the dampers at the present state [W]."""
        s = self.s
        self.modes("new_dq")[:] = self.modes("dq")
        s.power_input[0], s.power_damped[0], s.power_bed[0] = 0.0, 0.0, 0.0
        tilt, rate = (s.tilt[0, 0], 0.0), (s.tilt_rate[0, 0], 0.0)
        book_power(s, 0.0, 1.0, tilt, rate)
        return float(s.power_input[0]), float(s.power_damped[0])

    def energy(self) -> float:
        """Kinetic, strain and potential energy [J]."""
        return float(total_energy(self.s, 0, self.system))

    def change_edge(self) -> float:
        """Let the storey go over to its other edge; returns the energy lost [J]."""
        before = self.s.energy_lost[0]
        impact(self.s, 0, self.system, self.log)
        return float(self.s.energy_lost[0] - before)

    def recontact(self) -> float:
        """Let the storey come to rest; returns the energy lost [J]."""
        before = self.s.energy_lost[0]
        come_to_rest(self.s, 0, self.system, self.log)
        return float(self.s.energy_lost[0] - before)
