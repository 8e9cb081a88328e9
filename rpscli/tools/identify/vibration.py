"""First period and damping before uplift, from accelerations of a floor."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import AnalysisError, UsageError
from rpscli.model.contact import Contact
from rpscli.model.podium import Array, PodiumStructure
from rpscli.tools.identify.estimates import Estimate, Identified, estimate

BAND = (0.6, 1.5)
"""Frequencies about the first one that are looked at, over it."""
LOOKED_FOR = (0.85, 3.0)
"""Periods that are looked for, over the one on a fixed base."""
DAMPED = (1e-4, 0.5)
"""Damping ratios of structures."""
LEFT = (0.0, 0.7)
SCATTER = (0.3, 3.0)
"""Misfits of a model that holds: of what is fitted, and of an ambient spectrum."""
UNKNOWN = 3.0
"""Standard error of a logarithm that says nothing."""


class Vibration(NamedTuple):
    """First period [s] and damping ratio."""

    period: Estimate
    damping: Estimate
    # scatter about the spectrum, 1 where it holds; or the part that is not fitted
    misfit: float


@np.errstate(
    divide="ignore", over="ignore", invalid="ignore"
)  # where a search may go astray
def vibration(
    expected: float,
    dt: float,
    floor: Array,
    ground: Array | None = None,
    *,
    free: bool = False,
) -> Vibration:
    """First period and damping before uplift from a floor's acceleration, in any unit.

    With the ground's in the same unit the floor's answer to it is fitted;
    else a free decay if `free`, else the spectrum. `expected` is the first
    period on a fixed base [s].

    Notes
    -----
    Ambient: Whittle's likelihood of the periodogram, S = a f^c/((f^2 - f1^2)^2 + (2 zeta
    f1 f)^2) + b, P. Whittle, Ark. Mat. 2, 1953; intervals from Fisher's information. Else
    least squares of the transform in the band, linear in all but period and damping.
    """
    _require_samples(expected, dt, floor, ground)
    band = _band(expected, dt, floor, ground)
    if ground is None and not free:
        power = np.abs(band.floor) ** 2 / len(floor)
        return _ambient(band.frequencies, power, band.peak, expected)
    return _fitted(band, expected)


class _Band(NamedTuple):
    """Transforms of accelerations at the frequencies about the first one [Hz]."""

    time: NDArray[Any]
    inside: NDArray[np.bool_]  # of all frequencies
    peak: float
    frequencies: NDArray[Any]
    floor: NDArray[np.complex128]
    ground: NDArray[np.complex128] | None

    def columns(self, q: Array) -> NDArray[np.complex128]:
        """Motions of unit amplitude with the period and the damping of q."""
        w, zeta = np.exp(q)
        phase = -zeta + 1j * math.sqrt(1.0 - min(zeta, 0.9) ** 2)
        decay = np.exp(phase * w * self.time)
        made = [np.fft.rfft(part)[self.inside] for part in (decay.real, decay.imag)]
        # Higher modes are slow and smooth here: what begins in them, and what the ground
        # does.
        s = 2j * np.pi * self.frequencies / w
        made += [np.ones_like(s), s]
        if self.ground is not None:
            parts = (1.0, s**2, s**2 / (s**2 + 2.0 * zeta * s + 1.0))
            made += [self.ground * part for part in parts]
        return np.column_stack(made)

    def misses(self, q: Array) -> Array:
        """The part of the floor's transform that nothing explains."""
        C = self.columns(q)
        Y = self.floor
        return _unexplained(
            np.concatenate([C.real, C.imag]), np.concatenate([Y.real, Y.imag])
        )


def _band(expected: float, dt: float, floor: Array, ground: Array | None) -> _Band:
    """The frequencies about the peak of a smooth spectrum, over that of the ground."""
    n = len(floor)
    f = np.fft.rfftfreq(n, dt)
    Y = np.fft.rfft(floor - floor.mean())
    X = None if ground is None else np.fft.rfft(ground)
    power = np.abs(Y) ** 2
    if X is not None:
        power /= np.abs(X) ** 2 + np.median(np.abs(X) ** 2)

    width = max(3, round(0.05 * n * dt / expected))
    smooth = np.convolve(power, np.ones(width) / width, "same")
    looked = (f > 1.0 / (LOOKED_FOR[1] * expected)) & (
        f < 1.0 / (LOOKED_FOR[0] * expected)
    )
    peak = float(f[looked][np.argmax(smooth[looked])])

    inside = (f > BAND[0] * peak) & (f < BAND[1] * peak)
    if (count := int(inside.sum())) < 12:
        raise AnalysisError(
            f"{count} frequencies about {peak:.3g} Hz; a longer record is needed"
        )
    of_ground = None if X is None else X[inside]
    return _Band(np.arange(n) * dt, inside, peak, f[inside], Y[inside], of_ground)


def _fitted(band: _Band, expected: float) -> Vibration:
    """By least squares of the floor's transform in the band."""
    from scipy.optimize import least_squares

    start = [math.log(2.0 * math.pi * band.peak), math.log(0.03)]
    best = least_squares(band.misses, start, x_scale=0.01)
    freedoms = 2 * len(band.frequencies) - (6 if band.ground is None else 9)
    variance = 2.0 * float(best.cost) / freedoms
    J = np.asarray(best.jac)
    covariance = variance * _inverse(J.T @ J)
    whole = max(float(np.sum(np.abs(band.floor) ** 2)), np.finfo(float).tiny)
    share = 2.0 * float(best.cost) / whole
    return _of_logarithms(best.x, covariance, freedoms, math.sqrt(share), expected, LEFT)


def _require_samples(
    expected: float, dt: float, floor: Array, ground: Array | None
) -> None:
    """Refuse accelerations that cannot show a period."""
    for name, record in (("floor", floor), ("ground", ground)):
        if record is not None and not np.ptp(record) > 0.0:
            raise AnalysisError(f"the acceleration of the {name} is constant")
    if (span := len(floor) * dt) < 10.0 * expected:
        raise AnalysisError(
            f"{span:.3g} s are fewer than ten periods of {expected:.3g} s; a longer"
            " record is needed"
        )
    if dt >= 0.5 * LOOKED_FOR[1] * expected:  # where all that is looked for is too fast
        raise AnalysisError(
            f"samples every {dt:.3g} s do not show a period of {expected:.3g} s; a record"
            " with more samples a second is needed"
        )


def _ambient(
    f: NDArray[Any], power: NDArray[Any], peak: float, expected: float
) -> Vibration:
    """From the periodogram, whose values are exponential about the spectrum."""

    def spectrum(p: Array) -> Array:
        first = np.exp(p[0])
        zeta = np.exp(p[1])
        a = np.exp(p[2])
        b = np.exp(p[3])
        c = p[4]
        x = f / first
        return np.asarray(a * x**c / ((x**2 - 1.0) ** 2 + (2.0 * zeta * x) ** 2) + b)

    def unlikely(p: Array) -> float:
        S = spectrum(p)
        found = float(np.sum(np.log(S) + power / S))
        return found if math.isfinite(found) else math.inf

    from scipy.optimize import minimize

    sizes = peak, 0.03, 4e-3 * power.max(), power.min() + 1e-3 * power.mean()
    options: Any = {"maxiter": 4000, "xatol": 1e-6, "fatol": 1e-6}
    start = np.array([*map(math.log, sizes), 0.0])
    p = np.asarray(minimize(unlikely, start, method="Nelder-Mead", options=options).x)
    S = spectrum(p)
    h = 1e-5
    J = np.array(
        [(spectrum(p + h * d) - spectrum(p - h * d)) / (2.0 * h * S) for d in np.eye(5)]
    )
    covariance = _inverse(J @ J.T)
    misfit = float((power / S).std())
    q = np.array([p[0] + math.log(2.0 * math.pi), p[1]])
    return _of_logarithms(q, covariance, len(f) - 5, misfit, expected, SCATTER)


def _unexplained(columns: Array, y: Array) -> Array:
    """The part of y that no sum of the columns is; infinite
    where the search went astray.
    """
    if np.isfinite(columns).all():  # LAPACK prints a line on the terminal of what is not
        return np.asarray(y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0])
    return np.full_like(y, math.inf)


def _inverse(information: Array) -> Array:
    """The covariance; infinite where the search went astray."""
    if np.isfinite(information).all():
        return np.asarray(np.linalg.pinv(information))
    return np.full_like(information, math.inf)


def _of_logarithms(
    q: Array,
    covariance: Array,
    freedoms: int,
    misfit: float,
    expected: float,
    usual: tuple[float, float],
) -> Vibration:
    """Period and damping from logarithms of circular frequency and
    damping; refuse a bad fit.
    """
    T = 2.0 * math.pi * np.exp(-q[0])
    zeta = np.exp(q[1])
    errors = np.sqrt(np.diag(covariance)[:2])
    why = ""
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
            f"no vibration before uplift fits: {why}; the best has a period of {T:.4g} s"
            f" and a damping ratio of {zeta:.3g}; choose a part of the motion by --from"
            " and --to, or check the case and the units"
        )
    w, ratio = (
        estimate(value, error, freedoms) for value, error in zip(q, errors, strict=False)
    )
    period = Estimate(
        *(2.0 * math.pi * math.exp(-value) for value in (w.value, w.high, w.low))
    )
    return Vibration(period, Estimate(*(math.exp(value) for value in ratio)), misfit)


def vibration_of_case(
    structure: PodiumStructure, test: str, columns: Mapping[str, Array]
) -> Identified:
    """First period and damping of a building before uplift, and the contact of its
    podium.
    """
    building = structure.superstructure
    if building is None:
        raise UsageError(
            f"{test}: without storeys there is no period before uplift; use rocking"
        )
    time = columns["time"]
    fixed = float(building.periods[0])
    step = float(time[-1] - time[0]) / (len(time) - 1)
    ground = columns.get("ground_acceleration")
    found = vibration(
        fixed, step, columns["floor_acceleration"], ground, free=test == "release"
    )
    ratio = Estimate(*(value / fixed for value in found.period))
    estimates = {
        ("period", "s"): found.period,
        ("damping", "-"): found.damping,
        ("period_ratio", "-"): ratio,
    }
    remarks = (
        f"period_ratio is over {fixed:.4g} s, the period of the case on a fixed base"
    )
    if ground is not None:
        remarks += (
            "; noise in the record of the ground is not in the intervals, which are too"
            " narrow by it"
        )
    known = Identified(estimates, {}, found.misfit, remarks)
    return _with_contact(structure, ratio, known)


def _with_contact(
    structure: PodiumStructure, ratio: Estimate, found: Identified
) -> Identified:
    """Contact of the podium by a ratio of periods, added to what was found."""
    estimates = dict(found.estimates)
    remarks = found.remarks
    if ratio.high < 1.0:
        remarks += (
            "; the period is shorter than the case on a fixed base, which no contact"
            " makes it: the building is stiffer or lighter than the case"
        )
        return found._replace(remarks=remarks)
    if not ratio.low > 1.0:
        remarks += "; 1, which is rigid contact, is not excluded"
        return found._replace(remarks=remarks)

    try:
        estimates |= _contact_estimates(structure, ratio)
    except AnalysisError as error:
        remarks += "; period and damping are those measured, without a contact for them"
        return found._replace(remarks=remarks, fault=str(error))
    remarks += (
        "; stiffness of the podium in full contact; a period does not show whether ends"
        " are `plane`, which the settlement is for, or `edges`: try both"
    )
    keys = _contact_keys(ratio)
    return found._replace(estimates=estimates, keys=keys, remarks=remarks)


def _contact_estimates(
    structure: PodiumStructure, ratio: Estimate
) -> dict[tuple[str, str], Estimate]:
    """Stiffness of the podium in full contact, and its settlement where that is known."""
    try:
        soft = [replace(structure, contact=Contact("plane", each)).bed for each in ratio]
    except ValueError as error:
        raise AnalysisError(f"period_ratio = {ratio.value:.4g}: {error}") from None
    best, stiffest, softest = (bed for bed in soft if bed is not None)
    both = (best.stiffness, softest.stiffness, stiffest.stiffness)
    estimates = {("stiffness", "N/m"): Estimate(*both)}
    sunk = [
        bed.settlement for bed in (best, stiffest, softest) if bed.settlement is not None
    ]
    if len(sunk) == 3:
        estimates["settlement", "m"] = Estimate(*sunk)
    return estimates


def _contact_keys(ratio: Estimate) -> dict[str, str]:
    """Keys of a compliant contact, of which 1 itself is no ratio."""
    digits = 4 if ratio.value > 1.001 else 9
    return {
        "podium.contact.period_ratio": f"{ratio.value:.{digits}g}",
        "podium.contact.kind": "plane",
    }
