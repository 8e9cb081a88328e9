"""Target spectra: of codes by their parameters, or from a CSV
file, which is the sure way.

EN 1998-1:2004, EN 1998-1-1:2024, ASCE/SEI 7-16 and SP 14.13330.2018. None of the texts
was at hand: `checked` of each says what its formulae were compared with.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import (
    LARGEST,
    PluginError,
    RecordError,
    stem_of,
    told,
)
from rpscli.records.measures import Of
from rpscli.records.source import Query, hint, parse_query
from rpscli.records.target_table import read_ordinates
from rpscli.registry import Registry, owner_of

Array = NDArray[np.float64]
Shape = Callable[[Array], Array]  # periods (n,) [s] to pseudo-accelerations (n,) [m/s2]


Component = Of | Literal["srss"]
"""Kinds of spectra: measures of pairs, or the root of the sum of both squared spectra."""

NOT_VERIFIED = (
    "NOT VERIFIED"  # the beginning of statements that nothing was found to check
)
COMPONENTS: dict[Component, str] = {
    "component": "single components",
    "rotd50": "RotD50 of pairs",
    "rotd100": "RotD100 of pairs, the maximum direction",
    "geomean": "geometric means of pairs",
    "larger": "larger components of pairs",
    "x": "first components of pairs",
    "srss": "SRSS of both components of pairs",
}
"""As readers see them."""


@dataclass(frozen=True)
class TargetSpectrum:
    """The spectrum that the response spectra of motions are compared with, defined over a
    `span` of periods [s].

    `shape` is the pseudo-acceleration over the period. `pgv`, `pgd` and `pga` [m/s, m,
    m/s2] are peaks of the ground that go with it, None where the code gives none, the
    PGA that of a spectrum that does not begin with it, and `pgv_by` the origin of the
    PGV. `edition`, `parameters` (with units) and `level` (of shaking) are those of a
    code, `checked` says against what its formulae were compared, `rules` are its name
    after `--rules`. `damping` is a share of critical damping, `of` the kind of the
    ordinates, None if it is not said. `deviation` is the standard deviation of ln Sa
    over the period, None if motions need not scatter, and `pinned` [s] the conditioning
    period, at which that is zero.
    """

    name: str
    source: str
    shape: Shape
    pgv: float | None
    pgd: float | None = None
    damping: float = 0.05
    span: tuple[float, float] = (0.0, math.inf)
    edition: str = "as the file has it"
    checked: str = "the user's own"
    rules: str = "mean90"
    of: Component | None = None
    parameters: str = ""
    level: str = ""
    pgv_by: str = (
        "pseudo-velocity at 1 s over 1.65, a convention of Hazus, not of the code"
    )
    deviation: Shape | None = None
    pinned: float | None = None
    pga: float | None = None

    def __post_init__(self) -> None:
        """Refuse peaks, damping and periods that no spectrum has."""
        for name in ("pgv", "pgd", "pga", "pinned"):
            value = getattr(self, name)
            if value is not None and not 0.0 < value <= LARGEST:
                raise ValueError(f"{name} = {told(value)} must be > 0")
        if not 0.0 < self.damping < 1.0:
            raise ValueError(f"damping = {told(self.damping)} must be > 0 and < 1")
        low, high = self.span
        if not 0.0 <= low < high:
            raise ValueError(f"span = {self.span} must be two periods >= 0 that grow")

    @property
    def ground_acceleration(self) -> float | None:
        """PGA that goes with it; None if it has no value at T = 0 [m/s2]."""
        return float(self.shape(np.zeros(1))[0]) if self.span[0] == 0.0 else self.pga

    def acceleration(self, periods: Array) -> Array:
        """Pseudo-acceleration at periods (n,) [s], (n,) [m/s2]."""
        low, high = self.span
        outside = (periods < low * (1.0 - 1e-9)) | (periods > high * (1.0 + 1e-9))
        if outside.any():
            raise RecordError(
                f"{self.source}: has no value at {periods[outside][0]:g} s; it is defined"
                f" from {low:g} to {high:g} s: choose --periods within"
            )
        found = self.shape(np.clip(periods, low, high))
        if np.any(found < 0.0) or np.any(found > LARGEST):
            owner = owner_of(self.shape, self.source)
            raise PluginError(
                f"{owner}: its ordinates are {np.min(found):g} to {np.max(found):g} m/s2,"
                f" and must be at least 0 and at most {LARGEST:g}"
            )
        return found


def _velocity_of(shape: Shape) -> float:
    """PGV [m/s] that goes with a 5 % spectrum: its pseudo-velocity at 1 s over 1.65.

    That ratio is the median of Newmark and Hall, 1982, in FEMA, Hazus-MH 2.1, Earthquake
    Model Technical Manual, section 4.1. Later studies (Earthquake Spectra 31, 2015) let
    it grow with the magnitude: it is a convention.
    """
    return float(shape(np.ones(1))[0]) / (2.0 * math.pi) / 1.65


def _cornered(
    start: float, plateau: float, corners: tuple[float, float, float, float]
) -> Shape:
    """A spectrum of four corners: level, linear to a plateau,
    then over T and over T^2.
    """
    T_A, T_B, T_C, T_D = corners

    def shape(T: Array) -> Array:
        rising = start + (plateau - start) * (np.maximum(T, T_A) - T_A) / (T_B - T_A)
        falling = np.minimum(1.0, T_C / np.maximum(T, T_C))
        falling = plateau * falling * np.minimum(1.0, T_D / np.maximum(T, T_D))
        return np.where(T_B > T, rising, falling)

    return shape


def _in_words(seconds: dict[str, float] | None = None, **accelerations: float) -> str:
    """Parameters as readers see them."""
    words = [
        f"{name} = {a / STANDARD_GRAVITY:.3g} g" for name, a in accelerations.items()
    ]
    return ", ".join(
        [*words, *(f"{name} = {t:.3g} s" for name, t in (seconds or {}).items())]
    )


_EN1998_SOILS = {
    "1": {
        "A": (1.00, 0.15, 0.4, 2.0),
        "B": (1.20, 0.15, 0.5, 2.0),
        "C": (1.15, 0.20, 0.6, 2.0),
        "D": (1.35, 0.20, 0.8, 2.0),
        "E": (1.40, 0.15, 0.5, 2.0),
    },
    "2": {
        "A": (1.00, 0.05, 0.25, 1.2),
        "B": (1.35, 0.05, 0.25, 1.2),
        "C": (1.50, 0.10, 0.25, 1.2),
        "D": (1.80, 0.10, 0.30, 1.2),
        "E": (1.60, 0.05, 0.25, 1.2),
    },
}
"""S, T_B, T_C, T_D [s] by type and ground type: tables 3.2 and
3.3, recommended values."""

_NATIONAL = {"s": "ratio", "tb": "time", "tc": "time", "td": "time"}
"""Parameters that a national annex may set."""

_EN1998_LONGEST = 4.0
"""Period at which the clause ends [s]."""


def _en1998(rest: str, source: str) -> TargetSpectrum:
    """Elastic spectrum of clause 3.2.2.2, expressions (3.2) to (3.6),
    `ag=0.3g&soil=B&type=1`.

    a_g is that of ground type A with the importance factor. From a_g S to 2.5 a_g S eta
    at T_B, corners T_C and T_D, up to 4 s; eta = sqrt(10/(5 + xi)) >= 0.55 with xi in per
    cent. The peak displacement is d_g = 0.025 a_g S T_C T_D, expression (3.12).
    """
    query = parse_query(
        rest.lstrip("?"), source, ("ag", "soil", "type", "damping", *_NATIONAL)
    )
    kind = query.choice("type", "1", [*_EN1998_SOILS])
    soil = query.choice("soil", "A", [*_EN1998_SOILS[kind]])
    S, T_B, T_C, T_D = _en1998_soil(query, _EN1998_SOILS[kind][soil], source)
    a_g = query.acceleration("ag", bare=False)
    damping = query.quantity("damping", "ratio", 0.05)
    if a_g <= 0.0 or not 0.0 <= damping < 1.0:
        raise RecordError(f"{source}: ag must be > 0 and damping in [0, 1); 5 % is 0.05")
    eta = max(0.55, math.sqrt(10.0 / (5.0 + 100.0 * damping)))
    start = a_g * S
    corners = (0.0, T_B, T_C, T_D)
    own = [key for key in _NATIONAL if key in query.values]
    by = (
        f"the user's {', '.join(own)}" if own else "recommended values, no national annex"
    )
    return TargetSpectrum(
        f"EN 1998-1 type {kind}, ground {soil}" + ", national" * bool(own),
        source,
        _cornered(start, 2.5 * start * eta, corners),
        _velocity_of(_cornered(start, 2.5 * start, corners)),
        0.025 * start * T_C * T_D,
        damping,
        (0.0, _EN1998_LONGEST),
        edition=f"EN 1998-1:2004, 3.2.2.2, without amendment A1:2013, {by}",
        checked=(
            "tables and expressions compared with public implementations and with"
            " manuals of programs, not with the text"
        ),
        rules="en1998",
        parameters=f"S = {S:.3g}, {_in_words({'T_B': T_B, 'T_C': T_C, 'T_D': T_D}, a_g=a_g)}",
    )


def _en1998_soil(
    query: Query, usual: tuple[float, float, float, float], source: str
) -> tuple[float, float, float, float]:
    """S, T_B, T_C and T_D, of which a national annex may set each."""
    S, T_B, T_C, T_D = (
        query.quantity(key, unit, value)
        for (key, unit), value in zip(_NATIONAL.items(), usual, strict=True)
    )
    if not (S > 0.0 and 0.0 < T_B < T_C < T_D <= _EN1998_LONGEST):
        raise RecordError(
            f"{source}: must have s > 0 and 0 < tb < tc < td <= {_EN1998_LONGEST:g} s"
        )
    return S, T_B, T_C, T_D


def _en1998_2024(rest: str, source: str) -> TargetSpectrum:
    """Elastic spectrum of EN 1998-1-1:2024, 5.2.2.2, at 5 %:
    `s_alpha=0.9g&s_beta=0.35g&td=2`.

    S_alpha and S_beta are those of the site, with F_T F_alpha and F_T F_beta.
    T_D is 2 s where S_beta,RP on rock is at most 1 m/s2, else 1 s and as many
    seconds as that has m/s2.

    From S_alpha/F_A, F_A = 2.5, up to T_A = 0.02 s, to S_alpha at T_B, corners T_C =
    S_beta/S_alpha x 1 s and T_D. T_B is T_C/4 within 0.05 and 0.1 s. It is left at 6 s,
    where the displacement spectrum goes on with other parameters. The peak velocity is
    0.06 (S_alpha S_beta)^0.55 in m/s and m/s2.
    """
    query = parse_query(rest.lstrip("?"), source, ("s_alpha", "s_beta", "td"))
    short, long = (query.acceleration(key, bare=False) for key in ("s_alpha", "s_beta"))
    T_D = query.quantity("td", "time")
    if not (short > 0.0 and 0.05 < long / short < T_D <= 6.0):
        raise RecordError(
            f"{source}: s_alpha and s_beta must be > 0, and 0.05 < s_beta/s_alpha < td <="
            " 6, in s"
        )
    T_C = long / short
    return TargetSpectrum(
        "EN 1998-1-1:2024",
        source,
        _cornered(0.4 * short, short, (0.02, min(max(T_C / 4.0, 0.05), 0.1), T_C, T_D)),
        0.06 * (short * long) ** 0.55,
        span=(0.0, 6.0),
        edition=(
            "EN 1998-1-1:2024, 5.2.2.2, without national annex; what its annex D asks"
            " of motions is not checked"
        ),
        checked=(
            "formulae compared with two public implementations (PEUSP-beta, and rshalib"
            " of the draft of 2019), not with the text"
        ),
        pgv_by="0.06 (S_alpha S_beta)^0.55 of the code",
        parameters=_in_words({"T_D": T_D}, S_alpha=short, S_beta=long),
    )


def _asce7(rest: str, source: str) -> TargetSpectrum:
    """Design spectrum of clause 11.4.6, equations (11.4-5) to (11.4-7), at 5 % damping.

    `sds=1.0g&sd1=0.6g&tl=8`; `level=mcer` is 1.5 times that (11.4.7), which chapters 16
    and 17 ask for, for the maximum direction of pairs. From 0.4 S_DS to S_DS at T_0 = 0.2
    T_S, corners T_S = S_D1/S_DS (with S_D1 as the acceleration at 1 s) and T_L.
    """
    query = parse_query(rest.lstrip("?"), source, ("sds", "sd1", "tl", "level"))
    mcer = query.choice("level", "design", ["design", "mcer"]) == "mcer"
    S_DS, S_D1 = (query.acceleration(key, bare=False) for key in ("sds", "sd1"))
    T_L = query.quantity("tl", "time")
    times = 1.5 if mcer else 1.0
    if not (S_DS > 0.0 and 0.0 < S_D1 / S_DS < T_L):
        raise RecordError(
            f"{source}: sds and sd1 must be > 0, and sd1/sds, in s, below tl"
        )
    T_S = S_D1 / S_DS
    shape = _cornered(0.4 * times * S_DS, times * S_DS, (0.0, 0.2 * T_S, T_S, T_L))
    return TargetSpectrum(
        f"ASCE 7, {'MCE_R' if mcer else 'design'}",
        source,
        shape,
        _velocity_of(shape),
        edition=(
            "ASCE/SEI 7-16, 11.4.6, two-period; give the multi-period one of 7-22 as CSV"
        ),
        checked="equations compared with manuals of programs, not with the text",
        rules="asce7-ch16",
        of="rotd100",
        parameters=_in_words({"TL": T_L}, SDS=S_DS, SD1=S_D1) + ", times 1.5" * mcer,
        level="MCE_R" if mcer else "design",
    )


def _sp14(rest: str, source: str) -> TargetSpectrum:
    """A times the dynamic coefficient beta(T) of clause 5.6, at 5 % damping.

    A is the acceleration of the site: 1, 2 and 4 m/s2 for intensities 7, 8 and 9 (clause
    5.5). beta = 1 + 15 T up to 0.1 s, 2.5 up to 0.4 s (categories I and II) or 0.8 s (III
    and IV), then 2.5 sqrt(0.4/T) or 2.5 sqrt(0.8/T), nowhere less than 0.8. The reduction
    factor of structures that may be damaged is not in it.
    """
    query = parse_query(rest.lstrip("?"), source, ("acceleration", "soil"))
    corners = {"I": 0.4, "II": 0.4, "III": 0.8, "IV": 0.8}
    soil = query.choice("soil", "II", [*corners])
    A = query.acceleration("acceleration")
    corner = corners[soil]
    if A <= 0.0:
        raise RecordError(
            f"{source}: acceleration must be > 0; it is 4 m/s2 for intensity 9"
        )

    def shape(T: Array) -> Array:
        falling = 2.5 * np.sqrt(corner / np.maximum(T, corner))
        return A * np.where(T <= 0.1, 1.0 + 15.0 * T, np.maximum(falling, 0.8))

    return TargetSpectrum(
        f"SP 14.13330, soil {soil}",
        source,
        shape,
        _velocity_of(shape),
        edition=(
            "SP 14.13330.2018, 5.5 and 5.6, as first published: without amendment No. 1"
            " (Изменение № 1) and all later ones"
        ),
        parameters=_in_words(A=A),
        checked=(
            f"{NOT_VERIFIED}: from memory; supply the spectrum as a CSV file where it"
            " matters"
        ),
    )


CODES: Registry[Callable[[str, str], TargetSpectrum]] = Registry(
    "targets",
    {"en1998": _en1998, "en1998-2024": _en1998_2024, "asce7": _asce7, "sp14": _sp14},
    Callable[[str, str], TargetSpectrum],
)
"""Spectra of what follows a name and its colon, and of the whole source."""


def load_target(source: str) -> TargetSpectrum:
    """A spectrum of a code by its parameters, or from a CSV file."""
    scheme, colon, rest = source.partition(":")
    if colon and scheme.lower() in ("sprk", "sp_rk", "ntprk", "ntp_rk"):
        raise RecordError(
            f"{source}: the spectra of SP RK 2.03-30-2017 and NTP RK 08-01 could not be"
            " verified and are not those of sp14; give the spectrum as a CSV file"
        )
    if colon and (
        scheme in CODES or scheme in CODES.names()
    ):  # others are looked for last
        return CODES[scheme](rest, source)
    place, _, options = source.partition("?")
    if (path := Path(place)).is_file():
        return _table(path, options, source)
    known = CODES.names()
    fault = f"there is no file {path}; give a CSV file or a code: {', '.join(known)}"
    if colon and len(scheme) > 1:
        fault = f"{scheme!r} is not a known code; {hint(scheme, known)}, or a file"
    raise RecordError(f"{source}: {fault}")


def _table(path: Path, options: str, source: str) -> TargetSpectrum:
    """Columns period and acceleration, linear between logarithms,
    and perhaps `sigma_ln [-]`.
    """
    # With the third one, the standard deviation of ln Sa, the acceleration is the median.
    table = read_ordinates(path, source)
    cells = table.cells
    known = np.log(cells[:, :2])

    def shape(T: Array) -> Array:
        return np.asarray(table.factor * np.exp(np.interp(np.log(T), *known.T)))

    def deviation(T: Array) -> Array:
        return np.asarray(np.interp(np.log(T), known[:, 0], cells[:, 2]))

    query = parse_query(options, source, ("damping", "component", "level"))
    damping = query.quantity("damping", "ratio", 0.05)
    of = query.choice("component", "", get_args(Of))
    first = float(cells[0, 0])
    last = float(cells[-1, 0])
    pinned = table.scatters and not cells[:, 2].all()
    return TargetSpectrum(
        stem_of(path),
        source,
        shape,
        _velocity_of(shape) if damping == 0.05 and first <= 1.0 <= last else None,
        damping=damping,
        span=(first, last),
        of=cast("Of", of) if of else None,
        parameters=table.note,
        level=query.values.get("level") or "",
        deviation=deviation if table.scatters else None,
        pga=table.pga,
        pinned=float(cells[np.argmin(cells[:, 2]), 0]) if pinned else None,
    )
