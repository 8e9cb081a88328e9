"""How far something is, for those who look."""

from __future__ import annotations

import io

import pytest

from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import MANY, counted, watched


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


def test_many_systems_are_announced_few_are_not(capsys: pytest.CaptureFixture[str]) -> None:
    for count in (MANY - 1, MANY):
        assert list(watched("systems examined", Terminal(), range(count))) == list(range(count))
    assert capsys.readouterr().err == f"{MANY} systems examined\n"


def test_a_warning_is_said_once(capsys: pytest.CaptureFixture[str]) -> None:
    terminal = Terminal()
    terminal.warn(["R is unusual", "e is unusual"])
    terminal.warn(["e is unusual", "contact is lost"])
    said = capsys.readouterr().err.splitlines()
    assert said == [
        f"warning: {text}" for text in ("R is unusual", "e is unusual", "contact is lost")
    ]
