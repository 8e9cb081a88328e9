"""Target spectra of codes by their parameters; which one is meant.

EN 1998-1:2004, EN 1998-1-1:2024, ASCE/SEI 7-16 and SP 14.13330.2018. None of the texts was at hand:
`checked` of each says what its formulae were compared with. A CSV file is the sure way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.quantities import hint, parse_query
from rpscli.records.requirements import NOT_VERIFIED
from rpscli.records.target import Array, TargetSpectrum, table_spectrum, velocity_of
from rpscli.registry import Registry

EN1998_SOILS = {
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
"""S, T_B, T_C, T_D [s] by type and ground type: tables 3.2 and 3.3, recommended values."""

_NATIONAL = {"s": "ratio", "tb": "time", "tc": "time", "td": "time"}
"""Parameters that a national annex may set."""

EN1998_LONGEST = 4.0
"""Where clause 3.2.2.2 ends [s]."""


def _told(*, seconds: dict[str, float], **accelerations: float) -> str:
    """Parameters as readers see them."""
    in_g = {name: f"{a / STANDARD_GRAVITY:.3g} g" for name, a in accelerations.items()}
    all_of = in_g | {name: f"{time:.3g} s" for name, time in seconds.items()}
    return ", ".join(f"{name} = {value}" for name, value in all_of.items())


def en1998_spectrum(rest: str, source: str) -> TargetSpectrum:
    """Elastic spectrum of clause 3.2.2.2, expressions (3.2) to (3.6), `ag=0.3g&soil=B&type=1`.

    a_g is that of ground type A with the importance factor. The parameters of a national annex
    replace those of the tables: `s=1.3&tb=0.1&tc=0.4&td=2.5` [-, s].

    Up to T_B: a_g S (1 + T/T_B (2.5 eta - 1)); to T_C: 2.5 a_g S eta; to T_D: that times T_C/T;
    to 4 s: times T_C T_D/T^2; eta = sqrt(10/(5 + xi)) >= 0.55 with xi in per cent. The peak
    displacement is d_g = 0.025 a_g S T_C T_D, expression (3.12).

    >>> target = en1998_spectrum("?ag=2 m/s2&soil=C", "")
    >>> target.acceleration(np.array([0.0, 0.1, 0.3, 1.2, 4.0])).round(5).tolist()
    [2.3, 4.025, 5.75, 2.875, 0.43125]
    >>> round(target.pgd, 5)
    0.069
    """
    query = parse_query(rest.lstrip("?"), source, ("ag", "soil", "type", "damping", *_NATIONAL))
    kind, soil = query.values.get("type", "1"), query.values.get("soil", "A").upper()
    for word, given, known in (("type", kind, EN1998_SOILS), ("soil", soil, EN1998_SOILS["1"])):
        if given not in known:
            raise RecordError(f"{source}: {word} = {given!r} is not known; {hint(given, [*known])}")
    usual = zip(_NATIONAL.items(), EN1998_SOILS[kind][soil], strict=True)
    S, T_B, T_C, T_D = (query.quantity(key, unit, value) for (key, unit), value in usual)
    if not (S > 0.0 and 0.0 < T_B < T_C < T_D <= EN1998_LONGEST):
        raise RecordError(f"{source}: must have s > 0 and 0 < tb < tc < td <= {EN1998_LONGEST:g} s")
    a_g, damping = query.acceleration("ag", bare=False), query.quantity("damping", "ratio", 0.05)
    if a_g <= 0.0 or not 0.0 <= damping < 1.0:
        raise RecordError(f"{source}: ag must be > 0 and damping in [0, 1); 5 % is 0.05")
    eta = max(0.55, math.sqrt(10.0 / (5.0 + 100.0 * damping)))

    def shape(T: Array, eta: float = eta) -> Array:
        rising = 1.0 + T / T_B * (2.5 * eta - 1.0)
        falling = 2.5 * eta * np.minimum(1.0, T_C / np.maximum(T, T_C))
        falling *= np.minimum(1.0, T_D / np.maximum(T, T_D))
        return a_g * S * np.where(T_B > T, rising, falling)

    name = f"EN 1998-1 type {kind}, ground {soil}"
    own = [key for key in _NATIONAL if key in query.values]
    pgv, pgd = velocity_of(lambda T: shape(T, 1.0)), 0.025 * a_g * S * T_C * T_D
    return TargetSpectrum(
        f"{name}, national" if own else name,
        source,
        shape,
        pgv,
        pgd,
        damping,
        (0.0, EN1998_LONGEST),
        edition="EN 1998-1:2004, 3.2.2.2, whatever A1:2013 changes, "
        + (f"the user's {', '.join(own)}" if own else "recommended values, no national annex"),
        checked="tables and expressions compared with public implementations and with manuals of"
        " programs, not with the text",
        rules="en1998",
        parameters=f"S = {S:.3g}, " + _told(a_g=a_g, seconds={"T_B": T_B, "T_C": T_C, "T_D": T_D}),
    )


def en1998_2024_spectrum(rest: str, source: str) -> TargetSpectrum:
    """Elastic spectrum of EN 1998-1-1:2024, 5.2.2.2, at 5 %: `s_alpha=0.9g&s_beta=0.35g&td=2`.

    S_alpha and S_beta are those of the site, with F_T F_alpha and F_T F_beta. T_D is 2 s where
    S_beta,RP on rock is at most 1 m/s2, else 1 s and as many seconds as that has m/s2.

    S_alpha/F_A up to T_A, with F_A = 2.5 and T_A = 0.02 s; linear to S_alpha at T_B; S_alpha to
    T_C = S_beta/S_alpha x 1 s; S_beta/T to T_D; S_beta T_D/T^2. T_B is T_C/4 within 0.05 and 0.1 s.
    It is left at 6 s, where the displacement spectrum goes on with other parameters. The peak
    velocity is 0.06 (S_alpha S_beta)^0.55 in m/s and m/s2.

    >>> target = en1998_2024_spectrum("?s_alpha=10 m/s2&s_beta=4 m/s2&td=2", "")
    >>> target.acceleration(np.array([0.01, 0.06, 0.1, 0.4, 1.0, 4.0])).round(6).tolist()
    [4.0, 7.0, 10.0, 10.0, 4.0, 0.5]
    """
    query = parse_query(rest.lstrip("?"), source, ("s_alpha", "s_beta", "td"))
    short, long = (query.acceleration(key, bare=False) for key in ("s_alpha", "s_beta"))
    T_D = query.quantity("td", "time")
    if not (short > 0.0 and 0.05 < long / short < T_D <= 6.0):
        raise RecordError(
            f"{source}: s_alpha and s_beta must be > 0, and 0.05 < s_beta/s_alpha < td <= 6, in s"
        )
    T_A, T_C = 0.02, long / short
    T_B = min(max(T_C / 4.0, 0.05), 0.1)

    def shape(T: Array) -> Array:
        rising = short * (0.4 + 0.6 * (np.maximum(T, T_A) - T_A) / (T_B - T_A))
        falling = long / np.maximum(T, T_C) * np.minimum(1.0, T_D / np.maximum(T, T_D))
        return np.where(T_B > T, rising, falling)

    return TargetSpectrum(
        "EN 1998-1-1:2024",
        source,
        shape,
        0.06 * (short * long) ** 0.55,
        span=(0.0, 6.0),
        edition="EN 1998-1-1:2024, 5.2.2.2, without national annex; what its annex D asks of"
        " motions is not checked",
        checked="formulae compared with two public implementations (PEUSP-beta, and rshalib of the"
        " draft of 2019), not with the text",
        pgv_by="0.06 (S_alpha S_beta)^0.55 of the code",
        parameters=_told(S_alpha=short, S_beta=long, seconds={"T_D": T_D}),
    )


ASCE7_LEVELS = {"design": 1.0, "mcer": 1.5}
"""Factors on the design spectrum: clauses 11.4.6 and 11.4.7."""


def asce7_spectrum(rest: str, source: str) -> TargetSpectrum:
    """Design spectrum of clause 11.4.6, equations (11.4-5) to (11.4-7), at 5 % damping.

    `sds=1.0g&sd1=0.6g&tl=8`; `level=mcer` is 1.5 times that, which chapters 16 and 17 ask for, for
    the maximum direction of pairs. The multi-period spectrum of ASCE/SEI 7-22 is a CSV file.

    Up to T_0 = 0.2 T_S: S_DS (0.4 + 0.6 T/T_0); to T_S = S_D1/S_DS: S_DS; to T_L: S_D1/T (with
    S_D1 as the acceleration at 1 s); beyond: S_D1 T_L/T^2. The code gives no peak displacement.

    >>> target = asce7_spectrum("?sds=10 m/s2&sd1=6 m/s2&tl=4", "")
    >>> target.acceleration(np.array([0.0, 0.06, 0.3, 1.2, 4.0, 8.0])).round(6).tolist()
    [4.0, 7.0, 10.0, 5.0, 1.5, 0.375]
    """
    query = parse_query(rest.lstrip("?"), source, ("sds", "sd1", "tl", "level"))
    level = query.values.get("level", "design").lower()
    if level not in ASCE7_LEVELS:
        raise RecordError(
            f"{source}: level = {level!r} is not known; {hint(level, [*ASCE7_LEVELS])}"
        )
    S_DS, S_D1 = (query.acceleration(key, bare=False) for key in ("sds", "sd1"))
    short, long = ASCE7_LEVELS[level] * S_DS, ASCE7_LEVELS[level] * S_D1
    T_L = query.quantity("tl", "time")
    if not (short > 0.0 and 0.0 < long / short < T_L):
        raise RecordError(f"{source}: sds and sd1 must be > 0, and sd1/sds, in s, below tl")
    T_S = long / short
    T_0 = 0.2 * T_S

    def shape(T: Array) -> Array:
        rising = short * (0.4 + 0.6 * T / T_0)
        falling = long / np.maximum(T, T_S) * np.minimum(1.0, T_L / np.maximum(T, T_L))
        return np.where(T_0 > T, rising, falling)

    name = f"ASCE 7, {'MCE_R' if level == 'mcer' else 'design'}"
    return TargetSpectrum(
        name,
        source,
        shape,
        velocity_of(shape),
        edition="ASCE/SEI 7-16, 11.4.6, two-period; give the multi-period one of 7-22 as CSV",
        checked="equations compared with manuals of programs, not with the text",
        rules="asce7-ch16",
        of="rotd100",
        parameters=_told(SDS=S_DS, SD1=S_D1, seconds={"TL": T_L})
        + (", times 1.5" if level == "mcer" else ""),
        level="MCE_R" if level == "mcer" else "design",
    )


SP14_CORNERS = {"I": 0.4, "II": 0.4, "III": 0.8, "IV": 0.8}
"""End of the plateau [s] by soil category, clause 5.6."""

SP14_LEAST = 0.8
"""Of the dynamic coefficient, clause 5.6."""


def sp14_spectrum(rest: str, source: str) -> TargetSpectrum:
    """A times the dynamic coefficient beta(T) of clause 5.6, at 5 % damping.

    A is the acceleration of the site: 1, 2 and 4 m/s2 for intensities 7, 8 and 9 (clause 5.5).

    beta = 1 + 15 T up to 0.1 s, 2.5 up to 0.4 s (categories I and II) or 0.8 s (III and IV), then
    2.5 sqrt(0.4/T) or 2.5 sqrt(0.8/T), nowhere less than 0.8. The reduction factor of structures
    that may be damaged is not in it. The code gives no peak displacement.

    >>> target = sp14_spectrum("?acceleration=2 m/s2&soil=III", "")
    >>> target.acceleration(np.array([0.0, 0.05, 0.5, 3.2, 20.0])).round(6).tolist()
    [2.0, 3.5, 5.0, 2.5, 1.6]
    """
    query = parse_query(rest.lstrip("?"), source, ("acceleration", "soil"))
    soil = query.values.get("soil", "II").upper()
    if soil not in SP14_CORNERS:
        raise RecordError(f"{source}: soil = {soil!r} is not known; {hint(soil, [*SP14_CORNERS])}")
    A, corner = query.acceleration("acceleration"), SP14_CORNERS[soil]
    if A <= 0.0:
        raise RecordError(f"{source}: acceleration must be > 0; it is 4 m/s2 for intensity 9")

    def shape(T: Array) -> Array:
        falling = 2.5 * np.sqrt(corner / np.maximum(T, corner))
        return A * np.where(T <= 0.1, 1.0 + 15.0 * T, np.maximum(falling, SP14_LEAST))

    return TargetSpectrum(
        f"SP 14.13330, soil {soil}",
        source,
        shape,
        velocity_of(shape),
        edition="SP 14.13330.2018 without its amendments, 5.5 and 5.6",
        parameters=_told(A=A, seconds={}),
        checked=f"{NOT_VERIFIED}: from memory; supply the spectrum as a CSV file where it matters",
    )


CODES: Registry[Callable[[str, str], TargetSpectrum]] = Registry(
    "targets",
    {
        "en1998": en1998_spectrum,
        "en1998-2024": en1998_2024_spectrum,
        "asce7": asce7_spectrum,
        "sp14": sp14_spectrum,
    },
)
"""Spectra of what follows a name and its colon, and of the whole source."""

_UNKNOWN = ("sprk", "sp_rk", "ntprk", "ntp_rk")
"""SP RK 2.03-30-2017 and NTP RK 08-01, which are not SP 14.13330 and whose text was not found."""


def load_target(source: str) -> TargetSpectrum:
    """A spectrum of a code by its parameters, or from a CSV file."""
    scheme, colon, rest = source.partition(":")
    if colon and scheme.lower() in _UNKNOWN:
        raise RecordError(
            f"{source}: the spectra of SP RK 2.03-30-2017 and NTP RK 08-01 could not be verified"
            " and are not those of sp14; give the spectrum as a CSV file"
        )
    place, _, options = source.partition("?")
    path = Path(place)
    if colon and (scheme in CODES or scheme in CODES.names()):  # others are looked for last
        return CODES[scheme](rest, source)
    if path.is_file():
        return table_spectrum(path, options, source)
    known = CODES.names()
    if colon and len(scheme) > 1:
        raise RecordError(
            f"{source}: {scheme!r} is not a known code; {hint(scheme, known)}, or a file"
        )
    raise RecordError(
        f"{source}: there is no file {path}; give a CSV file or a code: {', '.join(known)}"
    )
