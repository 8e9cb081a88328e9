"""What is not imported does not cost the user a second."""

import json
import shlex

import pytest
from paper_structures import printed_by, python

from rpscli.commands.registry import OURS
from rpscli.registry import of_tools

HEAVY = {"llvmlite", "scipy", "matplotlib", "pydantic", "yaml", "rich", "numpy"}
SCRIPT = """
import atexit, json, sys
from rpscli.cli import program
atexit.register(lambda: print(json.dumps(sorted(sys.modules)), file=sys.stderr))
program(sys.argv[1:])
"""


def imported(folder, *arguments):
    """Modules that a command has imported when it ends."""
    return set(
        json.loads(
            python("-c", SCRIPT, *arguments, folder=folder).stderr.splitlines()[-1]
        )
    )


PICTURES_AND_KERNELS = {"llvmlite", "scipy", "matplotlib"}
UNITS = (
    "'--set=superstructure.storey_mass=200 t' '--set=podium.bearing.semi_diagonal=150 cm'"
)


@pytest.mark.parametrize(
    ("line", "without"),
    [
        *((line, HEAVY) for line in ("--help", "--version")),
        *((f"{command} --help", HEAVY) for command in [*OURS, *of_tools("commands")]),
        ("check small.yaml --json", {*PICTURES_AND_KERNELS, "rich"}),
        (f"check small.yaml {UNITS}", {*PICTURES_AND_KERNELS, "rpscli.records.formats"}),
        ("modal small.yaml", {"llvmlite", "scipy"}),
    ],
)
def test_commands_import_what_they_need(workplace, line, without):
    assert not imported(workplace, *shlex.split(line)) & without


def test_a_document_of_an_error_needs_no_numpy():
    python(
        "-c",
        "import sys, rpscli.commands.shell.terminal; sys.exit('numpy' in sys.modules)",
    )


def test_the_package_itself_imports_nothing():
    code = "import sys, rpscli; print(sorted(m for m in sys.modules if m.startswith('rpscli')))"
    assert printed_by("-c", code).strip() == "['rpscli']"
