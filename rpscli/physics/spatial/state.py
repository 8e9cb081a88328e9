"""What the kernel for two horizontal components reads and writes, as `planar.state` for one.

A structure is two records of `planar.state.SYSTEM`: of the directions x and y, which differ in
their buildings only; that in x is asked for all else. The state has the fields of the planar one
under the same names, with a row for each mode in x and behind them for each in y; its `n` counts
these rows, so that what loops over modes serves both kernels. What is planar and means less here:
`theta` is the tilt, >= 0, and its azimuth stands in `cos_phi` and `sin_phi`.
"""

from __future__ import annotations

import numpy as np

from rpscli.physics.core.records import WHOLE, Field
from rpscli.physics.planar import state as planar
from rpscli.physics.planar.run import Run

UPRIGHT_TILT = 5e-10
"""theta_c [rad]: what passes nearer is taken over by a map."""

UPLIFT_TILT = 1e-9
"""Tilt with which an uplift begins [rad]; its azimuth is that of the push."""


def _composed() -> tuple[Field, ...]:
    """The fields of the planar state, with rows in place of modes where both directions have some.

    What is of one lane and each storey stays; arrays of the planar step that the spatial one has no
    use for are left out.
    """
    unused = {"action_terms", "beam_velocity_term", "next_B", "next_C", "next_per_A"}
    unused |= {"next_theta_push", "looked_at", "shear_bound", "shear_before", "shear_bend"}
    unused |= {"acceleration_bound", "acceleration_before", "device_terms", "V", "storey_shear"}
    unused |= {"shear_room", "shear_below_all_maxima", "last_shear", "floor_acceleration"}
    unused |= {"acceleration_room", "acceleration_below_all_maxima", "last_acceleration"}
    kept = [field for field in planar.STATE if field.name not in unused]
    return tuple(
        field._replace(sizes=field.sizes.replace("modes lanes", "rows lanes"), by="spatial")
        for field in kept
    )


def _lanes(unit: str, **meanings: str) -> tuple[Field, ...]:
    """Numbers of each lane."""
    return tuple(Field(name, "lanes", unit, text, "spatial") for name, text in meanings.items())


def _terms(unit: str, sizes: str, **meanings: str) -> tuple[Field, ...]:
    """Taylor terms of each lane, as powers of t/h."""
    return tuple(
        Field(f"{name}_terms", f"{sizes} lanes", unit, text, "spatial")
        for name, text in meanings.items()
    )


STATE_3D = (
    *_composed(),
    Field("storeys", "", WHOLE, "of the building; n is twice as many", "run"),
    Field("record_y", "lanes", WHOLE, "offset of the record in y", "driver"),
    *_lanes("m/s2", a_g_y="a_g in y at the interval's start", next_a_g_y="at the step's end"),
    *_lanes("m/s3", a_g_y_slope="over the interval"),
    *_lanes("-", series_ratio="the step's last terms over what they may be"),
    *_lanes("s", contact_time="t_c", step_limit="steps are no longer than this; 0: as they may be"),
    *_lanes(
        "-",
        inertia_axial="I_3/(m_c R^2)",
        restitution="e",
        bounces_kept="1: floors keep their absolute velocity at re-contact, 0: the relative one",
        cone="kappa = sqrt(K(0)/A(0)) of the near-pass map",
        spin_0="columns spin by G = 1 - cos x + spin (x - sin x)/(spin_0 + spin_1 sin x)",
        spin_1="likewise; 0 beyond beta, where G - 1 + cos x is `spin`",
        spin="likewise",
        A_cos2="of cos 2x in A/(4 gamma eta)",
        A_sin2="of sin 2x in it",
        H_sin="of sin x in H",
        H_cos="of cos x in it",
        H_sin2="of sin 2x in it",
        H_cos2="of cos 2x in it",
        H_x="of x in it",
        cos_phi="cosine of the azimuth of the tilt",
        sin_phi="sine of it",
        next_turn="change of the azimuth over the step [rad]",
        per_J="1/J, J = K theta^2",
    ),
    *_lanes(
        "rad/s",
        angular_momentum="L over N m_c R^2",
        next_angular_momentum="at the end of the step",
        turning="w, the azimuth's rate",
    ),
    *_lanes("rad/s2", turning_rate="w' at the start of the step"),
    *_lanes(
        "N",
        push_x="of devices on the cap beam, in x",
        push_y="in y",
        pull="of devices on it, downwards",
    ),
    Field("shear", "2 lanes", "N", "last term of V in x and y", "spatial"),
    Field("beam", "2 lanes", "m/s", "last term of u_b' and the ground's velocity", "spatial"),
    # Positions have a term more than velocities.
    *_terms("rad", "positions", tilt="of x"),
    *_terms(
        "-",
        "positions",
        sin="of sin x",
        cos="of cos x",
        sin2="of sin 2x",
        cos2="of cos 2x",
        D="of C - c",
        u="of u = |u_b|/2R",
    ),
    *_terms("-", "2 positions", e="of cosine and sine of the azimuth", u_b="of u_b/2R in x and y"),
    *_terms("-", "2 terms", C_e="of C times these"),
    *_terms("1/s2", "2 terms", z="of z in x and y"),
    *_terms("rad/s", "terms", turning="of w", momentum="of L"),
    *_terms("-", "terms", J="of J", H="of H", g="of G - 1 + cos x", g_slope="of its slope"),
    *_terms("1/s2", "terms", w2="of w^2"),
    # Demands of floors, see `demands` for their rows; what bounds them is in `planar.demands`.
    Field("looked_at", "12 rows", "mixed", "shears, accelerations; modes", "spatial"),
    *(
        Field(name, "6 lanes modes", "mixed", text, "spatial")
        for name, text in (("largest", "the demands"), ("last", "when last looked at"))
    ),
    Field("bound", "4 lanes", "mixed", "sums of what changed since then", "spatial"),
    Field("before", "4 lanes", "mixed", "at the start of the step", "spatial"),
    Field("bend", "2 lanes", "mixed", "sums of what velocities lose, in x and y", "spatial"),
    Field("room", "6 lanes", "mixed", "no demand rises with a sum to this", "spatial"),
    Field("below", "6 lanes", "mixed", "none rises from rest", "spatial"),
    # Where it was largest, and what passes near upright did.
    *_lanes("rad", max_azimuth="of the largest tilt", critical_azimuth="where theta_cr was passed"),
    Field("max_beam", "2 lanes", "m", "largest |u_b| in x and y", "spatial"),
    *_lanes("m", torsion_lever="largest so far"),
    *_lanes("-", passes_as_impacts="passes with l > .5"),
    Field("closest_pass", "lanes", "-", "least theta_min/alpha of a pass", "spatial"),
    Field("shortest_pass", "lanes", "s", "least theta_min/|q| of a pass", "spatial"),
    *_lanes("J", energy_passes="lost in passes"),
)
"""`state` of `spatial`; lanes side by side."""

EQUIPPED_STATE_3D = (
    *STATE_3D,
    *(field for field in planar.STATE if field.name == "device_terms"),
    *planar.EQUIPPED_STATE[len(planar.STATE) :],
    *_lanes("-", kinks="1: a device's force has a kink where v = 0"),
    *_terms("m/s", "2 terms", v="of u_b' in x and y"),
    *_terms("m2/s2", "terms", speed2="of its square"),
    *_terms("N s/m", "terms", drag="of -P/u_b'"),
)
"""With devices."""

STATES_3D = {"pairs": STATE_3D, "pairs with devices": EQUIPPED_STATE_3D}
"""By the variant of the kernel that is compiled for it."""


def variant_of_pairs(run: Run) -> str:
    """Which of `STATES_3D` the structures of a run ask for."""
    devices = run.systems.view(np.ndarray)["devices"]
    return "pairs with devices" if devices.any() else "pairs"


RESULT_3D = (
    *planar.RESULT,
    Field("azimuth", "", "rad", "of the tilt at the end, from x towards y"),
    Field("max_azimuth", "", "rad", "of the largest tilt"),
    Field("critical_azimuth", "", "rad", "of the first passage of theta_cr"),
    Field("max_x", "", "m", "largest |u_b| in x"),
    Field("max_y", "", "m", "in y"),
    Field("passes_as_impacts", "", WHOLE, "passes that lost more than half of an impact's share"),
    Field("closest_pass", "", "-", "least theta_min/alpha of a pass; infinite without passes"),
    Field("shortest_pass", "", "s", "least theta_min/|theta phi'| of a pass; over t_c it is s"),
    Field("energy_passes", "", "J", "lost in passes, part of energy_lost"),
    Field("torsion_lever", "", "m", "largest torsion in a contact over the weight on it"),
    *(
        Field(f"{name}_{way}", "modes", unit, f"largest one in {way}")
        for name, unit in (("storey_shear", "N"), ("floor_acceleration", "m/s2"))
        for way in "xy"
    ),
)
"""What a history leaves behind: `planar.state.RESULT`, whose demands are resultants, and more.

Passes are `events[planar.state.PASS]`.
"""

SAMPLE_3D = (
    *planar.SAMPLE,
    Field("azimuth", "", "rad", "phi of the tilt, from x towards y; 0 in full contact", "spatial"),
    Field("turning", "", "rad/s", "phi'", "spatial"),
    Field("turning_rate", "", "rad/s2", "phi''", "spatial"),
    Field("push_x", "", "N", "of devices on the cap beam, in x", "spatial"),
    Field("push_y", "", "N", "in y", "spatial"),
)
"""The floors' displacements and velocities stand in an array of their own: in x, then in y.

`theta` is the size of the tilt; u_b = 2 R u(theta) (cos phi, sin phi).
"""

EVENT_3D = (
    *planar.EVENT,
    Field("azimuth", "", "rad", "of the tilt, after a pass that towards which it goes on"),
    Field("least_tilt", "", "rad", "of a pass: theta_min; else 0"),
    Field("nearness", "", "-", "of a pass: s = theta_min/(|q| t_c); infinite for t_c = 0"),
    Field("loss_share", "", "-", "of a pass: l, of what an impact would lose"),
)
