"""What an installation is verified by: closed forms, published numbers, a second integrator."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.comparison import Comparison
from rpscli.analyses.verification_buildings import buildings
from rpscli.analyses.verification_geometry import geometry
from rpscli.analyses.verification_histories import histories
from rpscli.analyses.verification_modes import modes
from rpscli.analyses.verification_pulses import pulses
from rpscli.analyses.verification_rocking import free_rocking


def verification() -> Iterator[Comparison]:
    """All comparisons, as they are computed; some 130 in a few seconds."""
    for group in (geometry, modes, buildings, free_rocking, pulses, histories):
        yield from group()
