"""The phases of uplifted motion, and where the tilt leaves them."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.state import (
    AFTER_UPLIFT,
    IMPACT,
    OVERTURNING,
    ROCKING,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_TO_ROCKING,
    UPLIFT,
    Record,
)
from rpscli.physics.transitions.log_event import log_event, time_of


@compiled
def enter_phase(s: Record, l: int, system: Record, phase: int) -> None:
    """Set the constants of a phase of motion and the range that the tilt has in it.

    Parameters
    ----------
    phase
        ROLLING or ROCKING.
    """
    s.phase[l] = phase
    constants = system.rolling if phase == ROLLING else system.rocking
    s.phase_p[l], s.phase_q[l], s.phase_c[l] = constants[0], constants[1], constants[2]
    s.phase_u0[l], s.phase_v0[l] = constants[3], constants[4]
    s.theta_low[l], s.theta_high[l] = system.beta, system.theta_limit
    if phase == ROLLING:
        s.theta_low[l], s.theta_high[l] = 0.0, min(system.beta, system.theta_limit)


@compiled
def enter_first_phase(s: Record, l: int, system: Record) -> None:
    """Enter the phase in which a tilt grows from zero: rolling, unless the edges are sharp."""
    phase = ROLLING if system.beta > 0.0 else ROCKING
    if s.phase[l] != phase:
        enter_phase(s, l, system, phase)


@compiled
def event_below(s: Record, l: int, system: Record) -> int:
    """What happens where the tilt falls below the range of its phase."""
    return ROCKING_TO_ROLLING if s.phase[l] == ROCKING and system.beta > 0.0 else IMPACT


@compiled
def event_above(s: Record, l: int, system: Record) -> int:
    """What happens where the tilt rises above the range of its phase."""
    goes_on = s.phase[l] == ROLLING and system.beta < system.theta_limit
    return ROLLING_TO_ROCKING if goes_on else OVERTURNING


@compiled
def uplift(s: Record, l: int, system: Record, log: Record, side: float) -> None:
    """Leave full contact towards a side; the modes' state is set already.

    Parameters
    ----------
    side
        1 to the right, -1 to the left.
    """
    s.side[l], s.renew[l] = side, AFTER_UPLIFT
    enter_first_phase(s, l, system)
    log_event(s, l, log, time_of(s, l), UPLIFT, 0.0, 0.0, 0.0, 0.0)
