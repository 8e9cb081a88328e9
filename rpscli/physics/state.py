"""The state of histories while the kernel follows them, and the codes that stand in it.

All lanes stand side by side in one structured record, every field named once, here: ``q``
has one row a mode, ``tilt`` one a direction. What the kernel is given and what it leaves
behind is in `interface`, how records lie in memory in `records`.

Letters are those of Theory: x the tilt, s its side, B and C the arms of contact over R.
Lanes come last, so that a loop over them is one vector instruction; what such loops test
is a number, 1 or 0.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

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


def fields_of(sizes: str, unit: str, **meanings: str) -> tuple[Field, ...]:
    """Fields of the same sizes and unit."""
    return tuple(Field(name, sizes, unit, text) for name, text in meanings.items())


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
    *fields_of(
        "lanes",
        "m",
        diameter="2 R",
        half_width="B of the flat part",
        arc_radius="r, or 0",
    ),
    *fields_of(
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
    *fields_of(
        "lanes", "1/m", weigh="(1 + 2 gamma + 2 gamma eta)/R", load="(1 + 2 gamma)/R"
    ),
    *fields_of("lanes", "1/(kg m)", share="2/(N m_c R)"),
    *fields_of(
        "lanes", "kg", columns_mass="N m_c", cap_beam_mass="m_b", floors_mass="M_tot"
    ),
    *fields_of(
        "lanes", "kg", riding="of floors that are lifted with the cap beam: all, or none"
    ),
    *fields_of(
        "lanes",
        "1/kg",
        spared="g + a_v less at contacts, a newton of floors on springs, else 0",
    ),
    *fields_of("lanes", "m/s2", gravity="g"),
    *fields_of("lanes", "rad", beta="end of the arc", theta_cr="static limit"),
    *fields_of("lanes", "s", contact_time="t_c", shock_time="see `system`"),
    *fields_of("rows lanes", "1/s2", omega2="w^2"),
    *fields_of("rows lanes", "1/s", two_xi_omega="2 xi w"),
    *fields_of("rows lanes", "sqrt(kg)", Gamma="participation"),
    *fields_of(
        "rows lanes", "mixed", shear_weight="see `system`", acceleration_weight="likewise"
    ),
    # Storeys that may yield, see `storeys`.
    *fields_of("lanes", WHOLE, yields="1 if they may", marked="storeys that yield now"),
    *fields_of("lanes", "-", hardening="h"),
    *fields_of("rows lanes", "N", strength="F"),
    *fields_of("rows lanes", "N/m", stiffness="k"),
    Field("mark", "rows lanes", WHOLE, "side to which a storey yields, else 0"),
    *fields_of("rows lanes", "m", middle="c of the elastic range", middle_most="largest"),
    *fields_of("rows lanes", "m", middle_least="least"),
    *fields_of("rows lanes", "N", drift_most="largest k |d| of a storey that yields"),
    *fields_of("rows lanes", "J", yielded="F times the path of its plastic drift"),
    *fields_of("rows lanes", "s", first_yield="when, or -1"),
    *fields_of(
        "rows lanes", "m sqrt(kg)/s2", freed="sum g_ri delta_i, load of plastic drifts"
    ),
    *fields_of("rows lanes", "m sqrt(kg)/s2", new_freed="at a stage"),
    *fields_of(
        "rows lanes",
        "N/(m sqrt(kg))",
        slipping="(1 - h) g_r1 while storey 1 yields, else 0",
    ),
    # The history and its records.
    *fields_of(
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
    *fields_of("lanes", "-", scale="factor on the records", steps="taken"),
    # The phase of motion and the range of the tilt in it.
    *fields_of(
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
    *fields_of(
        "lanes", "rad", x_low="the phase ends below", x_high="and above", bed_u="phi_u"
    ),
    *fields_of(
        "lanes",
        "1/s2",
        bed_k="k in full contact, else 0",
        bed_back="k phi_u/C_u, see `bed`",
    ),
    *fields_of("lanes", "1/s", bed_c="damping there, else 0"),
    Field(
        "rim", "lanes", "rad/s", "bed_c phi_u beyond it, against what goes round, else 0"
    ),
    *fields_of(
        "lanes", "sqrt(rad)", sink="while a plane end lifts, else 0", root="likewise"
    ),
    *fields_of("lanes", "1/rad", fade="1/(x_full - phi_u) of curved ends, else 0"),
    *fields_of("lanes", "1/sqrt(rad)", w="w of (12.6)"),
    *fields_of("lanes", "1/(rad sqrt(rad))", dw="its slope"),
    # At rest: what multiplies g + a_v in the limits of R |z| to either side, and what
    # adds to it.
    *fields_of(
        "lanes",
        "-",
        limit_right="tan(alpha) (1 + 2 gamma + 2 gamma eta)",
        limit_left="too",
    ),
    *fields_of("lanes", "m/s2", held_right="of devices and beds", held_left="likewise"),
    *fields_of(
        "lanes",
        "m/s2",
        held_x="what friction holds a tilt to any side about",
        held_y="in y",
    ),
    # The ground, linear over the interval; and time.
    Field("a_g", "ways lanes", "m/s2", "at the interval's start"),
    Field("a_g_slope", "ways lanes", "m/s3", "over it"),
    *fields_of("lanes", "m/s2", g_up="g + a_v at the interval's start"),
    *fields_of("lanes", "m/s3", g_up_slope="over it"),
    *fields_of(
        "lanes",
        "s",
        time="since the interval's start",
        h="length of the step",
        h_most="longest of this phase",
        h_limit="longest next one",
        h_now="after which the end of a step is looked for",
        dt="sampling interval",
    ),
    *fields_of("lanes", "1/s", rate="1/dt"),
    # The motion at the start of the step and at its end.
    *fields_of(
        "ways lanes", "rad", tilt="(a, b) = x (cos phi, sin phi)", new_tilt="at the end"
    ),
    *fields_of("ways lanes", "rad/s", tilt_rate="its rate", new_tilt_rate="at the end"),
    *fields_of("ways lanes", "rad/s2", bend="its acceleration", new_bend="at the end"),
    Field("bends", "stages ways lanes", "rad/s2", "at all stages"),
    *fields_of(
        "axes lanes", "m/s2", shaking="a_g + u_b'', upwards a_v + v_b''", new_shaking="so"
    ),
    *fields_of(
        "axes lanes", "N", V="base shear, springs and dampers", new_V="at the end"
    ),
    *fields_of("lanes", "N", taken="sum of k_1 abs(delta_1) of the ways, out of V"),
    *fields_of("axes lanes", "N/s", dV="its rate", new_dV="at the end"),
    *fields_of("axes lanes", "N/s2", ddV="while it stands", new_ddV="at the end"),
    *fields_of("lanes", "rad", x="tilt, along its side in one plane", new_x="at the end"),
    *fields_of("lanes", "rad/s", v="x'", new_v="at the end"),
    *fields_of("lanes", "rad/s2", a="x''", new_a="at the end"),
    *fields_of("lanes", "m/s2", lift="v_b''", new_lift="at the end"),
    *fields_of("rows lanes", "m sqrt(kg)", q="of modes", new_q="at the end"),
    *fields_of("rows lanes", "m sqrt(kg)/s", dq="velocities", new_dq="at the end"),
    *fields_of("rows lanes", "m sqrt(kg)/s2", force="f_r of the last stage"),
    Field("ddq", "stages rows lanes", "m sqrt(kg)/s2", "accelerations at all stages"),
    # What is known of the step.
    *fields_of(
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
    *fields_of(
        "lanes", WHOLE, devices="number of devices", tendons="of tendons in a column"
    ),
    Field("device_kind", f"{SLOTS} lanes", WHOLE, "see `system`"),
    Field("law", f"{SLOTS} 4 lanes", "mixed", "`device_constants` of `system`"),
    Field("own_law", f"{SLOTS} 2 lanes", WHOLE, "addresses, see `system`"),
    Field("branch", f"{SLOTS} lanes", WHOLE, "IDLE, WORKING or BEYOND"),
    Field("permanent", f"{SLOTS} lanes", "m", "plastic elongation of a tendon"),
    *fields_of("lanes", "-", columns="N", kinks="1: a force has a kink at u_b' = 0"),
    *fields_of(
        "lanes",
        "m/s",
        linear_speed="see `system`",
        stop_speed="|u_b'| at which friction stops a tilt to any side",
        start_speed="see `system`",
    ),
    *fields_of(
        "lanes",
        "rad/s",
        least_error="what a step may err by, where friction turns the tilt",
    ),
    *fields_of(
        "lanes",
        "N",
        friction_force="of all friction dampers",
        tied="by tendons, along it",
    ),
    *fields_of("lanes", "N", pull="on the cap beam, downwards"),
    *fields_of("lanes", "N m", friction_moment="of all rolling resistance"),
    *fields_of("ways lanes", "N", drive="of dampers and stops on the cap beam"),
    *fields_of(
        "lanes",
        "1/s2",
        turning="of tendons and rolling resistance along the tilt, over N m_c R^2",
        turning_across="of rolling resistance across it",
    ),
    # Sums of linear dampers, and of what has branches or powers; means over the step.
    *fields_of(
        "lanes", "N s/m", viscous="linear dampers", drag_branched="others, over |u_b'|"
    ),
    *fields_of("lanes", "N", stop_force="of stops that are met"),
    *fields_of("lanes", "N m", tendon_moment="of tendons, along the tilt"),
    *fields_of("lanes", "-", branched="1: a device has branches or powers"),
    *fields_of(
        "lanes", "m/s", speed="|u_b'| at the start of the step", new_speed="at the end"
    ),
    *fields_of(
        "lanes", "m2/s3", square_rate="rate of its square", new_square_rate="at the end"
    ),
    *fields_of("lanes", "m/s2", quicker="|u_b''|", new_quicker="at the end"),
    *fields_of(
        "lanes", "-", new_height="C at the end of the step", least_height="least so far"
    ),
    *fields_of("lanes", "m2/s2", mean_square="of |u_b'|"),
    *fields_of("lanes", "m/s", mean_pace="of u_b' against which friction acts"),
    *fields_of(
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
    *fields_of(
        "rows lanes", "m sqrt(kg)", seen_q="modes when floors were last looked at"
    ),
    *fields_of("rows lanes", "m sqrt(kg)/s2", seen_force="their forces"),
    *fields_of("ways lanes", "mixed", shear_sum="sum g (q - seen_q)^2 at the end"),
    *fields_of(
        "ways lanes", "mixed", shear_before="at its start", bent="sum g (q' - new_q')^2"
    ),
    *fields_of(
        "ways lanes",
        "mixed",
        acceleration_sum="over modal forces",
        acceleration_before="so",
    ),
    *fields_of("lanes", "mixed", bend_ratio="see `system`"),
    Field("max_beam", "ways lanes", "m", "largest |u_b| in either direction"),
    *fields_of(
        "lanes", "W", power_input="mean of the step", power_damped="so", power_bed="so"
    ),
    *fields_of("lanes", "W", power_upwards="of the dampers between floors upwards, so"),
    Field("factors", "6 rows lanes", "mixed", "of the exact step, see `standing`"),
    *fields_of("lanes", "s", factors_h="step that they are of"),
    Field(
        "within",
        "16 rows",
        "mixed",
        "factors of velocities within the step of the only lane",
    ),
    *fields_of("lanes", "s", within_h="step that they are of"),
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
