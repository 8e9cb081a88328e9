"""Sine and cosine of a tilt, without branches so that lanes can be computed together."""

from __future__ import annotations

from rpscli.physics.jit import kernel


@kernel
def sine_cosine(x: float) -> tuple[float, float]:
    """The sine and cosine of x by their power series [x in rad].

    Twenty terms leave less than 3e-16 for |x| <= pi/2, which no standing column exceeds; the error
    grows to 1e-9 at pi, where a structure has long been counted as overturned.
    """
    z = x * x
    sine = 1.0 - z / 342.0
    sine = 1.0 - z * (1.0 / 272.0) * sine
    sine = 1.0 - z * (1.0 / 210.0) * sine
    sine = 1.0 - z * (1.0 / 156.0) * sine
    sine = 1.0 - z * (1.0 / 110.0) * sine
    sine = 1.0 - z * (1.0 / 72.0) * sine
    sine = 1.0 - z * (1.0 / 42.0) * sine
    sine = 1.0 - z * (1.0 / 20.0) * sine
    sine = 1.0 - z * (1.0 / 6.0) * sine
    cosine = 1.0 - z / 380.0
    cosine = 1.0 - z * (1.0 / 306.0) * cosine
    cosine = 1.0 - z * (1.0 / 240.0) * cosine
    cosine = 1.0 - z * (1.0 / 182.0) * cosine
    cosine = 1.0 - z * (1.0 / 132.0) * cosine
    cosine = 1.0 - z * (1.0 / 90.0) * cosine
    cosine = 1.0 - z * (1.0 / 56.0) * cosine
    cosine = 1.0 - z * (1.0 / 30.0) * cosine
    cosine = 1.0 - z * (1.0 / 12.0) * cosine
    cosine = 1.0 - z * 0.5 * cosine
    return x * sine, cosine
