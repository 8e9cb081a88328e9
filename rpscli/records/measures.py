"""Measures of a ground motion, and of a pair of them: velocity,
intensities; scaling to one.

A measure of one component depends on how the sensors stood. Of a pair it is taken
over the 180 directions 0, 1, ... 179 deg from the first component towards the
second, and one number made of them: ``rotd50``, their median, or ``rotd100``, the
largest (D. M. Boore, Bull. Seism. Soc. Am. 100, 2010; directions count by themselves
at each period); ``geomean``, the geometric mean of both components as recorded,
``larger`` the larger of both, ``x`` the first one. ``component`` is no measure of a
pair: each component by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import (
    LARGEST,
    PluginError,
    RecordError,
    is_number,
    listed,
    require_kind,
    told,
)
from rpscli.records.ground_motion import GroundMotion, rotated
from rpscli.registry import Registry, owner_of
from rpscli.shown import Shown
from rpscli.units import KINDS

Array = NDArray[np.float64]


def velocity(acceleration: Array, dt: float) -> Array:
    """Ground velocity at the samples, zero at the first one; any integral by trapezia."""
    result = np.zeros_like(acceleration)
    np.cumsum(0.5 * dt * (acceleration[:-1] + acceleration[1:]), out=result[1:])
    return result


def displacement(acceleration: Array, dt: float) -> Array:
    """Displacement at the samples, zero at first; v dt + (2 a_0 +
    a_1) dt^2/6 in each step.
    """
    start = velocity(acceleration, dt)[:-1]
    step = dt * start + dt**2 * (2.0 * acceleration[:-1] + acceleration[1:]) / 6.0
    result = np.zeros_like(acceleration)
    np.cumsum(step, out=result[1:])
    return result


@dataclass(frozen=True)
class IntensityMeasures:
    """Measures of one motion; peaks are unsigned and taken at the samples."""

    pga: float
    pgv: float
    pgd: float
    """Peak ground acceleration, velocity and displacement; the ground starts from rest
    and no baseline is corrected [m/s2, m/s, m]."""
    # Arias intensity, pi/(2 g) times the integral of the squared acceleration [m/s]
    arias: float
    # cumulative absolute velocity, the integral of the absolute acceleration [m/s]
    cav: float
    d5_75: float
    # significant durations, from 5 % to 75 % and to 95 % of the Arias intensity [s]
    d5_95: float


def intensity_measures(motion: GroundMotion) -> IntensityMeasures:
    """All measures of a motion.

    Squares and absolute values are integrated by the trapezoidal rule, which is what
    published values use: for motions without content near the Nyquist frequency it is
    the more accurate one, while squares of the straight lines between samples fall
    short by dt/6 sum (a' dt)^2.

    A. Arias, in Seismic Design for Nuclear Power Plants, MIT Press, 1970.
    M. D. Trifunac and A. G. Brady, Bull. Seism. Soc. Am. 65, 1975 (duration to 95 %);
    P. G. Somerville and others, SAC/BD-97/04, 1997, use that to 75 %.
    """
    a = motion.acceleration
    dt = motion.dt
    husid = velocity(a**2, dt)

    def reached(share: float) -> float:
        level = share * husid[-1]
        after = int(np.argmax(husid >= level))
        if after == 0:  # a motion of zeros
            return 0.0
        before, beyond = husid[after - 1 : after + 1]
        return dt * (after - 1 + float((level - before) / (beyond - before)))

    return IntensityMeasures(
        pga=motion.pga,
        pgv=float(np.max(np.abs(velocity(a, dt)))),
        pgd=float(np.max(np.abs(displacement(a, dt)))),
        arias=math.pi / (2.0 * STANDARD_GRAVITY) * float(husid[-1]),
        cav=float(velocity(np.abs(a), dt)[-1]),
        d5_75=reached(0.75) - reached(0.05),
        d5_95=reached(0.95) - reached(0.05),
    )


_SAMPLES_PER_PERIOD = 50  # so that the largest sample is within 0.2 % of the peak
_FINEST = (
    64  # parts of a step; oscillators with periods below a step just follow the ground
)

SHORTEST = 1e-6  # of periods [s]; 0 is the rigid oscillator
DAMPING = 0.05


@dataclass(frozen=True, eq=False, repr=False)
class ResponseSpectrum(Shown):
    """Peak responses of linear oscillators, unsigned, each of shape (n,)."""

    periods: Array
    """[s]."""
    damping: float
    """Share of critical damping."""
    displacement: Array
    """Relative to the ground [m]."""
    pseudo_acceleration: Array
    """(2 pi/T)^2 times the displacement; the PGA at T = 0 [m/s2]."""
    total_acceleration: Array
    """Of the mass, in the inertial frame; the PGA at T = 0 [m/s2]."""


def response_spectrum(
    motion: GroundMotion, periods: Sequence[float] | Array, damping: float = 0.05
) -> ResponseSpectrum:
    """Response spectrum of a motion; the free vibration after its end counts.

    Parameters
    ----------
    motion : GroundMotion
        Horizontal ground acceleration.
    periods : sequence of float [s]
        Not negative; zero is the rigid oscillator.
    damping : float
        Share of critical damping, from 0 up to but below 1.

    Raises
    ------
    RecordError
        If a period or the damping is out of range.

    Examples
    --------
    >>> motion = GroundMotion(np.array([1.0, 1.0]), 10.0, "step", "", "")
    >>> spectrum = response_spectrum(motion, [1.0], damping=0.0)
    >>> round(float(spectrum.pseudo_acceleration[0]), 2)  # a sudden load counts twice
    2.0
    """
    require_kind(motion, GroundMotion, "the motion", "load_record(...) reads one")
    wanted = _valid_periods(periods)
    if not 0.0 <= damping < 1.0:
        raise RecordError(
            f"the damping of a response spectrum, {damping}, must be in [0, 1)"
        )
    peaks = np.tile([0.0, motion.pga], (wanted.size, 1))
    for place in np.flatnonzero(wanted):
        histories = _histories(motion, float(wanted[place]), damping)
        peaks[place] = [np.max(np.abs(each)) for each in histories]
    with np.errstate(divide="ignore"):
        stiffness = (2.0 * np.pi / wanted) ** 2
    pseudo = np.full(wanted.shape, motion.pga)
    np.multiply(stiffness, peaks[:, 0], out=pseudo, where=wanted > 0.0)
    return ResponseSpectrum(wanted, damping, peaks[:, 0], pseudo, peaks[:, 1])


def _valid_periods(periods: Sequence[float] | Array) -> Array:
    """Periods of oscillators [s], which a spectrum can be of: raises RecordError."""
    try:
        wanted = np.array(periods, dtype=np.float64)
    except (TypeError, ValueError):
        wanted = np.array([np.nan])
    if not (np.isfinite(wanted) & ((wanted == 0.0) | (wanted >= SHORTEST))).all():
        raise RecordError(
            f"periods of a response spectrum must be 0 or from {SHORTEST:g} s on:"
            f" {str(periods)[:60]}"
        )
    return wanted


def pseudo_acceleration_history(
    motion: GroundMotion, period: float, damping: float
) -> Array:
    """Relative displacement of an oscillator times (2 pi/T)^2
    [m/s2], on a step of its own.
    """
    if period == 0.0:
        return motion.acceleration
    return (2.0 * math.pi / period) ** 2 * _histories(motion, period, damping)[0]


def _histories(motion: GroundMotion, period: float, damping: float) -> list[Array]:
    """Displacement [m] and total acceleration [m/s2] of one oscillator."""
    from scipy.linalg import expm
    from scipy.signal import lfilter

    parts = min(_FINEST, max(1, math.ceil(_SAMPLES_PER_PERIOD * motion.dt / period)))
    fine = motion.finer(parts)
    quiet = np.zeros(math.ceil(period / fine.dt) + 1)  # one period after the end
    ground = np.concatenate([fine.acceleration, quiet])
    w = 2.0 * math.pi / period
    s = w * complex(-damping, math.sqrt(1.0 - damping**2))
    # Re(q), Im(q), the acceleration and its slope, as the closed formulae of the
    # integrals lose all digits where w dt is small.
    a = s.real * fine.dt
    b = s.imag * fine.dt
    rows = [
        [a, -b, 1.0, 0.0],
        [b, a, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [0.0, 0.0, 0.0, 0.0],
    ]
    step = expm(np.array(rows))
    grown, _, level, slope = step[0] + 1j * step[1]
    last = fine.dt * slope
    first = fine.dt * (level - slope)
    # At rest at the first sample, which may be a jump.
    q, _ = lfilter([last, first], [1.0, -grown], ground, zi=[-last * ground[0]])
    displacement = -q.imag / s.imag
    velocity = -(s * q).imag / s.imag
    return [displacement, -(w**2) * displacement - 2.0 * damping * w * velocity]


def drawn_spectrum(motion: GroundMotion) -> ResponseSpectrum:
    """The spectrum of figures: up to 4 s, at 5 % of critical damping."""
    periods = np.concatenate([np.arange(0.0, 1.0, 0.02), np.arange(1.0, 4.01, 0.05)])
    return response_spectrum(motion, periods, DAMPING)


def filtered_incremental_velocity(motion: GroundMotion, period: float) -> float:
    """FIV3 [m/s]: the three largest increments of filtered ground
    velocity in 0.7 T, added up.

    V(t) is the integral from t to t + 0.7 T of the acceleration behind a Butterworth
    low-pass filter of second order with the corner 0.85/T. FIV3 is the larger of the sum
    of the three largest maxima of V(t) and of the three smallest minima without their
    sign. The ground is at rest before and after the record. The filter runs forwards and
    backwards, as in the public programs EzGM and stickModel; others run it forwards alone
    (the paper was not at hand), which gives 4 to 61 % more, 16 % in the median, for the
    far-field records of FEMA P695.

    H. Davalos and E. Miranda, Earthq. Eng. Struct. Dyn. 48, 2019, 1384-1405.
    """
    from scipy.signal import butter, filtfilt, find_peaks

    window = 0.7 * period
    corner = 0.85 / period
    dt = motion.dt
    # Three periods of the corner, after which the filter has forgotten, and the window.
    quiet = np.zeros(math.ceil((3.0 / corner + window) / dt))
    ground = np.concatenate([quiet, motion.acceleration, quiet])
    if corner < (nyquist := 0.5 / dt):
        ground = filtfilt(*butter(2, corner / nyquist), ground, padlen=0)
    speed = velocity(ground, dt)
    time = np.arange(ground.size) * dt
    gained = np.interp(time + window, time, speed) - speed
    # Ripples of rounding on a flat top are no maxima of their own.
    least = 1e-9 * float(np.max(np.abs(gained)))
    sums = [
        np.sort(each[find_peaks(each, prominence=least)[0]])[-3:].sum()
        for each in (gained, -gained)
    ]
    return float(max(*sums, 0.0))


def _average_acceleration(spectra: Array, _: Array) -> Array:
    """AvgSa [m/s2] (...), the geometric mean of Sa (..., 10) at ten
    periods from 0.2 T to 3 T.

    The range is that of L. Eads, E. Miranda and D. G. Lignos, Earthq. Eng. Struct. Dyn.
    44, 2015, who space the periods by 0.01 s; ten periods, evenly spaced, are those of
    the ground motion models that give hazard curves of it. At T = 1 s they give 7 % less
    to 17 % more, 3 % more in the median, for the far-field records of FEMA P695.
    """
    with np.errstate(
        divide="ignore"
    ):  # a motion of zeros has no logarithm, and measures nothing
        return np.asarray(np.exp(np.mean(np.log(spectra), axis=-1)))


def _spectrum_intensity(spectra: Array, periods: Array) -> Array:
    """Housner's intensity [m] (...), the integral of the
    pseudo-velocity over 0.1 to 2.5 s.

    It is that of Sa (..., periods) by trapezia every 0.025 s, which is within 0.3 %
    for recorded motions. G. W. Housner, in Proc. Symposium on Earthquake and Blast
    Effects on Structures, 1952.
    """
    return np.asarray(np.trapezoid(spectra * periods / (2.0 * math.pi), periods, axis=-1))


Measure = str  # a name in `MEASURES`


@dataclass(frozen=True)
class IntensityMeasure:
    """A measure of ground motions in an SI `unit`.

    It is `of` a motion, a period [s] and a share of critical damping; the
    period is NaN for one that is not `at_period`. The measure grows by the
    `power` of the factor on a motion.
    """

    unit: str
    of: Callable[[GroundMotion, float, float], float]
    at_period: bool = False
    power: float = 1.0

    def __post_init__(self) -> None:
        if self.unit not in (known := [*KINDS, "-"]):
            raise ValueError(f"unit = {str(self.unit)[:20]!r} must be {listed(known)}")
        if not (is_number(self.power) and self.power > 0.0):
            raise ValueError(f"power = {self.power!r} must be > 0")


class _OfSpectrum(NamedTuple):
    """A measure by pseudo-accelerations at periods, which may be multiples of one [s]."""

    periods: Callable[[float], Array]
    value: Callable[[Array, Array], Array]

    def of(self, motion: GroundMotion, period: float, damping: float) -> float:
        at = self.periods(period)
        return float(
            self.value(response_spectrum(motion, at, damping).pseudo_acceleration, at)
        )


_SPECTRAL: dict[str, _OfSpectrum] = {
    "Sa": _OfSpectrum(lambda T: np.array([T]), lambda spectra, _: spectra[..., 0]),
    "AvgSa": _OfSpectrum(lambda T: np.linspace(0.2, 3.0, 10) * T, _average_acceleration),
    "Housner": _OfSpectrum(lambda _: np.linspace(0.1, 2.5, 97), _spectrum_intensity),
}
_HISTORIES: dict[str, Callable[[Array, float], Array]] = {
    "PGA": lambda a, _dt: a,
    "PGV": velocity,
    "PGD": displacement,
}
"""Histories, linear in a motion, whose largest magnitudes are measures."""


def _summary(name: str) -> Callable[[GroundMotion, float, float], float]:
    return lambda motion, _period, _damping: float(
        getattr(intensity_measures(motion), name)
    )


MEASURES = Registry(
    "measures",
    {
        "PGA": IntensityMeasure("m/s2", _summary("pga")),
        "PGV": IntensityMeasure("m/s", _summary("pgv")),
        "PGD": IntensityMeasure("m", _summary("pgd")),
        "Sa": IntensityMeasure("m/s2", _SPECTRAL["Sa"].of, at_period=True),
        "AvgSa": IntensityMeasure("m/s2", _SPECTRAL["AvgSa"].of, at_period=True),
        "FIV3": IntensityMeasure(
            "m/s",
            lambda m, T, _damping: filtered_incremental_velocity(m, T),
            at_period=True,
        ),
        "Housner": IntensityMeasure("m", _SPECTRAL["Housner"].of),
        "Arias": IntensityMeasure("m/s", _summary("arias"), power=2.0),
        "CAV": IntensityMeasure("m/s", _summary("cav")),
    },
    IntensityMeasure,
)


def needs_period(measure: Measure | None) -> bool:
    """True for a measure that is taken at a period."""
    return measure is not None and MEASURES[measure].at_period


def fault_of_aim(measure: str, value: float, period: float | None) -> str:
    """The reason why no motion can be scaled to a measure; empty if one can."""
    if measure not in MEASURES and measure not in (names := MEASURES.names()):
        return f"{measure} is not a measure; there are {', '.join(names)}"
    if needs_period(measure) and period is None:
        return f"{measure} is scaled to at a period; give period=... in s"
    if not (is_number(value) and value > 0.0):
        return f"{measure} = {told(value)} must be a number > 0, in SI, to scale to it"
    return ""


def measured(
    motion: GroundMotion,
    measure: Measure,
    period: float | None = None,
    damping: float = 0.05,
) -> float:
    """A measure of a motion, SI units."""
    found = MEASURES[measure]
    assert period is not None or not found.at_period, (
        f"{measure} is asked for at a period"
    )
    made = float(found.of(motion, math.nan if period is None else period, damping))
    if not 0.0 <= made <= LARGEST:
        owner = owner_of(found.of, measure)
        raise PluginError(
            f"{owner}: it is {made:g} {found.unit} for {motion.name}, and must be at least"
            f" 0 and at most {LARGEST:g}"
        )
    return made


def factor_to(value: float, unscaled: float, measure: Measure, source: str) -> float:
    """Factor on a motion that brings a measure of it to a value."""
    if not unscaled > 0.0:
        raise RecordError(f"{source}: {measure} is {unscaled:g}: cannot scale it")
    return float((value / unscaled) ** (1.0 / MEASURES[measure].power))


Of = Literal["rotd50", "geomean", "rotd100", "larger", "x", "component"]
"""Names of what a measure may be of."""

OF: tuple[Of, ...] = get_args(Of)

USUAL: Of = "rotd50"  # of pairs, where nothing else is asked for
SHOWN: dict[Of, str] = {"rotd50": "RotD50", "rotd100": "RotD100"}
"""As outputs name those that have another spelling."""

DIRECTIONS = np.arange(180.0)  # from the first component towards the second [deg]


def measure_label(measure: str, of: Of | None, at: str = "") -> str:
    """A measure, at a period perhaps, as columns and axes name it."""
    pair = "" if of in (None, "component") else SHOWN.get(of, of)
    inside = ", ".join(filter(None, (at, pair)))
    return f"{measure}({inside})" if inside else measure


def of_directions(values: Array, of: Of | Literal["srss"] = USUAL) -> Array:
    """Of values (180, ...) over the directions, (...)."""
    first = values[0]
    second = values[90]
    if of == "srss":
        return np.asarray(np.hypot(first, second))
    if of == "rotd50":
        return np.asarray(np.median(values, axis=0))
    if of == "rotd100":
        return np.asarray(values.max(axis=0))
    if of == "geomean":
        return np.asarray(np.sqrt(first * second))
    return np.asarray(np.maximum(first, second) if of == "larger" else first)


def over_directions(
    first: GroundMotion,
    second: GroundMotion,
    measure: Measure,
    period: float | None = None,
    damping: float = 0.05,
) -> Array:
    """(180,) a measure of the pair turned to each direction, SI units."""
    if history := _HISTORIES.get(measure):
        pair = (rotated(first, second, angle) for angle in (0.0, 90.0))  # of one length
        return _peaks(*(history(each.acceleration, each.dt) for each in pair))
    if spectral := _SPECTRAL.get(measure):
        at = spectral.periods(math.nan if period is None else period)
        return spectral.value(spectra_over_directions(first, second, at, damping), at)
    turned = (rotated(first, second, angle) for angle in DIRECTIONS.tolist())
    return np.array([measured(each, measure, period, damping) for each in turned])


def spectra_over_directions(
    first: GroundMotion,
    second: GroundMotion,
    periods: Sequence[float] | Array,
    damping: float,
) -> Array:
    """(180, periods) pseudo-acceleration of the pair turned to each direction [m/s2]."""
    pair = [rotated(first, second, angle) for angle in (0.0, 90.0)]  # of one length
    histories = (
        (pseudo_acceleration_history(m, float(t), damping) for m in pair) for t in periods
    )
    return np.column_stack([_peaks(*each) for each in histories])


def pair_measure(
    first: GroundMotion,
    second: GroundMotion,
    measure: Measure,
    of: Of = USUAL,
    period: float | None = None,
    damping: float = 0.05,
) -> float:
    """A measure of a pair, SI units."""
    return float(
        of_directions(over_directions(first, second, measure, period, damping), of)
    )


def _peaks(x: Array, y: Array) -> Array:
    """(180,) largest magnitudes of what is linear in the motion, in each direction."""
    turn = np.radians(DIRECTIONS)
    # 90 deg is the second component to the last bit, as it is of a motion that is turned.
    cosines = np.where(DIRECTIONS == 90.0, 0.0, np.cos(turn))
    turns = np.column_stack([cosines, np.sin(turn)])
    sizes = (np.abs(c * x + s * y) for c, s in turns[::15])
    corners = [int(np.argmax(size)) for size in sizes]
    # What is nearer than the least reach of some points is the farthest in no direction.
    reach = float(np.abs(turns @ [x[corners], y[corners]]).max(axis=1).min())
    far = x**2 + y**2 >= (reach * (1.0 - 1e-9)) ** 2
    x = x[far]
    y = y[far]
    return np.array([np.abs(c * x + s * y).max() for c, s in turns])
