"""Reading a podium back from its row of numbers, inside the kernels."""

from __future__ import annotations

from rpscli.physics.geometry import Phase
from rpscli.physics.jit import kernel
from rpscli.physics.parameters import Floats, Podium


@kernel
def podium_of(table: Floats, s: int) -> Podium:
    """The podium in row s of a table of numbers."""
    t = table[s]
    return Podium(
        t[0],
        t[1],
        t[2],
        t[3],
        t[4],
        Phase(t[5], t[6], t[7], t[8], t[9]),
        Phase(t[10], t[11], t[12], t[13], t[14]),
        t[15],
        t[16],
        t[17],
        t[18],
        t[19],
        t[20],
        t[21],
        t[22],
        t[23],
        t[24],
        t[25],
        t[26],
        t[27],
        t[28],
        t[29],
        t[30],
        t[31],
        t[32],
        t[33],
    )
