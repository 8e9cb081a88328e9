"""Run as a program: the digest of a short history under both components, samples included."""

from __future__ import annotations

import hashlib
import sys

from two_components import followed, frame, pair, two_pulses

STEP = 0.01


def digest() -> str:
    """Of a storey that uplifts under two pulses, and passes near upright."""
    x, y = two_pulses()[:, 80:190]
    x[0] = y[0] = 0.0
    structure = frame(1, 1.0, tan_wedge=0.3, rho=0.5, contact_time=2e-3)
    history = followed(structure, pair(x, y, STEP))
    assert len(history.passes)
    kept = history.left, history.samples, history.floors, history.log
    return hashlib.sha256(b"".join(of.tobytes() for of in kept)).hexdigest()


if __name__ == "__main__":
    sys.stdout.write(digest())
