"""Devices of the rocking storey (Theory, section 11).

Histories without devices run in a record without their fields, and the kernel that follows them is
compiled without this code. What the rest of the kernel calls is marked by `with_devices`.
"""

from __future__ import annotations

from collections.abc import Callable

from rpscli.physics.core.compile import Function, compiled_with


def with_devices(*, otherwise: object = None) -> Callable[[Function], Function]:
    """Compile for a state with devices; without them the function returns a constant."""
    return compiled_with("device_kind", otherwise=otherwise)
