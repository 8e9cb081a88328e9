"""Sections whose law another package may add: its constants are keys like ours.

Such a section is one of ours with these keys besides. It is known once a document names the law.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, create_model
from pydantic_core import CoreSchema, core_schema

from rpscli.case.schema.fields import Section
from rpscli.errors import PluginError
from rpscli.registry import Registry


@dataclass(frozen=True, eq=False)
class OwnLaws:
    """A section of ours, or where `key` names a law of another package that with its constants."""

    key: str
    registry: Registry[Any]
    ours: type[Section]
    loaded: dict[str, type[Section]] = field(default_factory=dict)
    """By the names of laws, those that were asked for."""

    def section(self, name: str) -> type[Section]:
        """The section of a law: raises PluginError if its constants cannot be keys."""
        if name not in self.loaded:
            constants = self.registry[name].constants
            with self.registry.blaming(name):
                if taken := [*constants.keys() & self.ours.model_fields.keys()]:
                    raise ValueError(f"its constant {taken[0]} must not be a key of rps; rename it")
                keys: dict[str, Any] = {
                    constant: (Annotated[float, quantity], Field(description=f"of {name}"))
                    for constant, quantity in constants.items()
                }
                keys[self.key] = (Literal[name], Field(description="of another package"))
                self.loaded[name] = create_model(name, __base__=self.ours, **keys)
        return self.loaded[name]

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """The check, for pydantic."""

        def checked(value: Any, ours: Any) -> object:
            name = value.get(self.key) if isinstance(value, dict) else None
            if not isinstance(name, str) or name in self.registry:
                return ours(value)
            known = name in self.registry.names()
            return self.section(name).model_validate(value) if known else ours(value)

        return core_schema.no_info_wrap_validator_function(checked, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """The JSON schema."""
        own = []
        for name, _ in self.registry.theirs():
            with suppress(PluginError):  # told where it is asked for
                own.append(self.section(name).model_json_schema())
        return {"anyOf": [handler(schema), *own]} if own else handler(schema)
