"""What the kernel reads and writes: structured records, every field named once, here.

* ``system``: a structure and how it is followed; filled by `rpscli.analyses`, read
  only; where both components act two stand together, of the directions x and y, which
  differ in their buildings;
* ``request``: a history to run, a system under a record; likewise;
* ``state``: all lanes side by side, last; ``q`` has one row a mode,
  ``tilt`` one a direction;
* ``result``: what a history leaves behind.

Letters are those of Theory: x the tilt, s its side, B and C the arms of contact over R.
Lanes come last, so that a loop over them is one vector instruction; what such loops test
is a number, 1 or 0. Sizes are part of a record's type: `ways`, the horizontal directions
in which the ground moves, and the lanes are so known when the kernel is compiled, which
is one source for all of them.
"""

from __future__ import annotations

from functools import cache
from threading import local
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import MOST_STOREYS
from rpscli.physics.tableau import END

Floats = NDArray[np.float64]
Record: TypeAlias = Any
"""One entry of an array of records: its fields are attributes, in
Python as in machine code."""

LANES = 32
"""Histories that one core follows at once. Loops over fewer are unrolled by the
compiler before it looks for vector instructions; more do not fit into the
processor's first cache."""

STATES = 5
"""States of many histories: for those that move, those that
stand, and those that wait."""

PADDING = 8
"""Rows that no mode uses, and entries that no lane uses. Without them the
rows of one lane would all fall into a few lines of the processor's cache,
and drive each other out."""

NO_HISTORY = -1
"""`history` of a lane that has nothing left to do."""

NO_RECORD = -1
"""Offset of a record that a history does not have."""

SLOTS = 8
"""Devices that a structure may have."""

# Kinds of device.
VISCOUS, FRICTION, STOP, TENDON, ROLLING_RESISTANCE, OWN = range(6)

# Where the constants of their laws stand in `device_constants`.
DAMPER_COEFFICIENT, DAMPER_EXPONENT = range(2)  # c, a
FRICTION_FORCE = 0  # F_d
STOP_GAP, STOP_STIFFNESS, STOP_DAMPING = range(3)  # d, k_s, c_s
TENDON_PRESTRESS, TENDON_STIFFNESS, TENDON_YIELD = range(3)  # P_0, k_t, P_y of one column
ROLLING_MOMENT = 0  # 2 W f

# Branches of a device's law: of a stop with its gap open, pushing back, let go before its
# gap; of a tendon slack, elastic, yielding; of an own law what it watches above zero or
# below. The others have one.
IDLE, WORKING, BEYOND = range(3)

# Phases of motion; STUCK is held by friction while tilted, BEDDED in full contact that
# gives way.
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
    FAILED_RESTITUTION,
) = range(9)

# Where a step is to end: the tilt leaves its range, passes nearest to upright; a storey
# at rest is no longer held; a device changes its law; a storey begins to yield, or ends.
NOTHING, LOW, HIGH, NEAREST, LET_GO, CHANGE, YIELD = range(7)

WHOLE = "integer"
"""Unit of what is counted: such fields are integers."""


class Field(NamedTuple):
    """A field of a record: a number, or an array of the named sizes."""

    name: str
    sizes: str  # of its axes, by name or as a number; none of a number
    unit: str  # SI; ``-`` for plain numbers, ``mixed`` where entries or cases differ
    meaning: str  # symbol or formula, and words


def _fields(sizes: str, unit: str, **meanings: str) -> tuple[Field, ...]:
    """Fields of the same sizes and unit."""
    return tuple(Field(name, sizes, unit, text) for name, text in meanings.items())


SYSTEM = (
    Field("n", "", WHOLE, "storeys, and modes"),
    *_fields("", "m", R="semi-diagonal of a column"),
    *_fields(
        "",
        "rad",
        alpha="slenderness angle of its flat part",
        beta="rotation at which the arc ends; 0 for flat ends",
        theta_cr="static limit: B = 0",
        theta_limit="counts as overturned",
        initial_rotation="theta at the start, released from rest",
    ),
    Field(
        "initial_turning",
        "",
        "rad/s",
        "rate of its azimuth then, for tests of free motion",
    ),
    Field("rolling", "5", "-", "p, q, c, u0, v0 of `geometry.Phase`"),
    Field("rocking", "5", "-", "the same beyond beta"),
    *_fields(
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
    *_fields("", "kg", columns_mass="N m_c", cap_beam_mass="m_b", floors_mass="M_tot"),
    Field("gravity", "", "m/s2", "g"),
    *_fields(
        "",
        "s",
        contact_time="t_c, what a pass near upright is compared with",
        shock_time="tau: beam and columns are turned over within it as by an impact",
        free_vibration="time after the record, at most",
    ),
    *_fields(
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
    *_fields(
        "", "-", hardening="h, stiffness of a storey that yields over the elastic one"
    ),
    *_fields("modes", "N", strength="F of a storey, or infinite"),
    *_fields("modes", "N/m", stiffness="k of a storey"),
    *_fields("modes", "kg", mass="of a floor"),
    *_fields("modes", "rad/s", omega="frequencies of the fixed base"),
    *_fields("modes", "1/s2", omega2="w^2"),
    *_fields("modes", "1/s", two_xi_omega="2 xi w"),
    *_fields(
        "modes", "sqrt(kg)", Gamma="participation Phi^T M 1, shapes mass-normalised"
    ),
    *_fields(
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
    *_fields(
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
    *_fields(
        "",
        "rad",
        bed_uplift="phi_u, at which full contact ends",
        bed_full="x_full of curved ends on a plane bed; else 0",
    ),
    Field("bed_k", "", "1/s2", "k of full contact, over N m_c R^2"),
    *_fields(
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

KEPT = (
    Field("max_theta", "", "rad", "largest |theta|"),
    Field("max_theta_time", "", "s", "when"),
    Field("max_azimuth", "", "rad", "of the largest tilt"),
    Field("critical_time", "", "s", "first passage of theta_cr; negative if never"),
    Field("critical_azimuth", "", "rad", "of that passage"),
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
    Field("energy_upwards", "", "J", "in its dampers upwards, if audited"),
    Field("energy_yielded", "", "J", "by storeys that yield"),
    Field("energy_lost", "", "J", "at impacts, passes and re-contacts, net"),
    Field("energy_created", "", "J", "at impacts that create it"),
    Field("energy_passes", "", "J", "lost in passes, part of energy_lost"),
    Field("bed_energy", "", "J", "dissipated in the bed, if audited"),
    Field(
        "closest_pass",
        "",
        "-",
        "least theta_min/alpha of a pass; infinite without passes",
    ),
    Field(
        "shortest_pass",
        "",
        "s",
        "least theta_min/|theta phi'| of a pass; over t_c it is s",
    ),
    Field("torsion_lever", "", "m", "largest torsion in a contact over the weight on it"),
    Field("bedded_time", "", "s", "in full contact with a bed"),
    Field("impact_number", "", "-", "largest chi"),
    Field(
        "passes_as_impacts",
        "",
        WHOLE,
        "passes that lost more than half of an impact's share",
    ),
    Field("creating_impacts", "", WHOLE, "impacts that created energy"),
    Field("accumulations", "", WHOLE, "of passes upright, begun anew as uplifts"),
)
"""What a lane keeps of its history as it goes, and leaves behind
at its end: all is `kept`."""

STATE = (
    # The structure, folded as the laws want it.
    *_fields(
        "lanes",
        "m",
        diameter="2 R",
        half_width="B of the flat part",
        arc_radius="r, or 0",
    ),
    *_fields(
        "lanes",
        "-",
        io_1="Io - 1",
        i_3="I_3/(m_c R^2)",
        one="1 + 4 gamma",
        four="4 gamma eta",
        sin_a="sin(alpha)",
        tan_a="tan(alpha)",
        spin="k while rolling: columns spin by (13.1)",
        sin_beta="sine of beta",
        excess_beta="beta - sin(beta)",
        kappa="sqrt(K(0)/A(0)) of passes near upright",
        step_error="see `system`",
    ),
    *_fields(
        "lanes", "1/m", weigh="(1 + 2 gamma + 2 gamma eta)/R", load="(1 + 2 gamma)/R"
    ),
    *_fields("lanes", "1/(kg m)", share="2/(N m_c R)"),
    *_fields(
        "lanes", "kg", columns_mass="N m_c", cap_beam_mass="m_b", floors_mass="M_tot"
    ),
    *_fields(
        "lanes", "kg", riding="of floors that are lifted with the cap beam: all, or none"
    ),
    *_fields(
        "lanes",
        "1/kg",
        spared="g + a_v less at contacts, a newton of floors on springs, else 0",
    ),
    *_fields("lanes", "m/s2", gravity="g"),
    *_fields("lanes", "rad", beta="end of the arc", theta_cr="static limit"),
    *_fields("lanes", "s", contact_time="t_c", shock_time="see `system`"),
    *_fields("rows lanes", "1/s2", omega2="w^2"),
    *_fields("rows lanes", "1/s", two_xi_omega="2 xi w"),
    *_fields("rows lanes", "sqrt(kg)", Gamma="participation"),
    *_fields(
        "rows lanes", "mixed", shear_weight="see `system`", acceleration_weight="likewise"
    ),
    # Storeys that may yield, see `storeys`.
    *_fields("lanes", WHOLE, yields="1 if they may", marked="storeys that yield now"),
    *_fields("lanes", "-", hardening="h"),
    *_fields("rows lanes", "N", strength="F"),
    *_fields("rows lanes", "N/m", stiffness="k"),
    Field("mark", "rows lanes", WHOLE, "side to which a storey yields, else 0"),
    *_fields("rows lanes", "m", middle="c of the elastic range", middle_most="largest"),
    *_fields("rows lanes", "m", middle_least="least"),
    *_fields("rows lanes", "N", drift_most="largest k |d| of a storey that yields"),
    *_fields("rows lanes", "J", yielded="F times the path of its plastic drift"),
    *_fields("rows lanes", "s", first_yield="when, or -1"),
    *_fields(
        "rows lanes", "m sqrt(kg)/s2", freed="sum g_ri delta_i, load of plastic drifts"
    ),
    *_fields("rows lanes", "m sqrt(kg)/s2", new_freed="at a stage"),
    *_fields(
        "rows lanes",
        "N/(m sqrt(kg))",
        slipping="(1 - h) g_r1 while storey 1 yields, else 0",
    ),
    # The history and its records.
    *_fields(
        "lanes",
        WHOLE,
        history="number of the request, or NO_HISTORY",
        system="number of its first structure",
        npts="samples of the record",
        vertical="offset of the vertical one",
        interval="present sampling interval",
        intervals="of the history, at most",
        outcome="how it ended, or RUNNING",
        phase="FULL_CONTACT to BEDDED",
        kind="of the event that ends the step",
        wanted="of that which it is to end on",
        which="what of it: device, side",
        tries="to end there",
        stalled="events in a row at one instant",
        directionless="passes in a row that no program resolves",
    ),
    Field("record", "ways lanes", WHOLE, "offsets of its records"),
    Field("events", f"{EVENT_KINDS} lanes", WHOLE, "of each kind"),
    *_fields("lanes", "-", scale="factor on the records", steps="taken"),
    # The phase of motion and the range of the tilt in it.
    *_fields(
        "lanes",
        "-",
        p="B = p cos x + q sin x",
        q0="C = c + p sin x - q0 cos x",
        c="k while rolling, 0 rocking",
        u0="of u_b",
        v0="of v_b",
        side="s: of one direction",
        moves="1: the tilt is free",
        rolls="1: on the arcs",
        cone=(
            "1: columns that may tilt to any side pass upright as a cone's tip, 0:"
            " smoothly"
        ),
        turned="keeps K continuous at phi_u of a bed, times x^2",
        direction="sign of x' for friction",
    ),
    *_fields(
        "lanes", "rad", x_low="the phase ends below", x_high="and above", bed_u="phi_u"
    ),
    *_fields(
        "lanes",
        "1/s2",
        bed_k="k in full contact, else 0",
        bed_back="k phi_u/C_u, see `bed`",
    ),
    *_fields("lanes", "1/s", bed_c="damping there, else 0"),
    Field(
        "rim", "lanes", "rad/s", "bed_c phi_u beyond it, against what goes round, else 0"
    ),
    *_fields(
        "lanes", "sqrt(rad)", sink="while a plane end lifts, else 0", root="likewise"
    ),
    *_fields("lanes", "1/rad", fade="1/(x_full - phi_u) of curved ends, else 0"),
    *_fields("lanes", "1/sqrt(rad)", w="w of (12.6)"),
    *_fields("lanes", "1/(rad sqrt(rad))", dw="its slope"),
    # At rest: what multiplies g + a_v in the limits of R |z| to either side, and what
    # adds to it.
    *_fields(
        "lanes",
        "-",
        limit_right="tan(alpha) (1 + 2 gamma + 2 gamma eta)",
        limit_left="too",
    ),
    *_fields("lanes", "m/s2", held_right="of devices and beds", held_left="likewise"),
    *_fields(
        "lanes",
        "m/s2",
        held_x="what friction holds a tilt to any side about",
        held_y="in y",
    ),
    # The ground, linear over the interval; and time.
    Field("a_g", "ways lanes", "m/s2", "at the interval's start"),
    Field("a_g_slope", "ways lanes", "m/s3", "over it"),
    *_fields("lanes", "m/s2", g_up="g + a_v at the interval's start"),
    *_fields("lanes", "m/s3", g_up_slope="over it"),
    *_fields(
        "lanes",
        "s",
        time="since the interval's start",
        h="length of the step",
        h_most="longest of this phase",
        h_limit="longest next one",
        h_now="after which the end of a step is looked for",
        dt="sampling interval",
    ),
    *_fields("lanes", "1/s", rate="1/dt"),
    # The motion at the start of the step and at its end.
    *_fields(
        "ways lanes", "rad", tilt="(a, b) = x (cos phi, sin phi)", new_tilt="at the end"
    ),
    *_fields("ways lanes", "rad/s", tilt_rate="its rate", new_tilt_rate="at the end"),
    *_fields("ways lanes", "rad/s2", bend="its acceleration", new_bend="at the end"),
    Field("bends", "stages ways lanes", "rad/s2", "at all stages"),
    *_fields(
        "axes lanes", "m/s2", shaking="a_g + u_b'', upwards a_v + v_b''", new_shaking="so"
    ),
    *_fields("axes lanes", "N", V="base shear, springs and dampers", new_V="at the end"),
    *_fields("lanes", "N", taken="sum of k_1 abs(delta_1) of the ways, out of V"),
    *_fields("axes lanes", "N/s", dV="its rate", new_dV="at the end"),
    *_fields("axes lanes", "N/s2", ddV="while it stands", new_ddV="at the end"),
    *_fields("lanes", "rad", x="tilt, along its side in one plane", new_x="at the end"),
    *_fields("lanes", "rad/s", v="x'", new_v="at the end"),
    *_fields("lanes", "rad/s2", a="x''", new_a="at the end"),
    *_fields("lanes", "m/s2", lift="v_b''", new_lift="at the end"),
    *_fields("rows lanes", "m sqrt(kg)", q="of modes", new_q="at the end"),
    *_fields("rows lanes", "m sqrt(kg)/s", dq="velocities", new_dq="at the end"),
    *_fields("rows lanes", "m sqrt(kg)/s2", force="f_r of the last stage"),
    Field("ddq", "stages rows lanes", "m sqrt(kg)/s2", "accelerations at all stages"),
    # What is known of the step.
    *_fields(
        "lanes",
        "-",
        error="of the step over what it may be",
        accepted="1: no event, not too long",
        due="1: must be looked at alone; .5: has come to a sample",
        tilt_rises="1: the largest tilt is raised, 2: perhaps within the step",
        devices_rise="1: what devices see may be raised",
        demands_rise="1: a floor's may be raised",
        contacts_rise="1: forces of the columns may be, within",
        contacts_near="1: at its start they were near the largest",
    ),
    # Devices: what they do at a stage, of the beam's force in z, of moments along the
    # tilt.
    *_fields(
        "lanes", WHOLE, devices="number of devices", tendons="of tendons in a column"
    ),
    Field("device_kind", f"{SLOTS} lanes", WHOLE, "see `system`"),
    Field("law", f"{SLOTS} 4 lanes", "mixed", "`device_constants` of `system`"),
    Field("own_law", f"{SLOTS} 2 lanes", WHOLE, "addresses, see `system`"),
    Field("branch", f"{SLOTS} lanes", WHOLE, "IDLE, WORKING or BEYOND"),
    Field("permanent", f"{SLOTS} lanes", "m", "plastic elongation of a tendon"),
    *_fields("lanes", "-", columns="N", kinks="1: a force has a kink at u_b' = 0"),
    *_fields(
        "lanes",
        "m/s",
        linear_speed="see `system`",
        stop_speed="|u_b'| at which friction stops a tilt to any side",
        start_speed="see `system`",
    ),
    *_fields(
        "lanes",
        "rad/s",
        least_error="what a step may err by, where friction turns the tilt",
    ),
    *_fields(
        "lanes",
        "N",
        friction_force="of all friction dampers",
        tied="by tendons, along it",
    ),
    *_fields("lanes", "N", pull="on the cap beam, downwards"),
    *_fields("lanes", "N m", friction_moment="of all rolling resistance"),
    *_fields("ways lanes", "N", drive="of dampers and stops on the cap beam"),
    *_fields(
        "lanes",
        "1/s2",
        turning="of tendons and rolling resistance along the tilt, over N m_c R^2",
        turning_across="of rolling resistance across it",
    ),
    # Sums of linear dampers, and of what has branches or powers; means over the step.
    *_fields(
        "lanes", "N s/m", viscous="linear dampers", drag_branched="others, over |u_b'|"
    ),
    *_fields("lanes", "N", stop_force="of stops that are met"),
    *_fields("lanes", "N m", tendon_moment="of tendons, along the tilt"),
    *_fields("lanes", "-", branched="1: a device has branches or powers"),
    *_fields(
        "lanes", "m/s", speed="|u_b'| at the start of the step", new_speed="at the end"
    ),
    *_fields(
        "lanes", "m2/s3", square_rate="rate of its square", new_square_rate="at the end"
    ),
    *_fields("lanes", "m/s2", quicker="|u_b''|", new_quicker="at the end"),
    *_fields(
        "lanes", "-", new_height="C at the end of the step", least_height="least so far"
    ),
    *_fields("lanes", "m2/s2", mean_square="of |u_b'|"),
    *_fields("lanes", "m/s", mean_pace="of u_b' against which friction acts"),
    *_fields(
        "lanes", "rad/s", mean_swing="of the rate against which rolling resistance acts"
    ),
    Field("apart", f"{SLOTS} lanes", "-", "1: a device is looked at by itself"),
    Field(
        "square_constant",
        f"{SLOTS} lanes",
        "N s/m",
        "of a linear damper: power over u_b'^2",
    ),
    Field("pace_constant", f"{SLOTS} lanes", "N", "of a friction damper"),
    Field("swing_constant", f"{SLOTS} lanes", "N m", "of rolling resistance"),
    Field("device_work", f"{SLOTS} lanes", "W", "mean power in the step, of those"),
    Field("device_energy", f"{SLOTS} lanes", "J", "dissipated"),
    Field("device_force", f"{SLOTS} lanes", "N", "largest |force|"),
    Field("device_velocity", f"{SLOTS} lanes", "m/s", "largest |rate|"),
    # What has come of it so far, and largest demands.
    *(field._replace(sizes="lanes") for field in KEPT),
    Field(
        "largest",
        "demands lanes modes",
        "mixed",
        "shears, then accelerations, see `floors`",
    ),
    Field("last", "demands lanes modes", "mixed", "when last looked at"),
    Field("room", "demands lanes", "mixed", "no demand rises with a sum to this"),
    Field(
        "seen_modes",
        "6 modes",
        "mixed",
        "scratch: q and q' in x, perhaps in y, and upwards",
    ),
    Field(
        "seen", "4 modes", "mixed", "scratch: shears and accelerations in x, perhaps in y"
    ),
    Field(
        "between",
        "12 modes",
        "mixed",
        "scratch: three shears, three accelerations of each",
    ),
    Field("elastic", "2 modes", "N", "scratch: drifts times k in x, perhaps in y"),
    Field("freeing", "2 modes", "mixed", "scratch: what plastic drifts are taken out of"),
    *_fields("rows lanes", "m sqrt(kg)", seen_q="modes when floors were last looked at"),
    *_fields("rows lanes", "m sqrt(kg)/s2", seen_force="their forces"),
    *_fields("ways lanes", "mixed", shear_sum="sum g (q - seen_q)^2 at the end"),
    *_fields(
        "ways lanes", "mixed", shear_before="at its start", bent="sum g (q' - new_q')^2"
    ),
    *_fields(
        "ways lanes",
        "mixed",
        acceleration_sum="over modal forces",
        acceleration_before="so",
    ),
    *_fields("lanes", "mixed", bend_ratio="see `system`"),
    Field("max_beam", "ways lanes", "m", "largest |u_b| in either direction"),
    *_fields(
        "lanes", "W", power_input="mean of the step", power_damped="so", power_bed="so"
    ),
    *_fields("lanes", "W", power_upwards="of the dampers between floors upwards, so"),
    Field("factors", "6 rows lanes", "mixed", "of the exact step, see `standing`"),
    *_fields("lanes", "s", factors_h="step that they are of"),
    Field(
        "within",
        "16 rows",
        "mixed",
        "factors of velocities within the step of the only lane",
    ),
    *_fields("lanes", "s", within_h="step that they are of"),
    Field("piece", "8", "mixed", "scratch of the search for roots"),
    Field("n", "", WHOLE, "storeys, and modes in each direction: the same in all lanes"),
    Field("axes", "", WHOLE, "directions with modes, see `system`: likewise"),
    Field("equipped", "", WHOLE, "largest number of devices of a lane"),
    Field("gives_way", "", WHOLE, "1 if any lane stands on a bed"),
    Field("yielding", "", WHOLE, "1 if storeys of any lane may yield"),
    Field("audited", "", WHOLE, "1 where energy flows are integrated"),
    Field("stop", "", WHOLE, "1: histories are to be left where they are"),
    Field("waiting", "", WHOLE, "number of the next request"),
    Field("active", "", WHOLE, "lanes with a history"),
    Field("present", "", WHOLE, "histories in it, or waiting for it"),
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


STOREYS_THAT_YIELD = {
    *(
        "strength",
        "stiffness",
        "mark",
        "middle",
        "middle_most",
        "middle_least",
        "drift_most",
    ),
    *("yielded", "first_yield", "new_freed", "slipping"),
}
"""Fields of modes that say something where storeys may yield."""

OVERLAYS = "words", "device_words", "mode_words", "storey_words"
"""Fields that overlay others of a state: by them a lane is copied, see `record_type`."""


def kind_of_field(field: Field) -> int:
    """0 of numbers of all lanes; from 1 on of one, as `OVERLAYS`;
    behind them what is scratch.
    """
    if not field.sizes:
        return 0
    *sizes, last = field.sizes.split()
    if field.name in STOREYS_THAT_YIELD:
        return 4
    if last != "lanes" or "stages" in sizes or field.name.startswith("new_"):
        return 1 + len(OVERLAYS)
    if "rows" in sizes:
        return 3 if len(sizes) == 1 else 1 + len(OVERLAYS)
    return 2 if f"{SLOTS}" in sizes else 1


@cache
def record_type(
    fields: tuple[Field, ...], ways: int = 1, lanes: int = 1
) -> np.dtype[Any]:
    """The type of a record of such fields, for so many directions and lanes.

    Fields of one shape stand together, and single numbers before all: a loop over lanes
    then writes before or behind what it reads, which the compiler can tell. Then come
    those that a lane keeps from step to step: of itself and of its devices (`words`,
    `device_words`: number, lane), of its modes and of storeys that yield (`mode_words`,
    `storey_words`: field, mode, lane).
    """
    sizes = {
        "ways": ways,
        "axes": ways + 1,
        "lanes": lanes + PADDING,
        "modes": MOST_STOREYS + PADDING,
        "rows": (ways + 1) * MOST_STOREYS + PADDING,
        "stages": END + 1,
        "demands": 2 * (2 * ways - 1),
    }
    kinds = {field: kind_of_field(field) if fields is STATE else 0 for field in fields}
    ordered = sorted(
        fields, key=lambda field: (kinds[field], len(field.sizes.split()), field.sizes)
    )
    of = dict[str, Location]()
    end = 0
    before = 0
    for field in ordered:
        number = np.int64 if field.unit == WHOLE else np.float64
        kind = np.dtype(
            (number, tuple(int(sizes.get(z, z)) for z in field.sizes.split()))
        )
        if kinds[field] != before:  # and then all do, of many lanes
            end = -(-end // LINE) * LINE
        before = kinds[field]
        begin = end
        of[field.name] = kind, begin
        end = begin + kind.itemsize
    if fields is STATE:
        of |= overlays(of)
    if fields in (STATE, RESULT):
        of["kept"] = overlay([of[field.name] for field in KEPT])
    return record_of(of)


LINE = 64
"""Bytes of a line of the processor's cache, with which the fields of all lanes begin."""


def record_of(fields: dict[str, Location]) -> np.dtype[Any]:
    """The type of a record with fields of kinds at offsets."""
    kinds, offsets = zip(*fields.values(), strict=True)
    return np.dtype({"names": [*fields], "formats": [*kinds], "offsets": [*offsets]})


Location: TypeAlias = tuple[np.dtype[Any], int]
"""A field's type and where it begins."""


def overlays(of: dict[str, Location]) -> dict[str, Location]:
    """The fields by which a lane is copied."""
    found = {}
    for kind, name in enumerate(OVERLAYS, 1):
        members = [of[field.name] for field in STATE if kind_of_field(field) == kind]
        found[name] = overlay(members, each=kind > 2)
    return found


def overlay(members: list[Location], *, each: bool = False) -> Location:
    """Words of fields that stand together: as rows of lanes, or
    `each` as a table of its own.
    """
    shape = members[0][0].shape
    words = sum(member.itemsize for member, _ in members) // 8
    rows = (words // shape[-1], shape[-1]) if shape else (words,)
    kind = np.dtype((np.int64, (len(members), *shape) if each else rows))
    return kind, min(offset for _, offset in members)


PAGE = 4096
"""Bytes of a page of memory. numpy begins an array anywhere; begun within a page,
a lane may take half as long again, as its rows fall on other lines of the
processor's cache in each process."""


def records(
    fields: tuple[Field, ...], count: int = 1, ways: int = 1, lanes: int = 1
) -> Record:
    """An array (count,) of records of zeros that begins with a page."""
    kind = record_type(fields, ways, lanes)
    size = kind.itemsize * count
    room = np.zeros(size + PAGE, np.uint8)
    first = -room.ctypes.data % PAGE
    return room[first : first + size].view(kind).view(np.recarray)


_kept = local()


def scratch(ways: int, lanes: int) -> Record:
    """States that this thread keeps, with whatever their last use left
    there (1,) or (STATES,).

    A state takes megabytes: made anew for each short history, it would
    take as long as the history.
    """
    kept = vars(_kept)
    name = f"{ways} {lanes}"
    if name not in kept:
        kept[name] = records(STATE, 1 if lanes == 1 else STATES, ways, lanes)
    return kept[name]
