"""Ground motions of a study: each read once, shared by all points and threads."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Hashable
from pathlib import Path
from threading import RLock
from typing import Generic, TypeVar

from rpscli.errors import RecordError
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.measures import Measure, measured
from rpscli.records.source import load_components
from rpscli.sweep.evaluation.points import RecordRequest

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

SAMPLES_KEPT = 32_000_000
"""Samples of ground motions held in memory (256 MB); the longest unused one goes first."""


class Recent(Generic[Key, Value]):
    """The values that were asked for last; safe to share among threads.

    Parameters
    ----------
    room
        Sum of the sizes that are kept.
    size
        Size of a value.
    """

    def __init__(self, room: float, size: Callable[[Value], float] = lambda _: 1.0) -> None:
        self._room, self._size, self._held = room, size, 0.0
        self._values: OrderedDict[Key, Value] = OrderedDict()
        self._lock = RLock()

    def value(self, key: Key, make: Callable[[], Value]) -> Value:
        """The value of a key, made if it is not at hand. Two threads never make the same one."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
                return self._values[key]
            made = self._values[key] = make()
            self._held += self._size(made)
            while self._held > self._room and len(self._values) > 1:
                _, oldest = self._values.popitem(last=False)
                self._held -= self._size(oldest)
            return made


class RecordCache:
    """Motions, the intensity of each, and the reasons why some cannot be had."""

    def __init__(self) -> None:
        self._motions: Recent[RecordRequest, MotionComponents | str] = Recent(
            SAMPLES_KEPT, _samples
        )
        self._digests: Recent[RecordRequest, bytes] = Recent(float("inf"))
        self._intensities: Recent[tuple[object, ...], float] = Recent(1e6)

    def motion(self, request: RecordRequest) -> MotionComponents:
        """The motion of a request.

        Raises
        ------
        RecordError
            If it cannot be read; the same error each time, without trying again.
        """
        found = self._motions.value(request, lambda: _load(request))
        if isinstance(found, str):
            raise RecordError(found)
        return found

    def digest(self, request: RecordRequest) -> bytes:
        """Digest of a motion's content; of the reason, if it cannot be read."""

        def make() -> bytes:
            try:
                return self.motion(request).digest
            except RecordError as error:
                return hashlib.sha256(f"unreadable: {request.source}: {error}".encode()).digest()

        return self._digests.value(request, make)

    def intensity(
        self,
        request: RecordRequest,
        measure: Measure,
        period: float | None = None,
        damping: float = 0.05,
    ) -> float:
        """A measure of the unscaled horizontal motion, SI units."""
        key = (request, measure, period, damping)
        return self._intensities.value(
            key, lambda: measured(self.motion(request).horizontal, measure, period, damping)
        )


def _samples(found: MotionComponents | str) -> float:
    """Room that a motion takes, both components together; a reason hardly any."""
    if isinstance(found, str):
        return 1.0
    return sum(motion.npts for motion in found.named.values())


def _load(request: RecordRequest) -> MotionComponents | str:
    """The motion, or why there is none."""
    source, folder, above, dt, units = request
    try:
        return load_components(source, above, folder=Path(folder), dt=dt, units=units)
    except (RecordError, OSError) as error:
        return str(error)
