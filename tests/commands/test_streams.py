"""What goes where: results, errors, colours, pipes, and the exit code that ends it."""

import contextlib
import io
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from sweep.small_studies import ROOT, STUDY

from rpscli.commands.record import command as record
from rpscli.commands.registry import OURS
from rpscli.commands.shell.terminal import (
    MANY,
    Terminal,
    counted,
    rendered,
    report,
    watched,
)
from rpscli.errors import CaseError
from rpscli.registry import of_tools
from rpscli.report.table import Table

from .conftest import SMALL_CASE

SINE = "pulse:sine?amplitude=0.3g&period=1"
EXAMPLES = [
    ("check", "small.yaml"),
    ("modal", "small.yaml"),
    ("pushover", "small.yaml"),
    ("timehistory", "small.yaml"),
    *(("record", word, SINE) for word in ("info", "plot", "convert", "synth")),
]


@pytest.mark.parametrize("command", EXAMPLES, ids=" ".join)
def test_a_document_is_all_that_json_prints(rps_json, command):
    document = rps_json(*command)
    assert document["status"] == "ok"
    assert document["command"] == " ".join(command[:-1])
    assert {"rps_version", "warnings"} <= set(document)
    assert all(Path(file).is_file() for file in document.get("files", ()))


@pytest.mark.parametrize("command", EXAMPLES[:5], ids=" ".join)
def test_quiet_leaves_the_data(rps, rps_json, command):
    result = rps(*command, "--quiet")
    assert (result.stdout, result.stderr) == ("", "")
    assert rps_json(*command, "--quiet")["status"] == "ok"


def test_tables_go_to_stdout_and_notes_to_stderr(rps):
    result = rps("modal", "small.yaml")
    assert result.stdout.startswith("Three storeys [test]\n")  # brackets are no markup
    assert "written to" not in result.stdout
    assert result.stderr == f"written to {Path('results', 'small', 'modal')}\n"


FRAME, SIX = (ROOT / "cases" / f"{name}.yaml" for name in ("rigid_frame", "six_storey"))
SCALED = "--set 'record.scale_to={measure: PGA, value: 0.2 g}'"
SETS = f"--record '{SINE}' --record 'pulse:sine?amplitude=0.2g&period=1'"
TARGET = "--target 'en1998:?ag=0.2g&soil=B' --per-event 1 -n 2"
FAILURES = [
    ("check none.yaml", "CaseError", "there is no such file"),
    ("check small.yaml --set podium.bearing.rho=1", "CaseError", "rho is not a key"),
    (f"check {SIX} --set limits.drift=0.01", "CaseError", "did you mean limits.drift_ratio?"),
    (f"timehistory small.yaml {SCALED} --set record.scale=2", "CaseError",
     "record.scale_to and record.scale"),
    ("timehistory small.yaml --record none.at2", "RecordError", "none.at2"),
    ("timehistory small.yaml --set record.source=list:a.txt", "RecordError", "by --record"),
    (f"timehistory small.yaml --vertical '{SINE}'", "RecordError", "dt"),
    (f"record convert '{SINE}' -o no.txt --resample -1", "RecordError", "give a step above 0"),
    ("record synth small.yaml", "RecordError", "small.yaml"),
    (f"record select '{SINE}' {TARGET}", "RecordError", "only 1 of 1 motions"),
    (f"record select '{SINE}' {TARGET} --pgv 0.2", "UsageError", "--pgv"),
    (f"record select '{SINE}' {TARGET} --set title=x", "UsageError", "name it by --case"),
    ("timehistory small.yaml --scale nan", "UsageError", "finite"),
    ("timehistory small.yaml --animate-from nan", "UsageError", "finite"),
    ("verify --score a.csv --digits nan", "UsageError", "finite"),
    ("identify small.yaml a.csv rocking --from nan", "UsageError", "finite"),
    ("timehistory small.yaml --animate film.avi", "UsageError", ".gif"),
    ("modal small.yaml --animate-size 500", "UsageError", "--animate FILE"),
    ("check small.yaml -o x", "UsageError", "--draw"),
    ("check small.yaml --figures pdf", "UsageError", "--draw"),
    ("timehistory small.yaml --set record=null", "UsageError", "--record"),
    ("timehistory small.yaml --fail-on rotation_rati=1", "UsageError", "_ratio?"),
    ("timehistory small.yaml --fail-on zork=1", "UsageError", "; `rps explain limits`"),
    ("timehistory small.yaml --fail-on rotation_ratio", "UsageError", "=NUMBER"),
    ("timehistory small.yaml --fail-on drift_ratio=1 --set superstructure.storey_height=null",
     "UsageError", "storey_height"),
    ("timehistory small.yaml --scale pga=0.4g", "UsageError", "--scale-to PGA=0.4g"),
    ("timehistory small.yaml --scale 2 --scale-to PGA=1", "UsageError", "--scale"),
    ("timehistory small.yaml --scale-to PGA", "UsageError", "write MEASURE=VALUE"),
    ("timehistory small.yaml --scale-to PGB=1", "UsageError", "did you mean PG"),
    ("timehistory small.yaml --scale-to 'PGA=0.4 m'", "UsageError", "is a length"),
    ("timehistory small.yaml --scale-to PGV=-1", "UsageError", "must be > 0 m/s"),
    ("timehistory small.yaml --scale-to 'PGA(0.5 s)=1 g'", "UsageError", "measures such as Sa"),
    ("timehistory - -", "UsageError", "-"),
    (f"timehistory small.yaml {SETS} --vertical '{SINE}'", "UsageError", "not 2"),
    (f"timehistory small.yaml {SETS} --animate film.gif", "UsageError", "not 2"),
    ("pushover small.yaml --pattern 1,2", "UsageError", "3 floor forces"),
    ("pushover small.yaml --pattern mode", "UsageError", "first_mode"),
    (f"pushover {FRAME} --pattern uniform", "UsageError", "no storeys"),
    (f"record convert '{SINE}' -o a.txt --to at2", "UsageError", "contradicts"),
    ("explain slendernes", "UsageError", "did you mean slenderness?"),
    ("schema results", "UsageError", "those of case, study, design"),
    ("init --example six_story", "UsageError", "did you mean six_storey?"),
    ("init --example six_storey --study", "UsageError", "leave out the rest"),
    ("check", "UsageError", "CASE"),
    ("check small.yaml --colour", "UsageError", "--colour"),
    ("chek small.yaml", "UsageError", "did you mean check?"),
    ("record show", "UsageError", "no such command: show"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("line", "kind", "says"), FAILURES, ids=[row[0] for row in FAILURES]
)
def test_failures(rps, rps_json, line, kind, says):
    command, code = shlex.split(line), 2 if kind == "UsageError" else 3
    result = rps(*command, exit_code=code, says=("error: ", says))
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    document = rps_json(*command, exit_code=code)
    assert document["status"] == "error"
    assert document["error"]["type"] == kind
    assert document["error"]["exit_code"] == code
    assert says in document["error"]["message"]
    assert not Path("results").exists()


def test_every_fault_of_a_case_is_a_line(rps):
    result = rps(
        "check", "small.yaml", "--set", "podium.columns=0", "--set", "rps=2", exit_code=3
    )
    lines = result.stderr.splitlines()
    assert len(lines) >= 2
    assert all(line.startswith("error: ") for line in lines)


def test_an_unreadable_record_leaves_the_derived_quantities(rps_json):
    unreadable = ("check", "small.yaml", "--set", "record.source=none.at2")
    document = rps_json(*unreadable, exit_code=3)
    assert document["status"] == "error"
    assert document["record"] is None
    assert document["T1"] == pytest.approx(0.3, rel=1e-12)


@pytest.mark.parametrize(
    ("error", "code", "says"),
    [
        (KeyboardInterrupt(), 130, "interrupted; no file is half written"),
        (ZeroDivisionError("by accident"), 1, "ZeroDivisionError: by accident"),
        (PermissionError(13, "Permission denied", "a/b"), 1,
         "a/b: Permission denied; check the path"),
        (MemoryError(), 1, "there is not enough memory"),
        (RecursionError("too deep"), 1, "there is not enough memory"),
    ],
)  # fmt: skip
def test_what_stops_a_command_is_told(rps, monkeypatch, error, code, says):
    """A fault of ours as such; what the machine refuses is none."""

    def stops(*_, **__):
        raise error

    monkeypatch.setattr("rpscli.analyses.modal.modal", stops)
    ours = isinstance(error, ZeroDivisionError)
    result = rps("modal", "small.yaml", "--json", exit_code=code, says=says)
    assert ("internal error (test_streams.py:" in result.stderr) == ours
    assert ("internal" in result.stderr) == ours
    assert "Traceback" not in result.stderr
    found = json.loads(result.stdout)["error"]
    assert (found["type"] == "Interrupted") == (code == 130)
    assert not Path("results").exists()
    monkeypatch.setenv("RPS_TRACEBACK", "1")
    assert ("Traceback" in rps("modal", "small.yaml", exit_code=code).stderr) == (
        code == 1
    )


def test_a_working_folder_that_is_gone(shell):
    line = "here=$PWD; mkdir gone; cd gone; rmdir ../gone; rps modal $here/small.yaml; echo $?"
    result = shell(line)
    assert result.stdout.splitlines()[-1] == "1"
    assert "cannot be written: No such file or directory" in result.stderr


def test_no_arguments_show_the_help(rps):
    result = rps(exit_code=2)
    assert "timehistory" in result.output
    assert "error:" not in result.output


def test_standard_input(rps, rps_json):
    document = rps_json("modal", "-", input=SMALL_CASE)
    assert document["case"]["name"] == "stdin"
    assert Path("results/stdin/modal/modes.csv").is_file()
    result = rps(
        "check", "-", input="rps: 1\nsuperstructure: {storeys: 0}\n", exit_code=3
    )
    assert "error: <stdin>" in result.stderr


def test_no_colours_in_a_pipe(shell):
    result = shell("rps check small.yaml")
    assert result.returncode == 0
    assert "\x1b" not in result.stdout + result.stderr


def test_no_color_is_respected_on_a_terminal(rps, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm-256color")
    assert "\x1b[1m" in rps("check", "small.yaml").stdout
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b[3" not in rps("check", "small.yaml").stdout


@pytest.fixture
def on_terminal(workplace):
    """Run `rps` in a process of its own on a terminal of 64 columns; what appears there."""
    termios = pytest.importorskip("termios")
    search = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    usual = {"TERM": "xterm-256color", "PYTHONPATH": search}
    for name in os.environ.keys() - {"COLUMNS", "NO_COLOR", "FORCE_COLOR", *usual}:
        usual[name] = os.environ[name]

    def run(*arguments, **more):
        ours, theirs = os.openpty()
        termios.tcsetwinsize(theirs, (24, 64))
        heard = b""
        with subprocess.Popen(
            [sys.executable, "-m", "rpscli", *arguments], cwd=workplace, env=usual | more,
            stdin=theirs, stdout=theirs, stderr=theirs,
        ) as process:  # fmt: skip
            os.close(theirs)
            with contextlib.suppress(OSError):  # the end of a terminal that nobody holds
                while part := os.read(ours, 65536):
                    heard += part
        os.close(ours)
        assert process.returncode == 0, heard
        return heard.decode("utf-8")

    return run


@pytest.mark.posix
def test_a_real_terminal_has_colours_its_own_width_and_a_bar(on_terminal, workplace):
    """In other tests variables and streams only say that they are one."""
    text = on_terminal("pushover", "small.yaml", "--figures", "none")
    assert "\x1b[1m" in text
    plain = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)
    assert 50 < max(len(line.rstrip()) for line in plain.splitlines()) <= 64
    study = STUDY.replace("base.yaml", "small.yaml")
    (workplace / "study.yaml").write_text(study, encoding="utf-8")
    text = on_terminal("sweep", "study.yaml", "--figures", "none", NO_COLOR="1")
    assert "\r\x1b[2K" in text  # a line that is written again
    assert "36/36" in text
    assert "\x1b[3" not in text


def test_narrow_terminals_break_no_number(rps, monkeypatch):
    numbers = re.findall(r"\d+\.\d+", rps("pushover", "small.yaml").stdout)
    monkeypatch.setenv("COLUMNS", "44")
    narrow = rps("pushover", "small.yaml").stdout
    assert max(len(line) for line in narrow.splitlines()) <= 44
    assert sorted(re.findall(r"\d+\.\d+", narrow)) == sorted(numbers)
    assert "…" not in narrow
    words = rps("timehistory", "small.yaml").stdout.split()
    assert {"storey", "acceleration"} <= set(words)  # heads of columns


def test_a_reader_that_leaves_is_no_error(shell):
    line = "rps {} | true; echo ${{PIPESTATUS[0]}}"
    check = "check small.yaml"
    for command in (
        check,
        f"{check} --json",
        "schema",
        "--help",
        "sweep -h",
        "--version",
    ):
        result = shell(line.format(command))
        assert result.stderr == ""
        assert result.stdout.splitlines()[-1].endswith("0")


def test_ascii_output_is_no_obstacle(shell):
    text = "sed 's/Three storeys/Drei Geschosse über Lagern/' small.yaml"
    result = shell(f"{text} | rps check -", PYTHONIOENCODING="ascii")
    assert result.returncode == 0
    assert "Drei Geschosse ?ber Lagern" in result.stdout


def test_every_command_has_a_help(rps):
    for path in [(name,) for name in [*OURS, *of_tools("commands")]] + [
        ("record", name) for name in record.commands
    ]:
        result = rps(*path, "--help")
        assert result.stdout.startswith(f"Usage: program {' '.join(path)}")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
@pytest.mark.parametrize("options", ["", "--json"])
def test_a_full_disk_behind_the_output_is_named(shell, options):
    result = shell(f"rps check small.yaml {options} > /dev/full")
    assert result.returncode == 1
    assert (
        result.stderr
        == "error: standard output: cannot be written: No space left on device\n"
    )


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_an_error_finds_a_full_disk_behind_the_output(shell):
    """The document of an error has no room: both are told, without a traceback."""
    result = shell("rps check nosuch.yaml --json > /dev/full")
    assert result.returncode == 1
    first, second = result.stderr.splitlines()
    assert first.startswith("error: nosuch.yaml: there is no such file")
    assert second == "error: standard output: cannot be written: No space left on device"
    assert shell("rps check nosuch.yaml 2> /dev/full").returncode == 3
    assert shell("rps check nosuch.yaml --json > /dev/full 2>&1").returncode == 1


def test_a_closed_output_is_named(monkeypatch, capsys):
    closed = io.StringIO()
    closed.close()
    with monkeypatch.context() as changed:
        changed.setattr(sys, "stdout", closed)
        assert report(CaseError("a case"), as_json=True) == 1
    assert "standard output: cannot be written" in capsys.readouterr().err


class Silent(Exception):
    """One that says nothing, and an exit code that is none."""

    exit_code = "three"

    def __str__(self):
        raise ValueError("no words")


def test_an_error_without_words_is_told(capsys):
    assert report(Silent(), as_json=False) == 1
    assert "Silent: its text cannot be read: ValueError" in capsys.readouterr().err


@pytest.mark.posix
def test_files_that_find_no_room_are_named_and_nothing_is_left_half_written(
    shell, workplace
):
    """The system refuses them by itself, beyond a size that no file may have."""
    Path("few").mkdir()
    result = shell("ulimit -f 1; rps pushover small.yaml --figures none -o few --force")
    assert result.returncode == 1
    assert "cannot be written: File too large" in result.stderr
    assert [*Path("few").iterdir()] == []


def test_no_standard_output_at_all(shell):
    result = shell("rps check small.yaml >&-")
    assert (result.returncode, result.stderr) == (0, "")


SAID = "0 of 3 (95 %: below 0.63), 2 overturned; 29 would show it"
ASKED = "at most 2 except in 10 % of the records"


@pytest.mark.parametrize(
    ("width", "heads", "row", "words", "keys", "parts"),
    [
        (40, "record,outcome,rotation,base shear kN,lift",
         "farfield_1_a,survived,0.123456,10000,3", 2, 1, 2),
        (100, "record,outcome,rotation,base shear kN,lift",
         "farfield_1_a,survived,0.123456,10000,3", 2, 1, 1),
        # keys are repeated
        (50, "R m,limit,,requirement,result",
         "1.5,rotation_ratio,EXCEEDED,at most 0.3,2 of 2 (95 %: above 0.22)", 4, 2, 2),
        # room is taken from words first
        (60, "record,rotation ratio,base shear kN,floor acceleration m/s2",
         "mean of all maxima of records,0.1074,2255,12.68", 1, 1, 1),
        (80, "ρ,R m,PGV m/s,limit,,requirement,result",
         f"0.5,1.5,0.6,base_shear_ratio,met~ not shown,{ASKED},{SAID.replace(',', '~')}", 7, 4, 1),
    ],
)  # fmt: skip
def test_tables_are_no_wider_than_the_terminal(
    monkeypatch, width, heads, row, words, keys, parts
):
    """Words fold before a table is cut in parts, which begin with its keys."""
    monkeypatch.setenv("COLUMNS", str(width))
    cells = row.replace("~", "\0").split(",")
    cells = [cell.replace("\0", ",") for cell in cells]
    text = rendered([Table.of_texts(heads.split(","), [cells], words=words, keys=keys)])
    lines = text.splitlines()
    assert max(map(len, lines)) <= width
    assert sum(line.split()[:1] == cells[0].split()[:1] for line in lines) == parts
    assert all(word in text for cell in cells for word in cell.split())


class Screen(io.StringIO):
    """A terminal that keeps what it shows."""

    def isatty(self):
        return True


def shown(stream, terminal, monkeypatch):
    monkeypatch.setattr("sys.stderr", stream)
    with counted("drawing", terminal) as tell:
        tell(3, 40)
    return stream.getvalue()


def test_a_bar_on_a_terminal_one_line_elsewhere(monkeypatch):
    bar = shown(Screen(), Terminal(), monkeypatch)
    assert "drawing" in bar
    assert "3/40" in bar
    assert shown(io.StringIO(), Terminal(), monkeypatch) == "drawing\n"
    assert shown(Screen(), Terminal(quiet=True), monkeypatch) == ""


def test_many_systems_are_announced_few_are_not(capsys):
    for count in (MANY - 1, MANY):
        assert list(watched("systems examined", Terminal(), range(count))) == list(
            range(count)
        )
    assert capsys.readouterr().err == f"{MANY} systems examined\n"


def test_a_warning_is_said_once(capsys):
    terminal = Terminal()
    terminal.warn(["R is unusual", "e is unusual"])
    terminal.warn(["e is unusual", "contact is lost"])
    said = capsys.readouterr().err.splitlines()
    assert said == [
        f"warning: {of}" for of in ("R is unusual", "e is unusual", "contact is lost")
    ]
