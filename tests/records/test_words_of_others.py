"""What headers, titles and names of files say in words that no list of ours was made from."""

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.loading import expanded, load_record
from rpscli.records.recordings import clusters
from rpscli.records.target import load_target
from rpscli.records.words import says_structure
from rpscli.sweep.statistics.hazard import read_hazard

COUNT = 800
TIMES = 0.01 * np.arange(COUNT)
VALUES = 0.2 * np.sin(21.0 * TIMES) * np.sin(np.pi * TIMES / TIMES[-1])
VALUES *= 0.2 / np.abs(VALUES).max()
USUAL = "# dt: 0.01 s\n# Acceleration in g"


def write(folder, *lines, name="a.txt", head=USUAL, values=VALUES):
    """A record under lines of a header; its path."""
    above = [each for each in (head, *(f"# {line}" for line in lines)) if each]
    rows = [f"{value:.9e}" for value in values]
    path = folder / name
    path.write_text("\n".join([*above, *rows]) + "\n", encoding="utf-8")
    return str(path)


OTHER_QUANTITIES = [
    "data type: VEL", "quantity: ground velocity", "type = disp", "vitesse du sol", "hiz kaydi",
    "скорость, см/с", "Geschwindigkeit", "sebesseg", "kine", "Verschiebung", "desplazamiento",
    "变位", "quantity: strain", "Einheit: mV", "unidades: cuentas", "counts",
]  # fmt: skip
CURVES = [
    "応答スペクトル", "spectral ordinates", "transfer function", "autocorrelation", "Eigenvalues",
    "cyclic loading protocol", "pushover curve", "GMPE median",
]  # fmt: skip
FACTORS = [
    "reduced by 1/3", "1/4 amplitude", "times two", "factored", "adjusted to 0.4g PGA",
    "run at 80 % level", "dimensionless", "規格化", "放大2倍", "Faktor: zwei", "squared",
    "mise a l'echelle", "in hundredths of g", "aceleracion en porcentaje de g",
    "Acceleration in g, per mille",
]  # fmt: skip


@pytest.mark.parametrize("line", [*OTHER_QUANTITIES, *CURVES, *FACTORS])
def test_another_quantity_curve_or_factor_is_refused_unless_the_user_says_what_a_value_is(
    line, tmp_path
):
    path = write(tmp_path, line)
    with pytest.raises(RecordError, match=r"\?units=1 g|\?columns=|acceleration record"):
        load_record(path)
    assert load_record(f"{path}?units=1 g&dt=0.01").pga == pytest.approx(0.2 * 9.80665)


@pytest.mark.parametrize(
    "line",
    [
        "matched to the spectrum of EC8", "spectrum-compatible accelerogram", "baseline adjusted",
        "Peak velocity: 12 cm/s", "filtered 0.1-25 Hz", "M 6.5, R = 12 km", "5 % damping",
        "data type: acceleration", "Created by SeismoSignal 2018", "Station: Disp Creek",
        "Event: Velocity Peak", "Initial velocity = 0.0 cm/s", "reduced data", "signal: ACC",
    ],
)  # fmt: skip
def test_words_beside_the_matter_are_read(line, tmp_path):
    motion = load_record(write(tmp_path, line))
    assert motion.pga == pytest.approx(0.2 * 9.80665)
    assert not motion.recording.in_borehole


@pytest.mark.parametrize(
    "name",
    ["RSN1_spectrum.txt", "fourier_amp.txt", "FAS.txt", "rec_vel.txt", "husid.txt"],
)
def test_a_name_of_another_quantity_is_refused(name, tmp_path):
    path = write(tmp_path, name=name)
    with pytest.raises(RecordError, match=r"its name says .*\?units=1 g"):
        load_record(path)
    assert load_record(f"{path}?units=1 g").dt == 0.01
    write(tmp_path, name="whole.txt")
    found, notes = expanded([str(tmp_path)])
    assert len(found) == 1
    assert name in notes[0]


@pytest.mark.parametrize(
    "lines",
    [
        ["dt=0.02 s orig; 0.01 s now"], ["original dt 0.005 s"], ["dt of instrument 0.005 s"],
        ["dt=0.005 s", "every second sample kept"], ["dt: 0.01", "time in minutes"],
        ["dt = 10 000 µs"], ["dt=0·01 s"],
    ],
)  # fmt: skip
def test_a_step_with_its_unit_counts_whatever_the_file_says(lines, tmp_path):
    path = write(tmp_path, "Acceleration in g", *lines, head="")
    with pytest.raises(RecordError):
        load_record(path)
    assert load_record(f"{path}?dt=0.01 s").dt == 0.01


@pytest.mark.parametrize(
    "line",
    [
        "Fs: 0.1 kHz", "dt: 10^-2 s", "Samples per second: 100", "samples/s: 100",
        "Scan rate: 100 scans/s", "rate = 100 points/sec", "Zeitschritt 0,01 sek.",
        "dt: 10000 us", "ndata: 800\n# dt: 0.01 s", "last sample at 7.99 s\n# dt: 0.01 s",
    ],
)  # fmt: skip
def test_steps_and_rates_in_further_words(line, tmp_path):
    motion = load_record(write(tmp_path, "Acceleration in g", line, head=""))
    assert motion.dt == pytest.approx(0.01, rel=1e-12)


WITH_METADATA = [
    "NPTS=800", "doi:10.1007/978-94-007-0152-6_8", "RESIF-RAP, network (licence CC BY 4.0)",
    "地震: 2016年熊本地震 本震 M7.3", "台站: 051WCW 卧龙", "#Data: 2F10.3", "git commit 3f2a9c1",
    "Title: 1940 El Centro, N-S component", "Mo = 1.2e19 Nm", "Z1.0 = 36 m", "f0 = 1.2 Hz",
    "Signal-to-noise ratio > 3 between 0.1 and 35 Hz", "Revision 3 of 12.05.2019",
    "Event 4 of 7", "Northridge earthquake of January 17, 1994", "Imperial Valley 06",
    "realization 3", "max 0,200 g", "maximum 1,96133 m/s2", "max. Beschleunigung 0,20 g",
    "Target spectrum: EC8 type 1, ag=0.25g", "Sensor: Episensor, 2 g full scale, S/N 1234",
]  # fmt: skip


@pytest.mark.parametrize("line", WITH_METADATA)
def test_metadata_do_not_stand_in_the_way(line, tmp_path):
    path = write(tmp_path, head=f"Acceleration [g], dt = 0.01 s\n{line}")
    motion = load_record(path)
    assert motion.pga == pytest.approx(0.2 * 9.80665)
    assert motion.warnings == ()


@pytest.mark.parametrize(
    ("line", "unit"),
    [
        ("acc (gal), 100 Hz", "cm/s2"), ("Zeitschritt 0.01 s, Beschleunigung in m/s2", "m/s2"),
        ("Aceleración en cm/s2, intervalo de muestreo 0.01 s", "cm/s2"),
        ("Tidssteg: 0.01 s. Akselerasjon i m/s2", "m/s2"),
        ("Accélération en m/s2, pas de 0.01 s", "m/s2"),
        ("acc in m/s2; dt=0.01 s", "m/s2"), ("gals, dt=0.01 s", "cm/s2"),
        ("800 points of accel data equally spaced at 0.010 sec, in cm/sec2", "cm/s2"),
    ],
)  # fmt: skip
def test_a_unit_and_a_step_in_one_line(line, unit, tmp_path):
    path = write(tmp_path, head=line)
    motion = load_record(path)
    assert motion.dt == pytest.approx(0.01)
    size = {"cm/s2": 0.01, "m/s2": 1.0}[unit]
    assert motion.pga == pytest.approx(0.2 * size)
    with pytest.raises(RecordError, match="contradicts the file"):
        load_record(f"{path}?units=g")


@pytest.mark.parametrize(
    "line", ["SI units", "mètres par seconde carrée", "values times 1e-3", "values x 1000",
             "1.5 x DBE", "peak-normalised", "intensity level 50 %", "rectified", "speed",
             "pore pressure [kPa]", "digital counts (24 bit)", "sensitivity 2.5 V/g"],
)  # fmt: skip
def test_further_words_that_bear_on_values(line, tmp_path):
    path = write(tmp_path, head=f"Acceleration [g], dt = 0.01 s\n{line}")
    with pytest.raises(RecordError):
        load_record(path)
    assert load_record(f"{path}?units=1 g&dt=0.01").npts == COUNT


def test_a_curve_without_negative_values_is_no_motion(tmp_path):
    curve = 0.2 + 0.3 * np.exp(-TIMES) * np.abs(np.sin(TIMES))
    path = write(tmp_path, values=curve)
    with pytest.raises(RecordError, match=r"no value is negative.*\?units=1 g"):
        load_record(path)
    # A pulse of one sign begins at rest.
    assert load_record(write(tmp_path, values=np.abs(VALUES))).npts == COUNT


@pytest.mark.parametrize(
    "names",
    [
        "AQV_E AQV_N AQK_E AQK_N AQA_E AQA_N", "YPT-NS YPT-EW IZT-NS IZT-EW SKR-NS SKR-EW",
        "GM1_x GM1_y GM2_x GM2_y GM3_x GM3_y", "kobe_H1 kobe_H2 bamm_H1 bamm_H2 gazl_H1 gazl_H2",
        "rp72_1 rp72_2 rp475_1 rp475_2 rp2475_1 rp2475_2", "EQ1 EQ2 EQ3", "gm2 gm5 gm7",
        "seed_1 seed_2 seed_3", "Smith_run1 Smith_run2 Smith_run3", "DBE MCE SLE",
        "RP0072 RP0475 RP2475", "Case1_surface Case2_surface Case3_surface", "E1 E2 E3 N1 N2 N3",
        "RSN143_TABAS_TAB-L1 RSN143_TABAS_TAB-T1", "Pacoima_Dam_E Pacoima_Dam_N",
    ],
)  # fmt: skip
def test_sets_and_pairs_of_three_are_read(names, tmp_path):
    every = names.split()
    found, notes = folder_of(tmp_path, *every, lengths=(0, 0, 0))
    assert len(found) == len(every)
    assert not notes


def test_three_factors_on_one_motion_are_read(tmp_path):
    for factor in (1, 2, 3):
        write(tmp_path, name=f"kobe_{factor}.txt", values=0.1 * factor * VALUES)
    found, notes = expanded([str(tmp_path)])
    assert len(found) == 3
    assert "the same samples times a factor" in notes[0]


def test_a_number_of_values_with_a_comma(tmp_path):
    values = np.concatenate([VALUES, VALUES])
    path = write(tmp_path, "ndata: 1,600", values=values)
    assert load_record(path).npts == 1600


@pytest.mark.parametrize(
    "line",
    ["duration 40 s", "Dauer: 15,99 s", "Record length (s) 3.995", "end time: 20 s",
     "time span: 0-30 s", "1600 values"],
)  # fmt: skip
def test_durations_and_counts_of_other_motions_are_told(line, tmp_path):
    (warning,) = load_record(write(tmp_path, line)).warnings
    assert "the header says" in warning
    for right in ("duration: 8 s", "Duration (s): 7.99", "significant duration 3.2 s"):
        assert not load_record(write(tmp_path, right)).warnings


@pytest.mark.parametrize(
    ("stamp", "step"),
    [
        (lambda t: f"02.01.2020 03:04:{5 + t:09.6f}", 0.01),
        (lambda t: f"04:{5 + t:06.3f}", 0.01),
    ],
)
def test_time_stamps_of_spreadsheets(stamp, step, tmp_path):
    rows = [f"{stamp(t)};{value:.9e}" for t, value in zip(TIMES, VALUES, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Zeit;Beschleunigung [g]", *rows]), encoding="utf-8")
    assert load_record(str(path)).dt == pytest.approx(step)


def folder_of(tmp_path, *names, lengths=(0, 1, 2)):
    """Motions that differ, of lengths that differ a little."""
    for k, name in enumerate(names):
        values = (np.sign(VALUES) * np.abs(VALUES) ** (k + 1))[
            : COUNT - 5 * lengths[k % 3]
        ]
        write(tmp_path, name=f"{name}.txt", values=values)
    return expanded([str(tmp_path)])


@pytest.mark.parametrize(
    "names",
    ["a_E-W a_N-S a_U-D", "a.E-W a.N-S a.U-D", "E-W N-S U-D", "a_E_W a_N_S a_U_D",
     "a_W-E a_S-N a_D-U", "q_este q_norte q_cenit"],
)  # fmt: skip
def test_an_axis_in_two_letters(names, tmp_path):
    found, notes = folder_of(tmp_path, *names.split())
    assert len(found) == 2
    assert "vertical components left out" in notes[0]


@pytest.mark.parametrize(
    "names",
    ["a_E-W a_N-S a_Z-Z", "a_E-O a_N-S a_H-B", "st_X st_Y st_W", "X1 Y1 W1 X2 Y2 W2",
     "q_N q_E q_H", "q090 q000 q-90", "q_T q_R q_L", "q_comp1 q_comp2 q_comp3",
     "q_N_filt q_E_filt q_A_filt"],
)  # fmt: skip
def test_a_third_component_is_asked_for(names, tmp_path):
    with pytest.raises(RecordError, match="neither names nor headers tell"):
        folder_of(tmp_path, *names.split())


IN_STRUCTURES = [
    "Installation: sous-sol", "Location: pylon cap", "Sensor: crest of dam", "Lage: 5. OG",
    "Location: zemin kat", "Position: Dachgeschoss", "设置: 地下室", "Location: pier top P3",
    "Sensor elevation above ground: 24.5 m", "Location: B2F", "Location: RF",
    "Ubicazione: copertura", "Structure: 6-story RC building", "Location: Level 12",
    "Ubicacion: azotea", "Emplacement: toit", "Sensor height: 45 m",
]  # fmt: skip


@pytest.mark.parametrize("line", IN_STRUCTURES)
def test_an_instrument_in_a_structure(line, tmp_path):
    assert load_record(write(tmp_path, line)).recording.in_borehole


@pytest.mark.parametrize(
    "line",
    [
        "Site: basement rock", "Station: Roof Butte, AZ", "Station: Borehole Road School",
        "Location: Los Angeles", "Location: Pierce Hall", "Location: free field",
        "Location: Tower Bridge Road", "Sensor: K2 accelerograph", "Location code: 10",
    ],
)  # fmt: skip
def test_an_instrument_on_the_ground(line, tmp_path):
    assert not load_record(write(tmp_path, line)).recording.in_borehole


def test_names_of_files_in_structures(tmp_path):
    names = "st_10F_E ABC_crest_E ABC_L12_E ABC_dach_E ABC_pier_E ABC_B1F_E ABC_toit_E"
    found, notes = folder_of(tmp_path, *names.split(), "ABC_ff_E")
    assert len(found) == 1
    assert "in buildings or in boreholes" in notes[0]
    assert not says_structure("Tower Street")


SAME = [
    "Origin time: 2011-02-03T13:05:06+09:00", "Origin time: 2011-02-03 07:05:06 MSK",
    "Origin time: 2011-02-03 07:35:06 IRST", "Origin time: 2011-02-03 4:05:06 AM",
    "Origin time (local): 2011-02-03 07:05:06", "Origin time: 2011.034 04:05:06",
    "Epoch origin: 1296705906", "Origin time: 03/02/2011 04:05:06",
    "Origin date: 3-FEB-2011\n# Origin time: 04:05:06", "Date: 2011-02-03\n# Time: 04:05:06",
    "Fecha: 03/02/2011\n# Hora: 04:05:06", "Earthquake date: 3 Feb 2011",
    "Heure origine: 3 février 2011 04h05m06s", "Event time (UTC): 2011-02-03 04.05.06",
    "Время в очаге: 03.02.2011 04:05:06", "Herdzeit: 03.02.2011 04:05:06",
    "Oluş zamanı: 03.02.2011 04:05:06", "発震時: 2011年02月03日 13時05分06秒 JST",
]  # fmt: skip
APART = [
    "Origin time: 2011-02-03 16:05:06", "Origin time: 2011-02-03 4:05:06 PM",
    "Event: Mw 7.1, depth 30 km", "Start time: 2011-02-03 04:05:06",
    "Converted: 2011-02-03 04:05:06", "Origin time: 2011-02-04 04:05:06",
]  # fmt: skip


@pytest.mark.parametrize(
    ("line", "count"), [*((line, 1) for line in SAME), *((line, 2) for line in APART)]
)
def test_an_earthquake_by_the_time_that_files_state(line, count, tmp_path):
    write(tmp_path, "Origin time: 2011-02-03 04:05:06", name="one.txt")
    write(tmp_path, line, name="two.txt")
    assert len({*clusters(["one.txt", "two.txt"], tmp_path, "events")}) == count


@pytest.mark.parametrize(
    ("one", "other", "count"),
    [
        ("EventID=us7000013", "Event ID: us7000013", 1),
        ("EventID=us7000013", "EventID=us7000014", 2),
        ("Event: Mw 6.5, depth 10 km", "Event: Mw 7.1, depth 30 km", 2),
    ],
)
def test_an_earthquake_by_its_number(one, other, count, tmp_path):
    write(tmp_path, one, name="one.txt")
    write(tmp_path, other, name="two.txt")
    assert len({*clusters(["one.txt", "two.txt"], tmp_path, "events")}) == count


@pytest.mark.parametrize(
    ("titles", "words"),
    [
        ("period [s],16% [g],50% [g],84% [g]", "one spectrum is wanted"),
        ("time [s],acceleration [g]", "not understood: time"),
        ("# vertical component\nperiod [s],Sa [g]", "says 'vertical'"),
        ("# normalised to PGA = 1\nperiod [s],Sa [g]", "says 'normalis'"),
        ("# 10% damping\nperiod [s],Sa [g]", "damp"),
    ],
)
def test_targets_that_may_be_others(titles, words, tmp_path):
    path = tmp_path / "target.csv"
    more = ",0.2" * (titles.splitlines()[-1].count(",") - 1)
    path.write_text(f"{titles}\n0.1,0.3{more}\n1,0.2{more}\n", encoding="utf-8")
    with pytest.raises(RecordError, match=words):
        load_target(str(path))


def test_a_target_as_spreadsheets_of_western_europe_write_it(tmp_path):
    path = tmp_path / "target.csv"
    text = "# amorti à 5 %\nPériodes [s];Accélération [g]\n0,1;0,3\n1;0,2\n"
    path.write_bytes(text.encode("latin-1"))
    assert load_target(str(path)).span == (0.1, 1.0)


@pytest.mark.parametrize(
    "remark", ["rates times 1000", "probability of exceedance", "50 yr exceedance"]
)
def test_hazards_that_may_be_others(remark, tmp_path):
    path = tmp_path / "hazard.csv"
    path.write_text(f"# {remark}\nPGA [g],rate [1/year]\n0.1,0.01\n0.2,0.001\n", "utf-8")
    with pytest.raises(Exception, match="and the column is taken as rates a year"):
        read_hazard(path, "PGA")


def test_a_table_of_which_one_title_is_not_understood(tmp_path):
    for heads in ("acc roof [g],acc ground [g]", "acc E-W [g],acc U-D [g]"):
        rows = [
            f"{t:.2f},{a:.9e},{a * a:.9e}" for t, a in zip(TIMES, VALUES, strict=True)
        ]
        path = tmp_path / "a.csv"
        path.write_text("\n".join([f"Time [s],{heads}", *rows]), encoding="utf-8")
        with pytest.raises(RecordError, match=r"say which one by \?channel=2"):
            load_record(str(path))
    found, notes = expanded([str(tmp_path)])
    assert [each.rpartition("=")[2] for each in found] == ["2"]
    assert "vertical components left out" in notes[0]


def test_uncorrected_values_are_left_out_of_folders(tmp_path):
    path = write(tmp_path, "Uncorrected acceleration", name="first.txt")
    write(tmp_path, "corrected", name="whole.txt")
    found, notes = expanded([str(tmp_path)])
    assert [each.rpartition("/")[2] for each in found] == ["whole.txt"]
    assert "first.txt" in notes[0]
    (warning,) = load_record(path).warnings
    assert "uncorrected" in warning


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("quake_x2.txt", "'x2'"), ("0.5x-quake.txt", "'0.5x'"), ("q_normalised.txt", "norm"),
        ("quake_gal.txt", "'gal'"), ("q-mps2.txt", "'mps2'"), ("uncorrected_EW.txt", "corrected"),
    ],
)  # fmt: skip
def test_a_name_that_says_other_values_than_are_read_is_told(name, said, tmp_path):
    path = write(tmp_path, name=name)
    (warning,) = load_record(path).warnings
    assert said in warning
    assert load_record(f"{path}?units=1 g&dt=0.01").warnings == ()


@pytest.mark.parametrize("name", ["q_g.txt", "acc_x_1.txt", "q_x1.txt", "GX_mod.txt"])
def test_a_name_that_says_nothing_else_is_read_without_a_word(name, tmp_path):
    assert load_record(write(tmp_path, name=name)).warnings == ()
