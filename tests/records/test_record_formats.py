"""Small files in the layouts of the agencies; real ones are read in test_shared_records.py."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.formats.record_text import read_text
from rpscli.records.formats.registry import FORMATS, is_record
from rpscli.records.source import load_record

VALUES = [1.5, -2.25, 30.125, -4.5, 5.0, 6.0, -7.0, 8.0, 9.0, -10.0, 11.0, 12.0]
PEAK = 30.125


def fixed(values: Sequence[float], width: int, form: str) -> str:
    cells = [form.format(value) for value in values]
    return "\n".join("".join(cells[i : i + width]) for i in range(0, len(cells), width))


def csmip(channels: tuple[int, ...] = (1,), peak: float = PEAK) -> str:
    body = fixed(VALUES, 8, "{:10.3f}")
    text = []
    for number in channels:
        text += [
            f"CORRECTED ACCELEROGRAM   36456-S4384-83123.01   CHAN {number:2d}:  90 DEG     FROM",
            "UNCORRECTED ACCELEROGRAM DATA              PROCESSED:  6/06/83",
            "AN EARTHQUAKE",
            "a date",
            "a trigger",
            "STATION NO. 36456",
            "A STATION",
            f"PEAK ACCELERATION =  {-peak:.3f}    CM/SEC/SEC  AT   10.940   SEC.",
            "    1    1    1",
            " 12 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)",
            body,
            " 12 POINTS OF VELOC DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC)",
            body,
            f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------",
        ]
    return "\n".join(text) + "\n\x1a\x1a"


def cosmos(title: str = "Corrected acceleration", interval: float = 20.0) -> str:
    reals = [-999.0] * 100
    reals[33], reals[61], reals[63] = 0.005, interval, -PEAK
    return "\n".join(
        [
            f"{title}    (Format v01.20 with 13 text lines) Src: file",
            *["text"] * 7,
            "Sta Chan  3: 340 deg (Rcrdr Chan  1) Location: roof",
            *["text"] * 4,
            " 100 Integer-header values follow on  10 lines, Format= (10I8)",
            fixed([1] * 100, 10, "{:8d}"),
            " 100 Real-header values follow on  17 lines, Format= (6F13.6)",
            fixed(reals, 6, "{:13.6f}"),
            '  1 Comment line(s) follow, each starting with a "|":',
            " | a comment",
            "     12  acceleration pts, approx    0 secs, units=cm/sec2(04),Format=(8F10.5)",
            fixed(VALUES, 8, "{:10.5f}"),
            "/&  ----------  End of data for channel  1  ----------",
        ]
    )


def knet() -> str:
    counts = [round(value * 1000) + 7000 for value in VALUES]
    peak = max(abs(count - sum(counts) / 12) for count in counts) / 1000
    return "\n".join(
        [
            "Origin Time       2014/12/31 23:49:00",
            *["Key               value"] * 4,
            "Station Code      CHB002",
            *["Key               value"] * 4,
            "Sampling Freq(Hz) 50Hz",
            "Duration Time(s)  0.24",
            "Dir.              N-S",
            "Scale Factor      2000(gal)/2000000",
            f"Max. Acc. (gal)   {peak:.3f}",
            "Last Correction   2014/12/31 23:49:59",
            "Memo.             ",
            fixed(counts, 8, "{:8d} "),
        ]
    )


def esm(kind: str = "ACCELERATION", count: int = 12, units: str = "cm/s^2") -> str:
    header = [
        "EVENT_NAME: AN EVENT",
        "EVENT_DATE_YYYYMMDD: 20190728",
        "NETWORK: HL",
        "STATION_CODE: DLFA",
        "SAMPLING_INTERVAL_S: 0.020000",
        f"NDATA: {count}",
        "STREAM: HNE",
        f"UNITS: {units}",
        f"PGA_CM/S^2: {PEAK:.6f}",
        f"DATA_TYPE: {kind}",
        "USER1: ",
    ]
    return "\n".join([*header, *(f"{value:.6f}" for value in VALUES)])


def smc(title: str = "2 CORRECTED ACCELEROGRAM") -> str:
    integers = [-32768] * 48
    integers[15], integers[16] = 2, 12
    reals = [1.7e38] * 50
    reals[1], reals[29], reals[31] = 50.0, PEAK, -10.0
    cells = [f"{value:11.4E}" for value in VALUES]
    glued = "".join(cell.replace("E+0", "E+").replace("E-0", "E-").rjust(10) for cell in cells)
    return "\n".join(
        [
            title.ljust(80),
            *["*"] * 2,
            "     1989  10  18    0004 Somewhere",
            "mag",
            "station = A Station   component=    360",
            *["*"] * 5,
            fixed(integers, 8, "{:10d}"),
            fixed(reals, 5, "{:15.7E}"),
            "|",
            "| a comment 1 2 3",
            glued[:80],
            glued[80:],
        ]
    )


def geonet(components: tuple[str, ...] = ("S16W",)) -> str:
    text = []
    for component in components:
        text += [
            "Corrected accelerogram 2018_WPWS_20 GNS Science",
            "Site WPWS      39 56 38S",
            *["text"] * 5,
            "2018 February 12         21:15:54 UT",
            "Epicentre",
            "Number of points  12    Duration 0.22 sec",
            "Instrument corrected data at 0.020 sec intervals",
            "Band-pass filter",
            f"Component {component}  Longitudinal Accelerometer Axis",
            f"Acceleration:  peak    {PEAK * 10:.1f} mm/s/s at  43.68 sec     rms      2.2 mm/s/s",
            "Velocity:      peak     1.65 mm/s   at  43.56 sec     rms     0.09 mm/s",
            "Displacement:  peak    0.131 mm     at  43.66 sec     rms    0.007 mm",
            fixed([0] * 40, 10, "{:8d}"),
            fixed([0.0] * 60, 10, "{:8.2f}"),
            fixed([10 * value for value in VALUES], 10, "{:8.1f}"),
            fixed(VALUES, 10, "{:8.3f}"),
            fixed(VALUES, 10, "{:8.3f}"),
        ]
    return "\n".join(text)


def write(folder: Path, text: str, name: str) -> str:
    (folder / name).write_bytes(text.replace("\n", "\r\n").encode("latin-1"))
    return str(folder / name)


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
    assert is_record(Path(path))


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
        (cosmos().replace("   12  acc", "   19  acc"), "found 12 of the 19 values"),
        (csmip().replace(" 12 POINTS OF ACCEL", " 11 POINTS OF ACCEL"), "11 values, but there are"),
        (csmip().replace("ACCEL DATA", "SOME DATA"), "no line announces the acceleration data"),
        (esm("VELOCITY"), "the file holds velocity"),
        (esm(count=13), "announces 13 values, but there are 12"),
        (esm(units="cm"), "UNITS: cm is no unit of acceleration"),
        (esm().replace("NDATA: 12", "NDATA:"), "the header lacks NDATA"),
        (smc("3 VELOCITY"), "only '2 CORRECTED ACCELEROGRAM'"),
        (smc("1 UNCORRECTED ACCELEROGRAM"), "only '2 CORRECTED ACCELEROGRAM'"),
        (smc().replace("        12", "     -9999"), "the headers give -9999 values"),
        (knet().replace("50Hz", "fast"), "lacks the scale factor, the sampling rate"),
        (geonet().replace("at 0.020 sec", "as sampled"), "lacks the number of points"),
    ],
)
def test_refuses(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        load_record(write(tmp_path, text, "rec.any"))


@pytest.mark.parametrize("make", [csmip, cosmos, esm, smc, geonet, knet])
def test_contradicting_options_are_refused(tmp_path: Path, make: Callable[[], str]) -> None:
    path = write(tmp_path, make(), "rec.any")
    with pytest.raises(RecordError, match="units = g contradicts the file"):
        load_record(f"{path}?units=g")
    with pytest.raises(RecordError, match=r"dt = 0\.01 s contradicts the file"):
        load_record(f"{path}?dt=0.01")


def test_only_one_format_recognises_each_layout(tmp_path: Path) -> None:
    for make in (csmip, cosmos, esm, smc, geonet, knet):
        text = read_text(Path(write(tmp_path, make(), "rec")), "rec")
        matching = [form.name for form in FORMATS if form.recognises(text)]
        assert [name for name in matching if name != "columns"][1:] == []
        assert matching[0] != "columns"
