"""Compiled kernels on records with named fields; no strings, no exceptions, no files.

`core` holds what kernels of any equation of motion share: records with named fields, lanes with
their record of the ground and their log, series, quintics, oscillators, and how all becomes machine
code. `planar` is the podium in a vertical plane: `state` names every number once;
`equation_of_motion` is the method, what moves with its Taylor terms; `steps` takes Taylor steps of
all lanes together and `events` finds what happens in them; `full_contact` follows a building on a
fixed base exactly until it uplifts; `transitions` go from one phase of motion to the next;
`energy` audits. `driver` strings them together.

What the kernels hand to each other everywhere stands here once:

Parameters
----------
s, state
    The record of all lanes (`planar.state.STATE`), and the array of one that holds it.
l, lanes
    A lane, and how many there are.
r, i, m
    A mode, a storey or floor or device, the order of a Taylor term; from 0.
system, systems
    The record of a lane's structure (`planar.state.SYSTEM`), and (S,) of all structures.
block, blocks
    The record of steps in full contact (`planar.state.BLOCK`), and the array that holds it; to the
    search of events it lends scratch.
acceleration
    (samples,) records of the ground end to end [m/s2].
output, log
    Where samples and events go (`planar.run.Output`); of these (rows,) `planar.state.EVENT`.
run
    The histories, and where their results go (`planar.run.Run`).
"""
