"""Design files: what may change in a case, what is required of it,
and what is to be least.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    BeforeValidator,
    Field,
    PlainValidator,
    WithJsonSchema,
    model_validator,
)

from rpscli.analyses.result_quantities import DEMANDS, SAMPLED
from rpscli.case.conditions import replaced_limits
from rpscli.case.schema.check import checked
from rpscli.case.schema.fields import Quantity, Section, Whole, must_be, refuse
from rpscli.case.schema.keys import is_whole, unit
from rpscli.case.schema.limits import Fractile
from rpscli.case.study.schema import (
    PLUS,
    Axis,
    Linked,
    Seed,
    Sources,
    StudyParts,
    is_moderate,
    with_keys,
)
from rpscli.case.study.study import (
    StudyInput,
    key_faults,
    linked_value,
    overridden,
    sources_of,
    study_of,
    varying,
)
from rpscli.case.text.document import Document, Fault, format_of
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import LARGEST, CaseError, hint, listed
from rpscli.records.recordings import clusters
from rpscli.units import in_si

GONE = {
    "find": "write `variables`",
    "ties": "write `linked`",
    "least": "write `minimise`",
    "confirm": "write `validate`",
    "tolerance": (
        "every design is judged by itself; `perturb` varies motions and impacts, and a"
        " study over values near the answer shows what differences in building do"
    ),
}
"""Keys of designs of earlier versions, and what to use in their place."""

Array = NDArray[np.float64]

STEPS = 3
"""Decimals of a range, or of its least end, to which values are
rounded, judged and printed."""


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


def _sum(value: object) -> object:
    """A name alone, or a sum."""
    if isinstance(value, str) and value.strip():
        return {value: {}}
    if isinstance(value, list | tuple):
        refuse(
            "must be one objective: lists of two, for a Pareto front, are gone; write a"
            " sum, or minimise one and set a limit on the other"
        )
    if not isinstance(value, dict) or not value:
        refuse(
            "must be a key or a result, or a sum such as"
            " {max_base_shear: 1e-6, podium.bearing.dimensions.width: 0.5}"
        )
    return value


_TERM = {"anyOf": [{"type": "number"}, Term.model_json_schema()]}
Objective = Annotated[
    dict[str, Term],
    BeforeValidator(_sum),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "minLength": 1},
                {"type": "object", "minProperties": 1, "additionalProperties": _TERM},
            ]
        }
    ),
]
"""A linear sum of results and keys, by their names."""


class Unknown(NamedTuple):
    """A key that may change, and its range in SI units."""

    key: str
    low: float
    high: float

    @property
    def digits(self) -> int:
        """Decimals of its values, which tell the ends of the
        range and a thousandth of it.
        """
        if is_whole(self.key):
            return 0
        sizes = [
            size for size in (abs(self.low), abs(self.high), self.high - self.low) if size
        ]
        return STEPS - math.floor(math.log10(min(sizes)))


def _unknown(given: tuple[str, object]) -> Unknown:
    """The range of a key, in SI units."""
    key, bounds = given
    si = in_si(bounds, unit(key))
    if not isinstance(si, list) or len(si) != 2 or not all(map(is_moderate, si)):
        words = (
            "numbers" if unit(key) == "-" else f"numbers in {unit(key)} or with a unit"
        )
        refuse(f"must be two {words}, [least, largest], up to {LARGEST:g}")
    if not si[0] < si[1]:
        refuse(
            "must rise from the least value to the largest; exchange them, or leave the"
            " key to the case"
        )
    return Unknown(key, float(si[0]), float(si[1]))


_BOUNDS = {
    "type": "array",
    "items": {"type": ["number", "string"]},
    "minItems": 2,
    "maxItems": 2,
}
Variables = Annotated[
    dict[str, Annotated[Unknown, PlainValidator(_unknown), WithJsonSchema(_BOUNDS)]],
    BeforeValidator(with_keys),
    must_be(
        dict,
        "keys with their ranges, as in {podium.bearing.slenderness: [0.1, 0.3]}",
        filled=True,
    ),
]


class SearchSection(Section):
    """How many designs are looked at; what is left out follows
    from the number of unknowns.
    """

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
    """A design: the values of some keys of a case that meet the
    limits and minimise something.
    """

    variables: Variables
    """dotted case keys with [least, largest]: what may change; devices count from 0, as
    in podium.devices.0.force"""
    linked: Linked = Field(
        {},
        description="further keys as linear sums of these, {key: factor, plus: constant}",
    )
    minimise: Objective
    """what is minimised: a result, a key, or a sum of them"""
    # pydantic's models have a method validate.
    validation: ValidateSection | None = Field(
        None, alias="validate", description="motions to validate the design with"
    )
    search: SearchSection = SearchSection()
    """how many designs are looked at"""


@dataclass(frozen=True, eq=False)
class DesignTask:
    """A study without values of its axis, which are looked for;
    `unseen` records validate them.
    """

    study: StudyInput
    file: DesignFile
    unseen: tuple[str, ...]

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """Unknowns of the design: keys that may change, with their ranges."""
        return tuple(self.file.variables.values())

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys that change: the unknowns, and what is linked to them."""
        return (*(unknown.key for unknown in self.unknowns), *self.file.linked)

    def values(self, places: Array) -> Array:
        """(designs, keys) values in SI units."""
        found = {}
        for unknown, at in zip(self.unknowns, places.T, strict=True):
            key, low, high = unknown
            values = low + (high - low) * at
            found[key] = np.array(
                [round(value, unknown.digits) for value in values.tolist()]
            )
        for key, terms in self.file.linked.items():
            columns = zip(
                *(found[name].tolist() for name in terms if name != PLUS), strict=True
            )
            found[key] = np.array(
                [linked_value(key, terms, row) for row in columns], dtype=float
            )
        return np.column_stack(list(found.values()))

    def rows(self, values: Array) -> tuple[tuple[float | int, ...], ...]:
        """The values of each design as a case takes them."""
        whole = [is_whole(key) for key in self.keys]
        return tuple(
            tuple(
                int(value) if is_int else value
                for value, is_int in zip(row, whole, strict=True)
            )
            for row in values.tolist()
        )

    @cached_property
    def clusters(self) -> tuple[int, ...]:
        """Numbers of the recordings, or events, of the records of the search."""
        sources = self.study.sources
        # Without any it is the case's own record.
        return (
            clusters(sources, self.study.folder, self.file.independent)
            if sources
            else (0,)
        )

    def study_of(
        self, values: Array, sources: tuple[str, ...] | None = None
    ) -> StudyInput:
        """The study of some designs, (designs, keys), under the
        design's records or others.
        """
        owner = {
            key: "linked" if key in self.file.linked else "variables" for key in self.keys
        }
        places = tuple(
            (self.study.document.value_place((owner[k], k)),) for k in self.keys
        )
        axis = Axis(self.keys, self.rows(values), places, of_designs=True)
        own = self.study.sources if sources is None else sources
        return replace(self.study, axes=(axis,), sources=own)


def parse_design(
    text: str, name: str, *, folder: Path | None = None, overrides: Sequence[str] = ()
) -> DesignTask:
    """A design task from its text."""
    folder = folder or Path()
    document = read_yaml(text, name)
    if (kind := format_of(document)) != "design":
        raise CaseError(
            f"{name}: this is a {kind or 'file'} without `variables`, but a design is"
            " needed here: a base case, variables, records, limits and minimise; see"
            " `rps explain variables`"
        )
    document.refuse(
        Fault((word,), f"{word} is gone: {now}", at_key=True)
        for word, now in GONE.items()
        if word in document.content
    )
    document, of_base = overridden(document, overrides, DesignFile)
    file = checked(DesignFile, document)
    unseen, faults, _ = sources_of(document, folder, "validate")
    document.refuse(
        [*faults, *key_faults(document, of_base, folder), *_name_faults(document, file)]
    )
    shared = {k: v for k, v in document.content.items() if k in StudyParts.model_fields}
    study = study_of(
        replace(document, content=shared),
        of_base,
        folder=folder,
        digest=hashlib.sha256(text.encode()).hexdigest(),
    )
    used, unseen = _used_and_unseen(document, file, study, unseen)
    notes = (*study.notes, *_notes(file, study.base.content))
    return DesignTask(
        replace(study, document=document, sources=used, notes=notes), file, unseen
    )


def _notes(file: DesignFile, base: dict[str, Any]) -> Iterator[str]:
    """Remarks on what the design takes from its base, or not, in another way than may be
    meant.
    """
    if names := replaced_limits(base, file.limits):
        yield f"the limits of the design replace those of the base case: {names}"
    own = {"slenderness", "semi_diagonal", "dimensions"}
    sizes = [key for key in file.variables if {*key.split(".")[2:3]} & own]
    if sizes and Document("", base).has(("superstructure", "yield", "ratio")):
        yield (
            "superstructure.yield.ratio is a multiple of V_st, which changes with"
            f" {sizes[0]}: the storeys of each design have another strength; yield.shears"
            " keeps it"
        )


def _used_and_unseen(
    document: Document, file: DesignFile, study: StudyInput, unseen: tuple[str, ...]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Records of the search, and those that the answer is
    validated on: others, or a part.
    """
    numbers = clusters((*study.sources, *unseen), study.folder, file.independent)
    own = dict(zip(study.sources, numbers, strict=False))
    section = file.validation
    others = zip(unseen, numbers[len(own) :], strict=True)
    if both := [source for source, number in others if number in own.values()]:
        text = (
            f"validate.records has {listed(both[:3], 'and')}, whose"
            f" {file.independent[:-1]} the search uses already; name other motions"
        )
        document.refuse([Fault(("validate", "records"), text)])
    if section is None or section.share is None:
        return study.sources, unseen
    names = max(numbers, default=-1) + 1  # of whole recordings or events
    drawn = np.random.default_rng(section.seed).permutation(names)
    held_out = set(drawn[: round(section.share * names)].tolist())
    unseen = tuple(source for source, number in own.items() if number in held_out)
    used = tuple(source for source in own if source not in unseen)
    if not (used and unseen):
        text = f"validate.share = {section.share} of {len(own)} records leaves none"
        document.refuse([Fault(("validate",), f"{text} on one side; give more records")])
    return used, unseen


def _name_faults(document: Document, file: DesignFile) -> Iterator[Fault]:
    """Keys that are no property of the structure; names that are
    neither keys nor results.
    """
    for key, place in varying(document):
        if key.split(".")[0] in {"limits", "analysis", "rps", "title", "record"}:
            text = (
                f"{key} must not change in a design; it is not a property of the"
                " structure"
            )
            yield Fault(place, text, at_key=True)
    known = [*file.variables, PLUS]
    keys = [*file.variables, *file.linked]
    for key, sums in file.linked.items():
        for name in (name for name in sums if name not in known):
            text = f"linked.{key} needs {name}, which is not under variables"
            yield Fault(("linked", key), f"{text}; use {listed(known)}")
    sampled = {quantity.name for quantity in SAMPLED}
    results = {quantity.name for quantity in DEMANDS}
    for name, term in file.minimise.items():
        if name in sampled and not file.whole_histories:
            text = f"{name} needs `whole_histories: true`; add it"
        elif name not in keys and name not in results:
            suggestion = hint(name, [*keys, *results], f"use {listed(keys)}, or a result")
            text = (
                f"{name} is neither a result nor a key that `variables` changes;"
                f" {suggestion}"
            )
        elif name in keys and "fractile" in term.model_fields_set:
            text = f"{name} is a key, without fractiles; remove it"
        else:
            continue
        yield Fault(("minimise",), f"minimise: {text}")
