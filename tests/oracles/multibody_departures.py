"""What bodies in contact do otherwise than the model assumes, as changes of the compiled text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rpscli.report.export.multibody import SPACING, THICKNESS

LOWER, UPPER = 1, 2
"""Bits of the spheres at both ends of a column in the description."""

BOX = 6
"""`mjGEOM_BOX` of the engine."""

FOOTING = 2.0
"""Half size of the block under a column [m], more than any column travels."""


@dataclass(frozen=True)
class Departures:
    """Lengths in metres; without any, the description stays as it is.

    Contacts slide by Coulomb's law with `friction` in place of 3. A beam that is free to tilt takes
    floors with it that stand `storey_height` above each other. Columns stand `spacing` apart, and
    each is so much `longer` than said, with the same ends and mass, on a footing as much lower.
    """

    friction: float | None = None
    storey_height: float = 0.0
    spacing: float = SPACING
    longer: tuple[float, ...] = ()

    def apply(self, specification: Any, columns: int, storeys: int) -> None:
        """Change the engine's specification."""
        for geom in specification.geoms if self.friction else ():
            geom.friction = self.friction, 0.0, 0.0
        for i in range(storeys):
            height = 0.5 * THICKNESS + (i + 1) * self.storey_height
            floor = specification.joint(f"floor {i}").parent
            floor.pos = 0.0, 0.0, height if self.storey_height else 0.0
        if self.spacing != SPACING:
            self._space(specification, columns)
        if any(self.longer):
            self._lengthen(specification)

    def _space(self, specification: Any, columns: int) -> None:
        """The beam grows with the distance of the columns, and keeps its mass."""
        for c in range(columns):
            specification.joint(f"tilt {c}").parent.pos[0] *= self.spacing / SPACING
        beam = specification.joint("beam across").parent
        box = beam.geoms[0]
        box.size[0] *= self.spacing / SPACING
        beam.inertia = [beam.mass * (box.size[0] ** 2 + box.size[2] ** 2) / 3.0] * 3

    def _lengthen(self, specification: Any) -> None:
        """All tops stay level; nothing stands on the ground itself any more."""
        world = specification.worldbody
        world.geoms[0].pos = 0.0, 0.0, -FOOTING
        for c, more in enumerate(self.longer):
            column = specification.joint(f"tilt {c}").parent
            column.pos[2] -= 0.5 * more
            for geom in column.geoms:
                geom.pos[2] += 0.5 * more * (1.0 if geom.contype == UPPER else -1.0)
            place = column.pos[0], 0.0, -more - FOOTING
            world.add_geom(type=BOX, pos=place, size=[FOOTING] * 3, contype=0, conaffinity=LOWER)


NO_DEPARTURES = Departures()
