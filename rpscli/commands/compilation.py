"""The wait at the first time history of a new version."""

from __future__ import annotations

from rpscli.commands.terminal import Terminal


def announce_compilation(terminal: Terminal) -> None:
    """Say that the kernels have to be compiled, if they have."""
    from rpscli.physics.driver import integrate  # noqa: PLC0415 -- numba is slow
    from rpscli.physics.jit import is_compiled  # noqa: PLC0415

    if not is_compiled(integrate):
        terminal.note("compiling the kernels, once for this version: up to a minute")
