"""Packages that give, raise and print what they should not: told by name, and harmless."""

import io
import json
import sys
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rpscli
from rpscli.case.schema.fields import Quantity
from rpscli.errors import PluginError, words_of
from rpscli.model.devices import OwnDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.own import DamperLaw, RestitutionLaw
from rpscli.records.measures import IntensityMeasure
from rpscli.records.target import TargetSpectrum, load_target
from rpscli.registry import Shared, apart, printed_aside

from .test_plugins import STUDY, as_installed

HOSTILE = """\
import sys
print("said on import")
from pydantic import model_validator
from rpscli.plugins import *
from rpscli.plugins import RecordFormat as Form

class Own(BaseException): pass
class Mute(Exception):
    def __str__(self): raise KeyError("no text")
def raising(error):
    def of(*_): raise error
    return IntensityMeasure("m/s", of)

leaves, own = raising(GeneratorExit("left")), raising(Own("a \\x1b[31mred\\nend"))
stops, mute = raising(StopIteration(3)), raising(Mute())
def said(*_):
    print("said by a measure")
    sys.stdout.write("and written")
    return 1.0
talks = IntensityMeasure("m/s", said)
negative = IntensityMeasure("m/s", lambda *_: -1.0)

def unset(axes, result):
    print("said by a figure")
    object.__setattr__(result, "record", None)
    object.__setattr__(result.trace, "rotation", None)

def recognises(text):
    print("said by a format")
    return False
form = Form("form", (".form",), recognises, lambda text: None)

def target(rest, source):
    print("said by a target")
    return TargetSpectrum("low", source, lambda periods: periods * 0.0 - 1.0, pgv=None)
def unsound(rest, source):
    return TargetSpectrum("low", source, lambda periods: periods, pgv=-1.0)

def linear(path, speed, c): return c * speed
def drives(path, speed, c): return c * speed * (0.15 - speed)
def slope(c): return c
N = {"c_own": Quantity("N s/m", above=0)}
stiff = DamperLaw(N, linear, slope, slope, lambda c: -1e9)
falls = DamperLaw(N, linear, lambda c: -c, slope)
modes = DamperLaw(N, linear, slope, lambda c: -c)
huge = DamperLaw(N, linear, lambda c: 1e300)
pushes = DamperLaw(N, lambda path, speed, c: -c * speed, slope)
driving = DamperLaw(N, drives, slope)
def raises(path, speed, c):
    if speed > 0.001:
        raise RuntimeError("too fast")
    return c * speed
late = DamperLaw(N, raises, slope)
S = {"c_own": Quantity("N s2/m2", above=0)}
squares = DamperLaw(S, lambda path, speed, c: c * speed * speed, slope)
def __getattr__(name):
    if name == "unknown":
        return DamperLaw({"c_own": Quantity("furlong")}, linear, slope)
    raise AttributeError(name)

class Strict(ReportOptions):
    @model_validator(mode="after")
    def looked_at(self):
        print("said by options")
        raise LookupError("in a validator")
class Plain(ReportOptions): pass
def found(study, options):
    print("said by a report")
    return Found({"": [Column("a", "-", [1])]}, None)
strict, plain = Report(Strict, found), Report(Plain, found)
"""
KINDS = {
    "measures": ["leaves", "own", "stops", "mute", "talks", "negative"],
    "figures": ["unset"],
    "formats": ["form"],
    "targets": ["target", "unsound"],
    "dampers": ["stiff", "falls", "modes", "huge", "pushes", "driving", "late",
                "squares", "unknown"],
    "reports": ["strict", "plain"],
}  # fmt: skip
SINE = "pulse:sine?amplitude=0.3g&period=0.5"
UNITS = "known are 1, m, kg, .*1/s, rad/s and N s2/m2"


@pytest.fixture
def hostile(tmp_path, monkeypatch, forgotten):
    """The package, as if installed."""
    lines = (
        f"[rpscli.{kind}]\n" + "".join(f"{name} = hostile:{name}\n" for name in names)
        for kind, names in KINDS.items()
    )
    as_installed(tmp_path / "site", "hostile", "".join(lines))
    (tmp_path / "site" / "hostile.py").write_text(HOSTILE, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path / "site")
    monkeypatch.delitem(sys.modules, "hostile", raising=False)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("leaves", "GeneratorExit: left"),
        ("own", "Own: a \ufffd[31mred end"),
        ("stops", "StopIteration: 3"),
        ("mute", "Mute: its text cannot be read: KeyError"),
        ("negative", "it is -1 m/s for sine_T0.5s_a0.3g, and must be at least 0"),
    ],
)
def test_whatever_a_package_raises_or_gives_is_told_by_its_name(hostile, rps, name, said):
    words = ("timehistory", "small.yaml", "--record", SINE, "--scale-to", f"{name}=1")
    failed = rps(*words, exit_code=1).stderr
    assert f"rpscli.measures: {name} of hostile 1.0 (hostile:{name}): {said}" in failed
    assert "internal" not in failed
    assert "\x1b" not in failed


def test_an_interruption_is_nobodys_error():
    with pytest.raises(KeyboardInterrupt), rpscli.registry.blaming("a package"):
        raise KeyboardInterrupt
    assert words_of(ValueError()) == "ValueError"


def test_the_document_alone_is_on_the_standard_output(hostile, figures, rps_json, rps):
    """Functions of all kinds print, at their import too; only commands may."""
    words = ("timehistory", "small.yaml", "--record", SINE, "--force")
    rps_json(*words, "--scale-to", "talks=1", "--figures", "png,unset")
    text = STUDY.replace("worst: {count: 3}", "plain").replace("ASI", "talks")
    Path("study.yaml").write_text(text, encoding="utf-8")
    rps_json("sweep", "study.yaml", "-o", "s")
    result = rps("sweep", "study.yaml", "-o", "s2", "--json")
    json.loads(result.stdout)
    assert "said by a report" in result.stderr
    Path("plain.txt").write_text("0 0.1\n0.01 0.2\n0.02 0.1\n", encoding="utf-8")
    looked = rps("record", "info", "plain.txt?units=g", "--json")
    json.loads(looked.stdout)
    assert "said by a format" in looked.stderr


def test_threads_do_not_take_each_others_output():
    results, others = io.StringIO(), io.StringIO()
    shared = Shared(results, others)
    with redirect_stdout(shared), printed_aside():
        print("aside")  # noqa: T201
        with printed_aside():
            print("deeper")  # noqa: T201
    shared.write("result")
    assert (results.getvalue(), others.getvalue()) == ("result", "aside\ndeeper\n")


def test_what_a_figure_writes_to_a_result_stays_there(hostile, figures, rps, workplace):
    words = ("timehistory", "small.yaml", "-o", "r", "--figures", "png,unset")
    result = rps(*words)
    assert "internal" not in result.stderr
    assert (workplace / "r" / "rotation.png").exists()
    case = rpscli.load_case("small.yaml")
    result = rpscli.time_history(case.structure, rpscli.load_record(SINE), case.analysis)
    copy = apart(result)
    object.__setattr__(copy.trace, "rotation", None)
    assert result.trace.rotation is not None
    assert copy.trace.time is result.trace.time  # arrays are read-only


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("stiff", "its stiffness is -1000000000.0 N/m, and must be at least 0"),
        ("falls", "its damping is -1000000.0 N s/m"),
        ("modes", "its linear is -1000000.0 N s/m"),
        ("huge", r"its damping is 1e\+300 N s/m, and must be at least 0 and at most"),
        ("pushes", "its force at 0.001 m/s, .*, is -1000 N, which pushes"),
        ("unknown", f"the unit 'furlong' of a Quantity is not known; {UNITS}"),
    ],
)
def test_dampers_that_are_none_are_faults_of_their_package(
    hostile, workplace, name, said
):
    named = rf"rpscli\.dampers: {name} of hostile 1\.0 .*: {said}"
    with pytest.raises(PluginError, match=named):
        rpscli.load_case("small.yaml", [f"podium.devices=[{{kind: {name}, c_own: 1e6}}]"])


def test_a_device_that_drives_is_warned_of(hostile, rps_json):
    device = "podium.devices=[{kind: driving, c_own: 3000 kN s/m}]"
    told = rps_json("timehistory", "small.yaml", "--set", device)["warnings"]
    (told,) = [text for text in told if "gives energy" in text]
    assert told.startswith("podium.devices.0 (driving) gives energy to the motion")


def test_what_a_law_raises_is_told_as_its_package(hostile, rps):
    device = "podium.devices=[{kind: late, c_own: 3 MN s/m}]"
    failed = rps("timehistory", "small.yaml", "--set", device, exit_code=4).stderr
    assert "late of hostile 1.0 (hostile:late): raises(" in failed
    assert "RuntimeError: too fast" in failed
    assert "check masses" not in failed


def test_units_of_other_packages_break_nothing_of_ours(hostile, rps, workplace):
    """One with a unit that nobody knows is left out where all are listed."""
    schema = rps("schema").stdout
    assert "N s2/m2" in schema
    assert "furlong" not in schema
    rps("init", "--editor", "mine.yaml")
    squares = "podium.devices=[{kind: squares, c_own: 2 kN s2/m2}]"
    (device,) = rpscli.load_case("small.yaml", [squares]).structure.devices
    assert device.values == (2000.0,)


def test_options_that_raise_are_named(hostile, rps, workplace):
    text = STUDY.replace("worst: {count: 3}", "strict").replace("ASI", "PGA")
    (workplace / "study.yaml").write_text(text, encoding="utf-8")
    failed = rps("sweep", "study.yaml", "-o", "s", exit_code=1)
    assert "Strict, options of hostile: LookupError: in a validator" in " ".join(
        failed.stderr.replace("'", "").split()
    )
    assert failed.stdout == ""


def test_spectra_with_sizes_that_none_has_are_named(hostile):
    for name, said in (("target", "ordinates are -1 to -1"), ("unsound", "pgv = -1")):
        with pytest.raises(PluginError, match=f"{name} of hostile 1.0 .*{said}"):
            load_target(f"{name}:?").acceleration(np.array([0.1, 0.5]))


def test_a_traceback_of_a_package_is_shown_once(hostile, rps, monkeypatch):
    monkeypatch.setenv("RPS_TRACEBACK", "1")
    words = ("timehistory", "small.yaml", "--record", SINE, "--scale-to", "own=1")
    failed = rps(*words, exit_code=1).stderr
    assert failed.count("Traceback") == 1
    assert 'hostile.py", line' in failed
    assert "\x1b" not in failed
    assert "error: rpscli.measures: own of hostile 1.0" in failed


OIL = DamperLaw(
    {"c": Quantity("N s/m", above=0), "share": Quantity(at_least=0, at_most=1)},
    lambda _, speed, c, share: c * speed * share,
    lambda c, _: c,
)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((-1e6, 0.1), r"damper oil: c = -1000000\.0 must be > 0 N s/m"),
        ((1e6, 2.0), r"damper oil: share = 2\.0 must be >= 0 and <= 1"),
        ((1e20, 0.1), "check the unit"),
        ((1e6,), r"has 2 constants \(c, share\), and 1 values were given"),
    ],
)
def test_bounds_hold_from_python_too(values, said):
    with pytest.raises(ValueError, match=said):
        OwnDamper("oil", OIL, values)
    law = RestitutionLaw(OIL.constants, lambda *_: 0.9)
    with pytest.raises(ValueError, match=said.replace("damper oil", "impact law oil")):
        ImpactLaw("oil", own=law, constants=values)


def test_sizes_of_measures_and_spectra_from_python():
    with pytest.raises(ValueError, match="unit = 'parsec' must be m, kg"):
        IntensityMeasure("parsec", lambda *_: 1.0)
    sound = TargetSpectrum("a", "a", lambda periods: periods, pgv=None)
    for change in ({"damping": 5.0}, {"span": (2.0, 1.0)}, {"pga": 0.0}):
        with pytest.raises(ValueError, match=next(iter(change))):
            replace(sound, **change)
