"""The ground motion that a time history runs on: the case's own, or that of the command line."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rpscli.errors import UsageError

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.records.ground_motion import GroundMotion, MotionComponents


@dataclass(frozen=True)
class MotionRequest:
    """What the command line says about the ground motion; None leaves it to the case."""

    record: str | None = None
    vertical: str | None = None
    scale: float | None = None


def motion_inputs(motion: MotionComponents) -> dict[str, Any]:
    """What identifies a motion in `run.json`; digests are those of the scaled samples."""
    components = {"horizontal": motion.horizontal, "vertical": motion.vertical}
    return {
        "scale": motion.scale,
        **{
            name: found and {"source": found.source, "sha256": found.digest}
            for name, found in components.items()
        },
    }


def load_motion(case: Case, request: MotionRequest) -> MotionComponents:
    """Read the motion; a `--record` stands in place of the whole `record` section of the case.

    Raises
    ------
    UsageError
        If neither names a record, or the scale is not finite.
    RecordError
        If a record cannot be read, or the components have different time steps.
    """
    from rpscli.records.ground_motion import MotionComponents  # noqa: PLC0415 -- numpy is slow
    from rpscli.records.source import load_record  # noqa: PLC0415

    given = case.record if request.record is None else None
    vertical: GroundMotion | None = None
    if request.record is not None:
        horizontal = load_record(request.record)
    elif given is not None:
        how: dict[str, Any] = {"folder": case.folder, "dt": given.dt, "units": given.units}
        horizontal = load_record(given.source, **how)
        if given.vertical is not None and request.vertical is None:
            vertical = load_record(given.vertical, **how)
    else:
        raise UsageError(f"{case.source}: the case names no record; give one with --record")
    if request.vertical is not None:
        vertical = load_record(request.vertical)
    motion = MotionComponents(horizontal, vertical)
    scale = request.scale
    if scale is None:
        scale = 1.0 if given is None else given.scale
    if not math.isfinite(scale):
        raise UsageError(f"--scale {scale}: must be a finite number")
    return motion if scale == 1.0 else motion.scaled(scale)
