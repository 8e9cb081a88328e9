"""What is not imported does not cost the user a second."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from rpscli.cli import COMMANDS

HEAVY = {"numba", "scipy", "matplotlib", "pydantic", "yaml", "rich", "numpy"}
SCRIPT = """
import atexit, json, sys
from rpscli.cli import program
atexit.register(lambda: print(json.dumps(sorted(sys.modules)), file=sys.stderr))
program(sys.argv[1:])
"""


def ran(code: str, *arguments: str, folder: Path | None = None) -> tuple[str, str]:
    """Both streams of a program in a process of its own."""
    result = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
        capture_output=True,
        text=True,
        check=True,
    )
    return result.stdout, result.stderr


def imported(folder: Path, *arguments: str) -> set[str]:
    """Modules that a command has imported when it ends."""
    return set(json.loads(ran(SCRIPT, *arguments, folder=folder)[1].splitlines()[-1]))


@pytest.mark.parametrize("command", [["--help"], ["--version"]], ids=" ".join)
def test_help_and_version_import_nothing_heavy(workplace: Path, command: list[str]) -> None:
    assert not imported(workplace, *command) & HEAVY


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_of_a_command_imports_nothing_heavy(workplace: Path, command: str) -> None:
    assert not imported(workplace, command, "--help") & HEAVY


def test_check_needs_no_kernels_and_no_pictures(workplace: Path) -> None:
    found = imported(workplace, "check", "small.yaml", "--json")
    assert not found & {"numba", "scipy", "matplotlib", "rich"}


def test_check_with_common_units_needs_no_library_of_units(workplace: Path) -> None:
    units = ["superstructure.storey_mass=200 t", "podium.bearing.semi_diagonal=150 cm"]
    found = imported(workplace, "check", "small.yaml", *(f"--set={unit}" for unit in units))
    assert not found & {"numba", "scipy", "matplotlib", "rpscli.records.formats"}


def test_a_document_of_an_error_needs_no_numpy() -> None:
    ran("import sys, rpscli.commands.shell.terminal; sys.exit('numpy' in sys.modules)")


def test_modal_without_its_picture_is_plain_numpy(workplace: Path) -> None:
    assert not imported(workplace, "modal", "small.yaml") & {"numba", "scipy"}


def test_the_package_itself_imports_nothing() -> None:
    code = "import sys, rpscli; print(sorted(m for m in sys.modules if m.startswith('rpscli')))"
    assert ran(code)[0].strip() == "['rpscli']"
