"""What devices do at a sample of the record, and leave behind at the end."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.elongation import opening
from rpscli.physics.devices.flows import device_at, stored_in
from rpscli.physics.devices.forces import cap_beam_path
from rpscli.physics.devices.rest import held
from rpscli.physics.state import (
    FRICTION,
    FULL_CONTACT,
    ROLLING_RESISTANCE,
    STUCK,
    TENDON,
    Floats,
    Record,
)


@compiled
def store_devices(s: Record, l: int, sample: Floats) -> None:
    """Keep force, displacement, dissipated and stored energy of each device of a lane.

    Horizontal forces are those on the cap beam, positive to the right, and go with u_b; of a tendon
    the tension of one goes with its elongation. Friction at rest is what equilibrium asks for while
    the storey is stuck, and counted as zero in full contact, where it cannot be told from that of
    the columns' flat ends.

    Parameters
    ----------
    sample
        (4, devices): written.
    """
    stuck, stands = s.phase[l] == STUCK, s.phase[l] == FULL_CONTACT
    path, rate, C = cap_beam_path(s, l, s.theta[l], s.theta_dot[l])
    e, lever, _, _ = opening(s, l, s.theta[l])
    share = held(s, l) if stuck else 0.0
    for i in range(s.devices[l]):
        kind, e_rate = s.device_kind[i, l], lever * s.theta_dot[l]
        force, _, displacement = device_at(s, l, i, path, rate, C, e, e_rate)
        if kind != TENDON:
            if (stuck or stands) and kind in (FRICTION, ROLLING_RESISTANCE):
                force *= share * s.direction[l]
            force, displacement = -s.side[l] * force, s.side[l] * displacement
        sample[0, i], sample[1, i] = force + 0.0, displacement + 0.0
        sample[2, i] = s.device_energy[i, l]
        sample[3, i] = stored_in(s, l, i, path, e)


@compiled
def leave_devices(s: Record, l: int, result: Record) -> None:
    """Write what the devices of a lane leave behind at the end of its history.

    Parameters
    ----------
    result
        A `state.RESULT`: written.
    """
    path, _, _ = cap_beam_path(s, l, s.theta[l], 0.0)
    e, _, _, _ = opening(s, l, s.theta[l])
    for i in range(s.devices[l]):
        result.device_force[i] = s.device_force[i, l]
        result.device_velocity[i] = s.device_velocity[i, l]
        result.device_energy[i] = s.device_energy[i, l]
        result.device_stored[i] = stored_in(s, l, i, path, e)
        result.permanent[i] = s.permanent[i, l]
