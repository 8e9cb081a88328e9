"""The structure of a valid case file, or why there is none."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.build import bearing_of, built
from rpscli.case.rules import BEARING, COLUMN, DIMENSIONS, YIELD, Rules, at_key
from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.limits import LimitsSection
from rpscli.case.text.document import Document, Fault, path_of
from rpscli.model.podium import PodiumStructure


def structure_of(file: CaseFile, document: Document) -> PodiumStructure:
    """The structure of valid sections, if they are consistent and the model takes it."""
    rules = Rules(file, document)
    document.refuse(rules.faults())
    try:
        bearing = bearing_of(file.podium.bearing)
        document.refuse(rules.faults_of_bearing(bearing))
        structure = built(bearing, file)
        if structure.bed is not None:
            structure.bed.refuse_start(file.analysis.initial_rotation)
        document.refuse(too_weak(structure))
    except ValueError as error:
        raise document.refusal([refused_by_model(error, document)]) from None
    return structure


def limits_without_result(
    limits: LimitsSection, structure: PodiumStructure
) -> Iterator[Fault]:
    """Limits on results that the structure lacks, which would never be exceeded."""
    for quantity in LIMITED:
        lacking = quantity.lacks(structure)
        if lacking and getattr(limits, quantity.name) is not None:
            text = f" needs {lacking}; give that, or remove the limit"
            yield at_key(f"limits.{quantity.name}", text)


LEAST_STRENGTH = 1e-4
"""Of the weight of the floors: storeys that are weaker yield at every step, for hours."""


def too_weak(structure: PodiumStructure) -> Iterator[Fault]:
    """Storeys without strength to speak of."""
    above = structure.superstructure
    if above is not None and above.strengths is not None:
        least = float(above.strengths.min())
        weight = above.mass * structure.gravity
        if least < LEAST_STRENGTH * weight:
            text = (
                f": a strength of {least:.3g} N is less than a ten-thousandth of the"
                " weight of"
            )
            yield at_key(YIELD, f"{text} the floors, {weight:.3g} N; check its unit")


OF_THE_MODEL = {
    **{
        name: f"{BEARING}.{name}"
        for name in ("slenderness", "wedge_slenderness", "curvature_ratio")
    },
    "ends": f"{BEARING}.ends",
    "restitution": "podium.impact",
    "law": "podium.impact.restitution",
    "devices": "podium.devices",
    "yield_force": "podium.devices",
    "edge_length": f"{COLUMN}.edge_length",
    "rows": "podium.plan.rows",
    "rows_y": "podium.plan.y.rows",
    "contact": "podium.contact",
    "twist": "podium.twist",
    "factors": "podium.twist.factors",
    "scatter": "podium.twist.scatter",
    "pivot_friction": "podium.twist.pivot_friction",
    "seats": "podium.twist.seats",
    "initial_rotation": "analysis.initial_rotation",
}
"""Keys of a case by the word with which the model begins a refusal."""


def refused_by_model(error: ValueError, document: Document) -> Fault:
    """Fault for a refusal by the model, at the key that it is about."""
    text = str(error)
    key = OF_THE_MODEL.get(text.split(maxsplit=1)[0].strip(":,"), "podium")
    said = key == f"{BEARING}.ends"  # beside ratios and dimensions
    if document.has(path_of(DIMENSIONS)) and key.startswith(BEARING) and not said:
        key = DIMENSIONS
    parent, _, last = key.rpartition(".")
    named = text.startswith((f"{last} ", f"{last}:"))
    whole = f"{parent}.{text}" if named else f"{key}: {text}"
    return Fault(path_of(key), whole, at_key=not named)
