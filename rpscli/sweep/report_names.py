"""Names in the options of reports that only the layout of a study can judge."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.faults import Fault, Path, dotted, listed, nearest, shown
from rpscli.case.study import Study
from rpscli.case.study_reports import LinesOptions, RotationOptions
from rpscli.case.study_requests import ReportRequest
from rpscli.sweep.results import KNOWN, is_result


def refuse_unknown_names(study: Study) -> None:
    """Refuse results that the analysis does not have, and values that a key does not take.

    Raises
    ------
    CaseError
        At the places of the names.
    """
    study.document.refuse(
        fault
        for request in study.reports
        for fault in (*_unknown_results(study, request), *_unknown_reference(study, request))
    )


def _unknown_results(study: Study, request: ReportRequest) -> Iterator[Fault]:
    options, analysis = request.options, study.file.analysis
    if not isinstance(options, LinesOptions):
        return
    varied = {key for axis in study.axes for key in axis.keys} | {"record", "scale"}
    named = [("x", options.x)] if options.x not in varied else []
    named += [("y", name) for name in options.y] + [("dashed", name) for name in options.dashed]
    for option, name in named:
        if not is_result(analysis, name):
            path: Path = (*request.path, request.kind, option)
            guess = nearest(name, KNOWN[analysis])
            hint = f"did you mean {guess}?" if guess else f"known are {listed(KNOWN[analysis])}"
            text = f"{dotted(path)} = {name} is no result of {analysis}"
            yield Fault(path, f"{text}{' and does not vary' * (option == 'x')}; {hint}")


def _unknown_reference(study: Study, request: ReportRequest) -> Iterator[Fault]:
    options = request.options
    if not isinstance(options, RotationOptions):
        return
    axis = study.axes[-1] if study.axes else None
    if options.key is not None:
        axis = next((axis for axis in study.axes if options.key in axis.keys), None)
    if axis is None:
        yield Fault(request.path, "the report rotation needs a varied key: systems to compare")
    elif options.reference is not None:
        place = axis.keys.index(options.key) if options.key else 0
        values = [row[place] for row in axis.rows]
        if options.reference not in values:
            path: Path = (*request.path, request.kind, "reference")
            text = f"{dotted(path)} = {shown(options.reference)} is no value of {axis.keys[place]}"
            yield Fault(path, f"{text}, which takes {listed(map(shown, values), 'and')}")
