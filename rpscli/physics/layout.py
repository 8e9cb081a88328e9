"""Where things stand in the arrays that the kernels share, and the codes of what they report.

The motion of all lanes lives in one flat buffer: entry ``row * L + l`` belongs to lane l of L. One
buffer with rows at offsets that the compiler knows is what lets it see that rows never overlap, so
that a loop over lanes becomes one vector instruction. Rows 0 to SCALARS - 1 hold one number a lane;
then come blocks of n rows, one for each mode of the fixed base or for each floor.
"""

from __future__ import annotations

ORDER = 7
"""Highest term of the Taylor series of the velocities; those of the positions have one more.
`series` and `terms` are written out for it."""

(
    # Constants of the structure, loaded with a history.
    DIAMETER,  # 2 R [m]
    INERTIA,  # Io - 1
    BEAM,  # 1 + 4 gamma
    BUILDING,  # 4 gamma eta
    WEIGHT,  # (1 + 2 gamma + 2 gamma eta)/R
    PUSH,  # (1 + 2 gamma)/R
    SHEAR,  # 2/(N m_c R)
    COLUMNS_MASS,  # N m_c
    CAP_BEAM_MASS,  # m_b
    FLOORS_MASS,  # M_tot
    STANDARD_GRAVITY,  # g
    THETA_CR,
    SCALE,  # factor on the record
    LAST_TERM,  # of a series over its first three: a step with more is too long
    # The phase of motion: its constants, the side, and the range of the tilt in it.
    ARM_COS,
    ARM_SIN,
    ARC,
    PATH_START,
    LIFT_START,
    SIDE,
    LOW,
    HIGH,
    # Ground acceleration in the present interval; `UPWARDS` is g + a_v.
    ACROSS,
    ACROSS_SLOPE,
    UPWARDS,
    UPWARDS_SLOPE,
    # Time of the interval's start, time since then, and steps.
    START,
    TIME,
    STEP,
    LEFT,  # steps left in the interval
    INTERVAL_LENGTH,
    PER_INTERVAL,  # 1 over it
    FLIGHT_STEP,
    FLIGHT_STEPS,  # steps in a whole interval
    CONTACT_STEP,
    CONTACT_STEPS,
    # The storey at the start of the step: x, x', x'', and what x'' was made of.
    TILT,
    RATE,
    TURN,
    LEVER,
    HEIGHT,
    PER_INERTIA,
    BASE_SHEAR,
    # The same at the end of the step.
    NEXT_TILT,
    NEXT_RATE,
    NEXT_TURN,
    NEXT_LEVER,
    NEXT_HEIGHT,
    NEXT_PER_INERTIA,
    NEXT_BASE_SHEAR,
    GROUND,  # a_g and g + a_v at the end of the step
    GROUND_UPWARDS,
    FORCING,  # of the present order: acceleration of the cap beam
    STRAIN,  # weighted squares of modal displacements and pulls at the end of the step, and
    STRAIN_REACH,  # how large they may be without raising a storey shear,
    PULLED,
    PULLED_REACH,  # or a floor acceleration
    # State of the step.
    CLEARED,  # 1 if it was looked at closely and holds no event
    ROUGH,  # 1 if the step is too long for its series
    QUIET,  # 1 if the step is not, and holds no event
    SEEN,  # 1 if a quiet step ends at a sample of the record
    WATCH,  # 1 if it may hold the largest tilt inside, or pass theta_cr for the first time
    RAISE,  # 1 if what is seen may raise a storey shear or a floor acceleration
    ATTEND,  # 1 if the step ends at a sample or holds an event
    STALE,  # accelerations must be computed anew; if so, why: see `FRESH`
    # Running totals and extremes, in the order of the results; times that never came are negative.
    PEAK,
    PEAK_TIME,
    CRITICAL_TIME,
    FRICTION_TOP,
    FRICTION_BOTTOM,
    NORMAL_TOP,
    NORMAL_BOTTOM,
    INPUT,
    DAMPED,
    LOST,
    CREATED,
    STEPS,
    # Taylor coefficients over the step, ORDER + 1 each.
    RATES,  # of x'
) = range(78)
TERMS = ORDER + 1
STATE = NEXT_TILT - TILT
LEVERS = RATES + TERMS  # of B
HEIGHTS = LEVERS + TERMS  # of C
INERTIAS = HEIGHTS + TERMS  # of A
ACTIONS = INERTIAS + TERMS  # of s (a_g/R (1 + 2 gamma) - 2 V/(N m_c R))
SCALARS = ACTIONS + TERMS

(
    SQUARE,  # w^2
    DRAG,  # 2 xi w
    PARTICIPATION,
    STRAIN_WEIGHT,  # of a squared displacement in STRAIN, and of a squared pull in PULLED
    PULLED_WEIGHT,
    STRAIN_BOUND,  # of a storey: its squared shear times this is at most STRAIN
    PULLED_BOUND,  # of a floor: its squared acceleration times this is at most PULLED
    STOREY_SHEAR,  # largest elastic one so far
    FLOOR_ACCELERATION,  # largest absolute one so far
    SHEAR_NOW,  # at the end of the step, where they are looked at
    ACCELERATION_NOW,
    Q,  # modal displacements at the start of the step, relative to the cap beam
    PULL,  # w^2 q + 2 xi w q' of the present order, and at last of the end
    NEXT_Q,  # at the end of the step
    NEXT_DQ,
    DQ,  # Taylor coefficients of the modal velocities, ORDER + 1 blocks
) = range(16)
BLOCKS = DQ + TERMS
"""Then come n blocks, mode shapes, and another n, storey shears of each mode."""


def rows(floors: int) -> int:
    """How many rows there are."""
    return SCALARS + (BLOCKS + 2 * floors) * floors


# Whole numbers of a lane.
(
    POINT,
    RECORD,  # offset of the record in the store of all records
    NPTS,
    VERTICAL,  # offset of the vertical record, or -1
    INTERVAL,
    INTERVALS,
    MOTION,
    OUTCOME,
    STALLED,
    CREATING,  # impacts that created energy
    COUNTS,  # 7 counts of events follow
) = range(11)

# Why the accelerations of a lane are stale.
FRESH = 0.0
MOVED_ON = 1.0
LIFTED_OFF = 2.0
LANDED = 3.0
LEANING = 4.0

# Phase of motion.
FULL_CONTACT, ROLLING, ROCKING = range(3)

# Kinds of event, in the log and in the counts.
(
    UPLIFT,
    IMPACT,
    RECONTACT,
    ROLLING_TO_ROCKING,
    ROCKING_TO_ROLLING,
    CRITICAL_PASSAGE,
    OVERTURNING,
) = range(7)
EVENT_KINDS = 7
NOTHING = -1
WHOLE_NUMBERS = COUNTS + EVENT_KINDS
NO_POINT = -1  # POINT of a lane that has nothing left to do

# Columns of the event log.
LOG_TIME, LOG_KIND, LOG_ROTATION, LOG_RATE_BEFORE, LOG_RATE_AFTER, LOG_ENERGY_LOST = range(6)
LOG_COLUMNS = 6

# Columns of a stored sample, before n floor displacements and n floor velocities.
(
    ROW_ROTATION,
    ROW_RATE,
    ROW_ACCELERATION,
    ROW_PHASE,
    ROW_INPUT,
    ROW_DAMPED,
    ROW_LOST,
    ROW_FLOORS,
) = range(8)

# Columns of the results of a history: numbers, before n storey shears and n floor accelerations.
(
    OUT_TIME,
    OUT_ROTATION,
    OUT_STORED,
    OUT_PEAK,
    OUT_PEAK_TIME,
    OUT_CRITICAL_TIME,
    OUT_FRICTION_TOP,
    OUT_FRICTION_BOTTOM,
    OUT_NORMAL_TOP,
    OUT_NORMAL_BOTTOM,
    OUT_INPUT,
    OUT_DAMPED,
    OUT_LOST,
    OUT_CREATED,
    OUT_FLOORS,
) = range(15)

# Columns of the whole numbers of a result; the event counts follow.
OUT_OUTCOME, OUT_MOTION, OUT_INTERVALS, OUT_STEPS, OUT_CREATING, OUT_COUNTS = range(6)
OUT_WHOLE_NUMBERS = OUT_COUNTS + EVENT_KINDS

# How a history ended; it has not while RUNNING.
RUNNING = -1
(
    AT_REST,
    SURVIVED,
    OVERTURNED_ROLLING,
    OVERTURNED_ROCKING,
    FAILED_NOT_FINITE,
    FAILED_TOO_MANY_EVENTS,
    FAILED_STEP_TOO_SMALL,
) = range(7)
