"""Stores that were damaged, runs that were killed: the same bytes at the end, or a way to them."""

from __future__ import annotations

import os
import shutil
import signal
import time
from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest
from click.testing import CliRunner, Result
from paper_structures import needs_compiled_kernels
from sweep.small_studies import BASE, STUDY

from hunt.trials import hunt, shares
from rpscli.cli import program
from rpscli.sweep.store import FILE

pytestmark = pytest.mark.posix  # trials are timed by its signals

MODAL = """\
rps: 1
base: base.yaml
analysis: modal
vary:
  - podium.bearing.slenderness: {low: 0.1, high: 0.25, count: 12}
  - superstructure.period: [0.2, 0.3, 0.4]
"""


@pytest.fixture(autouse=True)
def _studies(_workplace: None, tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(BASE, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    (tmp_path / "modal.yaml").write_text(MODAL, encoding="utf-8")


def sweep(*arguments: str) -> Result:
    return CliRunner().invoke(program, ["sweep", *arguments, "--quiet", "--jobs", "1"])


def _somewhere(data: bytearray, random: Random) -> int:
    """More often in what is written than in what SQLite keeps free."""
    while True:
        place = random.randrange(len(data))
        if data[place] or random.random() < 0.2:
            return place


def _bit(data: bytearray, random: Random) -> None:
    data[_somewhere(data, random)] ^= 1 << random.randrange(8)


def _digit(data: bytearray, random: Random) -> None:
    digits = [place for place, byte in enumerate(data) if 48 <= byte < 58]
    data[random.choice(digits)] = random.randrange(48, 58)


def _noise(data: bytearray, random: Random) -> None:
    place = _somewhere(data, random)
    data[place : place + random.randrange(1, 600)] = random.randbytes(random.randrange(1, 600))


def _nothing(data: bytearray, random: Random) -> None:
    place = _somewhere(data, random) // 4096 * 4096
    data[place : place + 4096] = bytes(4096)


def _end(data: bytearray, random: Random) -> None:
    del data[random.randrange(len(data)) :]


def _more(data: bytearray, random: Random) -> None:
    data += random.randbytes(random.randrange(1, 5000))


def _pages(data: bytearray, random: Random) -> None:
    one, other = (random.randrange(len(data) // 4096) * 4096 for _ in range(2))
    data[one : one + 4096], data[other : other + 4096] = (
        data[other : other + 4096],
        data[one : one + 4096],
    )


DAMAGES: list[Callable[[bytearray, Random], None]] = [
    _bit,
    _bit,
    _digit,
    _digit,
    _noise,
    _nothing,
    _end,
    _more,
    _pages,
]


@shares
def test_damaged_stores(long: bool) -> None:
    assert sweep("modal.yaml", "-o", "sound").exit_code == 0
    table = Path("sound/points.csv").read_bytes()

    def trial(random: Random) -> str:
        shutil.rmtree("copy", ignore_errors=True)
        shutil.copytree("sound", "copy")
        data = bytearray(Path("copy", FILE).read_bytes())
        random.choice(DAMAGES)(data, random)
        Path("copy", FILE).write_bytes(data)
        result = sweep("modal.yaml", "-o", "copy")
        if result.exit_code == 0:
            assert Path("copy/points.csv").read_bytes() == table, "other numbers without a word"
            return "same bytes"
        assert result.exit_code == 7, f"exit code {result.exit_code}: {result.stderr[-400:]}"
        assert len(result.stderr.splitlines()) == 1, result.stderr[-400:]
        assert any(way in result.stderr for way in ("--fresh", "-o")), result.stderr[-400:]
        anew = sweep("modal.yaml", "-o", "copy", "--fresh")
        if anew.exit_code == 7:  # no longer a file that is known to be ours
            assert "name another folder" in anew.stderr, anew.stderr[-400:]
            return "another folder"
        assert anew.exit_code == 0, anew.stderr[-400:]
        assert Path("copy/points.csv").read_bytes() == table
        return "--fresh"

    hunt("damaged stores", trial, 6, 100 if long else None)


@needs_compiled_kernels
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@shares
def test_killed_studies(long: bool) -> None:
    begin = time.perf_counter()
    assert sweep("study.yaml", "-o", "calm").exit_code == 0
    takes = time.perf_counter() - begin
    table = Path("calm/points.csv").read_bytes()

    def trial(random: Random) -> str:
        shutil.rmtree("hasty", ignore_errors=True)
        kills = random.choice([1, 1, 2, 3])
        for _ in range(kills):
            child = os.fork()
            if not child:
                sweep("study.yaml", "-o", "hasty")
                os._exit(0)
            time.sleep(random.random() * takes)
            os.kill(child, random.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM]))
            os.waitpid(child, 0)
        stored = Path("hasty", FILE).exists()
        last = sweep("study.yaml", "-o", "hasty")
        assert last.exit_code == 0, last.stderr[-400:]
        assert Path("hasty/points.csv").read_bytes() == table
        return f"{kills} killed, {'some' if stored else 'none'} stored"

    hunt("killed studies", trial, 1, 160 if long else None)
