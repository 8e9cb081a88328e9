"""Compiled kernels on plain floats and arrays; no strings, no exceptions, no files.

`geometry` and `tilt` hold the formulae of the rocking storey, `acceleration` the equations of
motion, `series` a step of them and `terms` the motion within it; `contact` and `standing` the exact
solution while every column stands on its flat ends; `events`, `inspection`, `flight` and `switch`
find what happens in between and do it; `driver` strings them together, for several histories side
by side. Steps run over the buffer of all lanes, see `layout`; the rest sees one of them, a `lane`.
How all this becomes machine code stands in `jit`, `part` and `linking`.
"""
