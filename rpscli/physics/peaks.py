"""The largest value within a step of what is known at its start, middle and end."""

from __future__ import annotations

from rpscli.physics.compile import compiled


@compiled
def middle_of(
    start: float, end: float, slope_times_step: float, end_slope_times_step: float
) -> float:
    """The middle of the cubic with these ends and slopes, which errs by (w h)^4/384."""
    return 0.5 * (start + end) + 0.125 * (slope_times_step - end_slope_times_step)


@compiled
def turning_value(start: float, middle: float, end: float) -> float:
    """Where the parabola through three values turns within the step,
    its value; else the end.
    """
    bend = start - 2.0 * middle + end
    change = end - start
    turns = abs(change) < 2.0 * abs(bend)
    return middle - change * change / (8.0 * (bend if turns else 1.0)) if turns else end


@compiled
def peak(start: float, middle: float, end: float) -> float:
    """The largest absolute value of the parabola through three values."""
    highest = max(abs(start), abs(end))
    return max(highest, abs(turning_value(start, middle, end)))
