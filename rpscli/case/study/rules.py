"""Rules that join several keys of a study, and how large it may be."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.keys import field_at, unknown_key
from rpscli.case.study.axes import Axis
from rpscli.case.study.reports import ReportKinds, ReportRequest, varied_keys
from rpscli.case.study.schema import MeasureScale, StudyFile
from rpscli.case.text.document import Document, Fault, Path, dotted
from rpscli.errors import listed

OF_HISTORIES = ("records", "scale", "perturb", "observed", "hazard")
"""Keys of a study that only time histories have."""

OF_POINTS = ("record", "scale")
"""Axes of the product that are no case keys; reports may name them."""


def _varied(document: Document) -> Iterator[tuple[str, Path]]:
    """Every key that varies or is sampled, and where it stands."""
    vary = document.content.get("vary")
    axes: list[Path] = [("vary", i) for i in range(len(vary) if isinstance(vary, list) else 0)]
    for owner in (*axes, ("sample", "ranges"), ("variables",), ("linked",)):  # of designs as well
        written = document.at(owner)
        yield from ((key, (*owner, key)) for key in (written if isinstance(written, dict) else ()))


def varied_paths(document: Document) -> dict[str, Path]:
    """Every key that varies or is sampled, once."""
    return dict(_varied(document))


def unknown_keys(document: Document) -> Iterator[Fault]:
    """Varied and sampled keys that the case format does not know."""
    for key, place in varied_paths(document).items():
        path: Path = tuple(part for part in key.split(".") if not part.isdecimal())
        if not path or field_at(CaseFile, path) is None:
            hint = unknown_key(CaseFile, path or (key,))[0].text
            yield Fault(place, hint, at_key=True)


def twice(document: Document) -> Iterator[Fault]:
    """Keys that vary twice, or together with a part of themselves."""
    seen: dict[str, Path] = {}
    for key, path in _varied(document):
        if key in seen:
            axis = " in another axis" if path[0] == seen[key][0] == "vary" else ""
            text = f"{key} varies already{axis}{document.where(seen[key])}; remove one of them"
            yield Fault(path, text, at_key=True)
        seen[key] = path
    names = sorted(seen)
    for name in names:
        if inside := [other for other in names if other.startswith(f"{name}.")]:
            text = f"{name} varies as a whole; {listed(inside, 'and')} inside it must not vary too"
            yield Fault(seen[name], text, at_key=True)


def fixed_faults(document: Document, overrides: Sequence[str]) -> Iterator[Fault]:
    """Overrides of the base that the study would put its own values over."""
    for text in overrides:
        key = text.partition("=")[0].strip()
        for varied, path in varied_paths(document).items():
            if key == varied or key.startswith(f"{varied}.") or varied.startswith(f"{key}."):
                message = f"{varied} varies in the study; --set {text} cannot fix it"
                yield Fault(path, message, at_key=True)


def analysis_rules(
    file: StudyFile, requests: tuple[ReportRequest, ...], kinds: ReportKinds
) -> Iterator[Fault]:
    """Keys and reports without a meaning with a modal or pushover analysis."""
    if file.analysis == "timehistory":
        return
    for key in OF_HISTORIES:
        if key in file.model_fields_set:
            text = f"{key} has no meaning with analysis: {file.analysis}; remove it"
            yield Fault((key,), text, at_key=True)
    suitable = listed(name for name, kind in kinds.items() if file.analysis in kind.analyses)
    for request in requests:
        if file.analysis not in (needed := kinds[request.kind].analyses):
            text = f"the report {request.kind} needs analysis: {listed(needed)}"
            yield Fault(request.path, f"{text}; {suitable} suits {file.analysis}")


def record_rules(document: Document) -> Iterator[Fault]:
    """The record is said once: by the study's list, or by the case and its varied keys."""
    for key, path in varied_paths(document).items():
        owner = None
        if key == "record" or key.startswith("record."):
            owner = "records" if document.has(("records",)) else None
        if key in {"record", "record.scale"} and document.has(("scale",)):
            owner = "scale"
        if owner:
            where = document.where((owner,))
            text = f"{key} must not vary beside {owner}{where}; remove one of them"
            yield Fault(path, text, at_key=True)


def reliability_rules(document: Document) -> Iterator[Fault]:
    """A limit on a rate needs to know how often motions come."""
    for key in ("annual_rate", "probability_in_50_years"):
        if document.has(("limits", key)) and not document.has(("hazard",)):
            text = f"limits.{key} needs a hazard curve; add `hazard: {{file: FILE, measure: PGV}}`"
            yield Fault(("limits", key), text, at_key=True)


def report_rules(
    document: Document,
    file: StudyFile,
    axes: Sequence[Axis],
    requests: tuple[ReportRequest, ...],
    kinds: ReportKinds,
) -> Iterator[Fault]:
    """Keys that reports name must vary; each kind has rules of its own."""
    known = [*(key for axis in axes for key in axis.keys), *OF_POINTS]
    for request in requests:
        kind = kinds[request.kind]
        faults = [
            Fault(
                path := (*request.path, request.kind, *option),
                f"{dotted(path)} = {key} does not vary in this study; use {listed(known)}",
            )
            for option, key in varied_keys(request.options)
            if key not in known
        ]
        if not faults and file.analysis in kind.analyses:
            faults.extend(kind.check(document, axes, request))
        yield from faults


MOST_SYSTEMS = 200_000
"""Each is checked as a case before anything runs, which takes a millisecond."""

MOST_POINTS = 5_000_000
"""Their results, some thirty numbers each, are in memory when reports are drawn."""


def size_faults(file: StudyFile, axes: Sequence[Axis], sources: Sequence[str]) -> Iterator[Fault]:
    """A study that is too large, at its largest part."""
    systems: dict[Path, int] = {("vary", i): len(axis.rows) for i, axis in enumerate(axes)}
    if file.sample is not None:
        systems["sample", "size"] = file.sample.size
    others: dict[Path, int] = {("records",): max(len(sources), 1)}
    if file.scale is not None:
        values = file.scale.values if isinstance(file.scale, MeasureScale) else file.scale
        others["scale",] = len(values)
    if file.perturb is not None:
        others["perturb", "members"] = file.perturb.members
    for parts, most, name in (
        (systems, MOST_SYSTEMS, "systems"),
        (systems | others, MOST_POINTS, "points"),
    ):
        if (count := math.prod(parts.values())) > most:
            product = " x ".join(str(part) for part in parts.values() if part > 1)
            largest = max(parts, key=lambda path: parts[path])
            yield Fault(
                largest,
                f"the study has {count} {name} ({product}), which must not be more than {most};"
                " use fewer values, or several studies",
            )
            return
