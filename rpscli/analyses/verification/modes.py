"""First mode and frequency parameter after uplift, as in Figures 3 to 5 of the paper."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.modal import UpliftedModes, modal
from rpscli.analyses.verification.comparison import Comparison, Known, compare
from rpscli.analyses.verification.structures import paper_podium

AMPLIFIED = "First mode after uplift over fixed base, tan a = 0.15 (as in Figure 3)"
PARAMETER = "Frequency parameter of six storeys, tan a = 0.15 (as in Figure 4)"

ROCKING = 0.0
"""Stands for the rocking phase, in which the radius plays no part."""

AMPLIFICATION = {
    (1, 0.25): (1.395, 1.396),
    (1, 0.5): (1.395, 1.395),
    (1, 1.5): (1.396, 1.395),
    (1, ROCKING): (1.376, 1.377),
    (2, 0.25): (1.634, 1.613),
    (2, 0.5): (1.635, 1.612),
    (2, 1.5): (1.638, 1.608),
    (2, ROCKING): (1.583, 1.569),
    (3, 0.25): (1.732, 1.663),
    (3, 0.5): (1.734, 1.660),
    (3, 1.5): (1.742, 1.650),
    (3, ROCKING): (1.664, 1.618),
    (6, 0.25): (1.836, 1.688),
    (6, 0.5): (1.844, 1.676),
    (6, 1.5): (1.875, 1.627),
    (6, ROCKING): (1.741, 1.661),
    (10, 0.25): (1.869, 1.703),
    (10, 0.5): (1.890, 1.668),
    (10, 1.5): (1.974, 1.528),
    (10, ROCKING): (1.753, 1.703),
}
"""By storeys and rho: frequency factor, damping factor."""

FREQUENCY_PARAMETER = {
    (0.25, 1.5): (1.275, 1.280),
    (1.5, 0.5): (4.122, 4.435),
    (1.5, 1.0): (3.008, 3.136),
    (1.5, 1.5): (2.482, 2.560),
    (1.5, 3.0): (1.774, 1.810),
    (ROCKING, 1.5): (1.765, 1.810),
}
"""By rho and R [m]: p_ext of the model and of the rigid estimate [rad/s]."""


def rounded(value: float) -> Known:
    """Half of the third decimal; and some were computed with g = 9.81 m/s2.

    That is 3.4e-4 more than the standard value, and frequencies go with its root.
    """
    return Known(value, 0.5e-3 + 1.8e-4 * value)


def modes() -> Iterator[Comparison]:
    """Amplification of frequency and damping, and the storey's own mode."""
    for (storeys, rho), known in AMPLIFICATION.items():
        found = _uplifted(storeys, rho, 1.5)
        where = f"n = {storeys}, {_phase(rho)}"
        values = (found.frequency_ratio[0], found.damping_ratio[0])
        for name, expected, value in zip(("frequency", "damping"), known, values, strict=True):
            yield compare(AMPLIFIED, f"{name} factor, {where}", "-", rounded(expected), value)
    for (rho, size), known in FREQUENCY_PARAMETER.items():
        found = _uplifted(6, rho, size)
        where = f"R = {size:g} m, {_phase(rho)}"
        values = (found.frequency_parameter, found.frequency_parameter_rigid)
        for name, expected, value in zip(("p_ext", "rigid estimate"), known, values, strict=True):
            yield compare(PARAMETER, f"{name}, {where}", "rad/s", rounded(expected), value)


def _uplifted(storeys: int, rho: float, size: float) -> UpliftedModes:
    result = modal(paper_podium(storeys, 0.15, rho or 0.5, size))
    if rho == ROCKING:
        return result.rocking
    assert result.rolling is not None, "curved ends roll"
    return result.rolling


def _phase(rho: float) -> str:
    return f"rolling, rho = {rho:g}" if rho else "rocking"
