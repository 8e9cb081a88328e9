"""Runs the model beside this file, and draws it over the history of rps. Needs no rps.

`model.xml` is run by mujoco, `model.py` by openseespy. The ground motion and the history of rps are
in timehistory.csv; rerun.csv and rerun.png are written. All numbers are SI.
"""

from __future__ import annotations

import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
STEPS_TOGETHER = 10
"""Of mujoco, under one value of the ground acceleration, that of their middle."""
SETTLING = 0.02
"""Time at rest before the ground moves [s], in which contacts take up the weight."""
UP = "ground_acceleration_up [m/s2]"
AT_ONCE = 5e-4
"""Longest step of OpenSees [s]."""


def by_mujoco(time: Any, ground: Any, up: Any, start: dict[str, float]) -> tuple[Any, Any, Any]:
    """Time, cap beam displacement and drift of the lowest storey, after each few steps."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(HERE / "model.xml"))
    data = mujoco.MjData(model)
    joints = {model.joint(i).name: int(model.joint(i).qposadr[0]) for i in range(model.njnt)}
    across = [place for name, place in joints.items() if name.startswith("across")]
    for name, place in joints.items():
        data.qpos[place] = start.get(name.rstrip("0123456789 "), 0.0)
    if not any(start.values()):
        mujoco.mj_step(model, data, round(SETTLING / model.opt.timestep))
    interval = STEPS_TOGETHER * model.opt.timestep
    count = round(time[-1] / interval)
    found = np.zeros((count + 1, 2))
    middles, weight = (np.arange(count) + 0.5) * interval, model.opt.gravity[2]
    pushes, lifts = (np.interp(middles, time, each) for each in (ground, up))
    for i in range(count + 1):
        if i:
            model.opt.gravity[[0, 2]] = -pushes[i - 1], weight - lifts[i - 1]
            mujoco.mj_step(model, data, STEPS_TOGETHER)
        found[i, 0] = 2.0 * data.qpos[across].mean()  # a centre moves half as far as the beam
        found[i, 1] = data.qpos[joints["floor 0"]] if "floor 0" in joints else 0.0
    return np.arange(count + 1) * interval, found[:, 0], found[:, 1]


def by_opensees(time: Any, ground: Any, _: Any, start: dict[str, float]) -> tuple[Any, Any, Any]:
    """Time, displacement and drift at the samples of the record, without vertical motion."""
    model = runpy.run_path(str(HERE / "model.py"))
    ops, dt = model["ops"], float(time[1] - time[0])
    model["build"](ground.tolist(), dt, float(start["beam across"]))
    parts = int(np.ceil(dt / AT_ONCE))
    found = np.zeros((len(time), 2))
    for i in range(len(time)):
        if i and ops.analyze(parts, dt / parts) != 0:
            raise RuntimeError(f"OpenSees did not converge at {time[i]:g} s")
        found[i] = ops.nodeDisp(1, 1)
        found[i, 1] = ops.nodeDisp(2, 1) - found[i, 0] if model["STOREYS"] else 0.0
    return time, found[:, 0], found[:, 1]


def main() -> None:
    """Run, write, draw."""
    as_they_are: dict[str, Any] = {"names": True, "deletechars": "", "replace_space": " "}
    ours = np.genfromtxt(HERE / "timehistory.csv", delimiter=",", **as_they_are)
    names = ["cap_beam_displacement [m]", "storey_1_drift [m]"]
    u, v, theta = (ours[name][0] for name in (names[0], "lift [m]", "rotation [rad]"))
    start = {"across": 0.5 * u, "up": 0.5 * v, "tilt": theta, "beam across": u, "beam up": v}
    program = by_mujoco if (HERE / "model.xml").exists() else by_opensees
    known = ours.dtype.names or ()
    up = ours[UP] if UP in known else np.zeros(len(ours))
    found = program(ours["time [s]"], ours["ground_acceleration [m/s2]"], up, start)
    heads = ",".join(["time [s]", *names])
    np.savetxt(HERE / "rerun.csv", np.array(found).T, "%.9g", ",", header=heads, comments="")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    for axes, name, other in zip(figure.subplots(2, sharex=True), names, found[1:], strict=True):
        mine = ours[name] if name in known else np.zeros(len(ours))
        largest = np.abs(mine).max(), np.abs(other).max()
        sys.stdout.write("largest {}: rps {:.5g}, the other {:.5g}\n".format(name, *largest))
        axes.plot(ours["time [s]"], mine, label="rps")
        axes.plot(found[0], other, "--", label=program.__name__.removeprefix("by_"))
        axes.set(xlabel="time [s]", ylabel=name)
    figure.axes[0].legend(loc="upper right")
    figure.savefig(HERE / "rerun.png", dpi=150)


if __name__ == "__main__":
    main()
