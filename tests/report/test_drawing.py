"""Figures drawn by other processes: the same pictures, whatever happens to those processes.

Copies of a process are made only while it has no other thread, so each test runs in a fresh one.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

HEAD = """
import os, sys, threading
from functools import partial
from rpscli.report.figures.drawing import artists, drawn

def picture(of):
    return f"{of} by {os.getpid()}".encode()

def only_here(of, home):
    if os.getpid() != home:
        os._exit(9)
    return picture(of)

def never(of):
    raise ValueError(f"cannot draw {of}")

NAMES = list("abcde")
"""

copies_are_made = pytest.mark.skipif(
    sys.platform != "linux" or len(os.sched_getaffinity(0)) < 2,
    reason="no copies of a process are made here",
)


def run(script: str) -> str:
    """What the script prints."""
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", HEAD + script],
        env=environment, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


def works(pid: int) -> bool:
    """Whether a process is there that has not ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


@copies_are_made
def test_other_processes_draw_and_the_order_is_kept() -> None:
    printed = run("""
with artists() as drawing:
    pictures = drawn({name: partial(picture, name) for name in NAMES}, drawing)
print([text.decode()[0] for text in pictures.values()], list(pictures))
print(str(os.getpid()) in str(pictures))
""")
    assert printed == f"{list('abcde')} {list('abcde')}\nFalse\n"


@copies_are_made
@pytest.mark.parametrize("killed", ["while drawing", "before"])
def test_what_a_process_does_not_draw_is_drawn_here(killed: str) -> None:
    before = "for each in multiprocessing.active_children(): each.kill(); each.join()"
    printed = run(f"""
import multiprocessing
with artists() as drawing:
    {before if killed == "before" else ""}
    pictures = drawn({{name: partial(only_here, name, os.getpid()) for name in NAMES}}, drawing)
print(len(pictures), str(pictures).count(str(os.getpid())))
""")
    assert printed == "5 5\n"


@copies_are_made
def test_an_error_is_raised_here() -> None:
    printed = run("""
try:
    with artists() as drawing:
        drawn({"a": partial(picture, "a"), "b": partial(never, "b")}, drawing)
except ValueError as error:
    print(error)
""")
    assert printed == "cannot draw b\n"


def test_beside_another_thread_no_process_is_copied() -> None:
    printed = run("""
over = threading.Event()
thread = threading.Thread(target=over.wait)
thread.start()
with artists() as drawing:
    pictures = drawn({name: partial(picture, name) for name in NAMES}, drawing)
over.set()
print(len(drawing), str(pictures).count(str(os.getpid())))
""")
    assert printed == "0 5\n"


@copies_are_made
def test_the_processes_end_with_the_one_that_made_them() -> None:
    printed = run("""
import multiprocessing, signal, time
child = os.fork()
if child == 0:
    with artists():
        print(*(each.pid for each in multiprocessing.active_children()), flush=True)
        os.kill(os.getpid(), signal.SIGKILL)
os.waitpid(child, 0)
""")
    pids = [int(word) for word in printed.split()]
    assert len(pids) == 2
    patience = time.monotonic() + 30.0  # they load matplotlib first
    while any(works(pid) for pid in pids):
        assert time.monotonic() < patience
        time.sleep(0.05)
