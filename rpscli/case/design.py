"""Design files: what may change in a case, what is required of it, and what is to be least."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, NamedTuple, Self, TypeGuard

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    WithJsonSchema,
    model_validator,
)

from rpscli.analyses.result_quantities import DEMANDS, SAMPLED
from rpscli.case.overrides import apply_overrides
from rpscli.case.schema.check import schema_check
from rpscli.case.schema.fields import LARGEST, Quantity, Section, Whole, is_finite, must_be, refuse
from rpscli.case.schema.keys import is_whole, unit
from rpscli.case.schema.limits import Fractile
from rpscli.case.study.axes import Axis, sources_of
from rpscli.case.study.rules import fixed_faults, record_rules, twice, unknown_keys, varied_paths
from rpscli.case.study.schema import Seed, Share, Sources, StudyParts
from rpscli.case.study.study import Study, shared_out, study_of
from rpscli.case.text.document import Document, Fault, is_case, is_design
from rpscli.case.text.document import Path as KeyPath
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError, hint, listed
from rpscli.records.clusters import clusters
from rpscli.registry import Registry
from rpscli.units import in_si

PLUS = "plus"
"""What is added to a linear sum."""


OLD_WORDS = {"find": "variables", "ties": "linked", "least": "minimise", "confirm": "validate"}
"""Keys of designs that had other names; understood, with a note, in this version only."""

Array = NDArray[np.float64]

DIGITS = 6
"""Of what is linked to the values of a design: nobody builds more, and files stay readable."""
STEPS = 3
"""Decimals of a range, or of its least end, to which values are rounded, judged and printed."""
TOLERANCE = 0.01
"""Of what is built, as a share of each value."""


class Term(Section):
    """One term of what is minimised."""

    times: Annotated[float, Quantity()] = 1.0
    """factor, in SI units"""
    fractile: Fractile = 0.5
    """of a result over the records; its median by default"""

    @model_validator(mode="before")
    @classmethod
    def _factor_alone(cls, value: object) -> object:
        return value if isinstance(value, dict | Term) else {"times": value}


Objective = dict[str, Term]
"""A linear sum of results and keys, by their names."""


def _sum(value: object) -> object:
    """A name alone, or a sum."""
    if isinstance(value, str) and value.strip():
        return {value: {}}
    if not isinstance(value, dict) or not value:
        refuse(
            "must be a key or a result, or a sum such as"
            " {max_base_shear: 1e-6, podium.bearing.dimensions.width: 0.5}"
        )
    return value


def _one_or_two(value: object) -> object:
    several = value if isinstance(value, list | tuple) else [value]
    if not 1 <= len(several) <= 2:
        refuse("must be one objective, or a list of two")
    return several


_SUM = {"type": "object", "minProperties": 1}
_ONE = {
    "anyOf": [
        {"type": "string", "minLength": 1},
        _SUM | {"additionalProperties": {"anyOf": [{"type": "number"}, Term.model_json_schema()]}},
    ]
}
Objectives = Annotated[
    tuple[Annotated[Objective, BeforeValidator(_sum)], ...],
    BeforeValidator(_one_or_two),
    WithJsonSchema({"anyOf": [*_ONE["anyOf"], {"type": "array", "items": _ONE, "maxItems": 2}]}),
]


class Unknown(NamedTuple):
    """A key that may change, and its range in SI units."""

    key: str
    low: float
    high: float

    @property
    def digits(self) -> int:
        """Decimals of its values, which tell the ends of the range and a thousandth of it."""
        sizes = [size for size in (abs(self.low), abs(self.high), self.high - self.low) if size]
        return STEPS - math.floor(math.log10(min(sizes)))


def _is_number(value: object) -> TypeGuard[float]:
    """A number whose sums and products with others stay finite."""
    return is_finite(value) and abs(value) <= LARGEST


def _with_keys(value: dict[str, object]) -> dict[str, object]:
    return {key: (key, bounds) for key, bounds in value.items()}


def _unknown(given: tuple[str, object]) -> Unknown:
    """The range of a key, in SI units."""
    key, bounds = given
    si = in_si(bounds, unit(key))
    if not isinstance(si, list) or len(si) != 2 or not all(map(_is_number, si)):
        words = "numbers" if unit(key) == "-" else f"numbers in {unit(key)} or with a unit"
        refuse(f"must be two {words}, [least, largest], up to {LARGEST:g}")
    if not si[0] < si[1]:
        refuse(
            "must rise from the least value to the largest; exchange them, or leave the key to the"
            " case"
        )
    return Unknown(key, float(si[0]), float(si[1]))


def _linear(terms: object) -> dict[str, float]:
    if not isinstance(terms, dict) or not all(map(_is_number, terms.values())):
        refuse(f"must be a linear sum, {{key: factor, plus: number}}, of numbers up to {LARGEST:g}")
    return terms


_BOUNDS = {"type": "array", "items": {"type": ["number", "string"]}, "minItems": 2, "maxItems": 2}
Variables = Annotated[
    dict[str, Annotated[Unknown, PlainValidator(_unknown), WithJsonSchema(_BOUNDS)]],
    BeforeValidator(_with_keys),
    must_be(
        dict, "keys with their ranges, as in {podium.bearing.slenderness: [0.1, 0.3]}", filled=True
    ),
]
_TERMS = {"type": "object", "additionalProperties": {"type": "number"}}
Sums = dict[str, Annotated[dict[str, float], PlainValidator(_linear), WithJsonSchema(_TERMS)]]


class SearchSection(Section):
    """How many designs are looked at; what is left out follows from the number of unknowns."""

    first: Annotated[int, Whole(4, 65_536)] | None = None
    """designs of the first, even sample"""
    most: Annotated[int, Whole(4, 65_536)] | None = None
    """designs in all; four times the first ones by default"""
    resolution: Annotated[float, Quantity(above=0, below=1)] = 0.005
    """distance to which designs close in, as a share of each range"""
    resamples: Annotated[int, Whole(0, 10_000)] = 500
    """bootstrap samples of the records; 0 = none"""
    seed: Seed = 1
    """of the sample and the bootstrap"""


Tolerance = Annotated[
    Annotated[dict[str, Share], Tag("each")] | Annotated[Share, Tag("all")],
    Discriminator(lambda value: "each" if isinstance(value, dict) else "all"),
]
"""One share of the values, or one of each key."""


class ValidateSection(Section):
    """Motions that the search does not see."""

    records: Sources | None = None
    """record sources, as in a study"""
    share: Annotated[float, Quantity(above=0, below=1)] | None = None
    """share of the design's own recordings that is held out, in place of them"""
    seed: Seed = 1
    """of the draw of what is held out"""

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.records is None) == (self.share is None):
            refuse("must have records or a share of the design's own, and not both")
        return self


class DesignFile(StudyParts):
    """A design: the values of some keys of a case that meet the limits and minimise something."""

    variables: Variables
    """dotted case keys with [least, largest]: what may change"""
    linked: Sums = Field(
        {}, description="further keys as linear sums of these, {key: factor, plus: constant}"
    )
    minimise: Objectives
    """what is minimised: a result, a key, or a sum of them; two for their front"""
    # pydantic's models have a method validate.
    validation: ValidateSection | None = Field(
        None, alias="validate", description="motions to validate the design with"
    )
    tolerance: Tolerance = TOLERANCE
    """by how much what is built may differ, as a share of the values, or {key: share}: 1 %"""
    search: SearchSection = SearchSection()
    """how many designs are looked at"""


@dataclass(frozen=True, eq=False)
class DesignTask:
    """What is looked for."""

    study: Study
    file: DesignFile
    confirming: tuple[str, ...]

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """What may change."""
        return tuple(self.file.variables.values())

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys that change: the unknowns, and what is linked to them."""
        return (*(unknown.key for unknown in self.unknowns), *self.file.linked)

    def values(self, places: Array) -> Array:
        """(designs, keys) values in SI units."""
        low = np.array([unknown.low for unknown in self.unknowns])
        high = np.array([unknown.high for unknown in self.unknowns])
        found = {
            unknown.key: _rounded(unknown, column)
            for unknown, column in zip(self.unknowns, (low + (high - low) * places).T, strict=True)
        }
        for key, terms in self.file.linked.items():
            sums = (terms[name] * found[name] for name in terms if name != PLUS)
            total = sum(sums, np.full(len(places), terms.get(PLUS, 0.0)))
            found[key] = np.array([float(f"{value:.{DIGITS}g}") for value in total.tolist()])
            if is_whole(key):
                found[key] = np.round(total)
        return np.column_stack(list(found.values()))

    def tolerances(self, places: Array) -> Array:
        """(designs, unknowns) tolerances of places in the unit cube."""
        given, keys = self.file.tolerance, [unknown.key for unknown in self.unknowns]
        each = given if isinstance(given, dict) else dict.fromkeys(keys, given)
        of = [each.get(key, TOLERANCE) for key in keys]
        low = np.array([unknown.low for unknown in self.unknowns])
        wide = np.array([unknown.high for unknown in self.unknowns]) - low
        return np.asarray(np.array(of) * np.abs(low + wide * places) / wide)

    def rows(self, values: Array) -> tuple[tuple[float | int, ...], ...]:
        """The values of each design as a case takes them."""
        whole = [is_whole(key) for key in self.keys]
        return tuple(
            tuple(int(value) if is_int else value for value, is_int in zip(row, whole, strict=True))
            for row in values.tolist()
        )

    @cached_property
    def clusters(self) -> tuple[int, ...]:
        """Numbers of the recordings, or events, of the records of the search."""
        sources = self.study.sources
        # Without any it is the case's own record.
        return clusters(sources, self.study.folder, self.file.independent) if sources else (0,)

    def study_of(self, values: Array, sources: tuple[str, ...] | None = None) -> Study:
        """The study of some designs, (designs, keys), under the design's records or others."""
        places = tuple((self.study.document.value_place(self.path(key)),) for key in self.keys)
        axis = Axis(self.keys, self.rows(values), places)
        own = self.study.sources if sources is None else sources
        return replace(self.study, axes=(axis,), sources=own)

    def path(self, key: str) -> tuple[str, str]:
        """Where a key stands in the file."""
        return "linked" if key in self.file.linked else "variables", key


def _rounded(unknown: Unknown, values: Array) -> Array:
    digits = 0 if is_whole(unknown.key) else unknown.digits
    return np.array([round(value, digits) for value in values.tolist()])


def read_design(source: str, overrides: Sequence[str] = ()) -> DesignTask:
    """A design task from a file, or from the standard input (``-``)."""
    piped = source == "-"
    folder = Path() if piped else Path(source).parent
    return parse_design(
        read_text(source), "<stdin>" if piped else source, folder=folder, overrides=overrides
    )


def parse_design(
    text: str, name: str, *, folder: Path | None = None, overrides: Sequence[str] = ()
) -> DesignTask:
    """A design task from its text."""
    folder = folder or Path()
    document = read_yaml(text, name)
    if not is_design(document):
        kind = "case" if is_case(document) else "study" if "base" in document.content else "file"
        raise CaseError(
            f"{name}: this is a {kind} without `variables`, but a design is needed here: a base"
            " case, variables, records, limits and minimise; see `rps explain variables`"
        )
    document, notes = _in_new_words(document)
    overrides, more = _overrides_in_new_words(overrides)
    of_design, of_base = shared_out(overrides, DesignFile)
    document = apply_overrides(document, of_design, model=DesignFile)
    check = schema_check(DesignFile, document)
    confirming, source_faults = _confirming(document, folder)
    faults = [*check.faults, *source_faults, *sources_of(document, folder)[1]]
    faults += [*_fixed_properties(document), *unknown_keys(document), *twice(document)]
    faults += record_rules(document)
    document.refuse([*faults, *fixed_faults(document, of_base)])
    file = check.read
    assert file is not None, "without faults the file is read"
    document.refuse(_name_faults(file))
    shared = {k: v for k, v in document.content.items() if k in StudyParts.model_fields}
    study = study_of(
        replace(document, content=shared),
        of_base,
        kinds=Registry("none", {}),
        folder=folder,
        digest=hashlib.sha256(text.encode()).hexdigest(),
    )
    used, held_out = _used_and_held_out(document, file, study, confirming)
    study = replace(study, document=document, sources=used, notes=(*notes, *more, *study.notes))
    return DesignTask(study, file, held_out)


def _in_new_words(document: Document) -> tuple[Document, list[str]]:
    """The document with the keys of today, and what to say of older ones."""
    old = [word for word in OLD_WORDS if word in document.content]
    document.refuse(
        Fault(
            (word,),
            f"{word} is the old word for {OLD_WORDS[word]}, which is given here as well"
            f"{document.where((OLD_WORDS[word],))}; remove one of them",
            at_key=True,
        )
        for word in old
        if OLD_WORDS[word] in document.content
    )

    def path(old: KeyPath) -> KeyPath:
        return (OLD_WORDS.get(str(old[0]), old[0]), *old[1:]) if old else old

    notes = [f"{document.key_place((word,))}: {_note(word)}" for word in old]
    renamed = replace(
        document,
        content={OLD_WORDS.get(key, key): value for key, value in document.content.items()},
        keys={path(old): place for old, place in document.keys.items()},
        values={path(old): place for old, place in document.values.items()},
        faults=tuple(replace(fault, path=path(fault.path)) for fault in document.faults),
    )
    return renamed, notes


def _overrides_in_new_words(overrides: Sequence[str]) -> tuple[list[str], list[str]]:
    renamed, notes = [], []
    for text in overrides:
        word, rest = re.split(r"(?=[.=])|$", text.strip(), maxsplit=1)
        if word in OLD_WORDS:
            notes.append(f"--set {text}: {_note(word)}")
        renamed.append(OLD_WORDS.get(word, word) + rest)
    return renamed, notes


def _note(word: str) -> str:
    return f"{word} is an old word; write {OLD_WORDS[word]}, version 2 knows only that"


def _used_and_held_out(
    document: Document, file: DesignFile, study: Study, confirming: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Records of the search, and those that the design is validated on."""
    sources, folder = study.sources, study.folder
    used, held_out, section = sources, tuple(confirming), file.validation
    if section is not None and section.share is not None:
        cluster = clusters(used, folder, file.independent)
        used, held_out = _shared(used, cluster, section.share, section.seed)
    else:
        cluster = clusters((*used, *held_out), folder, file.independent)
        known = set(cluster[: len(used)])
        others = zip(held_out, cluster[len(used) :], strict=True)
        if both := [source for source, number in others if number in known]:
            text = (
                f"validate.records has {listed(both[:3], 'and')}, whose {file.independent[:-1]} the"
                " search uses already; name other motions"
            )
            document.refuse([Fault(("validate", "records"), text)])
    if section is not None and not (used and held_out):
        text = f"validate.share = {section.share} of {len(sources)} records leaves none"
        document.refuse([Fault(("validate",), f"{text} on one side; give more records")])
    return used, held_out


def _fixed_properties(document: Document) -> Iterator[Fault]:
    """Keys that are no property of the structure."""
    for key, place in varied_paths(document).items():
        if key.split(".")[0] in {"limits", "analysis", "rps", "title", "record"}:
            text = f"{key} must not change in a design; it is not a property of the structure"
            yield Fault(place, text, at_key=True)


def _name_faults(file: DesignFile) -> Iterator[Fault]:
    """Names that are not keys that change, or in what is minimised not results either."""
    known, keys = [*file.variables, PLUS], [*file.variables, *file.linked]
    for name in file.tolerance if isinstance(file.tolerance, dict) else ():
        if name not in file.variables:
            text = f"tolerance.{name} is not under variables; use {listed([*file.variables])}"
            yield Fault(("tolerance", name), text, at_key=True)
    for key, sums in file.linked.items():
        for name in (name for name in sums if name not in known):
            text = f"linked.{key} needs {name}, which is not under variables"
            yield Fault(("linked", key), f"{text}; use {listed(known)}")
    sampled = {quantity.name for quantity in SAMPLED}
    results = {quantity.name for quantity in DEMANDS}
    terms = [term for objective in file.minimise for term in objective.items()]
    for name in dict.fromkeys(name for name, _ in terms):
        if name in sampled and not file.whole_histories:
            text = f"{name} needs `whole_histories: true`; add it"
        elif name not in keys and name not in results:
            suggestion = hint(name, [*keys, *results], f"use {listed(keys)}, or a result")
            text = f"{name} is neither a result nor a key that `variables` changes; {suggestion}"
        elif name in keys and any(n == name and "fractile" in t.model_fields_set for n, t in terms):
            text = f"{name} is a key, without fractiles; remove it"
        else:
            continue
        yield Fault(("minimise",), f"minimise: {text}")


def _confirming(document: Document, folder: Path) -> tuple[tuple[str, ...], list[Fault]]:
    """Sources under `validate.records`, and what is wrong with them."""
    if not isinstance(document.content.get("validate"), dict):
        return (), []
    sources, faults, _ = sources_of(document.part("validate"), folder)
    return sources, [
        Fault(("validate", *fault.path), f"validate.{fault.text}", fault.at_key) for fault in faults
    ]


def _shared(
    sources: tuple[str, ...], cluster: Sequence[int], share: float, seed: int
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Sources for the search, and those that are held out: whole recordings or events."""
    names = max(cluster, default=-1) + 1
    drawn = set(np.random.default_rng(seed).permutation(names)[: round(share * names)].tolist())
    numbered = [*zip(sources, cluster, strict=True)]
    used = tuple(source for source, number in numbered if number not in drawn)
    return used, tuple(source for source, number in numbered if number in drawn)
