"""Damaged traces, scores, stores, folders of results and caches, killed runs, and lying plug-ins.

Each is used, or refused in plain words; what is repaired has the same bytes.

pytest tests/hunt/test_hostile_edges.py                                  # a few of each kind
RPS_HUNT_SEED=7 pytest -m long tests/hunt/test_hostile_edges.py          # hundreds of each
"""

import json
import math
import os
import shutil
import signal
import time
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner
from paper_structures import needs_compiled_kernels
from sweep.small_studies import BASE, STUDY
from tools.identify.test_identify_command import FRAME

from hunt.trials import PROMISED, hunt, judged, mutated, shares
from rpscli import registry
from rpscli.analyses.verification import ANSWERS, problem_files
from rpscli.cli import program
from rpscli.compiler.functions import Program
from rpscli.compiler.objects import Kept
from rpscli.compiler.values import DOUBLE
from rpscli.plugins import (
    Column,
    Found,
    IntensityMeasure,
    RecordFormat,
    Report,
    ReportOptions,
    TargetSpectrum,
)
from rpscli.sweep.store import FILE

pytestmark = [
    pytest.mark.posix,
    needs_compiled_kernels,
]  # trials are timed by its signals

DECAY = [
    0.05 * math.exp(-0.1 * t) * math.cos(4.0 * t) for t in np.arange(0.0, 12.0, 0.02)
]
TRACES = {
    "rocking": "rotation [rad]",
    "ambient": "floor_acceleration [m/s2]",
    "release": "floor_acceleration [g]",
}
SCALES = ["1", "1e-9", "1e9", "-1", "0", "1e300", "nan"]


@shares
def test_traces(long):
    """What is refused writes nothing, and what is written has intervals that say something."""
    for name, text in (("frame.yaml", FRAME), ("building.yaml", BASE)):
        Path(name).write_text(text, encoding="utf-8")

    def trial(random):
        test = random.choice([*TRACES])
        factor, first = float(random.choice(SCALES)), random.randrange(300)
        noise = random.choice([0.0, 1e-6, 1e-3, 0.1])
        rows = [
            f"{0.02 * i:.2f},{factor * value + noise * random.gauss(0.0, 1.0):.6g}"
            for i, value in enumerate(DECAY[first:])
        ]
        text = "\n".join([f"time [s],{TRACES[test]}", *rows])
        text = mutated(text, random) if random.random() < 0.7 else text
        Path("data.csv").write_text(text, encoding="utf-8", errors="replace")
        case = random.choice(["frame.yaml", "building.yaml", "building.yaml"])
        words = ("identify", case, "data.csv", test, "--json")
        codes = PROMISED | {2}  # a frame has no period
        done = judged(*words, places=("data.csv", "ambient", "release"), codes=codes)
        return f"{test}: {done}"

    hunt("traces", trial, 12, 200 if long else None)


@shares
def test_scores(long):
    lines = problem_files()[ANSWERS].decode().splitlines()[:40]
    text = "\n".join([lines[0], *(f"{line}0.5" for line in lines[1:])])

    def trial(random):
        Path("answers.csv").write_text(
            mutated(text, random), encoding="utf-8", errors="replace"
        )
        return judged(
            "verify", "--score", "answers.csv", "--json", codes=PROMISED | {2, 6}
        )

    hunt("scores", trial, 12, 200 if long else None)


VALUES = [
    None, True, 0, -1, 0.5, 1e308, 10**400, math.nan, "", "x", "../x", "\0", "\ud800", [], [5],
    ["x"], ["a=b"], {}, {"a": 1}, "podium.bearing.slenderness=x",
    "pulse:sine?amplitude=0.1g&period=1",
]  # fmt: skip


def places_of(value, path=()):
    """Of all that a document holds."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    found = [(*path, key) for key, _ in items]
    items = value.items() if isinstance(value, dict) else enumerate(value)
    return found + [
        deeper
        for key, each in items
        if isinstance(each, dict | list) and each
        for deeper in places_of(each, (*path, key))
    ]


def otherwise(text, random):
    """A JSON document with another value, or without one, at some place."""
    document = json.loads(text)
    for _ in range(random.choice([1, 1, 2])):
        *above, last = random.choice(places_of(document))
        inside = document
        for key in above:
            inside = inside[key]
        if random.random() < 0.2:
            del inside[last]
        else:
            inside[last] = random.choice(VALUES)
    return json.dumps(document)


@shares
def test_folders_of_results(long):
    """Of histories, studies and designs: `report` makes a page, or says what is wrong where."""
    Path("base.yaml").write_text(BASE, encoding="utf-8")
    record = "pulse:sine?amplitude=0.2g&period=0.6&dt=0.01"
    study = f"rps: 1\nbase: base.yaml\nrecords: ['{record}']\nreports: [table]\n"
    Path("study.yaml").write_text(study, encoding="utf-8")
    one = ("timehistory", "base.yaml", "--record", record)
    two = (*one, "--record", f"{record}&factor=2")
    again = {"one": one, "two": two, "study": ("sweep", "study.yaml")}
    for name, words in again.items():
        assert judged(*words, "-o", name, "--figures", "none") == "done"

    def trial(random):
        shutil.rmtree("copy", ignore_errors=True)
        kind = random.choice(["one", "two", "study"])
        shutil.copytree(kind, "copy")
        names = [path.name for path in Path("copy").glob("*.json")]
        file = Path("copy", random.choice(["run.json", *names]))
        text = file.read_text(encoding="utf-8")
        damage = random.choice([otherwise, otherwise, otherwise, mutated])
        file.write_text(damage(text, random), encoding="utf-8", errors="surrogatepass")
        command, *words = random.choice(
            [("report", "copy", "-o", "p.html", "--force"), again[kind]]
        )
        into = () if command == "report" else ("-o", "copy", "--figures", "none")
        done = judged(command, *words, *into, codes=PROMISED | {2})
        return f"{kind}, {command}: {done}"

    hunt("folders of results", trial, 3, 120 if long else None)


GIVEN = [  # by functions of other packages; errors are raised
    None, True, 0.5, -1.0, 0.0, 1j, "5", b"5", [1.0], (), {}, np.ones(2), np.array(1.0),
    np.float64(2.0), np.nan, math.inf, 10**400, object(), Found({}, None), iter([1]),
    IntensityMeasure("m", lambda *_: 1.0), SystemExit(3), RecursionError("deep"), KeyError("x"),
    StopIteration(),
]  # fmt: skip


class Options(ReportOptions):
    """None of its own."""


def lying(kind, random):
    """An item of a kind of which something is not what it should be."""
    given = random.choice(GIVEN)

    def gives(*_):
        if isinstance(given, BaseException):
            raise given
        return given

    column = Column("a", "-", [given, given])
    table = {random.choice(["", "_b", "/../x", "\0"]): [column]}
    found = random.choice([
        lambda *_: Found(table, None), lambda *_: Found(table, gives, [given], {"": {}}),
        lambda *_: Found({"": [column, Column("b", "-", [1.0])]}, None),
        lambda *_: Found(given, None), lambda *_: Found({}, gives),
        lambda *_: Found({"": [given]}, None, shown={"": {}}), gives,
    ])  # fmt: skip
    spectrum = {"pgv": given} if random.random() < 0.3 else {"pgv": None}
    items = {
        "measures": lambda: IntensityMeasure(random.choice(["m/s", given]), gives),
        "formats": lambda: RecordFormat(
            "liar", (".txt",), random.choice([bool, gives]), gives
        ),
        "targets": lambda: random.choice(
            [gives, lambda *told: TargetSpectrum("t", told[1], gives, **spectrum)]
        ),
        "figures": lambda: gives,
        "reports": lambda: Report(
            Options, found, results=random.choice([lambda _: (), lambda _: (), gives])
        ),
    }
    return given if random.random() < 0.1 else items[kind]()


LIAR = "pulse:sine?amplitude=0.2g&period=0.6&dt=0.01"
COMMANDS = {
    "measures": (
        "timehistory",
        "base.yaml",
        "--record",
        LIAR,
        "--scale-to",
        "liar=0.1 m/s",
    ),
    "formats": ("record", "info", "made.txt?units=g&dt=0.01"),
    "targets": (
        "record",
        "select",
        LIAR,
        "--target",
        "liar:?",
        "-n",
        "1",
        "--rules",
        "none",
    ),
    "figures": ("modal", "base.yaml", "--figures", "png,liar"),
    "reports": ("sweep", "study.yaml"),
}


@shares
def test_plugins(long, monkeypatch):
    """Whatever they give, raise or end is told as theirs, or has come to a result."""
    Path("base.yaml").write_text(BASE, encoding="utf-8")
    study = f"rps: 1\nbase: base.yaml\nrecords: ['{LIAR}']\nreports: [liar]\n"
    Path("study.yaml").write_text(study, encoding="utf-8")
    Path("made.txt").write_text("0.1\n-0.2\n0.1\n", encoding="utf-8")

    def trial(random):
        kind = random.choice([*COMMANDS])

        output = ("-o", "out", "--force")
        point = SimpleNamespace(
            group=f"rpscli.{kind}", name="liar", value="x:y", dist=None
        )
        monkeypatch.setattr(
            registry, "_points", lambda of: {"liar": point} if of == kind else {}
        )
        item = cache(lambda: lying(kind, random))
        monkeypatch.setattr(registry, "_loaded", lambda _: item())
        written = {"formats": 0, "reports": 2}.get(kind, 3)
        # a measure in metres is not scaled to a velocity
        codes = PROMISED | ({1, 2} if kind == "measures" else {1})
        done = judged(*COMMANDS[kind], *output[:written], codes=codes)
        shutil.rmtree("out", ignore_errors=True)
        return f"{kind}: {done}"

    hunt("plug-ins", trial, 8, 400 if long else None)


MODAL = """\
rps: 1
base: base.yaml
analysis: modal
vary:
  - podium.bearing.slenderness: {low: 0.1, high: 0.25, count: 12}
  - superstructure.period: [0.2, 0.3, 0.4]
"""


def sweep(*arguments):
    return CliRunner().invoke(program, ["sweep", *arguments, "--quiet", "--jobs", "1"])


DAMAGES = ["bit", "bit", "digit", "digit", "noise", "nothing", "end", "more", "pages"]


def damage(data, random, kinds):
    """Damage of a binary file, more often in what is written than in what SQLite keeps free."""
    kind, place = random.choice(kinds), random.randrange(len(data))
    while not data[place] and random.random() >= 0.2:
        place = random.randrange(len(data))
    if kind == "bit":
        data[place] ^= 1 << random.randrange(8)
    elif kind == "digit":
        digits = [i for i, byte in enumerate(data) if 48 <= byte < 58]
        data[random.choice(digits)] = random.randrange(48, 58)
    elif kind == "noise":
        data[place : place + random.randrange(1, 600)] = random.randbytes(
            random.randrange(1, 600)
        )
    elif kind == "nothing":
        place = place // 4096 * 4096
        data[place : place + 4096] = bytes(4096)
    elif kind == "end":
        del data[place:]
    elif kind == "more":
        data += random.randbytes(random.randrange(1, 5000))
    else:
        one, other = (random.randrange(len(data) // 4096) * 4096 for _ in range(2))
        pages = data[one : one + 4096], data[other : other + 4096]
        data[other : other + 4096], data[one : one + 4096] = pages


@shares
def test_damaged_stores(long):
    """The same bytes at the end, or a way to them."""
    Path("base.yaml").write_text(BASE, encoding="utf-8")
    Path("modal.yaml").write_text(MODAL, encoding="utf-8")
    assert sweep("modal.yaml", "-o", "sound").exit_code == 0
    table = Path("sound/points.csv").read_bytes()

    def trial(random):
        shutil.rmtree("copy", ignore_errors=True)
        shutil.copytree("sound", "copy")
        data = bytearray(Path("copy", FILE).read_bytes())
        damage(data, random, DAMAGES)
        Path("copy", FILE).write_bytes(data)
        result = sweep("modal.yaml", "-o", "copy")
        if result.exit_code == 0:
            assert Path("copy/points.csv").read_bytes() == table, (
                "other numbers without a word"
            )
            return "same bytes"
        assert result.exit_code == 7, (
            f"exit code {result.exit_code}: {result.stderr[-400:]}"
        )
        assert len(result.stderr.splitlines()) == 1, result.stderr[-400:]
        assert any(way in result.stderr for way in ("--fresh", "-o")), result.stderr[
            -400:
        ]
        anew = sweep("modal.yaml", "-o", "copy", "--fresh")
        if anew.exit_code == 7:  # no longer a file that is known to be ours
            assert "name another folder" in anew.stderr, anew.stderr[-400:]
            return "another folder"
        assert anew.exit_code == 0, anew.stderr[-400:]
        assert Path("copy/points.csv").read_bytes() == table
        return "--fresh"

    hunt("damaged stores", trial, 6, 100 if long else None)


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@shares
def test_killed_studies(long):
    Path("base.yaml").write_text(BASE, encoding="utf-8")
    Path("study.yaml").write_text(STUDY, encoding="utf-8")
    begin = time.perf_counter()
    assert sweep("study.yaml", "-o", "calm").exit_code == 0
    takes = time.perf_counter() - begin
    table = Path("calm/points.csv").read_bytes()

    def trial(random):
        shutil.rmtree("hasty", ignore_errors=True)
        kills = random.choice([1, 1, 2, 3])
        for _ in range(kills):
            child = os.fork()
            if not child:
                sweep("study.yaml", "-o", "hasty")
                os._exit(0)
            time.sleep(random.random() * takes)
            os.kill(
                child, random.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM])
            )
            os.waitpid(child, 0)
        stored = Path("hasty", FILE).exists()
        last = sweep("study.yaml", "-o", "hasty")
        assert last.exit_code == 0, last.stderr[-400:]
        assert Path("hasty/points.csv").read_bytes() == table
        return f"{kills} killed, {'some' if stored else 'none'} stored"

    hunt("killed studies", trial, 1, 160 if long else None)


def four(x: float) -> float:
    return 4.0 * x


@shares
def test_caches(long):
    """Machine code that is not what was written is compiled anew, and is then whole."""
    program = Program()
    program.add(four, [DOUBLE], "@four")
    Path("cache").mkdir()
    store, file = Kept(Path("cache")), Path("cache/four.o")

    def trial(random):
        code = store.get(file.name, program.text)
        data = bytearray(file.read_bytes())
        damage(data, random, DAMAGES[:-1])
        file.write_bytes(data)
        assert store.find(file.name) in (None, code)
        assert store.get(file.name, program.text) == code
        assert store.find(file.name) == code
        return "whole"

    hunt("caches", trial, 10, 200 if long else None)
