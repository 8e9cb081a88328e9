"""The JSON documents of all commands, and `run.json`, as one JSON schema.

What stands here does not change within a `schema_version`: keys keep name, type, unit and meaning.
Others may be added, so that documents may hold more. Keys and types come from the tables and the
classes that documents are made of.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from types import UnionType
from typing import Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from rpscli.analyses import result_quantities as known
from rpscli.analyses.neighbours import Neighbour
from rpscli.analyses.pushover import CapacityCurve
from rpscli.analyses.results import ColumnForces, Energy
from rpscli.analyses.trace import DeviceDemand
from rpscli.analyses.verification import Comparison
from rpscli.case.conditions import Condition
from rpscli.case.json_schema import DIALECT
from rpscli.case.schema.keys import KeyReference
from rpscli.model.statics import Return
from rpscli.records.measures import IntensityMeasures
from rpscli.records.requirements import Rule
from rpscli.registry import Offer
from rpscli.report.documents import OF_RECORD, SCHEMA_VERSION
from rpscli.report.study.statistics import OF_RECORDS
from rpscli.report.tables.derived import CONTACT, DYNAMICS, FIRST_PERIOD, GEOMETRY
from rpscli.sweep.budget import Row

Shape = Any
"""A mapping of keys (`?`: not always), a list or a tuple of shapes, or any annotation."""
TYPES: dict[Any, Any] = {
    str: "string", int: "integer", float: ["number", "null"], bool: "boolean", dict: "object",
    np.ndarray: "array", type(None): "null",
}  # fmt: skip
"""Of JSON; a number that is not finite is null."""


def _schema(shape: Shape) -> dict[str, Any]:
    """Lists are of one shape, tuples hold what is allowed in one place."""
    origin: Any = get_origin(shape)
    inner, found = get_args(shape), dict[str, Any]()
    if isinstance(shape, Mapping) and isinstance(shape.get("type"), str | list):
        found = dict(shape)  # a schema already
    elif isinstance(shape, Mapping):
        required = [key for key in shape if not key.endswith("?")]
        properties = {key.rstrip("?"): _schema(each) for key, each in shape.items()}
        found = {"type": "object", "required": required, "properties": properties}
    elif isinstance(shape, tuple) or origin is UnionType:
        found = {"anyOf": [_schema(each) for each in inner or shape]}
    elif isinstance(shape, list) or origin in {list, tuple}:
        found = {"type": "array", "items": _schema((inner or shape)[0])}
    elif origin is Literal:
        found = {"enum": list(inner)}
    elif origin is dict:
        found = {"type": "object", "additionalProperties": _schema(inner[1])}
    elif is_dataclass(shape) or hasattr(shape, "_fields"):
        found = _schema(_keys(shape))
    elif (origin or shape) in TYPES:
        found = {"type": TYPES[origin or shape]}
    return found


def _keys(of: Any) -> dict[str, Shape]:
    """Fields of a class, and their types, as its objects stand in documents."""
    names = [each.name for each in fields(of)] if is_dataclass(of) else of._fields
    return {name: get_type_hints(of)[name] for name in names}


def _quantities(*of: Iterable[Any], listed: bool = False) -> dict[str, Shape]:
    """Numbers or lists, null where a structure does not have them, with unit and meaning."""
    found = {}
    for quantity in (each for some in of for each in some):
        whole, meaning = (getattr(quantity, name, "") for name in ("whole", "meaning"))
        one = {"type": ["integer" if whole else "number", "null"]}
        many = {"type": ["array", "null"], "items": one} if listed else one
        told = {"description": meaning or quantity.label, "unit": quantity.unit or "-"}
        found[quantity.name] = {**many, **told}
    return found


_VERSION = {"type": "integer", "const": SCHEMA_VERSION}
_HEADING = {"schema_version": _VERSION, "rps_version": str}
_ENDED = {"passed": bool, "exit_code": int}
_TOLD = {"warnings": list[str]}
_FILES = {"files": list[str]}
_SUBJECT = {"name": str, "title": str, "source": str}
_MOTION = {"name": str, "source": str, "npts": int, "dt": float}
_SHARE = {"count": int, "share": float, "low": float, "high": float}
_COUNTED = {"system": dict, "counted": int, "recordings?": int, "events?": int}
_SPREAD = _schema({f"{name}?": float for name in (*OF_RECORDS, "fractile_16", "least")})
_DEMANDS = {"type": "object", "additionalProperties": _SPREAD}
_STATISTICS = {**_COUNTED, "failed": int, "overturned": _SHARE, "demands": _DEMANDS}
_VERDICT = {
    **_COUNTED, **_keys(Condition), "beyond": _SHARE, "overturned_among_them": int, "value": float,
    "record": str | None, "value_at_fractile": float, "exceeded": bool, "shown": bool,
    "shown_by_recordings": int | None, "interval?": list[float],
}  # fmt: skip
_OF_STOREYS = _quantities(known.STOREYS, listed=True)
_HISTORY = {
    "case": _SUBJECT, "record": {**dict.fromkeys(OF_RECORD, float), **_MOTION, "scale": float},
    "outcome": str, "failure": str | None, **_quantities(known.HISTORY, known.SAMPLED),
    **{f"{name}?": shape for name, shape in _quantities(known.PAIR).items()},
    **_OF_STOREYS, "fixed_base": (_OF_STOREYS, type(None)), "energy": Energy,
    "column_forces": dict[str, ColumnForces], "devices": [DeviceDemand], "verdicts": [_VERDICT],
    "neighbours?": [Neighbour], **_TOLD, **_ENDED,
}  # fmt: skip
_UPLIFTED = {
    **_quantities(known.UPLIFTED_MODES, known.UPLIFTED_RATIOS, listed=True),
    **_quantities(known.FREQUENCY_PARAMETERS), "eigenvalues": [[float]],
}  # fmt: skip
_RECORD = {
    **_MOTION, "format": str, "description": str, "duration": float, **_keys(IntensityMeasures),
    "sha256": str, **_TOLD,
}  # fmt: skip
_DESIGN = {"design": int, "values": dict[str, float], "aims": dict[str, float]}
_POINTS = {"total": int, "failed": int}
_FAILURE = {"point": int, "message": str, "command": str}

DOCUMENTS: dict[str, Mapping[str, Shape]] = {
    "init": {**_FILES, "examples?": dict[str, str]},
    "explain": {
        "word": str, "keys": [KeyReference], "results": [{"name": str, "label": str}],
        "words": [{"word": str, "meaning": str}], "reports": [{"report": str, "meaning": str}],
        "options": [KeyReference], "plugins": [Offer],
    },
    "check": {
        "case": _SUBJECT, **_quantities(GEOMETRY, DYNAMICS, [FIRST_PERIOD]), "overturns": str,
        **{f"{name}?": shape for name, shape in _quantities(CONTACT).items()},
        "storeys": int, **dict.fromkeys(("periods", "damping_ratios", "stiffnesses"), list[float]),
        "devices": [{"kind": str}], "recentring": [Return], "limits": dict, **_TOLD, **_ENDED,
    },
    "modal": {
        "case": _SUBJECT, "fixed_base": _quantities(known.FIXED_BASE_MODES, listed=True),
        "full_contact?": _quantities(known.FIXED_BASE_MODES, listed=True),
        "rolling": _UPLIFTED, "rocking": _UPLIFTED, **_TOLD, **_FILES,
    },
    "pushover": {
        "case": _SUBJECT, **_quantities(known.PUSHOVER), "capacity": [CapacityCurve],
        "curve": _quantities(known.STOREY_CURVE, listed=True), **_TOLD, **_FILES,
    },
    "timehistory": {**_HISTORY, **_FILES},
    "timehistory of several": {
        "sets": [{"case": _SUBJECT, "records": [str], **_STATISTICS, "verdicts": [_VERDICT]}],
        "histories": [_HISTORY], **_TOLD, **_FILES, **_ENDED,
    },
    "sweep": {
        "study": _SUBJECT, "points": _POINTS, "outcomes": dict[str, int],
        "statistics?": [_STATISTICS], "verdicts?": [_VERDICT], "failures": [_FAILURE],
        "findings": dict[str, list[dict[str, str]]], "reports": dict, **_TOLD, **_FILES, **_ENDED,
    },
    "sweep --dry-run": {
        "study": _SUBJECT, "dry_run": Literal[True], "analysis": str, **_TOLD,
        **dict.fromkeys(("points", "systems", "records", "scales", "members"), int),
        "estimate": {"seconds": float, "jobs": int, "source": str},
    },
    "design": {
        "study": _SUBJECT, "points": _POINTS, "designs": dict[str, int], "closest": _DESIGN,
        **dict.fromkeys(("best", "robust"), (_DESIGN, type(None))),
        "islands": [_DESIGN], "front": [_DESIGN],
        "requirements": [{
            **_VERDICT, "requirement": str, "bound": float, "met": bool,
            "designs_that_meet_it": int, "binds": bool | None, "aim_without_it": float,
        }],
        "confirmed": bool | None, **_TOLD, **_FILES, **_ENDED,
        "confirmation": {f"{which}?": [_VERDICT] for which in ("best", "robust")},
    },
    "budget": {
        "case": _SUBJECT, "rows": [Row], **_TOLD, **_FILES,
        "results": [{
            "name": str, "limit": float, "exceeded": bool, "turned_by": [str], "moved_by": [str],
            "sentences": str, "records_fractiles": list[float], "records_beyond": str,
        }],
    },
    "export": {"case": _SUBJECT, "program": str, "limits": str, **_TOLD, **_FILES},
    "identify": {
        "case": _SUBJECT, "test": str, "level": float, "misfit": float, "ensembles": bool,
        "estimates": [{"name": str, "unit": str, **dict.fromkeys(("value", "low", "high"), float)}],
        "residuals": [{"time": float, "amplitude": float, "model_amplitude": float}],
        "keys": dict[str, str], **_TOLD, **_FILES,
    },
    "report": {**_TOLD, **_FILES, **_ENDED},
    "record info": {**_RECORD, "y?": _RECORD},
    **{f"record {verb}": {**_RECORD, "y?": _RECORD, **_FILES} for verb in ("plot", "convert")},
    "record synth": {**_RECORD, **_FILES},
    "record select": {
        "target": {"name": str, "source": str, "edition": str, "checked": str},
        "periods": [float], "common_factor": float, "misfit": float, "least_ratio": float,
        "requirements": ({"clause": str, "checked": str, "rules": [Rule]}, type(None)),
        "motions": [{"source": str, "factor": float, "clamped": bool, "misfit": float}],
        **_FILES, **_ENDED,
    },
    "verify": {
        "compared": int, "mismatches": int, "not_answered?": [str], **_ENDED,
        "comparisons": [{**_keys(Comparison), "holds": bool, "digits": float}],
    },
    "verify --problems": _FILES,
    "doctor": {"findings": [dict.fromkeys(("subject", "found", "remedy"), str)], **_ENDED},
}  # fmt: skip
"""What each command that succeeds, or finds a limit exceeded, says at least; `?`: not always."""

ERROR = {
    **_HEADING, "status": Literal["error"], "passed": Literal[False], "exit_code": int,
    "error": {"type": str, "message": str, "exit_code": int},
}  # fmt: skip
"""What a command says that fails, whatever else it says."""

RUN = {
    "schema_version": _VERSION, "command": str, "name": str, "file": str | None, "sha256": str,
    "record": str | None, "inputs": dict, "versions": dict[str, str | None], **_FILES,
}  # fmt: skip
"""`run.json`, beside the results of every command."""


def results_json_schema() -> dict[str, Any]:
    """One schema of all documents, each by itself under `$defs`."""
    each = {}
    for name, keys in DOCUMENTS.items():
        command = name.partition(" of ")[0].partition(" --")[0]
        begin = {
            **_HEADING,
            "status": Literal["ok"],
            "command": {"type": "string", "const": command},
        }
        each[name] = _schema({**begin, **keys})
    each |= {"error": _schema(ERROR), "run.json": _schema(RUN)}
    return {
        "$schema": DIALECT,
        "description": "Keys keep name, type, unit and meaning within a schema_version; others may"
        " be added. Numbers are SI, null where there is none.",
        "anyOf": [{"$ref": f"#/$defs/{name.replace(' ', '%20')}"} for name in each],
        "$defs": each,
    }
