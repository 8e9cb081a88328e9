"""What codes ask of a set, by numbers of one's own; what recordings are kept."""

from typing import NamedTuple

import numpy as np
import pytest
from conformance import conforms
from paper_structures import known

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError, UsageError
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.loading import load_record
from rpscli.records.measures import response_spectrum
from rpscli.records.target import Component, load_target
from rpscli.report.motions import record_files
from rpscli.tools.selection.filters import parse_filter
from rpscli.tools.selection.requirements import RULES, Periods


class Have(NamedTuple):
    """What a set has, in the order in which it is judged."""

    number: int
    of: Component
    level: str
    pga_ratio: float
    least: float
    span: tuple[float, float]


HAVE = Have(7, "component", "", 1.02, 0.91, (0.1, 1.0))
STRUCTURE = Periods(0.5, 2.0)


def words(rules, have, periods):
    return [rule.word for rule in RULES[rules].judged(*have, periods)]


@pytest.mark.parametrize(
    ("have", "periods", "wanted"),
    [
        # Three or more, mean PGA, 0.9, and 0.2 x 0.5 = 0.1 s to 2 x 0.5 = 1 s.
        (HAVE, STRUCTURE, ["met", "met", "met", "met"]),
        (HAVE._replace(number=2), STRUCTURE, ["NOT MET", "met", "met", "met"]),
        (HAVE._replace(pga_ratio=0.99), STRUCTURE, ["met", "NOT MET", "met", "met"]),
        (HAVE._replace(least=0.899), STRUCTURE, ["met", "met", "NOT MET", "met"]),
        (HAVE._replace(span=(0.11, 1.0)), STRUCTURE, ["met", "met", "met", "NOT MET"]),
        (HAVE._replace(span=(0.1, 0.99)), STRUCTURE, ["met", "met", "met", "NOT MET"]),
        (HAVE, None, ["met", "met", "met", "not checked"]),
        (
            HAVE._replace(pga_ratio=float("nan")),
            STRUCTURE,
            ["met", "not checked", "met", "met"],
        ),
    ],
)
def test_en1998(have, periods, wanted):
    assert words("en1998", have, periods) == wanted


def test_asce7():
    pairs = Have(11, "rotd100", "MCE_R", float("nan"), 0.9, (0.1, 1.0))
    assert words("asce7-ch16", pairs, STRUCTURE) == ["met"] * 5
    few = pairs._replace(number=10, of="rotd50", level="design", least=0.89)
    assert words("asce7-ch16", few, STRUCTURE) == [*["NOT MET"] * 4, "met"]
    assert words("asce7-ch16", pairs._replace(level=""), STRUCTURE)[2] == "not checked"
    # Isolated: 7 pairs, SRSS, the whole target from 0.75 x 2 = 1.5 s to 1.25 x 2 = 2.5 s.
    isolated = Have(7, "srss", "MCE_R", float("nan"), 1.0, (1.5, 2.5))
    assert words("asce7-ch17", isolated, STRUCTURE) == ["met"] * 5
    assert words("asce7-ch17", isolated._replace(least=0.99), STRUCTURE)[3] == "NOT MET"


def test_nobody_takes_an_unverified_clause_for_the_code():
    assert RULES["asce7-ch17"].checked.startswith("NOT VERIFIED")
    assert all("not with the text" in r.checked or "VERIFIED" in r.checked or r.span is None
               for r in RULES.values())  # fmt: skip


def test_filters():
    known = Recording("a 1999", "b", 6.7, 12e3, 300.0, 4.0, pulse=True)
    motion = GroundMotion(np.ones(101), 0.1, recording=known)
    kept = {
        "magnitude=6.5..6.7": True,
        "magnitude=6.8..": False,
        "distance=10 km..20 km": True,
        "distance=..11 km": False,
        "vs30=180..360": True,
        "usable_period=4..": True,
        "pulse=yes": True,
        "pulse=no": False,
        # A flat motion of 10 s: 70 % and 90 % of it.
        "d5_75=6.9..7.1": True,
        "d5_95=..8.9": False,
    }
    assert {text: parse_filter(text).keeps(motion) for text in kept} == kept
    unknown = GroundMotion(np.ones(3), 0.1)
    assert parse_filter("magnitude=6..7").keeps(unknown) is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("magnitud=6..7", "did you mean magnitude"),
        ("magnitude=6", "write magnitude=LOW..HIGH"),
        ("magnitude=a..7", "must be a number"),
        ("distance=3 kg..", "an end of the range"),
        ("vs30=500..200", "must not fall"),
        ("pulse=maybe", "pulse=yes or pulse=no"),
    ],
)
def test_filters_that_are_refused(text, message):
    with pytest.raises(UsageError, match=message):
        parse_filter(text)


G = STANDARD_GRAVITY


@pytest.mark.evidence("selection of records", "published")
@pytest.mark.parametrize(
    ("source", "values"),
    [
        # EN 1998-1 type 1, B: S 1.2, T_B 0.15, T_C 0.5, T_D 2; 0.3 x 1.2 = 0.36 g, plateau 0.9 g.
        (
            "en1998:?ag=0.3g&soil=B",
            {
                0.0: 0.36,
                0.075: 0.63,
                0.15: 0.9,
                0.5: 0.9,
                1.0: 0.45,
                2.0: 0.225,
                4.0: 0.05625,
            },
        ),
        # Type 2, D: S 1.8, T_B 0.1, T_C 0.3, T_D 1.2; 0.18 g, plateau 0.45 g.
        (
            "en1998:?ag=0.1g&soil=d&type=2",
            {0.05: 0.315, 0.2: 0.45, 0.6: 0.225, 2.4: 0.028125},
        ),
        # xi 20 %: eta = sqrt(10/25) = 0.632456; xi 50 %: sqrt(10/55) = 0.426, so 0.55.
        ("en1998:?ag=1g&damping=20%", {0.0: 1.0, 0.3: 1.58113883}),
        ("en1998:?ag=1g&damping=0.5", {0.3: 1.375}),
        # A national annex: 0.36 g, plateau 0.9 g between 0.1 and 0.4 s, 1/T^2 beyond 2.5 s.
        (
            "en1998:?ag=0.3g&soil=B&tb=0.1&tc=0.4&td=2.5",
            {0.05: 0.63, 0.1: 0.9, 0.8: 0.45, 2.5: 0.144, 4.0: 0.05625},
        ),
        ("en1998:?ag=0.3g&soil=B&s=1.5", {0.0: 0.45}),
        # 2024: PGA S_alpha/2.5; T_C = 0.4, T_B = 0.4/4 = 0.1; linear from 0.02 s to there.
        (
            "en1998-2024:?s_alpha=1g&s_beta=0.4g&td=2.5 s",
            {
                0.0: 0.4,
                0.02: 0.4,
                0.06: 0.7,
                0.1: 1.0,
                0.4: 1.0,
                1.0: 0.4,
                2.5: 0.16,
                5.0: 0.04,
            },
        ),
        # T_C = 0.12 and 0.6: T_B is 0.05 and 0.1, its bounds.
        ("en1998-2024:?s_alpha=1g&s_beta=0.12g&td=2", {0.05: 1.0, 0.035: 0.7}),
        ("en1998-2024:?s_alpha=1g&s_beta=0.6g&td=2", {0.1: 1.0, 0.06: 0.7}),
        # ASCE 7: T_S = 0.6, T_0 = 0.12.
        (
            "asce7:?sds=1g&sd1=0.6g&tl=8",
            {
                0.0: 0.4,
                0.06: 0.7,
                0.12: 1.0,
                0.6: 1.0,
                1.2: 0.5,
                8.0: 0.075,
                16.0: 0.01875,
            },
        ),
        ("asce7:?sds=1g&sd1=0.6g&tl=8&level=mcer", {0.06: 1.05, 1.2: 0.75}),
        # SP 14.13330, A = 0.4 g: 1 + 15 x 0.04 = 1.6; sqrt(0.4/1.6) = 0.5; at least 0.8.
        (
            "sp14:?acceleration=0.4g&soil=II",
            {
                0.0: 0.4,
                0.04: 0.64,
                0.1: 1.0,
                0.4: 1.0,
                1.6: 0.5,
                3.0: 0.365148372,
                9.0: 0.32,
            },
        ),
        ("sp14:?acceleration=0.4g&soil=III", {0.8: 1.0, 3.2: 0.5}),
    ],
)
def test_by_hand(source, values):
    found = load_target(source).acceleration(np.array(list(values))) / G
    for period, expected, mine in zip(values, values.values(), found, strict=True):
        conforms(
            "selection of records", f"target [g] at {period:g} s", expected, mine,
            1e-8 * expected, "hand calculation", source.partition(":")[0],
        )  # fmt: skip


def test_peaks_of_the_ground():
    target = load_target("en1998:?ag=0.3g&soil=B")
    assert target.pgd == pytest.approx(0.025 * 0.36 * G * 0.5 * 2.0)
    assert target.pgv == pytest.approx(0.45 * G / (2.0 * np.pi) / 1.65)
    damped = load_target("en1998:?ag=0.3g&soil=B&damping=0.2")
    assert (damped.pgv, damped.pgd) == (target.pgv, target.pgd)
    assert load_target("asce7:?sds=1g&sd1=0.6g&tl=8").pgd is None
    # 0.06 (10 x 4)^0.55.
    assert load_target(
        "en1998-2024:?s_alpha=10 m/s2&s_beta=4 m/s2&td=2"
    ).pgv == pytest.approx(0.45634, rel=1e-4)


def test_what_is_known_of_a_target():
    """Edition and check are told, and what nobody could check is told as that."""
    sources = {
        "en1998:?ag=1g": ("EN 1998-1:2004", "not with the text"),
        "en1998-2024:?s_alpha=1g&s_beta=0.4g&td=2": (
            "EN 1998-1-1:2024",
            "not with the text",
        ),
        "asce7:?sds=1g&sd1=0.6g&tl=8": ("7-16", "not with the text"),
        "sp14:?acceleration=4": (
            "without amendment No. 1 (Изменение № 1) and all later ones",
            "NOT VERIFIED",
        ),
    }
    for source, (edition, checked) in sources.items():
        target = load_target(source)
        assert edition in target.edition
        assert checked in target.checked
    assert load_target("asce7:?sds=1g&sd1=0.6g&tl=8&level=mcer").level == "MCE_R"
    assert load_target("asce7:?sds=1g&sd1=0.6g&tl=8").of == "rotd100"
    # 1 m/s2 over 9.80665 m/s2.
    target = load_target("asce7:?sds=1 m/s2&sd1=0.06 g&tl=8&level=mcer")
    assert target.parameters == "SDS = 0.102 g, SD1 = 0.06 g, TL = 8 s, times 1.5"


def table(folder, text):
    file = folder / "target.csv"
    file.write_text(text, encoding="utf-8")
    return str(file)


def test_a_table_with_scatter(tmp_path):
    rows = "0.1,0.4,0.5\n0.5,1.0,0\n2.0,0.25,0.3\n"
    file = table(tmp_path, f"T [s],median [g],sigma_ln [-]\n{rows}")
    target = load_target(f"{file}?component=RotD50&level=MCE_R")
    assert (target.pinned, target.of, target.level) == (0.5, "rotd50", "MCE_R")
    # 1 s is half way between 0.5 and 2 s in logarithms.
    found = known(target.deviation)(np.array([0.1, 1.0]))
    np.testing.assert_allclose(found, [0.5, 0.15], rtol=1e-12)
    with pytest.raises(
        RecordError, match="component = 'rot50' is not known; did you mean rotd50"
    ):
        load_target(f"{file}?component=rot50")


def test_a_table(tmp_path):
    file = table(tmp_path, "T [s],Sa [g],note\n0,0.4,x\n0.5,1.0,\n2.0,0.25,\n")
    target = load_target(file)
    # 1 s is half way between 0.5 and 2 in logarithms, as 0.5 is between 1 and 0.25.
    found = target.acceleration(np.array([0.5, 1.0, 2.0])) / G
    np.testing.assert_allclose(found, [1.0, 0.5, 0.25], rtol=1e-12)
    assert target.pgv == pytest.approx(0.5 * G / (2.0 * np.pi) / 1.65)
    assert target.ground_acceleration == pytest.approx(0.4 * G)
    assert load_target("en1998:?ag=0.3g&soil=B").ground_acceleration == pytest.approx(
        0.36 * G
    )
    assert load_target(f"{file}?damping=2%").pgv is None
    with pytest.raises(
        RecordError, match=r"no value at 0.1 s; it is defined from 0.5 to 2 s"
    ):
        target.acceleration(np.array([0.1]))


def test_the_spectrum_of_a_record_is_a_table(tmp_path):
    motion = load_record("synthetic:?pga=0.3g&seed=1&duration=4&dt=0.02")
    spectrum = response_spectrum(motion, [0.0, 0.5, 1.0, 2.0])
    file = table(tmp_path, str(dict(record_files(motion, spectrum))["spectrum.csv"]))
    found = load_target(file).acceleration(spectrum.periods[1:])
    np.testing.assert_allclose(found, spectrum.pseudo_acceleration[1:], rtol=1e-9)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("en1998:?soil=B", "ag is missing; add ag="),
        ("en1998:?ag=0.3g&soil=F", "soil = 'F' is not known; .*A"),
        ("en1998:?ag=0.3g&type=3", "type = '3' is not known"),
        ("en1998:?ag=-0.3g", "ag must be > 0"),
        ("en1998:?ag=0.3", "say the unit: ag=0.3 g, or ag=0.3 m/s2"),
        ("asce7:?sds=1.0&sd1=0.6g&tl=8", "say the unit: sds=1.0 g, or sds=1.0 m/s2"),
        ("en1998-2024:?s_alpha=1g&s_beta=0.4&td=2", "say the unit: s_beta=0.4 g"),
        ("en1998:?ag=0.3 m", "is no acceleration in g"),
        ("asce7:?sds=1g&sd1=0.6g", "tl is missing"),
        ("asce7:?sds=1g&sd1=0.6g&tl=0.5", "below tl"),
        ("asce7:?sds=1g&sd1=0.6g&tl=8&level=mce", "did you mean mcer"),
        ("sp14:?acceleration=4&soil=V", "soil = 'V' is not known"),
        ("en1998:?ag=1g&tb=0.5&tc=0.4", "0 < tb < tc < td <= 4 s"),
        ("en1998-2024:?s_alpha=1g&s_beta=0.4g", "td is missing"),
        ("en1998-2024:?s_alpha=1g&s_beta=0.4g&td=0.3", "s_beta/s_alpha < td"),
        ("sprk:?ag=1g", "could not be verified and are not those of sp14; give .* CSV"),
        ("sp14:?acceleration=0", "acceleration must be > 0"),
        ("en1989:?ag=0.3g", "'en1989' is not a known code; did you mean en1998"),
        ("nothing.csv", "there is no file nothing.csv; give a CSV file or a code"),
    ],
)
def test_targets_that_are_refused(source, message):
    with pytest.raises(RecordError, match=message):
        load_target(source)


@pytest.mark.parametrize(
    "text",
    [
        "T [ms];Sa [g]\n500;0,2\n1000;0,1\n",
        "период [сек],Sa [g]\n0.5,0.2\n1,0.1\n",
        "Frequenz [Hz]\tSa [m/s2]\n0\t0.1\n1\t0.980665\n2\t1.96133\n",
        "T (Sekunden),Sa (%g)\n.5,20\n1,10\n",
    ],
)
def test_periods_in_other_units_and_frequencies(text, tmp_path):
    target = load_target(table(tmp_path, text))
    assert target.span == (0.5, 1.0)
    ordinates = target.acceleration(np.array([0.5, 1.0]))
    assert ordinates == pytest.approx([0.2 * 9.80665, 0.1 * 9.80665], rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.1,0.5\n", "should name two columns with units"),
        ("T [s],Sa [m/s]\n1,1\n", "should name two columns with units"),
        ("T [s],Sa [g]\n1,1\n", "needs two rows"),
        ("T [s],Sa [g]\n1,1\n0.5,1\n", "periods that grow"),
        ("T [s],Sa [g]\n1,1\n2,x\n", ":3: '2,x' must be"),
        ("", "should name two columns"),
        (f"{'x' * 30}\n1,1\n", rf"1: '{'x' * 20}'\.\.\. should"),
    ],
)
def test_refuses_tables(tmp_path, text, message):
    with pytest.raises(RecordError, match=message):
        load_target(table(tmp_path, text))
