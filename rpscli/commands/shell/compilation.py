"""The wait at the first time history of a new version."""

from __future__ import annotations

from rpscli.commands.shell.terminal import Terminal


def announce_compilation(terminal: Terminal) -> None:
    """Say so whenever a kernel has to be compiled from now on."""
    from rpscli.analyses.kernels.compilation import announce_to  # noqa: PLC0415 -- numpy is slow

    announce_to(
        lambda name: terminal.note(
            f"compiling the kernel for {name}, once for this version: half a minute at most"
        )
    )
