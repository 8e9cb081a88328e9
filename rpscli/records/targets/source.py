"""From what a user writes to a target spectrum."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rpscli.errors import RecordError
from rpscli.records.query import hint
from rpscli.records.targets import asce7, en1998, sp14
from rpscli.records.targets.table import table_spectrum
from rpscli.records.targets.target import TargetSpectrum

_CODES: dict[str, Callable[[str, str], TargetSpectrum]] = {
    en1998.SCHEME: en1998.en1998_spectrum,
    asce7.SCHEME: asce7.asce7_spectrum,
    sp14.SCHEME: sp14.sp14_spectrum,
}


def load_target(source: str) -> TargetSpectrum:
    """A spectrum of a code by its parameters, or from a CSV file.

    Parameters
    ----------
    source : str
        `en1998:?ag=0.3g&soil=B`, `asce7:?sds=1.0g&sd1=0.6g&tl=8`, `sp14:?acceleration=4 m/s2`, or a
        file: `target.csv`, `target.csv?damping=0.02`.

    Raises
    ------
    RecordError
        If it is none of them, or a parameter is missing or wrong.
    """
    scheme, colon, rest = source.partition(":")
    if colon and scheme in _CODES:
        return _CODES[scheme](rest, source)
    place, _, options = source.partition("?")
    path = Path(place)
    if path.is_file():
        return table_spectrum(path, options, source)
    if colon and len(scheme) > 1:
        raise RecordError(
            f"{source}: {scheme!r} is no code that is known; {hint(scheme, [*_CODES])}, or a file"
        )
    raise RecordError(
        f"{source}: there is no file {path}; give a CSV file or a code: {', '.join(_CODES)}"
    )
