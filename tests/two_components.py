"""Structures and histories under two horizontal components, for the tests of the kernel."""

from dataclasses import dataclass

import numpy as np
from paper_structures import Array, ground, part

from rpscli.analyses.kernels.history import (
    HistoryRequest,
    follow,
    longest_history,
    run_of,
)
from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.bearing import Bearing
from rpscli.model.contact import Contact
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import (
    RayleighDamping,
    Superstructure,
    profile_stiffnesses,
)
from rpscli.physics.state import PASS, RECONTACT, Record
from rpscli.records.ground_motion import MotionComponents

COLUMNS_MASS = 1e4
ROOM = 20_000
"""Events that a log has room for."""


def frame(
    storeys=0,
    eta=0.0,
    period=0.3,
    *,
    gamma=10.0,
    tan_alpha=0.15,
    tan_wedge=0.0,
    rho=0.0,
    contact_time=0.0,
    factor=1.0,
    loss=1.0,
    axial=np.nan,
    period_y=0.0,
    devices=(),
    contact=None,
):
    """R 1.5 m, equal floors on uniform storeys, 5 % in modes 1 and 2, the flexible law."""
    given = {} if np.isnan(axial) else {"inertia_ratio_axial": axial}
    bearing = Bearing(1.5, tan_alpha, max(tan_wedge, tan_alpha), rho, **given)

    def building(seconds):
        masses = np.full(storeys, COLUMNS_MASS * gamma * eta / storeys)
        stiffnesses = profile_stiffnesses(masses, seconds, "uniform")
        return Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))

    return PodiumStructure(
        bearing,
        COLUMNS_MASS,
        COLUMNS_MASS * gamma,
        building(period) if storeys else None,
        ImpactLaw("flexible", factor=factor, loss=loss, contact_time=contact_time),
        superstructure_y=building(period_y) if period_y else None,
        devices=devices,
        contact=contact or Contact(),
    )


def pair(x, y, dt, up=None):
    """Both horizontal components, and perhaps the vertical one [m/s2]."""
    vertical = None if up is None else ground(up, dt)
    return MotionComponents(ground(x, dt), vertical, y=ground(y, dt))


def part_of_pair(given, record):
    """A far-field pair of FEMA P695 times `scale` from `t0` on for `T` seconds, from rest."""
    x, y = (
        part(
            record(f"farfield/{given['pair']}/{way}"),
            given["t0"],
            given["T"],
            given["scale"],
        )
        for way in "ab"
    )
    at_rest = np.arange(x.npts) > 0
    return pair(at_rest * x.acceleration, at_rest * y.acceleration, x.dt)


def two_pulses(seconds=6.0, dt=0.01):
    """(2, samples) at right angles, which overlap [m/s2]."""
    t = np.arange(0.0, seconds, dt)

    def pulse(period, middle):
        z = (np.pi * (t - middle) / period) ** 2
        return np.asarray((1.0 - 2.0 * z) * np.exp(-z))

    return np.array([3.5 * pulse(1.0, 1.2), 2.8 * pulse(0.7, 1.5)])


@dataclass(frozen=True, eq=False)
class History:
    """What one history leaves: its result, samples, floors and events."""

    left: Record
    samples: Record
    floors: Array
    log: Record

    @property
    def tilt(self):
        """X + iY at the samples [rad]."""
        return np.asarray(self.samples.theta * np.exp(1j * self.samples.azimuth))

    @property
    def residual(self):
        """Energy left over, over the input."""
        left = self.left
        spent = left.energy_damped + left.energy_lost + left.energy_stored
        spent += left.device_energy.sum() + left.device_stored.sum() + left.bed_energy
        spent += left.energy_upwards + left.energy_yielded
        return float((left.energy_input - spent) / left.energy_input)

    def of_kind(self, kind):
        """Events of a kind."""
        return self.log[self.log.kind == kind]

    @property
    def passes(self):
        """The closest approaches."""
        return self.of_kind(PASS)

    @property
    def recontacts(self):
        """When it came to rest."""
        return self.of_kind(RECONTACT)


def followed(structure, motion, settings=None, turning=0.0, finer=1, uplift_tilt=None):
    """A history alone, of its record unless the settings say more; perhaps turning at its start,
    and with uplifts that begin at another tilt [rad].
    """
    settings = settings or TimeHistorySettings(free_vibration=0.0)
    systems = stacked_systems([(structure, settings)], pairs=True).copy()
    systems["initial_turning"] = turning
    if uplift_tilt is not None:
        systems["uplift_tilt"] = uplift_tilt
    rows = longest_history(structure, settings, motion) * finer
    run = run_of(
        systems,
        [motion],
        [HistoryRequest(0, 0)],
        pairs=True,
        rows=rows,
        events=ROOM,
        finer=finer,
    )
    follow(run, lanes=1)
    left, output = run.results[0], run.output
    kept = int(left.intervals) * finer + 1
    return History(
        left, output.samples[:kept], output.floors[:kept], output.log[: left.events.sum()]
    )


def released(structure, tilt, across, seconds, *, accuracy=1.0, dt=0.01):
    """Let go at (tilt, 0) with (X', Y') = (0, across), on a ground at rest."""
    settings = TimeHistorySettings(
        free_vibration=seconds - dt, accuracy=accuracy, initial_rotation=tilt
    )
    still = np.zeros(2)
    return followed(structure, pair(still, still, dt), settings, across / tilt)
