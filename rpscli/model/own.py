"""Laws of other packages: forces of dampers and restitutions, compiled
when a history uses them.

Only their functions are compiled, never the kernels, which call them by their addresses.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

MOST_CONSTANTS = 4
"""A law of another package has no more."""


@dataclass(frozen=True, eq=False)
class OwnLaw:
    """What all such laws have.

    Parameters
    ----------
    constants
        A `Quantity` of each of up to four constants, by the name that it has in a case.
        Functions of a law take their values last, in this order.
    """

    constants: Mapping[str, Any]

    def __post_init__(self) -> None:
        for name, quantity in self.constants.items():
            if not (str(name).isidentifier() and hasattr(quantity, "unit")):
                raise TypeError(f"its constant {name!r} must be a name with a Quantity")
        if len(self.constants) > MOST_CONSTANTS:
            raise ValueError(
                f"it has {len(self.constants)} constants, at most {MOST_CONSTANTS}"
            )

    def taken(self) -> dict[Callable[..., float], int]:
        """Functions of the law that are compiled, and how many numbers each takes."""
        raise NotImplementedError

    @property
    def sources(self) -> list[str]:
        """The files in which its functions are written, as far as there are any."""
        functions = map(inspect.unwrap, filter(callable, vars(self).values()))
        files = {inspect.getsourcefile(function) or "" for function in functions}
        return [
            Path(file).read_text("utf-8")
            for file in sorted(files)
            if Path(file).is_file()
        ]


@dataclass(frozen=True, eq=False)
class DamperLaw(OwnLaw):
    """A damper between ground and cap beam, which resists along the beam's velocity.

    `force` and `watched` are compiled; what they may do is in
    `rpscli/compiler/LANGUAGE.md`. All in SI.

    Parameters
    ----------
    constants
        As of every law.
    force
        Of |u_b| [m] and |u_b'| [m/s]: the resistance [N]; 0 at rest.
    damping
        The largest slope of the force with the velocity, for steps [N s/m].
    linear
        That slope about rest, for modes [N s/m]; None if the force has a kink there, as
        powers of the velocity have.
    stiffness
        The largest slope with the displacement, for steps [N/m]; None if there is none.
    watched
        As `force`: a value that is zero where the force has a kink; steps end there.
    """

    force: Callable[..., float]
    damping: Callable[..., float]
    linear: Callable[..., float] | None
    stiffness: Callable[..., float] | None = None
    watched: Callable[..., float] | None = None

    def taken(self) -> dict[Callable[..., float], int]:
        """Its compiled functions, and how many numbers each takes."""
        functions = [self.force] if self.watched is None else [self.force, self.watched]
        return dict.fromkeys(functions, 2 + len(self.constants))


@dataclass(frozen=True, eq=False)
class RestitutionLaw(OwnLaw):
    """The restitution of impacts whose floors keep their velocities.

    Parameters
    ----------
    constants
        As of every law.
    restitution
        Of the tilt's rate before an impact [rad/s], tan(alpha), I_o/(m_c R^2), gamma =
        m_b/(N m_c) and eta = M_tot/m_b: e in (0, 1]; it is compiled.
    """

    restitution: Callable[..., float]

    def taken(self) -> dict[Callable[..., float], int]:
        """Its compiled function, and how many numbers it takes."""
        return {self.restitution: 5 + len(self.constants)}
