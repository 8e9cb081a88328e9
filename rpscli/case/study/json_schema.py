"""The study format as a JSON schema, for editors and other programs."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.json_schema import DIALECT, PresentKeys
from rpscli.case.study.reports import ReportKinds
from rpscli.case.study.schema import StudyFile, StudyParts


def study_json_schema(kinds: ReportKinds, model: type[StudyParts] = StudyFile) -> dict[str, Any]:
    """JSON schema of a study file, with the options of every kind of report; or of a design file.

    What a base lacks the varied keys may bring: of a case written in the study, no key is required.
    """
    options = {name: kind.options for name, kind in kinds.items()}
    models: dict[type[BaseModel], None] = dict.fromkeys((model, CaseFile, *options.values()))
    references, schema = models_json_schema(
        [(model, "validation") for model in models], schema_generator=PresentKeys
    )
    definitions: dict[str, Any] = schema["$defs"]

    def reference(model: Any) -> dict[str, Any]:
        return dict(references[model, "validation"])

    def definition(model: Any) -> dict[str, Any]:
        found: dict[str, Any] = definitions.pop(reference(model)["$ref"].rsplit("/", 1)[1])
        return found

    study, base = definition(model), definition(CaseFile)
    base.pop("required")
    described = study["properties"]["base"]["description"]
    study["properties"]["base"] = {
        "anyOf": [{"type": "string", "minLength": 1}, base],
        "description": described,
    }
    with_options = {
        "type": "object",
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": False,
        "properties": {
            name: {"anyOf": [reference(model), {"type": "null"}]} for name, model in options.items()
        },
    }
    if reports := study["properties"].get("reports"):
        reports["items"] = {"anyOf": [{"enum": list(options)}, with_options]}
    return {"$schema": DIALECT, **study, "$defs": definitions}
