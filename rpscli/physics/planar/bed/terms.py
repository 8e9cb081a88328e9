"""A bed in the equation of motion, and its Taylor terms (Theory (12.5), (12.6)).

The constants of a lane tell what it stands on: `bed_k`, `bed_c` > 0 in full contact, where its
phase is B = 0, C = C(phi_u); `sink`, `root` > 0 while a plane end lifts gradually; none of them on
edges that have lifted, on curved ends in contact outside of their flat part, and on rigid ends.

    A x'' + A' x'/2 = -(...) (B - sink w) g/R - (...) (B - root w) a_v/R - C action
                      - bed_k x - bed_c x' + G
    A = Io - 1 + (1 + 4 gamma) (C^2 + B_v^2) + 4 gamma eta B_v^2,    B_v = B - root w

    m x_0 y_m = -sum_(j=1..m) (m - j/2) x_j y_(m-j),    y = x^(-1/2)
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.records import ORDER, Record
from rpscli.physics.planar import plane_bed
from rpscli.physics.planar.bed import with_bed

patch = compiled(plane_bed.patch)


@compiled
def patch_of(s: Record, l: int, x: float) -> tuple[float, float]:
    """w and dw/dx of a lane; of one that does not lift gradually they do not count."""
    return patch(x if (s.root[l] > 0.0) & (x > 0.0) else 1.0, s.bed_uplift[l], s.fade[l])


def _no_change(_s: Record, _l: int, _x: float, given: float, *_: float) -> float:
    return given


@with_bed(otherwise=_no_change)
def lift_arm(s: Record, l: int, x: float, B: float) -> float:
    """B_v, the arm of the cap beam's lift, of B."""
    return float(B - s.root[l] * patch_of(s, l, x)[0])


@with_bed(otherwise=_no_change)
def inertia_on_bed(s: Record, l: int, x: float, A: float, B: float) -> float:
    """A with B_v in place of B."""
    Bv = lift_arm(s, l, x, B)
    return float(A + (s.one_4gamma[l] + s.four_gamma_eta[l]) * (Bv * Bv - B * B))


@with_bed(otherwise=_no_change)
def upwards_on_bed(s: Record, l: int, x: float, v: float, rate: float, rate_dot: float) -> float:
    """v_b'' with B_v in place of B [m/s2]."""
    w, slope = patch_of(s, l, x)
    return float(v - s.diameter[l] * s.root[l] * (w * rate_dot + slope * (rate * rate)))


@with_bed(otherwise=_no_change)
def hold_of_bed(s: Record, l: int, x: float, held: float, C: float) -> float:
    """What restores at rest beside B_v (g + a_v), as a limit of the push q [m/s2]."""
    missing = (s.root[l] - s.sink[l]) * patch_of(s, l, x)[0] * s.gravity[l] * s.weight_over_R[l]
    return float(held + 0.5 * s.diameter[l] * (missing + s.bed_k[l] * x) / C)


@with_bed()
def accelerate_on_bed(
    s: Record, l: int, c: float, B: float, C: float, action: float, g_up: float
) -> None:
    """x'' and 1/A of a lane with a bed, at the end of its step."""
    x, rate, both = s.next_theta[l], s.next_theta_dot[l], s.one_4gamma[l] + s.four_gamma_eta[l]
    w, slope = patch_of(s, l, x)
    Bv, dBv = B - s.root[l] * w, c - C - s.root[l] * slope
    per_A = 1.0 / (s.io_1[l] + s.one_4gamma[l] * (C * C) + both * (Bv * Bv))
    D = s.one_4gamma[l] * (C * B) + both * (Bv * dBv)
    a_v = g_up - s.gravity[l]
    weights = (s.gravity[l] * (B - s.sink[l] * w) + a_v * Bv) * s.weight_over_R[l]
    springs = s.bed_k[l] * x + s.bed_c[l] * rate
    found = -(weights + D * (rate * rate) + C * action + springs - s.next_device[l]) * per_A
    compliant = s.compliant[l] > 0.0
    s.next_theta_ddot[l] = found if compliant else s.next_theta_ddot[l]
    s.next_per_A[l] = per_A if compliant else s.next_per_A[l]


@with_bed()
def begin_bed(s: Record) -> None:
    """Terms of order 0."""
    for l in range(s.lanes):
        lifts = s.root[l] > 0.0
        x = s.theta[l] if lifts else 1.0
        y, shape = 1.0 / math.sqrt(x) if lifts else 0.0, 1.0 - s.fade[l] * (x - s.bed_uplift[l])
        s.tilt_terms[0, l], s.y_terms[0, l], s.shape_terms[0, l] = s.theta[l], y, shape
        square = shape * shape
        s.square_terms[0, l], s.fourth_terms[0, l] = square, square * square
        s.patch_terms[0, l] = y * (square * square)
        s.lift_terms[0, l] = s.B[l] - s.root[l] * s.patch_terms[0, l]


@with_bed(anew=True)
def extend_bed(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of x and w: those of x' before m are known."""
    for l in range(lanes):
        x = s.step[l] * (1.0 / m) * s.dtheta_terms[m - 1, l]
        sum_y = 0.5 * m * x * s.y_terms[0, l]
        for j in range(1, m):
            sum_y += (m - 0.5 * j) * s.tilt_terms[j, l] * s.y_terms[m - j, l]
        s.tilt_terms[m, l] = x
        y = s.y_terms[0, l]
        s.y_terms[m, l] = -(1.0 / m) * (y * y) * sum_y
        s.patch_terms[m, l] = s.y_terms[m, l]
    if s.fading == 0:
        return
    for l in range(lanes):
        s.shape_terms[m, l] = -s.fade[l] * s.tilt_terms[m, l]
        square, fourth, w = 0.0, 0.0, 0.0
        for j in range(m + 1):
            square += s.shape_terms[j, l] * s.shape_terms[m - j, l]
        s.square_terms[m, l] = square
        for j in range(m + 1):
            fourth += s.square_terms[j, l] * s.square_terms[m - j, l]
        s.fourth_terms[m, l] = fourth
        for j in range(m + 1):
            w += s.y_terms[j, l] * s.fourth_terms[m - j, l]
        s.patch_terms[m, l] = w


@with_bed(otherwise=0.0)
def lift_product(s: Record, l: int, j: int, k: int) -> float:
    """Of two terms of B_v, for the sum over them."""
    # Not summed in `bear`: a loop there is compiled before m is known, and keeps lanes apart.
    return float(s.lift_terms[j, l] * s.lift_terms[k, l])


def _rigid(
    _s: Record, _l: int, _m: int, A: float, _B: float, _squares: float, _: float, action: float
) -> tuple[float, float]:
    return A, action


@with_bed(otherwise=_rigid)
def bear(
    s: Record, l: int, m: int, A: float, B: float, squares: float, lifted: float, action: float
) -> tuple[float, float]:
    """Add what a bed does to the term of order m of A, and to what acts of the order before.

    B is the term of order m, `squares` that of B^2, `lifted` that of B_v^2 but for its ends.
    """
    k, root, sink = m - 1, s.root[l], s.sink[l]
    lift = B - root * s.patch_terms[m, l]
    s.lift_terms[m, l] = lift
    lifted += 2.0 * s.lift_terms[0, l] * lift
    a_v = s.g_up[l] + s.g_up_slope[l] * s.time[l] - s.gravity[l]
    missing = (sink * s.gravity[l] + root * a_v) * s.patch_terms[k, l]
    if m > 1:
        missing += root * s.step[l] * s.g_up_slope[l] * s.patch_terms[k - 1, l]
    springs = s.bed_k[l] * s.tilt_terms[k, l] + s.bed_c[l] * s.dtheta_terms[k, l]
    compliant = s.compliant[l] > 0.0
    more = (s.one_4gamma[l] + s.four_gamma_eta[l]) * (lifted - squares)
    held = springs - s.weight_over_R[l] * missing
    return A + (more if compliant else 0.0), action + (held if compliant else 0.0)


# The length of steps: behind phi_u a plane end changes its stiffness within a part of phi_u.

FIRST = 0.05
"""Of the usual step: the first one behind phi_u."""

FASTER = 2.0
"""A step over the one before it, at most."""

ONE_BEFORE = 0.06
"""Of the term before the last, as `steps.ONE_BEFORE` for x'."""


@with_bed()
def check_bed(s: Record) -> None:
    """Withdraw the acceptance of steps too long for the series of w; plan how long the next is."""
    for l in range(s.lanes):
        if s.root[l] == 0.0 or s.step[l] <= 0.0:
            continue
        y, d = s.y_terms, s.dtheta_terms
        ratio = max(abs(y[ORDER, l]), ONE_BEFORE * abs(y[ORDER - 1, l])) / y[0, l]
        if ratio > s.last_term[l] and s.step[l] > LEAST_STEP * s.dt[l]:
            s.too_long[l], s.accepted[l], s.peak_inside[l] = 1.0, 0.0, 0.0
        elif s.pace[l] < math.inf:
            first = abs(d[0, l]) + abs(d[1, l]) + abs(d[2, l])
            last = max(abs(d[ORDER, l]), ONE_BEFORE * abs(d[ORDER - 1, l]))
            ratio = max(ratio, last / max(first, 1e-300), 1e-30)
            longer = min(FASTER, 0.9 * (s.last_term[l] / ratio) ** (1.0 / ORDER))
            s.pace[l] = s.step[l] * max(longer, 0.5)


LEAST_STEP = 1e-12
"""Of the sampling interval: a step near x = 0 is not made shorter."""


@with_bed()
def watch_pace(s: Record) -> None:
    """Have steps behind phi_u planned one by one."""
    for l in range(s.lanes):
        if s.pace[l] < math.inf:
            s.needs_attention[l] = 1.0


@with_bed()
def keep_pace(s: Record, l: int) -> None:
    """Shorten the next step to what was planned behind the last one."""
    if s.pace[l] < s.step[l]:
        s.step[l], s.steps_left[l] = s.pace[l], 2.0
    elif s.pace[l] >= s.uplifted_step[l]:
        s.pace[l] = math.inf
