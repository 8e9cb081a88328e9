"""`rpscli.figures`: panels in somebody else's axes."""

import inspect
import math
import re
import subprocess
import sys
from dataclasses import replace
from functools import cache

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from paper_structures import podium

from report.small_results import CURVED, KINDS, history, structure, turned
from rpscli import figures
from rpscli.analyses.floor_spectra import fixed_base_floor_spectra, isolated_floor_spectra
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.errors import UsageError
from rpscli.model.devices import ViscousDamper
from rpscli.records.measures import response_spectrum

MADE = replace(structure(CURVED, 3), devices=(ViscousDamper(2e5),))


@cache
def result():
    return history(MADE, "pulse:half_sine?amplitude=0.3g&period=0.6")


def spectrum_of_record():
    return response_spectrum(result().record, np.linspace(0.1, 2.0, 20))


@cache
def both():
    return turned()


TIME = "time [s]"
PANELS = {
    "ground_acceleration": (lambda: (result(),), TIME, "ground\nacceleration [m/s²]"),
    "rotation": (lambda: (result(),), TIME, "rotation $\\theta$ [rad]"),
    "azimuth": (lambda: (both(),), TIME, "azimuth\n$\\varphi$ [deg]"),
    "orbit": (lambda: (both(),), "cap beam $u_{b,x}$ [m]", "cap beam $u_{b,y}$ [m]"),
    "events": (lambda: (result(),), TIME, ""),
    "displacements": (
        lambda: (result(),),
        TIME,
        "displacement relative\nto the ground [m]",
    ),
    "elastic_displacements": (lambda: (result(),), TIME, "relative\nto the cap beam [m]"),
    "energy": (lambda: (result(),), TIME, "energy [kJ]"),
    "moment_rotation": (
        lambda: (result(),),
        "rotation $\\theta$ [rad]",
        "contact points [MN m]",
    ),
    "storey_loop": (
        lambda: (KINDS["yields"](), 1),
        "storey drift $d$ [mm]",
        "shear $f$ [kN]",
    ),
    "storey_shears": (lambda: (result(),), "storey shear [MN]", "level (0 = cap beam)"),
    "storey_drifts": (
        lambda: (result(),),
        "storey drift ratio [%]",
        "level (0 = cap beam)",
    ),
    "floor_accelerations": (lambda: (result(),), "floor acceleration [m/s²]", "level"),
    "device": (lambda: (result(), 0), "$u_b$ [m]", "resistance [kN]"),
    "storey_curve": (
        lambda: (pushover(MADE),),
        "$u_b$ [m]",
        "force at the cap beam [MN]",
    ),
    "lift": (lambda: (pushover(MADE),), "$u_b$ [m]", "lift [mm]"),
    "capacity": (
        lambda: (pushover(MADE),),
        "roof displacement [m]",
        "sum of floor forces [",
    ),
    "mode": (lambda: (modal(MADE), "rolling", 1), "shape [-]", "height [m]"),
    "motion": (lambda: (result().record, "velocity"), TIME, "velocity\n[m/s]"),
    "spectrum": (
        lambda: (spectrum_of_record(),),
        "period [s]",
        "pseudo-acceleration, 5 % damping",
    ),
    "spectra": (
        lambda: ([spectrum_of_record()] * 2,),
        "period [s]",
        "5 % damping [m/s²]",
    ),
    "floor_spectrum": (
        lambda: (isolated_floor_spectra(result()), fixed_base_floor_spectra(result()), 3),
        "period [s]",
        "floor 3, pseudo-acceleration [m/s²]",
    ),
    "bearing": (lambda: (MADE, 0.1), "", ""),
    "bearing_end": (lambda: (CURVED,), "", ""),
    "structure": (lambda: (MADE,), "", ""),
}


def test_every_panel_is_tried_and_named():
    assert {*PANELS, "style"} == set(figures.__all__)
    assert set(figures.__all__) <= set(re.findall(r"`(\w+)`", figures.__doc__ or ""))


def panel(name, axes):
    arguments, _, _ = PANELS[name]
    getattr(figures, name)(axes, *arguments())


@pytest.mark.parametrize("name", PANELS)
def test_a_panel_is_drawn_with_labels_and_units(name):
    figure = Figure()
    left, right = figure.subplots(1, 2)
    panel(name, right)
    _, x_label, y_label = PANELS[name]
    assert right.get_xlabel().endswith(x_label)
    assert y_label.replace("\n", " ") in right.get_ylabel().replace("\n", " ")
    assert right.lines or right.patches
    assert not left.has_data()  # nothing but the axes that were given
    assert figure.get_suptitle() == ""
    assert (figure.axes[0], figure.axes[1]) == (left, right)
    figure.draw_without_rendering()
    parts = Figure().subfigures(1, 2, squeeze=False)[0]
    panel(name, parts[1].subplots())
    assert not parts[0].axes


@pytest.mark.parametrize("name", PANELS)
def test_small_axes_keep_room_for_what_they_show(name):
    """Four axes of 56 mm by 46 mm: legends and labels leave a third of each to its panel."""
    across, upwards = 56.0 / 25.4, 46.0 / 25.4
    figure = Figure(figsize=(2 * across, 2 * upwards), layout="constrained")
    every = figure.subplots(2, 2).ravel()
    for axes in every:
        panel(name, axes)
    figure.draw_without_rendering()  # which warns of axes without a size
    for axes in every:
        shape = axes.get_position()
        inside = axes.get_window_extent()
        if axes.get_aspect() == "auto":
            assert shape.width > 0.5 / 3
            assert shape.height > 0.5 / 3
        assert min(inside.width, inside.height) / figure.dpi > 0.3


@pytest.mark.parametrize(
    "name", ["storey_shears", "floor_accelerations", "storey_drifts"]
)
def test_profiles_say_what_their_lines_are(name):
    axes = Figure(figsize=(4.0, 3.0), layout="constrained").subplots()
    panel(name, axes)
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert {"on bearings", "fixed base"} <= {*texts}


def test_fonts_are_the_users_and_style_is_ours():
    with mpl.rc_context({"axes.labelsize": 17.0}):
        axes = Figure().subplots()
        figures.rotation(axes, result())
        assert axes.xaxis.label.get_fontsize() == 17.0
        with figures.style():
            ours = Figure().subplots()
            assert ours.xaxis.label.get_fontsize() == 9.0
        assert mpl.rcParams["axes.labelsize"] == 17.0


def test_the_module_does_not_load_matplotlib():
    code = (
        "import sys, rpscli; rpscli.figures.rotation; print('matplotlib' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout == "False\n"


def test_legends_may_be_left_out_and_names_are_hinted_at():
    axes, energy = Figure().subplots(), PANELS["energy"][0]()
    draw = figures.energy
    draw(axes, *energy, legend=False)
    assert axes.get_legend() is None
    assert axes.get_legend_handles_labels()[1]  # for one's own
    assert figures.moment is figures.moment_rotation
    for name in ("moment_rotatoin", "storeycurve"):
        with pytest.raises(AttributeError, match=r"has no panel .*; did you mean \w+\?"):
            getattr(figures, name)


def test_other_axes_and_other_results_are_refused():
    for axes in (None, 3, Figure()):
        with pytest.raises(UsageError, match="needs Axes of matplotlib"):
            figures.rotation(axes, result())
    for drawn in (None, result().structure):
        with pytest.raises(
            UsageError, match="rotation: needs TimeHistoryResult of rpscli"
        ):
            figures.rotation(Figure().subplots(), drawn)


@pytest.mark.parametrize(
    ("name", "other", "said"),
    [
        ("device", (-1,), "'-1' is none of the devices"),
        ("device", ("a",), "'a' is none of the devices"),
        ("mode", ("rolling", -1), "'-1' is none of the modes; there are 0, 1"),
        ("mode", ("rolling", 99), "none of the modes"),
        ("mode", ("sliding", 1), "none of the phases; there are rolling, rocking"),
        ("motion", ("jerk",), "there are acceleration, velocity, displacement"),
        ("floor_spectrum", (None, 0), "'0' is none of the floors; there are 1"),
        ("bearing", (math.nan,), "must be less than a quarter turn"),
        ("bearing", (10.0,), "must be less than a quarter turn"),
    ],
)
def test_panels_that_are_not_there(name, other, said):
    drawn = PANELS[name][0]()[0]
    with pytest.raises(UsageError, match=said):
        getattr(figures, name)(Figure().subplots(), drawn, *other)


def test_nothing_to_draw_is_told():
    single = pushover(podium(0))
    with pytest.raises(UsageError, match="has no capacity curve"):
        figures.capacity(Figure().subplots(), single)
    with pytest.raises(UsageError, match="no spectra to be drawn"):
        figures.spectra(Figure().subplots(), [])


@pytest.mark.parametrize("name", sorted({*figures.__all__} - {"style"}))
def test_the_signature_shows_the_legend(name):
    """Behind what the panel itself takes."""
    found = inspect.signature(getattr(figures, name)).parameters
    legend = found["legend"]
    assert legend.default is True
    assert legend.kind is inspect.Parameter.KEYWORD_ONLY
    assert next(iter(found)) == "axes"
