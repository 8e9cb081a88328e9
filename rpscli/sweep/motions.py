"""Ground motions of a study: what of them is asked for, each read and measured once."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Hashable
from pathlib import Path
from threading import RLock
from typing import Any, Generic, NamedTuple, TypeVar

from rpscli.errors import RecordError
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_components
from rpscli.records.measures import Measure, Of, measured, pair_measure
from rpscli.records.recordings import Pair
from rpscli.records.source import Source

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

SAMPLES_KEPT = 32_000_000
"""Samples of ground motions held in memory (256 MB); the least recently used go first."""


class RecordRequest(NamedTuple):
    """A ground motion to be loaded, and where its relative names start.

    What is measured by a `pair` has both components of that. A second component `y`
    acts together with the source, as both of a source do that says so; they are
    turned by a rotation [deg].
    """

    source: str
    folder: str
    vertical: str | None = None
    dt: float | None = None
    units: str | None = None
    pair: Pair | None = None
    y: str | None = None
    rotation: float = 0.0

    @property
    def name(self) -> str:
        """The source, or both."""
        return self.source if self.y is None else f"{self.source} + {self.y}"

    @property
    def is_pair(self) -> bool:
        """True if both horizontal components act."""
        return self.y is not None or Source.parse(self.source).both


class Recent(Generic[Key, Value]):
    """Values that were asked for last, sizes of `room` in all;
    safe to share among threads.
    """

    def __init__(
        self, room: float, size: Callable[[Value], float] = lambda _: 1.0
    ) -> None:
        self._room = room
        self._size = size
        self._held = 0.0
        self._values: OrderedDict[Key, Value] = OrderedDict()
        self._lock = RLock()

    def value(self, key: Key, make: Callable[[], Value]) -> Value:
        """The value of a key, made if it is not at hand. Two threads
        never make the same one.
        """
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
            SAMPLES_KEPT,
            # A reason takes hardly any room.
            lambda of: (
                1.0 if isinstance(of, str) else sum(e.npts for e in of.named.values())
            ),
        )
        self._digests: Recent[RecordRequest, bytes] = Recent(float("inf"))
        self._intensities: Recent[tuple[object, ...], float] = Recent(1e6)

    def motion(self, request: RecordRequest) -> MotionComponents:
        """The motion of a request."""

        def load() -> MotionComponents | str:
            source, folder, above, dt, units, _, y, rotation = request
            how: dict[str, Any] = {"folder": Path(folder), "dt": dt, "units": units}
            try:
                return load_components(source, above, y, rotation, **how)
            except (RecordError, OSError) as error:
                return str(error)

        motion = self._motions.value(request, load)
        if isinstance(motion, str):
            raise RecordError(motion)
        return motion

    def digest(self, request: RecordRequest) -> bytes:
        """Digest of a motion's content; of the reason, if it cannot be read."""

        def make() -> bytes:
            try:
                return self.motion(request).digest
            except RecordError as error:
                text = f"unreadable: {request.source}: {error}"
                return hashlib.sha256(text.encode("utf-8", "surrogateescape")).digest()

        return self._digests.value(request, make)

    def intensity(
        self,
        request: RecordRequest,
        measure: Measure,
        period: float | None = None,
        damping: float = 0.05,
        of: Of = "component",
    ) -> float:
        """A measure of the unscaled horizontal motion or, if it has
        one, of its pair, SI units.
        """
        both = None if of == "component" else request.pair
        # All directions of a pair share its measure, and both components together.
        shared = request._replace(source="", vertical=None, y=None, rotation=0.0)

        def make() -> float:
            if both is None:
                return measured(self.motion(request).horizontal, measure, period, damping)
            parts = (shared._replace(source=source, pair=None) for source in both)
            one, other = (self.motion(part).horizontal for part in parts)
            return pair_measure(one, other, measure, of, period, damping)

        whose = request if both is None else (shared, of)
        return self._intensities.value((whose, measure, period, damping), make)
