"""Compiled kernels on records with named fields; no strings, no exceptions, no files.

`state` names every number once. `equation_of_motion` is the method: what moves, with its Taylor
terms; `formulae` is the mathematics below it. `uplifted` takes Taylor steps of all lanes together
and finds what happens in them, `full_contact` follows a building on a fixed base exactly until it
uplifts, `transitions` go from one phase of motion to the next, `energy` audits. `driver` strings
them together. How all this becomes machine code stands in `compile`.

Everywhere `s` is the record of all lanes (`state.STATE`), `l` a lane, `r` a mode, `i` a storey or
floor, `m` the order of a Taylor term; `system` is the record of a lane's structure, and `block`
that of steps in full contact.
"""
