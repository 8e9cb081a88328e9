"""Every command that a text shows, and which test runs it.

A page is a document, a file with comments, or a workflow. `rps_lines` and `of_texts`
read its commands, `run` runs one, and `PAGES` says where: nothing that is shown may be missing.
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from click.testing import CliRunner

from rpscli.cli import program

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "rpscli"
GUIDE, THEORY, VERIFICATION, CONFORMANCE, ERRATA = (
    PACKAGE / f"{x}.md"
    for x in ("GUIDE", "THEORY", "VERIFICATION", "CONFORMANCE", "ERRATA")
)

QUICK = "tests/test_readme.py::test_commands_run_in_their_order"
LONG = "tests/test_readme.py::test_commands_of_a_page_run"
GALLERY = "tests/test_readme.py::test_the_gallery_shows_what_its_commands_give"
GRANITE = "tests/sweep/test_granite.py::test_the_readme_shows_what_its_commands_give"
TUTORIALS = (
    "tests/test_tutorials.py::test_commands_of_tutorials_run_and_print_what_is_shown"
)
PULLED = (
    "tests/tools/identify/test_pull_back.py::test_the_page_shows_what_its_command_gives"
)
PLUGINS = "tests/commands/test_plugins.py::test_the_example_is_installed_by_pip"
PIPELINE = "tests/test_readme.py::test_the_job_for_a_pipeline_runs"
BENCHMARKS = "tests/benchmarks/test_installed.py::test_a_little_of_the_benchmark_runs"
ENGINE = "tests/oracles/test_multibody.py::test_blocks_of_the_table_of_the_verification"
CHANGES_OF_LAW = "tests/report/test_studies.py::test_changes_of_the_impact_law_are_mapped"
SET_UP = "tests/test_readme.py::test_set_up_commands_run"

PAGES = {
    "README.md": (QUICK, LONG),
    "rpscli/GUIDE.md": (QUICK, LONG),
    "cases/README.md": (GALLERY,),
    "cases/granite/README.md": (GRANITE,),
    "rpscli/tutorials/figure.md": (TUTORIALS,),
    "rpscli/tutorials/verdict.md": (TUTORIALS,),
    "cases/pull_back/README.md": (PULLED,),
    "cases/pull_back/sochi.yaml": (PULLED,),
    "tests/example_package/README.md": (PLUGINS,),
    ".github/workflows/acceptance.yml": (PIPELINE,),
} | dict.fromkeys(
    (
        "rpscli/VERIFICATION.md",
        "rpscli/CONFORMANCE.md",
        "rpscli/analyses/certified/README.md",
        "rpscli/case/starter.yaml",
        "rpscli/case/starter_study.yaml",
        "cases/both_components.yaml",
        "cases/engineers_building.yaml",
        "cases/floors_on_springs.yaml",
        "cases/friction_dampers.yaml",
        "cases/measured_period.yaml",
        "cases/yielding_storeys.yaml",
        "cases/compdyn2021/README.md",
        "cases/studies/contact/README.md",
        "cases/studies/joints_both/README.md",
        "cases/studies/impact_law/README.md",
        "cases/studies/product.yaml",
        ".github/SUPPORT.md",
        ".github/workflows/pages.yml",
        ".github/workflows/tests.yml",
        ".ci/conda/recipe.yaml",
    ),
    (LONG,),
)
"""Pages and the tests that run their `rps` commands: blocks of the first two are run quickly."""

OTHERS = {
    r"pytest( |$)": ".ci/run runs the tests",
    r"\.ci/run$": "it is what runs the tests",
    r"\bpip install": SET_UP,
    r"venv/bin/activate": SET_UP,
    r"granite/(convert|judged)\.py": GRANITE,
    r"impact_law/changes\.py": CHANGES_OF_LAW,
    r"benchmarks\.histories": BENCHMARKS,
    r"benchmarks\.pairs": BENCHMARKS.replace("benchmark_runs", "benchmark_of_pairs_runs"),
    r"oracles\.resolved_contact": ENGINE,
}
"""Other lines of blocks, and what runs them."""

CHANGES = "CHANGELOG.md"
"""It tells what was new, and shows no commands to repeat."""

STANDS_FOR = {
    "COMMAND": "sweep",
    "WORD": "slenderness",
    "explain NAME": "explain risk",
    "NAME": "rigid_frame",
    "CASE": "cases/six_storey.yaml",
    "FOLDER": "certified_problems",
    "FILE.csv": "problems/answers.csv",
}
"""What a reader fills in."""


class Block(NamedTuple):
    """A fenced block of a document."""

    language: str
    text: str


def blocks(document):
    fences = re.findall(
        r"^```(\w*)\n(.*?)^```$", document.read_text("utf-8"), re.MULTILINE | re.DOTALL
    )
    return [Block(*fence) for fence in fences]


def of_blocks(document, language="sh"):
    """Lines of its blocks in a language."""
    return [
        of
        for b in blocks(document)
        if b.language == language
        for of in b.text.splitlines()
    ]


def rps_lines(page):
    """Lines of its blocks that begin with `rps`."""
    return [line for line in of_blocks(page) if line.startswith("rps ")]


def of_texts(page):
    """`rps` commands with arguments that stand in sentences, comments or steps of a workflow."""
    text = page.read_text("utf-8")
    if page.suffix == ".md":
        flat = re.sub(
            r"\s+", " ", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
        )
        lines = re.findall(r"`(rps [A-Za-z-]+ [^`]+)`", flat)
    elif page.suffix == ".yaml":
        told = re.findall(r"^(?:#  | +-) (rps [a-z-]+.*?)(  +.*)?$", text, re.MULTILINE)
        lines = [f"{line}  # {meaning}" if meaning else line for line, meaning in told]
    else:
        lines = re.findall(r"^\s+(?:- )?(?:run: )?(rps .*)$", text, re.MULTILINE)
    named = (
        line
        for line in dict.fromkeys(lines)
        if not re.fullmatch(r"rps record [a-z]+", line)
    )
    return [line for line in named if "=" not in line.split()[1]]


def pages():
    """Whatever may show commands, by its place."""
    found = [
        *ROOT.glob("*.md"),
        *(ROOT / ".ci").rglob("*.yaml"),
        *(ROOT / ".github").rglob("*.*"),
    ]
    found += [
        path for folder in ("rpscli", "cases") for path in (ROOT / folder).rglob("*.*")
    ]
    found += (ROOT / "tests").rglob("README.md")
    named = {path.relative_to(ROOT).as_posix(): path for path in sorted(found)}
    return {
        name: path
        for name, path in named.items()
        if path.suffix in {".md", ".yaml", ".yml"} and name != CHANGES
    }


class Command(NamedTuple):
    """A line: words after `rps`, and the exit code that its comment announces."""

    words: list[str]
    exit_code: int


def command(line):
    announced = re.search(r"#.*\bexit code (\d+)", line)
    for word, value in STANDS_FOR.items():
        line = re.sub(rf"(?<=[ ']){re.escape(word)}(?= |$)", value, line)
    _, *words = shlex.split(line, comments=True)
    return Command(words, int(announced[1]) if announced else 0)


def run(line):
    """A line with `rps`, in the working folder."""
    return CliRunner().invoke(program, command(line).words)


def run_all(lines):
    """Run lines one after another; what each of them printed."""
    outputs = {}
    for line in lines:
        result = run(line)
        assert result.exit_code == command(line).exit_code, f"{line}\n{result.output}"
        outputs[line.partition("#")[0].rstrip()] = result.output
    return outputs


def run_in_shell(line, **variables):
    """Any other line, with the Python that runs the tests; what it printed."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    environment = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT), **variables}
    done = subprocess.run(
        ["bash", "-c", line], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
    return done.stdout


def shown_outputs(document):
    """Each output that is shown, and the command before it."""
    found, last = [], ""
    for block in document:
        if block.language == "sh":
            last = block.text.splitlines()[-1].rpartition("rps ")[2]
        elif block.language == "text":
            found.append((f"rps {last.partition('#')[0].rstrip()}", block.text))
    return found


def not_printed(shown, output):
    """Lines that are shown and not printed, whatever the spaces between their columns.

    Columns are as wide as their widest number, of which the residual's has the digits of rounding.
    """
    printed = [" ".join(row.split()) for row in output.splitlines()]
    return [row for row in shown.splitlines() if " ".join(row.split()) not in printed]


def table(document, below):
    """Cells of the first table below some words: those of its head, then its rows."""
    rows = (
        document.read_text("utf-8")
        .partition(below)[2]
        .partition("\n|")[2]
        .split("\n\n")[0]
    )
    cells = [[c.strip() for c in row.strip("|").split("|")] for row in rows.splitlines()]
    return [cells[0], *cells[2:]]


NUMBER = re.compile(r"(?<![\w.])(?:(?<![\d-])[-+])?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?")


def told(document, after, *computed):
    """The numbers that follow some words, with "..." between them, are these, as far as shown."""
    text = " ".join(document.read_text("utf-8").split())
    for words in after.split(" ... "):
        _, found, text = text.partition(words)
        assert found, words
    for number, value in zip(NUMBER.findall(text), map(float, computed), strict=False):
        digits, _, power = number.rstrip(".").partition("e")
        last = 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
        assert abs(float(number) - value) < 0.502 * last, (after, number, value)
