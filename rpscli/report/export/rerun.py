"""Runs the model beside this file, and draws it over the history of rps. Needs no rps.

`model.xml` is run by mujoco, `model.py` by openseespy. The ground motion and the history of rps are
in timehistory.csv; rerun.csv and rerun.png are written. All numbers are SI.
"""

from __future__ import annotations

import csv
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
AT_ONCE = 5e-4
"""Longest step of OpenSees [s]."""


def history() -> dict[str, Any]:
    """Columns of timehistory.csv by name, without units."""
    with (HERE / "timehistory.csv").open(encoding="utf-8") as file:
        heads, *rows = list(csv.reader(file))
    columns = zip(heads, zip(*rows, strict=True), strict=True)
    return {
        head.partition(" [")[0]: np.array(cells, dtype=float)
        for head, cells in columns
        if "phase" not in head
    }


def by_mujoco(time: Any, ground: Any, start: dict[str, float]) -> tuple[Any, Any, Any]:
    """Time, cap beam displacement and drift of the lowest storey, after each few steps."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(HERE / "model.xml"))
    data = mujoco.MjData(model)
    joints = {model.joint(i).name: int(model.joint(i).qposadr[0]) for i in range(model.njnt)}
    across = [place for name, place in joints.items() if name.startswith("across")]
    for name, place in joints.items():
        kind = name.rpartition(" ")[0] if name[-1].isdigit() else name
        data.qpos[place] = start.get(kind, 0.0)
    if not any(start.values()):
        mujoco.mj_step(model, data, round(SETTLING / model.opt.timestep))
    interval = STEPS_TOGETHER * model.opt.timestep
    count = round(time[-1] / interval)
    found = np.zeros((count + 1, 2))
    pushes = np.interp((np.arange(count) + 0.5) * interval, time, ground)
    for i in range(count + 1):
        if i:
            model.opt.gravity[0] = -pushes[i - 1]
            mujoco.mj_step(model, data, STEPS_TOGETHER)
        found[i, 0] = 2.0 * data.qpos[across].mean()  # a centre moves half as far as the beam
        found[i, 1] = data.qpos[joints["floor 0"]] if "floor 0" in joints else 0.0
    return np.arange(count + 1) * interval, found[:, 0], found[:, 1]


def by_opensees(time: Any, ground: Any, start: dict[str, float]) -> tuple[Any, Any, Any]:
    """The same at the samples of the record."""
    model = runpy.run_path(str(HERE / "model.py"))
    ops, dt = model["ops"], float(time[1] - time[0])
    model["build"](ground.tolist(), dt, start["beam across"])
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
    ours = history()
    beam, lift = ours["cap_beam_displacement"], ours["lift"][0]
    start = {
        "across": 0.5 * beam[0], "up": 0.5 * lift, "tilt": ours["rotation"][0],
        "beam across": beam[0], "beam up": lift,
    }  # fmt: skip
    program = by_mujoco if (HERE / "model.xml").exists() else by_opensees
    time, *theirs = program(ours["time"], ours["ground_acceleration"], start)
    heads = "time [s],cap_beam_displacement [m],storey_1_drift [m]"
    rows = np.column_stack((time, *theirs))
    np.savetxt(HERE / "rerun.csv", rows, "%.9g", ",", header=heads, comments="")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    for axes, name, other in zip(
        figure.subplots(2, sharex=True), ("cap_beam_displacement", "storey_1_drift"), theirs,
        strict=True,
    ):  # fmt: skip
        mine = ours.get(name, 0.0 * beam)
        largest = np.abs(mine).max(), np.abs(other).max()
        sys.stdout.write("largest {}: rps {:.5g} m, the other {:.5g} m\n".format(name, *largest))
        axes.plot(ours["time"], mine, label="rps")
        axes.plot(time, other, "--", label=program.__name__.removeprefix("by_"))
        axes.set(xlabel="time [s]", ylabel=f"{name} [m]")
        axes.legend()
    figure.savefig(HERE / "rerun.png", dpi=150)


if __name__ == "__main__":
    main()
