"""Input and output of the kernel: structured records, named fields.

* ``system``: a structure and how it is followed; filled by `rpscli.analyses`, read
  only; where both components act two stand together, of the directions x and y, which
  differ in their buildings;
* ``request``: a history to run, a system under a record; likewise;
* ``result``: what a history leaves behind;
* ``sample`` and ``event``: its motion at an instant, and what happened.
"""

from __future__ import annotations

from rpscli.physics.state import EVENT_KINDS, KEPT, SLOTS, WHOLE, Field, fields_of

SYSTEM = (
    Field("n", "", WHOLE, "storeys, and modes"),
    *fields_of("", "m", R="semi-diagonal of a column"),
    *fields_of(
        "",
        "rad",
        alpha="slenderness angle of its flat part",
        beta="rotation at which the arc ends; 0 for flat ends",
        theta_cr="static limit: B = 0",
        theta_limit="counts as overturned",
        initial_rotation="theta at the start, released from rest",
    ),
    Field("uplift_tilt", "", "rad", "tilt with which an uplift to any side begins"),
    Field(
        "initial_turning",
        "",
        "rad/s",
        "rate of its azimuth then, for tests of free motion",
    ),
    Field("rolling", "5", "-", "p, q, c, u0, v0 of `geometry.Phase`"),
    Field("rocking", "5", "-", "the same beyond beta"),
    *fields_of(
        "",
        "-",
        Io="I_o/(m_c R^2)",
        inertia_axial="I_3/(m_c R^2), about a column's own axis",
        gamma="m_b/(N m_c)",
        eta="M_tot/m_b",
        restitution="e",
        columns="N",
        step_error="largest error of a step, over the velocities of the tilt",
        most_steps="more of them are a failure",
        recontact_tolerance="of alpha: a lower excursion is not followed",
        lifts="j = sqrt(A_u/A(phi_u+)), of theta' at uplift from a bed",
        bed_height="C_u = C(phi_u)",
    ),
    *fields_of("", "kg", columns_mass="N m_c", cap_beam_mass="m_b", floors_mass="M_tot"),
    Field("gravity", "", "m/s2", "g"),
    *fields_of(
        "",
        "s",
        contact_time="t_c, what a pass near upright is compared with",
        shock_time="tau: beam and columns are turned over within it as by an impact",
        free_vibration="time after the record, at most",
    ),
    *fields_of(
        "",
        WHOLE,
        axes=(
            "records of a structure: horizontal directions, and upwards on vertical"
            " springs"
        ),
        floors_jump="1 if the floors jump with the cap beam at an impact",
        max_events="more of them are a failure",
        until_rest="1 if it may end earlier, with nothing new to come",
        devices="number of devices",
        compliant="1 if full contact gives way, on a bed",
        yields="1 if storeys may yield",
    ),
    *fields_of(
        "", "-", hardening="h, stiffness of a storey that yields over the elastic one"
    ),
    *fields_of("modes", "N", strength="F of a storey, or infinite"),
    *fields_of("modes", "N/m", stiffness="k of a storey"),
    *fields_of("modes", "kg", mass="of a floor"),
    *fields_of("modes", "rad/s", omega="frequencies of the fixed base"),
    *fields_of("modes", "1/s2", omega2="w^2"),
    *fields_of("modes", "1/s", two_xi_omega="2 xi w"),
    *fields_of(
        "modes", "sqrt(kg)", Gamma="participation Phi^T M 1, shapes mass-normalised"
    ),
    *fields_of(
        "modes",
        "mixed",
        shear_weight="g_r of `floors`, for storey shears",
        acceleration_weight="g_r for floor accelerations",
        shear_bound_of="of a storey: shear times this <= sqrt(sum g q^2)",
        acceleration_bound_of="of a floor: likewise",
    ),
    Field("phi", "modes modes", "1/sqrt(kg)", "shapes: mode, floor"),
    Field("storey_shear_of", "modes modes", "N/(m sqrt(kg))", "k_i (phi_i - phi_(i-1))"),
    Field(
        "bend_ratio", "", "mixed", "largest w^4 times the latter weight over the former"
    ),
    *fields_of(
        "",
        "1/s",
        step_rate="least number of steps a second",
        bedded_rate="likewise in full contact on a bed",
        bed_c="damping of full contact, over N m_c R^2",
    ),
    Field("device_kind", f"{SLOTS}", WHOLE, "VISCOUS to OWN"),
    Field("device_constants", f"{SLOTS} 4", "mixed", "of its law, see the kinds"),
    Field(
        "own_law",
        f"{SLOTS} 3",
        WHOLE,
        "addresses of force and watched value; 1: kink at rest",
    ),
    Field("impact_law", "", WHOLE, "address of an own law of e, or 0"),
    Field(
        "impact_constants",
        "6",
        "mixed",
        "of it: a, b of e = a + b e_own, and four of its own",
    ),
    Field("linear_speed", "", "m/s", "up to which |u_b'|^a is followed as linear"),
    Field(
        "start_speed", "", "m/s", "|u_b'| with which a tilt to any side begins to slide"
    ),
    *fields_of(
        "",
        "rad",
        bed_uplift="phi_u, at which full contact ends",
        bed_full="x_full of curved ends on a plane bed; else 0",
    ),
    Field("bed_k", "", "1/s2", "k of full contact, over N m_c R^2"),
    *fields_of(
        "",
        "sqrt(rad)",
        sink="what a plane bed takes from the weight's arm, times w",
        root="and from that of the lift",
    ),
)

REQUEST = (
    Field("system", "", WHOLE, "number of the structure"),
    Field("record", "", WHOLE, "offset of the record among all"),
    Field("record_y", "", WHOLE, "offset of the second horizontal record, or NO_RECORD"),
    Field("npts", "", WHOLE, "its samples"),
    Field("vertical", "", WHOLE, "offset of the vertical record, or NO_RECORD"),
    Field("scale", "", "-", "factor on all"),
    Field("dt", "", "s", "sampling interval"),
)

RESULT = (
    Field("outcome", "", WHOLE, "how the history ended"),
    Field("phase", "", WHOLE, "phase of motion at its end"),
    Field(
        "ways", "", WHOLE, "horizontal components: of one, what asks for two is not known"
    ),
    Field("intervals", "", WHOLE, "sampling intervals that it lasted"),
    Field("steps", "", WHOLE, "steps taken"),
    Field("events", f"{EVENT_KINDS}", WHOLE, "of each kind"),
    Field("time", "", "s", "of its end"),
    *KEPT,
    Field("rotation", "", "rad", "theta at its end"),
    Field("azimuth", "", "rad", "of the tilt at the end, from x towards y"),
    Field("max_x", "", "m", "largest |u_b| in x"),
    Field("max_y", "", "m", "in y"),
    Field("energy_stored", "", "J", "at the end"),
    Field("storey_shear", "modes", "N", "largest |k_i d_i|"),
    Field("floor_acceleration", "modes", "m/s2", "largest absolute one"),
    *(
        Field(f"{name}_{way}", "modes", unit, f"largest one in {way}")
        for name, unit in (("storey_shear", "N"), ("floor_acceleration", "m/s2"))
        for way in "xy"
    ),
    Field("ductility", "2 modes", "-", "largest |d| k/F of a storey, in x and in y"),
    Field("slip", "2 modes", "m", "its plastic drift at the end"),
    Field("slip_most", "2 modes", "m", "the largest"),
    Field("slip_least", "2 modes", "m", "and the least"),
    Field("yielded", "2 modes", "J", "by it"),
    Field("first_yield", "2 modes", "s", "when it first yields; negative if never"),
    Field("device_force", f"{SLOTS}", "N", "largest |force|"),
    Field("device_velocity", f"{SLOTS}", "m/s", "largest |rate|"),
    Field("device_energy", f"{SLOTS}", "J", "dissipated"),
    Field("device_stored", f"{SLOTS}", "J", "at the end, over the start"),
    Field("permanent", f"{SLOTS}", "m", "plastic elongation of a tendon"),
)
"""Of both components demands are resultants."""

SAMPLE = (
    Field("theta", "", "rad", "tilt, positive to the right; of both components its size"),
    Field("theta_dot", "", "rad/s", "theta'"),
    Field("theta_ddot", "", "rad/s2", "theta''; 0 in full contact"),
    Field("phase", "", WHOLE, "FULL_CONTACT to BEDDED"),
    Field("azimuth", "", "rad", "phi of the tilt, from x towards y; 0 in full contact"),
    Field("turning", "", "rad/s", "phi'"),
    Field("lift", "", "m", "v_b"),
    Field("height", "", "m", "2 R C, of the thrust lines"),
    Field("normal_top", "", "N", "N on the upper ends of all columns"),
    Field("normal_bottom", "", "N", "on the lower ends"),
    Field("energy_input", "", "J", "by the ground so far"),
    Field("energy_damped", "", "J", "in the building so far"),
    Field("energy_upwards", "", "J", "in its dampers upwards so far"),
    Field("energy_yielded", "", "J", "by storeys that yield so far"),
    Field("energy_lost", "", "J", "at impacts and re-contacts so far, net"),
    Field("energy_bed", "", "J", "dissipated in the bed so far"),
    Field("energy_stored", "", "J", "stored, in devices over that at the start"),
    Field("beam", "2", "m", "u_b in x and y"),
    Field("base_shear", "2", "N", "of springs and dampers of the first storey"),
    Field("shear_top", "2", "N", "F on what stands on the columns"),
    Field("shear_bottom", "2", "N", "F on the columns"),
)
"""Displacements and velocities of the floors over the ground, and their absolute
accelerations, stand in an array of their own: those in x, then those in y."""

EVENT = (
    Field("time", "", "s", "since the record's start"),
    Field("kind", "", WHOLE, "UPLIFT to PASS"),
    Field("theta", "", "rad", "tilt of the storey"),
    Field("theta_dot_before", "", "rad/s", "theta' just before"),
    Field("theta_dot_after", "", "rad/s", "theta' just after"),
    Field("energy_lost", "", "J", "in the event; negative where it was created"),
    Field(
        "azimuth", "", "rad", "of the tilt, after a pass that towards which it goes on"
    ),
    Field("least_tilt", "", "rad", "of a pass: theta_min; else 0"),
    Field(
        "nearness", "", "-", "of a pass: s = theta_min/(|q| t_c); infinite for t_c = 0"
    ),
    Field("loss_share", "", "-", "of a pass: l, of what an impact would lose"),
)
