"""A slab that turns about the vertical on columns that each follow their heads (Theory, 17).

The unknowns are the slab's three ways u_x, u_y and psi and the building's modes with a part
in twist, which no lane of the other kernel has. The law of a column is the same `place`;
`laws.head` asks it the other way round. `state` names all numbers, `slab` sums up columns,
`seats` are their loads, `resting` is full contact, `follow` the history.
"""
