"""First period and damping before uplift, from accelerations of a floor."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.identification import Estimate, estimate
from rpscli.errors import AnalysisError

Array = NDArray[np.float64]
BAND = (0.6, 1.5)
"""Frequencies about the first one that are looked at, over it."""
LOOKED_FOR = (0.85, 3.0)
"""Periods that are looked for, over the one on a fixed base."""
DAMPED = (1e-4, 0.5)
"""Damping ratios of structures."""
LEFT, SCATTER = (0.0, 0.7), (0.3, 3.0)
"""Misfits of a model that holds: of what is fitted, and of an ambient spectrum."""
UNKNOWN = 3.0
"""Standard error of a logarithm that says nothing."""


class Vibration(NamedTuple):
    """First period [s] and damping ratio."""

    period: Estimate
    damping: Estimate
    misfit: float  # scatter about the spectrum, 1 where it holds; or the part that is not fitted


def vibration(
    expected: float, dt: float, floor: Array, ground: Array | None = None, *, free: bool = False
) -> Vibration:
    """First period and damping before uplift from a floor's acceleration, in any unit.

    With the ground's in the same unit the floor's answer to it is fitted; else a free decay if
    `free`, else the spectrum. `expected` is the first period on a fixed base [s].

    Notes
    -----
    Ambient: Whittle's likelihood of the periodogram, S = a f^c/((f^2 - f1^2)^2 + (2 zeta f1 f)^2) +
    b, P. Whittle, Ark. Mat. 2, 1953; intervals from Fisher's information. Else least squares of the
    transform in the band, linear in all but period and damping.
    """
    for name, record in (("floor", floor), ("ground", ground)):
        if record is not None and not np.ptp(record) > 0.0:
            raise AnalysisError(f"the acceleration of the {name} is constant")
    n = len(floor)
    if n * dt < 10.0 * expected:
        raise AnalysisError(
            f"{n * dt:.3g} s are fewer than ten periods of {expected:.3g} s; a longer record is"
            " needed"
        )
    f = np.fft.rfftfreq(n, dt)
    Y = np.fft.rfft(floor - floor.mean())
    X = None if ground is None else np.fft.rfft(ground)
    power = np.abs(Y) ** 2
    if X is not None:
        power /= np.abs(X) ** 2 + np.median(np.abs(X) ** 2)
    width = max(3, round(0.05 * n * dt / expected))
    smooth = np.convolve(power, np.ones(width) / width, "same")
    looked = (f > 1.0 / (LOOKED_FOR[1] * expected)) & (f < 1.0 / (LOOKED_FOR[0] * expected))
    peak = float(f[looked][np.argmax(smooth[looked])])
    inside = (f > BAND[0] * peak) & (f < BAND[1] * peak)
    f, Y = f[inside], Y[inside]
    if len(f) < 12:
        raise AnalysisError(f"{len(f)} frequencies about {peak:.3g} Hz; a longer record is needed")
    if X is None and not free:
        return _ambient(f, np.abs(Y) ** 2 / n, peak, expected)
    time = np.arange(n) * dt

    def columns(q: Array) -> Array:
        """What period and damping make of unit amplitudes."""
        w, zeta = np.exp(q)
        decay = np.exp((-zeta + 1j * math.sqrt(1.0 - min(zeta, 0.9) ** 2)) * w * time)
        made = [np.fft.rfft(part)[inside] for part in (decay.real, decay.imag)]
        # Higher modes are slow and smooth here: what begins in them, and what the ground does.
        s = 2j * np.pi * f / w
        made += [np.ones_like(s), s]
        if X is not None:
            parts = (1.0, s**2, s**2 / (s**2 + 2.0 * zeta * s + 1.0))
            made += [X[inside] * part for part in parts]
        return np.column_stack(made)

    def misses(q: Array) -> Array:
        C = columns(q)
        stacked, y = np.concatenate([C.real, C.imag]), np.concatenate([Y.real, Y.imag])
        return np.asarray(y - stacked @ np.linalg.lstsq(stacked, y, rcond=None)[0])

    from scipy.optimize import least_squares

    best = least_squares(misses, [math.log(2.0 * math.pi * peak), math.log(0.03)], x_scale=0.01)
    freedoms = 2 * len(f) - (6 if X is None else 9)
    variance = 2.0 * float(best.cost) / freedoms
    J = np.asarray(best.jac)
    covariance = variance * np.linalg.pinv(J.T @ J)
    share = 2.0 * float(best.cost) / float(np.sum(np.abs(Y) ** 2))
    return _of_logarithms(best.x, covariance, freedoms, math.sqrt(share), expected, LEFT)


def _ambient(f: NDArray[Any], power: NDArray[Any], peak: float, expected: float) -> Vibration:
    """From the periodogram, whose values are exponential about the spectrum."""

    def spectrum(p: Array) -> Array:
        first, zeta, a, b, c = np.exp(p[0]), np.exp(p[1]), np.exp(p[2]), np.exp(p[3]), p[4]
        x = f / first
        return np.asarray(a * x**c / ((x**2 - 1.0) ** 2 + (2.0 * zeta * x) ** 2) + b)

    def unlikely(p: Array) -> float:
        S = spectrum(p)
        return float(np.sum(np.log(S) + power / S))

    from scipy.optimize import minimize

    sizes = peak, 0.03, 4e-3 * power.max(), power.min() + 1e-3 * power.mean()
    options: Any = {"maxiter": 4000, "xatol": 1e-6, "fatol": 1e-6}
    start = np.array([*map(math.log, sizes), 0.0])
    p = np.asarray(minimize(unlikely, start, method="Nelder-Mead", options=options).x)
    S, h = spectrum(p), 1e-5
    J = np.array([(spectrum(p + h * d) - spectrum(p - h * d)) / (2.0 * h * S) for d in np.eye(5)])
    covariance, misfit = np.linalg.pinv(J @ J.T), float((power / S).std())
    q = np.array([p[0] + math.log(2.0 * math.pi), p[1]])
    return _of_logarithms(q, covariance, len(f) - 5, misfit, expected, SCATTER)


@np.errstate(invalid="ignore")  # variances below 0, of what is not determined
def _of_logarithms(
    q: Array,
    covariance: Array,
    freedoms: int,
    misfit: float,
    expected: float,
    usual: tuple[float, float],
) -> Vibration:
    """Period and damping from logarithms of circular frequency and damping; refuse a bad fit."""
    T, zeta = 2.0 * math.pi * np.exp(-q[0]), np.exp(q[1])
    errors, why = np.sqrt(np.diag(covariance)[:2]), ""
    if not (LOOKED_FOR[0] * expected < T < LOOKED_FOR[1] * expected):
        reach = f"from {LOOKED_FOR[0]:g} to {LOOKED_FOR[1]:g} times that of the case"
        why = f"its period of {T:.4g} s is not {reach}, {expected:.4g} s"
    elif not DAMPED[0] < zeta < DAMPED[1]:
        why = f"its damping ratio of {zeta:.3g} is none of a structure"
    elif not usual[0] < misfit < usual[1]:
        why = f"its misfit of {misfit:.3g} is not from {usual[0]:g} to {usual[1]:g}"
    elif not np.all(errors < UNKNOWN):
        why = "the motion does not determine it"
    if why:
        raise AnalysisError(
            f"no vibration before uplift fits: {why}; choose a part of the motion by --from and"
            " --to, or check the case and the units"
        )
    w, ratio = (estimate(value, error, freedoms) for value, error in zip(q, errors, strict=False))
    period = Estimate(*(2.0 * math.pi * math.exp(-value) for value in (w.value, w.high, w.low)))
    return Vibration(period, Estimate(*(math.exp(value) for value in ratio)), misfit)
