"""Laws of other packages: forces of dampers and restitutions, compiled
when a history uses them.

Only their functions are compiled, never the kernels, which call them by their addresses.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rpscli.errors import LARGEST, PluginError, is_number, told
from rpscli.registry import blaming, owner_of

MOST_CONSTANTS = 4
"""A law of another package has no more."""


PATH = 0.1
SPEEDS = 1e-3, 0.1
"""Displacement [m] and velocities [m/s] at which dampers must resist."""
SLOPES = {"damping": "N s/m", "linear": "N s/m", "stiffness": "N/m"}
"""Answers of a damper that are sizes, with their units."""
SMALL_RATE = 1e-3
"""Rate of the tilt at which a law gives the one e of tables [rad/s]."""


@dataclass(frozen=True, eq=False)
class OwnLaw:
    """Constants and checks that all such laws have.

    Parameters
    ----------
    constants
        A `Quantity` of each of up to four constants, by the name that it has in a case.
        Functions of a law take their values last, in this order.
    """

    constants: Mapping[str, Any]

    def __post_init__(self) -> None:
        for name, quantity in self.constants.items():
            known = hasattr(quantity, "unit") and hasattr(quantity, "read")
            if not (str(name).isidentifier() and known):
                raise TypeError(f"its constant {name!r} must be a name with a Quantity")
        if len(self.constants) > MOST_CONSTANTS:
            raise ValueError(
                f"it has {len(self.constants)} constants, at most {MOST_CONSTANTS}"
            )

    def require_values(self, values: Sequence[float], what: str) -> None:
        """Refuse values that the bounds of its constants do not admit: a ValueError."""
        if len(values) != len(self.constants):
            names = ", ".join(self.constants) or "none"
            raise ValueError(
                f"{what} has {len(self.constants)} constants ({names}), and"
                f" {len(values)} values were given"
            )
        for (name, quantity), value in zip(self.constants.items(), values, strict=True):
            try:
                quantity.read(value)
            except ValueError as error:
                text = f"{what}: {name} = {told(value)} {error}"
                raise ValueError(text) from None

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
        That slope about rest, for modes [N s/m]; left out if the force has a kink there, as
        powers of the velocity have.
    stiffness
        The largest slope with the displacement, for steps [N/m]; None if there is none.
    watched
        As `force`: a value that is zero where the force has a kink; steps end there.
    """

    force: Callable[..., float]
    damping: Callable[..., float]
    linear: Callable[..., float] | None = None
    stiffness: Callable[..., float] | None = None
    watched: Callable[..., float] | None = None

    def require_resistance(self, name: str, values: Sequence[float]) -> None:
        """Refuse what is no damper: a force at rest, or one that
        pushes, and slopes without a size; raises PluginError.
        """
        owner = owner_of(self.force, f"damper {name}")
        with blaming(owner):
            at_rest = self.force(PATH, 0.0, *values)
            slopes = {
                (each, unit): function(*values)
                for each, unit in SLOPES.items()
                if (function := getattr(self, each)) is not None
            }
        if at_rest:
            raise PluginError(
                f"{owner}: its force at rest, at a displacement of {PATH:g} m, is"
                f" {at_rest:g} N, and must be 0; friction and stops are kinds of rps"
            )
        for speed in SPEEDS:
            force = math.nan
            with suppress(Exception):  # a history tells it, if it comes so far
                force = self.force(PATH, speed, *values)
            if force < 0.0:
                raise PluginError(
                    f"{owner}: its force at {speed:g} m/s, at a displacement of {PATH:g} m,"
                    f" is {force:g} N, which pushes; a damper resists: give it the other"
                    " sign"
                )
        for (each, unit), slope in slopes.items():
            if not (is_number(slope) and 0.0 <= slope <= LARGEST):
                raise PluginError(
                    f"{owner}: its {each} is {told(slope)[:60]} {unit}, and must be at"
                    f" least 0 and at most {LARGEST:g}"
                )

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

    def at_small_rate(self, name: str, given: Sequence[float]) -> float:
        """e at the rate of tables; raises PluginError if it is none."""
        owner = owner_of(self.restitution, f"impact law {name}")
        with blaming(owner):
            e = self.restitution(SMALL_RATE, *given)
        if not 0.0 < e <= 1.0:
            raise PluginError(
                f"{owner}: its restitution is {e:g} at a rate of {SMALL_RATE:g} rad/s, and"
                " must be above 0 and at most 1"
            )
        return e

    def taken(self) -> dict[Callable[..., float], int]:
        """Its compiled function, and how many numbers it takes."""
        return {self.restitution: 5 + len(self.constants)}
