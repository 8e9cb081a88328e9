"""A Taylor step of all lanes: no term is computed twice, an event is a root of a polynomial."""

from __future__ import annotations

from rpscli.physics.compile import compiled, specialised
from rpscli.physics.devices.forces import set_devices_at_ends
from rpscli.physics.devices.series import begin_devices, extend_devices
from rpscli.physics.equation_of_motion import (
    accelerate,
    begin_terms,
    extend_modes,
    extend_rotation,
)
from rpscli.physics.state import LANES, ORDER, Record


@compiled
def take_steps(s: Record) -> None:
    """Advance the lanes, each by its own step.

    Reads the motion at the start of the step, and leaves it; writes the Taylor terms and the end.
    """
    begin_terms(s)
    if s.equipped > 0:
        begin_devices(s)
    if s.lanes == 1:
        extend_all(s, 1)
    else:
        extend_all(s, LANES)
    add_terms(s)
    if s.equipped > 0:
        set_devices_at_ends(s)
    accelerate(s)


assert ORDER == 7, "orders are written out below"


@specialised
def extend_all(s: Record, lanes: int) -> None:
    """Terms of all orders, in all lanes.

    Written out: the compiler is to know lanes and orders, or it fears that terms overlap.
    """
    extend_rotation(s, lanes, 1)
    extend_modes(s, lanes, 1)
    extend_equipped(s, 1)
    extend_rotation(s, lanes, 2)
    extend_modes(s, lanes, 2)
    extend_equipped(s, 2)
    extend_rotation(s, lanes, 3)
    extend_modes(s, lanes, 3)
    extend_equipped(s, 3)
    extend_rotation(s, lanes, 4)
    extend_modes(s, lanes, 4)
    extend_equipped(s, 4)
    extend_rotation(s, lanes, 5)
    extend_modes(s, lanes, 5)
    extend_equipped(s, 5)
    extend_rotation(s, lanes, 6)
    extend_modes(s, lanes, 6)
    extend_equipped(s, 6)
    extend_rotation(s, lanes, 7)
    extend_modes(s, lanes, 7)
    extend_equipped(s, 7)


@compiled
def extend_equipped(s: Record, m: int) -> None:
    """Terms of order m of devices, where there are any."""
    if s.equipped > 0:
        extend_devices(s, m)


@compiled
def add_terms(s: Record) -> None:
    """The end of the step: the sum of all terms."""
    lanes, d, dq = s.lanes, s.dtheta_terms, s.dq
    for l in range(lanes):
        change, s.next_theta_dot[l] = sums(
            d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]
        )
        s.next_theta[l] = s.theta[l] + s.step[l] * change
    for r in range(s.n):
        for l in range(lanes):
            change, s.next_dq[r, l] = sums(
                dq[0, r, l],
                dq[1, r, l],
                dq[2, r, l],
                dq[3, r, l],
                dq[4, r, l],
                dq[5, r, l],
                dq[6, r, l],
                dq[7, r, l],
            )
            s.next_q[r, l] = s.q[r, l] + s.step[l] * change


@compiled
def sums(
    t0: float, t1: float, t2: float, t3: float, t4: float, t5: float, t6: float, t7: float
) -> tuple[float, float]:
    """Integral over t/h from 0 to 1, and value at 1, of a series.

    Parameters
    ----------
    t0, t1, t2, t3, t4, t5, t6, t7
        Coefficients of powers of t/h.
    """
    late = t7 * 0.125 + t6 * (1.0 / 7.0) + t5 * (1.0 / 6.0) + t4 * 0.2
    change = late + t3 * 0.25 + t2 * (1.0 / 3.0) + t1 * 0.5 + t0
    return change, t7 + t6 + t5 + t4 + t3 + t2 + t1 + t0
