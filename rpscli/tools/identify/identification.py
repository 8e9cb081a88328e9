"""Measurements on a standing structure, and what they say about its case, with intervals.

Restitution and rolling resistance come from free rocking, by times and amplitudes of its
swings. The model is read as the measurement is, so that what the reading does to a swing
does not count. Where releases within the error of measurement part ways, as under
buildings that vibrate, means of ensembles are fitted, and what swings scatter about
them, together, counts as error. First period and damping before uplift come from
accelerations of a floor.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.errors import AnalysisError, UsageError
from rpscli.model.contact import Contact
from rpscli.model.devices import RollingResistance
from rpscli.model.podium import Array, PodiumStructure
from rpscli.records.ground_motion import GroundMotion

LEVEL = 0.90
"""Of every interval."""


class Estimate(NamedTuple):
    """A parameter with its interval of 90 %."""

    value: float
    low: float
    high: float

    @property
    def determined(self) -> bool:
        """Whether its interval has a width, and one below the value."""
        return 0.0 < self.high - self.low < abs(self.value)


class Identified(NamedTuple):
    """Estimates, and what they are in a case."""

    estimates: dict[tuple[str, str], Estimate]  # by name and unit
    keys: dict[str, str]  # values of keys, as written
    misfit: float  # distance of the model over the errors
    remarks: str
    ensembles: bool = False  # true if means of many motions were fitted
    residuals: tuple[dict[str, float], ...] = ()  # of each swing


def estimate(value: float, error: float, freedoms: int) -> Estimate:
    """From a standard error whose own size was estimated: Student's t."""
    from scipy.stats import t

    wide = float(t.ppf(0.5 + 0.5 * LEVEL, freedoms)) * error
    return Estimate(float(value), float(value - wide), float(value + wide))


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
    f = f[inside]
    Y = Y[inside]
    if len(f) < 12:
        raise AnalysisError(
            f"{len(f)} frequencies about {peak:.3g} Hz; a longer record is needed"
        )
    if X is None and not free:
        return _ambient(f, np.abs(Y) ** 2 / n, peak, expected)
    time = np.arange(n) * dt

    def columns(q: Array) -> Array:
        """What period and damping make of unit amplitudes."""
        w, zeta = np.exp(q)
        decay = np.exp((-zeta + 1j * math.sqrt(1.0 - min(zeta, 0.9) ** 2)) * w * time)
        made = [np.fft.rfft(part)[inside] for part in (decay.real, decay.imag)]
        # Higher modes are slow and smooth here: what begins in them, and what the ground
        # does.
        s = 2j * np.pi * f / w
        made += [np.ones_like(s), s]
        if X is not None:
            parts = (1.0, s**2, s**2 / (s**2 + 2.0 * zeta * s + 1.0))
            made += [X[inside] * part for part in parts]
        return np.column_stack(made)

    def misses(q: Array) -> Array:
        C = columns(q)
        return _unexplained(
            np.concatenate([C.real, C.imag]), np.concatenate([Y.real, Y.imag])
        )

    from scipy.optimize import least_squares

    best = least_squares(
        misses, [math.log(2.0 * math.pi * peak), math.log(0.03)], x_scale=0.01
    )
    freedoms = 2 * len(f) - (6 if X is None else 9)
    variance = 2.0 * float(best.cost) / freedoms
    J = np.asarray(best.jac)
    covariance = variance * _inverse(J.T @ J)
    share = (
        2.0 * float(best.cost) / max(float(np.sum(np.abs(Y) ** 2)), np.finfo(float).tiny)
    )
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
            f"no vibration before uplift fits: {why}; choose a part of the motion by"
            " --from and --to, or check the case and the units"
        )
    w, ratio = (
        estimate(value, error, freedoms) for value, error in zip(q, errors, strict=False)
    )
    period = Estimate(
        *(2.0 * math.pi * math.exp(-value) for value in (w.value, w.high, w.low))
    )
    return Vibration(period, Estimate(*(math.exp(value) for value in ratio)), misfit)


MOST_SWINGS = 12
SEEN = 20.0
"""Least amplitude of a swing that is used, over the noise of a sample."""
NEAR_TOP = 0.7
"""Part of a swing's amplitude above which its samples are taken for its top."""
ENSEMBLE = 9
"""Releases within three standard errors of the amplitude."""
SETTLED = 0.02
"""Move at which a fit ends, over the steps of differences: the next
one would be its square."""
WIDE = 4.0
"""Steps of differences of ensembles, over the standard errors."""
SHARED = tuple((part, lever) for part in (0.9, 0.6, 0.3) for lever in (0.003, 0.01))
"""Parts of what is lost at impacts, and levers over B that take
the rest: where fits begin."""
AS_GOOD = 1.26
"""Squared misfits over the least one of fits that are as good: 90 % fractile of F, for
two values that are fitted together and some twenty freedoms."""
PARTING = 0.3
"""Scatter of an ensemble over the error of measurement from which it counts."""
WORST_MISFIT = 10.0
"""Of a model that rocks like the structure; what a model lacks
leaves a few times the noise."""


class Swing(NamedTuple):
    """Top of an excursion to one side: time [s], |theta| [rad],
    and their standard errors.
    """

    time: float
    amplitude: float
    time_error: float
    amplitude_error: float


@dataclass(frozen=True)
class _Release:
    """A structure that is let go; q is its rotation, a delay, its
    loss or e, and its lever.
    """

    structure: PodiumStructure
    dt: float
    span: float
    noise: float
    side: float
    swings: list[Swing]

    @property
    def measured(self) -> Array:
        return np.array([value for swing in self.swings for value in swing[:2]])

    @property
    def place(self) -> int | None:
        devices = enumerate(self.structure.devices)
        return next(
            (i for i, each in devices if isinstance(each, RollingResistance)), None
        )

    def changed(self, q: Array) -> PodiumStructure:
        """With what is looked for."""
        law = self.structure.impact_law
        value = float(q[2])
        changed = (
            replace(law, restitution=value)
            if law.kind == "value"
            else replace(law, loss=value)
        )
        made = replace(self.structure, impact_law=changed)
        if self.place is None:
            return made
        devices = [*made.devices]
        devices[self.place] = RollingResistance(float(q[3]))
        return replace(made, devices=tuple(devices))

    def tops(self, q: Array, release: float = 1.0) -> Array:
        """Times and amplitudes of the swings; those that do not come have none."""
        start = self.side * float(q[0]) * release
        settings = TimeHistorySettings(free_vibration=self.span, initial_rotation=start)
        still = GroundMotion(np.zeros(2), self.dt, "still", "still", "")
        trace = time_history(
            self.changed(q), still, settings, with_fixed_base=False
        ).trace
        found = swings_of(
            trace.time, trace.rotation, self.noise, 0.25 * SEEN * self.noise
        )[1:]
        values = self.measured
        values[1::2] = 0.0
        for i, swing in enumerate(found[: len(self.swings)]):
            values[2 * i : 2 * i + 2] = swing.time + q[1], swing.amplitude
        return values


def rocking(structure: PodiumStructure, time: Array, rotation: Array) -> Identified:
    """Restitution and lever from rotations (n,) [rad] after a
    release of the unstrained case.
    """
    if (largest := float(np.abs(rotation).max())) >= structure.critical_rotation:
        raise AnalysisError(
            f"the rotation of {largest:.4g} rad is beyond the critical one of"
            f" {structure.critical_rotation:.4g} rad, where it would overturn; check its"
            " unit"
        )
    time = time - time[0]
    # Third differences of a smooth motion are small against those of noise, 20 sigma^2.
    rough = float(np.median(np.abs(np.diff(rotation, 3)))) / 0.6745 / math.sqrt(20.0)
    noise = max(rough, 1e-6 * largest)
    every = swings_of(time, rotation, noise, SEEN * noise)
    if len(every) < 4:
        raise AnalysisError(
            f"{len(every)} whole swings exceed the noise of {noise:.2g} rad, and four are"
            " needed: release it from a larger rotation, or choose a part of the motion"
            " by --from and --to"
        )
    if structure.bearing.is_spherical:
        raise AnalysisError(
            "columns without a flat part roll without impacts; use another test"
        )
    first, *swings = every[: MOST_SWINGS + 1]
    dt = float(time[1] - time[0])
    side = math.copysign(1.0, rotation[np.argmax(time >= first.time)])
    # Half a swing more than is looked at, which are ever shorter ones.
    span = swings[-1].time + 0.5 * (swings[-1].time - swings[-2].time)
    of = _Release(structure, dt, span, noise, side, swings)
    errors = np.array([value for swing in swings for value in swing[2:]])
    starts, steps, bounds = _starts(of, first)
    try:
        fits = [_fitted(of.tops, q, steps, bounds, of.measured, errors) for q in starts]
        q, gain, misfit = min(fits, key=lambda fit: fit[2])
        # Loss and lever make up for each other along a valley with many bottoms.
        others = [fit[0] - q for fit in fits if fit[2] ** 2 <= AS_GOOD * misfit**2]
        valley = np.sum(np.square(others), axis=0) / max(len(others) - 1, 1)
        covariance = (gain * errors**2) @ gain.T
        reach = 3.0 * max(1.0, misfit) * math.sqrt(covariance[0, 0]) / q[0]
        # A model that does not rock does not depend on its release either.
        releases = 1.0 + max(reach, 1e-9) * np.linspace(-1.0, 1.0, ENSEMBLE)

        def means(q: Array) -> tuple[Array, Array]:
            """Of the ensemble, and what the size of the release does not explain."""
            many = np.array([of.tops(q, release) for release in releases])
            away = (releases - 1.0)[:, None]
            left = (
                many
                - many.mean(axis=0)
                - away * ((away * many).sum(axis=0) / (away**2).sum())
            )
            return many.mean(axis=0), left

        left = means(q)[1]
        # Of one motion, and of the mean that it is held against.
        scatter = left.T @ left / (ENSEMBLE - 2) * (1.0 + 1.0 / ENSEMBLE)
        ensembles = bool(np.any(np.sqrt(np.diag(scatter)) > PARTING * errors))
        if ensembles:
            wide = np.sqrt(errors**2 + np.diag(scatter))
            steps = WIDE * np.sqrt(np.diag(covariance))
            q, gain, misfit = _fitted(
                lambda q: means(q)[0], q, steps, bounds, of.measured, wide
            )
            # Swings that part ways do so together, which the gain adds up.
            covariance = (gain * errors**2) @ gain.T + gain @ scatter @ gain.T
    except (ValueError, np.linalg.LinAlgError) as error:
        raise AnalysisError(
            f"no structure of this kind rocks in this way: {error}"
        ) from None
    model = of.tops(q).reshape(-1, 2)
    _refuse_bad_fit(q, bounds, model, misfit)
    spread = np.sqrt(max(1.0, misfit) ** 2 * np.diag(covariance) + valley)
    # The scatter of an ensemble is known from so few motions.
    freedoms = ENSEMBLE - 2 if ensembles else 2 * len(swings) - len(q)
    found = [estimate(*each, freedoms) for each in zip(q, spread, strict=True)]
    ratios = sorted(of.changed(np.array([*q[:2], k, *q[3:]])).restitution for k in
                    np.clip(found[2], *bounds[:, 2]))  # fmt: skip
    e = Estimate(of.changed(q).restitution, ratios[0], ratios[-1])
    return _told(of, [e, *found[2:]], model, misfit, ensembles=ensembles)


def _told(
    of: _Release, found: list[Estimate], model: Array, misfit: float, *, ensembles: bool
) -> Identified:
    """In words and numbers: e, the loss or e again, and a lever."""
    estimates = {("restitution", "-"): found[0]}
    written = [("podium.impact.restitution", found[0], 5)]
    if of.structure.impact_law.kind != "value":
        estimates["loss", "-"] = found[1]
        written = [("podium.impact.loss", found[1], 4)]
    if of.place is not None:
        estimates["lever", "m"] = found[2]
        written.append((f"podium.devices.{of.place}.lever", found[2], 4))
    keys = {
        key: f"{value.value:.{digits}g}"
        for key, value, digits in written
        if value.determined
    }
    names = (*Swing._fields, "model_time", "model_amplitude")
    rows = zip(of.swings, model.tolist(), strict=True)
    residuals = tuple(dict(zip(names, (*swing, *at), strict=True)) for swing, at in rows)
    remarks = f"residuals are {misfit:.3g} times what noise alone would leave"
    if misfit > 1.4:  # which noise leaves in one of a hundred, with twenty freedoms
        remarks += (
            ": the model lacks something, such as rolling resistance; intervals include"
            " that"
        )
    if of.place is not None:
        remarks += (
            "; loss and lever make up for each other: intervals include fits as good as"
            " this one that were found from other starts, and not those that were not"
        )
    if ensembles:
        remarks += "; neighbouring releases diverge, so means of ensembles were fitted"
    return Identified(estimates, keys, misfit, remarks, ensembles, residuals)


def _refuse_bad_fit(q: Array, bounds: Array, model: Array, misfit: float) -> None:
    """What least squares end at is no answer if the model does not
    rock like the structure.
    """
    away = f"{misfit:.3g} times the noise from those measured"
    if not misfit <= WORST_MISFIT:
        seen = int((model[:, 1] > 0.0).sum())
        count = len(model)
        short = f", and only {seen} of {count}" * (seen < count)
        why = f"the swings of the model that fits best are {away}{short}"
    elif (at_ends := (q == bounds)[:, (0, 2)].any(axis=0)).any():
        name = ("rotation of the release", "loss at impacts")[int(at_ends.argmax())]
        why = f"the {name} that fits best is at the end of its range, {away}"
    else:
        return
    raise AnalysisError(
        f"no structure of this kind rocks in this way: {why}; check the units, the"
        " geometry of the case, and that the structure was let go from rest"
    )


def _starts(of: _Release, first: Swing) -> tuple[list[Array], Array, Array]:
    """First values, steps of differences, and least and largest values."""
    law = of.structure.impact_law
    b = of.structure.bearing
    s = of.structure
    lifts = s.path(np.array([swing.amplitude for swing in of.swings]))[2]
    lost = 1.0 - min(float(np.median(np.sqrt(lifts[1:] / lifts[:-1]))), 0.999)
    if law.kind == "value":
        rows = [(1.0 - lost, 2e-3, 0.01, 1.0)]
    else:
        full = max(1.0 - replace(law, loss=1.0).ratio(b, s.gamma, s.eta_riding), 1e-6)
        rows = [(lost / full, 5e-3, 1e-6, 0.98 / full)]
    if of.place is not None:
        rows.append((0.0, 1e-3 * b.half_width, 1e-9, 0.2 * b.half_width))
    late = of.swings[0].time
    first_rows = [(first.amplitude, 2e-3 * first.amplitude, 0.0, s.critical_rotation),
                  (0.0, 1e-3 * late, -late, late)]  # fmt: skip
    q, steps, low, high = np.array([*first_rows, *rows]).T
    starts = [q]
    if of.place is not None:
        own = float(law.kind == "value")  # which is 1 where nothing is lost
        starts = [np.array([*q[:2], own + part * (q[2] - own), lever * b.half_width])
                  for part, lever in SHARED]  # fmt: skip
    return starts, steps, np.array([low, high])


def swings_of(time: Array, rotation: Array, noise: float, least: float) -> list[Swing]:
    """Excursions above a least amplitude: a parabola through what
    is near the top of each.
    """
    places = np.flatnonzero(np.abs(rotation) > max(0.25 * least, 4.0 * noise))
    turns = np.flatnonzero(np.diff(np.sign(rotation[places]))) + 1
    found: list[Swing] = []
    for run in np.split(places, turns):
        if not len(run) or np.abs(rotation[run]).max() < least:
            break
        x = np.abs(rotation[run[0] : run[-1] + 1])
        top = run[0] + np.flatnonzero(x > NEAR_TOP * x.max())
        # The record ends before the top has passed.
        if len(top) < 5 or top[-1] == len(rotation) - 1:
            break
        middle = 0.5 * (time[top[0]] + time[top[-1]])
        half = 0.5 * (time[top[-1]] - time[top[0]])
        powers = np.vander((time[top] - middle) / half, 3, increasing=True)
        c = np.linalg.lstsq(powers, np.abs(rotation[top]), rcond=None)[0]
        at = -0.5 * c[1] / c[2]
        spread = noise**2 * np.linalg.inv(powers.T @ powers)
        of_time = half * np.array([0.0, -0.5 / c[2], 0.5 * c[1] / c[2] ** 2])
        of_amplitude = np.array([1.0, at, at**2])
        errors = (math.sqrt(g @ spread @ g) for g in (of_time, of_amplitude))
        found.append(Swing(float(middle + half * at), float(of_amplitude @ c), *errors))
    return found


def _fitted(
    model: Callable[[Array], Array], q: Array, steps: Array, bounds: Array, measured: Array,
    errors: Array,
) -> tuple[Array, Array, float]:  # fmt: skip
    """Least squares by Gauss and Newton: q, its change by each
    measurement, misfit over errors.
    """

    def misses(q: Array) -> Array:
        return np.asarray((measured - model(np.clip(q, *bounds))) / errors)

    for _ in range(12):
        r = misses(q)
        sides = [(misses(q - step), misses(q + step)) for step in np.diag(steps)]
        J = np.column_stack(
            [(a - b) / (2.0 * h) for (a, b), h in zip(sides, steps, strict=True)]
        )
        inverse = np.linalg.pinv((J * steps).T @ (J * steps)) * steps[:, None]
        move = inverse @ (J * steps).T @ r
        parts = (
            (part, np.clip(q + part * move, *bounds)) for part in (1.0, 0.5, 0.25, 0.1)
        )
        better = (each for each in parts if np.sum(misses(each[1]) ** 2) < np.sum(r**2))
        part, tried = next(better, (0.0, q))
        q = tried
        if np.all(np.abs(part * move) < SETTLED * steps):
            break
    variance = float(np.sum(misses(q) ** 2)) / (len(measured) - len(q))
    return q, inverse @ (J * steps).T / errors, math.sqrt(variance)


_ROTATION = (("rotation", "rad"), ("cap_beam_displacement", "m"))
_FLOOR = (("floor_acceleration", "m/s2"),)
_GROUND = (("ground_acceleration", "m/s2"),)
TESTS = {
    "rocking": (_ROTATION,),
    "ambient": (_FLOOR,),
    "release": (_FLOOR,),
    "earthquake": (_FLOOR, _GROUND),
}
"""Columns that each test needs besides the time, one of each
group, and their SI units."""


def identified(
    structure: PodiumStructure, test: str, columns: Mapping[str, Array]
) -> Identified:
    """What one of the `TESTS` says of a structure, from columns
    (n,) in SI units by name.
    """
    if test == "rocking":
        if (rotation := columns.get("rotation")) is None:
            beam = columns["cap_beam_displacement"]
            x = np.linspace(0.0, structure.critical_rotation, 2001)
            rotation = np.sign(beam) * np.interp(np.abs(beam), structure.path(x)[1], x)
        found = rocking(structure, columns["time"], rotation)
    else:
        found = _vibration(structure, test, columns)
    for (name, _), value in found.estimates.items():
        if not value.determined:
            unknown = (
                f"; {name} is not determined: its interval is not narrower than its value"
            )
            found = found._replace(remarks=found.remarks + unknown)
    return found


def _vibration(
    structure: PodiumStructure, test: str, columns: Mapping[str, Array]
) -> Identified:
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
    estimates = {("period", "s"): found.period, ("damping", "-"): found.damping}
    estimates["period_ratio", "-"] = ratio
    remarks = (
        f"period_ratio is over {fixed:.4g} s, the period of the case on a fixed base"
    )
    if ground is not None:
        remarks += (
            "; noise in the record of the ground is not in the intervals, which are too"
        )
        remarks += " narrow by it"
    keys: dict[str, str] = {}
    if not ratio.low > 1.0:
        remarks += "; 1, which is rigid contact, is not excluded"
        return Identified(estimates, keys, found.misfit, remarks)
    try:
        soft = [replace(structure, contact=Contact("plane", each)).bed for each in ratio]
    except ValueError as error:
        raise AnalysisError(f"period_ratio = {ratio.value:.4g}: {error}") from None
    best, stiffest, softest = (bed for bed in soft if bed is not None)
    both = (best.stiffness, softest.stiffness, stiffest.stiffness)
    estimates["stiffness", "N/m"] = Estimate(*both)
    sunk = [
        bed.settlement for bed in (best, stiffest, softest) if bed.settlement is not None
    ]
    if len(sunk) == 3:
        estimates["settlement", "m"] = Estimate(*sunk)
    digits = (
        4 if ratio.value > 1.001 else 9
    )  # 1 itself is no ratio of a compliant contact
    keys["podium.contact.period_ratio"] = f"{ratio.value:.{digits}g}"
    keys["podium.contact.kind"] = "plane"
    remarks += (
        "; stiffness of the podium in full contact; a period does not show whether ends"
        " are"
    )
    remarks += " `plane`, which the settlement is for, or `edges`: try both"
    return Identified(estimates, keys, found.misfit, remarks)
