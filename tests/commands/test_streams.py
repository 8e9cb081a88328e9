"""What goes where: results, errors, colours, pipes, and the exit code that ends it."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path

import pytest

from rpscli.cli import COMMANDS
from rpscli.commands.record import command as record
from rpscli.commands.shell.terminal import MANY, Terminal, counted, rendered, watched
from rpscli.report.table import Table

from .conftest import Invoke, InvokeJson, Shell

EXAMPLES = [
    ("check", "small.yaml"),
    ("modal", "small.yaml"),
    ("pushover", "small.yaml"),
    ("timehistory", "small.yaml"),
    ("record", "info", "pulse:sine?amplitude=0.3g&period=1"),
    ("record", "plot", "pulse:sine?amplitude=0.3g&period=1"),
    ("record", "convert", "pulse:sine?amplitude=0.3g&period=1"),
    ("record", "synth", "pulse:sine?amplitude=0.3g&period=1"),
]


@pytest.mark.parametrize("command", EXAMPLES, ids=" ".join)
def test_a_document_is_all_that_json_prints(rps_json: InvokeJson, command: tuple[str, ...]) -> None:
    document = rps_json(*command)
    assert document["status"] == "ok"
    assert document["command"] == " ".join(command[:-1])
    assert {"rps_version", "warnings"} <= set(document)
    assert all(Path(file).is_file() for file in document.get("files", ()))


@pytest.mark.parametrize("command", EXAMPLES[:5], ids=" ".join)
def test_quiet_prints_nothing(rps: Invoke, command: tuple[str, ...]) -> None:
    result = rps(*command, "--quiet")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")


def test_a_document_is_data_that_quiet_does_not_take_away(rps_json: InvokeJson) -> None:
    assert rps_json("modal", "small.yaml", "--quiet")["status"] == "ok"


def test_tables_go_to_stdout_and_notes_to_stderr(rps: Invoke) -> None:
    result = rps("modal", "small.yaml")
    assert result.stdout.startswith("Three storeys [test]\n")  # brackets are no markup
    assert "written to" not in result.stdout
    assert result.stderr == f"written to {Path('results', 'small', 'modal')}\n"


FAILURES = [
    (("check", "none.yaml"), 3, "CaseError", "there is no such file"),
    (("check", "small.yaml", "--set", "podium.bearing.rho=1"), 3, "CaseError", "rho is not a key"),
    (("timehistory", "small.yaml", "--record", "none.at2"), 3, "RecordError", "none.at2"),
    (("timehistory", "small.yaml", "--scale", "nan"), 2, "UsageError", "finite"),
    (("timehistory", "small.yaml", "--animate-from", "nan"), 2, "UsageError", "finite"),
    (("verify", "--score", "a.csv", "--digits", "nan"), 2, "UsageError", "finite"),
    (("identify", "small.yaml", "a.csv", "rocking", "--from", "nan"), 2, "UsageError", "finite"),
    (("timehistory", "small.yaml", "--animate", "film.avi"), 2, "UsageError", ".gif"),
    (("modal", "small.yaml", "--animate-size", "500"), 2, "UsageError", "--animate FILE"),
    (("check", "small.yaml", "-o", "x"), 2, "UsageError", "--draw"),
    (("check", "small.yaml", "--figures", "pdf"), 2, "UsageError", "--draw"),
    (("timehistory", "small.yaml", "--set", "record=null"), 2, "UsageError", "--record"),
    (("timehistory", "small.yaml", "--fail-on", "rotation_rati=1"), 2, "UsageError", "_ratio?"),
    (
        ("timehistory", "small.yaml", "--fail-on", "zork=1"),
        2,
        "UsageError",
        "; `rps explain limits`",
    ),
    (
        ("timehistory", "small.yaml", "--set", "record.source=list:a.txt"),
        3,
        "RecordError",
        "by --record",
    ),
    (("timehistory", "small.yaml", "--fail-on", "rotation_ratio"), 2, "UsageError", "=NUMBER"),
    (("timehistory", "small.yaml", "--scale", "pga=0.4g"), 2, "UsageError", "--scale-to PGA=0.4g"),
    (("pushover", "small.yaml", "--pattern", "1,2"), 2, "UsageError", "3 floor forces"),
    (("pushover", "small.yaml", "--pattern", "mode"), 2, "UsageError", "first_mode"),
    (("record", "synth", "small.yaml"), 3, "RecordError", "small.yaml"),
    (("check",), 2, "UsageError", "CASE"),
    (("check", "small.yaml", "--colour"), 2, "UsageError", "--colour"),
    (("chek", "small.yaml"), 2, "UsageError", "did you mean check?"),
    (("record", "show"), 2, "UsageError", "no such command: show"),
]


@pytest.mark.parametrize(
    ("command", "code", "kind", "says"), FAILURES, ids=[" ".join(row[0]) for row in FAILURES]
)
def test_failures(
    rps: Invoke, rps_json: InvokeJson, command: tuple[str, ...], code: int, kind: str, says: str
) -> None:
    result = rps(*command)
    assert (result.exit_code, result.stdout) == (code, "")
    assert says in result.stderr
    assert "error: " in result.stderr
    assert "Traceback" not in result.stderr
    document = rps_json(*command, exit_code=code)
    assert document["status"] == "error"
    assert document["error"]["type"] == kind
    assert document["error"]["exit_code"] == code
    assert says in document["error"]["message"]
    assert not Path("results").exists()


def test_every_fault_of_a_case_is_a_line(rps: Invoke) -> None:
    result = rps("check", "small.yaml", "--set", "podium.columns=0", "--set", "rps=2")
    lines = result.stderr.splitlines()
    assert len(lines) >= 2
    assert all(line.startswith("error: ") for line in lines)


def test_an_unreadable_record_leaves_the_derived_quantities(rps: Invoke) -> None:
    result = rps("check", "small.yaml", "--set", "record.source=none.at2", "--json")
    document = json.loads(result.stdout)
    assert document["status"] == "error"
    assert document["record"] is None
    assert document["T1"] == pytest.approx(0.3, rel=1e-12)


def test_an_interruption_ends_with_130(rps: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("rpscli.analyses.modal.modal", interrupted)
    result = rps("modal", "small.yaml", "--json")
    assert result.exit_code == 130
    assert "interrupted; no file is half written" in result.stderr
    assert json.loads(result.stdout)["error"]["type"] == "Interrupted"
    assert not Path("results").exists()


def test_a_fault_of_ours_says_so(rps: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("by accident")

    monkeypatch.setattr("rpscli.analyses.modal.modal", broken)
    result = rps("modal", "small.yaml")
    assert result.exit_code == 1
    assert "internal error (test_streams.py:" in result.stderr
    assert "ZeroDivisionError: by accident" in result.stderr
    assert "Traceback" not in result.stderr
    monkeypatch.setenv("RPS_TRACEBACK", "1")
    assert "Traceback" in rps("modal", "small.yaml").stderr


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (PermissionError(13, "Permission denied", "a/b"), "a/b: Permission denied; check the path"),
        (MemoryError(), "there is not enough memory"),
        (RecursionError("too deep"), "there is not enough memory"),
    ],
)
def test_what_the_machine_refuses_is_no_fault_of_ours(
    rps: Invoke, monkeypatch: pytest.MonkeyPatch, error: Exception, words: str
) -> None:
    def refused(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("rpscli.analyses.modal.modal", refused)
    result = rps("modal", "small.yaml")
    assert result.exit_code == 1
    assert words in result.stderr
    assert "internal" not in result.stderr


def test_a_working_folder_that_is_gone(shell: Shell) -> None:
    line = "here=$PWD; mkdir gone; cd gone; rmdir ../gone; rps modal $here/small.yaml; echo $?"
    result = shell(line)
    assert result.stdout.splitlines()[-1] == "1"
    assert "cannot be written: No such file or directory" in result.stderr


def test_no_arguments_show_the_help(rps: Invoke) -> None:
    result = rps()
    assert "timehistory" in result.output
    assert "error:" not in result.output


def test_standard_input(rps: Invoke, rps_json: InvokeJson) -> None:
    text = Path("small.yaml").read_text(encoding="utf-8")
    document = rps_json("modal", "-", input=text)
    assert document["case"]["name"] == "stdin"
    assert Path("results/stdin/modal/modes.csv").is_file()
    result = rps("check", "-", input="rps: 1\nsuperstructure: {storeys: 0}\n")
    assert result.exit_code == 3
    assert "error: <stdin>" in result.stderr


def test_no_colours_in_a_pipe(shell: Shell) -> None:
    result = shell("rps check small.yaml")
    assert result.returncode == 0
    assert "\x1b" not in result.stdout + result.stderr


def test_no_color_is_respected_on_a_terminal(rps: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm-256color")
    assert "\x1b[1m" in rps("check", "small.yaml").stdout
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b[3" not in rps("check", "small.yaml").stdout


def test_narrow_terminals_fold_words_and_break_no_number(
    rps: Invoke, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbers = re.findall(r"\d+\.\d+", rps("pushover", "small.yaml").stdout)
    monkeypatch.setenv("COLUMNS", "44")
    narrow = rps("pushover", "small.yaml").stdout
    assert max(len(line) for line in narrow.splitlines()) <= 44
    assert sorted(re.findall(r"\d+\.\d+", narrow)) == sorted(numbers)
    assert "…" not in narrow
    words = rps("timehistory", "small.yaml").stdout.split()
    assert {"storey", "acceleration"} <= set(words)  # heads of columns


def test_a_reader_that_leaves_is_no_error(shell: Shell) -> None:
    line = "rps {} | true; echo ${{PIPESTATUS[0]}}"
    for command in (
        "check small.yaml",
        "check small.yaml --json",
        "schema",
        "--help",
        "sweep -h",
        "--version",
    ):
        result = shell(line.format(command))
        assert result.stderr == ""
        assert result.stdout.splitlines()[-1].endswith("0")


def test_ascii_output_is_no_obstacle(shell: Shell) -> None:
    text = "sed 's/Three storeys/Drei Geschosse über Lagern/' small.yaml"
    result = shell(f"{text} | rps check -", PYTHONIOENCODING="ascii")
    assert result.returncode == 0
    assert "Drei Geschosse ?ber Lagern" in result.stdout


def test_every_command_has_a_help(rps: Invoke) -> None:
    for path in [(name,) for name in COMMANDS] + [("record", name) for name in record.commands]:
        result = rps(*path, "--help")
        assert result.exit_code == 0
        assert result.stdout.startswith(f"Usage: program {' '.join(path)}")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
@pytest.mark.parametrize("options", ["", "--json"])
def test_a_full_disk_behind_the_output_is_named(shell: Shell, options: str) -> None:
    result = shell(f"rps check small.yaml {options} > /dev/full")
    assert result.returncode == 1
    assert result.stderr == "error: standard output: cannot be written: No space left on device\n"


def test_no_standard_output_at_all(shell: Shell) -> None:
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
    monkeypatch: pytest.MonkeyPatch,
    width: int, heads: str, row: str, words: int, keys: int, parts: int,
) -> None:  # fmt: skip
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

    def isatty(self) -> bool:
        return True


def shown(stream: io.StringIO, terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr("sys.stderr", stream)
    with counted("drawing", terminal) as tell:
        tell(3, 40)
    return stream.getvalue()


def test_a_bar_on_a_terminal_one_line_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    bar = shown(Screen(), Terminal(), monkeypatch)
    assert "drawing" in bar
    assert "3/40" in bar
    assert shown(io.StringIO(), Terminal(), monkeypatch) == "drawing\n"
    assert shown(Screen(), Terminal(quiet=True), monkeypatch) == ""


def test_many_systems_are_announced_few_are_not(capsys: pytest.CaptureFixture[str]) -> None:
    for count in (MANY - 1, MANY):
        assert list(watched("systems examined", Terminal(), range(count))) == list(range(count))
    assert capsys.readouterr().err == f"{MANY} systems examined\n"


def test_a_warning_is_said_once(capsys: pytest.CaptureFixture[str]) -> None:
    terminal = Terminal()
    terminal.warn(["R is unusual", "e is unusual"])
    terminal.warn(["e is unusual", "contact is lost"])
    said = capsys.readouterr().err.splitlines()
    assert said == [
        f"warning: {text}" for text in ("R is unusual", "e is unusual", "contact is lost")
    ]
