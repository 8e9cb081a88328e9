"""Impacts: the columns fall back on their flat ends and go over to the other edge."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

from rpscli.errors import require_fields
from rpscli.model.bearing import Bearing
from rpscli.model.own import RestitutionLaw
from rpscli.registry import Registry

ImpactKind = Literal["flexible", "rigid", "value"]

IMPACT_LAWS: Registry[RestitutionLaw | None] = Registry(
    "impact_laws", dict.fromkeys(get_args(ImpactKind)), RestitutionLaw
)
"""Ours by their names, and what other packages add."""

CONTACT_TIME = 2e-3
"""Duration of an impact [s]: a joint that settles by D_0 under the building
has sqrt(2 D_0/g), that is 2 to 4.5 ms of 20 to 100 um; it moves the medians of
many pairs by less than 5 %."""

LONGEST_CONTACT = 0.02
"""Longest impact [s]; beyond it a pass would no longer be short against the motion."""


@dataclass(frozen=True)
class ImpactLaw:
    """theta'+ = e theta'- at theta = 0, and what the floors do at that instant.

    Parameters
    ----------
    kind
        ``flexible``: storey springs carry no impulse, so the floors keep their
        absolute velocities. ``rigid``: all floors jump with the cap beam (paper,
        Eq. 6). ``value``: e is measured; the floors jump as in ``rigid``. Another
        name: that of the law `own`.
    restitution
        e of the law ``value``.
    factor
        Multiplies the e of any law.
    loss
        kappa: how much of 1 - e is lost beside an impulse at the edges, 1 - e = kappa (1
        - e_edge) with e_edge of ``flexible`` or ``rigid``. About x/B if the impulse acts
        at x from the middle of ends of half width B.
    contact_time
        t_c, how long an impact takes [s], 0 to 20 ms. Only motions in both
        horizontal directions ask for it: of a pass near upright it decides how much
        is lost as at an impact.
    own
        The law of another package, whose e goes by the rate of the tilt; floors keep
        their velocities. Where one number is asked for it is that at 0.001 rad/s.
    constants
        Of that law, in their order.

    Notes
    -----
    Theory (4.5), (4.9). The paper's coefficient c is e^2.
    """

    kind: str = "flexible"
    restitution: float | None = None
    factor: float = 1.0
    loss: float = 1.0
    contact_time: float = CONTACT_TIME
    own: RestitutionLaw | None = None
    constants: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        """Refuse other words, and an e that the law does not take or lacks."""
        require_fields(self)
        if (self.kind in get_args(ImpactKind)) == (self.own is not None):
            raise ValueError(f"impact law {self.kind!r} must be flexible, rigid or value")
        if (self.kind == "value") != (self.restitution is not None):
            raise ValueError("law `value`, and it alone, needs a restitution, as in 0.92")
        if self.own is not None:
            self.own.require_values(self.constants, f"impact law {self.kind}")
        if not 0.0 <= self.contact_time <= LONGEST_CONTACT:
            raise ValueError(
                f"contact_time = {self.contact_time} s must be within 0 and"
                f" {LONGEST_CONTACT:g} s"
            )

    @property
    def floors_jump(self) -> bool:
        """True if the floors take part in the velocity jump of the cap beam."""
        return self.kind != "flexible" and self.own is None

    def ratio(self, bearing: Bearing, gamma: float, eta: float) -> float:
        """Restitution e = theta'+/theta'- of a bearing with mass ratios gamma and eta.

        A value <= 0 means that the column does not go over to its other edge; the case
        is then outside the model.

        Parameters
        ----------
        bearing
            Shape of every column.
        gamma
            m_b/(N m_c), cap beam over columns.
        eta
            M_tot/m_b, building over cap beam.

        Examples
        --------
        >>> round(ImpactLaw("rigid").ratio(Bearing(1.5, 0.15, 0.3, 0.5), 10.0, 6.0), 5)
        0.95604
        """
        law = {"rigid": rigid_restitution, "flexible": flexible_restitution}.get(
            self.kind
        )
        e = None if law is None else law(bearing, gamma, eta)
        if self.own is not None:
            given = bearing.slenderness, bearing.inertia_ratio, gamma, eta
            e = self.own.at_small_rate(self.kind, (*given, *self.constants))
        if e is not None:
            return self.factor * (1.0 - self.loss * (1.0 - e))
        assert self.restitution is not None, "the law `value` has one"
        return self.factor * self.restitution


def rigid_restitution(bearing: Bearing, gamma: float, eta: float) -> float:
    """e if the floors move with the cap beam (Theory (4.6); paper, Eq. 6, c = e^2)."""
    Io = bearing.inertia_ratio
    carried = 4.0 * gamma * (1.0 + eta)
    return 1.0 - 2.0 * math.sin(bearing.alpha) ** 2 * (1.0 + carried) / (Io + carried)


def flexible_restitution(bearing: Bearing, gamma: float, eta: float) -> float:
    """e if only the vertical momentum of the floors takes part (Theory (4.8))."""
    Io = bearing.inertia_ratio
    a = bearing.alpha
    sin2 = math.sin(a) ** 2
    beam = 4.0 * gamma
    floors = 4.0 * gamma * eta * math.sin(a) ** 2
    return (Io - 2.0 * sin2 + beam * math.cos(2.0 * a) - floors) / (Io + beam + floors)
