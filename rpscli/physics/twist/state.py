"""Numbers of a slab that turns: records by name, with units."""

from __future__ import annotations

from rpscli.physics.state import WHOLE, Field, fields_of

COLUMN = (
    *fields_of("", "m", x="place from the centre of mass", y="likewise"),
    *fields_of("", "m", diameter="2 R", beyond_beta="|u| where its arc ends, else 0"),
    *fields_of("", "kg", mass="m_c", carried="m_c/2 + m_b, pushed by the ground"),
    *fields_of("", "kg", vertical="S, its vertical part of an impact's masses"),
    *fields_of("", "N", weight="W: half of itself and all that it carries"),
    *fields_of(
        "",
        "-",
        io_1="Io - 1",
        i_3="I_3/(m_c R^2)",
        one="1 + 4 gamma",
        both="1 + 4 gamma (1 + eta)",
        sin_a="sin(alpha)",
        tan_a="tan(alpha)",
        spin="k while rolling: columns spin by (13.1)",
        sin_beta="sine of beta",
        excess_beta="beta - sin(beta)",
        rolls="1: on its arcs",
    ),
    Field("rolling", "5", "-", "p, q, c, u0, v0 of `geometry.Phase`"),
    Field("rocking", "5", "-", "the same beyond beta"),
    *fields_of("", "rad", theta_limit="counts as overturned", tilt="x of the last stage"),
    # At the last stage.
    *fields_of("", "m", u_x="u of its head", u_y="likewise", lift="v_b"),
    *fields_of("", "m/s", w_x="its velocity", w_y="likewise"),
    *fields_of("", "N", load="N on it"),
    # At the start of the step.
    *fields_of("", "m", away="|u|"),
    *fields_of("", "m2/s", leaving="u.w"),
    *fields_of("", "m", passed="|u| that it has to leave before it passes again"),
    # Kept.
    *fields_of("", "m", max_u="largest |u|"),
    *fields_of("", "s", max_time="when"),
    *fields_of("", "rad", max_tilt="largest tilt"),
    *fields_of("", "N", least_load="least N", most_load="largest N"),
    Field("passes", "", WHOLE, "nearest approaches to upright"),
)
"""A column: its law, its state, its demands."""

MODE = (
    *fields_of("", "1/s2", omega2="w^2"),
    *fields_of("", "1/s", two_xi_omega="2 xi w"),
    Field(
        "Gamma", "3", "mixed", "participation in x, y [sqrt(kg)] and twist [m sqrt(kg)]"
    ),
    *fields_of("", "m sqrt(kg)", q="of the mode", new_q="at a stage"),
    *fields_of("", "m sqrt(kg)/s", dq="velocity", new_dq="at a stage"),
    *fields_of("", "m sqrt(kg)", drift="of the mode at the centre of stiffness"),
    *fields_of("", "m sqrt(kg)/s", drifts="its rate"),
    *fields_of("", "m sqrt(kg)/s2", force="w^2 q + 2 xi w q' of the last stage"),
    Field("ddq", "stages", "m sqrt(kg)/s2", "accelerations at all stages"),
)
"""A mode of the building in x, y and twist."""

DAMPER = (
    *fields_of("", "m", x="place from the centre of mass", y="likewise"),
    *fields_of("", "N s/m", constant="of a linear damper"),
    *fields_of("", "N", friction="of a friction damper"),
)
"""A damper between ground and slab, of one law in all directions."""

SLAB = (
    Field("way", "3", "mixed", "u_x, u_y [m] and psi [rad]"),
    Field("new_way", "3", "mixed", "at a stage"),
    Field("rate", "3", "mixed", "their rates"),
    Field("new_rate", "3", "mixed", "at a stage"),
    Field("bend", "3", "mixed", "accelerations at the start of the step"),
    Field("new_bend", "3", "mixed", "at a stage"),
    Field("bends", "stages 3", "mixed", "at all stages"),
    Field("V", "3", "mixed", "of the storeys on the slab [N; N m]"),
    Field("shaking", "3", "mixed", "a_g + u'', and psi''"),
    Field("push", "3", "mixed", "on the slab [N; N m]"),
    Field("M", "6", "mixed", "masses xx, xy, yy, x psi, y psi, psi psi"),
    Field("seat", "3", "mixed", "z_0 [m] and z [-] of (17.9)"),
    *fields_of("", "kg m2", inertia="I_s less those of its points"),
    *fields_of("", "m", radius="of the column farthest from the centre"),
    *fields_of("", "m/s2", gravity="g"),
    *fields_of("", "N m", pivot="lever times W"),
    *fields_of("", "rad/s", creeps="psi' below which friction in pivoting is viscous"),
    *fields_of("", "m/s", slow="speed below which friction dampers are viscous"),
    *fields_of("", "m", bowl="U_c", sinks="delta of the seats; 0: the slab warps freely"),
    *fields_of("", "m", near="all heads nearer to upright may come to rest"),
    *fields_of("", "N m", holds="torque that full contact holds alone, or 0"),
    *fields_of("", "N", held="push that it holds alone"),
    *fields_of("", "kg", pushed="what the ground pushes in full contact, without floors"),
    *fields_of("", "-", arc="longest step over the time to upright of a head"),
    *fields_of("", "-", step_error="largest error of a step, over the velocities"),
    *fields_of(
        "", "s", h_most="longest step", dt="sampling interval", h_limit="next one"
    ),
    *fields_of("", "s", time="since the interval's start", h="length of the step"),
    *fields_of("", "s", contact_time="t_c, what a pass is compared with"),
    *fields_of("", "-", restitution="e of all columns together", loss="kappa of the law"),
    *fields_of("", "-", error="of the step over what it may be"),
    Field("a_g", "2", "m/s2", "at the interval's start"),
    Field("a_g_slope", "2", "m/s3", "over it"),
    Field("power", "4", "W", "mean of the step: input, damped, of pivots, of dampers"),
    Field("flowed", "4", "J", "the same, so far"),
    *fields_of("", "J", lost="at rest", lost_in_passes="near upright"),
    *fields_of("", "m", away="|u| of the centre at the start of the step"),
    *fields_of("", "m2/s", leaving="u.u' of the centre there"),
    *fields_of("", "rad", max_twist="largest |psi|"),
    *fields_of("", "m", max_u="largest |u| of the centre"),
    *fields_of("", "N", max_shear="largest resultant of V"),
    Field("stands", "", WHOLE, "1: in full contact"),
    Field("outcome", "", WHOLE, "how it ended, or RUNNING"),
    Field("interval", "", WHOLE, "present sampling interval"),
    Field("intervals", "", WHOLE, "of the history"),
    Field("npts", "", WHOLE, "samples of the record"),
    Field("until_rest", "", WHOLE, "1: ends where nothing can move any more"),
    Field("steps", "", WHOLE, "taken"),
    Field("most_steps", "", WHOLE, "more of them are a failure"),
)
"""The slab, what acts on it, and how it is followed."""

SAMPLES = 18
"""Numbers of a sample: u_x, u_y, psi, their rates, energy, the four flows, what was lost at
rest, V of x, y and twist, least and largest N over W, what passes have lost."""
