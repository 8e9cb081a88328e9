"""The impact law must send the columns over to their other edge: 0 < e <= 1."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rpscli.case.builder import bearing, building_mass, impact_law, storey_masses
from rpscli.case.document import Document
from rpscli.case.draft import BEARING, IMPACT
from rpscli.case.faults import Fault
from rpscli.case.rules_bearing import below
from rpscli.case.schema import CaseFile


def restitution_rule(file: CaseFile, document: Document) -> Iterator[Fault]:
    """Refuse e <= 0 and e > 1 (Theory, section 4) of a case without other faults."""
    column, law = bearing(file.podium.bearing), impact_law(file.podium.impact)
    total = building_mass(file.superstructure)
    masses = storey_masses(file.podium, total)
    gamma = masses.cap_beam / masses.columns
    eta = total / masses.cap_beam if masses.cap_beam else 0.0
    e = law.ratio(column, gamma, eta)
    if e > 1.0:
        yield Fault(
            (*IMPACT, "factor"),
            f"podium.impact.factor = {law.factor:g} gives the restitution {e:.4g}, which must be"
            f" <= 1; use a factor of at most {below(law.factor / e)}",
        )
    if e <= 0.0:
        widest = largest_slenderness(law.kind, column.inertia_ratio, gamma, eta)
        name = "dimensions" if document.has((*BEARING, "dimensions")) else "slenderness"
        yield Fault(
            (*BEARING, name),
            f"podium.bearing: the slenderness tan(alpha) = {column.slenderness:g} gives the"
            f" restitution {e:.4g} (impact law {law.kind}), which must be > 0 for the columns to"
            f" go over to their other edge; use less than {below(widest)}, or a measured value"
            " with impact: {law: value, restitution: ...}",
        )


def largest_slenderness(law: str, inertia_ratio: float, gamma: float, eta: float) -> float:
    """tan(alpha) at which the restitution of a law vanishes (Theory, section 4, solved for alpha).

    Housner's block, I_o/(m_c R^2) = 4/3: e = 1 - (3/2) sin^2(alpha) is zero at sin^2 = 2/3.

    >>> round(largest_slenderness("rigid", 4 / 3, 0.0, 0.0) ** 2, 12)
    2.0
    """
    beam, moved = 4.0 * gamma, 4.0 * gamma * (1.0 + eta)
    if law == "rigid":
        sin2 = (inertia_ratio + moved) / (2.0 * (1.0 + moved))
    else:
        sin2 = (inertia_ratio + beam) / (2.0 + 2.0 * beam + beam * eta)
    return math.sqrt(sin2 / (1.0 - sin2)) if sin2 < 1.0 else math.inf
