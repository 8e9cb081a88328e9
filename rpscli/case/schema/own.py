"""Sections whose law another package may add: its constants are keys like ours.

Such a section is one of ours with these keys besides. It is known once a document names the law.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, create_model
from pydantic_core import CoreSchema, core_schema

from rpscli.case.schema.fields import Quantity, Section
from rpscli.model.own import MOST_CONSTANTS
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
                self._refuse(constants)
                keys: dict[str, Any] = {
                    constant: (Annotated[float, quantity], Field(description=f"of {name}"))
                    for constant, quantity in constants.items()
                }
                keys[self.key] = (Literal[name], Field(description="of another package"))
                self.loaded[name] = create_model(name, __base__=self.ours, **keys)
        return self.loaded[name]

    def _refuse(self, constants: Mapping[str, Any]) -> None:
        if len(constants) > MOST_CONSTANTS:
            raise ValueError(f"it has {len(constants)} constants, at most {MOST_CONSTANTS} may be")
        for name, quantity in constants.items():
            if not isinstance(quantity, Quantity) or not name.isidentifier():
                raise TypeError(f"its constant {name!r} must be a name with a Quantity")
            if name in self.ours.model_fields:
                raise ValueError(f"its constant {name} must not be called as a key of rps is")

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
        own = [self.section(name).model_json_schema() for name, _ in self.registry.theirs()]
        return {"anyOf": [handler(schema), *own]} if own else handler(schema)
