"""Energy of a lane, relative to the ground, and its flows (Theory, section 8)."""

from __future__ import annotations

from rpscli.physics.geometry import Phase
from rpscli.physics.lane import Lane
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    ARC,
    ARM_COS,
    ARM_SIN,
    BEAM,
    BUILDING,
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    DAMPED,
    DIAMETER,
    DQ,
    DRAG,
    FLOORS_MASS,
    INERTIA,
    INPUT,
    LIFT_START,
    PARTICIPATION,
    PATH_START,
    RATE,
    SIDE,
    SQUARE,
    STANDARD_GRAVITY,
    STEP,
    TILT,
    TIME,
    UPWARDS,
    UPWARDS_SLOPE,
    Q,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import part, routine
from rpscli.physics.terms import integral, modal_terms, tilt_terms, value
from rpscli.physics.tilt import cap_beam_lift, lever_arm, path_height, tilt_inertia
from rpscli.physics.trigonometry import sine_cosine

NODES = (0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263)
WEIGHTS = (0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693)
"""Gauss and Legendre's rule of order 8 over [0, 1]."""


@part
def phase_of(s: Floats) -> Phase:
    """Constants of the phase of motion of a lane, from its numbers."""
    return Phase(s[ARM_COS], s[ARM_SIN], s[ARC], s[PATH_START], s[LIFT_START])


@part
def relative_momentum(x: Floats) -> float:
    """1^T M v' [kg m/s]: that of the floors relative to the cap beam; `x` are the lane's blocks."""
    momentum = 0.0
    for r in range(x.shape[1]):
        momentum += x[PARTICIPATION, r] * x[DQ, r]
    return momentum


@part
def building_energy(lane: Lane, base_rate: float) -> float:
    """Kinetic and strain energy of the floors [J], the cap beam moving at u_b' = base_rate."""
    x = lane.blocks
    energy = float(0.5 * lane.numbers[FLOORS_MASS] * (base_rate * base_rate))
    for r in range(x.shape[1]):
        q, dq = x[Q, r], x[DQ, r]
        energy += 0.5 * (dq * dq + x[SQUARE, r] * (q * q))
    return energy + base_rate * relative_momentum(x)


@part
def tilting_energy(s: Floats, B: float, C: float, rate: float) -> float:
    """Kinetic energy of columns and cap beam, and of the floors' vertical motion [J]."""
    A = tilt_inertia(s[INERTIA], s[BEAM], s[BUILDING], phase_of(s), B, C)
    return float(0.125 * s[COLUMNS_MASS] * (s[DIAMETER] * s[DIAMETER]) * A * (rate * rate))


@part
def lifted_mass(s: Floats) -> float:
    """Mass that moves with the cap beam, half of the columns' included [kg]."""
    return float(0.5 * s[COLUMNS_MASS] + s[CAP_BEAM_MASS] + s[FLOORS_MASS])


@routine
def uplifted_energy(lane: Lane) -> float:
    """Kinetic, strain and potential energy of the uplifted structure [J]."""
    s = lane.numbers
    rate, phase = s[RATE], phase_of(lane.numbers)
    sine, cosine = sine_cosine(s[TILT])
    B, C = lever_arm(phase, cosine, sine), path_height(phase, cosine, sine)
    lift = s[DIAMETER] * cap_beam_lift(phase, cosine, sine)
    lifted = lifted_mass(s) * s[STANDARD_GRAVITY] * lift
    base_rate = s[SIDE] * s[DIAMETER] * C * rate
    return float(lifted) + tilting_energy(s, B, C, rate) + building_energy(lane, base_rate)


@part
def powers_after(lane: Lane, t: float) -> tuple[float, float]:
    """Power of the ground and of the dampers [W], a fraction t of the step after its start."""
    s, x = lane.numbers, lane.blocks
    rates = tilt_terms(s)
    tilt, rate = s[TILT] + s[STEP] * integral(rates, t), value(rates, t)
    sine, cosine = sine_cosine(tilt)
    phase = phase_of(s)
    B, C = lever_arm(phase, cosine, sine), path_height(phase, cosine, sine)
    momentum, taken = lifted_mass(s) * s[SIDE] * s[DIAMETER] * C * rate, 0.0
    for r in range(x.shape[1]):
        dq = value(modal_terms(x, r), t)
        momentum += x[PARTICIPATION, r] * dq
        taken += x[DRAG, r] * (dq * dq)
    time = s[TIME] + t * s[STEP]
    across = s[ACROSS] + s[ACROSS_SLOPE] * time
    upwards = s[UPWARDS] + s[UPWARDS_SLOPE] * time - s[STANDARD_GRAVITY]
    given = across * momentum + upwards * lifted_mass(s) * s[DIAMETER] * B * rate
    return -given, taken


@routine
def book_energy(lane: Lane, shape: Shape, fraction: float) -> None:
    """Book what flows in the first part of the step, if energy is audited.

    The flows are integrated by a rule of their own, so that the audit can show something: it does
    not know that the motion balances them.
    """
    if len(shape.audit) > 0:
        s = lane.numbers
        for i in range(len(NODES)):
            given, taken = powers_after(lane, fraction * NODES[i])
            s[INPUT] += fraction * s[STEP] * WEIGHTS[i] * given
            s[DAMPED] += fraction * s[STEP] * WEIGHTS[i] * taken
