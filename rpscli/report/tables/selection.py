"""Chosen motions as a JSON document, CSV tables, and a list that a study reads."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from rpscli.records.selection import Candidate, Selection
from rpscli.report.table import Column


def selection_document(selection: Selection) -> dict[str, Any]:
    """What was chosen, beside the target; SI units."""
    target = selection.target
    return {
        "target": {
            "name": target.name,
            "source": target.source,
            "damping": target.damping,
            "pgv": target.pgv,
            "pgd": target.pgd,
        },
        "periods": [float(selection.periods[0]), float(selection.periods[-1])],
        "candidates": selection.candidates,
        "refused": selection.refused,
        "misfit": selection.misfit,
        "least_ratio": selection.least_ratio,
        "mean_pgv": selection.mean_pgv,
        "mean_pgd": selection.mean_pgd,
        "motions": [
            {
                "source": one.motion.source,
                "factor": one.factor,
                "event": one.event,
                "pgv": one.factor * one.pgv,
                "pgd": one.factor * one.pgd,
                "misfit": one.misfit,
            }
            for one in selection.chosen
        ],
    }


def selection_columns(selection: Selection) -> list[Column]:
    """`selection.csv`: one row a motion, its peaks scaled."""
    chosen = selection.chosen
    return [
        Column("source", "-", [one.motion.source for one in chosen]),
        Column("factor", "-", [one.factor for one in chosen]),
        Column("event", "-", [one.event for one in chosen]),
        Column("pga", "m/s2", [one.factor * one.motion.pga for one in chosen]),
        Column("pgv", "m/s", [one.factor * one.pgv for one in chosen]),
        Column("pgd", "m", [one.factor * one.pgd for one in chosen]),
        Column("misfit", "-", [one.misfit for one in chosen]),
    ]


def mean_columns(selection: Selection) -> list[Column]:
    """`spectra.csv`: one row a period; target, mean, and every scaled motion."""
    return [
        Column("period", "s", selection.periods),
        Column("target", "m/s2", selection.wanted),
        Column("mean", "m/s2", selection.mean),
        *(
            Column(one.motion.name, "m/s2", one.factor * one.acceleration)
            for one in selection.chosen
        ),
    ]


def selection_list(selection: Selection, folder: Path) -> str:
    """`selection.txt`: one source with its factor a line, for `list:selection.txt` in a study.

    Parameters
    ----------
    selection
        Whose motions were read from the working folder.
    folder
        Where the list will stand; files are named as seen from there.
    """
    heads = (
        f"# {len(selection.chosen)} motions for {selection.target.source}",
        "# in a study: records: ['list:selection.txt'], with the path as seen from the study",
    )
    return "\n".join((*heads, *(_line(one, folder) for one in selection.chosen))) + "\n"


def _line(one: Candidate, folder: Path) -> str:
    place, mark, options = one.motion.source.partition("?")
    if Path(place).expanduser().is_file() and not Path(place).expanduser().is_absolute():
        place = Path(os.path.relpath(place, folder)).as_posix()
    return f"{place}?{options}{'&' * bool(mark)}factor={one.factor:g}"
