"""Results of the files that reproduce the paper, computed once for all tests."""

import csv
from pathlib import Path

import pytest
from click.testing import CliRunner

from rpscli.cli import program

CASES = Path(__file__).parents[2] / "cases" / "compdyn2021"


def rows_of(path):
    """Rows of a CSV file; units are taken out of the header."""
    with path.open(encoding="utf-8", newline="") as file:
        return [
            {key.partition(" [")[0]: value for key, value in row.items()}
            for row in csv.DictReader(file)
        ]


@pytest.fixture(scope="session")
def reproduce(tmp_path_factory):
    """Run a study of the folder (once) and read one of its tables; figures are left out."""
    folders = {}

    def read(study, table, *overrides):
        key = (study, *overrides)
        if key not in folders:
            folder = tmp_path_factory.mktemp(study)
            options = [word for override in overrides for word in ("--set", override)]
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(
                    "rpscli.report.figures.style.picture", lambda *_: b"a figure"
                )
                command = [
                    "sweep",
                    str(CASES / f"{study}.yaml"),
                    "-o",
                    str(folder),
                    *options,
                ]
                result = CliRunner().invoke(program, command)
            assert result.exit_code == 0, result.stderr
            folders[key] = folder
        return rows_of(folders[key] / f"{table}.csv")

    return read
