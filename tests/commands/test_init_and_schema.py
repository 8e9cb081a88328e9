"""rps init and rps schema."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from click.testing import Result

Invoke = Callable[..., Result]
InvokeJson = Callable[..., dict[str, Any]]


def test_the_starter_is_a_case(rps: Invoke) -> None:
    result = rps("init")
    assert result.exit_code == 0
    assert "case.yaml" in result.stderr
    assert rps("check", "case.yaml").exit_code == 0


def test_the_starter_through_a_pipe(rps: Invoke) -> None:
    text = rps("init", "-").stdout
    assert rps("check", "-", input=text).exit_code == 0
    assert not Path("case.yaml").exists()


def test_init_overwrites_nothing(rps: Invoke, rps_json: InvokeJson) -> None:
    Path("mine.yaml").write_text("mine", encoding="utf-8")
    result = rps("init", "mine.yaml")
    assert result.exit_code == 7
    assert "--force" in result.stderr
    assert Path("mine.yaml").read_text(encoding="utf-8") == "mine"
    assert rps_json("init", "mine.yaml", "--force")["files"] == ["mine.yaml"]
    assert Path("mine.yaml").read_text(encoding="utf-8").startswith("# A case of rps")


def test_the_schema_is_json_and_nothing_else(rps: Invoke) -> None:
    plain, marked = rps("schema"), rps("schema", "--json")
    assert plain.stdout == marked.stdout
    schema = json.loads(plain.stdout)
    assert "superstructure" in schema["properties"]
    assert plain.stderr == ""
