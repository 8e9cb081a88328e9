"""A structure in one lane of the kernels, put where a test wants it."""

from __future__ import annotations

from paper_structures import Array, stillness

from rpscli.analyses.history import empty_results, shape_of_one
from rpscli.analyses.kernel_input import podium_parameters
from rpscli.analyses.kernel_tables import joined, point, points, stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics import layout, switch
from rpscli.physics.driver import refresh
from rpscli.physics.energy import uplifted_energy
from rpscli.physics.lane import lane_of
from rpscli.physics.loading import begin
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

    def block(self, number: int) -> Array:
        """A view of one of the blocks of n + 1 rows."""
        block: Array = self.lane.blocks[number]
        return block

    @property
    def side(self) -> float:
        """Sign of theta."""
        return float(self.buffer[layout.SIDE])

    @property
    def position(self) -> Array:
        """The tilt and the floors' displacements; may be written to."""
        return self.block(layout.POSITION)

    @property
    def velocity(self) -> Array:
        """Their rates; may be written to."""
        return self.block(layout.VELOCITY)

    def accelerations(self, horizontal: float = 0.0, vertical: float = 0.0) -> Array:
        """x'' and u'' at the present state while the ground moves with these accelerations."""
        self.buffer[layout.ACROSS] = horizontal
        self.buffer[layout.UPWARDS] = self.podium.gravity + vertical
        refresh(self.lanes, self.shape, 0)
        return self.block(layout.ACCELERATION).copy()

    def energy(self) -> float:
        """Kinetic, strain and potential energy [J]."""
        return float(uplifted_energy(self.lane))

    def go_over(self) -> None:
        """Let the storey go over to its other edge."""
        switch.go_over(self.lane)

    def lock(self) -> None:
        """Let the storey come to rest."""
        switch.lock(self.lane)
