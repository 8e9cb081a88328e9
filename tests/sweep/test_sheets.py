"""Figures of many systems: panels beside series, and sheets of at most a page."""

import io
import warnings

import pytest
from matplotlib.figure import Figure
from PIL import Image

from rpscli.report.figures.look import Look
from rpscli.report.figures.style import PAGE, WIDTH
from rpscli.report.study.panels import MOST_PANELS, in_sheets
from rpscli.report.study.registry import REPORTS
from sweep.small_studies import ALPHA, RHO, STUDY, fallen, made

SLENDERNESS = [0.1, 0.12, 0.14, 0.16]
TWELVE = STUDY.replace(
    f"{ALPHA}: [0.10, 0.15]\n    podium.bearing.wedge_slenderness: [0.20, 0.30]",
    f"{ALPHA}: {SLENDERNESS}\n    podium.bearing.wedge_slenderness: [0.2, 0.2, 0.3, 0.3]",
).replace("scale: [0.5, 1.0]", "scale: [0.25, 0.5, 0.75, 1.0]")
COLUMN = 89.0  # mm
DOTS = 150  # to an inch, of our PNG files


def answer(point):
    """Slender columns overturn sooner; those of flat ends never."""
    demand = point["scale"] * point["record"] / (40.0 * point[ALPHA] ** 2)
    falls = demand > 4.0 and point[RHO] != 0
    return fallen(falls, rotation_ratio=demand / 10, max_base_shear=1e3, max_rotation=0.1)


def found_of(study_of, report, text=TWELVE):
    results = made(study_of, answer, text=f"{text}reports: [{report}]\n")
    (request,) = results.table.layout.study.reports
    return REPORTS[request.kind].make(results, request.options)


def millimetres(png):
    return [25.4 * pixels / DOTS for pixels in Image.open(io.BytesIO(png)).size]


@pytest.mark.parametrize("columns", [1, 2])
@pytest.mark.parametrize(
    "report",
    [
        "fragility: {resamples: 0}",
        "ida",
        f"lines: {{x: scale, result: max_rotation, panels: [{ALPHA}, {RHO}]}}",
        "overturning: {columns: record}",
        "rotation: {panels: [scale, record]}",
    ],
)
def test_a_file_is_at_most_a_page_high(study_of, report, columns):
    found = found_of(study_of, report)
    files = dict(found.files("x", "Twelve systems", Look(("png",), columns)))
    pictures = [name for name in files if name.endswith(".png")]
    numbers = range(2, len(pictures) + 1)
    assert pictures == ["x.png", *(f"x_sheet_{number}.png" for number in numbers)]
    assert len(pictures) > 1 or columns == 2
    for name in pictures:
        width, height = millimetres(files[name]())
        assert width <= 179.0
        assert height <= 240.5


def test_sheets_have_all_panels_once_in_their_order(study_of):
    found = found_of(study_of, "ida")
    whole = [axes.get_title() for axes in drawn(found.figure("t")) if axes.axison]
    sheets = found.sheets(Look(columns=1))
    titles = []
    for number, sheet in enumerate(sheets, start=1):
        figure = figure_of(sheet("t"))
        assert f"sheet {number} of {len(sheets)}" in figure.get_suptitle()
        titles += [axes.get_title() for axes in figure.axes if axes.axison]
    assert len(sheets) == 2
    assert len(titles) == 12
    assert [t.replace("\n", " ") for t in titles] == whole


def figure_of(draw, size=(WIDTH, 40.0)):
    figure = Figure(figsize=size, layout="constrained")
    draw(figure)
    return figure


def drawn(draw):
    return figure_of(draw).axes


@pytest.mark.parametrize("count", [1, 5, 8, 9, 16, 17, 35, 100])
@pytest.mark.parametrize("columns", [1, 2, 3])
def test_sheets_are_pages_and_about_as_long(count, columns):
    parts = in_sheets(count, columns, 2.1, 1.0)
    assert [n for part in parts for n in range(count)[part]] == list(range(count))
    rows = [-(-(part.stop - part.start) // columns) for part in parts]
    assert all(1.0 + 2.1 * each <= PAGE for each in rows)
    assert max(rows) - min(rows) < max(2, len(parts))
    fits = int((PAGE - 1.0) / 2.1) * columns
    assert len(parts) == -(-count // fits)


def test_beyond_the_most_panels_a_sheet_says_so(study_of):
    found = found_of(study_of, f"rotation: {{panels: [{RHO}, record, scale]}}", TWELVE)
    assert MOST_PANELS == 36
    assert len(found.figure.panels) == 36
    more = TWELVE.replace("[0.25, 0.5, 0.75, 1.0]", "[0.2, 0.4, 0.6, 0.8, 1.0]")
    found = found_of(study_of, f"rotation: {{panels: [{RHO}, record, scale]}}", more)
    sheets = found.sheets()
    assert sum(len(sheet.panels) for sheet in sheets) == 36
    assert all("the first 36 of 45 panels" in sheet.note for sheet in sheets)


def test_rows_of_a_sheet_begin_with_their_whole_name(study_of):
    """Names go on from the row before, but not from the sheet before."""
    for sheet in found_of(study_of, "overturning: {columns: record}").sheets(
        Look(columns=1)
    ):
        assert sheet.names[0] == sheet.whole[0]
        assert sheet.names[0].startswith("tan α = ")
    assert sheet.part == "sheet 3 of 3"


@pytest.mark.parametrize("series", ["", f", series: {ALPHA}"])
def test_fragilities_have_panels_beside_series(study_of, series):
    """Columns of flat ends never overturn: their panel stays in its place."""
    report = f"fragility: {{resamples: 0, panels: {RHO}{series}, limits: {{rotation_ratio: 9}}}}"
    found = found_of(study_of, report)
    axes = {each.get_title(): each for each in drawn(found.figure("t"))}
    assert [*axes] == [
        f"{state}, {name}"
        for state in ("rotation ratio > 9", "overturning")
        for name in ("critical ρ", "ρ = 0.5", "flat ends")
    ]
    empty = axes["overturning, flat ends"]
    assert not empty.lines
    assert [text.get_text() for text in empty.texts] == ["no curve"]
    full = axes["overturning, critical ρ"]
    names = [line.get_label() for line in full.lines if line.get_label()[0] != "_"]
    assert {*names} <= {f"tan α = {value:g}" for value in SLENDERNESS}
    assert len(names) > 1
    colours = {line.get_label(): line.get_color() for line in full.lines}
    other = {
        line.get_label(): line.get_color() for line in axes["overturning, ρ = 0.5"].lines
    }
    assert all(colours[name] == other[name] for name in names)
    fits = {column.name: column.values for column in found.tables[""]}
    assert len(fits[RHO]) == 24


def test_a_risk_has_panels_beside_series(study_of, workplace):
    curve = "PGV [m/s],rate [1/year]\n0.01,0.1\n0.1,0.01\n1,0.0001\n"
    (workplace / "hazard.csv").write_text(curve, encoding="utf-8")
    text = TWELVE.replace("scale: [", "scale: {measure: PGV, values: [").replace(
        "0.75, 1.0]", "0.75, 1.0]}"
    )
    report = f"risk: {{resamples: 0, panels: {RHO}, hazard: {{file: hazard.csv, measure: PGV}}}}"
    found = found_of(study_of, report, text)
    axes = drawn(found.figure("t"))
    assert [each.get_title() for each in axes] == ["critical ρ", "ρ = 0.5", "flat ends"]
    assert [text.get_text() for text in axes[2].texts] == ["no rate"]
    assert len(axes[0].patches) > 1


def test_an_ida_has_series_beside_panels(study_of):
    """Medians of the panels are those of the file."""
    found = found_of(study_of, f"ida: {{panels: {ALPHA}, series: {RHO}}}")
    axes = drawn(found.figure("t"))
    assert [each.get_title() for each in axes] == [f"tan α = {v:g}" for v in SLENDERNESS]
    columns = {column.title: column.values for column in found.tables[""]}
    rows = [
        median
        for alpha, rho, median in zip(
            columns[f"{ALPHA} [-]"],
            columns[f"{RHO} [-]"],
            columns["rotation_ratio_50 [-]"],
            strict=True,
        )
        if (alpha, rho) == (0.16, 0)
    ]
    (line,) = [line for line in axes[-1].lines if line.get_label() == "flat ends"]
    assert line.get_xdata()[1:] == pytest.approx(rows)


@pytest.mark.parametrize("rows", [12, 16])
def test_a_table_in_a_figure_of_somebody_has_all_rows_that_fit(study_of, rows):
    """Second texts give way before rows do."""
    text = TWELVE if rows == 16 else TWELVE.replace("0.5, 0.75, 1.0]", "0.5, 1.0]")
    found = found_of(study_of, f"overturning: {{rows: [{ALPHA}, scale]}}", text)
    figure = figure_of(found.figure("t"), (6.4, 4.8))
    assert len(figure.axes[0].get_yticks()) == rows
    assert f"of {rows} rows" not in figure.get_suptitle()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.draw_without_rendering()
