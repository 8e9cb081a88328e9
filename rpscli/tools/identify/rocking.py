"""Restitution and rolling resistance from free rocking after a release.

They follow from times and amplitudes of its swings. The model is read as the
measurement is, so that what the reading does to a swing does not count. Where releases
within the error of measurement part ways, as under buildings that vibrate, means of
ensembles are fitted, and what swings scatter about them, together, counts as error.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.errors import AnalysisError
from rpscli.model.devices import RollingResistance
from rpscli.model.podium import Array, PodiumStructure
from rpscli.records.ground_motion import GroundMotion
from rpscli.tools.identify.estimates import Estimate, Identified, estimate

MOST_SWINGS = 12
FEWEST_OF_DRIFT = 5
"""Swings after the first one with which an offset and a slope of the sensor
are fitted.
"""
DRIFT = 0.1
"""Largest offset, and change of it in all swings, over the amplitude of the first one."""
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
LACKING = 1.4
"""Misfit that noise leaves in one of a hundred, with twenty freedoms."""
WORST_MISFIT = 10.0
"""Of a model that rocks like the structure; what a model lacks
leaves a few times the noise."""
CLOSE = 5e-3
"""Residuals over the last time and the largest amplitude that are a fit whatever the noise:
slow noise of a sensor does not show between samples beside each other."""


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
    """A structure that is let go; q is its rotation, a delay, its loss or e, its lever,
    and, where a drift is fitted, what the sensor adds: an offset and its rate.
    """

    structure: PodiumStructure
    dt: float
    span: float
    noise: float
    side: float
    first: Swing  # begins with the release
    swings: list[Swing]  # all after it that are looked at
    scale: float = 1.0  # of the errors, where residuals are larger than they
    known: dict[bytes, tuple[Array, Array]] = field(default_factory=dict)
    """Times and rotations of models that were followed: the delay and what a sensor
    adds change none of them."""

    @property
    def drifts(self) -> bool:
        """True if there are swings enough to tell a drift from what rocks."""
        return len(self.swings) >= FEWEST_OF_DRIFT

    @property
    def measured(self) -> Array:
        """Times and amplitudes of the swings, in turn."""
        return np.array([value for swing in self.swings for value in swing[:2]])

    @property
    def errors(self) -> Array:
        """Standard errors of what is measured."""
        return self.scale * np.array([v for swing in self.swings for v in swing[2:]])

    @property
    def place(self) -> int | None:
        """Number of the rolling resistance among the devices; None without one."""
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
        time, seen = self._followed(q, release)
        if self.drifts:
            seen = seen + q[-2] + q[-1] * (time + q[1])
        found = swings_of(time, seen, self.noise, 0.25 * SEEN * self.noise)[1:]
        values = self.measured
        values[1::2] = 0.0
        for i, swing in enumerate(found[: len(self.swings)]):
            values[2 * i : 2 * i + 2] = swing.time + q[1], swing.amplitude
        return values

    def _followed(self, q: Array, release: float) -> tuple[Array, Array]:
        """Times and rotations of the model, each once."""
        start = self.side * float(q[0]) * release
        lever = q[3:4] if self.place is not None else q[:0]
        name = np.array([start, q[2], *lever]).tobytes()
        if name not in self.known:
            settings = TimeHistorySettings(
                free_vibration=self.span, initial_rotation=start
            )
            still = GroundMotion(np.zeros(2), self.dt, "still", "still", "")
            trace = time_history(
                self.changed(q), still, settings, with_fixed_base=False
            ).trace
            self.known[name] = trace.time, trace.rotation
        return self.known[name]


def rocking(structure: PodiumStructure, time: Array, rotation: Array) -> Identified:
    """Restitution and lever from rotations (n,) [rad] after a
    release of the unstrained case.
    """
    of = _release(structure, time, rotation)
    starts = _starts(of)
    try:
        best = _best_fit(of, starts)
    except (ValueError, np.linalg.LinAlgError) as error:
        raise AnalysisError(
            f"no structure of this kind rocks in this way: {error}"
        ) from None
    q, _, misfit = best.fit
    model = of.tops(q).reshape(-1, 2)
    _refuse_bad_fit(of, q, starts.bounds, model, misfit * best.scale)

    spread = np.sqrt(max(1.0, misfit) ** 2 * np.diag(best.covariance) + best.valley)
    misfit *= best.scale
    # The scatter of an ensemble is known from so few motions.
    freedoms = ENSEMBLE - 2 if best.ensembles else 2 * len(of.swings) - len(q)
    found = [estimate(*each, freedoms) for each in zip(q, spread, strict=True)]
    ratios = sorted(of.changed(np.array([*q[:2], k, *q[3:]])).restitution for k in
                    np.clip(found[2], *starts.bounds[:, 2]))  # fmt: skip
    e = Estimate(of.changed(q).restitution, ratios[0], ratios[-1])
    return _told(of, q, [e, *found[2:]], model, misfit, ensembles=best.ensembles)


def _release(structure: PodiumStructure, time: Array, rotation: Array) -> _Release:
    """The swings after a release; refuse rotations that do not show enough of them."""
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
    return _Release(structure, dt, span, noise, side, first, swings)


class _Starts(NamedTuple):
    """First values of fits, steps of differences, and least and largest values."""

    values: list[Array]
    steps: Array
    bounds: Array


class _Fit(NamedTuple):
    """Values q, their change by each measurement, and the misfit over the errors."""

    q: Array
    gain: Array
    misfit: float


class _BestFit(NamedTuple):
    """The fit that counts; the valley has squares by which others as good differ."""

    fit: _Fit
    covariance: Array
    valley: Array
    ensembles: bool
    scale: float  # of the errors that the misfit is over


class _Ensemble(NamedTuple):
    """Releases beside one another, as multiples of the one that is looked for."""

    of: _Release
    releases: Array

    def means(self, q: Array) -> tuple[Array, Array]:
        """Of the ensemble, and what the size of the release does not explain."""
        many = np.array([self.of.tops(q, release) for release in self.releases])
        away = (self.releases - 1.0)[:, None]
        left = (
            many
            - many.mean(axis=0)
            - away * ((away * many).sum(axis=0) / (away**2).sum())
        )
        return many.mean(axis=0), left

    def scatter(self, q: Array) -> Array:
        """Covariance of one motion, and of the mean that it is held against."""
        left = self.means(q)[1]
        return left.T @ left / (ENSEMBLE - 2) * (1.0 + 1.0 / ENSEMBLE)


def _best_fit(of: _Release, starts: _Starts) -> _BestFit:
    """The least misfit from all starts; that of ensembles where releases part ways."""
    _, steps, bounds = starts
    errors = of.errors
    fits = [
        _fitted(of.tops, q, steps, bounds, of.measured, errors) for q in starts.values
    ]
    best = min(fits, key=lambda fit: fit.misfit)
    # Loss and lever make up for each other along a valley with many bottoms.
    worst = AS_GOOD * best.misfit**2
    others = [fit.q - best.q for fit in fits if fit.misfit**2 <= worst]
    valley = np.sum(np.square(others), axis=0) / max(len(others) - 1, 1)

    scale = best.misfit if best.misfit > LACKING else 1.0
    if scale > 1.0:  # noise is larger than samples beside each other show
        of = replace(of, scale=scale)
        errors = of.errors
        best = best._replace(misfit=1.0)
    covariance = (best.gain * errors**2) @ best.gain.T
    reach = 3.0 * max(1.0, best.misfit) * math.sqrt(covariance[0, 0]) / best.q[0]
    # A model that does not rock does not depend on its release either.
    releases = 1.0 + max(reach, 1e-9) * np.linspace(-1.0, 1.0, ENSEMBLE)
    ensemble = _Ensemble(of, releases)
    scatter = ensemble.scatter(best.q)
    ensembles = bool(np.any(np.sqrt(np.diag(scatter)) > PARTING * errors))
    if ensembles:
        wide = np.sqrt(errors**2 + np.diag(scatter))
        steps = WIDE * np.sqrt(np.diag(covariance))
        best = _fitted(
            lambda q: ensemble.means(q)[0], best.q, steps, bounds, of.measured, wide
        )
        # Swings that part ways do so together, which the gain adds up.
        gain = best.gain
        covariance = (gain * errors**2) @ gain.T + gain @ scatter @ gain.T
    return _BestFit(best, covariance, valley, ensembles, scale)


def _told(
    of: _Release,
    q: Array,
    found: list[Estimate],
    model: Array,
    misfit: float,
    *,
    ensembles: bool,
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
    remarks = _remarks(of, q, misfit, ensembles=ensembles)
    sensor = {"offset": float(q[-2]), "drift": float(q[-1])} if of.drifts else None
    return Identified(
        estimates, keys, misfit, remarks, ensembles, residuals, sensor=sensor
    )


def _remarks(of: _Release, q: Array, misfit: float, *, ensembles: bool) -> str:
    """Remarks that a reader of the values has to know."""
    remarks = f"residuals are {misfit:.3g} times what noise alone would leave"
    if misfit > LACKING:
        remarks += (
            ": the model lacks something, such as rolling resistance, or noise is slower"
            " than samples show, as behind a filter; intervals include that"
        )
    if of.drifts:
        remarks += (
            f"; an offset of {1e3 * q[-2]:.3g} mrad and a drift of {1e3 * q[-1]:.3g}"
            " mrad/s of the sensor were fitted with them"
        )
    else:
        remarks += (
            f"; fewer than {FEWEST_OF_DRIFT + 1} swings: a drift of the sensor is not"
            " fitted with them"
        )
    if of.place is not None:
        remarks += (
            "; loss and lever make up for each other: intervals include fits as good as"
            " this one that were found from other starts, and not those that were not"
        )
    if ensembles:
        remarks += "; neighbouring releases diverge, so means of ensembles were fitted"
    return remarks


def _refuse_bad_fit(
    of: _Release, q: Array, bounds: Array, model: Array, misfit: float
) -> None:
    """Refuse the end of least squares as an answer if the model does not rock like the
    structure.
    """
    away = f"{misfit:.3g} times the noise from those measured"
    missed = model - of.measured.reshape(-1, 2)
    close = np.sqrt(np.mean(missed**2, axis=0)) < CLOSE * model.max(axis=0)
    if not misfit <= WORST_MISFIT and not close.all():
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


def _starts(of: _Release) -> _Starts:
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
    first = of.first
    late = of.swings[0].time
    if of.drifts:
        far = DRIFT * of.first.amplitude
        span = of.swings[-1].time
        rows.append((0.0, 1e-3 * far, -far, far))
        rows.append((0.0, 1e-3 * far / span, -far / span, far / span))
    first_rows = [(first.amplitude, 2e-3 * first.amplitude, 0.0, s.critical_rotation),
                  (0.0, 1e-3 * late, -late, late)]  # fmt: skip
    q, steps, low, high = np.array([*first_rows, *rows]).T
    starts = [q]
    if of.place is not None:
        own = float(law.kind == "value")  # which is 1 where nothing is lost
        starts = [np.array([*q[:2], own + part * (q[2] - own), lever * b.half_width, *q[4:]])
                  for part, lever in SHARED]  # fmt: skip
    return _Starts(starts, steps, np.array([low, high]))


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
) -> _Fit:  # fmt: skip
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
    return _Fit(q, inverse @ (J * steps).T / errors, math.sqrt(variance))
