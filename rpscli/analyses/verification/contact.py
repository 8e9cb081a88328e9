"""Compliant ends: the period asked for, releases, energy, and the limit of rigid ends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rpscli.analyses.modal import modal
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification.known import (
    FLAT,
    Comparison,
    Known,
    compare,
    motion,
    paper_podium,
    within,
)
from rpscli.model.contact import Contact
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import ModalDamping, Superstructure, profile_stiffnesses

PERIODS = "Full contact of compliant ends, r = 1.2 (periods over T1)"
RELEASES = "Release at 0.4 alpha, undamped building on compliant plane ends"
SECOND_PERIOD = 0.4899030
"""Of one storey, over T1; by another program, as are the releases."""

REFERENCES = (
    (1, 2.868200132581778e-05, 1.0, 0.35612, 5.649),
    (3, 2.1e-4, 0.0, 0.38034, 3.4081),
    (3, 2.1e-4, 0.3, 0.36964, 3.922),
)
"""Of plane ends: storeys, phi_u, loss; back swing over alpha and V_b/V_st."""


def of_paper(storeys: int, contact: Contact, loss: float = 1.0) -> PodiumStructure:
    """The paper's podium with flat ends, and stiffnesses that are equal, without damping."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10.0, "uniform")
    return replace(
        paper_podium(storeys, 0.15, FLAT),
        superstructure=Superstructure(masses, stiffnesses, ModalDamping(0.0)),
        impact_law=ImpactLaw(loss=loss),
        contact=contact,
    )


def released(structure: PodiumStructure) -> TimeHistoryResult:
    """2.4 s after a release."""
    settings = TimeHistorySettings(0.0, initial_rotation=0.4 * structure.bearing.alpha)
    still = motion(np.zeros(2401), 1e-3)
    return time_history(structure, still, settings, with_fixed_base=False)


def compliant_ends() -> Iterator[Comparison]:
    """T/T_1 = r, swings and shears of releases, kept energy, and stiff edges."""
    for storeys, kind in ((6, "plane"), (6, "edges"), (1, "plane")):
        ends = Contact(kind, period_ratio=1.2, damping=0.0)  # type: ignore[arg-type]
        structure = of_paper(storeys, ends)
        full, where = modal(structure).full_contact, f"{kind}, n = {storeys}"
        assert full is not None, "its ends are compliant"
        ratios = full.periods / (0.1 * storeys)
        yield compare(PERIODS, f"first, {where}", "-", within(1.2, 1e-9), ratios[0])
    # The reference has the C of rigid columns in the mass at the beam.
    yield compare(PERIODS, f"second, {where}", "-", within(SECOND_PERIOD, 1e-6), ratios[1])
    half_width = structure.bearing.half_width
    for storeys, phi_u, loss, back, shear in REFERENCES:
        ends = Contact("plane", settlement=phi_u * half_width, damping=0.0)
        found, where = released(of_paper(storeys, ends, loss)), f"n = {storeys}, loss = {loss:g}"
        # Half of the last digit, and what lies between samples of 1 ms.
        known = Known(back, 1e-5), Known(shear, 5e-4)
        yield compare(RELEASES, f"back swing/alpha, {where}", "-", known[0], back_swing(found))
        yield compare(RELEASES, f"V_b/V_st, {where}", "-", known[1], found.base_shear_ratio or 0.0)
        if loss == 0.0:
            kept = found.trace.energy_stored[-1] / found.trace.energy_stored[0]
            yield compare(RELEASES, f"energy kept, {where}", "-", within(1.0, 1e-6), kept)
    stiff = Contact("edges", settlement=1e-5 * structure.bearing.alpha * half_width, damping=0.0)
    edges, rigid = (back_swing(released(of_paper(1, ends))) for ends in (stiff, Contact()))
    name = "back swing/alpha, stiff edges against rigid ends, n = 1"
    yield compare(RELEASES, name, "-", Known(rigid, 1e-4), edges)


def back_swing(result: TimeHistoryResult) -> float:
    """The largest rotation to the other side, over alpha."""
    return -float(result.trace.rotation.min()) / result.structure.bearing.alpha
