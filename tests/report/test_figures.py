"""Figures: drawn for every kind of result, the same for the same result."""

from __future__ import annotations

import os
import shutil
import sys
from functools import partial
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from report.small_results import CURVED, FLAT, KINDS, structure
from rpscli.analyses.modal import modal
from rpscli.errors import OutputError, UsageError
from rpscli.report.figures import style
from rpscli.report.figures.animation import frame_plan, modes_film
from rpscli.report.figures.history import rotation_figure, shown_floors
from rpscli.report.figures.look import USUAL, FilmRequest


def test_a_figure_depends_on_its_result_alone() -> None:
    result = KINDS["rolls"]()
    draw = partial(rotation_figure, result, "title")
    first = style.picture(draw, USUAL, "png")
    with mpl.rc_context({"lines.linewidth": 9.0, "axes.facecolor": "black"}):
        assert style.picture(draw, USUAL, "png") == first


def test_a_title_is_no_formula() -> None:
    draw = partial(rotation_figure, KINDS["at rest"](), r"costs 5 $ or \frac$" + 200 * "x")
    assert style.picture(draw, USUAL, "png")


def test_floors_in_the_figure_are_floors_of_the_building() -> None:
    for storeys in range(60):
        floors = shown_floors(storeys)
        assert len(floors) == min(storeys, 3)
        assert all(1 <= floor <= storeys for floor in floors)
        assert not floors or floors[0] == storeys


@pytest.mark.parametrize("kind", KINDS)
def test_an_animation_shows_the_motion_from_its_first_to_its_last(kind: str) -> None:
    result = KINDS[kind]()
    samples, speed = frame_plan(result, FilmRequest(Path("film.gif")))
    assert 2 <= len(samples) <= 180  # 9 s
    assert (np.diff(samples) >= 0).all()
    assert samples[-1] < len(result.trace.time)
    shown = np.abs(result.trace.rotation[samples[0] : samples[-1] + 1])
    assert shown.max() == np.abs(result.trace.rotation).max()
    assert speed > 0.0


def test_speed_and_part_of_an_animation_are_those_that_were_asked_for() -> None:
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
    ("wishes", "says"),
    [
        ({"first": 1e9}, "before the end at"),
        ({"speed": 1e-4}, "3000 are the most"),
    ],
)
def test_a_part_that_is_not_there_is_refused(wishes: dict[str, float], says: str) -> None:
    with pytest.raises(UsageError, match=says):
        frame_plan(KINDS["rolls"](), FilmRequest(Path("film.gif"), **wishes))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("file", "wishes", "says"),
    [
        ("film.avi", {}, "must end with .gif or .mp4"),
        ("film.gif", {"first": 2.0, "last": 1.0}, "--animate-to 1 must be later than"),
        ("film.gif", {"last": 0.0}, "later than --animate-from 0"),
    ],
)
def test_a_film_that_cannot_be_is_refused(file: str, wishes: dict[str, float], says: str) -> None:
    with pytest.raises(UsageError, match=says):
        FilmRequest(Path(file), **wishes)  # type: ignore[arg-type]


def test_mp4_needs_its_encoder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UsageError, match=r"needs the program ffmpeg.*or write film\.gif"):
        FilmRequest(Path("film.mp4"))


def test_mp4_is_what_its_ending_says(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    shutil.copy(ffmpeg.get_ffmpeg_exe(), tmp_path / f"ffmpeg{'.exe' * (sys.platform == 'win32')}")
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    file = tmp_path / "film.mp4"
    drawn: list[int] = []
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
def test_an_encoder_that_fails_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    broken = tmp_path / "ffmpeg"
    broken.write_text("#!/bin/sh\nexit 3\n")
    broken.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    with pytest.raises(OutputError, match="ffmpeg could not make the film"):
        modes_film(modal(structure(FLAT, 0)), "title", FilmRequest(Path("film.mp4")))
