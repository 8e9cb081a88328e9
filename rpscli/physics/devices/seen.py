"""Results kept of devices: largest forces and rates, and samples."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.table import device_at, stored_in
from rpscli.physics.devices.worked import Worked
from rpscli.physics.lane import sign_of, stands
from rpscli.physics.peaks import peak
from rpscli.physics.state import (
    FRICTION,
    FULL_CONTACT,
    ROLLING_RESISTANCE,
    TENDON,
    Floats,
    Record,
)


@compiled
def raise_devices(s: Record, l: int, start: Worked, middle: Worked, end: Worked) -> None:
    """Raise the largest forces and rates of devices by those of
    three instants, and between.
    """
    for i in range(s.devices[l]):
        one = device_at(s, l, i, start)
        two = device_at(s, l, i, middle)
        three = device_at(s, l, i, end)
        force = peak(one[0], two[0], three[0])
        s.device_force[i, l] = max(s.device_force[i, l], force)
        s.device_velocity[i, l] = max(
            s.device_velocity[i, l], peak(one[1], two[1], three[1])
        )


@compiled
def store_devices(s: Record, l: int, at: Worked, share: float, sample: Floats) -> None:
    """Keep force, displacement, dissipated and stored energy of each device of a lane.

    Horizontal forces are those on the cap beam, positive to the right, and go with u_b;
    of a tendon the tension of one goes with its elongation. Friction at rest is what
    equilibrium asks for while the storey is stuck, and in full contact the least that it
    can be: `share` of what it can.
    """
    side = sign_of(s, l)
    for i in range(s.devices[l]):
        kind = s.device_kind[i, l]
        force, _, displacement = device_at(s, l, i, at)
        if kind != TENDON:
            if stands(s, l) and kind in (FRICTION, ROLLING_RESISTANCE):
                force *= share * s.direction[l]
                if s.phase[l] == FULL_CONTACT and kind == ROLLING_RESISTANCE:
                    force = 0.0
            force = -side * force
            displacement = side * displacement
        sample[0, i] = force + 0.0
        sample[1, i] = displacement + 0.0
        sample[2, i] = s.device_energy[i, l]
        sample[3, i] = stored_in(s, l, i, at)
