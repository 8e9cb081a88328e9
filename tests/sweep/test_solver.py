"""The digest that guards stored results covers every source that makes them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import rpscli
from rpscli.sweep.context import SOLVING, digest_of_sources

PACKAGE = Path(rpscli.__file__).parent


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources."""
    copy = tmp_path_factory.mktemp("sources") / "rpscli"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    return copy


@pytest.mark.parametrize("name", SOLVING)
def test_a_changed_source_changes_the_digest(package: Path, name: str) -> None:
    place = package / name
    sources = [place] if place.is_file() else sorted(place.rglob("*.py"))
    assert sources, "every name stands for a source"
    before = digest_of_sources(package)
    for source in sources:
        text = source.read_text()
        source.write_text(f"{text}\n")
        assert digest_of_sources(package) != before, source
        source.write_text(text)
    assert digest_of_sources(package) == before


def test_every_module_behind_a_stored_number_counts() -> None:
    script = """
import sys
import rpscli.sweep.evaluation
print(*(m.__file__ for n, m in sys.modules.items() if n.startswith("rpscli.")), sep=chr(10))
"""
    paths = [str(PACKAGE.parent), *sys.path]
    done = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
        capture_output=True,
        text=True,
        check=True,
    )
    modules = {Path(line).relative_to(PACKAGE).as_posix() for line in done.stdout.split()}
    counted = {name for name in modules if name.startswith(tuple(SOLVING))}
    assert "analyses/demand.py" in counted
    others = {"errors.py", "machine.py", "shown.py", "sweep/__init__.py", "version.py"}
    assert modules - counted == others
