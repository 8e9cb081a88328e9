"""One intensity measure of a ground motion by its name, and the factor that scales to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from rpscli.errors import RecordError

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion

Measure = Literal["PGA", "PGV", "PGD", "Sa", "Arias", "CAV"]

MEASURE_UNITS: dict[Measure, str] = {
    "PGA": "m/s2",
    "PGV": "m/s",
    "PGD": "m",
    "Sa": "m/s2",
    "Arias": "m/s",
    "CAV": "m/s",
}
"""SI units."""


def measured(
    motion: GroundMotion, measure: Measure, period: float | None = None, damping: float = 0.05
) -> float:
    """A measure of a motion, SI units.

    Parameters
    ----------
    motion : GroundMotion
    measure : str
        One of `MEASURE_UNITS`.
    period : float, optional [s]
        Of Sa, which needs it.
    damping : float
        Of Sa, a share of critical damping.
    """
    if measure == "Sa":
        from rpscli.records.measures.spectrum import spectral_acceleration

        assert period is not None, "Sa is asked for at a period"
        return spectral_acceleration(motion, period, damping)
    from rpscli.records.measures.intensity import intensity_measures

    return float(getattr(intensity_measures(motion), measure.lower()))


def factor_to(value: float, unscaled: float, measure: Measure, source: str) -> float:
    """Factor on a motion that brings a measure of it to a value.

    Parameters
    ----------
    value, unscaled : float [SI]
        What the measure is to be, and what it is.
    measure : str
        Its name; Arias intensity grows with the square of the motion.
    source : str
        Names the motion in the message.

    Raises
    ------
    RecordError
        If the measure is zero.

    Examples
    --------
    >>> factor_to(4.0, 1.0, "PGA", ""), factor_to(4.0, 1.0, "Arias", "")
    (4.0, 2.0)
    """
    if unscaled <= 0.0:
        raise RecordError(f"{source}: {measure} is 0: cannot scale it")
    ratio = value / unscaled
    return ratio**0.5 if measure == "Arias" else ratio
