"""A command line in a working folder of its own."""

import csv
import importlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from sweep.small_studies import BASE, ROOT

from rpscli import registry
from rpscli.cli import program
from rpscli.commands.registry import others

SMALL_CASE = (
    BASE.replace("superstructure:", 'title: "Three storeys [test]"\nsuperstructure:', 1)
    .replace("storey_mass: 200000", "storey_mass: [200000, 200000, 150000]")
    .replace(
        "analysis",
        'record: {source: "pulse:half_sine?amplitude=0.3g&period=0.6"}\nanalysis',
    )
)


def columns(path):
    """A CSV file by its header."""
    with path.open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    return {
        name: list(values)
        for name, values in zip(head, zip(*rows, strict=True), strict=True)
    }


def write_case(name, *changes, more=""):
    """Write the case that takes no time into the working folder, with changes and more below."""
    text = SMALL_CASE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    Path(name).write_text(text + more, encoding="utf-8")


def _refuse(constant):
    raise AssertionError(f"{constant} is no JSON")


@pytest.fixture
def workplace(tmp_path, monkeypatch):
    """An empty working folder with a case that takes no time."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("COLUMNS", raising=False)
    write_case("small.yaml")
    return tmp_path


@pytest.fixture
def figures():
    """Asked for by tests that want real figures."""


@pytest.fixture(autouse=True)
def _figures_cost_nothing(request, monkeypatch):
    """What figures look like is tested elsewhere; here they only have to be written."""
    if "figures" not in request.fixturenames:
        monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"a figure")


@pytest.fixture
def rps(workplace):
    """Run `rps` in this process, to the end with this exit code; what it says on standard error."""

    def invoke(*arguments, exit_code=0, says=(), **options):
        result = CliRunner().invoke(program, arguments, **options)
        assert exit_code in {None, result.exit_code}, result.stderr
        for text in (says,) if isinstance(says, str) else says:
            assert text in result.stderr
        return result

    return invoke


@pytest.fixture
def rps_json(rps):
    """Run `rps ... --json`; the standard output must hold one document and nothing else."""

    def invoke(*arguments, exit_code=0, **options):
        result = rps(*arguments, "--json", exit_code=exit_code, **options)
        document = json.loads(result.stdout, parse_constant=_refuse)
        assert document["schema_version"] == 1
        return document

    return invoke


@pytest.fixture
def shell(workplace):
    """Run a line of bash in which ``rps`` is the program, in a process of its own."""

    def run(line, **environment):
        search = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
        function = f'rps() {{ "{sys.executable}" -m rpscli "$@"; }}\n'
        return subprocess.run(
            ["bash", "-c", function + line],
            cwd=workplace,
            env={**os.environ, "PYTHONPATH": search, **environment},
            capture_output=True,
            text=True,
            check=False,
            timeout=120,
        )

    return run


@pytest.fixture
def forgotten():
    """What is installed is looked for anew."""

    def forget():
        importlib.invalidate_caches()
        registry._points.cache_clear()
        registry._loaded.cache_clear()
        others.cache_clear()

    forget()
    yield
    forget()
