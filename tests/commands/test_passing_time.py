"""How far something is, for those who look."""

from __future__ import annotations

import io

import pytest

from rpscli.commands.shell.passing_time import counted
from rpscli.commands.shell.terminal import Terminal


class Screen(io.StringIO):
    """A terminal that keeps what it shows."""

    def isatty(self) -> bool:
        return True


def shown(stream: io.StringIO, terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr("sys.stderr", stream)
    with counted("drawing", terminal) as tell:
        tell(3, 40)
    return stream.getvalue()


def test_a_bar_on_a_terminal_one_line_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    bar = shown(Screen(), Terminal(), monkeypatch)
    assert "drawing" in bar
    assert "3/40" in bar
    assert shown(io.StringIO(), Terminal(), monkeypatch) == "drawing\n"
    assert shown(Screen(), Terminal(quiet=True), monkeypatch) == ""
