"""Results of one point under their published names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rpscli.analyses import result_quantities as rq
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.result_quantities import ResultQuantity, plain
from rpscli.case.study.schema import Analysis
from rpscli.model.podium import PodiumStructure

Results = dict[str, Any]
"""Numbers, None, lists of numbers, and mappings of these; JSON-able."""

DONE = "done"
"""Outcome of an analysis that has no others."""

FAILED = "failed"

Named = dict[str, ResultQuantity]
"""Quantities by their dotted paths in the results of a point."""


def _named(
    quantities: Iterable[ResultQuantity], places: Iterable[str] = ("",), index: str = ""
) -> Named:
    known = tuple(quantities)
    return {f"{place}{q.name}{index}": q for place in places for q in known}


_FIXED, _ROLLING, _ROCKING = ("fixed_base.",), ("rolling.",), ("rocking.",)

SCALARS: dict[Analysis, Named] = {
    "timehistory": _named((*rq.HISTORY, *rq.SAMPLED, *rq.IMPACTS, *rq.INTENSITIES)),
    "modal": _named(rq.FIXED_BASE_MODES, _FIXED, ".0")
    | _named(rq.UPLIFTED_RATIOS, _ROLLING, ".0")
    | _named(rq.FREQUENCY_PARAMETERS, _ROLLING)
    | _named(rq.UPLIFTED_RATIOS, _ROCKING, ".0")
    | _named(rq.FREQUENCY_PARAMETERS, _ROCKING),
    "pushover": _named(rq.PUSHOVER),
}
"""Scalar results of each analysis, in the order of `points.csv`; modes count from 0."""

KNOWN: dict[Analysis, Named] = {
    "timehistory": SCALARS["timehistory"] | _named([rq.STOREY_SHEARS]),
    "modal": _named((*rq.FIXED_BASE_MODES, *rq.FIXED_BASE_SHAPES), _FIXED)
    | _named(
        (*rq.UPLIFTED_MODES, *rq.UPLIFTED_RATIOS, *rq.FREQUENCY_PARAMETERS, *rq.UPLIFTED_SHAPES),
        _ROLLING + _ROCKING,
    )
    | _named([rq.LEVEL]),
    "pushover": SCALARS["pushover"]
    | _named((*rq.STOREY_CURVE, *rq.STOREY_CURVE_RATIOS), ["curve."]),
}
"""Results that a report may name; elements of lists by their index, counted from 0."""


def quantity(analysis: Analysis, path: str) -> ResultQuantity | None:
    """The quantity at a dotted path; None if the analysis has no such result.

    >>> quantity("modal", "rolling.frequency_ratio.0").unit, quantity("modal", "rolling.period")
    ('-', None)
    """
    parts = path.split(".")
    while parts and parts[-1].isdecimal():
        parts.pop()
    return KNOWN[analysis].get(".".join(parts))


def parametric_results(analysis: Analysis, structure: PodiumStructure) -> Results:
    """Results of a modal or pushover analysis."""
    return _modal(structure) if analysis == "modal" else _pushover(structure)


def _modal(structure: PodiumStructure) -> Results:
    result = modal(structure)
    found: Results = {**result.results(), rq.LEVEL.name: list(range(structure.storeys + 1))}
    states = result.uplifted | ({"fixed_base": result.fixed_base} if result.fixed_base else {})
    for state, modes in states.items():
        found[state] |= plain(modes.profiles())
        found[state].pop(rq.EIGENVALUES.name, None)
    return found


def _pushover(structure: PodiumStructure) -> Results:
    result = pushover(structure)
    found = result.results()
    found["curve"] |= plain(result.curve_ratios())
    return found


def value_at(results: Results, path: str) -> Any:
    """The value at a dotted path; None where there is none (a mode that does not exist).

    >>> value_at({"rolling": {"frequency_ratio": [1.7, 1.2]}}, "rolling.frequency_ratio.0")
    1.7
    """
    value: Any = results
    if "." not in path:
        return value.get(path)
    for part in path.split("."):
        if isinstance(value, list):
            index = int(part) if part.isdecimal() else len(value)
            value = value[index] if index < len(value) else None
        else:
            value = value.get(part) if isinstance(value, dict) else None
    return value
