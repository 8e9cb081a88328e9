"""`podium.contact`: what is read, what is refused and why, and what commands say of it."""

import math

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure
from paper_structures import known

from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.cli import program
from rpscli.report.figures.bearing import draw_end
from rpscli.report.figures.structure import draw_mode

from .conftest import BUILDING, EDGES, FLAT, PLANE, case_of


def structure_of(*overrides):
    return case_of(*FLAT, *overrides).structure


def test_keys_and_their_defaults():
    """The three sizes describe the same joint; without the key ends are rigid."""
    assert structure_of().bed is None
    first = structure_of(PLANE)
    bed = known(first.bed)
    assert (first.contact.damping, first.impact_law.loss) == (0.03, 0.3)
    assert structure_of(EDGES).impact_law.loss == 1.0
    assert structure_of(PLANE, "podium.impact.loss=0.8").impact_law.loss == 0.8
    for given in (f"stiffness: {bed.stiffness!r}", f"settlement: {bed.settlement!r}"):
        other = known(structure_of(f"podium.contact={{kind: plane, {given}}}").bed)
        assert other.period_ratio == pytest.approx(1.2, rel=1e-9)
    units = structure_of("podium.contact={kind: edges, stiffness: 60 MN/m}")
    assert units.contact.stiffness == 6e7
    assert structure_of(
        PLANE, "analysis.recontact_tolerance=1e-6"
    ).bed  # the default, as in a case that was written out whole


def printed(command, contact, folder):
    """What a command prints, blanks as one."""
    case = folder / "c.yaml"
    case.write_text(
        BUILDING.replace("record: {source: motion.at2}\n", ""), encoding="utf-8"
    )
    words = [word for each in (*FLAT, contact) for word in ("--set", each)]
    if command != "check":
        words += ["-o", str(folder / f"{command} {contact}")]
    result = CliRunner().invoke(
        program, [command, str(case), *words], env={"COLUMNS": "200"}
    )
    assert result.exit_code == 0, result.stderr
    return " ".join(result.stdout.split())


@pytest.fixture
def _no_pictures(monkeypatch):
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"a figure")


@pytest.mark.usefixtures("_no_pictures")
def test_what_commands_print(tmp_path):
    """Each number from W, R, alpha and the law of one end, to the digits that are printed."""
    check = printed("check", PLANE, tmp_path)
    assert "period in full contact over T1 r 1.200" in check
    assert "first period in full contact T 0.3600 s" in check
    structure = structure_of(PLANE)
    alpha, W = math.atan(0.15), structure.weight
    # To first order phi_u = tan(alpha)/(3 (1 + 2 H K_s/W)).
    K = float(check.split(" K_s ")[1].split()[0]) * 1e3
    phi_u = 0.15 / (3.0 * (1.0 + 3.0 * math.cos(alpha) * K / W))
    told = float(check.split(" phi_u ")[1].split()[0])
    assert told == pytest.approx(phi_u, rel=1e-3)
    settled = float(check.split(" D_0 ")[1].split()[0])
    assert settled == pytest.approx(phi_u * 1.5 * math.sin(alpha), rel=1e-3)
    length = float(check.split("contact length at 0.1 alpha ")[1].split()[0])
    assert length == pytest.approx(math.sqrt(10.0 * phi_u / alpha), rel=1e-3)
    edges = printed("check", EDGES, tmp_path)
    assert float(edges.split(" phi_u ")[1].split()[0]) == pytest.approx(
        3.0 * told, rel=2e-3
    )
    assert "contact length" not in edges

    modes = printed("modal", PLANE, tmp_path)
    assert "full contact rad/s T s xi %" in modes
    assert "1.200 without damping" in modes

    push = printed("pushover", PLANE, tmp_path)
    uplift = push.split("uplift force ")[1].split()
    force = float(uplift[0]) * {"MN": 1e6, "kN": 1e3}[uplift[1]]
    # Where edges lift m = 1/3, and flat ends have B = sin(alpha - x), C = cos(alpha - x).
    arm = math.sin(alpha - told) - 2.0 / 3.0 * math.sin(alpha)
    assert force == pytest.approx(W * arm / math.cos(alpha - told), rel=3e-4)
    assert "stiffness in full contact" in push
    assert "stiffness after uplift" in printed("pushover", "title=stiff", tmp_path)


def test_the_drawing_has_the_length_in_contact():
    def drawn(contact):
        axes, structure = Figure().subplots(), structure_of(contact)
        draw_end(axes, structure.bearing, structure.bed)
        return [text for each in axes.texts if "contact" in (text := each.get_text())]

    bed = known(structure_of(PLANE).bed)
    alpha = math.atan(0.15)
    length = 3000.0 * math.sin(alpha) * math.sqrt(10.0 * bed.uplift_rotation / alpha)
    assert drawn(PLANE) == [f"{length:.3g} mm in contact at α/10"]
    assert drawn(EDGES) == drawn("title=rigid") == []


def test_moments_of_plane_joints_end_before_the_critical_rotation():
    """Which stays that of rigid ends: alpha [1 - (2/3) sqrt(phi_u/alpha)] of slender columns."""
    structure = structure_of(PLANE)
    result, bed = pushover(structure), known(structure.bed)
    assert result.critical_rotation == structure_of().critical_rotation
    curve = result.curve
    last = curve.rotation[curve.force > 0.0].max() / math.atan(0.15)
    end = 1.0 - 2.0 / 3.0 * math.sqrt(bed.uplift_rotation / math.atan(0.15))
    step = 1.0 / 200  # of the curve's points, and what is of second order
    assert last == pytest.approx(end, abs=2.0 * step)
    assert curve.force[-1] < 0.0


def test_the_picture_of_modes_has_the_cap_beam_that_moves_in_full_contact():
    result, figure = modal(structure_of(PLANE)), Figure()
    draw_mode(figure.subplots(), result, "rocking", 1)
    dashed = next(
        line for line in figure.axes[0].lines if line.get_label() == "full contact"
    )
    shapes = known(result.full_contact).shapes
    assert np.asarray(dashed.get_xdata()).tolist() == [0.0, *shapes[:, 0].tolist()]
    assert shapes[0, 0] > 0.05  # on a fixed base it would not move
