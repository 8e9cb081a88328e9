"""What only the built podium tells: whether it can be let go, and come down again."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rpscli.case.build import Podium
from rpscli.case.rules.bearing import below
from rpscli.case.rules.partial_case import BEARING, IMPACT
from rpscli.case.schema.case_file import AnalysisSection
from rpscli.case.text.document import Document
from rpscli.case.text.faults import Fault
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw


def overturning_rule(bearing: Bearing, analysis: AnalysisSection) -> Iterator[Fault]:
    """A structure must have overturned where the model ends."""
    limit, critical = analysis.overturning_limit, bearing.critical_rotation
    if limit * critical > bearing.largest_rotation:
        yield Fault(
            ("analysis", "overturning_limit"),
            f"analysis.overturning_limit = {limit:g} times theta_cr = {critical:.6g} rad must not"
            f" exceed {bearing.largest_rotation:.6g} rad, where the columns lie down and the model"
            f" ends; use at most {below(bearing.largest_rotation / critical)}",
        )


def release_rule(bearing: Bearing, analysis: AnalysisSection) -> Iterator[Fault]:
    """A structure that is let go from a rotation must not have overturned already."""
    limit = analysis.overturning_limit * bearing.critical_rotation
    if abs(analysis.initial_rotation) >= limit:
        yield Fault(
            ("analysis", "initial_rotation"),
            f"analysis.initial_rotation = {analysis.initial_rotation:g} rad must stay below the"
            " overturning limit,"
            f" overturning_limit * theta_cr = {limit:.6g} rad; use less than {below(limit)}",
        )


def restitution_rule(podium: Podium, document: Document) -> Iterator[Fault]:
    """The impact law must send the columns over to their other edge: 0 < e <= 1.

    Theory, section 4.
    """
    column, law = podium.bearing, podium.impact_law
    e = law.ratio(column, podium.gamma, podium.eta)
    if e > 1.0:
        yield Fault(
            (*IMPACT, "factor"),
            f"podium.impact.factor = {law.factor:g} gives the restitution {e:.4g}, which must be"
            f" <= 1; use a factor of at most {below(law.factor / e)}",
        )
    if e <= 0.0:
        widest = largest_slenderness(law, column.inertia_ratio, podium.gamma, podium.eta)
        lost = "" if law.loss == 1.0 else f", loss {law.loss:g}"
        name = "dimensions" if document.has((*BEARING, "dimensions")) else "slenderness"
        yield Fault(
            (*BEARING, name),
            f"podium.bearing: the slenderness tan(alpha) = {column.slenderness:g} gives the"
            f" restitution {e:.4g} (impact law {law.kind}{lost}), which must be > 0 for the columns"
            f" to go over to their other edge; use less than {below(widest)}, or a measured value"
            " with impact: {law: value, restitution: ...}",
        )


def largest_slenderness(law: ImpactLaw, inertia_ratio: float, gamma: float, eta: float) -> float:
    """tan(alpha) at which the restitution of a law vanishes (Theory, section 4, solved for alpha).

    Housner's block, I_o/(m_c R^2) = 4/3: e = 1 - (3/2) sin^2(alpha) is zero at sin^2 = 2/3.

    >>> round(largest_slenderness(ImpactLaw("rigid"), 4 / 3, 0.0, 0.0) ** 2, 12)
    2.0
    """
    beam, floors = 4.0 * gamma, 4.0 * gamma * eta
    # kappa (1 - e_edge) = 1 with 1 - e_edge = 2 sin^2 (1 + beam + floors)/(Io + ...)
    if law.kind == "rigid":
        sin2 = (inertia_ratio + beam + floors) / (2.0 * law.loss * (1.0 + beam + floors))
    else:
        sin2 = (inertia_ratio + beam) / (2.0 * law.loss * (1.0 + beam + floors) - floors)
    return math.sqrt(sin2 / (1.0 - sin2)) if sin2 < 1.0 else math.inf
