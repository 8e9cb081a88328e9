"""What follows from the devices of a case as tables for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rpscli.report.numbers import large, shown
from rpscli.report.table import Part, Table

if TYPE_CHECKING:
    from rpscli.model.podium import PodiumStructure


def device_tables(structure: PodiumStructure) -> Iterator[Part]:
    """Each device's numbers, uplift with all of them, and from where the storey re-centres."""
    if not structure.devices:
        return
    from rpscli.model.statics import returns, uplift_acceleration, uplift_force

    found = [
        (f"{index} {device.kind}", item.label, item.value, item.unit)
        for index, device in enumerate(structure.devices)
        for item in device.consequences(structure)
    ]
    found.append(("all", "uplift force at the cap beam", uplift_force(structure), "N"))
    found.append(
        ("all", "uplift acceleration, quasi-static", uplift_acceleration(structure), "m/s2")
    )
    rows = []
    for device, label, value, unit in found:
        number, name = large(value, unit)
        rows.append((device, label, "never" if number is None else shown(number), name))
    yield Table.of_texts(("device", "", "value", "unit"), rows, words=2)
    if back := returns(structure):
        yield Table.of_texts(
            ("from rest at rad", "of theta_cr", "u_b m", "friction kN", "largest kN", "comes back"),
            [
                (
                    shown(row.rotation),
                    shown(row.rotation / structure.critical_rotation, 2),
                    shown(row.displacement),
                    shown(1e-3 * row.friction),
                    shown(1e-3 * row.largest_friction),
                    "yes" if row.recentres else "no",
                )
                for row in back
            ],
        )
