"""Every document keeps what the schema of results promises: real output of every command."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from click.testing import Result

from commands.conftest import SMALL_CASE
from rpscli.cli import COMMANDS
from rpscli.report.result_schema import DOCUMENTS, results_json_schema

SCHEMA = results_json_schema()
FRAME = """\
rps: 1
superstructure: {storeys: 0}
podium:
  bearing: {semi_diagonal: 1.5, slenderness: 0.15, curvature_ratio: 0}
  cap_beam_mass: 100 t
  cap_beam_mass_ratio: 10
"""
STUDY = """\
rps: 1
base: small.yaml
vary: [{podium.bearing.slenderness: [0.1, 0.15]}]
limits: {rotation_ratio: 1.0e-3}
reports: [overturning]
"""
DESIGN = """\
rps: 1
base: small.yaml
variables: {podium.bearing.slenderness: [0.1, 0.2]}
minimise: podium.bearing.slenderness
limits: {rotation_ratio: 0.5}
search: {first: 4, most: 8}
"""
PULSE = "pulse:sine?amplitude=0.3g&period=0.5"
NONE = ("--figures", "none")
RUNS: dict[str, tuple[tuple[str, ...], int]] = {
    "init": (("init", "new.yaml"), 0),
    "explain": (("explain", "slenderness"), 0),
    "check": (("check", "small.yaml"), 0),
    "check of a frame": (("check", "frame.yaml"), 0),
    "modal": (("modal", "small.yaml", *NONE), 0),
    "pushover": (("pushover", "small.yaml", *NONE), 0),
    "pushover of a frame": (("pushover", "frame.yaml", *NONE), 0),
    "timehistory": (("timehistory", "small.yaml", *NONE), 0),
    "timehistory of a frame": (("timehistory", "frame.yaml", "--record", PULSE, *NONE), 0),
    "timehistory of several": (
        ("timehistory", "small.yaml", "frame.yaml", "--record", PULSE, *NONE, "-o", "several"),
        0,
    ),
    "sweep --dry-run": (("sweep", "study.yaml", "--dry-run"), 0),
    "sweep": (("sweep", "study.yaml", *NONE), 10),
    "sweep of modes": (("sweep", "modes.yaml", *NONE), 0),
    "design": (("design", "design.yaml", *NONE), 0),
    "budget": (("budget", "small.yaml", "--record", PULSE, "--record", f"{PULSE}1", *NONE), 0),
    "export": (("export", "small.yaml", "opensees"), 0),
    "identify": (("identify", "small.yaml", "floor.csv", "release"), 0),
    "report": (("report", "small.yaml", "-o", "page.html"), 0),
    "report of a study": (("report", "study.yaml", "-o", "study.html"), 10),
    "record info": (("record", "info", PULSE), 0),
    "record plot": (("record", "plot", PULSE, *NONE), 0),
    "record convert": (("record", "convert", PULSE, "-o", "pulse.at2"), 0),
    "record synth": (("record", "synth", "synthetic:?pga=0.3g&seed=7", "-o", "s.at2"), 0),
    "record select": (
        ("record", "select", PULSE, f"{PULSE}&factor=2", "--target", "target.csv", "-n", "1",
         "--rules", "none", *NONE),
        0,
    ),
    "verify": (("verify",), 0),
    "verify --problems": (("verify", "--problems", "problems"), 0),
    "doctor": (("doctor",), 0),
    "error": (("check", "nothing.yaml"), 3),
}  # fmt: skip


def complaints(name: str, document: dict[str, Any]) -> Iterator[str]:
    """What a document lacks or has in another type."""
    known = SCHEMA["$defs"]
    wanted = known.get(name) or known[name.partition(" of ")[0]]
    for error in jsonschema.Draft202012Validator(wanted).iter_errors(document):
        yield f"{[*error.path]}: {error.message[:200]}"


def test_it_is_a_schema_and_names_every_command() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    named = {name.split()[0] for name in DOCUMENTS}
    assert named == COMMANDS.keys() - {"schema", "completion"}  # which print no document
    assert {*SCHEMA["$defs"]} - {*RUNS} == {"run.json"}


def open_objects(schema: Any, key: str = "") -> Iterator[str]:
    """Keys of objects of which nothing is declared."""
    if isinstance(schema, list):
        schema = dict(enumerate(schema))
    if not isinstance(schema, dict):
        return
    if schema.get("type") == "object" and not {"properties", "additionalProperties"} & {*schema}:
        yield key
    for name, part in schema.items():
        yield from open_objects(part, str(name))


def test_only_what_the_file_of_a_user_names_is_left_open() -> None:
    assert {*open_objects(SCHEMA)} == {"system", "limits", "reports", "inputs"}


@pytest.mark.parametrize("name", RUNS)
def test_documents_keep_it(
    name: str,
    rps: Callable[..., Result],
    workplace: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    empty = b'<svg xmlns="http://www.w3.org/2000/svg" width="1pt" height="1pt"/>'
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: empty)
    files = {
        "frame.yaml": FRAME,
        "study.yaml": STUDY,
        "design.yaml": DESIGN,
        "modes.yaml": STUDY.replace("limits: {rotation_ratio: 1.0e-3}\n", "analysis: modal\n")
        .replace("reports: [overturning]\n", ""),
        "floor.csv": "time [s],floor_acceleration [g]\n"
        + "".join(f"{i / 50},{math.exp(-i / 50) * math.cos(i / 2.4)}\n" for i in range(300)),
        "target.csv": "period [s],acceleration [g]\n0.1,0.3\n3,0.1\n",
    }  # fmt: skip
    for file, text in files.items():
        (workplace / file).write_text(text, encoding="utf-8")
    arguments, code = RUNS[name]
    result = rps(*arguments, "--json")
    assert result.exit_code == code, result.stderr
    document = json.loads(result.stdout)
    assert list(complaints(name, document)) == []
    # The whole schema takes it, and would not take another version of it.
    whole = jsonschema.Draft202012Validator(SCHEMA)
    assert whole.is_valid(document)
    assert not whole.is_valid({**document, "schema_version": 2})
    for run in workplace.rglob("run.json"):
        assert list(complaints("run.json", json.loads(run.read_text(encoding="utf-8")))) == []


def test_a_document_that_breaks_the_promise_is_seen(rps_json: Callable[..., Any]) -> None:
    document = rps_json("check", "small.yaml")
    assert SMALL_CASE.count("slenderness") == 2
    changed = {**document, "critical_rotation": "0.3 rad"}
    assert "is not of type" in "".join(complaints("check", changed))
    del document["static_base_shear"]
    assert "is a required property" in "".join(complaints("check", document))
