"""The answer of a search as a JSON document and as CSV tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rpscli.case.conditions import EVENTS, LIMITS
from rpscli.case.design import Objective
from rpscli.report.study.labels import key_columns, label, symbol
from rpscli.report.study.statistics import reached
from rpscli.report.table import Column
from rpscli.sweep.design.answer import NONE, Answer, Interval
from rpscli.sweep.design.judgement import Requirement
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.table import Array, Indices


def requirement_label(requirement: Requirement) -> str:
    """What is limited, and at which intensity."""
    words = requirement.condition.name
    if requirement.level is None:
        return words
    return f"{words} at {label(requirement.measure, requirement.level)}"


def requirement_unit(requirement: Requirement) -> str:
    """SI unit of its value."""
    name = requirement.condition.name
    return "-" if name in EVENTS else LIMITS[name].unit


def aim_label(aim: Objective) -> str:
    """A sum in words.

    >>> from rpscli.case.design import Term
    >>> aim_label({"podium.bearing.semi_diagonal": Term(times=2.0), "max_base_shear": Term()})
    '2 R + base shear, median'
    """
    terms = []
    for name, term in aim.items():
        known = LIMITS.get(name)
        fractile = "median" if term.fractile == 0.5 else f"{100.0 * term.fractile:g} % fractile"
        words = symbol(name) if known is None else f"{known.label}, {fractile}"
        terms.append(words if term.times == 1.0 else f"{term.times:g} {words}")
    return " + ".join(terms)


def aim_unit(aim: Objective) -> str:
    """SI unit of an aim of one term; ``-`` for a sum, which may be of anything."""
    if len(aim) != 1:
        return "-"
    ((name, term),) = aim.items()
    if term.times != 1.0:
        return "-"
    return LIMITS[name].unit if name in LIMITS else unit_of(name)


def answer_document(answer: Answer) -> dict[str, Any]:
    """Everything but the designs one by one, which are in `designs.csv`."""
    found = None if answer.best == NONE else answer.best
    return {
        "designs": {
            "looked_at": len(answer.places),
            "valid": int(answer.valid.sum()),
            "passing": int(answer.passes.sum()),
        },
        "least": [
            {"aim": aim_label(aim), "unit": aim_unit(aim)} for aim in answer.task.file.minimise
        ],
        "best": None if found is None else _design(answer, found),
        "robust": None if answer.robust == NONE else _design(answer, answer.robust),
        "closest": _design(answer, answer.closest),
        "requirements": requirement_rows(answer),
        "at_bounds": [{"key": key, "end": end} for key, end in answer.at_bounds],
        "front": [_design(answer, int(place)) for place in answer.front],
        "records": {
            "resamples": answer.resamples,
            "without_answer": answer.unanswered,
            "passing_share_of_best": None if found is None else answer.passing_share[found],
            "intervals": dict(_intervals(answer)),
            "without_one": _without_one(answer),
        },
        "bracket": answer.bracket if found is not None and len(answer.task.unknowns) == 1 else None,
    }


def _design(answer: Answer, place: int) -> dict[str, Any]:
    aims = zip(
        map(aim_label, answer.task.file.minimise), answer.judged.aims[:, 0, place], strict=True
    )
    return {
        "design": place + 1,
        "values": dict(zip(answer.task.keys, answer.values[place].tolist(), strict=True)),
        "aims": {name: float(value) for name, value in aims},
    }


def _intervals(answer: Answer) -> list[tuple[str, Interval]]:
    keys = [(key, answer.interval(place)) for place, key in enumerate(answer.task.keys)]
    return [*keys, (aim_label(answer.task.file.minimise[0]), answer.aim_interval)]


def _without_one(answer: Answer) -> list[dict[str, Any]]:
    """The best design when one record is left out, in the order of the records."""
    sources = answer.task.study.sources
    rows = []
    for source, place in zip(sources, answer.without_record.tolist(), strict=False):
        design = None if place == NONE else _design(answer, place)
        rows.append({"record": source, "best": design})
    return rows


def requirement_rows(answer: Answer) -> list[dict[str, Any]]:
    """Each requirement at the best design, or at the one that fails least."""
    judged, place = answer.judged, answer.closest
    without = {each.requirement: each for each in answer.without}
    rows = []
    for row, requirement in enumerate(judged.requirements):
        each = without.get(row)
        rows.append(
            {
                "requirement": requirement_label(requirement),
                **asdict(requirement.condition),
                "level": requirement.level,
                "value": float(judged.values[row, 0, place]),
                "bound": requirement.bound,
                "records_too_many": float(judged.excess[row, place]),
                "met": bool(judged.met[row, 0, place]),
                "designs_that_meet_it": int(judged.met[row, 0].sum()),
                "binds": None if each is None else each.binds,
                "aim_without_it": None if each is None else each.aim,
            }
        )
    return rows


def design_columns(answer: Answer, places: Indices | Sequence[int]) -> list[Column]:
    """One row a design: its keys, whether it passes, aims, and the value of each requirement.

    `passing_share` is the share of the resamples of the records in which it passes; a value that
    overturned is ``inf``, and cells of designs that are no valid case are empty.
    """
    judged, passing = answer.judged, answer.passing_share

    def column(name: str, unit: str, values: Array) -> Column:
        return Column(name, unit, [reached(float(values[place])) for place in places])

    columns = [Column("design", "-", [int(place) + 1 for place in places])]
    columns += key_columns(answer.task.keys, [answer.values[place].tolist() for place in places])
    for name, flags in (("valid", answer.valid), ("passes", answer.passes)):
        columns.append(Column(name, "-", [str(bool(flags[place])).lower() for place in places]))
    columns.append(column("passing_share", "-", passing))
    for row, aim in enumerate(answer.task.file.minimise):
        name = aim_label(aim).replace(",", "")
        columns.append(column(f"least {name}", aim_unit(aim), judged.aims[row, 0]))
    for row, requirement in enumerate(judged.requirements):
        name, unit = requirement_label(requirement), requirement_unit(requirement)
        columns.append(column(name, unit, judged.values[row, 0]))
        columns.append(column(f"{name}: records too many", "-", judged.excess[row]))
    return columns
