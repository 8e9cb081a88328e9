"""What an installation is verified by: closed forms, published numbers, a second integrator."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.verification.buildings import buildings
from rpscli.analyses.verification.comparison import Comparison
from rpscli.analyses.verification.devices import devices
from rpscli.analyses.verification.free_rocking import free_rocking
from rpscli.analyses.verification.geometry import geometry
from rpscli.analyses.verification.histories import histories
from rpscli.analyses.verification.modes import modes
from rpscli.analyses.verification.pulses import pulses


def verification() -> Iterator[Comparison]:
    """All comparisons, as they are computed; some 130 in a few seconds."""
    for group in (geometry, modes, buildings, free_rocking, pulses, devices, histories):
        yield from group()
