"""`rps record`: ground motions by themselves."""

from __future__ import annotations

import click

from rpscli.commands.shell.lazy import LazyGroup, Member

MEMBERS = {
    "info": Member("rpscli.commands.record.info", "what was read, and its intensity measures"),
    "plot": Member("rpscli.commands.record.plot", "time histories and response spectrum"),
    "select": Member("rpscli.commands.record.select", "motions and factors that fit a spectrum"),
    "convert": Member("rpscli.commands.record.convert", "write it as AT2 or as two columns"),
    "synth": Member("rpscli.commands.record.synth", "make a pulse or a synthetic motion"),
}


@click.command("record", cls=LazyGroup, members=MEMBERS)
def command() -> None:
    """Look at ground motions, choose them, convert them, make them.

    SRC is a file (PEER AT2, columns of numbers, and more; options as in rec.txt?dt=0.01&units=g),
    a member of a set (fema_p695:farfield/1/b), two components at an angle in degrees
    (fema_p695:farfield/1?angle=30, x.at2?second=y.at2&angle=30), a pulse
    (pulse:sine?amplitude=0.4g&period=1.2) or a synthetic motion (synthetic:?pga=0.4g&seed=1).
    """
