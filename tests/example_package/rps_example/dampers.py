"""A damper: oil behind a relief valve, which opens at a force and lets the damper resist less."""

from __future__ import annotations

from rpscli.plugins import DamperLaw, Quantity


def force(path: float, speed: float, c: float, relief: float, share: float) -> float:
    """An oil damper with a relief valve: c v up to the relief force, a share of c behind it."""
    opens = relief / c
    return c * speed if speed <= opens else relief + share * c * (speed - opens)


def valve(path: float, speed: float, c: float, relief: float, share: float) -> float:
    """Zero where the valve opens [m/s]."""
    return relief / c - speed


def slope(c: float, relief: float, share: float) -> float:
    """The largest, which is that about rest too [N s/m]."""
    return c


OIL = DamperLaw(
    {
        "closed_coefficient": Quantity("N s/m", symbol="c", above=0),
        "relief_force": Quantity("N", symbol="F_r", above=0),
        "open_share": Quantity(symbol="of c", at_least=0, at_most=1),
    },
    force,
    damping=slope,
    linear=slope,
    watched=valve,
)
