"""Rows of CSV text: the one reader of all tables that users give."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from rpscli.errors import CaseError, RpsError


def csv_rows(
    text: str, name: str | Path, fault: type[RpsError] = CaseError
) -> list[tuple[int, list[str]]]:
    """Rows that are not empty, each with the number of its
    line; blanks before cells go.
    """
    lines = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True)
    try:
        return [
            (lines.line_num, row) for row in lines if any(cell.strip() for cell in row)
        ]
    except csv.Error as error:
        line = lines.line_num
        raise fault(
            f"{name}:{line}: is not CSV: {error}; is a quote not closed?"
        ) from None
