"""One history of 40 s at 200 Hz: what others would run, and we.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.histories``. All is
measured in one run on one core, so that the ratios mean something; accuracy stands beside speed.

The peer is heyoka's Taylor integrators: full contact by one, uplifted motion by another.
The equations are written once more (Theory, sections 1 to 4), mirrored: `x = |theta|`, and floors
and ground are multiplied by the side of the tilt, so that one right-hand side serves both sides.
The ground acceleration is linear between samples, so the integrator stops at each of them and gets
two new parameters; constants of the phase are parameters too. theta = 0 and theta = beta are its
terminal events. Nothing of the program's kernels is used.
"""

import importlib
import math
import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from rpscli.analyses.demand import DemandRequest, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import (
    RayleighDamping,
    Superstructure,
    profile_stiffnesses,
)
from rpscli.physics.state import IMPACT, LANES
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_record

NEGLIGIBLE = 1e-6
"""An excursion below this times alpha is not followed: the podium locks."""

ACROSS, SLOPE, P, Q, CURVE, SHIFT, SQUARE, LEVEL = range(8)  # parameters
IMPACT_EVENT, ARC_END = -1, -2
"""What a step returns where it ended at a terminal event: -1 less the event's number."""
ASIDE = 1e-14
"""Where rocking begins: of a root at the start and one behind it, heyoka sees only the first."""
GOOD = (-4294967297, -4294967299)
"""What it returns else: the step of its own choice, or cut at the sample."""
UPLIFTS = {-1: 1.0, -2: -1.0}
"""Side of the uplift for the number of the event that ends full contact."""


class PeerHistory(NamedTuple):
    """What a history says."""

    max_rotation: float
    impacts: int


def building_of(podium):
    """The building and its coefficients of Rayleigh's damping."""
    building = podium.superstructure
    assert building is not None
    assert isinstance(building.damping, RayleighDamping)
    return building, *building.damping.coefficients(building.frequencies)


class Landing:
    """Impacts of one podium, with the right-hand side at x = 0 prepared: it is linear there."""

    def __init__(self, podium):
        (building, a0, a1), R = building_of(podium), podium.bearing.semi_diagonal
        n, gamma, eta, alpha = (
            podium.storeys,
            podium.gamma,
            podium.eta,
            podium.bearing.alpha,
        )
        sine, cosine = math.sin(alpha), math.cos(alpha)
        self.storeys, self.restitution = n, podium.restitution
        self.beam = 2.0 * R * cosine
        self.jump = self.beam * (1.0 - podium.restitution)
        self.left_out = 2.0 / (1.0 + podium.restitution) * self.beam  # (3.5)
        self.negligible = 2.0 * NEGLIGIBLE * alpha
        curve = podium.bearing.rolling.c
        A = podium.bearing.inertia_ratio + 4.0 * gamma + 4.0 * gamma * eta * sine**2
        D = sine * ((1.0 + 4.0 * gamma) * curve + 4.0 * gamma * eta * (curve - cosine))
        restoring = sine * podium.gravity / R * (1.0 + 2.0 * gamma + 2.0 * gamma * eta)
        self.restoring, self.turning = restoring / A, D / A
        self.ground = cosine * (1.0 + 2.0 * gamma) / R / A
        shear = np.zeros(2 * n + 2)  # V = shear . y, beam at 2 R cos(alpha) x'
        shear[1], shear[n + 2 :] = building.stiffnesses[0], a0 * building.masses
        shear[n + 2] += a1 * building.stiffnesses[0]
        shear[n + 1] = -self.beam * shear[n + 2 :].sum()
        self.back = 0.0
        """What decelerates the tilt behind the last impact [rad/s2]."""
        self.building = 2.0 * cosine / (podium.columns_mass * R) / A * shear

    def land(self, y, across):
        """Impact: change the mirrored state to that of the other side; whether the podium locks.

        `across` is the ground acceleration as mirrored on the side that is left.
        """
        n = self.storeys
        rate = -self.restitution * y[n + 1]
        y[n + 2 :] -= self.jump * y[n + 1]
        np.negative(y, y)
        y[0], y[n + 1] = 0.0, rate
        back = self.restoring + self.turning * rate * rate - self.ground * across
        back -= self.building @ y
        self.back = float(back)
        stays = back > 0.0 and rate * rate < self.negligible * back
        if stays:
            y[n + 2 :] += self.left_out * rate
        return bool(stays)


def equations(podium):
    """The mirrored equations of motion as heyoka's expressions."""
    import heyoka as hy

    building, a0, a1 = building_of(podium)
    masses, stiffnesses, n = building.masses, building.stiffnesses, podium.storeys
    R, gamma, eta = podium.bearing.semi_diagonal, podium.gamma, podium.eta
    names = ["x", *(f"u{i}" for i in range(n)), "w", *(f"v{i}" for i in range(n))]
    y = hy.make_vars(*names)
    x, u, w, v = y[0], y[1 : n + 1], y[n + 1], y[n + 2 :]
    across = hy.par[ACROSS] + hy.par[SLOPE] * hy.time
    p, q, c = hy.par[P], hy.par[Q], hy.par[CURVE]
    cosine, sine = hy.cos(x), hy.sin(x)
    B = p * cosine + q * sine
    rise = p * sine - q * cosine
    C = c + rise
    S = hy.par[SQUARE] + 2.0 * c * C
    beam = 2.0 * R * (hy.par[SHIFT] + c * x - q * sine - p * cosine)
    beam_rate = 2.0 * R * C * w
    below, rates_below = [beam, *u[:-1]], [beam_rate, *v[:-1]]
    shears = [
        stiffnesses[i] * (u[i] - below[i]) + stiffnesses[i] * a1 * (v[i] - rates_below[i])
        for i in range(n)
    ]
    drags = [a0 * (v[i] - beam_rate) for i in range(n)]
    V = hy.sum([shears[0], *(masses[i] * drags[i] for i in range(n))])
    A = (
        podium.bearing.inertia_ratio
        - 1.0
        + (1.0 + 4.0 * gamma) * S
        + 4.0 * gamma * eta * B * B
    )
    D = B * ((1.0 + 4.0 * gamma) * c - 4.0 * gamma * eta * rise)
    weight = podium.gravity / R * (1.0 + 2.0 * gamma + 2.0 * gamma * eta) * B
    push = (1.0 + 2.0 * gamma) / R * across - 2.0 / (podium.columns_mass * R) * V
    pulls = [shears[i] - shears[i + 1] if i + 1 < n else shears[i] for i in range(n)]
    bends = [-(1.0 / masses[i]) * pulls[i] - drags[i] - across for i in range(n)]
    speeds = [w, *v]
    return list(
        zip(y, [*speeds, -(weight + C * push + D * w * w) / A, *bends], strict=True)
    )


class HeyokaStanding:
    """A compiled integrator of the building on a fixed base, with uplift as its terminal event."""

    def __init__(self, podium, dt, tol):
        import heyoka as hy

        (building, _, _), n, self.dt = building_of(podium), podium.storeys, dt
        forces = np.hstack([building.stiffness_matrix, building.damping_matrix])
        flow = -forces / building.masses[:, None]
        gamma, eta = podium.gamma, podium.eta
        on_beam = 2.0 * gamma * eta / building.masses.sum() * forces.sum(axis=0)
        lift = podium.uplift_acceleration * (1.0 + 2.0 * gamma * (1.0 + eta))
        names = [f"{kind}{i}" for kind in "uv" for i in range(n)]
        z = hy.make_vars(*names)
        across = hy.par[ACROSS] + hy.par[SLOPE] * hy.time

        def weighted(row):
            return hy.sum([float(w) * x for w, x in zip(row, z, strict=True) if w != 0.0])

        rates = [*z[n:], *(weighted(flow[i]) - across for i in range(n))]
        push = weighted(on_beam) - (1.0 + 2.0 * gamma) * across
        self.integrator = hy.taylor_adaptive(
            list(zip(z, rates, strict=True)),
            np.zeros(2 * n),
            pars=np.zeros(2),
            tol=tol,
            t_events=[
                hy.t_event(lift - sign * push, direction=hy.event_direction.negative)
                for sign in UPLIFTS.values()
            ],
        )

    def stand(self, z, slopes, intercepts, interval, after):
        """From `after` seconds into an interval to the next uplift, or to the record's end.

        Of a record of given slopes and values at time zero. Returns the interval, the time into it
        and the side of uplift, 0 at the end.
        """
        ta, dt = self.integrator, self.dt
        step, pars = ta.step, ta.pars
        ta.state[:] = z
        ta.time = interval * dt + after
        ta.reset_cooldowns()
        left = dt - after
        for i in range(interval, len(slopes)):
            pars[ACROSS], pars[SLOPE] = intercepts[i], slopes[i]
            while left > 0.0:
                outcome, h = step(left)
                left -= h
                if left > 0.0 and (side := UPLIFTS.get(int(outcome), 0.0)) != 0.0:
                    z[:] = ta.state
                    return i, dt - left, side
            left = dt
        z[:] = ta.state
        return len(slopes), 0.0, 0.0


class HeyokaRocking:
    """Compiled integrators for one podium."""

    def __init__(self, structure, dt, tol=1e-4):
        import heyoka as hy

        podium = self.podium = structure
        self.rolling, self.rocking = structure.bearing.rolling, structure.bearing.rocking
        self.level, self.limit = (
            structure.bearing.beta,
            2.0 * structure.bearing.critical_rotation,
        )
        self.dt, self.landing = dt, Landing(podium)
        self.standing = HeyokaStanding(podium, dt, tol)
        x = hy.make_vars("x")
        self.integrator = hy.taylor_adaptive(
            equations(podium),
            np.zeros(2 * podium.storeys + 2),
            pars=np.zeros(8),
            tol=tol,
            t_events=[
                # heyoka's own cooldown grows with the tolerance and hides the next impact
                hy.t_event(x, direction=hy.event_direction.negative, cooldown=0.0),
                hy.t_event(x - hy.par[LEVEL], cooldown=0.0),
            ],
        )
        self.integrator.pars[LEVEL] = self.level
        self._peak, self._impacts = 0.0, 0
        self._slopes = []
        self._intercepts = []

    def history(self, record):
        """One history from rest to the end of the record; infinite rotation if it overturns."""
        n, dt = self.podium.storeys, self.dt
        slopes = np.diff(record) / dt
        self._slopes = slopes.tolist()
        self._intercepts = (record[:-1] - slopes * np.arange(len(slopes)) * dt).tolist()
        self._peak, self._impacts = 0.0, 0
        y, z = self.integrator.state, np.zeros(2 * n)
        interval, after = 0, 0.0
        while interval < len(slopes):
            interval, after, side = self.standing.stand(
                z, self._slopes, self._intercepts, interval, after
            )
            if side == 0.0:
                break
            y[0], y[n + 1] = ASIDE, 0.0
            y[1 : n + 1], y[n + 2 :] = side * z[:n], side * z[n:]
            interval, after, side = self._fly(interval, after, side)
            z[:n] = side * y[1 : n + 1]
            z[n:] = side * (y[n + 2 :] - self.landing.beam * y[n + 1])
        return PeerHistory(self._peak, self._impacts)

    def _fly(self, interval, after, side):
        """From an uplift to re-contact: interval, time into it, and side of the state."""
        ta, n, dt = self.integrator, self.podium.storeys, self.dt
        step, land = ta.step, self.landing.land
        y, pars, slopes, intercepts = ta.state, ta.pars, self._slopes, self._intercepts
        value = y.item  # Python's own floats: numpy's would double the time of this loop
        self._enter(self.rolling)
        ta.time = interval * dt + after
        ta.reset_cooldowns()
        peak, left, before, w = self._peak, dt - after, 0.0, 0.0
        for i in range(interval, len(slopes)):
            across, slope = side * intercepts[i], side * slopes[i]
            pars[ACROSS], pars[SLOPE] = across, slope
            while left > 0.0:
                outcome, h = step(left)
                left -= h
                x, w = value(0), value(n + 1)
                if x > peak:  # noqa: PLR1730 -- max takes longer than the step's bookkeeping
                    peak = x
                if w <= 0.0 < before and x + h * before > peak:
                    peak = max(peak, self._turning_point(h))
                before = w
                if left == 0.0:
                    break  # at the sample: to ask what ended the step takes as long as the step
                code = int(outcome)
                if code == IMPACT_EVENT:
                    self._impacts += 1
                    stays = land(y, across + slope * ta.time)
                    side, across, slope, before = -side, -across, -slope, value(n + 1)
                    if stays:
                        self._peak = float(peak)
                        return i, dt - left, side
                    y[0], pars[ACROSS], pars[SLOPE] = ASIDE, across, slope
                elif code == ARC_END:
                    self._enter(self.rocking if w > 0.0 else self.rolling)
                    y[0] = self.level + (ASIDE if w > 0.0 else -ASIDE)
                else:
                    refuse_failure(code)
            left = dt
            if y[0] > self.limit:
                peak = np.inf
                break
        self._peak = float(peak)
        return len(slopes), 0.0, side

    def _enter(self, phase):
        pars, (p, q, c, u0, _) = self.integrator.pars, phase
        pars[P], pars[Q], pars[CURVE], pars[SHIFT] = p, q, c, u0
        pars[SQUARE] = p * p + q * q - c * c

    def _turning_point(self, h):
        """The tilt where its rate is zero within the last step, by its dense output."""
        ta, n = self.integrator, self.podium.storeys
        low, high = ta.time - h, ta.time
        for _ in range(30):
            middle = 0.5 * (low + high)
            if ta.update_d_output(middle)[n + 1] > 0.0:
                low = middle
            else:
                high = middle
        return float(ta.update_d_output(low)[0])


def refuse_failure(code):
    """Stop if a step did not end well."""
    if code not in GOOD:
        raise RuntimeError(f"heyoka stopped with {code}")


RECORDS = 64
TIMES = 10
"""Each record is followed so often in lanes: of few histories, lanes are idle near the end."""
STEP = 0.005
TIGHT = 8.0
"""Accuracy of the reference."""
ALONE = 1_000_000_000
"""Histories from which on lanes would be worth while: never."""
CLOSE = 1e-4
"""Relative error in max|theta| that counts as the same history: single ones are chaotic."""
COLUMNS = (
    "storeys", "program", "over rps, one", "over rps, lanes", "ms/history", "max theta to 1e-4",
    "impacts",
)  # fmt: skip
_CONSOLE = Console(width=132, highlight=False)


def installed(module):
    """Whether a peer can be imported; says so at once if not."""
    try:
        importlib.import_module(module)
    except (
        ImportError,
        OSError,
        RuntimeError,
    ) as error:  # of system libraries that are missing
        _CONSOLE.print(
            f"{module} is left out: {error} (pip install -e '.[bench]' brings all)"
        )
        return False
    return True


def structure(storeys):
    """The paper's building: T_1 = n/10 s, gamma = 10, eta = n, the rigid law."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10, "sine")
    building = Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))
    return PodiumStructure(
        Bearing(1.5, 0.15, 0.30, 0.5), 2e4, 2e5, building, ImpactLaw("rigid")
    )


@dataclass(frozen=True)
class Contest:
    """One program: seconds, largest rotation and impacts of each of its records."""

    name: str
    times: list[float]
    rotations: list[float]
    impacts: list[int]

    def close(self, exact, limit):
        """Share of those that agree with a reference, whose overturned ones are left out."""
        standing = np.array(exact) < limit
        off = np.abs(np.array(self.rotations) / exact - 1.0)[standing]
        return f"{np.mean(off < CLOSE):.0%} of {off.size}" if off.size else "none"


def run(name, program, records):
    """Each record by itself, the least time of five rounds through all of them."""
    program(records[0])  # may compile
    found = {}
    times = [np.inf] * len(records)
    for _ in range(5):
        for i, record in enumerate(records):
            start = time.perf_counter()
            found[i] = program(record)
            times[i] = min(times[i], time.perf_counter() - start)
    answers = [found[i] for i in range(len(records))]
    return Contest(
        name, times, [a.max_rotation for a in answers], [a.impacts for a in answers]
    )


def contests(building, records, *, heyoka):
    """A peer; one history of ours with its samples, one without, and in lanes."""

    def requests(chosen):
        # without free vibration every history is as long as its record
        settings = TimeHistorySettings(free_vibration=0.0)
        return [DemandRequest(building, MotionComponents(r), settings) for r in chosen]

    def sampled(record):
        (request,) = requests([record])
        history = sampled_history(building, request.motion, request.settings).history
        return PeerHistory(float(history.max_theta), int(history.events[IMPACT]))

    def alone(record):
        (found,) = demands(requests([record]), worth_lanes=ALONE)
        return PeerHistory(found.max_rotation, found.impacts)

    if heyoka:
        peer = HeyokaRocking(building, STEP)
        yield run("heyoka, tol 1e-4", lambda r: peer.history(r.acceleration), records)
    yield run("rps, one with all samples", sampled, records)
    yield run("rps, one", alone, records)
    often = requests([*records] * TIMES)
    spent = []
    for _ in range(4):
        start = time.perf_counter()
        found = demands(often, worth_lanes=1)[: len(records)]
        spent.append(time.perf_counter() - start)
    rotations, impacts = [d.max_rotation for d in found], [d.impacts for d in found]
    each = [min(spent) / len(often)] * len(records)
    yield Contest(f"rps, {len(often)} in {LANES} lanes", each, rotations, impacts)


def rows(storeys, records, *, heyoka):
    """All lines for one building."""
    building = structure(storeys)
    settings = TimeHistorySettings(free_vibration=0.0, accuracy=TIGHT)
    limit = settings.overturning_limit * building.critical_rotation
    tight = demands(
        [DemandRequest(building, MotionComponents(r), settings) for r in records]
    )
    exact = [d.max_rotation for d in tight]
    found = [*contests(building, records, heyoka=heyoka)]
    one, lanes = (float(np.sum(c.times)) for c in found[-2:])
    for c in found:
        spent = float(np.sum(c.times))
        numbers = (
            f"{z:.3g}"
            for z in (spent / one, spent / lanes, 1e3 * float(np.mean(c.times)))
        )
        impacts = f"{np.mean(c.impacts):.0f}"
        yield [str(storeys), c.name, *numbers, c.close(exact, limit), impacts]


def main():
    """Measure, and print one table that Markdown understands."""
    heyoka = installed("heyoka")
    sources = (
        f"synthetic:?pga=0.5g&duration=40&dt={STEP}&seed={i}"
        for i in range(1, RECORDS + 1)
    )
    records = [load_record(source) for source in sources]
    title = "One history of 40 s at 200 Hz on one core; ratios: times that rps is faster"
    table = Table(*COLUMNS, title=title, title_justify="left", box=box.MARKDOWN)
    for storeys in (3, 9):
        for row in rows(storeys, records, heyoka=heyoka):
            table.add_row(*row)
    _CONSOLE.print(table)


if __name__ == "__main__":
    main()
