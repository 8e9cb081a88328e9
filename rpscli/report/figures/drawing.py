"""Figures drawn by other processes, which load matplotlib while this one computes.

Threads would not help: neither loading nor drawing lets go of the interpreter.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from multiprocessing.connection import Connection, wait

from rpscli.report.figures import style
from rpscli.report.figures.look import Look, drawn_with

MOST_ARTISTS = 2
"""A time history has five figures: more processes would load longer than they draw."""

Draw = Callable[[], bytes]
"""Makes the file of a figure; can be pickled."""

Artists = Sequence[Connection]
"""What leads to processes that draw what they are sent, and send the picture back."""


@contextmanager
def artists(figures: int = MOST_ARTISTS) -> Iterator[Artists]:
    """Processes that get ready to draw so many figures; none if all is to be drawn here.

    They are copies of this process, to be made early: what is in memory by then must be copied as
    soon as it is touched, which takes longer than to load it once more. They end with it.
    """
    import multiprocessing

    ends: list[Connection] = []
    for _ in range(min(_cores_for_copies(), figures)):
        here, there = multiprocessing.Pipe()
        ends.append(here)
        fork = multiprocessing.get_context("fork")
        fork.Process(target=_work, args=(there, tuple(ends)), daemon=True).start()
        there.close()
    try:
        yield ends
    finally:
        for end in ends:
            end.close()


def figure_files(
    figures: Mapping[str, Draw], look: Look, artists: Artists = ()
) -> dict[str, bytes]:
    """The files of figures by their names, in each format that is wanted.

    Parameters
    ----------
    figures
        What draws each figure, by the file's name without its ending.
    look
        Formats and style.
    artists
        Processes that draw.
    """
    wanted = {
        f"{stem}.{ending}": partial(drawn_with, look, ending, draw)
        for stem, draw in figures.items()
        for ending in look.endings
    }
    return drawn(wanted, artists)


def drawn(figures: Mapping[str, Draw], artists: Artists = ()) -> dict[str, bytes]:
    """The files of figures by their names, in the order given.

    What a process fails to draw is drawn here; if it fails here too, that is the error.
    """
    waiting, idle = list(figures), list(artists)
    at_work: dict[Connection, str] = {}
    pictures: dict[str, bytes] = {}
    while at_work or (waiting and idle):
        while waiting and idle:
            artist, name = idle.pop(), waiting.pop(0)
            with suppress(OSError):
                artist.send(figures[name])
                at_work[artist] = name
        done = wait(list(at_work)) if at_work else ()
        for artist in [each for each in at_work if each in done]:
            name = at_work.pop(artist)
            with suppress(EOFError, OSError):
                pictures[name] = artist.recv_bytes()
                idle.append(artist)
    return {name: pictures.get(name) or draw() for name, draw in figures.items()}


def _cores_for_copies() -> int:
    """How many copies of this process may run.

    None with a single core; nor where one is not safe, which is anywhere but on Linux, and while
    this process has other threads, which a copy would be without.
    """
    try:
        threads = len(os.listdir("/proc/self/task"))  # noqa: PTH208 -- only their number
    except OSError:
        return 0
    cores = len(os.sched_getaffinity(0))
    return min(cores, MOST_ARTISTS) if threads == 1 and cores > 1 else 0


def _work(here: Connection, elsewhere: Artists) -> None:
    """Get ready, and draw until nobody is left who could ask."""
    # An interruption is the business of the process that waits.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for end in elsewhere:
        end.close()  # or this process would keep its own line open
    with suppress(Exception):
        style.picture(lambda figure: style.heading(figure, "fonts"), 1.0, layout=None)
        while True:
            here.send_bytes(here.recv()())
