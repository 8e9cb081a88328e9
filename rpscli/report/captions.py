"""Captions of figures, for pages and for `rps explain`."""

CAPTIONS = {
    "s": "The structure at rest.",
    "bearing": (
        "A column at rest, where rolling ends and at the critical rotation, to one"
        " scale; one of its ends enlarged; and the horizontal force at the cap beam"
        " that holds it there. R runs from the middle of the column to the edge of the"
        " flat part of its end; dots are contacts."
    ),
    "orbit": (
        "From above: the path of the cap beam over the ground, and the moment of ground"
        " and building about the contacts, beyond whose circle upright columns with a"
        " flat part uplift; time in colour."
    ),
    "column": (
        "The most loaded column when its moment is largest: forces at its ends, to a"
        " scale of their own, and axial force, shear and moment along it."
    ),
    "rotation": (
        "Ground acceleration, rotation of the columns with the phases of the motion,"
        " and the events."
    ),
    "displacements": "Displacements relative to the ground against time.",
    "moment_rotation": (
        "Driving and restoring moment about the contact points against rotation."
    ),
    "energy": "Balance of the energy supplied by the ground.",
    "storey_shears": "Largest storey shears on the bearings and on a fixed base.",
    "storey_loops": (
        "Shear of the springs of storeys that yield against their drift, and the lines"
        " on which they yield."
    ),
    "devices": "Force against displacement of each device between ground and cap beam.",
    "twist": (
        "The slab from above: paths of the heads of its columns over the ground, enlarged"
        " and drawn from their places, the column that moves most in red; below, the turn"
        " about the vertical."
    ),
    "modes": (
        "Shapes of the podium's own mode and of the first vibration modes on uplifted"
        " columns, a row a state, scaled to 1 at their largest component; dashed: on a"
        " fixed base; red: over the cap beam."
    ),
    "storey_curve": (
        "Force that holds the cap beam at rest, and its lift, against its displacement,"
        " from upright to the critical rotation; dashed: on the way back."
    ),
    "capacity": (
        "Sum of floor forces of each pattern against the displacement of the roof, whole"
        " and near the beginning of motion."
    ),
    "floor_spectra": (
        "Response spectra of the floors on bearings and on a fixed base, for what stands"
        " on them."
    ),
}
"""What a figure shows, by the name of its file."""

NOT_OF_A_RESPONSE = frozenset(
    ("column", "modes", "storey_curve", "capacity", "floor_spectra")
)
"""Those that have sections of their own, or none, on a page."""
