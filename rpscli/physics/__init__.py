"""The compiled kernel on records with named fields; no strings, no exceptions, no files.

`state` names every number once that a lane knows, `interface` what goes in and what comes
out; `records` lay them out. `laws` are the physics, each law once, of plain named
numbers; `lane` asks them with the numbers of a lane, and `energy`, `devices`, `friction`,
`storeys`, `bed` are what else it has. `step` takes a Runge-Kutta step of all lanes
together (`tableau`), `standing` the exact one, `events` finds where a step is to end,
`upright` has uplift, impact and pass, `demands` what is largest, `rest` when nothing more
can come, `samples` and `ground` what is kept. `follow` strings them together from the
`beginning` of a history to its `ending`, in `groups` of those that stand and that move.
`kernels` has machine code of all, `own_laws` of those of other packages, and
`integrate` runs it.

What the kernel's functions hand to each other everywhere stands here once:

Parameters
----------
s
    The record of all lanes (`state.STATE`).
l
    A lane.
r, i, axis
    A mode, a storey or floor or device, a direction: 0 is x, 1 is y.
system, systems
    The record of a lane's structure (`interface.SYSTEM`), and one for
    each direction, or of all.
acceleration
    (samples,) records of the ground end to end [m/s2].
output, log
    Where samples and events go (`run.Output`); of these (rows,) `interface.EVENT`.
tilt, rate, z
    Vectors of two numbers, in x and in y; of one plane the second is 0.
"""
