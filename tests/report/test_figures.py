"""Figures as a user asks for them: films, formats, widths, fonts; the same for the same result."""

import io
import os
import re
import shutil
import sys
import warnings
from functools import partial
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

from report.small_results import CURVED, FLAT, KINDS, drawn, structure
from rpscli.analyses.modal import modal
from rpscli.errors import OutputError, UsageError
from rpscli.report.figures import style
from rpscli.report.figures.history import rotation_figure, shown_floors
from rpscli.report.figures.look import USUAL, FilmRequest, Look, read_style
from rpscli.tools.animation.film import frame_plan, modes_film


def test_a_figure_depends_on_its_result_alone():
    result = KINDS["rolls"]()
    draw = partial(rotation_figure, result, "title")
    first = style.picture(draw, USUAL, "png")
    with mpl.rc_context({"lines.linewidth": 9.0, "axes.facecolor": "black"}):
        assert style.picture(draw, USUAL, "png") == first


def test_floors_in_the_figure_are_floors_of_the_building():
    for storeys in range(60):
        floors = shown_floors(storeys)
        assert len(floors) == min(storeys, 3)
        assert all(1 <= floor <= storeys for floor in floors)
        assert not floors or floors[0] == storeys


@pytest.mark.parametrize("kind", KINDS)
def test_an_animation_shows_the_motion_from_its_first_to_its_last(kind):
    result = KINDS[kind]()
    samples, speed = frame_plan(result, FilmRequest(Path("film.gif")))
    assert 2 <= len(samples) <= 180  # 9 s
    assert (np.diff(samples) >= 0).all()
    assert samples[-1] < len(result.trace.time)
    shown = np.abs(result.trace.rotation[samples[0] : samples[-1] + 1])
    assert shown.max() == np.abs(result.trace.rotation).max()
    assert speed > 0.0


def test_speed_and_part_of_an_animation_are_those_that_were_asked_for():
    result = KINDS["rolls"]()
    time = result.trace.time
    wanted = FilmRequest(Path("film.gif"), speed=0.5, first=0.2, last=0.8)
    samples, speed = frame_plan(result, wanted)
    assert len(samples) == 24  # 0.6 s take 1.2 s
    assert speed == pytest.approx(0.5)
    shown = time[samples[[0, -1]]]
    np.testing.assert_allclose(shown, (0.2, 0.8), atol=float(time[1]))
    to_the_end, _ = frame_plan(result, FilmRequest(Path("film.gif"), speed=1.0, last=1e9))
    assert to_the_end[-1] == len(time) - 1


@pytest.mark.parametrize(
    ("file", "wishes", "says"),
    [
        ("film.gif", {"first": 1e9}, "before the end at"),
        ("film.gif", {"speed": 1e-4}, "3000 are the most"),
        ("film.avi", {}, "must end with .gif or .mp4"),
        ("film.gif", {"first": 2.0, "last": 1.0}, "--animate-to 1 must be later than"),
        ("film.gif", {"last": 0.0}, "later than --animate-from 0"),
    ],
)
def test_a_film_that_cannot_be_is_refused(file, wishes, says):
    with pytest.raises(UsageError, match=says):
        frame_plan(KINDS["rolls"](), FilmRequest(Path(file), **wishes))


def test_mp4_needs_its_encoder(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UsageError, match=r"needs the program ffmpeg.*or write film\.gif"):
        FilmRequest(Path("film.mp4"))


def test_mp4_is_what_its_ending_says(monkeypatch, tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    shutil.copy(
        ffmpeg.get_ffmpeg_exe(), tmp_path / f"ffmpeg{'.exe' * (sys.platform == 'win32')}"
    )
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    file = tmp_path / "film.mp4"
    drawn = []
    # An odd width, which the format does not know.
    film = modes_film(
        modal(structure(CURVED, 1)),
        "title",
        FilmRequest(file, 241),
        progress=lambda done, _: drawn.append(done),
    )
    file.write_bytes(film)
    assert film[4:8] == b"ftyp"
    assert drawn == list(range(1, 61))
    assert ffmpeg.count_frames_and_secs(str(file)) == (60, pytest.approx(2.0))


@pytest.mark.skipif(sys.platform == "win32", reason="a script is no program there")
def test_an_encoder_that_fails_is_told(monkeypatch, tmp_path):
    broken = tmp_path / "ffmpeg"
    broken.write_text("#!/bin/sh\nexit 3\n")
    broken.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    with pytest.raises(OutputError, match="ffmpeg could not make the film"):
        modes_film(modal(structure(FLAT, 0)), "title", FilmRequest(Path("film.mp4")))


def drawn_as(ending, look=USUAL, title="title"):
    return style.picture(partial(rotation_figure, KINDS["rolls"](), title), look, ending)


def test_each_format_is_what_its_ending_says_and_the_same_for_the_same_data():
    files = {ending: drawn_as(ending) for ending in ("png", "svg", "pdf")}
    assert files["png"].startswith(b"\x89PNG")
    assert files["pdf"].startswith(b"%PDF")
    assert b"<svg" in files["svg"]
    assert {ending: drawn_as(ending) for ending in files} == files


@pytest.mark.parametrize(("columns", "inches"), [(1, 3.5), (2, 7.0)])
def test_a_figure_fills_columns_of_a_journal(columns, inches):
    width, _ = Image.open(io.BytesIO(drawn_as("png", Look(columns=columns)))).size
    assert width == pytest.approx(inches * style.DPI, abs=1)
    found = re.search(rb'width="([\d.]+)pt"', drawn_as("svg", Look(columns=columns)))
    assert found is not None
    assert float(found[1]) == pytest.approx(72.0 * inches)


def test_a_style_file_goes_over_ours(tmp_path):
    file = tmp_path / "paper.mplstyle"
    file.write_text(
        "font.family: serif\nfont.size: 12\nfigure.figsize: 5, 9\nlines.linewidth: 3\n"
    )
    figure = drawn(
        rotation_figure, KINDS["rolls"](), "title", look=Look(style=read_style(file))
    )
    assert figure.get_figwidth() == 5.0
    assert figure.get_figheight() != 9.0  # each figure knows how high it must be
    axes = figure.axes[1]
    label = axes.yaxis.label
    assert label.get_fontsize() == 12.0
    assert label.get_fontfamily() == ["serif"]
    assert axes.yaxis.get_ticklabels()[0].get_fontsize() == pytest.approx(
        12.0 * 8.0 / 9.0
    )
    assert 3.0 in {line.get_linewidth() for line in axes.lines}


def test_text_of_svg_is_text_with_fonts_to_fall_back_on():
    found = drawn_as("svg", title="Six storeys").decode()
    assert ">Six storeys   |   " in found
    assert "time [s]</text>" in found
    families = re.findall(r'font-family: ([^;"]*)', found)
    assert len(families) > 20
    assert all(family.startswith("'DejaVu Sans'") for family in families)
    assert all(family.endswith(", sans-serif") for family in families)


def test_a_style_says_nothing_of_windows_and_little_of_other_files(tmp_path):
    file = tmp_path / "paper.mplstyle"
    file.write_text("backend: TkAgg\nlines.markersize: 3\n")
    assert style.drawable_style(file) == {"lines.markersize": 3.0}
    file.write_text("the first line, 'secret'\nthe second: secret\n")
    with pytest.raises(UsageError) as caught:
        style.drawable_style(file)
    assert "secret" not in str(caught.value)


CANNOT = r"paper.mplstyle: cannot be drawn with: .*correct"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("font.siize: 9\n", "font.siize"),
        ("font.size: large as life\n", "font.size"),
        (None, "No such file"),
        (b"\xff\xfe\x00", "is not a text"),
        ("axes.prop_cycle: cycler(color=['101010'])\n", "prop_cycle is gone: .* rpscli.figures"),
        ("axes.prop_cycle: cycler('color', ['#332288'])\n", "prop_cycle is gone"),
        ("axes.edgecolor: #332288\n", "write colours without it"),
        ("figure.dpi: 1e9", CANNOT), ("figure.figsize: 1e5, 1e5", CANNOT),
        ("font.size: 1e6", CANNOT), ("savefig.format: exe", CANNOT),
        ("figure.subplot.left: 2", CANNOT), ("font.family: nosuchfont", CANNOT),
    ],
)  # fmt: skip
def test_a_style_that_is_nonsense_is_blamed_before_anything_is_computed(
    tmp_path, text, reason, capfd
):
    file = tmp_path / "paper.mplstyle"
    if text is not None:
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(UsageError, match=reason):
        style.drawable_style(file)
    assert capfd.readouterr() == ("", "")


def test_letters_that_the_font_lacks_and_formulas_that_are_none_make_no_noise(capfd):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert drawn_as("png", title="地震 \x07 costs 5 $ or \\frac" + 200 * "x")
    assert capfd.readouterr() == ("", "")
