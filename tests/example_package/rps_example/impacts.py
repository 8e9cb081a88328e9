"""An impact law: what falls faster crushes more of the joint, and gives back less."""

from __future__ import annotations

import math

from rpscli.plugins import Quantity, RestitutionLaw


def restitution(
    rate: float,
    tan_alpha: float,
    inertia_ratio: float,
    gamma: float,
    eta: float,
    slow: float,
    fast: float,
    usual: float,
) -> float:
    """A restitution that falls with the rate of the tilt: e_f + (e_s - e_f) exp(-rate/rate_0)."""
    return fast + (slow - fast) * math.exp(-rate / usual)


CRUSHING = RestitutionLaw(
    {
        "slow_restitution": Quantity(symbol="e_s", above=0, at_most=1),
        "fast_restitution": Quantity(symbol="e_f", above=0, at_most=1),
        "usual_rate": Quantity(symbol="rate_0 [rad/s]", above=0),
    },
    restitution,
)
