"""Ends that give way: full contact with a stiffness, and gradual uplift (Theory, section 12).

Histories on rigid ends run in a record without the fields of a bed, and the kernels that follow
them are compiled without this code. What the rest of the kernel calls is marked by `with_bed`.
"""

from __future__ import annotations

from collections.abc import Callable

from rpscli.physics.core.compile import Function, compiled_with


def with_bed(*, otherwise: object = None, anew: bool = False) -> Callable[[Function], Function]:
    """Compile for a state with a bed; without it the function is `otherwise`, or returns it."""
    return compiled_with("bed_k", otherwise=otherwise, anew=anew)
