"""What a long history costs, said before it begins, and that it goes on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rpscli.commands.shell.passing_time import passing_time
from rpscli.commands.shell.terminal import Terminal

if TYPE_CHECKING:
    from rpscli.case.case import Case

LONG = 10.0
"""What is worth a word [s]."""


@contextmanager
def patience(case: Case, duration: float, terminal: Terminal) -> Iterator[None]:
    """Around the computation of a history.

    Parameters
    ----------
    case
        What is computed.
    duration
        Of the record [s].
    terminal
        Where to say it.
    """
    from rpscli.analyses.kernels.step_lengths import (
        most_seconds,
        most_steps,
    )

    seconds = most_seconds(case.structure, case.analysis, duration)
    if seconds < LONG:
        yield
        return
    steps = most_steps(case.structure, case.analysis, duration)
    terminal.note(
        f"a long history: up to {steps:.2g} steps of {case.structure.storeys} modes, {seconds:.0f}"
        " s if it does not come to rest before; analysis.free_vibration shortens it"
    )
    with passing_time("computing", terminal):
        yield
