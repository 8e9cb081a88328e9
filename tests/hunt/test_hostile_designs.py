"""Damaged design files, studies that no file could say, films, drawings, reports and pages."""

import math
import re
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from hunt.test_hostile_files import CASE_KEYS, CASES, VALUES
from hunt.trials import LONGEST_LINE, PROMISED, hunt, hunted, judged, mutated, shares
from rpscli import load_case, load_record, load_study
from rpscli.case.schema.keys import key_references, known_paths
from rpscli.cli import program
from rpscli.errors import CaseError, RpsError, UsageError
from rpscli.report.figures.look import read_style
from rpscli.report.study.registry import REPORTS
from rpscli.tools.design.keys import DesignFile, parse_design

pytestmark = pytest.mark.posix  # trials are timed by its signals

DESIGN = f"""rps: 1
base: {CASES}/six_storey.yaml
variables: {{podium.bearing.semi_diagonal: [0.8, 2.0], podium.bearing.slenderness: [0.1, 0.2]}}
linked: {{podium.bearing.wedge_slenderness: {{podium.bearing.slenderness: 2, plus: 0.01}}}}
records: ["pulse:sine?amplitude=0.3g&period=0.8", "pulse:sine?amplitude=0.2g&period=1"]
limits: {{rotation_ratio: 0.5, max_roof_displacement: 0.5 m}}
whole_histories: true
minimise: {{podium.bearing.semi_diagonal: 1, max_base_shear: {{times: 1e-6, fractile: 0.84}}}}
validate: {{share: 0.5}}
search: {{first: 4, most: 8, resamples: 0}}
"""
DESIGN_KEYS = [".".join(map(str, path)) for path in known_paths(DesignFile)]
HUGE = 10**390


def test_the_design_is_sound():
    Path("design.yaml").write_text(DESIGN, encoding="utf-8")
    assert judged("design", "design.yaml", "--dry-run") == "done"


@hunted("designs", 6, 1200)
def test_designs(random):
    Path("design.yaml").write_text(
        mutated(DESIGN, random), encoding="utf-8", errors="replace"
    )
    return judged("design", "design.yaml", "--dry-run", places=("design.yaml", ".yaml:"))


@shares
def test_values_of_designs(long):
    values = [*VALUES, str(HUGE), "[1, 2]", "[2, 1]", "[.nan, 1]", f"[1, {HUGE}]"]
    sums = [
        "{podium.bearing.slenderness: 1e308, plus: 1e308}",
        "{max_rotation: {fractile: 2}}",
    ]

    def trial(random):
        Path("design.yaml").write_text(DESIGN, encoding="utf-8")
        change = f"{random.choice([*DESIGN_KEYS, *CASE_KEYS])}={random.choice([*values, *sums])}"
        return judged("design", "design.yaml", "--dry-run", "--set", change)

    hunt("values of designs", trial, 6, 800 if long else None)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            f"variables: {{podium.bearing.semi_diagonal: [0.8, {HUGE}]}}",
            "must be two numbers",
        ),
        (f"linked: {{superstructure.storeys: {{plus: {HUGE}}}}}", "must be a linear sum"),
        (
            "linked: {superstructure.storeys: {podium.bearing.slenderness: 1e308}}",
            "up to 1e+15",
        ),
        (f"scale: [{HUGE}]", "must be a finite number"),
        (
            "variables: {podium.bearing.semi_diagonal: [1, 1]}",
            "or leave the key to the case",
        ),
        ("scale: {factor: [1, 2]}", "scale.factor is not a key"),
        ("validate: {records: 3}", "must be a list"),
        (
            "minimise: {max_rotation: {times: 1, x: 2}}",
            "max_rotation.x is not a key",
        ),
    ],
)
def test_slips_in_designs_are_told(line, said):
    key = line.split(":", maxsplit=1)[0] + ":"
    text = "\n".join(
        [*(old for old in DESIGN.splitlines() if not old.startswith(key)), line]
    )
    with pytest.raises(CaseError, match=re.escape(said)):
        parse_design(text, "design.yaml")


STUDY = {
    "rps": 1,
    "analysis": "pushover",
    "base": f"{CASES}/rigid_frame.yaml",
}
CIRCLE = []
CIRCLE.append(CIRCLE)


@pytest.mark.parametrize("value", [CIRCLE, object(), {1, 2}, 1j, b"x", {(1, 2): 3}])
def test_studies_that_no_file_could_say(value):
    with pytest.raises(CaseError, match="cannot be written to a file"):
        load_study(STUDY | {"title": value})


def test_studies_say_paths_and_refuse_numbers_that_are_none():
    study = load_study(STUDY | {"base": CASES / "rigid_frame.yaml"})
    assert len(study) == 1
    for jobs in (0, -1, 10**9):
        with pytest.raises(UsageError, match="jobs"):
            study.run(jobs=jobs)
    with pytest.raises(CaseError, match="finite"):
        load_study(STUDY | {"vary": [{"podium.bearing.slenderness": [math.nan]}]})
    with pytest.raises(KeyError, match="not a column"):
        study.run()[3]


PLACES = ["x" * 5000, f"new/{'x' * 5000}", "a/" * 3000, "a\0b", "file/x"]


@pytest.mark.parametrize(
    "place", PLACES, ids=["name", "path", "depth", "zero byte", "file"]
)
def test_folders_that_cannot_be_are_told_to_python_as_well(place):
    Path("file").touch()
    study = load_study(STUDY)
    result = study.run()
    calls = [
        lambda: study.run(place),
        lambda: result.write(place),
        lambda: result.write("new", style=place),
        lambda: load_study(place),
        lambda: load_case(place),
        lambda: load_record(place),
    ]
    for call in calls:
        with pytest.raises(RpsError) as refusal:
            call()
        assert len(str(refusal.value)) < LONGEST_LINE
    assert [each.name for each in Path().iterdir()] == ["file"]


FILMS = [f"{'x' * 300}.gif", "file/a.gif", "folder.gif", "a.gif", "a.mp4", "a", "a.avi"]
REALS = ["0", "nan", "inf", "-1", "1e-300", "1e300", "0.5", "2", "1e9", "x"]
FILM_OPTIONS = ["--animate-speed", "--animate-from", "--animate-to", "--animate-size"]


@shares
def test_films(long):
    """What cannot be shown is refused, most of it before the history, and leaves nothing behind."""
    case, record = f"{CASES}/rigid_frame.yaml", "pulse:sine?amplitude=0.3g&period=0.8"

    def trial(random):
        Path("file").touch()
        Path("folder.gif").mkdir(exist_ok=True)
        before = {*Path().rglob("*")}
        chosen = random.sample(FILM_OPTIONS, random.choice([1, 1, 2]))
        wishes = [word for option in chosen for word in (option, random.choice(REALS))]
        arguments = [
            "--record",
            record,
            "--animate",
            random.choice(FILMS),
            *wishes,
            "-o",
            "out",
        ]
        result = CliRunner().invoke(
            program, ["timehistory", case, *arguments, "--figures", "none", "--force"]
        )
        shown = f"{' '.join(arguments)[:300]}: {result.stderr[-500:]}"
        assert "internal error" not in result.stderr, shown
        if result.exit_code:
            # The command line is at fault, or the place: no input is.
            assert result.exit_code in {1, 2}, shown
            assert "error: " in result.stderr, shown
            assert max(map(len, result.stderr.splitlines())) <= LONGEST_LINE, shown
            assert not [
                each for each in {*Path().rglob("*")} - before if each.is_file()
            ], shown
        return f"exit {result.exit_code}"

    hunt("films", trial, 8, 200 if long else None)


EXTREMES = {
    "podium.bearing.semi_diagonal": ["1e-9", "1e9", "1e300", "0"],
    "podium.bearing.slenderness": ["1e-12", "0.2999999", "0.3", "10", "1e300"],
    "podium.bearing.wedge_slenderness": ["0.1500000001", "0.999", "1", "1e9"],
    "podium.bearing.curvature_ratio": ["0", "0.075", "1e-9", "1e9", "critical"],
    "superstructure": ["null", "{storeys: 1}"],
    "title": ["$\\frac{$", "''", f"{'y' * 4000}", "日本語"],
    "podium.devices": [
        "[{kind: stop, gap: 1e9, stiffness: 1}]",
        "[{kind: stop, gap: 1e-9, stiffness: 1e9}]",
        "[{kind: tendon, stiffness: 1e7, prestress: 1}]",
    ],
}


@hunted("drawings", 4, 300)
def test_drawings_of_bearings(random):
    keys = random.sample(list(EXTREMES), random.choice([1, 1, 2]))
    changes = [f"{key}={random.choice(EXTREMES[key])}" for key in keys]
    options = [word for change in changes for word in ("--set", change)]
    case, formats = f"{CASES}/rigid_frame.yaml", random.choice(["png", "svg,pdf"])
    end = judged("check", case, "--draw", "--figures", formats, "-o", "drawn", *options)
    if end == "done":
        assert all(
            Path("drawn", f"bearing.{each}").is_file() for each in formats.split(",")
        )
    return end


def test_styles_are_files(tmp_path):
    for place in ("/dev/zero", str(tmp_path), "a\0b"):
        with pytest.raises(UsageError, match="cannot be read"):
            read_style(Path(place))


COMPUTED = f"""rps: 1
base: {CASES}/six_storey.yaml
vary: [{{podium.bearing.slenderness: [0.12, 0.15]}}, {{podium.bearing.semi_diagonal: [0.5, 1.5]}}]
records: ["pulse:sine?amplitude=0.3g&period=0.8", "pulse:sine?amplitude=0.2g&period=1"]
scale: {{measure: PGA, values: [0.2 g, 0.6 g]}}
"""
REPORT_OPTIONS = {
    kind: [key.key for key in key_references(report.options)]
    for kind, report in REPORTS.items()
    if kind != "floor_spectra"  # which takes seconds for each history
}
LIKELY = (
    "scale", "record", "podium.bearing.slenderness", "podium.bearing.semi_diagonal", "PGA", "PGV",
    "max_rotation", "rotation_ratio", "drift_ratio", "[max_rotation, drift_ratio]", "0.5", "median",
    "overturned", "{rotation_ratio: 0.5}", "[0.1, 0.2]",
)  # fmt: skip
EMPTY = b'<svg xmlns="http://www.w3.org/2000/svg" width="1pt" height="1pt"/>'


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """A study and a history that were computed."""
    folder = tmp_path_factory.mktemp("stored")
    (folder / "study.yaml").write_text(COMPUTED, encoding="utf-8")
    none = ("--figures", "none", "-q")
    assert (
        judged("sweep", str(folder / "study.yaml"), "-o", str(folder / "sweep"), *none)
        == "exit 10"
    )
    source = "pulse:sine?amplitude=0.2g&period=0.8"
    command = ("timehistory", f"{CASES}/six_storey.yaml", "--record", source)
    assert judged(*command, "-o", str(folder / "history"), *none) == "done"
    return folder


@shares
def test_options_of_reports(stored, long):
    def trial(random):
        kind, keys = random.choice([*REPORT_OPTIONS.items()])
        options = ", ".join(
            f"{key}: {random.choice([*LIKELY, *LIKELY, random.choice(VALUES)])}"
            for key in random.sample(keys, min(random.randrange(4), len(keys)))
            if "." not in key
        )
        place = (
            "-o",
            str(stored / "sweep"),
            "--figures",
            "none",
            "--report-only",
            "--json",
        )
        change = f"reports=[{{{kind}: {{{options}}}}}]"
        return judged("sweep", str(stored / "study.yaml"), "--set", change, *place)

    hunt("options of reports", trial, 2, 1000 if long else None)


@shares
def test_pages_of_damaged_results(stored, long, tmp_path, monkeypatch):
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: EMPTY)

    def trial(random):
        folder = tmp_path / "copy"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(stored / random.choice(["sweep", "history"]), folder)
        file = folder / random.choice(["run.json", "run.json", "summary.json"])
        before = file.read_text(encoding="utf-8") if file.is_file() else "{}"
        file.write_text(mutated(before, random), encoding="utf-8", errors="replace")
        return judged(
            "report", str(folder), "-o", "page.html", "--force", codes=PROMISED | {2}
        )

    hunt("pages of damaged results", trial, 3, 400 if long else None)
