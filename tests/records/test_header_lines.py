"""Headers by their values, in any language: units, factors, steps, peaks, directions."""

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.directions import direction_of, directions_of
from rpscli.records.families import direction_by_name
from rpscli.records.formats.at2 import at2_text
from rpscli.records.formats.titles import title_of
from rpscli.records.loading import expanded, load_components, load_record
from rpscli.records.quantities import ACCELERATIONS, canonical_unit
from rpscli.records.recordings import clusters
from rpscli.records.target import load_target
from rpscli.report.motions import two_column_text

TIMES = 0.005 * np.arange(200)
VALUES = 0.2 * np.sin(2.0 * np.pi * TIMES) * np.sin(np.pi * TIMES) ** 2 / 0.6
PEAK = float(f"{np.abs(VALUES).max():.6f}")


def power(exponent):
    """Motions that differ: powers with the sign of the values."""
    return np.sign(VALUES) * np.abs(VALUES) ** exponent


def series(*heads, values=VALUES):
    return "\n".join([*heads, *(f"{x:.6f}" for x in values)]) + "\n"


def table(heads, *columns):
    rows = zip(*columns, strict=True)
    return "\n".join([heads, *(",".join(f"{x:.6f}" for x in row) for row in rows)]) + "\n"


def read(tmp_path, text, options="", name="rec.txt"):
    (tmp_path / name).write_text(text, encoding="utf-8")
    return load_record(f"{tmp_path / name}{options}")


def folder(tmp_path, **texts):
    for name, text in texts.items():
        (tmp_path / f"{name}.txt").write_text(text, encoding="utf-8")
    return expanded([f"{tmp_path}"])


@pytest.mark.parametrize(
    ("spelling", "size"),
    [
        ("mg", 9.80665e-3), ("milli g", 9.80665e-3), ("g/1000", 9.80665e-3), ("% g", 0.0980665),
        ("% of g", 0.0980665), ("CMS/SEC/SEC", 0.01), ("м/с²", 1.0), ("см/с/с", 0.01),
        ("m·s⁻²", 1.0), ("cm/sn2", 0.01), ("m s^-2", 1.0), ("гал", 0.01), ("ガル", 0.01),
    ],
)  # fmt: skip
def test_units_of_one_table(spelling, size):
    assert ACCELERATIONS[canonical_unit(spelling)] == pytest.approx(size, rel=1e-12)


@pytest.mark.parametrize("spelling", ["kg", "mgal", "g/count", "m/s", "cm/\u04552", "µg"])
def test_what_is_no_unit_of_acceleration(spelling):
    assert canonical_unit(spelling) is None


@pytest.mark.parametrize(
    "line",
    [
        "eenheid: gal", "Mertekegyseg = cm/s2", "μονάδα: gal", "jednostka: m/s2", "Unit,gal",
        "m/s2", "amplitudes in gal", "values [cm/s2]", "acc in mg", "enhet: %g",
    ],
)  # fmt: skip
def test_a_unit_under_any_key_is_compared(line, tmp_path):
    text = series("dt: 0.005", "units: g", line)
    with pytest.raises(RecordError, match="contradicts"):
        read(tmp_path, text)
    assert read(tmp_path, text, "?units=1 g").pga == pytest.approx(9.80665 * PEAK)
    assert read(tmp_path, series("dt: 0.005", line)).npts == VALUES.size  # and taken


@pytest.mark.parametrize(
    "line",
    [
        "Vergrotingsfaktor 0.5", "kerroin: 2", "szorzo = 0.25", "współczynnik: 10",
        "modulus: 981", "xyz: 3.5", "Masstab 1:1000", "sf,0.5", "LSB: 0.1 g", "bias 0.3 V",
        "number of points 800", "Antal punkter: 800", "divided by 10", "normalizzato",
        "масштабировано", "values were doubled", "x 2", "0.5 times as recorded", "# 0.5",
    ],
)  # fmt: skip
@pytest.mark.parametrize("mark", ["", "# "])
def test_what_is_not_understood_is_refused_and_one_option_cures_it(line, mark, tmp_path):
    text = series("# dt: 0.005", "# units: g", f"{mark}{line}")
    with pytest.raises(RecordError, match=r"not understood.*\?units=1 g|factor on the"):
        read(tmp_path, text)
    assert read(tmp_path, text, "?units=1 g").pga == pytest.approx(9.80665 * PEAK)


@pytest.mark.parametrize(
    "line",
    [
        "Latitude: 40.71", "Enlem: 40.71", "Broj zapisa / record no: 17", "Magnitud: 7.4",
        "Entfernung (km): 12.5", "Vs30 = 276", "corner frequency: 0.1 Hz", "filtre ordre 4",
        "serial: 1234", "date: 1999-08-17", "Saat: 00:01:38", "damping 0.7", "Tiefe 17 km",
        "Kocaeli 1999", "sample 1 of 1", "Duration: 1 s", "200 Hz", "scale factor: 1",
        "PGV: 45.3 cm/s", "trigger level 0.01 g", "full range: 2 g", "npts 200",
        "1 g = 9.81 m/s2", "El Centro, Imperial Valley, 5/18/1940, 180", "unscaled",
    ],
)  # fmt: skip
def test_what_does_not_bear_on_the_values_is_read(line, tmp_path):
    motion = read(tmp_path, series("# dt: 0.005", "# units: g", f"# {line}"))
    assert motion.pga == pytest.approx(9.80665 * PEAK)
    assert motion.warnings == ()


@pytest.mark.parametrize(
    "line",
    [
        "Abtastrate: 200 Hz", "frecuencia de muestreo 200 Hz", "Örnekleme aralığı: 5 ms",
        "Zeitschritt 0.005 s", "passo di campionamento = 0.005", "шаг: 0,005 с", "pas: 5 ms",
        "サンプリング周波数: 200Hz", "200 samples/s", "sps 200", "dt: 0.005 sn",
    ],
)  # fmt: skip
def test_steps_in_other_languages(line, tmp_path):
    assert read(tmp_path, series(line, "units: g")).dt == pytest.approx(0.005, rel=1e-12)
    with pytest.raises(RecordError, match=r"contradicts|not understood"):
        read(tmp_path, series(line, "units: g"), "?dt=0.01")


@pytest.mark.parametrize(
    ("words", "unit", "size"),
    [
        ("huippukiihtyvyys:", "gal", 980.665), ("szczytowe przysp. =", "m/s2", 9.80665),
        ("maks. ivme", "mg", 1000.0), ("Piek", "%g", 100.0), ("nejvyšší:", "cm/s2", 980.665),
    ],
)  # fmt: skip
def test_stated_peaks_in_other_words(words, unit, size, tmp_path):
    right = f"{words} {size * PEAK:.5g} {unit}"
    assert read(tmp_path, series("dt: 0.005", "units: g", right)).warnings == ()
    wrong = f"{words} {2.5 * size * PEAK:.5g} {unit}"
    (doubt,) = read(tmp_path, series("dt: 0.005", "units: g", wrong)).warnings
    assert "the values peak at" in doubt


@pytest.mark.parametrize("line", ["raw data", "unkorrigiert", "sin corregir"])
def test_uncorrected_values_are_told(line, tmp_path):
    (doubt,) = read(tmp_path, series("dt: 0.005", "units: g", line)).warnings
    assert "give the corrected record" in doubt


UPRIGHT = [
    "Kierunek: pionowy", "směr: svislý", "Richtung: senkrecht", "sensor: Verticale",
    "YÖN: DÜŞEY", "成分: 上下", "направление: вертикальное", "Kanal 3: lodret", "cmpinc: 180",
    "azimuth: 0 dip: -90", "ch 3 VERTICAL", "Z", "comp (vertical): UD", "eje: Z",
]  # fmt: skip


@pytest.mark.parametrize("line", UPRIGHT)
def test_verticals_under_any_key_are_left_out(line, tmp_path):
    found, notes = folder(
        tmp_path,
        one=series("component: 0 deg", "dt: 0.005", "units: g"),
        two=series("component: 90 deg", "dt: 0.005", "units: g", values=VALUES[::-1]),
        three=series(line, "dt: 0.005", "units: g", values=0.6 * VALUES**2),
    )
    assert len(found) == 2
    assert "three.txt" in notes[0]


@pytest.mark.parametrize(
    "line", ["site class: D", "Zone: Z", "station: Up", "soil type: D", "rec 200 Hz"]
)
def test_other_values_are_no_directions(line, tmp_path):
    motion = read(tmp_path, series(line, "dt: 0.005", "units: g"))
    assert not motion.recording.is_vertical


@pytest.mark.parametrize(
    "words",
    [("p", "q", "r"), ("k1", "k2", "k3"), ("HL1", "HL2", "HL3"), ("ch01", "ch02", "ch03"),
     ("090", "N", "uvw"), ("000", "180", "W")],
)  # fmt: skip
def test_three_of_one_length_are_asked_for(words, tmp_path):
    texts = {
        f"STA_{word}": series("dt: 0.005", "units: g", values=power(k + 1))
        for k, word in enumerate(words)
    }
    with pytest.raises(
        RecordError, match=r"(?s)vertical.*\.\.\.-UP, or name the records"
    ):
        folder(tmp_path, **texts)


@pytest.mark.parametrize(
    "words",
    [("nord", "est", "alto"), ("sever", "vychod", "svisle"), ("h1", "h2", "Vertikalna"),
     ("00", "90", "updn"), ("tozai", "nanboku", "jouge")],
)  # fmt: skip
def test_the_vertical_of_three_by_its_word(words, tmp_path):
    texts = {
        f"STA_{word}": series("dt: 0.005", "units: g", values=power(k + 1))
        for k, word in enumerate(words)
    }
    found, notes = folder(tmp_path, **texts)
    assert len(found) == 2
    assert words[2] in notes[0]


def test_three_of_three_stations_or_lengths_are_no_components(tmp_path):
    texts = {
        f"r{k}": series(f"station: S{k}", "dt: 0.005", "units: g", values=power(k + 1))
        for k in range(3)
    }
    assert len(folder(tmp_path, **texts)[0]) == 3
    for k in range(3):
        values = power(k + 1)[: 150 + 10 * k]
        (tmp_path / f"r{k}.txt").write_text(
            series("dt: 0.005", "units: g", values=values)
        )
    assert len(expanded([f"{tmp_path}"])[0]) == 3


@pytest.mark.parametrize(
    ("names", "sizes"),
    [
        (("kobe", "duzce", "taft"), (160,) * 3),  # matched to one spectrum, by programs
        (("Test010", "Test011", "Test012", "Test020"), (150, 150, 150, 160)),
        (("Test130", "Test132", "Test134", "Test12", "Test7"), (160,) * 3 + (150, 150)),
    ],
)
def test_names_of_their_own_and_numbers_of_a_series_are_no_components(
    names, sizes, tmp_path
):
    texts = {
        name: series("dt: 0.005", "units: g", values=power(k + 1)[:size])
        for k, (name, size) in enumerate(zip(names, sizes, strict=True))
    }
    assert len(folder(tmp_path, **texts)[0]) == len(names)


@pytest.mark.parametrize("heads", ["HL1,HL2,HL3", "p,q,a", "H1,H2,third", "NS,EW,aux"])
def test_a_table_of_three_is_asked_for(heads, tmp_path):
    text = table(f"dt: 0.005\nunits: g\n{heads}", VALUES, power(2), power(3))
    with pytest.raises(RecordError, match=r"do not tell their directions|\?columns="):
        folder(tmp_path, t=text)
    motion = load_record(
        f"{tmp_path / 't.txt'}?columns=acc NS [g],acc EW [g],-&channel=1"
    )
    assert motion.pga == pytest.approx(9.80665 * PEAK)


@pytest.mark.parametrize(
    ("one", "other", "says"),
    [
        ("X_vert.txt", "X_EW.txt", "vertical component"), ("X_N.txt", "X_S.txt", "0 degrees"),
        ("P-N10E.txt", "P-S10W.txt", "0 degrees"), ("Q090.txt", "Q100.txt", "10 degrees"),
        ("X_HNE.txt", "X_HNZ.txt", "vertical component"), ("a_nord.txt", "a_sud.txt", "0 deg"),
    ],
)  # fmt: skip
def test_pairs_are_compared_by_their_names(one, other, says, tmp_path):
    (tmp_path / one).write_text(series("dt: 0.005", "units: g"))
    (tmp_path / other).write_text(series("dt: 0.005", "units: g", values=VALUES**2))
    with pytest.raises(RecordError, match=says):
        load_components(f"{tmp_path / one}?second={other}&both")


def test_a_pair_of_two_stations_by_name_is_doubted(tmp_path):
    (tmp_path / "AB1_NS.txt").write_text(series("dt: 0.005", "units: g"))
    for name in ("AB2_EW.txt", "AB1_EW.txt"):
        (tmp_path / name).write_text(series("dt: 0.005", "units: g", values=VALUES**2))
        pair = load_components(f"{tmp_path / 'AB1_NS.txt'}?second={name}&both")
        doubted = any("more than a direction" in text for text in pair.y.warnings)
        assert doubted == (name == "AB2_EW.txt")


def test_a_direction_of_a_name_goes_with_the_motion(tmp_path):
    text = series("dt: 0.005", "units: g")
    assert read(tmp_path, text, name="STA_HLZ.txt").recording.is_vertical
    assert read(tmp_path, text, name="STA_düşey.txt").recording.is_vertical
    assert read(tmp_path, text, name="run_001.txt").recording.direction == ""
    assert direction_by_name("model_d.csv") == ""
    stated = read(
        tmp_path, series("component: NS", "dt: 0.005", "units: g"), name="a_UP.txt"
    )
    assert stated.recording.direction == "NS"


@pytest.mark.parametrize(
    ("words", "vertical"),
    [
        (("K", "D"), (False, False)),
        (("V", "Z"), (False, True)),
        (("N", "V"), (False, True)),
    ],
)
def test_letters_by_what_stands_beside_them(words, vertical):
    assert tuple(way.vertical for way in directions_of(words)) == vertical


@pytest.mark.parametrize("word", ["1", "3", "H3", "HN3", "aux", "0.5", "Pacoima"])
def test_numbers_of_components_are_no_directions(word):
    assert direction_of(word) is None


@pytest.mark.parametrize(
    "name",
    ["base isolator acc", "mean acc", "acc rms", "roof accel", "fart", "hastighet", "acc^2",
     "acc ratio", "PGA", "residual acceleration"],
)  # fmt: skip
def test_titles_with_other_words_are_no_accelerations(name):
    assert title_of(f"{name} (g)", 0).kind != "acceleration"


@pytest.mark.parametrize(
    "name",
    ["Acc NS", "Corrected Acc.", "Ivme", "Ускорение", "加速度", "Ground acceleration EW"],
)
def test_titles_of_accelerations(name):
    assert title_of(f"{name} (g)", 0).kind == "acceleration"


@pytest.mark.parametrize(
    "time", ["Zaman (sn)", "Время (с)", "时间 (s)", "Tid [s]", "Tiempo(seg)"]
)
def test_times_in_other_languages(time, tmp_path):
    assert read(tmp_path, table(f"{time},acc (g)", TIMES, VALUES)).dt == pytest.approx(
        0.005
    )


def test_what_the_user_says_of_columns_is_compared(tmp_path):
    text = table("Zeit (s),Beschleunigung (gal)", TIMES, VALUES)
    with pytest.raises(RecordError, match=r"says gal; leave them out, or.*&units=1 g"):
        read(tmp_path, text, "?columns=time,acc [g]")
    assert read(tmp_path, text, "?columns=time,acc [g]&units=1 g").npts == 200


@pytest.mark.parametrize("title", ["index", "No.", "sample"])
def test_numbers_of_samples_are_no_times(title, tmp_path):
    with pytest.raises(RecordError, match="numbers of samples"):
        read(tmp_path, table(f"{title},acc (g)", TIMES, VALUES))
    counted = table(f"{title},acc (g)", np.arange(200), VALUES)
    assert read(tmp_path, counted, "?dt=0.005").dt == 0.005


@pytest.mark.parametrize("clock", ["10:20:{:06.3f}", "2001-02-03 10:20:{:06.3f}"])
def test_clock_times_are_read(clock, tmp_path):
    rows = (f"{clock.format(t)},{a:.6f}" for t, a in zip(TIMES, VALUES, strict=True))
    motion = read(tmp_path, "\n".join(["time (hh:mm:ss),acc (g)", *rows]), name="c.csv")
    assert (motion.dt, motion.npts) == (0.005, 200)


def test_typeset_numbers_are_read(tmp_path):
    quoted = "\n".join(
        f'{t:.3f},"{a:.6f}"'.replace('"0.', '"0,').replace('"-0.', '"-0,')
        for t, a in zip(TIMES, VALUES, strict=True)
    )
    assert read(tmp_path, f"t (s),a (g)\n{quoted}\n").pga == pytest.approx(9.80665 * PEAK)
    minus = table("t (s),a (g)", TIMES, VALUES).replace("-", "\u2212")
    assert read(tmp_path, minus).pga == pytest.approx(9.80665 * PEAK)


def test_characters_that_look_like_others_are_named(tmp_path):
    with pytest.raises(RecordError, match=r"U\+0455, CYRILLIC SMALL LETTER DZE"):
        read(tmp_path, series("dt: 0.005", "units: cm/\u04552"))
    with pytest.raises(RecordError, match=r"U\+0430"):
        read(tmp_path, table("t (s),\u0430cc (g)", TIMES, VALUES))


@pytest.mark.parametrize(
    ("events", "numbers"),
    [
        (("L'Aquila, 4/6/2009", "LAQUILA (Italy) 06.04.2009"), (0, 0)),
        (("Düzce, 11/12/1999", "DUZCE- Turkey, 1999-11-12"), (0, 0)),
        (("Parkfield, 9/28/2004", "San Simeon, 12/22/2003"), (0, 1)),
        (("Chi-Chi Taiwan, 9/20/1999", "CHICHI 09/20/99"), (0, 0)),
        (("EQID 136", "EQID 137"), (0, 1)),
    ],
)
def test_one_earthquake_in_any_words(events, numbers, tmp_path):
    for k, event in enumerate(events):
        lines = (f"event: {event}", f"station: S{k}", "dt: 0.005", "units: g")
        (tmp_path / f"f{k}.txt").write_text(series(*lines))
    sources = [f"{tmp_path / f'f{k}.txt'}" for k in range(len(events))]
    assert clusters(sources, by="events") == numbers


@pytest.mark.parametrize(
    "line",
    ["SENSOR_DEPTH_M: 30", "hloubka: downhole", "Tiefe: 30 m", "site: roof", "10th floor",
     "location: basement"],
)  # fmt: skip
def test_boreholes_and_buildings_are_left_out(line, tmp_path):
    found, notes = folder(
        tmp_path,
        A_NS=series("site: free field", "dt: 0.005", "units: g"),
        B_NS=series(line, "dt: 0.005", "units: g", values=VALUES**2),
    )
    assert [path[-8:] for path in found] == ["A_NS.txt"]
    assert "in boreholes, left out" in notes[0]


@pytest.mark.parametrize(
    "other", [2.0 * VALUES, -VALUES, VALUES[:190]], ids=["double", "opposite", "cut"]
)
def test_copies_times_a_factor_are_told(other, tmp_path):
    _, notes = folder(
        tmp_path,
        first=series("dt: 0.005", "units: g", values=100.0 * VALUES),
        second=series("dt: 0.005", "units: g", values=100.0 * other),
    )
    assert "times a factor, cut" in notes[0]


@pytest.mark.parametrize("name", ["sigma lnSa [-]", "sd (ln)", "std_ln", "lnSa std"])
def test_scatter_of_a_target_by_other_names(name, tmp_path):
    (tmp_path / "t.csv").write_text(f"T [s],Sa [g],{name}\n0.1,0.5,0.6\n1,0.2,0.7\n")
    assert load_target(f"{tmp_path / 't.csv'}").deviation is not None


@pytest.mark.parametrize("name", ["spread std", "Abweichung SD", "COV", "log10 sigma"])
def test_a_scatter_that_is_not_told_is_asked_for(name, tmp_path):
    (tmp_path / "t.csv").write_text(f"T [s],Sa [g],{name}\n0.1,0.5,0.6\n1,0.2,0.7\n")
    with pytest.raises(RecordError, match=r"call it sigma_ln \[-\]"):
        load_target(f"{tmp_path / 't.csv'}")


@pytest.mark.parametrize("name", ["STA_HLZ", "STA_dusey", "ABC_N00E"])
@pytest.mark.parametrize("ending", [".at2", ".txt"])
def test_a_conversion_keeps_what_a_name_says_and_no_more(name, ending, tmp_path):
    motion = read(tmp_path, series("dt: 0.005", "units: g"), name=f"{name}.txt")
    text = (at2_text if ending == ".at2" else two_column_text)(motion)
    back = read(tmp_path, text, name=f"q{ending}").recording
    assert back == motion.recording
    assert back.direction == name.rpartition("_")[2]
    assert (back.event, back.station) == ("", "")


@pytest.mark.parametrize(
    "line", ["Duzce 1999-11-12 Bolu UP", "NOWHERE 01/02/01 1200, ABC UP"]
)
def test_the_last_word_of_an_at2_title_says_up(line, tmp_path):
    rows = "\n".join(f"{x:15.7E}" for x in VALUES)
    head = f"PEER\n{line}\nACCELERATION IN UNITS OF G\nNPTS= 200, DT= .005 SEC\n"
    assert read(tmp_path, head + rows + "\n", name="x.at2").recording.is_vertical


@pytest.mark.parametrize("words", ["SF= 2.0", "FACTOR: 0.5", "xyz = 981", "PGA= .9 G"])
def test_numbers_beside_the_unit_of_an_at2_header(words, tmp_path):
    rows = "\n".join(f"{x:15.7E}" for x in VALUES)
    head = "PEER\nA 7, 1/2/2001, B 12, 0\nACCELERATION IN UNITS OF G. {}\n"
    text = head.format(words) + "NPTS= 200, DT= .005 SEC\n" + rows + "\n"
    if "PGA" in words:
        (doubt,) = read(tmp_path, text, name="x.at2").warnings
        assert "the header says 0.9" in doubt
        return
    with pytest.raises(RecordError, match=r"not understood|factor on the values"):
        read(tmp_path, text, name="x.at2")
    assert read(tmp_path, text, "?units=1 g", name="x.at2").npts == 200
