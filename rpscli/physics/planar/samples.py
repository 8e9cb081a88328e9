"""From one sample of the record to the next: store, and see whether the history is over."""

from __future__ import annotations

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import sine_cosine
from rpscli.physics.planar.devices.flows import store_devices
from rpscli.physics.planar.equation_of_motion import (
    cap_beam_displacement,
    contact_height,
    phase_constants,
)
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.state import FULL_CONTACT


@compiled
def store_sample(s: Record, l: int, system: Record, output: Output) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    at = s.interval[l]
    if at >= output.samples.shape[0]:
        return
    sample, side = output.samples[at], s.side[l]
    stands = s.phase[l] == FULL_CONTACT
    sample.theta, sample.theta_dot = side * s.theta[l], side * s.theta_dot[l]
    sample.theta_ddot = 0.0 if stands else side * s.theta_ddot[l]
    sample.phase = s.phase[l]
    sample.energy_input, sample.energy_damped = s.energy_input[l], s.energy_damped[l]
    sample.energy_lost = s.energy_lost[l]
    u_b, du_b = 0.0, 0.0
    if not stands:
        phase, (sine, cosine) = phase_constants(s, l), sine_cosine(s.theta[l])
        u_b = side * s.diameter[l] * cap_beam_displacement(phase, s.theta[l], cosine, sine)
        du_b = side * s.diameter[l] * contact_height(phase, cosine, sine) * s.theta_dot[l]
    for i in range(s.n):
        u, du = u_b, du_b
        for r in range(s.n):
            u += system.phi[r, i] * s.q[r, l]
            du += system.phi[r, i] * s.dq[0, r, l]
        output.floors[at, 0, i], output.floors[at, 1, i] = u, du
    if s.devices[l] > 0:
        store_devices(s, l, output.devices[at])
