"""Pictures that one prints: no text over another or off the canvas, legends beside the data."""

import warnings
from contextlib import nullcontext
from dataclasses import replace
from functools import cache, partial
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from paper_structures import needs_compiled_kernels

import rpscli
from report.small_results import CURVED, history, structure, turned, yielding
from report.test_figures_of_studies import a_selection, of_one_unknown, of_two_unknowns
from report.test_public_figures import PANELS, panel
from rpscli.analyses.floor_spectra import PERIODS
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.result_quantities import LIMITED
from rpscli.model.devices import FrictionDamper, Stop, Tendon, ViscousDamper
from rpscli.records.measures import drawn_spectrum
from rpscli.report import bundles
from rpscli.report.figures import style
from rpscli.report.figures.look import Look
from rpscli.report.figures.structure import draw_structure
from rpscli.report.files import Drawing
from rpscli.report.motions import record_files
from rpscli.report.study.heights import Floors, floor_spectra_figure
from rpscli.tools.budget.report import Budget, BudgetRow
from rpscli.tools.design.report import region_figure, requirements_figure
from rpscli.tools.selection.figure import selection_figure

TITLE = (
    "Eighteen hospitals at the river, of which each is compared with all of the others"
)
NAME = "The hospital at the river, block {} of the second phase"
ALPHA, SIX = (
    "podium.bearing.slenderness",
    Path(__file__).parents[2] / "cases/six_storey.yaml",
)
PULSE = "pulse:half_sine?amplitude=0.3g&period=0.6"
RECORDS = [f"pulse:sine?amplitude=0.4g&period={period}" for period in (0.5, 2.0)]
HAZARD = "PGV [cm/s],rate [1/year]\n2,0.2\n10,0.03\n50,0.001\n200,0.00001\n"
LIMITS = {"rotation_ratio": [0.25, 0.5]}
REPORTS = [
    "overturning",
    "rotation",
    {"demand": {"panels": ["scale"], "series": ["title"]}},
    {"storey_shear": {"panels": ["title"]}},
    {"ida": {"result": "max_base_shear"}},
    {"fragility": {"limits": LIMITS}},
    {"risk": {"limits": LIMITS, "hazard": {"file": "hazard.csv", "measure": "PGV"}}},
    "comparison",
    {"lines": {"x": "scale", "result": ["rotation_ratio", "fixed_base_ratio"]}},
    {"table": {"result": "max_base_shear"}},
    {"scatter": {"x": "max_base_shear", "y": "PGV", "panels": [], "series": ["title"]}},
    {"overturning_spectrum": {"panels": [], "series": ["title"]}},
]


def texts_of(figure):
    """Those that are drawn."""
    seen = []
    draw = Text.draw

    def watch(text, renderer):
        if text.get_visible() and text.get_text().strip():
            seen.append(text)
        draw(text, renderer)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Text, "draw", watch)
        figure.draw_without_rendering()
    return list(dict.fromkeys(seen))


def faults(figure):
    """What a reader would complain about."""
    canvas = FigureCanvasAgg(figure)
    texts, point = texts_of(figure), figure.dpi / 72.0
    renderer, frame = canvas.get_renderer(), figure.bbox.padded(point)
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in texts]
    lines = [(text, line) for text in texts for line in text.get_text().split("\n")]
    for text, line in lines:
        if (signs := line.count("$")) and (signs % 2 or not text.get_parse_math()):
            yield f"formula cut: {text.get_text()!r}"
    for words, box in boxes:
        if not frame.containsx(box.x0) or not frame.containsx(box.x1):
            yield f"off the canvas: {words!r}"
        if not frame.containsy(box.y0) or not frame.containsy(box.y1):
            yield f"above or below the canvas: {words!r}"
    for (words, box), (others, other) in combinations(boxes, 2):
        if shared(box, other, point):
            yield f"over each other: {words!r} and {others!r}"
    yield from of_panels(figure, renderer)


def of_panels(figure, renderer):
    """Legends over panels, and panels without room."""
    point = figure.dpi / 72.0
    found = [*figure.findobj(Axes), *figure.findobj(Legend)]
    boxes = [(each, each.get_window_extent(renderer)) for each in found]
    panels = [
        (each, box) for each, box in boxes if isinstance(each, Axes) and each.axison
    ]
    for legend, box in boxes[len(figure.findobj(Axes)) :]:
        for axes, of_axes in panels:
            if shared(box, of_axes, 2.0 * point):
                yield f"the legend of {legend.get_texts()[0]} over {axes.get_title()!r}"
    for axes, box in panels:
        if axes.get_label() != "<colorbar>" and min(box.width, box.height) < 16.0 * point:
            yield f"no room is left for {axes.get_title() or axes.get_xlabel()!r}"


def shared(one, other, least):
    """True if boxes have an area in common."""
    across, upwards = (
        min(getattr(one, f"{end}1"), getattr(other, f"{end}1"))
        - max(getattr(one, f"{end}0"), getattr(other, f"{end}0"))
        for end in "xy"
    )
    return bool(across > least and upwards > 1.5 * least)


def printed(draw, columns):
    look = Look(columns=columns)
    with style.in_style(look):
        return [*faults(style.drawn(draw, look))]


@pytest.mark.long
@pytest.mark.parametrize("columns", [1, 2])
def test_figures_of_analyses_can_be_read(columns, monkeypatch):
    devices = ViscousDamper(2e5), Stop(0.02, 4e6), Tendon(2e4, 1e6), FrictionDamper(1e5)
    made, look = replace(structure(CURVED, 6), devices=devices), Look(columns=columns)
    result = history(made, PULSE)
    storeys = [
        Floors((NAME.format(n),), np.ones((3, 2, 2, 6, len(PERIODS)))) for n in range(9)
    ]
    draw = {
        "structure": style.single(draw_structure, made, (TITLE,), 4.4, 5.0),
        "selection": partial(selection_figure, a_selection(), TITLE),
        "requirements": partial(requirements_figure, of_one_unknown(), TITLE),
        "region": partial(region_figure, of_two_unknowns(), TITLE),
        "spectra": floor_spectra_figure(("title",), storeys, "")(TITLE),
    }
    files = [
        *style.figure_files(draw, look).items(),
        *bundles.timehistory_files(result, TITLE, look),
        *bundles.timehistory_files(turned(), TITLE, look),
        *bundles.timehistory_files(turned("yields"), TITLE, look),
        *bundles.timehistory_files(history(yielding(8), PULSE), TITLE, look),
        *bundles.pushover_files(pushover(yielding(6)), TITLE, look),
        *bundles.pushover_files(pushover(yielding(6, 0.0)), TITLE, look),
        *bundles.floor_spectra_files(result, TITLE, look),
        *bundles.pushover_files(pushover(made), TITLE, look),
        *bundles.modal_files(modal(made), TITLE, look),
        *record_files(result.record, drawn_spectrum(result.record), look),
    ]
    drawings = [each for _, each in files if isinstance(each, Drawing)]
    assert len(drawings) > 15
    figures = list[Figure]()
    monkeypatch.setattr(
        Figure, "savefig", lambda figure, *_, **__: figures.append(figure)
    )
    for each in drawings:
        each.draw()
    with style.in_style(look):
        found = [
            f"{each.name}: {fault}"
            for each, of in zip(drawings, figures, strict=True)
            for fault in faults(of)
        ]
    assert not found


@pytest.mark.parametrize("of_rps", [False, True])
def test_panels_fit_into_a_grid(*, of_rps):
    names = ["rotation", "energy", "moment_rotation", "storey_curve", *PANELS]
    found = []
    for first in range(0, len(names), 4):
        with warnings.catch_warnings(), style.in_style() if of_rps else nullcontext():
            warnings.simplefilter("error")  # of a layout that collapses
            found += in_grid(names[first : first + 4])
    assert not found


@pytest.mark.parametrize(
    "name", ["rotation", "displacements", "moment_rotation", "storey_curve"]
)
def test_legends_stay_in_axes_that_nothing_makes_room_around(name):
    figure = Figure()
    above, below = figure.subplots(2, 1)
    panel(name, below)
    figure.draw_without_rendering()
    legend = below.get_legend()
    assert legend is not None
    assert not shared(legend.get_window_extent(), above.get_window_extent(), 0.0)
    assert above.get_legend() is None


def in_grid(names):
    figure = Figure(figsize=(7.0, 5.0), layout="constrained")
    for axes, name in zip(figure.subplots(2, 2).flat, names, strict=False):
        panel(name, axes)
    return [f"{names}: {fault}" for fault in faults(figure)]


@cache
def eighteen(folder):
    (folder / "hazard.csv").write_text(HAZARD, encoding="utf-8")
    places = enumerate((source, scale) for source in RECORDS for scale in (0.3, 1.0))
    rows = [f"{source},{scale},1,{0.01 * 2.0**n}\n" for n, (source, scale) in places]
    (folder / "seen.csv").write_text(
        "".join(["record,scale,overturned,max_rotation\n", *rows])
    )
    slopes = [round(0.08 + 0.005 * n, 4) for n in range(18)]
    study = {
        "rps": 1, "title": TITLE, "base": str(SIX), "limits": {}, "whole_histories": True,
        "vary": [{"title": [NAME.format(n) for n in range(18)], ALPHA: slopes}],
        "records": RECORDS, "scale": {"measure": "PGV", "values": [0.3, 1.0]},
        "observed": "seen.csv", "reports": REPORTS,
    }  # fmt: skip
    return rpscli.load_study(study).run()


@pytest.fixture
def result(tmp_path_factory, monkeypatch):
    place = tmp_path_factory.getbasetemp() / "eighteen"
    place.mkdir(exist_ok=True)
    monkeypatch.chdir(place)
    return eighteen(place)


@pytest.mark.long
@needs_compiled_kernels
@pytest.mark.parametrize("columns", [1, 2])
def test_reports_can_be_read(result, columns):
    assert {*result.study.reports} == {*REPORT_NAMES}
    for name in REPORT_NAMES:
        figure = result.report(name).figure
        assert figure is not None, name
        assert not printed(figure(TITLE), columns), name


REPORT_NAMES = [next(iter(each)) if isinstance(each, dict) else each for each in REPORTS]


@needs_compiled_kernels
@pytest.mark.parametrize(
    "first", [8, *(pytest.param(first, marks=pytest.mark.long) for first in (0, 4))]
)
def test_reports_fit_into_a_grid(result, first):
    figure = Figure(figsize=(7.0, 5.0), layout="constrained")
    for axes, name in zip(figure.subplots(2, 2).flat, REPORT_NAMES[first:], strict=False):
        result.draw(name, axes)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of a layout that collapses
        assert not [*faults(figure)]


@pytest.mark.parametrize("columns", [1, 2])
def test_a_budget_can_be_read(columns):
    """Labels are whole, whatever changes."""
    case, values = rpscli.load_case(SIX), {quantity.name: 1.0 for quantity in LIMITED}
    change = "superstructure.damping.ratio 0.03 in place of 0.05, and of all that follows from it"
    rows = [
        BudgetRow(
            "damping",
            change,
            "",
            "survived",
            {n: k * v for n, v in values.items()},
            "a",
            "",
        )
        for k in (1.0, 1.4, 2.6)
    ]
    made = Budget(case, rows)
    assert not printed(made.figure, columns)
    axes, *_ = style.drawn(made.figure, Look(columns=columns)).axes
    label = axes.get_yticklabels()[1].get_text().replace("\n", " ")
    assert label == f"damping: {change}"
