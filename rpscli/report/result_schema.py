"""The JSON documents of all commands, and `run.json`, as one JSON schema.

What stands here does not change within a `schema_version`: keys keep name, type, unit and meaning.
Others may be added, so that documents may hold more. Keys of results come from their own table.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from rpscli.analyses.result_quantities import (
    FIXED_BASE_MODES,
    FREQUENCY_PARAMETERS,
    HISTORY,
    PUSHOVER,
    SAMPLED,
    STOREY_CURVE,
    STOREYS,
    UPLIFTED_MODES,
    UPLIFTED_RATIOS,
    ResultQuantity,
)
from rpscli.case.json_schema import DIALECT
from rpscli.report.documents import SCHEMA_VERSION

Schema = dict[str, Any]


def _schema(shape: Any) -> Schema:
    """Of a shape: a type, an example list, a mapping of keys, words that are allowed, a schema."""
    if isinstance(shape, type):
        names = {str: "string", int: "integer", float: ["number", "null"], bool: "boolean"}
        return {"type": {**names, dict: "object", list: "array"}[shape]}
    if isinstance(shape, list):
        return {"type": "array", "items": _schema(shape[0])}
    if isinstance(shape, tuple):
        return {"enum": list(shape)}
    if "type" in shape and isinstance(shape["type"], str | list):
        return dict(shape)
    return {
        "type": "object",
        "required": [key for key in shape if not key.endswith("?")],
        "properties": {key.rstrip("?"): _schema(each) for key, each in shape.items()},
    }


def _quantities(known: Iterable[ResultQuantity], *, listed: bool = False) -> Mapping[str, Schema]:
    """Numbers or lists, null where a structure does not have them, with unit and meaning."""
    found = {}
    for quantity in known:
        one: Schema = {"type": ["integer" if quantity.whole else "number", "null"]}
        many = {"type": ["array", "null"], "items": one} if listed else one
        meaning = quantity.meaning or quantity.label
        found[quantity.name] = {**many, "description": meaning, "unit": quantity.unit or "-"}
    return found


_WORD_OR_NULL = {"type": ["string", "null"]}
_HEADING = {"schema_version": (SCHEMA_VERSION,), "rps_version": str, "status": ("ok", "error")}
_END = {"passed": bool, "exit_code": int}
_WARNED = {"warnings": [str]}
_SUBJECT = {"name": str, "title": str, "source": str}
_SHARE = {"count": int, "share": float, "low": float, "high": float}
_COUNTED = {"system": dict, "counted": int, "recordings": int}
_STATISTICS = {**_COUNTED, "failed": int, "overturned": _SHARE, "demands": dict}
_VERDICT = {
    **_COUNTED, "name": str, "limit": float, "source": str, "share": float, "fractile": float,
    "beyond": _SHARE, "value": float, "record": _WORD_OR_NULL, "exceeded": bool, "shown": bool,
}  # fmt: skip
_LIMIT = {"name": str, "limit": float, "source": str, "value": float, "exceeded": bool}
_HISTORY = {
    "case": _SUBJECT,
    "record": {"name": str, "source": str, "npts": int, "dt": float, "pga": float},
    "outcome": str,
    **_quantities(HISTORY),
    **_quantities(SAMPLED),
    **_quantities(STOREYS, listed=True),
    "energy": {"input": float, "damped": float, "impact": float, "stored": float},
    "devices": [dict],
    "verdicts": [_LIMIT],
    **_WARNED,
    **_END,
}
_UPLIFTED = {
    **_quantities((*UPLIFTED_MODES, *UPLIFTED_RATIOS), listed=True),
    **_quantities(FREQUENCY_PARAMETERS),
    "eigenvalues": [[float]],
}
_MOTION = {
    "name": str, "source": str, "format": str, "npts": int, "dt": float, "duration": float,
    "pga": float, "pgv": float, "pgd": float, "arias": float, "cav": float, "d5_75": float,
    "d5_95": float, "sha256": str, **_WARNED,
}  # fmt: skip
_DESIGN = {"design": int, "values": dict, "aims": [float]}

DOCUMENTS: dict[str, Mapping[str, Any]] = {
    "init": {"files": [str]},
    "explain": {"word": str, "keys": [dict], "results": [dict], "words": [dict]},
    "check": {
        "case": _SUBJECT, "alpha": float, "beta": float, "rho_cr_paper": float,
        "rho_cr_exact": float, "critical_rotation": float, "restitution": float,
        "uplift_acceleration": float, "static_base_shear": float, "gamma": float, "eta": float,
        "p_hat": float, "T1": float, "storeys": int, "limits": dict, **_WARNED, **_END,
    },
    "modal": {
        "case": _SUBJECT, "fixed_base": _quantities(FIXED_BASE_MODES, listed=True),
        "rolling": _UPLIFTED, "rocking": _UPLIFTED, **_WARNED, "files": [str],
    },
    "pushover": {
        "case": _SUBJECT, **_quantities(PUSHOVER),
        "curve": _quantities(STOREY_CURVE, listed=True), "capacity": [dict], **_WARNED,
        "files": [str],
    },
    "timehistory": {**_HISTORY, "files": [str]},
    "timehistory of several": {
        "histories": [_HISTORY],
        "sets": [{"case": _SUBJECT, "records": [str], **_STATISTICS, "verdicts": [_VERDICT]}],
        **_WARNED, "files": [str], **_END,
    },
    "sweep": {
        "study": _SUBJECT, "points": {"total": int, "failed": int}, "outcomes": dict,
        "statistics?": [_STATISTICS], "verdicts?": [_VERDICT], "reports": dict,
        "failures": [{"point": int, "message": str, "command": str}], **_WARNED, "files": [str],
        **_END,
    },
    "sweep --dry-run": {
        "study": _SUBJECT, "dry_run": (True,), "analysis": str, "points": int, "systems": int,
        "records": int, "scales": int, "members": int, **_WARNED,
    },
    "design": {
        "study": _SUBJECT, "points": {"total": int, "failed": int}, "requirements": [dict],
        **_WARNED, "files": [str], **_END,
    },
    "compare": {
        "tolerance": float, **{key: {"source": str, "versions": dict, **_WARNED} for key in "ab"},
        **{key: [{"name": str}] for key in ("inputs", "versions")}, "compared": int,
        "only_a": [str], "only_b": [str], **_END,
        "results": [
            {"name": str, "unit": str, "at": str, "differing": int, "of": int, "largest": float,
             "relative": float, "noise": float}
        ],
    },
    "report": {"files": [str], **_WARNED, **_END},
    "record info": _MOTION,
    **{f"record {verb}": {**_MOTION, "files": [str]} for verb in ("plot", "convert", "synth")},
    "record select": {
        "target": {"name": str, "source": str, "edition": str, "checked": str},
        "periods": [float], "common_factor": float, "misfit": float, "least_ratio": float,
        "requirements": {"type": ["object", "null"]}, "files": [str], **_END,
        "motions": [{"source": str, "factor": float, "clamped": bool, "misfit": float}],
    },
    "verify": {
        "compared": int, "mismatches": int, **_END,
        "comparisons": [
            {"group": str, "quantity": str, "unit": str, "expected": float, "computed": float,
             "tolerance": float, "holds": bool}
        ],
    },
}  # fmt: skip
"""What each command that succeeds, or finds a limit exceeded, says at least; `?`: not always."""

ERROR = {
    **_HEADING, "status": ("error",), "passed": (False,), "exit_code": int,
    "error": {"type": str, "message": str, "exit_code": int},
}  # fmt: skip
"""What a command says that fails, whatever else it says."""

RUN = {
    "schema_version": (SCHEMA_VERSION,), "command": str, "name": str, "file": _WORD_OR_NULL,
    "sha256": str, "record": _WORD_OR_NULL, "inputs": dict, "files": [str],
    "versions": dict.fromkeys(("rps", "python", "numpy", "numba"), _WORD_OR_NULL),
}  # fmt: skip
"""`run.json`, beside the results of every command."""


def results_json_schema() -> Schema:
    """One schema of all documents, each by itself under `$defs`."""
    each = {}
    for name, keys in DOCUMENTS.items():
        command = name.partition(" of ")[0].partition(" --")[0]
        each[name] = _schema({**_HEADING, "status": ("ok",), "command": (command,), **keys})
    each |= {"error": _schema(ERROR), "run.json": _schema(RUN)}
    return {
        "$schema": DIALECT,
        "description": "Keys keep name, type, unit and meaning within a schema_version; others may"
        " be added. Numbers are SI, null where there is none.",
        "anyOf": [{"$ref": f"#/$defs/{name.replace(' ', '%20')}"} for name in each],
        "$defs": each,
    }
