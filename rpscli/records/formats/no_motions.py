"""What is no acceleration over time: curves, other quantities, steps of other samples.

They are refused with what was understood, what was not, and what to write.
"""

from __future__ import annotations

import re
from typing import NoReturn

from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.statements import Statement
from rpscli.records.formats.tables import Table, plain_line
from rpscli.records.formats.titles import (
    ACCELERATION,
    COUNT,
    MATCHED,
    TIME,
    ColumnTitle,
    title_of,
)
from rpscli.records.quantities import canonical_unit
from rpscli.records.words import (
    NO_SERIES,
    OTHER_QUANTITIES,
    folded,
    look_alikes,
    speaks_of,
    words_of,
)

_OF_ANOTHER_STEP = re.compile(
    r"\borig\w*|\binstrument\w*|\braw\b|\binitial\w*|\bbefore\b|\bformer\w*|\bnative\b"
)
_CHANGED_STEP = re.compile(
    r"every (?:second|third|fourth|other|\d+\w*) (?:sample|point|value)"
    r"|decimat\w*|thinned"
    r"|time (?:is )?(?:in (?:minutes|hours|min)\b|compressed|scaled|stretched)"
)


def refuse_other_steps(
    text: RecordText, steps: list[Statement], lines: list[tuple[int, str]]
) -> None:
    """Refuse a step of other samples, and words that say that samples were taken away."""
    stated_at = {each.line for each in steps}
    for index, line in lines:
        plain = folded(line)
        other = index in stated_at and _OF_ANOTHER_STEP.search(plain)
        if found := other or _CHANGED_STEP.search(plain):
            raise text.fault(
                f"{line.strip()[:60]!r} says {found[0]!r}, and the step may be another"
                " one; say it with its unit: ?dt=0.005 s",
                index,
            )


def refuse_other_quantities(
    text: RecordText, table: Table, titles: list[ColumnTitle]
) -> None:
    """Refuse columns of other quantities, and titles that are not understood."""
    if text.multiple is not None and len(titles) == 1:
        return  # the user says what a value is
    kinds = [title.kind for title in titles]
    for title, kind in zip(titles, kinds, strict=True):
        if kind == "a spectrum":
            raise text.fault(
                f"the title {title.name[:40]!r} is that of a spectrum, not of a record"
                " over time; give the acceleration record of the same station",
                title.line,
            )
    if text.columns is None:
        _refuse_spectra(text, table)
    if ACCELERATION not in kinds and text.multiple is None:
        _refuse_other_series(text, table)
    if titles and (ACCELERATION not in kinds or _lacks_time(titles, kinds)):
        _refuse_titles(text, titles, kinds)


MOST_WORDS = 6
"""Of a line that calls a table by what it holds."""


def _refuse_spectra(text: RecordText, table: Table) -> None:
    """Refuse a table under a line, or a name, that calls it a spectrum or a curve."""
    if text.multiple is not None:
        return
    lines = [(of.line, of.value) for of in table.header]
    for line, told in lines:
        plain = folded(told)
        short = len(words_of(told)) <= MOST_WORDS
        if short and speaks_of(told, NO_SERIES) and not MATCHED.search(plain):
            raise text.fault(
                f"the header says {told[:60]!r}: this is a spectrum or a curve, not a"
                " record over time; if it is one, say what the columns are:"
                f" ?columns={'time,' if table.widths[0] > 1 else ''}acceleration [UNIT]",
                line,
            )
    words = [
        word
        for word in words_of(text.path.stem)
        if word in NO_SERIES | OTHER_QUANTITIES
        and not MATCHED.search(folded(text.path.stem))
    ]
    if words:
        raise text.fault(
            f"its name says {words[0]!r}: this is a curve or another quantity, not an"
            " acceleration over time; if it is one, say what a value is: ?units=1 g"
        )


def _refuse_other_series(text: RecordText, table: Table) -> None:
    """Refuse velocities and displacements by a title anywhere in the header."""
    for line in table.header:
        for cell in re.split(r"[,;\t]|\s{2,}", line.value):
            title = title_of(plain_line(cell), line.line)
            is_title = title.name and not re.search(r"[\d:=]", cell)
            if is_title and title.kind in ("velocity", "displacement"):
                raise text.fault(
                    f"the header says {line.value[:60]!r}: this is a {title.kind} record;"
                    " give the acceleration record of the same station",
                    line.line,
                )


def _lacks_time(titles: list[ColumnTitle], kinds: list[str]) -> bool:
    """True of two columns of which one is no acceleration, no time and no count."""
    return len(titles) == 2 and not {*kinds} <= {TIME, ACCELERATION, COUNT}


def _refuse_titles(
    text: RecordText, titles: list[ColumnTitle], kinds: list[str]
) -> NoReturn:
    """Say what was understood of titles, what not, and what to write."""
    said = [
        f"{title.name[:30] or title.unit!r} is {kind or 'not understood'}"
        + ("" if kind else look_alikes(title.name))
        for title, kind in zip(titles, kinds, strict=True)
    ]
    units = [title.unit for title in titles if canonical_unit(title.unit or "-")]
    unit = units[0] if units else "g"
    wanted = ",".join(["time", f"acceleration [{unit}]", *["-"] * (len(titles) - 2)])
    raise text.fault(
        f"the titles are not those of a record over time: {'; '.join(said[:4])}; if it is"
        f" one, say what the columns are: ?columns={wanted}",
        titles[0].line,
    )
