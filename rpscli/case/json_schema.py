"""The formats of files as JSON schemas, for editors and other programs."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.study.schema import StudyParts

DIALECT = "https://json-schema.org/draft/2020-12/schema"


class PresentKeys(GenerateJsonSchema):
    """Optional keys are left out, never null: show neither null nor a default of null."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        """Schema of the value that the key has when it is written."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """Schema with the default, where there is one."""
        shown = super().default_schema(schema)
        default = shown.pop("default", None)
        if isinstance(default, dict):  # a whole section
            default = {key: value for key, value in default.items() if value is not None}
        return shown if default is None else {**shown, "default": default}

    def field_title_should_be_set(self, schema: Any) -> bool:
        """No titles: they would only repeat the keys."""
        del schema
        return False


def json_schema_of(model: type[BaseModel]) -> dict[str, Any]:
    """JSON schema of a model; ``unit`` beside a number is the SI unit of a bare number."""
    schema = model.model_json_schema(schema_generator=PresentKeys)
    return {"$schema": DIALECT, **schema}


def study_json_schema(model: type[StudyParts]) -> dict[str, Any]:
    """JSON schema of a study or design file; its base may lack what keys bring."""
    study, base = json_schema_of(model), json_schema_of(CaseFile)
    definitions = {**base.pop("$defs"), **study.pop("$defs")}
    del base["required"], base["$schema"]
    described = study["properties"]["base"]["description"]
    study["properties"]["base"] = {
        "anyOf": [{"type": "string", "minLength": 1}, base],
        "description": described,
    }
    return {**study, "$defs": definitions}
