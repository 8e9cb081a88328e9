"""Figures as a user asks for them: formats, widths, fonts."""

from __future__ import annotations

import io
import re
import warnings
from functools import partial
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from PIL import Image

from report.small_results import KINDS, drawn
from rpscli.errors import UsageError
from rpscli.report.figures import style
from rpscli.report.figures.history import rotation_figure
from rpscli.report.figures.look import USUAL, Look, read_style


def drawn_as(ending: str, look: Look = USUAL, title: str = "title") -> bytes:
    return style.picture(partial(rotation_figure, KINDS["rolls"](), title), look, ending)


def test_each_format_is_what_its_ending_says_and_the_same_for_the_same_data() -> None:
    files = {ending: drawn_as(ending) for ending in ("png", "svg", "pdf")}
    assert files["png"].startswith(b"\x89PNG")
    assert files["pdf"].startswith(b"%PDF")
    assert b"<svg" in files["svg"]
    assert {ending: drawn_as(ending) for ending in files} == files


def test_formats_become_files() -> None:
    def draw(figure: Figure) -> None:
        figure.subplots().set_axis_off()

    files = style.figure_files({"a": draw}, Look(("svg", "pdf")))
    assert list(files) == ["a.svg", "a.pdf"]
    assert files["a.pdf"]().startswith(b"%PDF")
    assert list(style.figure_files({"a": draw}, USUAL)) == ["a.png"]
    assert style.figure_files({"a": draw}, Look(())) == {}


@pytest.mark.parametrize(("columns", "inches"), [(1, 3.5), (2, 7.0)])
def test_a_figure_fills_columns_of_a_journal(columns: int, inches: float) -> None:
    width, _ = Image.open(io.BytesIO(drawn_as("png", Look(columns=columns)))).size
    assert width == pytest.approx(inches * style.DPI, abs=1)
    found = re.search(rb'width="([\d.]+)pt"', drawn_as("svg", Look(columns=columns)))
    assert found is not None
    assert float(found[1]) == pytest.approx(72.0 * inches)


def test_a_style_file_goes_over_ours(tmp_path: Path) -> None:
    file = tmp_path / "paper.mplstyle"
    file.write_text("font.family: serif\nfont.size: 12\nfigure.figsize: 5, 9\nlines.linewidth: 3\n")
    figure = drawn(rotation_figure, KINDS["rolls"](), "title", look=Look(style=read_style(file)))
    assert figure.get_figwidth() == 5.0
    assert figure.get_figheight() != 9.0  # each figure knows how high it must be
    axes = figure.axes[1]
    label = axes.yaxis.label
    assert label.get_fontsize() == 12.0
    assert label.get_fontfamily() == ["serif"]
    assert axes.yaxis.get_ticklabels()[0].get_fontsize() == pytest.approx(12.0 * 8.0 / 9.0)
    assert 3.0 in {line.get_linewidth() for line in axes.lines}


def test_text_of_svg_is_text_with_fonts_to_fall_back_on() -> None:
    found = drawn_as("svg", title="Six storeys").decode()
    assert ">Six storeys   |   " in found
    assert "time [s]</text>" in found
    families = re.findall(r'font-family: ([^;"]*)', found)
    assert len(families) > 20
    assert all(family.startswith("'DejaVu Sans'") for family in families)
    assert all(family.endswith(", sans-serif") for family in families)


@pytest.mark.parametrize(
    "text",
    [
        "figure.dpi: 1e9", "figure.figsize: 1e5, 1e5", "font.size: 1e6",
        "savefig.format: exe", "figure.subplot.left: 2", "font.family: nosuchfont",
    ],
)  # fmt: skip
def test_a_style_that_cannot_be_drawn_is_blamed_before_anything_is_computed(
    tmp_path: Path, text: str, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "paper.mplstyle"
    file.write_text(text)
    with pytest.raises(UsageError, match=r"paper.mplstyle: cannot be drawn with: .*correct"):
        style.drawable_style(file)
    assert capfd.readouterr() == ("", "")


def test_a_style_says_nothing_of_windows_and_little_of_other_files(tmp_path: Path) -> None:
    file = tmp_path / "paper.mplstyle"
    file.write_text("backend: TkAgg\nlines.markersize: 3\n")
    assert style.drawable_style(file) == {"lines.markersize": 3.0}
    file.write_text("the first line, 'secret'\nthe second: secret\n")
    with pytest.raises(UsageError) as caught:
        style.drawable_style(file)
    assert "secret" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("font.siize: 9\n", "font.siize"),
        ("font.size: large as life\n", "font.size"),
        (None, "No such file"),
        (b"\xff\xfe\x00", "is not a text"),
        ("axes.prop_cycle: cycler(color=['101010'])\n", "prop_cycle is gone: .* rpscli.figures"),
    ],
)
def test_a_style_file_that_says_nonsense_is_refused(
    tmp_path: Path, text: str | bytes | None, reason: str, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "paper.mplstyle"
    if text is not None:
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(UsageError, match=reason):
        read_style(file)
    assert capfd.readouterr() == ("", "")


def test_letters_that_the_font_lacks_make_no_noise(capfd: pytest.CaptureFixture[str]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert drawn_as("png", title="地震 \x07 six storeys")
    assert capfd.readouterr() == ("", "")
