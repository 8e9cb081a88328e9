"""What other packages add: the example is installed and used, broken ones break nothing else."""

import importlib.metadata
import os
import re
import shlex
import shutil
import sys
import tomllib
from pathlib import Path

import click
import numpy as np
import pytest
from PIL import Image
from shown_commands import ROOT, command, of_blocks, run_in_shell

import rpscli
from rpscli.case.schema.scale_to import scale_to_of
from rpscli.commands.init import schema_of
from rpscli.errors import CaseError, PluginError, RecordError
from rpscli.records.formats import FORMATS
from rpscli.records.measures import MEASURES
from rpscli.records.target import CODES, load_target
from rpscli.sweep.evaluation import System
from rpscli.tools.selection.command import command as select

from .conftest import write_case

EXAMPLE = Path(__file__).parents[1] / "example_package"
BROKEN = """\
[rpscli.formats]
tidy2 = no_such_module:X
[rpscli.measures]
XYZ = no_such_module:X
PGV = no_such_module:X
[rpscli.targets]
flat = rpscli.constants:STANDARD_GRAVITY
steep = json:loads
[rpscli.reports]
nothing = no_such_module:X
"""
STUDY = """\
rps: 1
base: small.yaml
records: ["pulse:half_sine?amplitude=0.3g&period=0.6", "pulse:sine?amplitude=0.3g&period=0.6"]
scale: {measure: ASI, values: [1, 2]}
reports: [worst: {count: 3}]
"""


def as_installed(folder, name, entry_points):
    """What pip would leave of a package besides its modules."""
    place = folder / f"{name.replace('-', '_')}-1.0.dist-info"
    place.mkdir(parents=True)
    metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n"
    (place / "METADATA").write_text(metadata, encoding="utf-8")
    (place / "entry_points.txt").write_text(entry_points, encoding="utf-8")


@pytest.fixture
def example(tmp_path, monkeypatch, forgotten):
    """The example, as its own `pyproject.toml` installs it."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text(encoding="utf-8"))[
        "project"
    ]
    groups = project["entry-points"].items()
    lines = (
        f"[{g}]\n" + "".join(f"{k} = {v}\n" for k, v in e.items()) for g, e in groups
    )
    as_installed(tmp_path / "site", project["name"], "".join(lines))
    monkeypatch.syspath_prepend(tmp_path / "site")
    monkeypatch.syspath_prepend(EXAMPLE)


@pytest.fixture
def broken(tmp_path, monkeypatch, forgotten):
    """A package of which nothing works."""
    as_installed(tmp_path / "broken", "broken-plugins", BROKEN)
    monkeypatch.syspath_prepend(tmp_path / "broken")


def test_a_format(example, tmp_path):
    file = tmp_path / "one.tidy"
    file.write_text("TIDY dt=0.01 unit=cm/s2\n100\n-300\n50\n", encoding="utf-8")
    motion = rpscli.load_record(str(file))
    assert (motion.format, motion.dt) == ("TIDY", 0.01)
    assert motion.acceleration.tolist() == [1.0, -3.0, 0.5]
    file.write_text("TIDY dt=0.01 unit=cm/s2\nhundred\n", encoding="utf-8")
    with pytest.raises(
        RecordError, match=r"one\.tidy: could not convert.*; write one number"
    ):
        rpscli.load_record(str(file))


def test_a_measure(example):
    motion = rpscli.load_record("pulse:sine?amplitude=0.3g&period=0.5")
    scaled = motion.scaled_to("ASI", 2.0)
    periods = np.linspace(0.1, 0.5, 41)
    spectrum = rpscli.response_spectrum(scaled, periods).pseudo_acceleration
    assert np.trapezoid(spectrum, periods) == pytest.approx(2.0, rel=1e-12)
    assert scale_to_of("ASI=150 cm/s").value == 1.5
    with pytest.raises(
        ValueError, match="belongs to measures such as Sa, AvgSa, FIV3; ASI has"
    ):
        scale_to_of("ASI(1 s)=150 cm/s")
    with pytest.raises(ValueError, match="ASII is not a measure; did you mean ASI"):
        scale_to_of("ASII=1")


def test_a_target(example):
    target = load_target("plateau:?a=4 m/s2&corner=0.5")
    assert target.acceleration(np.array([0.1, 0.5, 1.0])).tolist() == [4.0, 4.0, 2.0]
    with pytest.raises(RecordError, match="a and corner must be > 0"):
        load_target("plateau:?a=4 m/s2&corner=0 s")
    option = next(each for each in select.params if each.name == "target")
    known = [found.value for found in option.shell_complete(click.Context(select), "p")]
    assert known == ["plateau:?"]


def test_a_figure_of_a_history(example, rps, workplace):
    rps("timehistory", "small.yaml", "-o", "here", "--figures", "png,phase_plane")
    assert (workplace / "here" / "phase_plane.png").read_bytes()
    result = rps("check", "small.yaml", "--draw", "--figures", "phase_plane", exit_code=2)
    assert "phase_plane is drawn by modal, pushover or timehistory alone" in result.stderr
    assert rpscli.figures.phase_plane.__doc__ == "The rate of rotation over the rotation."


def test_a_command(example, rps, workplace):
    slenderness = rpscli.load_case("small.yaml").structure.bearing.slenderness
    assert float(rps("widths", "small.yaml").stdout) == pytest.approx(
        1.0 / slenderness, rel=1e-3
    )
    help_text = rps("--help").stdout
    assert re.search(r"Commands of other packages:\n  widths +Print how many", help_text)
    usage = rps("widths", exit_code=2).stderr
    assert "Missing argument" in usage


def test_a_command_that_fails_is_told_as_its_package(
    tmp_path, monkeypatch, forgotten, rps
):
    code = """import click
@click.command("stumbles")
def stumbles(): raise KeyError("gone")
modal = no_command = 3
"""
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "stumbling.py").write_text(code, encoding="utf-8")
    points = ("stumbles = stumbling:stumbles", "modal = stumbling:modal",
              "budget = stumbling:modal", "three = stumbling:no_command")  # fmt: skip
    as_installed(
        tmp_path / "site", "stumbling", "\n".join(["[rpscli.commands]", *points])
    )
    monkeypatch.syspath_prepend(tmp_path / "site")
    failed = rps("stumbles", exit_code=1).stderr
    assert "rpscli.commands: stumbles of stumbling 1.0" in failed
    assert "KeyError: 'gone'" in failed
    assert "must be Command" in rps("three", exit_code=1).stderr
    told = rps("explain", "plugins").stdout
    assert told.count("rps has one of this name, which is taken") == 2


def test_a_study(example, rps_json, workplace):
    (workplace / "study.yaml").write_text(STUDY, encoding="utf-8")
    document = rps_json("sweep", "study.yaml", "-o", "here")
    table = document["reports"]["worst"]["rows"]
    assert len(table) == 3
    ratios = [row["rotation_ratio"] for row in table]
    assert ratios == sorted(ratios, reverse=True)
    head, *lines = (workplace / "here" / "points.csv").read_text().splitlines()
    assert "ASI [m/s]" in head
    assert len(lines) == 4
    assert (workplace / "here" / "worst.png").exists()


def test_the_figure_of_a_study_is_drawn(example, figures, rps, workplace):
    (workplace / "study.yaml").write_text(STUDY, encoding="utf-8")
    rps("sweep", "study.yaml", "-o", "here", "--figures", "png,svg")
    with Image.open(workplace / "here" / "worst.png") as picture:
        assert min(picture.size) > 300
        assert len(set(picture.convert("L").tobytes())) > 10  # it is not empty
    assert "<svg" in (workplace / "here" / "worst.svg").read_text(encoding="utf-8")


def test_what_is_installed_is_listed(example, rps_json):
    found = {each["name"]: each for each in rps_json("explain", "plugins")["plugins"]}
    names = [
        "tidy",
        "ASI",
        "plateau",
        "worst",
        "phase_plane",
        "oil",
        "crushing",
        "widths",
    ]
    assert [*found] == names
    assert {each["package"] for each in found.values()} == {"rps-example 1.0"}
    assert found["ASI"]["meaning"].startswith("ASI [m/s]: the integral of Sa")
    assert not any(each["fault"] for each in found.values())
    looked_at = {row["subject"]: row for row in rps_json("doctor")["findings"]}
    assert (
        looked_at["rpscli.dampers: oil"] | {"found": "rps-example 1.0", "remedy": ""}
        == (looked_at["rpscli.dampers: oil"])
    )
    report = rps_json("explain", "worst")
    options = [option["key"] for option in report["options"]]
    assert options == ["name", "title", "formats", "count"]
    assert "worst" in str(schema_of("study"))


OIL = "{kind: oil, closed_coefficient: 2 MN s/m, relief_force: 300 kN, open_share: 0.1}"
CRUSHING = (
    "{law: crushing, slow_restitution: 0.95, fast_restitution: 0.7, usual_rate: 0.3}"
)
WITH_LAWS = ("--set", f"podium.devices=[{OIL}]", "--set", f"podium.impact={CRUSHING}")


def test_laws_in_a_case(example, rps, rps_json, workplace):
    found = rps_json("timehistory", "small.yaml", *WITH_LAWS, "-o", "here")
    (damper,) = found["devices"]
    assert damper["kind"] == "oil"
    assert damper["force"] > 3e5  # the valve opens
    resolved = rpscli.load_case("small.yaml", WITH_LAWS[1::2]).document
    assert resolved["podium"]["devices"][0]["relief_force"] == 3e5
    again = rpscli.load_case(resolved).structure
    assert again.restitution == pytest.approx(0.7 + 0.25 * np.exp(-1e-3 / 0.3))
    assert (workplace / "here" / "devices.png").exists()
    modes = rps_json("modal", "small.yaml", *WITH_LAWS)
    assert modes["rolling"] != rps_json("modal", "small.yaml")["rolling"]
    assert "relief_force" in str(schema_of("case"))
    refused = rps("export", "small.yaml", "mujoco", *WITH_LAWS, exit_code=2)
    assert "podium.devices is not exported" in refused.stderr
    rps(
        "export",
        "small.yaml",
        "opensees",
        *WITH_LAWS[2:],
        exit_code=2,
        says="podium.impact",
    )


def test_constants_of_laws_are_axes(example, rps_json, workplace):
    devices = f"  devices: [{OIL}]\n  impact: {CRUSHING}\nrecord:"
    write_case("laws.yaml", ("record:", devices))
    vary = "vary: [{podium.devices.0.relief_force: [200 kN, 400 kN]},"
    vary += " {podium.impact.fast_restitution: [0.6, 0.9]}]\n"
    study = STUDY.replace("small.yaml", "laws.yaml").replace(
        "ASI, values: [1", "PGA, values: [3"
    )
    study = study.split("reports")[0]
    (workplace / "study.yaml").write_text(study + vary, encoding="utf-8")
    rps_json("sweep", "study.yaml", "-o", "here")
    head, *lines = (workplace / "here" / "points.csv").read_text().splitlines()
    assert "podium.devices.0.relief_force [N]" in head
    at = [name.split(" [")[0] for name in head.split(",")].index("rotation_ratio")
    assert len(lines) == 16
    assert len({line.split(",")[at] for line in lines}) > 8


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            OIL.replace("300 kN", "3 m"),
            r"relief_force = '3 m' is a length, but must be a force",
        ),
        (OIL.replace("0.1", "2"), r"open_share = 2 must be >= 0 and <= 1 \(of c\)"),
        (OIL.replace(", open_share: 0.1", ""), "open_share is missing: of oil"),
        (OIL.replace("}", ", gap: 1}"), "gap is not a key of kind: oil, which has"),
        (
            OIL.replace("open_share", "open_shar"),
            "did you mean podium.devices.0.open_share",
        ),
        (OIL.replace("oil", "oill"), "must be viscous, .* or oil; did you mean oil"),
        (
            "{kind: viscous, relief_force: 1}",
            "relief_force is not a key .*known here: kind",
        ),
    ],
)
def test_constants_are_checked(example, workplace, given, said):
    rpscli.load_case(
        "small.yaml", [f"podium.devices=[{OIL}]"]
    )  # its keys are known from here on
    with pytest.raises(CaseError, match=said):
        rpscli.load_case("small.yaml", [f"podium.devices=[{given}]"])


def test_what_is_broken_is_told_and_stays_alone(broken, rps, workplace):
    motion = rpscli.load_record("pulse:sine?amplitude=0.3g&period=0.5")
    assert motion.scaled_to("PGV", 1.0).npts == motion.npts  # ours stays ours
    named = r"XYZ of broken-plugins 1\.0 \(no_such_module:X\): ModuleNotFoundError"
    with pytest.raises(PluginError, match=named):
        motion.scaled_to("XYZ", 1.0)
    with pytest.raises(
        PluginError, match=r"flat of broken-plugins .* is 9.80665, and must be a f"
    ):
        load_target("flat:?a=1")
    with pytest.raises(PluginError, match=r"steep of broken-plugins .*: TypeError"):
        load_target("steep:?a=1")
    file = workplace / "plain.txt"
    file.write_text("0 0.1\n0.01 0.2\n0.02 0.1\n", encoding="utf-8")
    assert rpscli.load_record(f"{file}?units=g").npts == 3
    with pytest.raises(RecordError, match=r"units(?s:.*)tidy2 of broken-plugins 1\.0"):
        rpscli.load_record(str(file))
    (workplace / "study.yaml").write_text(STUDY.replace("worst: {count: 3}", "nothing"))
    result = rps("sweep", "study.yaml", "--dry-run", exit_code=1)
    assert "nothing of broken-plugins 1.0 (no_such_module:X)" in result.stderr
    listed = rps("explain", "plugins").stdout
    assert "rps has one of this name" in listed.replace("\n", " ")
    assert listed.count("broken-plugins") >= 6
    assert "ModuleNotFoundError" in rps("doctor").stdout.replace("\n", "")


LIARS = """\
import sys
import numpy as np
from rpscli.plugins import *
from rpscli.plugins import RecordFormat as Form

def measure(value):
    return IntensityMeasure("m/s", lambda *_: value)

nothing, text, numbers, turned = measure(None), measure("5"), measure([1.0]), measure(1j)
array, huge, nan = measure(np.ones(2)), measure(10**400), measure(np.nan)
ends = IntensityMeasure("m/s", lambda *_: sys.exit(0))

form = Form("form", (".form",), lambda text: text.lines[0][0] == "f", lambda text: None)
blind = Form("blind", (".blind",), lambda text: text.lines[0][0] == "b", lambda text: text)

def target(rest, source): return None
def short(rest, source):
    return TargetSpectrum("short", source, lambda periods: np.ones(1), pgv=None, rules="none")
def holed(rest, source):
    return TargetSpectrum("holed", source, lambda periods: periods * np.nan, pgv=None)
def quits(rest, source): raise SystemExit("bye")

def writes(axes, result): result.trace.rotation[:] = 0.0
def garbles(axes, result): axes.set_title("$\\\\frac{1$")

def linear(path, speed, c): return c * speed
def slope(c): return c
def raises(path, speed, c): raise RuntimeError("no law")
N = {"c_own": Quantity("N s/m", above=0)}
sound = DamperLaw(N, linear, slope, slope)
short_law = DamperLaw(N, lambda path, speed: speed, slope, slope)
unready = DamperLaw(N, linear, lambda c: None, slope)
raising = DamperLaw(N, raises, slope, slope)
ours = DamperLaw({"gap": Quantity("m")}, linear, slope, slope)
bounces = RestitutionLaw({}, lambda *_: 1.5)
late = {
    "unnamed": lambda: DamperLaw({"c_own": "N s/m"}, linear, slope, slope),
    "many": lambda: DamperLaw({f"c{i}": Quantity() for i in range(5)}, linear, slope, slope),
    "lacking": lambda: DamperLaw(N, linear),
}
def __getattr__(name):
    if name in late:
        return late[name]()
    raise AttributeError(name)

class Options(ReportOptions):
    pass

def report(found): return Report(Options, lambda study, options: found())
away = report(lambda: Found({"/../../x": [Column("a", "-", [1])]}, None))
uneven = report(lambda: Found({"": [Column("a", "-", [1]), Column("b", "-", [])]}, None))
plain = report(lambda: 5)
undrawn = report(lambda: Found({"": [Column("a", "-", [1])]}, lambda title: "no bytes"))
asks = Report(Options, lambda study, options: None, results=lambda _: 5)
"""
LAWS = {
    "short_law": "TypeError",
    "unready": "what slope gives is of type NoneType|what <lambda> gives is of type NoneType",
    "raising": "RuntimeError: no law",
    "unnamed": "must be a name with a Quantity",
    "ours": "gap must not be a key of rps; rename it",
    "many": "5 constants, at most 4",
    "lacking": "missing 1 required positional argument: 'damping'",
    "bounces": "must be DamperLaw",
}
LYING = {
    "formats": ["form", "blind"],
    "measures": ["nothing", "text", "numbers", "turned", "array", "huge", "nan", "ends"],
    "targets": ["target", "short", "holed", "quits"],
    "figures": ["writes", "garbles"],
    "reports": ["away", "uneven", "plain", "undrawn", "asks"],
}


@pytest.fixture
def liars(tmp_path, monkeypatch, forgotten):
    """A package that gives what it should not, under names that it should not have either."""
    groups = {
        kind: {name: f"liars:{name}" for name in names} for kind, names in LYING.items()
    }
    groups["figures"] |= {"../x": "liars:writes", "png": "liars:writes"}
    groups["dampers"] = {name: f"liars:{name}" for name in ("sound", *LAWS)}
    groups["impact_laws"] = {"bounces": "liars:bounces"}
    lines = (f"[rpscli.{kind}]\n" + "".join(f"{k} = {v}\n" for k, v in of.items())
             for kind, of in groups.items())  # fmt: skip
    as_installed(tmp_path / "site", "liars", "".join(lines))
    (tmp_path / "site" / "liars.py").write_text(LIARS, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path / "site")
    monkeypatch.delitem(sys.modules, "liars", raising=False)


def test_what_lies_is_named(liars, figures, rps, workplace):
    """Wrong values, names and ends of the process are faults of the package, and told as such."""
    motion = rpscli.load_record("pulse:sine?amplitude=0.3g&period=0.5")
    for name in LYING["measures"]:
        with pytest.raises(
            PluginError, match=f"{name} of liars 1.0 .*(finite number|SystemExit)"
        ):
            motion.scaled_to(name, 1.0)
    for name in ("target", "quits"):
        with pytest.raises(
            PluginError, match=f"{name} of liars 1.0 .*(TargetSpectrum|bye)"
        ):
            load_target(f"{name}:?")
    for name in ("short", "holed"):
        with pytest.raises(
            PluginError, match=f"{name} of liars 1.0 .*must be finite, a number"
        ):
            load_target(f"{name}:?").acceleration(np.array([0.1, 0.2]))
    for name in ("f.form", "b.txt"):
        (workplace / name).write_text(f"{name[0]} 0.1 0.2\n", encoding="utf-8")
        with pytest.raises(PluginError, match=r"of liars 1\.0 .* must be GroundMotion"):
            rpscli.load_record(f"{workplace / name}?units=g&dt=0.1")
    for name, reason in (
        ("writes", "read-only"),
        ("garbles", "ValueError"),
        ("../x", "letters"),
    ):
        words = (
            "timehistory",
            "small.yaml",
            "-o",
            "r",
            "--force",
            "--figures",
            f"png,{name}",
        )
        result = rps(*words, exit_code=None, says=(f"{name} of liars 1.0", reason))
        assert "internal" not in result.stderr
    for name in LYING["reports"]:
        text = STUDY.replace("worst: {count: 3}", name).replace("ASI", "PGA")
        (workplace / "study.yaml").write_text(text, encoding="utf-8")
        result = rps(
            "sweep", "study.yaml", "-o", "s", exit_code=None, says=f"{name} of liars 1.0"
        )
        assert "internal" not in result.stderr
    assert not [*workplace.parent.glob("x.*"), *workplace.rglob("x.*")]
    listed = rps("explain", "plugins").stdout
    assert listed.replace("\n", " ").count("taken") == 1


def test_laws_that_lie_are_named(liars, workplace):
    def used(name):
        constant = "gap: 1" if name == "ours" else "c_own: 1000"
        devices = f"podium.devices=[{{kind: {name}, {constant}}}]"
        structure = rpscli.load_case("small.yaml", [devices]).structure
        rpscli.demand(structure, rpscli.load_record("pulse:sine?amplitude=0.1g&period=1"))

    for name, said in LAWS.items():
        with pytest.raises(PluginError, match=f"{name} of liars 1.0 .*({said})"):
            used(name)
    assert "c_own" in str(schema_of("case"))
    with pytest.raises(
        PluginError, match=r"bounces of liars .*: its restitution is 1\.5"
    ):
        rpscli.load_case("small.yaml", ["podium.impact=bounces"])


def test_a_package_is_written_under_a_name_of_its_own(
    rps, rps_json, workplace, monkeypatch, forgotten
):
    """What is written is installed as it stands, and works."""
    told = rps("init", "--package", "my-dampers").stderr
    assert "next: pip install -e my-dampers" in told
    folder = workplace / "my-dampers"
    assert {each.name for each in folder.iterdir()} == {
        "pyproject.toml",
        "README.md",
        "my_dampers.py",
    }
    project = tomllib.loads((folder / "pyproject.toml").read_text("utf-8"))
    assert project["project"]["name"] == "my-dampers"
    assert project["tool"]["setuptools"]["py-modules"] == ["my_dampers"]
    points = project["project"]["entry-points"].items()
    lines = (
        f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in of.items())
        for group, of in points
    )
    as_installed(workplace / "site", "my-dampers", "".join(lines))
    monkeypatch.syspath_prepend(workplace / "site")
    monkeypatch.syspath_prepend(folder)
    found = rps_json("explain", "plugins")["plugins"]
    assert {each["package"] for each in found} == {"my-dampers 1.0"}
    assert not any(each["fault"] for each in found)
    rps("check", "small.yaml", *WITH_LAWS)
    (folder / "my_dampers.py").write_text("# mine\n", encoding="utf-8")
    rps("init", "--package", "my-dampers", exit_code=7, says="my_dampers.py exists")
    for name in ("json", "rpscli", "../x", "My", "9a", "class", "a--b"):
        rps("init", "--package", name, exit_code=2, says="small letters")
    rps("init", "--package", "a", "--study", exit_code=2, says="--package writes files")


def test_stored_points_know_the_file_of_a_law(liars, tmp_path, workplace):
    case = rpscli.load_case("small.yaml", ["podium.devices=[{kind: sound, c_own: 1000}]"])
    before = System.of_case(case).digest
    assert System.of_case(case).digest == before
    (tmp_path / "site" / "liars.py").write_text(
        f"{LIARS}# another law\n", encoding="utf-8"
    )
    assert System.of_case(case).digest != before


def test_nobody_is_asked_for_names_of_ours(forgotten, monkeypatch, workplace):
    entry_points = importlib.metadata.entry_points

    def asked(**given):
        assert not given.get("group", "").startswith("rpscli"), (
            "other packages were looked for"
        )
        return entry_points(**given)  # of numba

    monkeypatch.setattr("importlib.metadata.entry_points", asked)
    case = rpscli.load_case(workplace / "small.yaml")
    motion = rpscli.load_record("pulse:sine?amplitude=0.3g&period=0.5").scaled_to(
        "PGA", 1.0
    )
    rpscli.demand(case.structure, motion)
    text = STUDY.replace("ASI", "Housner").replace("worst: {count: 3}", "overturning")
    (workplace / "study.yaml").write_text(text, encoding="utf-8")
    rpscli.load_study("study.yaml")
    assert load_target("en1998:?ag=1 m/s2&soil=A").name
    assert "PEER AT2" in FORMATS
    assert "sp14" in CODES
    assert "CAV" in MEASURES


@pytest.mark.long
def test_the_example_is_installed_by_pip(tmp_path, workplace):
    """As users do it, into a folder of its own; pip fetches what builds it."""
    site = tmp_path / "site"
    install, *lines = of_blocks(EXAMPLE / "README.md")
    shutil.copytree(EXAMPLE, tmp_path / "package")  # where what is built may stay
    install = install.replace(
        "-e .", f"--no-deps --quiet --target {site} {tmp_path / 'package'}"
    )
    search = os.pathsep.join([str(site), str(ROOT)])
    run_in_shell(install)
    printed = []
    for line in lines:
        words = [sys.executable, "-m", "rpscli", *command(line).words]
        words = [
            str(ROOT / word) if word.startswith("cases/") else word for word in words
        ]
        printed.append(run_in_shell(shlex.join(words), PYTHONPATH=search))
    assert printed[0].count("rps-example 1.0") == 8
    assert "ASI" in printed[1]
    assert list(workplace.rglob("phase_plane.png"))
    assert list(workplace.rglob("selection.txt"))
