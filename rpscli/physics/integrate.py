"""Running the kernel: all histories of a run, in machine code that a Ctrl-C can stop."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event, Thread, current_thread, main_thread

import numpy as np

from rpscli.physics.kernels import kernel
from rpscli.physics.records import scratch
from rpscli.physics.run import KernelRun
from rpscli.physics.state import LANES, Record

HEARS = 0.1
"""A Ctrl-C is heard within so many seconds."""


def integrate(run: KernelRun, lanes: int = LANES, *, interruptible: bool = False) -> None:
    """Follow every history of `run.requests` from rest; writes `run.results`.

    Machine code hears no signal: to be `interruptible` by Ctrl-C it runs in another
    thread, which costs a tenth of a millisecond. Of many histories the longest begin
    first, so that no lane is left with one at the end.
    """
    if len(run.requests) > lanes and not run.output.samples.size:
        given = run.requests.view(np.ndarray)
        order = np.argsort(-given["npts"] * given["dt"], kind="stable")
        if np.any(order[1:] < order[:-1]):
            ordered = run._replace(
                requests=run.requests[order], results=run.results[order]
            )
            integrate(ordered, lanes, interruptible=interruptible)
            run.results[order] = ordered.results
            return
    systems = run.systems.view(np.ndarray)  # fields of records take ten times as long
    state = scratch(run.ways, lanes)
    plain = state.view(np.ndarray)
    plain["n"] = systems["n"][0]
    plain["stop"] = 0
    plain["equipped"] = int(systems["devices"].max(initial=0))
    plain["yielding"] = int(systems["yields"].any())
    plain["gives_way"] = int(systems["compliant"].any())
    plain["axes"] = systems["axes"][0]
    given = run.systems, run.requests, run.acceleration, run.results, run.output

    run_kernel = kernel(run.ways, lanes)

    def work() -> None:
        run_kernel(state, *given)

    if interruptible and current_thread() is main_thread():
        hear(work, state)
    else:
        work()


def in_background(work: Callable[..., object], *given: object) -> None:
    """Do some work in another thread; a Ctrl-C does not wait for its end."""
    ended = Event()
    failed = list[BaseException]()

    def whole() -> None:
        try:
            work(*given)
        except BaseException as error:  # noqa: BLE001 -- raised where it is waited for
            failed.append(error)
        finally:
            ended.set()

    Thread(target=whole, daemon=True).start()
    while not ended.wait(HEARS):
        pass
    for error in failed:
        raise error


def hear(work: Callable[[], None], state: Record) -> None:
    """Do some work on a state in another thread; a Ctrl-C stops
    it, and waits for its end.
    """
    ended = Event()

    def whole() -> None:
        try:
            work()
        finally:
            ended.set()

    Thread(target=whole, daemon=True).start()
    try:
        # Not Thread.join: interrupted, it takes a running thread for ended before Python
        # 3.13.
        while not ended.wait(HEARS):
            pass
    except BaseException:
        state.view(np.ndarray)["stop"] = 1
        ended.wait()
        raise
