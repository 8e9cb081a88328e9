"""`podium.twist` in cases, results, studies and files."""

import numpy as np
import pytest

import rpscli
from rpscli.analyses.twist import twist_history
from rpscli.case.case import parse_case
from rpscli.errors import RpsError
from rpscli.report.bundles import timehistory_files
from rpscli.report.captions import CAPTIONS
from rpscli.report.twist import columns_table, depends
from rpscli.tools.animation.slab import SlabView

CASE = """\
rps: 1
title: A slab that turns
superstructure:
  storeys: 1
  storey_mass: 160 t
  storey_height: 3 m
  period: 0.3 s
  damping: {ratio: 0.05}
  torsion: {period_ratio: 1.2, eccentricity: [0.05, 0.05]}
podium:
  cap_beam_mass: 160 t
  column_mass: 4 t
  columns: 4
  bearing: {semi_diagonal: 1.5 m, slenderness: 0.15, wedge_slenderness: 0.30, curvature_ratio: 0.5}
  plan: {rows: [0 m, 10 m], y: {rows: [0 m, 10 m]}}
  twist: {scatter: {slenderness: 0.02, seed: 1}, pivot_friction: 1 mm, seats: 5 mm}
"""


SPHERICAL = [
    ("slenderness: 0.15,", "slenderness: 0,"), ("curvature_ratio: 0.5", "curvature_ratio: 1.5")
]  # fmt: skip


def case(*changes, text=CASE):
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return parse_case(text, name="turns.yaml")


def pair():
    x = rpscli.load_record("synthetic:?pga=0.5g&duration=6&dt=0.01&seed=1")
    y = rpscli.load_record("synthetic:?pga=0.5g&duration=6&dt=0.01&seed=2")
    return rpscli.MotionComponents(x, y=y)


@pytest.fixture(scope="module")
def result():
    of = parse_case(CASE, name="turns.yaml")
    return rpscli.time_history(of.structure, pair(), of.analysis)


def test_results_are_of_the_column_that_moves_most(result):
    columns = result.twist.run.columns
    heads = np.hypot(*np.moveaxis(result.twist.column_ways, -1, 0)).max(axis=0)
    own = float(columns["max_u"].max())
    assert result.twist.max_corner_displacement == own
    assert result.max_corner_displacement == max(own, result.max_cap_beam_displacement)
    # Samples are 10 ms apart, between which the largest may lie.
    assert (columns["max_u"] >= heads - 1e-12).all()
    np.testing.assert_allclose(columns["max_u"], heads, rtol=0.01)
    centre = result.twist.max_centre_displacement
    assert result.corner_factor == own / centre > 1.0
    assert result.max_rotation >= result.max_column_rotation
    assert (
        result.rotation_ratio >= (columns["max_tilt"] / result.twist.run.critical).max()
    )
    assert 0.0 < result.max_twist < 0.1
    assert result.residual_twist < 0.1 * result.max_twist


def test_the_energy_of_an_earthquake_closes(result):
    energies = result.twist.energies
    assert abs(energies["residual"]) < 1e-6 * energies["input"]
    parts = ("damped", "pivots", "dampers", "passes", "lost_at_rest")
    assert all(energies[part] >= 0.0 for part in parts)
    assert energies["pivots"] > 0.0 < energies["damped"]


def test_without_the_key_nothing_changes(result):
    plain = parse_case(CASE.replace("  twist:", "  # twist:"), name="p.yaml")
    other = rpscli.time_history(plain.structure, pair(), plain.analysis)
    assert other.twist is None
    assert other.max_twist is None
    assert other.history["max_theta"] == result.history["max_theta"]
    assert other.max_base_shear == result.max_base_shear


def test_dampers_at_corners_and_in_the_middle():
    """A tenth of the weight per m/s at the corners holds the turn back more."""
    at = "[[0 m, 0 m], [10 m, 0 m], [0 m, 10 m], [10 m, 10 m]]"
    turns = {}
    for name, places in (("none", None), ("middle", ""), ("corners", f", at: {at}")):
        text = CASE
        if places is not None:
            device = f"[{{kind: viscous, coefficient: 330 kN s/m{places}}}]"
            text = text.replace("  twist:", f"  devices: {device}\n  twist:")
        of = parse_case(text, name="d.yaml")
        turns[name] = twist_history(of.structure, pair(), of.analysis).max_twist
    assert turns["corners"] < 0.5 * turns["middle"]
    assert turns["corners"] < 0.5 * turns["none"]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ([(", y: {rows: [0 m, 10 m]}", "")], "places of columns"),
        ([("  columns: 4", "  columns: 6")], "2 x 2"),
        ([("  twist:", "  contact: {kind: edges, settlement: 1 mm}\n  twist:")], "compliant"),
        ([("  twist:", "  impact: rigid\n  twist:")], "law rigid"),
        ([("period: 0.3 s", "period: 0.3 s\n  yield: {ratio: 1.5}")], "yield"),
        ([("period: 0.3 s", "period: 0.3 s\n  vertical_period: 0.1 s")], "vertical_period"),
        (
            [("  twist:", "  devices: [{kind: stop, gap: 1 m, stiffness: 1 MN/m}]\n  twist:")],
            "stop",
        ),
        (
            [(
                "  twist:",
                "  devices: [{kind: viscous, coefficient: 1 kN s/m, exponent: 0.5}]\n  twist:",
            )],
            "exponent 1",
        ),
        ([("seats: 5 mm", "seats: 0.1 mm")], "seats"),
        ([("scatter: {slenderness: 0.02, seed: 1}", "factors: [1, 1.02]")], "factors"),
        ([("eccentricity: [0.05, 0.05]", "eccentricity: [0.6, 0]")], "eccentricity"),
        (SPHERICAL, "scatter would change nothing"),
        (
            [("scatter: {slenderness: 0.02, seed: 1}", "factors: [1, 1, 1, 1.1]"), *SPHERICAL],
            "factors would change nothing",
        ),
        (
            [
                ("seats: 5 mm}", "seats: 5 mm}\n  contact: {kind: edges, settlement: 1 mm}"),
                ("period: 0.3 s", "period: 0.3 s\n  vertical_period: 0.1 s"),
            ],
            "compliant .*; and .*vertical_period",
        ),
    ],
)  # fmt: skip
def test_what_is_not_followed_is_refused_with_the_reason(changes, words):
    def followed():
        return twist_history(case(*changes).structure, pair())

    with pytest.raises(RpsError, match=words):
        followed()


def test_one_component_is_refused():
    of = parse_case(CASE, name="one.yaml")
    with pytest.raises(RpsError, match="leaves its plane"):
        rpscli.time_history(of.structure, pair().horizontal)


def test_factors_go_to_the_columns_row_by_row():
    changes = [
        ("scatter: {slenderness: 0.02, seed: 1}", "factors: [1.02, 0.99, 1.01, 0.98]")
    ]
    structure = case(*changes, text=CASE).structure
    run = twist_history(structure, pair()).run
    assert run.factors.tolist() == [1.02, 0.99, 1.01, 0.98]
    assert run.places.tolist() == [[-5, -5], [5, -5], [-5, 5], [5, 5]]
    np.testing.assert_allclose(run.columns["tan_a"], 0.15 * run.factors, rtol=1e-12)


def test_every_figure_of_a_history_has_a_caption_for_pages(result):
    files = [name for name, _ in timehistory_files(result, "title")]
    figures = {name.removesuffix(".png") for name in files if name.endswith(".png")}
    assert "twist" in figures
    assert figures <= CAPTIONS.keys()


def test_a_slab_on_spherical_ends_that_friction_holds_stays_tilted():
    """No flat part: neither factors of the slenderness nor passes are told."""
    changes = [
        ("scatter: {slenderness: 0.02, seed: 1}, ", ""),
        *SPHERICAL,
        ("  twist:", "  devices: [{kind: friction, force: 300 kN}]\n  twist:"),
    ]
    of = case(*changes)
    found = rpscli.time_history(of.structure, pair(), of.analysis)
    assert found.outcome == found.twist.outcome == "stays_tilted"
    assert "passes" not in {name for name, *_ in found.twist.by_column()}
    heads = columns_table(found.twist).heads
    assert "passes" not in heads
    assert "slenderness times" not in heads
    assert "scatter" not in depends(found.twist)


def test_a_scatter_of_many_columns_is_what_it_says():
    drawn = rpscli.Twist(scatter=0.02, seed=3).factors_of(20_000)
    assert drawn.mean() == pytest.approx(1.0, abs=5e-4)
    # Cut at three standard deviations, 1.3 % smaller.
    assert drawn.std() == pytest.approx(0.02 * 0.9866, rel=0.01)
    assert np.abs(drawn - 1.0).max() <= 0.06


def test_demands_which_would_not_turn_are_refused():
    structure = case().structure
    with pytest.raises(RpsError, match="centre alone"):
        rpscli.demand(structure, pair())


def test_a_film_shows_the_slab_from_above(result):
    from matplotlib.figure import Figure

    axes = Figure().add_subplot()
    view = SlabView(axes, result.twist)
    sample = int(np.abs(result.twist.ways[:, 2]).argmax())
    view.show(sample)
    heads = np.transpose(view.heads.get_data())
    ways = (heads - result.twist.run.places) / view.scale
    np.testing.assert_allclose(ways, result.twist.column_ways[sample], atol=1e-12)
    corners = view.outline.get_xy()[:4]
    side = corners[1] - corners[0]
    turned = np.arctan2(side[1], side[0])
    psi = result.twist.ways[sample, 2]
    assert turned == pytest.approx(np.arctan(view.scale * psi), rel=1e-9)
    assert np.all(np.abs(corners) <= axes.get_xlim()[1] * 1.5)
