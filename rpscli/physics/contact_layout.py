"""Where things stand in the arrays of full contact: the modal rows of a lane, and a block of steps.

Entry k of each row of a block belongs to the state after k steps.
"""

from __future__ import annotations

(
    Q,  # modal displacements
    DQ,  # modal velocities
    OMEGA,
    XI,
    PARTICIPATION,
    SQUARE,  # w^2
    DRAG,  # 2 xi w
    STRAIN_WEIGHT,  # see `layout`
    PULLED_WEIGHT,
    WHOLE,  # 8 rows: `oscillator.transition` over a contact step
) = range(10)
PART = WHOLE + 8  # 8 rows: over a part of one
SHAPES = PART + 8  # n rows: mode shapes; then n rows: storey shears of each mode

COLUMNS = 32
"""Instants of a block, its start included."""

# A step looks at the next instant as well, the last one beyond its rows: not at ALARM, which the
# same loop writes, for the compiler would then not make vectors of it.
(
    AT,  # acceleration of the ground, and its slope over the step that begins
    SLOPE,
    RISE,  # g + a_v, and its slope
    RISE_SLOPE,
    PUSH,  # base shear of the modes, and two derivatives but for what the ground's slope adds
    PUSH_SLOPE,
    PUSH_BEND,
    SEEN,  # 1 at samples of the record that come before any uplift
    ALARM,  # 1 if the storey might uplift in the step that begins
    GIVEN,  # energy put in and damped during the step that begins
    TAKEN,
    STRAIN,  # weighted squares of modal displacements and pulls, see `layout`
    PULLED,
    SHEAR,  # scratch of one floor
    PULL,
    FRICTION_TOPS,  # extremes since full contact began, column by column
    FRICTION_BOTTOMS,
    NORMAL_TOPS,
    NORMAL_BOTTOMS,
    ROWS,  # how many they are
) = range(20)

# Rows of a mode: displacement, velocity, and pull w^2 q + 2 xi w q' over its mass.
MODAL_Q, MODAL_DQ, MODAL_PULL = range(3)
