"""What small functions of `rpscli.commands` give, by example."""

from __future__ import annotations

from rpscli.commands.shell.options import _formats
from rpscli.commands.shell.waiting import duration
from rpscli.commands.timehistory_run import unique


def test_shell_options() -> None:
    assert (_formats("svg, pdf"), _formats("none")) == ((("svg", "pdf"), ()), ((), ()))


def test_shell_waiting() -> None:
    assert (duration(7.4), duration(83.0), duration(7260.0)) == ("7 s", "1 min 23 s", "2 h 1 min")


def test_names_of_folders() -> None:
    assert unique(["a", "b", "a", "B"]) == ["a", "b", "a_2", "B_2"]
