"""Settings of a time history."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rpscli.errors import require_fields, require_kind, told
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import GroundMotion, MotionComponents


@dataclass(frozen=True)
class TimeHistorySettings:
    """Choices of the analysis that are no property of the structure.

    Parameters
    ----------
    free_vibration
        Time after the record [s]; None goes on until no new maximum is possible (Theory,
        section 3), for at most `LONGEST_FREE_VIBRATION`.
    recontact_tolerance
        After an impact the podium locks when the next excursion
        stays below this times alpha.
    overturning_limit
        The structure counts as overturned at this times theta_cr, at most where the
        columns lie down and the model ends (`Bearing.largest_rotation`).
    accuracy
        Divides the default time step; 2 gives steps half as long.
    max_events
        A history with more events ends as `failed`.
    initial_rotation
        theta at the start [rad], released from rest (snap-back); 0 is full contact.

    Raises
    ------
    ValueError
        For a value that no history can be run with.

    Examples
    --------
    >>> TimeHistorySettings(free_vibration=2.0).free_vibration
    2.0
    """

    free_vibration: float | None = None
    recontact_tolerance: float = 1e-6
    overturning_limit: float = 2.0
    accuracy: float = 1.0
    max_events: int = 100_000
    initial_rotation: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what would never end, or end in nonsense."""
        require_fields(self)
        free = self.free_vibration
        rules = {
            "free_vibration": (
                free is None or 0.0 <= free < math.inf,
                "None or finite and >= 0",
            ),
            "recontact_tolerance": (
                0.0 <= self.recontact_tolerance < 1.0,
                "from 0 to below 1",
            ),
            "overturning_limit": (
                0.0 < self.overturning_limit < math.inf,
                "finite and > 0",
            ),
            "accuracy": (0.0 < self.accuracy < math.inf, "finite and > 0"),
            "max_events": (
                1 <= self.max_events <= 10**9 and self.max_events % 1 == 0,
                "a whole number from 1 to 1e9",
            ),
            "initial_rotation": (math.isfinite(self.initial_rotation), "finite"),
        }
        for name, (holds, rule) in rules.items():
            if not holds:
                raise ValueError(f"{name} = {told(getattr(self, name))} must be {rule}")


LONGEST_FREE_VIBRATION = 120.0
"""Time after which free vibration `auto` gives up waiting for rest [s]."""


def require_structure(structure: object) -> None:
    """Refuse a case, a name or anything else in place of a structure."""
    require_kind(
        structure, PodiumStructure, "the structure", "load_case(...).structure is one"
    )


def require_inputs(
    structure: object,
    record: GroundMotion | MotionComponents,
    settings: TimeHistorySettings | None,
    vertical: GroundMotion | None,
) -> tuple[TimeHistorySettings, MotionComponents]:
    """Settings, or the usual ones, and all components; refuses inputs of other kinds."""
    require_structure(structure)
    remedy = "load_record(...) reads one, GroundMotion(samples, dt) makes one"
    require_kind(record, (GroundMotion, MotionComponents), "the record", remedy)
    chosen = TimeHistorySettings() if settings is None else settings
    require_kind(chosen, TimeHistorySettings, "settings", "use TimeHistorySettings(...)")
    motion = MotionComponents(record) if isinstance(record, GroundMotion) else record
    return chosen, motion if vertical is None else replace(motion, vertical=vertical)
