"""Where things stand in the arrays that the kernels share, and the codes of what they report."""

from __future__ import annotations

# The state of one history: tilt x = |theta|, its rate, two energy integrals, then n floor
# displacements and n floor velocities, both relative to the ground.
TILT = 0
TILT_RATE = 1
INPUT = 2
DAMPED = 3
FLOORS = 4

# Phase of motion.
FULL_CONTACT = 0
ROLLING = 1
ROCKING = 2

# Kinds of event, in the log and in the counts.
UPLIFT = 0
IMPACT = 1
RECONTACT = 2
ROLLING_TO_ROCKING = 3
ROCKING_TO_ROLLING = 4
CRITICAL_PASSAGE = 5
OVERTURNING = 6
EVENT_KINDS = 7

# Columns of the event log.
LOG_TIME = 0
LOG_KIND = 1
LOG_ROTATION = 2
LOG_RATE_BEFORE = 3
LOG_RATE_AFTER = 4
LOG_ENERGY_LOST = 5
LOG_COLUMNS = 6

# Columns of a stored sample, before n floor displacements and n floor velocities.
ROW_ROTATION = 0
ROW_RATE = 1
ROW_ACCELERATION = 2
ROW_PHASE = 3
ROW_INPUT = 4
ROW_DAMPED = 5
ROW_LOST = 6
ROW_FLOORS = 7

# Running totals of a history. Times that never came are negative.
LOST = 0
CREATED = 1
CREATED_IMPACTS = 2
PEAK = 3
PEAK_TIME = 4
CRITICAL_TIME = 5
TALLY_SIZE = 6

# Contact demands: largest |F|/N at the top and bottom, least normal force over the weight on it.
FRICTION_TOP = 0
FRICTION_BOTTOM = 1
NORMAL_TOP = 2
NORMAL_BOTTOM = 3

# How a history ended; it has not while RUNNING.
RUNNING = -1
AT_REST = 0
SURVIVED = 1
OVERTURNED_ROLLING = 2
OVERTURNED_ROCKING = 3
FAILED_NOT_FINITE = 4
FAILED_TOO_MANY_EVENTS = 5
FAILED_STEP_TOO_SMALL = 6
