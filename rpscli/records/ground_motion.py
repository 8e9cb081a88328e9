"""Ground motions, which every reader, pulse and set returns, and their components."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError, is_number, require_fields, require_kind, told
from rpscli.records.directions import direction_in
from rpscli.shown import Frozen, Shown, frozen, with_unit

if TYPE_CHECKING:
    from rpscli.records.measures import Measure, Of


class Recording(NamedTuple):
    """An earthquake and a station; empty or None where the source does not say.

    `event` is the earthquake with its year, `distance` the closest one to the rupture
    [m], `vs30` [m/s] that of the ground, `usable_period` the longest that the filters of
    the record leave [s], `pulse` whether it was found to have a velocity pulse, `origin`
    the time of the earthquake, `direction` that of the component, and `start` that of its
    first sample, as the source states.
    """

    event: str = ""
    station: str = ""
    magnitude: float | None = None
    distance: float | None = None
    vs30: float | None = None
    usable_period: float | None = None
    pulse: bool | None = None
    origin: str = ""
    direction: str = ""
    start: str = ""

    @property
    def is_vertical(self) -> bool:
        """True if the component is stated to be a vertical one."""
        direction = direction_in(self.direction)
        return direction is not None and direction.vertical

    @property
    def in_borehole(self) -> bool:
        """True if the instrument is stated to be below the ground, or in a building."""
        return _BOREHOLE.search(self.station) is not None


_BOREHOLE = re.compile(
    r"(?:bore-?hole|down-?hole)[\W\d]*m?$|\bdepth\b|\bin a building$", re.IGNORECASE
)

UNKNOWN = Recording()

LEAST = 0.25  # factors between these are usual
MOST = 4.0


def scale_doubts(name: str, factor: float) -> tuple[str, ...]:
    """A warning for a record under a factor that is not usual;
    its sign does not matter.
    """
    doubt = (
        f"{name} is scaled by {factor:.4g}, beyond the usual {LEAST:g} to {MOST:g}:"
        " records of another size differ in more than their amplitude"
    )
    return () if LEAST <= abs(factor) <= MOST else (doubt,)


@dataclass(frozen=True, eq=False, repr=False)
class GroundMotion(Shown):
    """Ground acceleration, sampled uniformly from t = 0 and linear between the samples.

    Positive acceleration is the direction that the record's own sensor calls
    positive. Before the first sample the ground is at rest; after the last one
    its acceleration is zero.

    Parameters
    ----------
    acceleration : array, shape (npts,) [m/s2]
        Copied, then kept contiguous and read-only.
    dt : float [s]
        Sampling interval.
    name, source : str
        Short, good for titles and file names; the source as the user wrote it.
    format, description : str
        What the samples were read from or made by, such as "PEER AT2" or "pulse"; what
        the reader understood: event, station, units.
    warnings : tuple of str
        What the reader wants a human to look at.
    recording : Recording
        Earthquake and station, as far as the source tells them.

    Raises
    ------
    RecordError
        If there are fewer than two samples, one of them is not finite or masked,
        or `dt` is not positive.

    Examples
    --------
    >>> motion = GroundMotion(np.array([0.0, 2.0, -3.0]), dt=0.5)
    >>> motion.npts, motion.duration, motion.pga
    (3, 1.0, 3.0)
    >>> GroundMotion(np.array([0.0, 2.0]), 0.5, "m", "m.at2", "PEER AT2").source
    'm.at2'
    """

    acceleration: NDArray[np.float64]
    dt: float
    name: str = "motion"
    source: str = "array"
    format: str = "array"
    description: str = ""
    warnings: tuple[str, ...] = ()
    recording: Recording = UNKNOWN

    def __post_init__(self) -> None:
        values = np.zeros(0)  # of what is no list
        fault = ""
        with suppress(TypeError, ValueError, OverflowError):
            values = np.array(self.acceleration, dtype=np.float64, order="C")
        if np.ma.is_masked(self.acceleration):
            first = int(np.argmax(np.ma.getmaskarray(self.acceleration)))
            fault = f"sample {first + 1} is masked, a gap; fill it, or cut the record"
        elif values.ndim != 1 or values.size < 2:
            fault = "a ground motion needs one row of at least 2 samples, found the shape"
            fault += f" {values.shape}"
        elif not np.isfinite(values).all():
            first = int(np.argmin(np.isfinite(values)))
            fault = f"sample {first + 1} is {values[first]}, not finite"
        elif not (is_number(self.dt) and self.dt > 0.0):
            fault = f"dt = {self.dt} s must be positive and finite"
        if fault:
            raise RecordError(f"{self.source}: {fault}")
        require_fields(self, RecordError)
        object.__setattr__(self, "acceleration", frozen(values))
        object.__setattr__(self, "dt", float(self.dt))

    def facts(self) -> dict[str, object]:
        """Where it comes from, and how strong and long it is."""
        return {
            "name": self.name,
            "pga": with_unit(self.pga, "m/s2"),
            "duration": with_unit(self.duration, "s"),
            "dt": with_unit(self.dt, "s"),
            "npts": self.npts,
            "format": self.format,
            "description": self.description,
        }

    @property
    def npts(self) -> int:
        """Number of samples."""
        return int(self.acceleration.size)

    @property
    def duration(self) -> float:
        """Time of the last sample [s]: (npts - 1) dt."""
        return (self.npts - 1) * self.dt

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the samples, shape (npts,) [s], from zero."""
        return frozen(np.arange(self.npts, dtype=np.float64) * self.dt)

    @cached_property
    def pga(self) -> float:
        """Peak ground acceleration [m/s2], unsigned."""
        return float(np.max(np.abs(self.acceleration)))

    @cached_property
    def digest(self) -> str:
        """SHA-256 (hexadecimal) of `dt` and the samples: same digest, same motion."""
        digest = hashlib.sha256(np.array([self.dt], dtype="<f8").tobytes())
        digest.update(self.acceleration.astype("<f8").tobytes())
        return digest.hexdigest()

    def resampled(self, dt: float) -> GroundMotion:
        """The motion, linear between its samples, sampled every `dt` seconds.

        A step that is a whole part of the old one changes nothing but the number of
        samples; a longer one, up to the duration, loses what is between, and says so.

        Raises a RecordError if the step is not positive, or longer than the motion.

        >>> motion = GroundMotion(np.array([0.0, 2.0, -2.0]), 0.5)
        >>> motion.resampled(0.25).acceleration.tolist()
        [0.0, 1.0, 2.0, 0.0, -2.0]
        """
        if not (np.isfinite(dt) and 0.0 < dt <= self.duration):
            raise RecordError(
                f"{self.source}: cannot be sampled every {dt:g} s; give a step above 0"
                f" and up to its duration, {self.duration:g} s"
            )
        # A sample that rounding puts just behind the end is the last one.
        count = int(np.floor(self.duration / dt * (1.0 + 1e-12))) + 1
        values = np.interp(
            np.minimum(np.arange(count) * dt, self.duration), self.time, self.acceleration
        )
        text = f"resampled from {self.dt:g} s"
        made = self.noted(text, acceleration=values, dt=dt)
        if dt <= self.dt * (1.0 + 1e-12):
            return made
        lost = f"{text} to {dt:g} s: what was between the samples is lost"
        return replace(made, warnings=(*self.warnings, lost))

    def finer(self, parts: int) -> GroundMotion:
        """The motion with that many even parts in each sampling interval."""
        at = np.arange((self.npts - 1) * parts + 1) / parts
        values = np.interp(at, np.arange(self.npts), self.acceleration)
        return replace(self, acceleration=values, dt=self.dt / parts)

    def scaled(self, factor: float) -> GroundMotion:
        """The motion times `factor`, with a description that says so."""
        if not is_number(factor):
            raise RecordError(
                f"{self.source}: the factor {told(factor)} must be a finite number"
            )
        return self.noted(
            f"scaled by {factor:g}", acceleration=self.acceleration * factor
        )

    def noted(self, note: str, **changed: Any) -> GroundMotion:
        """A changed motion, with a note on that behind its description."""
        return replace(
            self, description=f"{self.description}; {note}".lstrip("; "), **changed
        )

    def scaled_to(
        self,
        measure: Measure,
        value: float,
        *,
        period: float | None = None,
        damping: float = 0.05,
        second: GroundMotion | None = None,
        of: Of = "rotd50",
    ) -> GroundMotion:
        """The motion, scaled so that a measure of it, or of its pair, has a value.

        Parameters
        ----------
        measure : str
            ``PGA``, ``PGV``, ``PGD``, ``Sa``, ``AvgSa``, ``FIV3``, ``Housner``,
            ``Arias``, ``CAV``, or one that another package adds.
        value, period, damping : float [SI, s, share of critical damping]
            What it is to be; of Sa, AvgSa and FIV3, which need it;
            of Sa, AvgSa and Housner.
        second : GroundMotion, optional
            The other horizontal component: the measure is that of the
            pair, and so is the factor.
        of : str
            What of a pair: ``rotd50``, ``rotd100``, ``geomean``, or ``larger``.

        Raises a RecordError if there is no such measure, the period
        is missing, or it is zero.

        >>> GroundMotion(np.array([0.0, 2.0, -3.0]), dt=0.5).scaled_to("PGA", 1.5).pga
        1.5
        """
        from rpscli.records import measures  # which measure motions

        if fault := measures.fault_of_aim(measure, value, period):
            raise RecordError(f"{self.source}: {fault}")
        if second is None:
            unscaled = measures.measured(self, measure, period, damping)
        else:
            unscaled = measures.pair_measure(self, second, measure, of, period, damping)
        return self.scaled(measures.factor_to(value, unscaled, measure, self.source))


@dataclass(frozen=True, eq=False)
class MotionComponents(Frozen):
    """The components of one ground motion: horizontal, and vertical where that is known.

    All have the same time step; shorter ones go on as zero.

    Parameters
    ----------
    horizontal : GroundMotion
        Along x, where there is a second one.
    vertical, y : GroundMotion, optional
        Positive upwards; the second horizontal component.
    scale, scaled_to : float, str
        By which all were multiplied since they were read; what that aimed at, in words.

    Raises
    ------
    RecordError
        If the time steps differ.

    >>> along = GroundMotion(np.array([0.0, 2.0, -3.0]), 0.5, "x", "x.at2", "PEER AT2")
    >>> up = GroundMotion(np.array([1.0, 2.0]), 0.5, "z", "z.at2", "PEER AT2")
    >>> MotionComponents(along, up).samples.tolist()
    [[0.0, 2.0, -3.0], [1.0, 2.0, 0.0]]
    """

    horizontal: GroundMotion
    vertical: GroundMotion | None = None
    scale: float = 1.0
    scaled_to: str = ""
    y: GroundMotion | None = None

    def __post_init__(self) -> None:
        for name, motion in {"horizontal": self.horizontal, **self.named}.items():
            require_kind(motion, GroundMotion, name, "load_record(...) gives a motion")
            require_one_step(self.horizontal, motion, name)
        require_fields(self, RecordError)

    @property
    def named(self) -> dict[str, GroundMotion]:
        """Those that there are, by their names in documents,
        in the order of `samples`.
        """
        every = {"horizontal": self.horizontal, "y": self.y, "vertical": self.vertical}
        return {name: motion for name, motion in every.items() if motion is not None}

    @property
    def dt(self) -> float:
        """Sampling interval of all [s]."""
        return self.horizontal.dt

    @property
    def npts(self) -> int:
        """Samples of the longest."""
        return max(motion.npts for motion in self.named.values())

    @property
    def duration(self) -> float:
        """Time of its last sample [s]."""
        return (self.npts - 1) * self.dt

    @cached_property
    def samples(self) -> NDArray[np.float64]:
        """Accelerations (components, npts) [m/s2]; shorter ones go on as zero."""
        motions = [motion.acceleration for motion in self.named.values()]
        if len(motions) == 1:
            return motions[0][None, :]
        return frozen(
            np.array([np.pad(each, (0, self.npts - each.size)) for each in motions])
        )

    def row(self, name: str) -> int | None:
        """Of a component among the samples; None if it is not known."""
        names = list(self.named)
        return names.index(name) if name in names else None

    @property
    def digest(self) -> bytes:
        """Of the samples of all components."""
        above, across = (each.digest if each else "" for each in (self.vertical, self.y))
        parts = [self.horizontal.digest, above, *filter(None, [across])]
        return hashlib.sha256("|".join(parts).encode()).digest()

    def finer(self, parts: int) -> MotionComponents:
        """The motion with that many even parts in each sampling interval."""
        return self if parts == 1 else self._each(lambda motion: motion.finer(parts))

    def scaled(self, factor: float) -> MotionComponents:
        """All components times `factor`."""
        scaled = self._each(lambda motion: motion.scaled(factor))
        return replace(scaled, scale=self.scale * factor, scaled_to="")

    def _each(self, change: Callable[[GroundMotion], GroundMotion]) -> MotionComponents:
        changed: dict[str, Any] = {
            name: change(motion) for name, motion in self.named.items()
        }
        return replace(self, **changed)

    def turned(self, rotation: float) -> MotionComponents:
        """A pair turned from x towards y [deg]: what acted along x
        then acts at that azimuth.
        """
        x = self.horizontal
        y = self.y
        if not is_number(rotation):
            raise RecordError(
                f"the rotation {told(rotation)} must be a finite number [deg]"
            )
        if y is None or rotation % 360.0 == 0.0:
            return self
        along, across = (
            replace(
                rotated(x, y, direction - rotation),
                name=f"{of.name}_{rotation:g}deg",
                source=of.source,
                description=f"{of.description}; pair turned by {rotation:g} deg".lstrip(
                    "; "
                ),
            )
            for of, direction in ((x, 0.0), (y, 90.0))
        )
        return replace(self, horizontal=along, y=across)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings besides those of the horizontal one: of the
        others, and of the factor.
        """
        doubts = [
            text for each in (self.y, self.vertical) if each for text in each.warnings
        ]
        made = self.horizontal.format == "pulse"
        return (
            *doubts,
            *(() if made else scale_doubts(self.horizontal.name, self.scale)),
        )


def require_one_step(one: GroundMotion, other: GroundMotion, name: str) -> None:
    """Refuse components of different time steps; the other one is called by its name."""
    if one.dt != other.dt:
        raise RecordError(
            f"{other.source}: the {name} record has dt = {other.dt} s, {one.source}"
            f" {one.dt} s: they must agree; resample one of them with `rps record convert"
            f" {other.source} --resample {one.dt}`"
        )


def rotated(first: GroundMotion, second: GroundMotion, angle: float) -> GroundMotion:
    """The motion in a plane that stands at an angle to the first component [deg]."""
    require_one_step(first, second, "second")
    if not is_number(angle):
        raise RecordError(f"the angle {told(angle)} must be a finite number [deg]")
    # A component itself is not changed by rounding.
    quarters, rest = divmod(angle, 90.0)
    c = math.cos(math.radians(rest))
    s = math.sin(math.radians(rest))
    cosine, sine = ((c, s), (-s, c), (-c, -s), (s, -c))[int(quarters) % 4]
    values = np.zeros(max(first.npts, second.npts))
    values[: first.npts] += cosine * first.acceleration
    values[: second.npts] += sine * second.acceleration
    warnings = tuple(dict.fromkeys((*first.warnings, *second.warnings)))
    note = f"turned by {angle:g} deg towards {second.name}"
    return first.noted(note, acceleration=values, warnings=warnings)
