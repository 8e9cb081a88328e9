"""Where things stand in the arrays that the kernels share, and the codes of what they report.

The motion of all lanes lives in one flat buffer: entry ``row * L + l`` belongs to lane l of L. One
buffer with rows at offsets that the compiler knows is what lets it see that rows never overlap, so
that a loop over lanes becomes one vector instruction. Rows 0 to SCALARS - 1 hold one number a lane;
then come blocks of n + 1 rows, the tilt or the ground storey first, then the floors.
"""

from __future__ import annotations

(
    # Constants of the structure, loaded with a history.
    DIAMETER,  # 2 R [m]
    INERTIA,  # Io - 1
    BEAM,  # 1 + 4 gamma
    BUILDING,  # 4 gamma eta
    WEIGHT,  # (1 + 2 gamma + 2 gamma eta)/R
    PUSH,  # (1 + 2 gamma)/R
    SHEAR,  # 2/(N m_c R)
    DRAG,  # a0
    COLUMNS_MASS,  # N m_c
    CAP_BEAM_MASS,  # m_b
    FLOORS_MASS,  # M_tot
    STANDARD_GRAVITY,  # g
    THETA_CR,
    SCALE,  # factor on the record
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
    FLIGHT_STEP,
    FLIGHT_STEPS,  # steps in a whole interval
    CONTACT_STEP,
    CONTACT_STEPS,
    # Written by each evaluation of the accelerations.
    BASE,
    BASE_RATE,
    LEVER,
    HEIGHT,
    PER_INERTIA,
    RESTORING,
    BASE_SHEAR,
    MOMENTUM,
    DRIVE,  # what accelerates every floor alike: -a_g + a0 u_b'
    GROUND,
    GROUND_UPWARDS,
    # State of the step.
    LOCATING,  # 0 cruising, > 0 re-steps done towards an event, -1 false alarm cleared
    LEVEL,  # tilt of the event that is being located
    LONGEST,  # length of the step in which the event was seen
    QUIET,  # 1 if the step holds no event
    SEEN,  # 1 if a quiet step ends at a sample of the record
    WATCH,  # 1 if it may hold the largest tilt inside, or pass theta_cr for the first time
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
    EVALUATIONS,
    # Energy flows: at the present stage, at the start of the step, and their mean over the step.
    GIVEN,
    TAKEN,
    GIVEN_FIRST,
    TAKEN_FIRST,
    GIVEN_MEAN,
    TAKEN_MEAN,
    SCALARS,  # how many they are
) = range(73)

(
    STIFFNESS,
    DAMPING,  # a1 times stiffness
    MASS,
    INVERSE_MASS,
    FORCE,  # of each storey, and 0 above the roof
    STOREY_SHEAR,  # largest elastic one so far
    FLOOR_ACCELERATION,  # largest absolute one so far
    STEPS,  # the step length, once for each coordinate: see `runge_kutta`
    AHEAD,  # positions, velocities and accelerations of the present stage of a step, and at last
    AHEAD_RATE,  # of its end
    AHEAD_ACCELERATION,
    POSITION,  # the state at the start of the step
    VELOCITY,  # 6 blocks, one a stage that is needed again; the first is the state's
) = range(13)
ACCELERATION = VELOCITY + 6
BLOCKS = ACCELERATION + 6

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
    EVENT,  # kind of the event that is being located
    STALLED,
    CREATING,  # impacts that created energy
    COUNTS,  # 7 counts of events follow
) = range(12)

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
OUT_OUTCOME, OUT_MOTION, OUT_INTERVALS, OUT_EVALUATIONS, OUT_CREATING, OUT_COUNTS = range(6)
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
