"""What the kernels read and write: structured records, every field named once, here.

Five records, each with an owner:

* ``system``: a structure and how it is followed; filled by `rpscli.analyses`, read only;
* ``request``: a history to run, a system under a record; likewise;
* ``state``: all lanes side by side; field ``theta`` has one entry a lane, ``q`` one row a mode;
* ``block``: steps in full contact, of one lane at a time, entry k after k steps;
* ``result``: what a history leaves behind.

Letters are those of Theory: x = |theta|, s its side, B and C the arms of contact over R.
"""

from __future__ import annotations

from rpscli.physics.core.records import WHOLE, Field

SLOTS = 8
"""Devices that a structure may have."""

# Kinds of device.
VISCOUS, FRICTION, STOP, TENDON, ROLLING_RESISTANCE = range(5)

# Where the constants of their laws stand in `device_constants`.
DAMPER_COEFFICIENT, DAMPER_EXPONENT = range(2)  # c, a
FRICTION_FORCE = 0  # F_d
STOP_GAP, STOP_STIFFNESS, STOP_DAMPING = range(3)  # d, k_s, c_s
TENDON_PRESTRESS, TENDON_STIFFNESS, TENDON_YIELD = range(3)  # P_0, k_t, P_y of one column
ROLLING_MOMENT = 0  # 2 W f

# Branches of a device's law: of a stop with its gap open, pushing back, let go before its gap; of
# a tendon slack, elastic, yielding. The others have one.
IDLE, WORKING, BEYOND = range(3)

# Phases of motion; STUCK is held by friction while tilted, BEDDED in full contact that gives way.
FULL_CONTACT, ROLLING, ROCKING, STUCK, BEDDED = range(5)

# Kinds of event, in the log and in the counts.
(
    UPLIFT,
    IMPACT,
    RECONTACT,
    ROLLING_TO_ROCKING,
    ROCKING_TO_ROLLING,
    CRITICAL_PASSAGE,
    OVERTURNING,
    STICKING,
    SLIDING,
    STOP_MET,
    STOP_LEFT,
    TENDON_YIELDING,
    TENDON_SLACK,
    TENDON_TAUT,
    PASS,  # of the upright position, by columns that are free to tilt to any side
) = range(15)
EVENT_KINDS = 15
NO_EVENT = -1

# How a history ended; it has not while RUNNING.
RUNNING = -1
(
    AT_REST,
    SURVIVED,
    OVERTURNED_ROLLING,
    OVERTURNED_ROCKING,
    FAILED_NOT_FINITE,
    FAILED_TOO_MANY_EVENTS,
    FAILED_STEP_TOO_SMALL,
    FAILED_TOO_MANY_STEPS,
) = range(8)

# After what the accelerations of a lane must be computed anew.
(
    NOTHING_NEW,
    AFTER_PHASE_CHANGE,  # or a jump of the ground's acceleration
    AFTER_UPLIFT,
    AFTER_IMPACT,
    AFTER_RELEASE,
    AFTER_REVERSAL,  # x' = 0 under friction
) = range(6)

# What becomes of a lane.
GOES_ON, FOLLOW_CONTACT, IS_OVER, NOT_ACCEPTED = range(4)

MOST_ON_BED = 64
"""Storeys up to which exact steps follow full contact on a bed: of more they cost too much."""

BED_ROW = 2 * MOST_ON_BED + 8
"""Entries of such a state, padded."""

# Steps in full contact whose maps are kept.
WHOLE_STEP, SHORT_STEP = range(2)

SYSTEM = (
    Field("n", "", WHOLE, "storeys, and modes"),
    Field("R", "", "m", "semi-diagonal of a column"),
    Field("alpha", "", "rad", "slenderness angle of its flat part"),
    Field("beta", "", "rad", "rotation at which the arc ends; 0 for flat ends"),
    Field("theta_cr", "", "rad", "static limit: B = 0"),
    Field("theta_limit", "", "rad", "counts as overturned"),
    Field("rolling", "5", "-", "p, q, c, u0, v0 of `geometry.Phase`"),
    Field("rocking", "5", "-", "the same beyond beta"),
    Field("Io", "", "-", "I_o/(m_c R^2)"),
    Field("inertia_axial", "", "-", "I_3/(m_c R^2), about a column's own axis"),
    Field("contact_time", "", "s", "t_c, what a pass near upright is compared with"),
    Field("gamma", "", "-", "m_b/(N m_c)"),
    Field("eta", "", "-", "M_tot/m_b"),
    Field("columns_mass", "", "kg", "N m_c"),
    Field("cap_beam_mass", "", "kg", "m_b"),
    Field("floors_mass", "", "kg", "M_tot"),
    Field("gravity", "", "m/s2", "g"),
    Field("restitution", "", "-", "e"),
    Field("floors_jump", "", WHOLE, "1 if the floors jump with the cap beam at an impact"),
    Field("omega", "modes", "rad/s", "frequencies of the fixed base"),
    Field("xi", "modes", "-", "damping ratios"),
    Field("omega2", "modes", "1/s2", "w^2"),
    Field("two_xi_omega", "modes", "1/s", "2 xi w"),
    Field("Gamma", "modes", "sqrt(kg)", "participation Phi^T M 1, shapes mass-normalised"),
    Field("phi", "modes modes", "1/sqrt(kg)", "shapes: mode, floor"),
    Field("storey_shear_of", "modes modes", "N/(m sqrt(kg))", "k_i (phi_i - phi_(i-1))"),
    Field("shear_weight", "modes", "mixed", "g_r of `demands`, for storey shears"),
    Field("acceleration_weight", "modes", "mixed", "g_r for floor accelerations"),
    Field("shear_bound_of", "modes", "mixed", "of a storey: shear times this <= sqrt(sum g q^2)"),
    Field("acceleration_bound_of", "modes", "mixed", "of a floor: likewise"),
    Field("bend_ratio", "", "mixed", "largest w^4 times the latter weight over the former"),
    Field("uplifted_rate", "", "1/s", "least number of Taylor steps a second"),
    Field("contact_rate", "", "1/s", "least number of steps a second in full contact"),
    Field("last_term", "", "-", "largest last term of a series, over its first three"),
    Field("most_steps", "", "-", "more of them are a failure"),
    Field("recontact_tolerance", "", "-", "of alpha: a lower excursion is not followed"),
    Field("bounces", "", "-", "what bounces left out add to the floors' velocity, over u_b'"),
    Field("max_events", "", WHOLE, "more of them are a failure"),
    Field("initial_rotation", "", "rad", "theta at the start, released from rest"),
    Field("initial_turning", "", "rad/s", "rate of its azimuth then, for tests of free motion"),
    Field("free_vibration", "", "s", "time after the record, at most"),
    Field("until_rest", "", WHOLE, "1 if it may end earlier, with nothing new to come"),
    Field("columns", "", "-", "N"),
    Field("devices", "", WHOLE, "number of devices"),
    Field("device_kind", f"{SLOTS}", WHOLE, "VISCOUS to ROLLING_RESISTANCE"),
    Field("device_constants", f"{SLOTS} 4", "mixed", "of its law, see the kinds"),
    Field("linear_speed", "", "m/s", "up to which |u_b'|^a is followed as linear"),
    Field("compliant", "", WHOLE, "1 if full contact gives way, on a bed"),
    Field("bed_uplift", "", "rad", "phi_u, at which full contact ends"),
    Field("bed_full", "", "rad", "x_full of curved ends on a plane bed; else 0"),
    Field("bed_height", "", "-", "C_u = C(phi_u)"),
    Field("bed_k", "", "1/s2", "k of full contact, over N m_c R^2"),
    Field("bed_c", "", "1/s", "its damping, likewise"),
    Field("sink", "", "sqrt(rad)", "what a plane bed takes from the weight's arm, times w"),
    Field("root", "", "sqrt(rad)", "and from that of the lift"),
    Field("lifts", "", "-", "j = sqrt(A_u/A(phi_u+)), of theta' at uplift"),
    Field("bedded_rate", "", "1/s", "least number of Taylor steps a second in full contact"),
)

REQUEST = (
    Field("system", "", WHOLE, "number of the structure"),
    Field("record", "", WHOLE, "offset of the record among all"),
    Field("record_y", "", WHOLE, "offset of the second horizontal record, or NO_RECORD"),
    Field("npts", "", WHOLE, "its samples"),
    Field("vertical", "", WHOLE, "offset of the vertical record, or NO_RECORD"),
    Field("bed_map", "", WHOLE, "offset of what `bed_block` maps by, behind them; -1 if none"),
    Field("scale", "", "-", "factor on both"),
    Field("dt", "", "s", "sampling interval"),
)

STATE = (
    # The structure, folded as the equation of motion wants it.
    Field("diameter", "lanes", "m", "2 R", "driver"),
    Field("io_1", "lanes", "-", "Io - 1", "driver"),
    Field("one_4gamma", "lanes", "-", "1 + 4 gamma", "driver"),
    Field("four_gamma_eta", "lanes", "-", "4 gamma eta", "driver"),
    Field("weight_over_R", "lanes", "1/m", "(1 + 2 gamma + 2 gamma eta)/R", "driver"),
    Field("ground_over_R", "lanes", "1/m", "(1 + 2 gamma)/R", "driver"),
    Field("shear_factor", "lanes", "1/(kg m)", "2/(N m_c R)", "driver"),
    Field("columns_mass", "lanes", "kg", "N m_c", "driver"),
    Field("cap_beam_mass", "lanes", "kg", "m_b", "driver"),
    Field("floors_mass", "lanes", "kg", "M_tot", "driver"),
    Field("gravity", "lanes", "m/s2", "g", "driver"),
    Field("theta_cr", "lanes", "rad", "static limit", "driver"),
    Field("omega2", "modes lanes", "1/s2", "w^2", "driver"),
    Field("two_xi_omega", "modes lanes", "1/s", "2 xi w", "driver"),
    Field("Gamma", "modes lanes", "sqrt(kg)", "participation", "driver"),
    Field("shear_weight", "modes lanes", "mixed", "see `system`", "driver"),
    Field("acceleration_weight", "modes lanes", "mixed", "see `system`", "driver"),
    Field("last_term", "lanes", "-", "see `system`", "driver"),
    Field("devices", "lanes", WHOLE, "number of devices", "devices, driver"),
    Field("linear_speed", "lanes", "m/s", "see `system`", "devices"),
    Field("friction_force", "lanes", "N", "of all friction dampers", "devices"),
    Field("friction_moment", "lanes", "N m", "of all rolling resistance", "devices"),
    Field("nonsmooth_damper", "lanes", "-", "1: a force has a kink at u_b' = 0", "devices, driver"),
    # The history and its record.
    Field("scale", "lanes", "-", "factor on the record", "driver"),
    Field("history", "lanes", WHOLE, "number of the request, or NO_HISTORY", "driver"),
    Field("system", "lanes", WHOLE, "number of its structure", "driver"),
    Field("record", "lanes", WHOLE, "offset of its record", "driver"),
    Field("npts", "lanes", WHOLE, "samples of the record", "driver"),
    Field("vertical", "lanes", WHOLE, "offset of the vertical one", "driver"),
    Field("interval", "lanes", WHOLE, "present sampling interval", "driver, full_contact, lanes"),
    Field("intervals", "lanes", WHOLE, "of the history, at most", "driver"),
    Field("outcome", "lanes", WHOLE, "how it ended, or RUNNING", "driver, events, full_contact"),
    # The phase of motion and the range of the tilt in it.
    Field("phase", "lanes", WHOLE, "FULL_CONTACT to BEDDED", "devices, driver, transitions"),
    Field("phase_p", "lanes", "-", "B = p cos x + q sin x", "transitions"),
    Field("phase_q", "lanes", "-", "C = c + p sin x - q cos x", "transitions"),
    Field("phase_c", "lanes", "-", "k while rolling, 0 rocking", "transitions"),
    Field("phase_u0", "lanes", "-", "of u_b", "transitions"),
    Field("phase_v0", "lanes", "-", "of v_b", "transitions"),
    Field("side", "lanes", "-", "s = sign(theta)", "driver, transitions"),
    Field("theta_low", "lanes", "rad", "the phase ends below", "transitions"),
    Field("theta_high", "lanes", "rad", "and above", "transitions"),
    # The devices.
    Field("direction", "lanes", "-", "sign of x' for friction", "devices"),
    # The ground, linear over the interval; and time.
    Field("a_g", "lanes", "m/s2", "at the interval's start", "lanes"),
    Field("a_g_slope", "lanes", "m/s3", "over it", "lanes"),
    Field("g_up", "lanes", "m/s2", "g + a_v at the interval's start", "lanes"),
    Field("g_up_slope", "lanes", "m/s3", "over it", "lanes"),
    Field("interval_start", "lanes", "s", "since the record's start", "lanes"),
    Field("time", "lanes", "s", "since the interval's start", "events, full_contact, lanes, steps"),
    Field("step", "lanes", "s", "h, length of the step", "driver, events, steps"),
    Field("steps_left", "lanes", "-", "in the interval, this one included", "events, steps"),
    Field("dt", "lanes", "s", "sampling interval", "driver"),
    Field("sampling_rate", "lanes", "1/s", "1/dt", "driver"),
    Field("uplifted_step", "lanes", "s", "in a whole interval", "driver"),
    Field("uplifted_steps", "lanes", "-", "in a whole interval", "driver"),
    Field("contact_step", "lanes", "s", "in full contact", "driver"),
    Field("contact_steps", "lanes", "-", "in a whole interval", "driver"),
    # The motion at the start of the step.
    Field("theta", "lanes", "rad", "x = |theta|", "driver, events, samples, steps, transitions"),
    Field(
        "theta_dot", "lanes", "rad/s", "x'", "devices, driver, events, samples, steps, transitions"
    ),
    Field(
        "theta_ddot",
        "lanes",
        "rad/s2",
        "x''",
        "devices, driver, equation_of_motion, events, samples, steps",
    ),
    Field("B", "lanes", "-", "contact arm B(x)", "equation_of_motion, steps"),
    Field("C", "lanes", "-", "contact height C(x)", "equation_of_motion, steps"),
    Field("per_A", "lanes", "-", "1/A(x)", "equation_of_motion, steps"),
    Field("V", "lanes", "N", "base shear, springs and dampers", "equation_of_motion, steps"),
    Field("q", "modes lanes", "m sqrt(kg)", "of modes", "driver, events, full_contact, steps"),
    # The motion at its end.
    Field("next_theta", "lanes", "rad", "x", "equation_of_motion, steps"),
    Field("next_theta_dot", "lanes", "rad/s", "x'", "equation_of_motion, steps"),
    Field("next_theta_ddot", "lanes", "rad/s2", "x''", "equation_of_motion, steps"),
    Field("next_B", "lanes", "-", "contact arm B(x)", "equation_of_motion"),
    Field("next_C", "lanes", "-", "contact height C(x)", "equation_of_motion"),
    Field("next_per_A", "lanes", "-", "1/A(x)", "equation_of_motion"),
    Field(
        "next_V",
        "lanes",
        "N",
        "base shear",
        "devices, driver, equation_of_motion, full_contact, samples",
    ),
    Field(
        "next_a_g",
        "lanes",
        "m/s2",
        "a_g",
        "devices, driver, equation_of_motion, full_contact, samples",
    ),
    Field(
        "next_g_up",
        "lanes",
        "m/s2",
        "g + a_v",
        "devices, driver, equation_of_motion, full_contact, samples",
    ),
    Field("next_device", "lanes", "1/s2", "what devices add to A x''", "devices"),
    Field("next_push", "lanes", "N", "on the cap beam, to the right", "devices"),
    Field("next_pull", "lanes", "N", "on the cap beam, downwards", "devices"),
    Field("next_q", "modes lanes", "m sqrt(kg)", "of modes", "equation_of_motion, steps"),
    Field("next_dq", "modes lanes", "m sqrt(kg)/s", "velocities", "equation_of_motion, steps"),
    # Taylor coefficients over the step, as powers of t/h.
    Field("dtheta_terms", "terms lanes", "rad/s", "of x'", "equation_of_motion"),
    Field("B_terms", "terms lanes", "-", "of B", "equation_of_motion"),
    Field("C_terms", "terms lanes", "-", "of C", "equation_of_motion"),
    Field("A_terms", "terms lanes", "-", "of A, from order 1", "equation_of_motion"),
    Field("action_terms", "terms lanes", "1/s2", "of `horizontal_action`", "equation_of_motion"),
    Field("device_terms", "terms lanes", "1/s2", "of what devices add to A x''", "devices"),
    Field(
        "dq",
        "terms modes lanes",
        "m sqrt(kg)/s",
        "of q'; dq[0] is q' at the start",
        "driver, equation_of_motion, events, full_contact, steps, transitions",
    ),
    Field(
        "modal_force",
        "modes lanes",
        "m sqrt(kg)/s2",
        "last order's f_r",
        "demands, equation_of_motion",
    ),
    Field("beam_velocity_term", "lanes", "m/s", "last term of u_b' + ground", "equation_of_motion"),
    # What is known of the step: 1 or 0, numbers so that lanes go together.
    Field("too_long", "lanes", "-", "1: for its series", "devices, steps"),
    Field("accepted", "lanes", "-", "1: no event, not too long", "devices, driver, steps"),
    Field("peak_inside", "lanes", "-", "1: may hold the largest x", "devices, steps"),
    Field("no_event", "lanes", "-", "1: a closer look found none", "driver, events, steps"),
    Field("demands_rise", "lanes", "-", "1: a floor's may be raised", "demands"),
    Field("contacts_rise", "lanes", "-", "1: forces of the columns may be, within", "demands"),
    Field("needs_attention", "lanes", "-", "1: must be looked at alone", "steps"),
    Field("restart_after", "lanes", WHOLE, "AFTER_...", "devices, driver, events, transitions"),
    # Maxima so far; times that never came are negative.
    Field("max_theta", "lanes", "rad", "largest x", "demands, driver, events"),
    Field("max_theta_time", "lanes", "s", "when", "demands, driver, events"),
    Field("critical_time", "lanes", "s", "when theta_cr was first passed", "driver, events"),
    Field("friction_top", "lanes", "-", "largest |F|/N, top", "demands, driver"),
    Field("friction_bottom", "lanes", "-", "at the lower ends", "demands, driver"),
    Field("normal_top", "lanes", "-", "least N/weight, upper end", "demands, driver"),
    Field("normal_bottom", "lanes", "-", "lower ends", "demands, driver"),
    Field("heavy_top", "lanes", "-", "largest N over it", "demands, driver"),
    Field("heavy_bottom", "lanes", "-", "lower ends", "demands, driver"),
    Field("shear_top", "lanes", "N", "largest |F|", "demands, driver"),
    Field("shear_bottom", "lanes", "N", "lower ends", "demands, driver"),
    Field("light", "lanes", "N", "N of the lower ends, at the start", "demands, steps"),
    Field("next_light", "lanes", "N", "at the end of the step", "demands"),
    Field("drag", "lanes", "N", "|F| of the lower ends, at the start", "demands, steps"),
    Field("next_drag", "lanes", "N", "at the end of the step", "demands"),
    Field("storey_shear", "lanes modes", "N", "largest |k_i d_i|", "demands, driver"),
    Field("floor_acceleration", "lanes modes", "m/s2", "largest absolute one", "demands, driver"),
    Field("shear_bound", "lanes", "mixed", "sum g (q - seen_q)^2 at the end", "demands"),
    Field("shear_before", "lanes", "mixed", "at its start", "demands, steps"),
    Field("shear_bend", "lanes", "mixed", "sum g of what q' loses over it, squared", "demands"),
    Field("shear_below_all_maxima", "lanes", "mixed", "no shear rises to this", "demands, driver"),
    Field("shear_room", "lanes", "mixed", "no shear rises with a sum to this", "demands, driver"),
    Field("acceleration_bound", "lanes", "mixed", "the sum over modal forces", "demands"),
    Field("acceleration_room", "lanes", "mixed", "likewise", "demands, driver"),
    Field("acceleration_before", "lanes", "mixed", "at its start", "demands, steps"),
    Field("looked_at", "6 floors", "mixed", "shears, accelerations; modes", "samples"),
    Field("last_shear", "lanes modes", "N", "|k_i d_i| when last looked at", "driver"),
    Field("last_acceleration", "lanes modes", "m/s2", "likewise", "driver"),
    Field("seen_q", "modes lanes", "m sqrt(kg)", "the modes then", "demands, driver"),
    Field("seen_force", "modes lanes", "m sqrt(kg)/s2", "their forces", "demands, driver"),
    Field("bend_ratio", "lanes", "mixed", "see `system`", "driver"),
    Field("acceleration_below_all_maxima", "lanes", "mixed", "likewise", "demands, driver"),
    # Energy and counts.
    Field("energy_input", "lanes", "J", "of the ground, audited", "driver, energy, full_contact"),
    Field("energy_damped", "lanes", "J", "in building, if audited", "driver, energy, full_contact"),
    Field("energy_lost", "lanes", "J", "at impacts and re-contacts", "driver, transitions"),
    Field("energy_created", "lanes", "J", "at impacts that create it", "driver, transitions"),
    Field("steps", "lanes", "-", "taken", "driver, steps"),
    Field("stalled", "lanes", WHOLE, "events in a row at one instant", "driver, events"),
    Field("creating_impacts", "lanes", WHOLE, "impacts that created energy", "driver, transitions"),
    Field("events", f"lanes {EVENT_KINDS}", WHOLE, "of each kind", "driver, lanes"),
    Field("n", "", WHOLE, "storeys, and modes: the same in all lanes", "run"),
    Field("lanes", "", WHOLE, "lanes in use: 1 or all", "run"),
    Field("audited", "", WHOLE, "1 where energy flows are integrated", "driver"),
    Field("stop", "", WHOLE, "1: histories are to be left where they are", "driver"),
    Field("waiting", "", WHOLE, "number of the next request", "driver"),
)

EQUIPPED_STATE = (
    *STATE,
    Field("columns", "lanes", "-", "N", "devices"),
    Field("device_kind", f"{SLOTS} lanes", WHOLE, "see `system`", "devices"),
    Field("law", f"{SLOTS} 4 lanes", "mixed", "`device_constants` of `system`", "devices"),
    Field("tendons", "lanes", WHOLE, "number of tendons in a column", "devices"),
    Field("half_width", "lanes", "m", "B of the flat part", "devices"),
    Field("arc_radius", "lanes", "m", "r; 0 for flat ends", "devices"),
    Field("arc_end", "lanes", "rad", "beta", "devices"),
    Field("device_branch", f"{SLOTS} lanes", WHOLE, "IDLE, WORKING or BEYOND", "devices"),
    Field("permanent", f"{SLOTS} lanes", "m", "plastic elongation of a tendon", "devices"),
    Field("path", "lanes", "m", "|u_b| at the start of the step", "devices"),
    Field("tension", "lanes", "N", "of all tendons at the start of the step", "devices"),
    Field("tendon_stiffness", "lanes", "N/m", "of those that are elastic", "devices"),
    Field("advance_terms", "terms lanes", "m/s", "of |u_b|', 2 R C x'", "devices"),
    Field("resistance_terms", "terms lanes", "N", "of -s P", "devices"),
    Field("power_terms", f"{SLOTS} terms lanes", "mixed", "of |u_b'|^a", "devices"),
    Field("lever_terms", "terms terms lanes", "m", "of de/dx and its derivatives", "devices"),
    Field("elongation_terms", "9 lanes", "m", "of a tendon's elongation e", "devices"),
    Field("event_terms", "9 lanes", "mixed", "of what must not fall below zero", "devices"),
    Field("local", "4 9", "mixed", "scratch: powers of x - x_0", "devices"),
    Field("device_force", f"{SLOTS} lanes", "N", "largest |force|", "devices"),
    Field("device_velocity", f"{SLOTS} lanes", "m/s", "largest |rate|", "devices"),
    Field("device_energy", f"{SLOTS} lanes", "J", "dissipated", "devices"),
)

# Where ends give way `bed`, `bed_block` and `bed_events` write fields of the motion above as well.
COMPLIANT_STATE = (
    *EQUIPPED_STATE,
    Field("compliant", "lanes", "-", "1 if the structure stands on a bed", "bed, bed_events"),
    Field("bed_uplift", "lanes", "rad", "phi_u", "bed, bed_events"),
    Field("bed_k", "lanes", "1/s2", "k in full contact, else 0", "bed, bed_events"),
    Field("bed_c", "lanes", "1/s", "damping there, else 0", "bed, bed_events"),
    Field("sink", "lanes", "sqrt(rad)", "while a plane end lifts, else 0", "bed, bed_events"),
    Field("root", "lanes", "sqrt(rad)", "likewise", "bed, bed_events"),
    Field("fade", "lanes", "1/rad", "1/(x_full - phi_u) of curved ends, else 0", "bed, bed_events"),
    Field("pace", "lanes", "s", "longest next step", "bed, bed_events"),
    Field("bed_map", "lanes", WHOLE, "see `request`", "bed"),
    Field("bed_energy", "lanes", "J", "dissipated in the bed", "bed, bed_events"),
    Field("bedded_time", "lanes", "s", "in full contact", "bed, bed_events"),
    Field("impact_number", "lanes", "-", "largest chi", "bed, bed_events"),
    Field("tilt_terms", "terms lanes", "rad", "of x", "bed, bed_events"),
    Field("y_terms", "terms lanes", "1/sqrt(rad)", "of x^(-1/2)", "bed, bed_events"),
    Field("shape_terms", "terms lanes", "-", "of 1 - fade (x - phi_u)", "bed, bed_events"),
    Field("square_terms", "terms lanes", "-", "of its square", "bed, bed_events"),
    Field("fourth_terms", "terms lanes", "-", "of its fourth power", "bed, bed_events"),
    Field("patch_terms", "terms lanes", "1/sqrt(rad)", "of w", "bed, bed_events"),
    Field("lift_terms", "terms lanes", "-", "of B_v", "bed, bed_events"),
    Field("fading", "", WHOLE, "1 if w has a second factor in any lane", "driver"),
)

STATES = {"plain": STATE, "devices": EQUIPPED_STATE, "compliant": COMPLIANT_STATE}
"""By the variant of the kernel that is compiled for it."""

BLOCK = (
    Field("n", "", WHOLE, "modes", "run"),
    # The modes, now and over a step: q1 = a q + b q' + c p + d p', q1' = e q + f q' + g p + i p'.
    Field("q", "modes", "m sqrt(kg)", "displacements", "full_contact"),
    Field("dq", "modes", "m sqrt(kg)/s", "velocities", "full_contact"),
    Field("step_maps", "2 modes 8", "mixed", "of a WHOLE_STEP, a SHORT_STEP", "full_contact"),
    Field("work", "2 modes 9", "mixed", "of v^2 and v t over them", "full_contact"),
    Field("qs", "modes instants", "m sqrt(kg)", "displacements", "full_contact"),
    Field("dqs", "modes instants", "m sqrt(kg)/s", "velocities", "full_contact"),
    Field("forces", "modes instants", "m sqrt(kg)/s2", "w^2 q + 2 xi w q'", "full_contact"),
    Field("rises", "modes instants", "m sqrt(kg)/s3", "their rates", "full_contact"),
    # The ground and the building. A step looks at the next instant as well, the last one ahead of
    # the block.
    Field("a_g", "instants", "m/s2", "ground acceleration", "full_contact, lanes"),
    Field("a_g_slope", "instants", "m/s3", "over the step that begins", "full_contact, lanes"),
    Field("g_up", "instants", "m/s2", "g + a_v", "full_contact, lanes"),
    Field("g_up_slope", "instants", "m/s3", "over the step that begins", "full_contact, lanes"),
    Field("V", "ahead", "N", "base shear", "full_contact"),
    Field("dV", "ahead", "N/s", "V'", "full_contact"),
    Field("ddV", "ahead", "N/s2", "V'' but for the ground's slope", "full_contact"),
    Field("alarm", "instants", "-", "1: uplift is near", "full_contact"),
    Field("input", "instants", "J", "over the step that begins", "full_contact"),
    Field("damped", "instants", "J", "over the step that begins", "full_contact"),
    Field("shear_bound", "instants", "mixed", "sum g q^2", "full_contact"),
    Field("acceleration_bound", "instants", "mixed", "sum g force^2", "full_contact"),
    Field("shear_bend", "instants", "mixed", "sum g q''^2", "full_contact"),
    Field("row", "ahead", "mixed", "shear of a storey, or acceleration of a floor", "full_contact"),
    Field("row_slope", "ahead", "mixed", "its rate", "full_contact"),
    Field("largest", "instants", "mixed", "the largest in each step", "full_contact"),
    Field("push", "ahead", "N", "of devices on the cap beam", "devices, full_contact"),
    Field("push_within", "instants", "N", "half a step later", "devices, full_contact"),
    Field("piece", "8", "mixed", "scratch of the search for roots", "quintic"),
)

# Rows of their own: among those above they would move what rigid ends need to other cache lines.
COMPLIANT_BLOCK = (
    *BLOCK,
    # On a bed: the tilt, and what the cap beam adds to the ground's motion.
    Field(
        "bed_maps", f"5 {BED_ROW} {BED_ROW}", "mixed", "what a step makes of them", "full_contact"
    ),
    Field("standing", f"33 {BED_ROW}", "mixed", "states at instants, and one more", "bed_block"),
    Field("tilt", "ahead", "rad", "theta", "bed_block"),
    Field("tilt_rate", "ahead", "rad/s", "theta'", "bed_block"),
    Field("tilt_bend", "ahead", "rad/s2", "theta''", "bed_block"),
    Field("ground", "instants", "m/s2", "ground acceleration", "bed_block"),
    Field("across", "ahead", "m/s2", "u_b''; 0 at rest", "bed_block"),
    Field("across_rate", "ahead", "m/s3", "its rate", "bed_block"),
)

BLOCKS = {"plain": BLOCK, "devices": BLOCK, "compliant": COMPLIANT_BLOCK}
"""Likewise."""

RESULT = (
    Field("outcome", "", WHOLE, "how the history ended"),
    Field("phase", "", WHOLE, "phase of motion at its end"),
    Field("intervals", "", WHOLE, "sampling intervals that it lasted"),
    Field("steps", "", WHOLE, "Taylor steps taken"),
    Field("creating_impacts", "", WHOLE, "impacts that created energy"),
    Field("events", f"{EVENT_KINDS}", WHOLE, "of each kind"),
    Field("time", "", "s", "of its end"),
    Field("rotation", "", "rad", "theta at its end"),
    Field("max_theta", "", "rad", "largest |theta|"),
    Field("max_theta_time", "", "s", "when"),
    Field("critical_time", "", "s", "first passage of theta_cr; negative if never"),
    Field("friction_top", "", "-", "largest |F|/N at the upper ends"),
    Field("friction_bottom", "", "-", "at the lower ends"),
    Field("normal_top", "", "-", "least N over the weight on it, upper ends"),
    Field("normal_bottom", "", "-", "lower ends"),
    Field("heavy_top", "", "-", "largest N over it"),
    Field("heavy_bottom", "", "-", "lower ends"),
    Field("shear_top", "", "N", "largest |F| of all columns"),
    Field("shear_bottom", "", "N", "lower ends"),
    Field("energy_input", "", "J", "by the ground, if audited"),
    Field("energy_damped", "", "J", "in the building, if audited"),
    Field("energy_lost", "", "J", "at impacts and re-contacts, net"),
    Field("energy_created", "", "J", "at impacts that create it"),
    Field("energy_stored", "", "J", "at the end"),
    Field("storey_shear", "modes", "N", "largest |k_i d_i|"),
    Field("floor_acceleration", "modes", "m/s2", "largest absolute one"),
    Field("device_force", f"{SLOTS}", "N", "largest |force|"),
    Field("device_velocity", f"{SLOTS}", "m/s", "largest |rate|"),
    Field("device_energy", f"{SLOTS}", "J", "dissipated"),
    Field("device_stored", f"{SLOTS}", "J", "at the end, over the start"),
    Field("permanent", f"{SLOTS}", "m", "plastic elongation of a tendon"),
    Field("bed_energy", "", "J", "dissipated in the bed, if audited"),
    Field("bedded_time", "", "s", "in full contact with a bed"),
    Field("impact_number", "", "-", "largest chi"),
)

SAMPLE = (
    Field("theta", "", "rad", "tilt of the storey, positive to the right", "samples"),
    Field("theta_dot", "", "rad/s", "theta'", "samples"),
    Field("theta_ddot", "", "rad/s2", "theta''; 0 in full contact", "samples"),
    Field("phase", "", WHOLE, "FULL_CONTACT to BEDDED", "samples"),
    Field("energy_input", "", "J", "by the ground so far", "samples"),
    Field("energy_damped", "", "J", "in the building so far", "samples"),
    Field("energy_lost", "", "J", "at impacts and re-contacts so far, net", "samples"),
    Field("bed_energy", "", "J", "dissipated in the bed so far", "bed"),
)
"""The floors' displacements and velocities stand in an array of their own, as long as they are."""

EVENT = (
    Field("time", "", "s", "since the record's start", "lanes"),
    Field("kind", "", WHOLE, "UPLIFT to TENDON_TAUT", "lanes"),
    Field("theta", "", "rad", "tilt of the storey", "lanes"),
    Field("theta_dot_before", "", "rad/s", "theta' just before", "lanes"),
    Field("theta_dot_after", "", "rad/s", "theta' just after", "lanes"),
    Field("energy_lost", "", "J", "in the event; negative where it was created", "lanes"),
)
