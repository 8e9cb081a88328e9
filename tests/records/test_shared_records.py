"""Real files, where they are at hand: RPS_RECORDS names a folder with `fema_p695/MANIFEST.csv`
and `formats/`."""

import csv
import hashlib
import os
from pathlib import Path

import numpy as np
import pytest

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.loading import expand_sources, load_record

FOLDER = Path(os.environ.get("RPS_RECORDS", "/nonexistent"))
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="RPS_RECORDS names no folder")


def test_every_file_of_the_manifest():
    with (FOLDER / "fema_p695" / "MANIFEST.csv").open(
        newline="", encoding="utf-8"
    ) as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 99
    assert len(expand_sources([str(FOLDER / "fema_p695" / "far_field")])) == 44
    for row in rows:
        path = FOLDER / "fema_p695" / row["file"]
        assert hashlib.sha256(path.read_bytes()).hexdigest() == row["sha256"]
        peer = row["format"].startswith("PEER AT2")
        dt = float(row["dt_s"]) if row["format"].startswith("one column") else None
        made = load_record(str(path), dt=dt, units=None if peer else "g")
        assert (made.npts, made.dt) == (int(row["npts"]), float(row["dt_s"]))
        # The manifest prints five decimals.
        assert made.pga / STANDARD_GRAVITY == pytest.approx(
            float(row["pga_g"]), abs=0.51e-5
        )
        rounded = made.dt in {0.0039, 0.0024}
        assert len(made.warnings) == int(rounded)


@pytest.mark.parametrize(
    ("source", "form", "npts", "dt", "pga"),
    [
        # Peaks as printed in the headers, in m/s2.
        ("0111a.smc", "SMC", 6001, 0.005, 1.044078),
        ("Cosmos12TimeSeriesTest.v1", "COSMOS v1", 7000, 0.01, 1.61962),
        ("ce36456p_CE36456.V2?channel=1", "CSMIP volume 2", 3251, 0.02, 2.67957),
        ("ce36456p_CE36456.V2?channel=2", "CSMIP volume 2", 3250, 0.02, 0.94805),
        ("ce36456p_CE36456.V2?channel=3", "CSMIP volume 2", 3250, 0.02, 2.56231),
        ("CHB0021412312349.NS", "K-NET ASCII", 6800, 0.01, 0.03868),
        ("NGNH311106302345.EW2", "K-NET ASCII", 12000, 0.01, 0.00708),
        (
            "HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC",
            "ESM ASCII",
            13876,
            0.005,
            0.00227973,
        ),
        ("20180212_211557_WPWS_20.V2A?channel=1", "GeoNet volume 2", 5800, 0.02, 0.0416),
        ("20180212_211557_WPWS_20.V2A?channel=2", "GeoNet volume 2", 5800, 0.02, 0.1940),
        ("20180212_211557_WPWS_20.V2A?channel=3", "GeoNet volume 2", 5800, 0.02, 0.0273),
        (
            "elCentro.txt?units=g",
            "two-column text",
            1559,
            0.02,
            0.31882 * STANDARD_GRAVITY,
        ),
        ("elcentro_NS_trunc.dat?units=m/s2", "two-column text", 1560, 0.02, 3.1276),
    ],
)
def test_samples_of_formats(source, form, npts, dt, pga):
    made = load_record(source, folder=FOLDER / "formats")
    assert (made.format, made.npts) == (form, npts)
    assert made.dt == pytest.approx(dt, rel=1e-12)
    assert made.pga == pytest.approx(pga, rel=2e-4, abs=6e-6)  # the headers' last digits
    assert not any("header says" in warning for warning in made.warnings)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("NP8040-n.1000hyfh.HNE.01.V0c", "Raw acceleration counts"),
        ("18_RIODELL270.txt?dt=0.02&units=g", "look like a header"),
        ("20180212_211557_WPWS_20.V2A", "1: S16W; 2: S74E; 3: Up"),
        ("elCentro.txt", "does not state the units"),
        ("../fema_p695/far_field/NGA_no_829_RIO360.txt", "units"),
        ("README.md", "no known format"),
    ],
)
def test_samples_that_are_refused(source, message):
    with pytest.raises(RecordError, match=message):
        load_record(source, folder=FOLDER / "formats")


def test_two_copies_of_el_centro_agree():
    one = load_record("elCentro.txt?units=g", folder=FOLDER / "formats")
    other = load_record("elcentro_NS_trunc.dat?units=m/s2", folder=FOLDER / "formats")
    # The second begins with an added zero and took g = 9.81 m/s2.
    np.testing.assert_allclose(
        other.acceleration[1:], one.acceleration * 9.81 / STANDARD_GRAVITY, atol=1e-6
    )
