# %% [markdown]
# A building on kinematic bearings, from one history to a study: a notebook as a script.
# Editors run it cell by cell; `python cases/notebook.py`, from the folder above, runs all of it.
# Everything is SI.

# %% One case, one motion, one history
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rpscli
from rpscli import figures

case = rpscli.load_case("cases/six_storey.yaml")
motion = rpscli.load_record("synthetic:?pga=0.5g&duration=15&dt=0.02&seed=3")
history = rpscli.time_history(case.structure, motion, case.analysis)
history  # a notebook shows a table

# %% Results are numbers and arrays
trace = history.trace
peak = int(np.argmax(np.abs(trace.rotation)))
print(f"{history.outcome}: {history.rotation_ratio:.2f} of the critical rotation")
print(f"largest sample at t = {trace.time[peak]:.2f} s, of {trace.drifts.shape} drifts")

# %% Panels go into axes of your own
with figures.style():
    figure, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
    figures.rotation(above, history)
    figures.energy(below, history)
    above.label_outer()

# %% The bearing, as it would stand at the critical rotation, beside its force
figure, (left, right) = plt.subplots(1, 2, figsize=(7.0, 3.4), layout="constrained")
figures.bearing(left, case.structure, case.structure.critical_rotation)
figures.storey_curve(right, rpscli.pushover(case.structure))

# %% A motion of your own: an array, scaled to a peak ground velocity
time = np.arange(0.0, 6.0, 0.01)
pulse = rpscli.GroundMotion(
    np.sin(2.0 * np.pi * time) * np.exp(-time), dt=0.01, name="my pulse"
)
for pgv in (0.3, 0.6, 0.9):
    demand = rpscli.demand(case.structure, pulse.scaled_to("PGV", pgv), case.analysis)
    print(
        f"PGV {pgv} m/s: {demand.outcome}, {demand.rotation_ratio:.2f} of the critical rotation"
    )

# %% A study: a file, or what it would say
study = rpscli.load_study(
    {
        "rps": 1,
        "title": "How large may the radius be?",
        "base": "cases/six_storey.yaml",
        "vary": [{"podium.bearing.curvature_ratio": [0.5, 1.0, 1.5]}],
        "records": [
            {
                "source": "synthetic:?pga=0.5g&duration=15&dt=0.02",
                "seed": [1, 2, 3, 4, 5, 6],
            }
        ],
        "scale": {"measure": "PGV", "values": ["40 cm/s", "80 cm/s"]},
        "limits": {"rotation_ratio": {"at_most": 0.5, "share": 0.5}},
        "reports": [
            "overturning",
            {
                "lines": {
                    "x": "podium.bearing.curvature_ratio",
                    "y": "rotation_ratio",
                    "series": "scale",
                    "statistic": "median",
                }
            },
        ],
    }
)
result = study.run("results/notebook")  # `rps sweep` could go on there
result

# %% Its points are columns; pandas takes them, if it is there
print(result["rotation_ratio"].reshape(3, 6, 2).max(axis=1))
print(result.statistics["fixed_base_ratio_median"])
try:
    print(
        result.to_dataframe()
        .groupby("podium.bearing.curvature_ratio")["rotation_ratio"]
        .max()
    )
except ModuleNotFoundError:
    print("pandas is not installed")

# %% Reports are drawn into figures, or written as the program writes them
figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 4.0), layout="constrained")
for axes, name in zip((left, right), study.reports, strict=True):
    result.draw(name, axes)
files = result.write(figures=("svg",))
print(f"{len(files)} files in {Path(files[0]).parent}; limits kept: {result.passed}")
