"""Small files in the layouts of the agencies; real ones are read in test_shared_records.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from small_records import VALUES, cosmos, csmip, esm, geonet, knet, smc, write

from rpscli.errors import RecordError
from rpscli.records.formats import FORMATS, contents
from rpscli.records.formats.record_text import read_text
from rpscli.records.loading import load_record


@pytest.mark.parametrize(
    ("text", "name", "form", "resolution"),
    [
        (csmip(), "a.V2", "CSMIP volume 2", 1e-12),
        (cosmos(), "a.v1", "COSMOS v1", 1e-12),
        (esm(), "a.ASC", "ESM ASCII", 1e-12),
        (smc(), "a.smc", "SMC", 5e-5),  # four decimals of the mantissa
        (geonet(), "a.V2A", "GeoNet volume 2", 0.5e-2),  # 0.1 mm/s2
    ],
)
@pytest.mark.parametrize("named", [True, False])
def test_reads(
    tmp_path: Path, text: str, name: str, form: str, resolution: float, *, named: bool
) -> None:
    path = write(tmp_path, text, name if named else "record")
    made = load_record(path)
    assert made.format == form
    assert made.dt == pytest.approx(0.02, rel=1e-12)
    np.testing.assert_allclose(made.acceleration * 100.0, VALUES, atol=resolution, rtol=1e-4)
    assert made.warnings == ()
    assert contents(Path(path))


def test_knet_is_centred_and_says_so(tmp_path: Path) -> None:
    made = load_record(write(tmp_path, knet(), "CHB002.NS"))
    centred = np.array(VALUES) - np.mean(VALUES)
    # Counts are whole: half of 0.001 gal.
    np.testing.assert_allclose(made.acceleration * 100.0, centred, atol=6e-4)
    assert made.dt == 0.02
    assert made.name == "CHB002_NS"
    assert "mean of 11.9" in made.description
    assert "removed" in made.description
    assert made.warnings == ()


def test_a_channel_is_chosen_by_its_number(tmp_path: Path) -> None:
    path = write(tmp_path, csmip((4, 6)), "a.V2")
    with pytest.raises(RecordError, match=r"2 channels.*\?channel=4.*4: 90 DEG; 6: 90 DEG"):
        load_record(path)
    with pytest.raises(RecordError, match="no channel 5; the file has 4: 90 DEG; 6"):
        load_record(f"{path}?channel=5")
    made = load_record(f"{path}?channel=6")
    assert (made.npts, made.name) == (12, "a_ch6")
    assert load_record(f"{write(tmp_path, geonet(('N', 'Up')), 'a.V2A')}?channel=2").npts == 12
    with pytest.raises(RecordError, match="channel 1 comes 2 times"):
        load_record(f"{write(tmp_path, csmip((1, 1)), 'b.V2')}?channel=1")


def test_a_peak_that_differs_from_the_header_is_a_warning(tmp_path: Path) -> None:
    made = load_record(write(tmp_path, csmip(peak=31.0), "a.V2"))
    assert "peak at 30.125 and the header says 31" in made.warnings[0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (cosmos("Raw acceleration counts"), "'Raw acceleration counts'.*only corrected"),
        (cosmos("Velocity"), "'Velocity.*only corrected acceleration"),
        (cosmos(interval=-999.0), "value 62, the sampling interval"),
        (cosmos().replace("cm/sec2", "counts"), "no line announces acceleration values"),
        (
            cosmos().replace("   12  acc", "   19  acc"),
            "announces 19 values, and 12 stand before '/&  -",
        ),
        (csmip().replace(" 12 POINTS OF ACCEL", " 11 POINTS OF ACCEL"), "11 values, and"),
        (csmip().replace("ACCEL DATA", "SOME DATA"), "no line announces the acceleration data"),
        (
            "Uncorrected Accelerogram Data\n   200 Accelerogram points at 200 pts/sec, in g/10\n",
            r"uncorrected accelerogram \(volume 1\)",
        ),
        (esm("VELOCITY"), "the file holds velocity"),
        (esm(count=13), "announces 13 values, and 12 stand"),
        (esm(units="cm"), "UNITS says 'cm', which is not a unit of acceleration"),
        (esm().replace("NDATA: 12", "NDATA:"), "the header lacks NDATA"),
        (smc("3 VELOCITY"), "only '2 CORRECTED ACCELEROGRAM'"),
        (smc("1 UNCORRECTED ACCELEROGRAM"), "only '2 CORRECTED ACCELEROGRAM'"),
        (smc().replace("        12", "     -9999"), "the headers give -9999 values"),
        (
            knet().replace("50Hz", "fast"),
            "rec.any:11: .*Sampling Freq.* = 'fast'|lacks Sampling Freq",
        ),
        (geonet().replace("at 0.020 sec", "as sampled"), "lacks the number of points"),
    ],
)
def test_refuses(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        load_record(write(tmp_path, text, "rec.any"))


def test_only_one_format_recognises_each_layout(tmp_path: Path) -> None:
    for make in (csmip, cosmos, esm, smc, geonet, knet):
        text = read_text(Path(write(tmp_path, make(), "rec")), "rec")
        matching = [form.name for form in FORMATS.values() if form.recognises(text)]
        assert [name for name in matching if name != "columns"][1:] == []
        assert matching[0] != "columns"
