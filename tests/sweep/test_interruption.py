"""Killed, interrupted, with one thread or two: the same bytes at the end, and their store."""

import json
import os
import shlex
import shutil
import signal
import sqlite3
import threading
import time
import warnings
from concurrent.futures import Executor, Future
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from paper_structures import printed_by, python

import rpscli
from rpscli.cli import program
from rpscli.errors import OutputError, Refused, RpsError, UsageError
from rpscli.records.formats.at2 import at2_text
from rpscli.records.loading import load_record
from rpscli.studies import load_study
from rpscli.sweep.evaluation import (
    MISSING,
    SOLVING,
    PointResults,
    digest_of_sources,
    run_batch,
)
from rpscli.sweep.points import lay_out, reproduction
from rpscli.sweep.run import Engine, compute, run, start
from rpscli.sweep.store import FILE, Store
from rpscli.sweep.table import PointTable, points_csv
from sweep.small_studies import BASE, FOLDER, STUDY, csv_rows

POINTS = 36
"""Of the study; one thread computes them in batches of nine."""

CSV = "results/study/sweep/points.csv"


@pytest.mark.posix
def test_the_first_ctrl_c_drains_and_says_how_to_go_on(workplace):
    """Runs that are killed: tests/hunt/test_hostile_edges.py."""
    study = ("sweep", "study.yaml", "--jobs", "1", "--json")
    program = str(Path(__file__).with_name("interrupted.py"))
    stopped = python(program, *study, folder=workplace, exit_code=130)
    assert "Ctrl-C again" in stopped.stderr
    assert "the same command continues" in stopped.stderr
    document = json.loads(stopped.stdout)
    assert document["error"]["type"] == "Interrupted"
    # The batch under way was finished and stored.
    assert document["points"] == {"total": POINTS, "stored": 27}
    assert not (workplace / CSV).exists()
    done = python("-mrpscli", *study, folder=workplace)
    assert json.loads(done.stdout)["points"]["kept"] == 27


@pytest.mark.posix
def test_the_second_ctrl_c_stops_at_once(study_of, workplace, monkeypatch):
    layout = lay_out(study_of())
    told = []
    over = threading.Event()

    def one_batch(context, points):
        if points[0].number:
            over.wait()
        return run_batch(context, points)

    def interrupt(progress):
        os.kill(os.getpid(), signal.SIGINT)
        told.append("first")
        os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr("rpscli.sweep.run.run_batch", one_batch)
    before = signal.getsignal(signal.SIGINT)
    with Store(workplace) as store:
        begin = start(layout, store)
        with pytest.raises(KeyboardInterrupt):
            run(layout, begin, store, Engine(layout.context, 1), interrupt)
        assert told == ["first"]
        assert len(store.outcomes()) == 9  # the second batch is still under way
    over.set()
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.posix
def test_a_ctrl_c_given_to_another_thread_is_heard(study_of, workplace, monkeypatch):
    layout = lay_out(study_of())
    heard = threading.Event()

    def one_batch(context, points):
        time.sleep(0.5)  # until the main thread waits
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        os.kill(
            os.getpid(), signal.SIGINT
        )  # only this thread takes it: the waiting one sleeps on
        assert heard.wait(20.0)
        return run_batch(context, points)

    monkeypatch.setattr("rpscli.sweep.run.run_batch", one_batch)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        with Store(workplace) as store:
            begin = start(layout, store)
            finish = run(
                layout, begin, store, Engine(layout.context, 1), announce=heard.set
            )
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    assert (finish.computed, len(begin.pending)) == (9, POINTS)


def test_equal_points_are_computed_once(study_of, workplace):
    layout = lay_out(study_of(STUDY, ("[0.5, 1.0]", "[1.0, 1.0]")))
    with Store(workplace) as store:
        begin = start(layout, store)
        assert len(begin.pending) == 18
        run(layout, begin, store, Engine(layout.context, 1))
        found = store.results(begin.keys, ["max_rotation"])
    rotation = found.columns["max_rotation"]
    assert rotation.shape == (36,)
    assert rotation[0] == rotation[1]
    assert MISSING not in found.outcomes


def test_a_second_run_computes_nothing(sweep_json, workplace):
    """Nor does it change a byte; nor does all that is computed anew, in two threads."""
    csv = workplace / CSV
    first = sweep_json("study.yaml", "--jobs", "1")
    text = csv.read_bytes()
    second = sweep_json("study.yaml")
    assert csv.read_bytes() == text
    assert (first["points"]["computed"], first["points"]["kept"]) == (36, 0)
    assert (second["points"]["computed"], second["points"]["kept"]) == (0, 36)
    fresh = sweep_json("study.yaml", "--fresh", "--jobs", "2")
    assert fresh["points"]["computed"] == 36
    assert csv.read_bytes() == text


def test_a_changed_study_keeps_what_applies_and_says_what_changed(sweep_json):
    sweep_json("study.yaml")
    text = STUDY.replace("critical, 0.5, 0]", "critical, 1.5]").replace("Test", "Renamed")
    changed = sweep_json("study.yaml", study=text)
    assert changed["points"] == {
        "total": 24,
        "computed": 12,
        "kept": 12,
        "failed": 0,
        "unused": 24,
    }
    notes = " ".join(changed["notes"])
    assert "curvature_ratio: ['critical', 0.5, 0] -> ['critical', 1.5]" in notes
    assert "12 points still apply, 12 are to be computed" in notes
    assert "24 stored points are no longer in the study" in notes
    # Nothing was thrown away: the first study is whole again at once.
    assert sweep_json("study.yaml", study=STUDY)["points"]["computed"] == 0
    # What is stored of one case applies to no other.
    changed = sweep_json("study.yaml", base=BASE.replace("ratio: 0.05", "ratio: 0.04"))
    assert changed["points"]["computed"] == 36
    assert "base.superstructure.damping.ratio: 0.05 -> 0.04" in " ".join(changed["notes"])


def test_the_folder_of_another_study_is_refused(sweep, workplace):
    assert sweep("study.yaml", "-o", "there").exit_code == 0
    other = STUDY.replace("scale: [0.5, 1.0]", "scale: [2]")
    (workplace / "other.yaml").write_text(other)
    refused = sweep("other.yaml", "-o", "there")
    assert refused.exit_code == 7
    assert "another study (study)" in refused.stderr
    assert sweep("other.yaml", "-o", "there", "--fresh").exit_code == 0


def test_report_only_computes_nothing(sweep, workplace):
    lacking = sweep("study.yaml", "--report-only")
    assert lacking.exit_code == 7
    assert "lacks 36 of 36 points, which `rps sweep` computes" in lacking.stderr
    assert sweep("study.yaml").exit_code == 0
    text = STUDY.replace("scale:", "reports: [overturning]\nscale:")
    assert sweep("study.yaml", "--report-only", study=text).exit_code == 0
    for name in ("overturning.csv", "overturning.png"):
        assert (workplace / FOLDER / name).exists()


def test_other_reports_of_the_same_points_keep_the_earlier_ones(sweep, workplace):
    """Also if the new one fails; a sweep without the option takes them away."""
    first = STUDY.replace("scale:", "reports: [overturning]\nscale:")
    assert sweep("study.yaml", study=first).exit_code == 0
    old = workplace / FOLDER / "overturning.csv"
    before = old.read_bytes()
    other = STUDY.replace("scale:", "reports: [rotation]\nscale:")
    done = sweep("study.yaml", "--report-only", study=other)
    assert done.exit_code == 0
    assert "kept, of an earlier run: overturning.csv" in done.stderr
    assert "removed" not in done.stderr
    assert old.read_bytes() == before
    assert (workplace / FOLDER / "rotation.csv").exists()
    own = json.loads((workplace / FOLDER / "run.json").read_text("utf-8"))["files"]
    assert {"overturning.csv", "rotation.csv"} <= {*own}
    last = sweep("study.yaml", study=other)
    assert "removed, of an earlier run: overturning.csv" in last.stderr
    assert not old.exists()
    assert (workplace / FOLDER / "rotation.csv").exists()


def test_options_that_contradict_each_other_are_refused(sweep):
    for options in (("--fresh",), ("--retry-failed",), ("--scheduler", "tcp://x:1")):
        assert sweep("study.yaml", "--report-only", *options).exit_code == 2
    assert sweep("study.yaml", "--jobs", "2", "--scheduler", "tcp://x:1").exit_code == 2


@pytest.fixture
def spoilt(workplace):
    """A study of two record files, one of which cannot be read."""
    motion = load_record("synthetic:?pga=0.4g&seed=1&duration=3&dt=0.02")
    (workplace / "good.at2").write_text(at2_text(motion))
    (workplace / "bad.at2").write_text("no record at all\n")
    begin, end = STUDY.index("records:"), STUDY.index("scale:")
    text = (
        STUDY[:begin]
        + "records: [good.at2, bad.at2]\nreports: [overturning]\n"
        + STUDY[end:]
    )
    (workplace / "study.yaml").write_text(text)
    return workplace


def test_the_rest_goes_on(spoilt, sweep_json):
    document = sweep_json("study.yaml", exit_code=5)
    assert document["status"] == "error"
    assert document["points"]["failed"] == document["outcomes"]["failed"] == 12
    points = csv_rows("points.csv")
    failed = [p for p in points if p["outcome [-]"] == "failed"]
    assert {p["record [-]"] for p in failed} == {"bad.at2"}
    assert {p["record [-]"] for p in points if p not in failed} == {"good.at2"}
    assert all(p["max_rotation [rad]"] == "" for p in failed)
    assert {p["scale [-]"] for p in failed} == {"0.5", "1.0"}
    shares = csv_rows("overturning.csv")  # at each scale
    assert {(row["counted [-]"], row["failed [-]"]) for row in shares} == {("3", "3")}


def test_each_failure_has_a_command_that_reproduces_it(spoilt, sweep_json):
    """A case inside the study is written for it, from Python as well."""
    for inside in (False, True):
        text = (spoilt / "study.yaml").read_text()
        if inside:
            inner = "base:\n" + "".join(f"  {line}\n" for line in BASE.splitlines())
            text = text.replace("base: base.yaml\n", inner)
        failure = sweep_json("study.yaml", exit_code=5, study=text)["failures"][0]
        assert "bad.at2" in failure["message"]
        words = shlex.split(failure["command"])
        assert words[:3] == [
            "rps",
            "timehistory",
            f"{FOLDER}/base.yaml" if inside else "base.yaml",
        ]
        again = CliRunner().invoke(program, words[1:])
        assert again.exit_code == 3
        assert failure["message"] in again.stderr
        assert csv_rows("failed.csv")[0]["command [-]"] == failure["command"]
    files = {name: (FOLDER / name).read_bytes() for name in ("failed.csv", "base.yaml")}
    shutil.rmtree(FOLDER)
    result = load_study("study.yaml").run(FOLDER)
    assert len(result.failures) == 12
    result.write()
    assert {name: (FOLDER / name).read_bytes() for name in files} == files


def test_the_command_of_a_good_point_gives_its_numbers(spoilt):
    overrides = ("perturb={members: 3}", "podium.cap_beam_mass_ratio=8")
    layout = load_study("study.yaml", overrides).layout
    point = layout[2]
    row = run_batch(layout.context, [point]).columns
    words = shlex.split(reproduction(layout, point, Path("base.yaml")))
    single = CliRunner().invoke(program, [*words[1:], "--json"])
    found = json.loads(single.stdout)
    assert found["max_rotation"] == pytest.approx(row["max_rotation"][0], rel=1e-6)
    assert found["record"]["scale"] == row["scale"][0]


def test_failed_points_are_tried_again(spoilt, sweep_json):
    sweep_json("study.yaml", exit_code=5)
    kept = sweep_json("study.yaml", exit_code=5)
    assert (kept["points"]["computed"], kept["points"]["failed"]) == (0, 12)
    retried = sweep_json("study.yaml", "--retry-failed", exit_code=5)
    assert (retried["points"]["computed"], retried["points"]["kept"]) == (12, 12)
    (spoilt / "bad.at2").write_text(
        (spoilt / "good.at2").read_text().replace("0.4", "0.3")
    )
    repaired = sweep_json("study.yaml")
    assert repaired["points"]["failed"] == 0
    assert not (spoilt / FOLDER / "failed.csv").exists()


def test_components_of_two_time_steps_fail(sweep):
    vertical = "synthetic:?pga=0.3g&duration=4&dt=0.01&seed=2"
    record = {
        "source": "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=1",
        "vertical": vertical,
    }
    study = (
        "rps: 1\nbase: base.yaml\nvary: [{podium.bearing.curvature_ratio: [0.5, 0]}]\n"
    )
    base = f"{BASE}record: {json.dumps(record)}\n"
    refused = sweep("study.yaml", "--quiet", study=study, base=base)
    assert refused.exit_code == 5
    assert "2 of 2 points failed" in refused.stderr
    assert "they must agree; resample one of them" in refused.stderr
    assert f"--vertical '{vertical}'" in refused.stderr


def key(number):
    return bytes([number] * 32)


def batch(*numbers, failed=False):
    """Points that survived, or failed."""
    values = np.full(len(numbers), np.nan) if failed else 0.1 * np.array(numbers)
    outcomes = np.array(["failed" if failed else "survived"] * len(numbers), dtype="U20")
    messages = dict.fromkeys(range(len(numbers)), "why") if failed else {}
    columns = {"x": values, "list": np.column_stack([values, values + 1.0])}
    return list(map(key, numbers)), PointResults(outcomes, messages, columns)


def rows(store, *numbers):
    """Outcome, message, x and the second of the list of some points."""
    found = store.results(list(map(key, numbers)), ["x", "list.1", "unknown"])
    nothing = np.full(len(numbers), np.nan)
    x, last = (found.columns.get(name, nothing).tolist() for name in ("x", "list.1"))
    assert "unknown" not in found.columns
    told = [found.messages.get(row) for row in range(len(numbers))]
    return [repr(row) for row in zip(found.outcomes.tolist(), told, x, last, strict=True)]


def test_what_is_stored_is_there_after_reopening(tmp_path):
    with Store(tmp_path) as store:
        store.add(*batch(1, 3))
        store.add(*batch(2, failed=True))
        store.note(study="a")
    with Store(tmp_path) as store:
        assert store.outcomes() == {key(1): False, key(3): False, key(2): True}
        assert rows(store, 2, 9, 1, 1) == [
            "('failed', 'why', nan, nan)",
            "('', None, nan, nan)",
            *["('survived', None, 0.1, 1.1)"] * 2,
        ]
        assert store.facts()["study"] == "a"
        store.add(*batch(2))
        assert store.outcomes()[key(2)] is False
        assert rows(store, 2) == ["('survived', None, 0.2, 1.2)"]
        store.add(*batch(2, failed=True))
        assert rows(store, 2) == ["('failed', 'why', nan, nan)"]


def test_a_second_process_is_refused(tmp_path):
    for fresh in (False, True):
        with Store(tmp_path), pytest.raises(Refused, match=r"in use.*-o"):
            Store(tmp_path, fresh=fresh).__enter__()


def test_fresh_begins_anew_even_where_the_file_is_damaged(tmp_path):
    with Store(tmp_path) as store:
        store.add(*batch(*range(200)))
    with Store(tmp_path, fresh=True) as store:
        assert store.outcomes() == {}
        store.add(*batch(*range(200)))
    path = tmp_path / FILE
    content = bytearray(path.read_bytes())
    content[1024:] = b"\xff" * (len(content) - 1024)
    path.write_bytes(content)
    with pytest.raises(RpsError, match=r"damaged.*--fresh"):
        Store(tmp_path).__enter__()
    with Store(tmp_path, fresh=True) as store:
        assert store.outcomes() == {}


@pytest.mark.parametrize("what", ["file", "folder", "other"])
def test_a_store_that_is_deleted_while_it_is_used_is_told(tmp_path, what):
    folder = tmp_path / "o"
    with Store(folder) as store:
        store.add(*batch(1))
        store.require()
        if what == "folder":
            shutil.rmtree(folder)
        else:
            (folder / FILE).unlink()
        if what == "other":
            (folder / FILE).write_bytes(b"")
        with pytest.raises(OutputError, match=r"deleted or replaced.*same command"):
            store.add(*batch(2))
        with pytest.raises(OutputError, match="deleted or replaced"):
            store.require()


def test_files_of_others_are_left_alone(tmp_path):
    with closing(sqlite3.connect(tmp_path / FILE)) as db:
        db.execute("CREATE TABLE mine (x)")
    whole = (tmp_path / FILE).read_bytes()
    damaged = whole[:1024] + b"\xff" * (len(whole) - 1024)
    for content in (b"notes of mine, not to be lost", whole, damaged):
        (tmp_path / FILE).write_bytes(content)
        for fresh in (False, True):
            with pytest.raises(Refused, match="not the store"):
                Store(tmp_path, fresh=fresh).__enter__()
        assert (tmp_path / FILE).read_bytes() == content


@pytest.mark.parametrize(("version", "told"), [(0, "before 4"), (5, "5")])
def test_another_format_is_refused(tmp_path, version, told):
    with Store(tmp_path) as store:
        store.note(study="a")
    with closing(sqlite3.connect(tmp_path / FILE)) as db:
        db.execute(f"PRAGMA user_version = {version}")
    with pytest.raises(Refused, match=rf"format {told}.*--fresh"):
        Store(tmp_path).__enter__()
    with Store(tmp_path, fresh=True) as store:
        assert store.facts() == {}


def test_a_full_disk_is_told_and_what_was_stored_stays(tmp_path):
    with Store(tmp_path) as store:
        store.add(*batch(1))
        # SQLite reports a limit on its pages as a full disk.
        store._db.execute("PRAGMA max_page_count = 1")
        with pytest.raises(OutputError, match=r"disk is full.*same\s+command"):
            store.add(*batch(*range(2, 200)))
        assert list(store.outcomes()) == [key(1)]


PACKAGE = Path(rpscli.__file__).parent


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """A copy of the sources."""
    copy = tmp_path_factory.mktemp("sources") / "rpscli"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    return copy


@pytest.mark.parametrize("name", SOLVING)
def test_a_changed_source_changes_the_digest(package, name):
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


def test_every_module_behind_a_stored_number_counts():
    code = "import sys, rpscli.sweep.evaluation; "
    code += (
        "print(*(m.__file__ for n, m in sys.modules.items() if n.startswith('rpscli.')))"
    )
    modules = {
        Path(p).relative_to(PACKAGE).as_posix() for p in printed_by("-c", code).split()
    }
    counted = {name for name in modules if name.startswith(tuple(SOLVING))}
    assert "analyses/demand.py" in counted
    others = {"errors.py", "machine.py", "shown.py", "sweep/__init__.py", "version.py"}
    others.add("titled_table.py")  # of files that no point depends on
    # What tools offer is looked up; no number of a point depends on it.
    assert {n for n in modules - counted if not n.startswith("tools/")} == others


RECORDS = ("seed: [1, 2, 3]", "seed: {low: 1, high: 16, count: 16}")


@pytest.fixture(scope="module")
def distributed():
    return pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def scheduler(distributed):
    """Address of a cluster of two worker processes, which are replaced when they die."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # sockets of the worker that is killed
        with distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster:
            yield cluster.scheduler_address


@pytest.mark.posix
def test_a_killed_worker_changes_no_byte(study_of, workplace, distributed, scheduler):
    layout = lay_out(study_of(STUDY, RECORDS))
    client = distributed.Client(scheduler, set_as_default=False)
    workers = list(client.run(os.getpid).values())
    client.close()
    killed = []

    def kill_one(progress):
        if not killed:
            os.kill(workers[0], signal.SIGKILL)
            killed.append(workers[0])

    texts = []
    for name, address in (("cluster", scheduler), ("threads", None)):
        with Store(workplace / name) as store:
            begin = start(layout, store)
            engine = Engine(layout.context, 1, address)
            finish = run(layout, begin, store, engine, kill_one)
            assert (finish.computed, finish.failed) == (len(layout), 0)
            table = PointTable.of(layout, partial(store.results, begin.keys))
            texts.append("".join(points_csv(table)))
    assert killed
    assert texts[0] == texts[1]


def test_a_worker_of_another_version_is_refused(study_of):
    other = replace(lay_out(study_of()).plan, solver="another")
    with pytest.raises(RpsError, match="same version"):
        compute("digest", other, [])


def test_points_that_kill_every_worker_come_back_failed(study_of, distributed):
    layout = lay_out(study_of())
    engine = Engine(layout.context, 1)
    tried = []

    class Deadly(Executor):
        """A cluster on which the first point takes its workers with it."""

        def submit(self, work, /, *inputs, **_):
            future = Future()
            tried.append([point.number for point in inputs[-1]])
            if 0 in tried[-1]:
                future.set_exception(distributed.KilledWorker("task", None, 3))
            else:
                future.set_result(work(*inputs))
            return future

    engine._executor, engine._deadly = Deadly(), distributed.KilledWorker
    engine._digest, engine._plan = "deadly", layout.plan
    found = {
        ps[0].number: results for ps, results in engine.outcomes([[layout[0], layout[1]]])
    }
    assert tried == [[0, 1], [0], [1]]  # each is tried alone
    assert found[0].outcomes.tolist() == ["failed"]
    assert "died" in found[0].messages[0]
    assert found[1].messages == {}


@pytest.mark.long
@pytest.mark.posix
def test_a_point_that_ends_its_process_is_told_and_the_others_come(
    sweep_json, workplace, distributed, scheduler
):
    """Through the option, on a cluster whose workers really die, four of them for each task.

    Dask counts a death against all tasks that the worker held, so that a sound point may
    come back failed too; then it is told that its workers died.
    """

    class Deadly(distributed.WorkerPlugin):
        """What each worker begins with: the first point ends its process."""

        def setup(self, **_):
            from rpscli.sweep import run

            self.whole = run.run_batch

            def run_batch(context, points):
                if any(point.number == 0 for point in points):
                    os._exit(1)
                return self.whole(context, points)

            run.run_batch = run_batch

        def teardown(self, **_):
            from rpscli.sweep import run

            run.run_batch = self.whole

    few = STUDY.replace("[critical, 0.5, 0]", "[0.5]").replace("[1, 2, 3]", "[1]")
    with distributed.Client(scheduler, set_as_default=False) as client:
        client.register_plugin(Deadly(), name="deadly")
        words = ("study.yaml", "--scheduler", scheduler, "--figures", "none")
        document = sweep_json(
            *words, study=few.replace("[0.5, 1.0]", "[1.0]"), exit_code=5
        )
        client.unregister_worker_plugin("deadly")
    first, second = csv_rows("points.csv")
    failed = [row for row in (first, second) if row["outcome [-]"] == "failed"]
    assert first in failed
    assert document["points"]["failed"] == len(failed)
    assert all("died" in failure["message"] for failure in document["failures"])
    assert second in failed or second["outcome [-]"] in {"survived", "overturned"}


@pytest.mark.usefixtures("distributed")
def test_no_scheduler_is_told(study_of, monkeypatch):
    monkeypatch.setattr("rpscli.sweep.run.PATIENCE", 0.3)
    with pytest.raises(UsageError, match="no Dask scheduler"):
        Engine(lay_out(study_of()).context, 1, "tcp://127.0.0.1:9")
