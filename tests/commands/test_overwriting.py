"""What a command replaces, and what it does not touch."""

import json
from pathlib import Path

import pytest

from .conftest import SMALL_CASE, write_case


def contents(folder):
    return {file.name: file.read_bytes() for file in Path(folder).iterdir()}


def test_the_same_run_gives_the_same_bytes_and_an_edited_case_says_so(rps):
    rps("modal", "small.yaml", "-o", "out")
    first = contents("out")
    result = rps("modal", "small.yaml", "-o", "out")
    assert "replaces" not in result.stderr
    assert contents("out") == first
    write_case("small.yaml", more="# edited\n")
    told = "replaces results of the same case with other inputs"
    rps("modal", "small.yaml", "-o", "out", says=told)


def test_another_command_or_case_is_refused(rps):
    rps("modal", "small.yaml", "-o", "out")
    before = contents("out")
    write_case("other.yaml")
    for command, case in (("pushover", "small.yaml"), ("modal", "other.yaml")):
        rps(
            command,
            case,
            "-o",
            "out",
            exit_code=7,
            says=("`rps modal` on small", "--force"),
        )
        assert contents("out") == before
    rps("pushover", "small.yaml", "-o", "out", "--force")
    assert json.loads(Path("out/run.json").read_bytes())["command"] == "pushover"


def test_strange_files_are_refused_unless_nothing_touches_them(rps):
    Path("out").mkdir()
    Path("out/notes.txt").write_text("mine", encoding="utf-8")
    rps("modal", "small.yaml", "-o", "out")
    Path("out/run.json").unlink()
    rps("modal", "small.yaml", "-o", "out", exit_code=7, says="modes.csv exists")
    assert Path("out/notes.txt").read_text(encoding="utf-8") == "mine"


def test_a_case_from_a_pipe_is_known_by_its_text(rps):
    for text, exit_code in (
        (SMALL_CASE, 0),
        (SMALL_CASE, 0),
        (SMALL_CASE + "# other", 7),
    ):
        rps("modal", "-", "-o", "out", input=text, exit_code=exit_code)


def test_a_place_that_is_no_folder(rps):
    Path("file").write_text("", encoding="utf-8")
    for place in ("file", "file/below"):
        result = rps("modal", "small.yaml", "-o", place, exit_code=1, says="is a file")
        assert "internal" not in result.stderr


@pytest.mark.posix
def test_two_processes_may_write_to_one_new_folder(shell):
    """Both compute; the second writes its results over those of the first, which are its own."""
    line = "rps modal small.yaml -o out --figures none"
    done = shell(f"{line} & first=$!; {line}; second=$?; wait $first && exit $second")
    assert done.returncode == 0, done.stderr
    assert json.loads(Path("out/run.json").read_bytes())["command"] == "modal"
