"""Runs the model beside this file, and draws it over the history of rps. Needs no rps.

`model.xml` is run by mujoco, `model.py` by openseespy. The ground motion and the history
of rps are in timehistory.csv; rerun.csv and rerun.png are written. All numbers are SI.
"""

from __future__ import annotations

import runpy
import sys
from collections.abc import Iterator
from importlib import import_module
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
COMPARABLE = inf
"""Time up to which motions of rps agree that differ by 1e-4 [s]."""
OVERTURNED = inf
"""Displacement of the cap beam from which rps counts it as overturned [m]."""
STEPS_TOGETHER = 10
"""Of mujoco, under one value of the ground acceleration, that of their middle."""
SETTLING = 0.02
"""Time at rest before the ground moves [s], in which contacts take up the weight."""
UP = "ground_acceleration_up [m/s2]"
AT_ONCE = 5e-4
"""Longest step of OpenSees [s]."""

Rows = Iterator[tuple[float, float, float]]
"""Time, cap beam displacement and drift of the lowest storey."""


def by_mujoco(time: Any, ground: Any, up: Any, start: dict[str, float]) -> Rows:
    """After each few steps."""
    mujoco = loaded("mujoco")
    model = mujoco.MjModel.from_xml_path(str(HERE / "model.xml"))
    data = mujoco.MjData(model)
    joints = {
        model.joint(i).name: int(model.joint(i).qposadr[0]) for i in range(model.njnt)
    }
    across = [place for name, place in joints.items() if name.startswith("across")]
    for name, place in joints.items():
        data.qpos[place] = start.get(name.rstrip("0123456789 "), 0.0)
    if not any(start.values()):
        mujoco.mj_step(model, data, round(SETTLING / model.opt.timestep))
    interval = STEPS_TOGETHER * model.opt.timestep
    count = round(time[-1] / interval)
    middles = (np.arange(count) + 0.5) * interval
    weight = model.opt.gravity[2]
    pushes, lifts = (np.interp(middles, time, each) for each in (ground, up))
    for i in range(count + 1):
        if i:
            model.opt.gravity[[0, 2]] = -pushes[i - 1], weight - lifts[i - 1]
            mujoco.mj_step(model, data, STEPS_TOGETHER)
        # a centre moves half as far as the beam
        drift = data.qpos[joints["floor 0"]] if "floor 0" in joints else 0.0
        yield i * interval, 2.0 * data.qpos[across].mean(), drift


def by_opensees(time: Any, ground: Any, _: Any, start: dict[str, float]) -> Rows:
    """At the samples of the record, without vertical motion."""
    loaded("openseespy.opensees")
    model = runpy.run_path(str(HERE / "model.py"))
    ops = model["ops"]
    dt = float(time[1] - time[0])
    model["build"](ground.tolist(), dt, float(start["beam across"]))
    parts = int(np.ceil(dt / AT_ONCE))
    for i in range(len(time)):
        if i and ops.analyze(parts, dt / parts) != 0:
            sys.exit(
                f"OpenSees did not converge at {time[i]:g} s; make AT_ONCE in {__file__}"
                " less"
            )
        beam = ops.nodeDisp(1, 1)
        yield time[i], beam, ops.nodeDisp(2, 1) - beam if model["STOREYS"] else 0.0


def loaded(name: str) -> Any:
    """The other program, or one sentence that names what it lacks."""
    try:
        return import_module(name)
    except Exception as error:  # noqa: BLE001 -- openseespy raises RuntimeError
        cause: BaseException = error
        while inner := cause.__cause__ or cause.__context__:
            cause = inner
        package = name.partition(".")[0]
        sys.exit(
            f"{package} cannot be loaded: {cause}; install it (pip install"
            f" {package}), and the libraries of the system that this names"
        )  # fmt: skip


def main() -> None:
    """Run, write, draw."""
    as_they_are: dict[str, Any] = {"names": True, "deletechars": "", "replace_space": " "}
    ours = np.genfromtxt(HERE / "timehistory.csv", delimiter=",", **as_they_are)
    names = ["cap_beam_displacement [m]", "storey_1_drift [m]"]
    u, v, theta = (ours[name][0] for name in (names[0], "lift [m]", "rotation [rad]"))
    start = {
        "across": 0.5 * u,
        "up": 0.5 * v,
        "tilt": theta,
        "beam across": u,
        "beam up": v,
    }
    program = by_mujoco if (HERE / "model.xml").exists() else by_opensees
    known = ours.dtype.names or ()
    up = ours[UP] if UP in known else np.zeros(len(ours))
    rows = []
    for row in program(ours["time [s]"], ours["ground_acceleration [m/s2]"], up, start):
        rows.append(row)
        if not abs(row[1]) < OVERTURNED:
            sys.stdout.write(f"overturned at {row[0]:.4g} s, beyond {OVERTURNED:.4g} m\n")
            break
    heads = ",".join(["time [s]", *names])
    np.savetxt(HERE / "rerun.csv", rows, "%.9g", ",", header=heads, comments="")
    from matplotlib.figure import Figure

    found = np.transpose(rows)
    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    for axes, name, other in zip(
        figure.subplots(2, sharex=True), names, found[1:], strict=True
    ):
        mine = ours[name] if name in known else np.zeros(len(ours))
        largest = np.abs(mine).max(), np.abs(other).max()
        sys.stdout.write(
            "largest {}: rps {:.5g}, the other {:.5g}\n".format(name, *largest)
        )
        axes.plot(ours["time [s]"], mine, label="rps")
        axes.plot(found[0], other, "--", label=program.__name__.removeprefix("by_"))
        axes.set(xlabel="time [s]", ylabel=name)
        if np.isfinite(COMPARABLE):
            label = f"$\\pm$1e-4 of the motion agree up to {COMPARABLE:.4g} s"
            axes.axvline(COMPARABLE, color="black", linestyle=":", label=label)
    figure.axes[0].legend(loc="upper right")
    figure.savefig(HERE / "rerun.png", dpi=150)


if __name__ == "__main__":
    main()
