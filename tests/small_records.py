"""Small files in the layouts of the agencies."""

VALUES = [1.5, -2.25, 30.125, -4.5, 5.0, 6.0, -7.0, 8.0, 9.0, -10.0, 11.0, 12.0]
PEAK = 30.125


def fixed(values, width, form):
    cells = [form.format(value) for value in values]
    return "\n".join("".join(cells[i : i + width]) for i in range(0, len(cells), width))


def csmip(channels=(1,), peak=PEAK, names=()):
    text = []
    for number, name in zip(channels, names or ["90 DEG"] * len(channels), strict=True):
        body = fixed([VALUES[0] + number - channels[0], *VALUES[1:]], 8, "{:10.3f}")
        text += [
            f"CORRECTED ACCELEROGRAM   36456-S4384-83123.01   CHAN {number:2d}:  {name}     FROM",
            "UNCORRECTED ACCELEROGRAM DATA              PROCESSED:  6/06/83",
            "AN EARTHQUAKE",
            "MAY 2, 1983 16:42 PDT                   (ORIGIN(BRK): 05/02/83, 23:42:38.5 UTC)",
            "36456-S4384-83123.01               TRIGGER TIME: 05/02/83, 16:42:48.2 PDT",
            "STATION NO. 36456   35.908N, 120.458W     SMA-1  S/N 4384",
            "HYPOCENTER(BRK): 36.25N,120.28W, H=9KM. PRELIMINARY SOLUTION.  ML=6.5(BRK)",
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


def cosmos(title="Corrected acceleration", interval=20.0):
    reals = [-999.0] * 100
    reals[33], reals[61], reals[63] = 0.005, interval, -PEAK
    return "\n".join(
        [
            f"{title}    (Format v01.20 with 13 text lines) Src: file",
            "Record of An Earthquake of Fri Nov 30, 2018 17:29 UTC",
            "Hypocenter: 61.34640 -149.95520 H= 46km ML=6.8, Mw=7.0",
            "Origin: 2018/11/30 17:29:29    UTC",
            "Statn No: 02-008040 Code:NP-8040   USGS  AK:Anchorage;R B Atwood Bld",
            "text",
            "text",
            "Rcrd start time: 2018/11/30 17:29:06.332 UTC (Q=5) RcrdId: (see comment)",
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


def knet():
    counts = [round(value * 1000) + 7000 for value in VALUES]
    peak = max(abs(count - sum(counts) / 12) for count in counts) / 1000
    return "\n".join(
        [
            "Origin Time       2014/12/31 23:49:00",
            *["Key               value"] * 3,
            "Mag.              5.1",
            "Station Code      CHB002",
            *["Key               value"] * 3,
            "Record Time       2014/12/31 23:49:20",
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


def esm(kind="ACCELERATION", count=12, units="cm/s^2"):
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
        "EVENT_TIME_HHMMSS: 160908",
        "MAGNITUDE_W: ",
        "MAGNITUDE_L: 4.6",
        "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: 20190728_160905.700",
    ]
    return "\n".join([*header, *(f"{value:.6f}" for value in VALUES)])


def smc(title="2 CORRECTED ACCELEROGRAM"):
    integers = [-32768] * 48
    integers[15], integers[16] = 2, 12
    reals = [1.7e38] * 50
    reals[1], reals[29], reals[31] = 50.0, PEAK, -10.0
    cells = [f"{value:11.4E}" for value in VALUES]
    glued = "".join(
        cell.replace("E+0", "E+").replace("E-0", "E-").rjust(10) for cell in cells
    )
    return "\n".join(
        [
            title.ljust(80),
            *["*"] * 2,
            "     1989  10  18    0004 Somewhere",
            "Moment Mag=      7.1 Ms=      7.1 Ml=      7.0",
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


def geonet(components=("S16W",)):
    text = []
    for component in components:
        text += [
            "Corrected accelerogram 2018_WPWS_20 GNS Science",
            "Site WPWS      39 56 38S",
            *["text"] * 3,
            "Accelerogram 20180212_211554_WPWS_20                 Processed 2018 February 21",
            "6 km south of Waipukurau",
            "2018 February 12         21:15:54 UT",
            "Epicentre  40 03 27S 176 32 45E  Bearing S15W  Dist   13km  Depth    9km M  4.17",
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


def write(folder, text, name):
    (folder / name).write_bytes(text.replace("\n", "\r\n").encode("latin-1"))
    return str(folder / name)
