"""What an installation is verified by: closed forms, published numbers, a second integrator."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.verification.known import Comparison
from rpscli.analyses.verification.motions import (
    buildings,
    compliant_ends,
    devices,
    free_rocking,
    histories,
)
from rpscli.analyses.verification.overturning import pulses
from rpscli.analyses.verification.space import free_motion, one_component, passes
from rpscli.analyses.verification.statics import geometry, modes


def verification() -> Iterator[Comparison]:
    """All comparisons, as they are computed; some 180 in a few seconds."""
    plane = (geometry, modes, buildings, free_rocking, pulses, devices, histories)
    for group in (*plane, compliant_ends, free_motion, passes, one_component):
        yield from group()
