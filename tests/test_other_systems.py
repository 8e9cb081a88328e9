"""What Windows, macOS and plain network folders do otherwise, simulated where the program asks.

Each difference has one place in `rpscli`: paths and the cache in `user_cache`, cores in `machine`,
locks of folders in `report.files`, of stores in `sweep.store`, Ctrl-C in `sweep.run`, pipes
and encodings of files in `case.text.files`, those of the console in `commands.shell.terminal`.
"""

import errno
import os
import re
import shutil
import signal
import sqlite3
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from paper_structures import known, python

from rpscli import user_cache
from rpscli.cli import program
from rpscli.errors import RecordError
from rpscli.machine import available_cores
from rpscli.records.loading import load_record
from rpscli.report.figures.look import quiet_matplotlib
from rpscli.report.files import locked, write_whole
from rpscli.sweep.run import first_interrupt
from rpscli.sweep.store import Store

ROOT = Path(__file__).parents[1]
SOURCES = sorted((ROOT / "rpscli").rglob("*.py"))
STUDY = """\
rps: 1
base: case.yaml
analysis: modal
vary: [{podium.bearing.slenderness: [0.1, 0.15]}]
"""
SEAMS = {
    "fcntl": {"report/files.py"},
    "getuid": {"user_cache.py"},
    "sched_getaffinity": {"machine.py"},
    "O_NONBLOCK": {"case/text/files.py"},
    "mkfifo": set[str](),
    "fork": set[str](),
    "SIGTERM": set[str](),
    "SIGKILL": set[str](),
    "SIGINT": {"sweep/run.py"},
    "sqlite3": {"sweep/store.py", "user_cache.py"},
}
"""What is not the same everywhere, and the only files that may name it."""


def rps(*words, exit_code=0):
    """What a command prints, which ends with this exit code."""
    result = CliRunner().invoke(program, words)
    assert result.exit_code == exit_code, result.output
    return result.output


@pytest.fixture
def windows(tmp_path, monkeypatch):
    """What Python has on Linux alone, or not on Windows, is not there."""
    for name in (
        "fork",
        "forkpty",
        "getuid",
        "sched_getaffinity",
        "O_NONBLOCK",
        "mkfifo",
    ):
        monkeypatch.delattr(os, name, raising=False)
    for name in ("SIGKILL", "SIGHUP", "SIGALRM", "SIGUSR1"):
        monkeypatch.delattr(signal, name, raising=False)
    for module in ("fcntl", "termios", "resource", "pwd"):
        monkeypatch.setitem(sys.modules, module, None)  # then importing it fails
    monkeypatch.setattr(
        user_cache, "is_private", lambda _: True
    )  # as its first line says there


def test_what_differs_between_systems_is_named_in_one_place():
    found = {name: set() for name in SEAMS}
    for path in SOURCES:
        for name in re.findall(
            rf"(?:import |\.)({'|'.join(SEAMS)})\b", path.read_text("utf-8")
        ):
            found[name].add(path.relative_to(ROOT / "rpscli").as_posix())
    assert found == SEAMS


@pytest.mark.usefixtures("windows")
def test_commands_run_as_on_windows(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    none = ("--figures", "none")
    for words in (
        ("init", "case.yaml"),
        ("doctor",),
        ("check", "case.yaml"),
        ("pushover", "case.yaml", *none),
        ("sweep", "study.yaml", *none),
        ("sweep", "study.yaml", *none),  # over the results of the first
    ):
        rps(*words)
    assert available_cores() == os.cpu_count()


def test_windows_asks_for_no_owner(tmp_path, monkeypatch):
    tmp_path.chmod(0o777)
    with monkeypatch.context() as patch:
        patch.setattr(os, "name", "nt")
        assert user_cache.is_private(tmp_path)


@pytest.mark.parametrize("system", ["linux", "darwin", "win32"])
@pytest.mark.parametrize("home", ["home", "~"])
def test_homes_get_no_folders_of_names_that_nobody_uses(
    tmp_path, monkeypatch, system, home
):
    """In containers users may have no home: then Python leaves the `~` in a path."""
    for variable in (
        user_cache.VARIABLE,
        "XDG_CACHE_HOME",
        "XDG_CONFIG_HOME",
        "MPLCONFIGDIR",
    ):
        monkeypatch.setenv(variable, "")  # to be put back
        monkeypatch.delenv(variable)
    monkeypatch.delitem(sys.modules, "matplotlib", raising=False)
    monkeypatch.setattr(sys, "platform", system)
    expanded = str(tmp_path / home) if home != "~" else home
    monkeypatch.setattr(os.path, "expanduser", lambda path: path.replace("~", expanded))
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path / "temporary"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "home").mkdir()
    place = known(user_cache.user_cache())
    quiet_matplotlib()
    assert place.is_relative_to(
        tmp_path / ("temporary" if home == "~" else "home/.cache")
    )
    assert os.environ.get("MPLCONFIGDIR") == (
        str(place / "matplotlib") if home == "~" else None
    )
    left = {path.name for path in (tmp_path / "home").iterdir()}
    usual = {".cache", ".config"} if system == "linux" else {".cache"}
    assert left == (set() if home == "~" else usual)
    assert not (tmp_path / "~").exists()


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.EOPNOTSUPP])
def test_folders_that_cannot_be_locked_are_written_to(tmp_path, monkeypatch, number):
    def refuse(*_):
        raise OSError(number, os.strerror(number))

    fcntl = pytest.importorskip("fcntl")
    monkeypatch.setattr(fcntl, "flock", refuse)
    with locked(tmp_path / "new"):
        write_whole({tmp_path / "new" / "a.txt": b"a"})
    assert (tmp_path / "new" / "a.txt").read_bytes() == b"a"


def test_a_file_that_another_program_holds_open_is_named(tmp_path, monkeypatch):
    """Windows replaces no file that a spreadsheet shows."""
    (tmp_path / "table.csv").write_bytes(b"old")

    def refuse(self, _):
        raise PermissionError(errno.EACCES, "Access is denied", str(self))

    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(
        Exception, match=r"table\.csv: cannot be written: Access is denied"
    ):
        write_whole({tmp_path / "table.csv": b"new"})
    assert {path.name for path in tmp_path.iterdir()} == {
        "table.csv"
    }  # and nothing half written
    assert (tmp_path / "table.csv").read_bytes() == b"old"


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (
            sqlite3.SQLITE_IOERR | 15 << 8,
            "the disk cannot be read or written",
        ),  # IOERR_LOCK
        (sqlite3.SQLITE_CANTOPEN, "cannot be written"),
        (sqlite3.SQLITE_READONLY, "cannot be written"),
        (sqlite3.SQLITE_BUSY, "is in use"),
    ],
)
def test_stores_in_network_folders_say_what_is_wrong(tmp_path, monkeypatch, code, told):
    def refuse(*_, **__):
        error = sqlite3.OperationalError("as the file system says")
        error.sqlite_errorcode = code
        raise error

    monkeypatch.setattr(sqlite3, "connect", refuse)
    with pytest.raises(Exception, match=told) as raised:
        Store(tmp_path).__enter__()
    assert "another folder with -o" in str(raised.value)


def test_ctrl_c_is_left_alone_outside_the_main_thread():
    """Notebooks and servers run studies in threads, where no signal may be set."""
    before, seen = signal.getsignal(signal.SIGINT), list[Any]()

    def work():
        with first_interrupt(lambda: None) as event:
            seen.append(event.is_set())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [False]
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("encoding", ["cp1252", "cp866"])
def test_consoles_that_are_not_utf_8_show_all_that_they_can(tmp_path, encoding):
    """Lines of tables, Greek letters and Cyrillic titles: what cannot be shown becomes `?`."""
    text = (ROOT / "cases" / "free_standing_block.yaml").read_text("utf-8")
    (tmp_path / "блок.yaml").write_text(
        text.replace("title: ", "title: Блок на краю, "), "utf-8"
    )
    words = ("-m", "rpscli", "check", "блок.yaml")
    plain = {"PYTHONUTF8": "0"}
    shown = python(*words, folder=tmp_path, encoding=encoding, environment=plain).stdout
    assert ("Блок на краю" in shown) == (encoding == "cp866")
    assert "peak acceleration 4.413 m/s2" in " ".join(shown.split())


def test_no_file_is_read_or_written_in_the_encoding_of_the_system(tmp_path):
    """On Windows it is none that has all letters."""
    script = """
import sys, warnings
warnings.filterwarnings("error", category=EncodingWarning, module=r"rpscli(\\.|$)")
from click.testing import CliRunner
from rpscli.cli import program
for line in sys.argv[1:]:
    result = CliRunner().invoke(program, line.split())
    assert result.exit_code == 0, result.output
"""
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    lines = [
        "init case.yaml", "init --example rigid_frame", "check case.yaml", "explain slenderness",
        "sweep study.yaml --figures none", "record info cases/records/synthetic_far_field.at2",
    ]  # fmt: skip
    python("-X", "warn_default_encoding", "-c", script, *lines, folder=tmp_path)


@pytest.mark.parametrize(
    "name",
    ["with blanks and (brackets)", "каталог с пробелами", "o'quote & co", "深い" * 10],
)
def test_folders_of_any_name_hold_cases_and_results(tmp_path, monkeypatch, name):
    folder = tmp_path / name
    folder.mkdir()
    monkeypatch.chdir(folder)
    for words in (
        ("init", "--example", "rigid_frame"),
        ("check", "cases/rigid_frame.yaml"),
    ):
        rps(*words)
    rps(
        "pushover",
        str(folder / "cases/rigid_frame.yaml"),
        "--figures",
        "none",
        "-o",
        name,
    )
    assert (folder / name / "run.json").is_file()


@pytest.mark.parametrize("silent", [False, True])
def test_a_path_that_is_too_long_is_named(tmp_path, monkeypatch, *, silent):
    """Also where paths keep to themselves what the system refuses, as from Python 3.14 on."""
    if silent:
        for asked in ("exists", "is_file", "is_dir"):
            answer = getattr(os.path, asked.replace("_", ""))
            monkeypatch.setattr(Path, asked, lambda path, answer=answer: answer(path))
    with pytest.raises(RecordError, match="cannot be read: "):
        load_record(str(tmp_path / ("d" * 300)))
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "cases" / "free_standing_block.yaml", "block.yaml")
    output = rps(
        "pushover", "block.yaml", "--figures", "none", "-o", "d" * 300, exit_code=1
    )
    assert "cannot be written" in output
    assert "name another place with -o" in output


@pytest.mark.parametrize(
    "source",
    [
        "pulse:sine?amplitude=0.3g&period=0.8",
        "pulse:ricker?amplitude=0.3g&period=0.8&factor=1.5",
        "synthetic:?pga=0.3g&seed=7",
        f"{ROOT}/cases/records/synthetic_far_field.at2?factor=2",
    ],
)
def test_folders_of_records_have_names_that_windows_allows(source):
    name = load_record(source).name
    assert not set('<>:"/\\|?*') & set(name)
    assert name == name.strip(". ")
    assert name.partition(".")[0].upper() not in {
        "CON",
        "PRN",
        "AUX",
        "NUL",
        "COM1",
        "LPT1",
    }
