"""Target spectra of users: a table of periods, accelerations and perhaps a scatter."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError, beginning
from rpscli.records.quantities import (
    ACCELERATIONS,
    HERTZ_PATTERN,
    KNOWN_UNITS,
    TIME_UNITS,
    canonical_unit,
)
from rpscli.records.words import folded, look_alikes
from rpscli.titled_table import (
    Row,
    Title,
    TitledTable,
    number_of,
    text_of,
    titled_table,
)

Array = NDArray[np.float64]


class Ordinates(NamedTuple):
    """Rows of a file: growing periods > 0 [s], accelerations in units of `factor`
    [m/s2], and sigma_ln if it `scatters`. The `pga` [m/s2] is that at the period 0, the
    `note` names columns that are not used.
    """

    cells: Array
    factor: float
    scatters: bool
    pga: float | None
    note: str


def read_ordinates(path: Path, source: str) -> Ordinates:
    """Read and check the rows of a CSV file."""
    table = _columns_of(path, source)
    factor = ACCELERATIONS[canonical_unit(table.titles[1].unit) or "m/s2"]
    scatters = _place_of_deviation(table)
    width = 3 if scatters else 2
    places = (0, 1, scatters)[:width]
    cells = np.array([_cells(row, places, path) for row in table.rows]).reshape(-1, width)
    cells = _over_periods(cells, table.titles[0].unit)
    unused = [n for place, n in enumerate(table.names) if place not in places]
    others = [
        title.name
        for place, title in enumerate(table.titles)
        if place > 1
        and place not in places
        and canonical_unit(title.unit or "-")
        and not re.search("total|absolute", title.name)  # beside pseudo-accelerations
    ]
    if others:
        raise RecordError(
            f"{path}:{table.line}: {table.titles[1].name!r} and {others[0]!r} are both"
            " accelerations, and one spectrum is wanted: keep the column that is meant"
        )
    _refuse_remarks(table, path)
    rigid = cells[cells[:, 0] == 0.0]  # 0 has no logarithm
    cells = cells[cells[:, 0] > 0.0]
    if len(cells) < 2 or (np.diff(cells[:, 0]) <= 0.0).any():
        raise RecordError(f"{path}: needs two rows at least, with periods that grow")
    pga = factor * float(rigid[0, 1]) if len(rigid) else None
    note = f"columns not used: {', '.join(unused)}" if unused else ""
    return Ordinates(cells, factor, bool(scatters), pga, note)


def _over_periods(cells: Array, unit: str) -> Array:
    """Rows over periods [s], of rows over periods in a unit of time or over
    frequencies.
    """
    if not re.fullmatch(HERTZ_PATTERN, folded(unit)):
        return cells * [TIME_UNITS[folded(unit)], *[1.0] * (cells.shape[1] - 1)]
    cells = cells[cells[:, 0] > 0.0][::-1]  # at the frequency 0 the period has no bound
    return np.column_stack([1.0 / cells[:, 0], cells[:, 1:]])


_PERIOD = re.compile(
    r"t|f|tn|t[_ ]?\d?|t_?n|natural period|"
    r"(?:\w+ )?(?:period\w*|peri[oy]d\w*|periyot\w*|schwing\w*|eigenperiode\w*"
    r"|freq\w*|frek\w*|период\w*|частот\w*|周期|固有周期|频率|周波数|okres\w*"
    r"|perioda"
    r"|περιοδο\w*)(?:[_ ]\w+)?"
)
"""Titles of periods and frequencies, folded."""


def _is_period(name: str) -> bool:
    """True of a title of periods or frequencies; also of none."""
    return not name or _PERIOD.fullmatch(folded(name)) is not None


def _is_of_periods(unit: str) -> bool:
    """True of a unit of periods or of frequencies."""
    return bool(unit) and (
        folded(unit) in TIME_UNITS
        or re.fullmatch(HERTZ_PATTERN, folded(unit)) is not None
    )


_OTHERWISE = re.compile(
    r"vertical|velocity|displacement|normali[sz]|normier|\bscale|\bfactor|faktor"
    r"|\btimes\b|multiply|inelastic|\bpsv\b|duration|\bdamp\w*\W{0,3}(?!5(?:\.0*)? ?%)\d"
    r"|(?<![\d.])(?!5(?:\.0*)? ?%)\d+(?:\.\d+)? ?%(?! ?in\b)"
    r"|(?!\b5(?:\.0*)? ?%)\b\d+(?:\.\d+)? ?% ?(?:of critical )?damp"
)
"""Words of remarks that say that ordinates are others than they look."""


def _refuse_remarks(table: TitledTable, path: Path) -> None:
    """Refuse remarks above or among rows that bear on what they are."""
    titled = [(table.line, title.name) for title in table.titles[:2]]
    for line, text in (*titled, *table.remarks):
        if match := _OTHERWISE.search(folded(text)):
            raise RecordError(
                f"{path}:{line}: {beginning(text)} says {match[0]!r}: write"
                " the ordinates that are meant, horizontal pseudo-accelerations, with"
                " ?damping= if it is not 5 %, and take these words away"
            )


_DEVIATION = re.compile(
    r"(?:sigma|beta|std|dispersion|σ|β)(?:ln)?(?:sa)?|(?:sigma|beta|std|stdev|sd"
    r"|σ)?lnsa(?:std|sd)?"
    r"|(?:stdev|sd|standarddeviation|σ)(?:of)?ln(?:sa)?|ln(?:std|sd|stdev|sigma)"
)
"""Names of the standard deviation of ln Sa, a plain number, without what parts words."""
_SCATTERS = re.compile(
    r"sigma|σ|\bstd|stdev|\bsd\b|standard|deviat|desv|sapma|streu|ecart|scarto|\bcov\b"
    r"|scatter"
    r"|dispers|variance|отклон|偏差|ばらつき|标准差|odchyl|τυπικη"
)
"""Words for some scatter, of which the measure is not told."""


def _place_of_deviation(table: TitledTable) -> int:
    """The column of the standard deviation of ln Sa; 0 without one."""
    for place, title in enumerate(table.titles[2:], 2):
        name = re.sub(r"[\W_]+", "", folded(title.name))
        if title.unit.lower() in ("", "ln") and _DEVIATION.fullmatch(name + title.unit):
            return place
    for title in table.titles[2:]:
        if _SCATTERS.search(folded(title.name)):
            raise RecordError(
                f"{table.source}:{table.line}: the column {title.name!r} may be the"
                f" scatter of"
                " the spectrum; call it sigma_ln [-] if it is the standard deviation of"
                " ln Sa, else remove it"
            )
    return 0


def _with_unit(title: Title) -> Title:
    """A title whose unit may stand behind `_`, as in `sa_g`."""
    name, mark, unit = title.name.rpartition("_")
    known = mark and not title.unit and (_is_of_periods(unit) or canonical_unit(unit))
    return Title(name, unit) if known else title


def _columns_of(path: Path, source: str) -> TitledTable:
    """The columns of a target, each understood by its title."""
    try:
        text = text_of(path.read_bytes())
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"{source}: cannot be read: {error}; name a CSV file") from None
    table = titled_table(text, path, RecordError)
    titles = tuple(map(_with_unit, table.titles))
    table = replace(table, titles=titles)
    known = len(titles) > 1 and canonical_unit(titles[1].unit) is not None
    named = titles and _is_period(titles[0].name)
    of_periods = titles and _is_of_periods(titles[0].unit)
    if not (known and named and of_periods):
        odd = [
            f"{title.name} [{title.unit}]{look_alikes(f'{title.name} {title.unit}')}"
            for title, right in zip(
                titles[:2], (named and of_periods, known), strict=False
            )
            if not right
        ]
        raise RecordError(
            f"{path}:{table.line}: {table.written} should name two columns with units,"
            " as in 'period [s],acceleration [g]' (or [ms], or a frequency in [Hz]);"
            f" accelerations are in {KNOWN_UNITS}"
            f" (not understood: {', '.join(odd) or 'one title only'})"
        )
    return table


def _cells(row: Row, places: Sequence[int], path: Path) -> list[float]:
    found = [number_of(row.cells[place]) for place in places]
    width = len(places)
    wrong = not np.isfinite(found).all()
    if wrong or not (min(found) >= 0.0 and found[1] > 0.0):
        also = ", and a sigma_ln >= 0" if width > 2 else ""
        raise RecordError(
            f"{path}:{row.line}: {beginning(','.join(row.cells[:width]))} must be a"
            f" period >= 0 and an acceleration > 0{also}"
        )
    return found
