"""The devices of a case: their keys, units and bounds."""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from rpscli.case.schema.fields import Quantity
from rpscli.case.schema.section import Section
from rpscli.model.devices import DEVICES

DEVICE_KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    kind: (
        tuple(field.name for field in fields(device) if field.default is MISSING),
        tuple(field.name for field in fields(device) if field.default is not MISSING),
    )
    for kind, device in DEVICES.items()
}
"""Keys that a device of each kind must have, and may have: the fields of its law."""


def _device_schema(schema: dict[str, Any]) -> None:
    """Which keys go with which kind, for editors."""
    names = set(schema["properties"]) - {"kind"}
    schema["allOf"] = [
        {
            "if": {"properties": {"kind": {"const": kind}}},
            "then": {
                "required": list(needed),
                "properties": dict.fromkeys(sorted(names - {*needed, *optional}), False),
            },
        }
        for kind, (needed, optional) in DEVICE_KEYS.items()
    ]


class DeviceSection(Section):
    """A device between ground and cap beam; its kind says which keys it has."""

    model_config = ConfigDict(json_schema_extra=_device_schema)

    kind: Literal["viscous", "friction", "stop", "tendon", "rolling_resistance"] = Field(
        description="viscous or friction damper, elastic stop, unbonded tendon in the axis of each"
        " column, or the resistance of the columns to rolling"
    )
    coefficient: Annotated[float, Quantity("N s/m", symbol="c", above=0)] | None = Field(
        None, description="viscous: c, the force at a velocity of 1 m/s, P = c |u_b'|^a"
    )
    exponent: (
        Annotated[
            float, Quantity(symbol="a", at_least=0.2, at_most=2, remedy="1 is a linear damper")
        ]
        | None
    ) = Field(None, description="viscous: a of P = c |u_b'|^a; 1 if left out")
    force: Annotated[float, Quantity("N", symbol="F_d", above=0)] | None = Field(
        None, description="friction: F_d, at which the damper slides"
    )
    gap: Annotated[float, Quantity("m", symbol="d", at_least=0)] | None = Field(
        None, description="stop: d, the cap beam's displacement at which it is met, on both sides"
    )
    stiffness: Annotated[float, Quantity("N/m", above=0)] | None = Field(
        None, description="stop: k_s; tendon: k_t of one"
    )
    damping: Annotated[float, Quantity("N s/m", symbol="c_s", at_least=0)] | None = Field(
        None, description="stop: c_s beside its stiffness; it never pulls; 0 if left out"
    )
    prestress: Annotated[float, Quantity("N", symbol="P_0", at_least=0)] | None = Field(
        None, description="tendon: P_0 of one, while the structure stands"
    )
    yield_force: Annotated[float, Quantity("N", symbol="P_y", above=0)] | None = Field(
        None, description="tendon: P_y of one; left out: it never yields"
    )
    lever: Annotated[float, Quantity("m", symbol="f", above=0)] | None = Field(
        None,
        description="rolling_resistance: f, by which the normal force runs ahead of the contact;"
        " a moment f N at either end of the columns",
    )
