"""What `rps identify CASE pull-back` tells."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from rpscli.case.case import Case
from rpscli.commands.inputs import CaseInput, case_heading
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, announce_compilation, passing_time
from rpscli.errors import AnalysisError, UsageError
from rpscli.report.files import heading
from rpscli.report.table import Heading, Part, Table, shown
from rpscli.tools.identify.pull_options import PullRequest, range_of, ranges_given

if TYPE_CHECKING:
    from rpscli.tools.identify.estimates import Estimate
    from rpscli.tools.identify.pull_back import Pull, PullBack, Times

REMARKS = (
    "an interval has every value that brings the building to rest in the time that was"
    " seen with one combination or more of {combinations}, evenly spread over the ranges:"
    " it is no probability, and as wide as they are. `held` stays where it was pushed."
    " Slenderness is that of columns with a flat part, lever that of rolling resistance"
    " on spherical ends: two numbers do not tell which of them stand. The building is"
    " pushed"
    " at the cap beam and unstrained when it is let go; what else the case says is taken"
    " as it is"
)


def told_pull_back(given: CaseInput, pull: PullRequest, terminal: Terminal) -> None:
    """Find what fits a test, and tell it."""
    from rpscli.tools.identify.pull_back import COMBINATIONS, pull_back

    test = _test(pull)
    announce_compilation(terminal)
    with passing_time("fitting", terminal):
        found = pull_back(
            given.case.structure, test, ranges_given(pull.ranges), COMBINATIONS
        )
    remarks = REMARKS.format(combinations=COMBINATIONS)
    keys = _keys(given.case, found)
    document = {
        **heading("identify"),
        "case": case_heading(given),
        "test": "pull-back",
        **_of_estimates(found),
        "keys": keys,
        "measured": test._asdict(),
        "ranges": found.ranges,
        "histories": found.histories,
        "combinations": COMBINATIONS,
        "rest_by_slenderness": [_plain(row) for row in found.by_slenderness],
        "rest_by_lever": [_plain(row) for row in found.by_lever],
        "remarks": remarks,
        "warnings": given.case.warnings,
        "files": [],
    }
    fault = None if found.slenderness else AnalysisError(_nothing(found, test.rest))
    tables = [Heading(given.case.title), *_tables(found, keys), remarks]
    terminal.finish(document, tables, fault)


def _test(pull: PullRequest) -> Pull:
    """What was seen, as it was typed; refuse what is missing."""
    from rpscli.tools.identify.pull_back import Pull

    wanted = {
        "displacement": (pull.displacement, "m", "10..13 cm"),
        "rest": (pull.rest, "s", "10..15 s"),
    }
    seen = {}
    for name, (text, unit, example) in wanted.items():
        if text is None:
            raise UsageError(f"pull-back needs --{name}; write --{name} '{example}'")
        seen[name] = range_of(f"--{name}", text, unit)
    within, _ = range_of("--within", pull.within, "m")
    return Pull(seen["displacement"], seen["rest"], within)


def _of_estimates(found: PullBack) -> dict[str, Any]:
    """Estimates in the form of other tests; nothing for what no pull has."""
    return {
        "level": None,
        "estimates": [
            {"name": name, "unit": unit, **value._asdict()}
            for name, unit, value in _estimates(found)
        ],
        "misfit": None,
        "ensembles": False,
        "residuals": [],
        "sensor": None,
    }


def _estimates(found: PullBack) -> Iterator[tuple[str, str, Estimate]]:
    """Those that fit, with their names and units."""
    for name, unit in (("slenderness", "-"), ("lever", "m")):
        value = getattr(found, name)
        if value is not None:
            yield name, unit, value


def _nothing(found: PullBack, rest: tuple[float, float]) -> str:
    """Why no slenderness fits."""
    medians = [row.median for row in found.by_slenderness if math.isfinite(row.median)]
    ends = f"{min(medians):.3g} to {max(medians):.3g} s" if medians else "never"
    return (
        f"no slenderness brings this building to rest after {rest[0]:g} to {rest[1]:g} s;"
        f" medians over the combinations are {ends}: look at the displacement and its"
        " unit, and at the ranges, or the model lacks what stopped it"
    )


def _keys(case: Case, found: PullBack) -> dict[str, str]:
    """The slenderness as keys of the case, where it is determined."""
    value = found.slenderness
    if value is None or not value.determined:
        return {}
    bearing = case.structure.bearing
    wedge = value.value * bearing.wedge_slenderness / bearing.slenderness
    if (sizes := case.file.podium.bearing.dimensions) is not None:
        names = "dimensions.width", "dimensions.wedge_width"
        size = sizes.height
    else:
        names = "slenderness", "wedge_slenderness"
        size = 1.0
    values = (size * value.value, size * wedge)
    pairs = zip(names, values, strict=True)
    return {f"podium.bearing.{name}": f"{number:.3g}" for name, number in pairs}


def _plain(row: Times) -> dict[str, Any]:
    """A row for JSON, which has no infinite numbers."""
    return {
        name: value if isinstance(value, int) or math.isfinite(value) else None
        for name, value in row._asdict().items()
    }


def _tables(found: PullBack, keys: dict[str, str]) -> Iterator[Part]:
    rows = [
        (name, *(shown(number, 3) for number in value), unit.strip("-"))
        for name, unit, value in _estimates(found)
    ]
    if rows:
        yield Table.of_texts(("", "value", "from", "to", "unit"), rows)
    from rpscli.tools.identify.pull_back import UNKNOWN

    ranges = [
        (name, *(shown(end, 4) for end in ends), UNKNOWN[name].unit.strip("-"))
        for name, ends in found.ranges.items()
    ]
    yield Table.of_texts(("not known", "from", "to", "unit"), ranges)
    yield _times("tan(alpha)", found.by_slenderness)
    yield _times("lever m", found.by_lever)
    if keys:
        sets = options.set_words(f"{key}={value}" for key, value in keys.items())
        yield f"in the case, or behind it: {shlex.join(sets)}"


def _times(head: str, rows: Sequence[Times]) -> Table:
    """Times to rest over the combinations, for each value of what is looked for."""
    heads = (head, "at rest after s", "median", "largest", "overturn, or not so far")
    texts = [
        (shown(row.value, 3), *map(_time, row[1:4]), str(row.overturned)) for row in rows
    ]
    return Table.of_texts(heads, texts, words=0)


def _time(value: float) -> str:
    """A time, and words where there is none."""
    if math.isnan(value):
        return "-"
    if value == 0.0:
        return "held"
    return "later" if math.isinf(value) else f"{value:.1f}"
