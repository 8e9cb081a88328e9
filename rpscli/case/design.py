"""Design files: what may change in a case, what is required of it, and what is to be least."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeGuard

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PlainValidator, ValidationError, WithJsonSchema

from rpscli.analyses.result_quantities import DEMANDS, SAMPLED
from rpscli.case.overrides import apply_overrides
from rpscli.case.schema.fields import (
    LARGEST,
    Quantity,
    Section,
    Whole,
    first_fault,
    is_finite,
    refuse,
)
from rpscli.case.schema.keys import is_whole, unit
from rpscli.case.schema.limits import Fractile
from rpscli.case.study.axes import Axis, clashes, sources_of
from rpscli.case.study.rules import (
    fixed_faults,
    record_rules,
    scale_faults,
    unknown_keys,
    varied_paths,
)
from rpscli.case.study.schema import Seed, StudyParts
from rpscli.case.study.study import Study, shared_out, single_key_faults, study_of
from rpscli.case.text.document import Document, Fault, is_case, is_design, shown
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError, hint, listed
from rpscli.units import in_si

PLUS = "plus"
"""What is added to a linear sum."""


class Term(Section):
    """One term of what is to be least."""

    times: Annotated[float, Quantity()] = Field(1.0, description="factor, in SI units")
    fractile: Fractile = Field(
        0.5, description="of a result over the records; its median by default"
    )


Aim = dict[str, Term]
"""A linear sum of results and keys, by their names."""


def _aims(value: object) -> tuple[Aim, ...]:
    """One sum, or two whose front is looked for."""
    several = value if isinstance(value, list) else [value]
    if not 1 <= len(several) <= 2:
        refuse("must be one aim, or a list of two")
    return tuple(_aim(item) for item in several)


def _aim(value: object) -> Aim:
    """A name alone, or a sum."""
    if isinstance(value, str) and value.strip():
        return {value: Term.model_validate({})}
    if not isinstance(value, dict) or not value:
        refuse(
            f"has {shown(value)}, which must be a key or a result, or a sum such as"
            " {max_base_shear: 1e-6, podium.bearing.dimensions.width: 0.5}"
        )
    return {str(name): _term(name, given) for name, given in value.items()}


def _term(name: object, given: object) -> Term:
    written = given if isinstance(given, dict) else {"times": given}
    if isinstance(given, Term):
        return given
    try:
        return Term.model_validate(written)
    except ValidationError as error:
        refuse(f"has {name}: {shown(given)}, whose {first_fault(error)}")


_SUM = {"type": "object", "minProperties": 1}
_ONE_AIM = {
    "anyOf": [
        {"type": "string", "minLength": 1},
        _SUM | {"additionalProperties": {"anyOf": [{"type": "number"}, Term.model_json_schema()]}},
    ]
}
_BOUND = {"type": ["number", "string"]}

Bounds = Annotated[
    Any, WithJsonSchema({"type": "array", "items": _BOUND, "minItems": 2, "maxItems": 2})
]
"""Two values, which the task reads in the unit of their key."""
Aims = Annotated[
    tuple[Aim, ...],
    PlainValidator(_aims),
    WithJsonSchema(
        {"anyOf": [*_ONE_AIM["anyOf"], {"type": "array", "items": _ONE_AIM, "maxItems": 2}]}
    ),
]


class SearchSection(Section):
    """How many designs are looked at; what is left out follows from the number of unknowns."""

    first: Annotated[int, Whole(4, 65_536)] | None = Field(
        None, description="designs of the first, even sample"
    )
    most: Annotated[int, Whole(4, 65_536)] | None = Field(
        None, description="designs in all; four times the first ones by default"
    )
    resolution: Annotated[float, Quantity(above=0, below=1)] = Field(
        0.005, description="distance to which designs close in, as a share of each range"
    )
    resamples: Annotated[int, Whole(0, 10_000)] = Field(
        500, description="bootstrap samples of the records; 0 = none"
    )
    seed: Seed = Field(1, description="of the sample and the bootstrap")


class ConfirmSection(Section):
    """Motions that the search does not see."""

    records: tuple[Any, ...] | None = Field(None, description="record sources, as in a study")
    share: Annotated[float, Quantity(above=0, below=1)] | None = Field(
        None, description="share of the design's own records that is held out, in place of them"
    )
    seed: Seed = Field(1, description="of the draw of what is held out")


class DesignFile(StudyParts):
    """A design: the values of some keys of a case that meet the limits and make an aim least."""

    find: dict[str, Bounds] = Field(
        description="dotted case keys with [least, largest]: what may change"
    )
    ties: dict[str, dict[str, float]] = Field(
        {}, description="further keys as linear sums of these, {key: factor, plus: constant}"
    )
    least: Aims = Field(
        description="what is to be least: a result, a key, or a sum of them; two for their front"
    )
    confirm: ConfirmSection | None = Field(None, description="motions to confirm the design with")
    search: SearchSection = Field(SearchSection(), description="how many designs are looked at")


Array = NDArray[np.float64]

DIGITS = 6
"""Of the values of a design: nobody builds more, and files stay readable."""


class Unknown(NamedTuple):
    """A key that may change, and its range in SI units."""

    key: str
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class DesignTask:
    """What is looked for.

    Parameters
    ----------
    study
        Case, records and limits; its axes are empty, and its document is that of the design.
    file
        The validated file.
    unknowns
        What may change.
    confirming
        Single sources of motions that the search does not see.
    """

    study: Study
    file: DesignFile
    unknowns: tuple[Unknown, ...]
    confirming: tuple[str, ...]

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys that change: the unknowns, and what is tied to them."""
        return (*(unknown.key for unknown in self.unknowns), *self.file.ties)

    def values(self, places: Array) -> Array:
        """(designs, keys) values in SI units.

        Parameters
        ----------
        places
            (designs, unknowns) in the unit cube.
        """
        low = np.array([unknown.low for unknown in self.unknowns])
        high = np.array([unknown.high for unknown in self.unknowns])
        found = {
            unknown.key: _rounded(unknown.key, column)
            for unknown, column in zip(self.unknowns, (low + (high - low) * places).T, strict=True)
        }
        for key, terms in self.file.ties.items():
            sums = (terms[name] * found[name] for name in terms if name != PLUS)
            found[key] = _rounded(key, sum(sums, np.full(len(places), terms.get(PLUS, 0.0))))
        return np.column_stack(list(found.values()))

    def rows(self, values: Array) -> tuple[tuple[float | int, ...], ...]:
        """The values of each design as a case takes them."""
        whole = [is_whole(key) for key in self.keys]
        return tuple(
            tuple(int(value) if is_int else value for value, is_int in zip(row, whole, strict=True))
            for row in values.tolist()
        )

    def study_of(self, values: Array, sources: tuple[str, ...] | None = None) -> Study:
        """The study of some designs, (designs, keys), under the design's records or others."""
        places = tuple((self.study.document.value_place(self.path(key)),) for key in self.keys)
        axis = Axis(self.keys, self.rows(values), places)
        own = self.study.sources if sources is None else sources
        return replace(self.study, axes=(axis,), sources=own)

    def path(self, key: str) -> tuple[str, str]:
        """Where a key stands in the file."""
        return "ties" if key in self.file.ties else "find", key


def _rounded(key: str, values: Array) -> Array:
    if is_whole(key):
        return np.round(values)
    return np.array([float(f"{value:.{DIGITS}g}") for value in values.tolist()])


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
    """A design task from its text.

    Parameters
    ----------
    text
        YAML.
    name
        Of the file, for messages.
    folder
        Where relative file names start; the working folder by default.
    overrides
        Texts ``key=value`` for keys of the design (``search.most``) or of the case at its base.

    Raises
    ------
    CaseError
        If it is not valid: one line for each fault.
    """
    folder = folder or Path()
    document = read_yaml(text, name)
    if not is_design(document):
        kind = "case" if is_case(document) else "study" if "base" in document.content else "file"
        raise CaseError(
            f"{name}: this is a {kind} without `find`, but a design is wanted here: a base case,"
            " find, records, limits and least; see `rps explain find`"
        )
    of_design, of_base = shared_out(overrides, DesignFile)
    document = apply_overrides(document, of_design, model=DesignFile)
    confirming, confirm_faults = _confirming(document, folder)
    unknowns, find_faults = _unknowns(document)
    faults = [*single_key_faults(document, DesignFile), *scale_faults(document)]
    faults += [*find_faults, *unknown_keys(document), *clashes(varied_paths(document))]
    faults += [*record_rules(document), *fixed_faults(document, of_base), *confirm_faults]
    document.refuse([*faults, *_tie_faults(document), *sources_of(document, folder)[1]])
    file = DesignFile.model_validate(document.content)
    document.refuse(_aim_faults(file))
    study = study_of(
        _study_document(document),
        of_base,
        kinds={},
        folder=folder,
        digest=hashlib.sha256(text.encode()).hexdigest(),
    )
    study = replace(study, document=document)
    used, held_out = _used_and_held_out(document, file, study.sources, confirming)
    return DesignTask(replace(study, sources=used), file, unknowns, held_out)


def _used_and_held_out(
    document: Document, file: DesignFile, sources: Sequence[str], confirming: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Records of the search, and those that the design is confirmed on."""
    used, held_out = tuple(sources), tuple(confirming)
    if file.confirm is not None and file.confirm.share is not None:
        used, held_out = _shared(used, file.confirm.share, file.confirm.seed)
    elif both := sorted(set(used) & set(held_out)):
        text = f"confirm.records has {listed(both[:3], 'and')}, which the search uses already"
        document.refuse([Fault(("confirm", "records"), f"{text}; name other motions")])
    if file.confirm is not None and not (used and held_out):
        text = f"confirm.share = {file.confirm.share} of {len(sources)} records leaves none"
        document.refuse([Fault(("confirm",), f"{text} on one side; give more records")])
    return used, held_out


def _study_document(document: Document) -> Document:
    """What the design says as a study would."""
    shared = {k: v for k, v in document.content.items() if k in StudyParts.model_fields}
    return replace(document, content=shared)


def _unknowns(document: Document) -> tuple[tuple[Unknown, ...], list[Fault]]:
    """The ranges under `find`, in SI units."""
    unknowns: list[Unknown] = []
    faults: list[Fault] = []
    if (written := document.content["find"]) == {}:
        text = "find is empty; name a key, as in {podium.bearing.slenderness: [0.1, 0.3]}"
        faults.append(Fault(("find",), text))
    for key, bounds in written.items() if isinstance(written, dict) else ():
        si = in_si(bounds, unit(key))
        if not isinstance(si, list) or len(si) != 2 or not all(map(_is_number, si)):
            words = "numbers" if unit(key) == "-" else f"numbers in {unit(key)} or with a unit"
            text = f"find.{key} = {shown(bounds)} must be two {words}, [least, largest]"
            text += f", up to {LARGEST:g}"
            faults.append(Fault(("find", key), text))
        elif not si[0] < si[1]:
            text = f"find.{key} = {shown(bounds)} must rise from the least value to the largest"
            faults.append(
                Fault(("find", key), f"{text}; exchange them, or leave the key to the case")
            )
        else:
            unknowns.append(Unknown(key, float(si[0]), float(si[1])))
    for key, place in varied_paths(document).items():
        if key.split(".")[0] in {"limits", "analysis", "rps", "title", "record"}:
            text = f"{key} must not change in a design; it is no property of the structure"
            faults.append(Fault(place, text, at_key=True))
    return tuple(unknowns), faults


def _is_number(value: object) -> TypeGuard[float]:
    """A number whose sums and products with others stay finite."""
    return is_finite(value) and abs(value) <= LARGEST


def _tie_faults(document: Document) -> Iterator[Fault]:
    found, ties = document.content["find"], document.content.get("ties", {})
    known = [*(found if isinstance(found, dict) else ()), PLUS]
    for key, terms in ties.items() if isinstance(ties, dict) else ():
        if key in known:
            text = f"{key} varies under find already; take one of them out"
            yield Fault(("ties", key), text, at_key=True)
        elif not isinstance(terms, dict) or not all(map(_is_number, terms.values())):
            text = (
                f"ties.{key} = {shown(terms)} must be a linear sum, {{key: factor, plus: number}},"
                f" of numbers up to {LARGEST:g}"
            )
            yield Fault(("ties", key), text)
        else:
            for name in terms:
                if name not in known:
                    text = f"ties.{key} needs {name}, which is not under find"
                    yield Fault(("ties", key), f"{text}; use {listed(known)}")


def _aim_faults(file: DesignFile) -> Iterator[Fault]:
    """Names that are neither keys that change nor results."""
    keys = [*file.find, *file.ties]
    sampled = {quantity.name for quantity in SAMPLED}
    results = {quantity.name for quantity in DEMANDS}
    for name in dict.fromkeys(name for aim in file.least for name in aim):
        if name in sampled and not file.whole_histories:
            yield Fault(("least",), f"least: {name} needs `whole_histories: true`; add it")
        elif name not in keys and name not in results:
            meant = hint(name, [*keys, *results], f"use {listed(keys)}, or a result")
            yield Fault(
                ("least",),
                f"least: {name} is neither a result nor a key that `find` changes; {meant}",
            )
        elif name in keys and "fractile" in _given(file.least, name):
            yield Fault(("least",), f"least: {name} is a key, without fractiles; take it out")


def _given(aims: Sequence[Aim], name: str) -> set[str]:
    """What the file says of a term."""
    return set().union(*(aim[name].model_fields_set for aim in aims if name in aim))


def _confirming(document: Document, folder: Path) -> tuple[tuple[str, ...], list[Fault]]:
    """Sources under `confirm.records`, or what is wrong with the section."""
    section = document.content.get("confirm")
    if not isinstance(section, Mapping):
        return (), []
    if ("records" in section) == ("share" in section):
        text = "confirm must have records or a share of the design's own, and not both"
        return (), [Fault(("confirm",), text, at_key=True)]
    sources, faults = sources_of(document.part("confirm"), folder)
    return sources, [
        Fault(("confirm", *fault.path), f"confirm.{fault.text}", fault.at_key) for fault in faults
    ]


def _shared(
    sources: tuple[str, ...], share: float, seed: int
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Sources for the search, and those that are held out."""
    count = round(share * len(sources))
    drawn = set(np.random.default_rng(seed).permutation(len(sources))[:count].tolist())
    used = tuple(source for place, source in enumerate(sources) if place not in drawn)
    return used, tuple(source for place, source in enumerate(sources) if place in drawn)
