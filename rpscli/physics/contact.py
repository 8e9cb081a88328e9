"""Full contact: a fixed-base building, solved exactly, and the instant at which it uplifts.

While theta = theta' = 0 the building is linear and the ground acceleration is linear over an
interval, so its modes advance without error. The storey uplifts to the side s when the margin

    f(t) = (g + a_v) tan(alpha) (1 + 2 gamma + 2 gamma eta) - s q(t),
    q(t) = -a_g (1 + 2 gamma) + 2 gamma eta V/M_tot

leaves zero downwards (Theory, section 3): exactly where s theta'' of the uplifted equation would
become positive.

All that a lane needs stands in its modal rows z (rows, n), see `Q` to `SHAPES`.
"""

from __future__ import annotations

from typing import NamedTuple

from rpscli.physics.events import NO_PASSAGE, first_descent, lower_hull, quintic
from rpscli.physics.jit import kernel, part
from rpscli.physics.oscillator import transition
from rpscli.physics.parameters import Floats, Systems

(
    Q,  # modal displacements
    DQ,  # modal velocities
    Q_END,
    DQ_END,
    OMEGA,
    XI,
    PARTICIPATION,
    SQUARE,  # w^2
    DRAG,  # 2 xi w
    PULL,  # w^2 q + 2 xi w q': what the modes pull with, over their masses
    SHEARS,  # elastic storey shears and floor pulls, scratch
    PULLS,
    WHOLE,  # 8 rows: `oscillator.transition` over a contact step
) = range(13)
PART = WHOLE + 8  # 8 rows: over a part of one
SHAPES = PART + 8  # n rows: mode shapes; then n rows: storey shears of each mode


class Stance(NamedTuple):
    """What the margin against uplift is made of, and how the ground moves in the interval.

    `own` is 1 + 2 gamma, `share` 2 gamma eta/M_tot [1/kg], `lift` tan(alpha) times the whole,
    `creep` sum Gamma^2 2 xi w.
    """

    own: float
    share: float
    lift: float
    creep: float
    across: float
    across_slope: float
    upwards: float
    upwards_slope: float


class Push(NamedTuple):
    """Base shear of the modes and its two derivatives, but for what the ground's slope adds."""

    shear: float
    slope: float
    bend: float


@kernel
def load_modes(systems: Systems, s: int, z: Floats, h: float) -> None:
    """Fill the modal rows of a lane at rest; h is its contact step."""
    n = z.shape[1]
    for row in range(z.shape[0]):
        for i in range(n):
            z[row, i] = 0.0
    for r in range(n):
        w, xi = systems.omega[s, r], systems.xi[s, r]
        z[OMEGA, r], z[XI, r] = w, xi
        z[PARTICIPATION, r] = systems.participation[s, r]
        z[SQUARE, r], z[DRAG, r] = w * w, 2.0 * xi * w
        for i in range(n):
            z[SHAPES + r, i] = systems.shapes[s, r, i]
            z[SHAPES + n + r, i] = systems.shear_shapes[s, r, i]
    fill_transition(z, h, WHOLE)


@kernel
def fill_transition(z: Floats, h: float, row: int) -> None:
    """The exact map of every mode over h, under the ground's acceleration; 8 rows from `row`."""
    for r in range(z.shape[1]):
        a, b, c, d, e, f, g, i = transition(z[OMEGA, r], z[XI, r], h)
        load = -z[PARTICIPATION, r]
        z[row, r], z[row + 1, r], z[row + 2, r], z[row + 3, r] = a, b, load * c, load * d
        z[row + 4, r], z[row + 5, r], z[row + 6, r], z[row + 7, r] = e, f, load * g, load * i


@kernel
def advance_modes(z: Floats, across: float, slope: float, row: int) -> None:
    """Exact modal states one step later, to Q_END and DQ_END; the map stands at `row`.

    `across` is the ground acceleration at the start of the step, `slope` its rate.
    """
    for r in range(z.shape[1]):
        q, dq = z[Q, r], z[DQ, r]
        still = z[row + 2, r] * across + z[row + 3, r] * slope
        moving = z[row + 6, r] * across + z[row + 7, r] * slope
        z[Q_END, r] = z[row, r] * q + z[row + 1, r] * dq + still
        z[DQ_END, r] = z[row + 4, r] * q + z[row + 5, r] * dq + moving


@kernel
def push_of(z: Floats, row: int, across: float) -> Push:
    """Base shear of the modal states in two rows from `row`, a_g = `across`; writes PULL."""
    V, dV, ddV = 0.0, 0.0, 0.0
    for r in range(z.shape[1]):
        part, square, drag = z[PARTICIPATION, r], z[SQUARE, r], z[DRAG, r]
        q, dq = z[row, r], z[row + 1, r]
        pull = square * q + drag * dq
        ddq = -part * across - pull
        rise = square * dq + drag * ddq
        z[PULL, r] = pull
        V += part * pull
        dV += part * rise
        ddV += part * (square * ddq - drag * rise)
    return Push(V, dV, ddV)


@part
def keep_end(z: Floats) -> None:
    """Make the end of the step the present state."""
    for r in range(z.shape[1]):
        z[Q, r], z[DQ, r] = z[Q_END, r], z[DQ_END, r]


@part
def contact_energies(z: Floats, across: float, slope: float, h: float) -> tuple[float, float]:
    """Energy put in by the ground and damped during an exact step [J].

    The input -int a_g 1^T M u' dt is exact: integrated by parts it needs int q dt, which the
    equation of motion gives. The damped energy is a trapezoid corrected with end slopes, of order
    4, independent of the solution's own balance so that the audit can show something.
    """
    a0, a1 = across, across + slope * h
    given, damped = 0.0, 0.0
    for r in range(z.shape[1]):
        part, square, drag = z[PARTICIPATION, r], z[SQUARE, r], z[DRAG, r]
        q0, v0, q1, v1 = z[Q, r], z[DQ, r], z[Q_END, r], z[DQ_END, r]
        area = (-part * 0.5 * (a0 + a1) * h - (v1 - v0) - drag * (q1 - q0)) / square
        given -= part * (a1 * q1 - a0 * q0 - slope * area)
        g0 = -part * a0 - drag * v0 - square * q0
        g1 = -part * a1 - drag * v1 - square * q1
        damped += drag * (0.5 * h * (v0 * v0 + v1 * v1) + h * h / 6.0 * (v0 * g0 - v1 * g1))
    return given, damped


@kernel
def margin_after(
    z: Floats, stance: Stance, time: float, h: float, side: float
) -> tuple[float, float]:
    """Margin f against uplift to `side` and its slope, a time h after `time`, exactly."""
    fill_transition(z, h, PART)
    advance_modes(z, stance.across + stance.across_slope * time, stance.across_slope, PART)
    across = stance.across + stance.across_slope * (time + h)
    push = push_of(z, Q_END, across)
    q = stance.share * push.shear - stance.own * across
    dq = stance.share * push.slope - stance.own * stance.across_slope
    limit = stance.lift * (stance.upwards + stance.upwards_slope * (time + h))
    return limit - side * q, stance.lift * stance.upwards_slope - side * dq


@part
def locate_uplift(
    z: Floats, stance: Stance, time: float, h: float, guess: float, side: float
) -> float:
    """Time after `time`, near guess in [0, h], at which the margin is zero to rounding.

    Newton's method on the exact margin; leaves the modal state there in Q_END. A margin that only
    grazes zero has no steep root; the interpolant's own root then stands.
    """
    t = guess
    for _ in range(6):
        f, slope = margin_after(z, stance, time, t, side)
        if slope >= 0.0:
            break
        change = -f / slope
        if not 0.0 <= t + change <= h or abs(change) < 1e-15 * h:
            break
        t += change
    margin_after(z, stance, time, t, side)
    return t


@part
def step_contact(
    z: Floats, stance: Stance, time: float, h: float, row: int, before: Push, piece: Floats
) -> tuple[float, float, Push]:
    """Advance the modes by h, or to the uplift if that comes first, to Q_END and DQ_END.

    Parameters
    ----------
    row
        Where the exact map over h stands.
    before
        The push at `time`.
    piece
        (6,) scratch.

    Returns
    -------
    Time advanced [s], the side of uplift (0 if none), and the push at the end of the step.
    """
    slope = stance.across_slope
    start = stance.across + slope * time
    end = start + slope * h
    advance_modes(z, start, slope, row)
    after = push_of(z, Q_END, end)
    climb = stance.lift * stance.upwards_slope
    limit = stance.lift * (stance.upwards + stance.upwards_slope * time)
    bend = -stance.share * stance.creep * slope
    path = quintic(
        h,
        stance.share * before.shear - stance.own * start,
        stance.share * before.slope - stance.own * slope,
        stance.share * before.bend + bend,
        stance.share * after.shear - stance.own * end,
        stance.share * after.slope - stance.own * slope,
        stance.share * after.bend + bend,
    )
    first, side = NO_PASSAGE, 0.0
    for sign in (1.0, -1.0):
        # The limit is linear: its coefficients rise evenly.
        margin = (
            limit - sign * path[0],
            limit + 0.2 * h * climb - sign * path[1],
            limit + 0.4 * h * climb - sign * path[2],
            limit + 0.6 * h * climb - sign * path[3],
            limit + 0.8 * h * climb - sign * path[4],
            limit + h * climb - sign * path[5],
        )
        if min(lower_hull(margin), margin[0]) < 0.0:
            t = first_descent(margin, piece)
            if t < first:
                first, side = t, sign
    if side == 0.0:
        return h, side, after
    return locate_uplift(z, stance, time, h, first * h, side), side, after
