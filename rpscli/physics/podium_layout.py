"""Where the numbers of a `parameters.Podium` stand in its row, phases spread out."""

from __future__ import annotations

(R, ALPHA, BETA, THETA_CR, THETA_LIMIT) = range(5)
ROLLING_PHASE, ROCKING_PHASE = 5, 10  # the five numbers of a `geometry.Phase` each
(
    IO,
    GAMMA,
    ETA,
    COLUMNS_MASS,
    CAP_BEAM_MASS,
    FLOORS_MASS,
    GRAVITY,
    RESTITUTION,
    FLOORS_JUMP,
    FLIGHT_RATE,
    CONTACT_RATE,
    LAST_TERM,
    RECONTACT_TOLERANCE,
    BOUNCES,
    MAX_EVENTS,
    INITIAL_ROTATION,
    FREE_VIBRATION,
    UNTIL_REST,
    PODIUM_NUMBERS,  # how many they are
) = range(15, 34)
