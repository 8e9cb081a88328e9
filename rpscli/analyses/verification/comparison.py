"""A number that is known beside the one that the program finds."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Known:
    """A number that should come out.

    Parameters
    ----------
    value
        In the unit of its quantity.
    tolerance
        Largest difference that is still agreement, absolute.
    """

    value: float
    tolerance: float


def printed(digits: str, units: float = 0.5) -> Known:
    """A printed number; the tolerance is half of its last digit, or so many of them.

    Parameters
    ----------
    digits
        As printed.
    units
        Tolerance in units of the last digit.

    >>> printed("0.2014")
    Known(value=0.2014, tolerance=5e-05)
    """
    decimals = len(digits.partition(".")[2])
    return Known(float(digits), float(f"{units * 10.0**-decimals:.6g}"))


def within(value: float, share: float) -> Known:
    """A number that holds up to a share of it.

    Parameters
    ----------
    value
        Of the number.
    share
        Tolerance over |value|.

    >>> within(-2.0, 0.01)
    Known(value=-2.0, tolerance=0.02)
    """
    return Known(value, abs(value) * share)


@dataclass(frozen=True)
class Comparison:
    """One line of a verification.

    Parameters
    ----------
    expected, computed
        In this unit.
    tolerance
        Largest difference that is still agreement, absolute.
    group
        What it belongs to, with the source of the expected value.
    quantity
        What is compared, of which structure.
    unit
        Of both values; ``-`` for plain numbers.
    """

    group: str
    quantity: str
    unit: str
    expected: float
    computed: float
    tolerance: float

    @property
    def holds(self) -> bool:
        """Whether the computed value is close enough; one that is no number never is."""
        return abs(self.computed - self.expected) <= self.tolerance


def compare(group: str, quantity: str, unit: str, known: Known, computed: float) -> Comparison:
    """The comparison of a known number with a computed one.

    Parameters
    ----------
    group, quantity, unit
        See `Comparison`.
    known
        What should come out, with its tolerance.
    computed
        What did.
    """
    return Comparison(group, quantity, unit, known.value, float(computed), known.tolerance)
