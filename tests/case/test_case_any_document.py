"""Whatever a file holds, it is a case that can be built, or it is refused in plain words."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from rpscli.case.case import case_from_mapping
from rpscli.case.overrides import apply_overrides
from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.keys import known_paths
from rpscli.case.text.document import Document
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError

from .conftest import BUILDING, FRAME

KEYS = [".".join(map(str, path)) for path in known_paths(CaseFile)]
NUMBERS = st.sampled_from([0, 1, 2, 3, 0.0, 0.05, 0.2, 0.5, 1.0, 1.5, -1, 1e-30, 1e20, 1e308])
WORDS = st.sampled_from(["critical", "auto", "sine", "value", "rigid", "2 t", "3 mm", "4 kN", "x"])
SINGLE = st.one_of(NUMBERS, WORDS, st.booleans(), st.floats(), st.none())
VALUES = st.one_of(
    SINGLE,
    st.lists(SINGLE, max_size=4),
    st.dictionaries(st.sampled_from(["law", "ratio", "height", "x"]), SINGLE, max_size=2),
)


@given(
    text=st.sampled_from([BUILDING, FRAME]),
    changes=st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=4),
)
def test_any_values(text: str, changes: dict[str, Any]) -> None:
    document = read_yaml(text, "c.yaml")
    lines: list[str] = []
    try:
        structure = case_from_mapping(document, "c.yaml", None, changes, label="vary").structure
        assert 0.0 < structure.restitution <= 1.0
        assert structure.critical_rotation > 0.0
    except CaseError as error:
        lines = str(error).splitlines()
    assert all(line.startswith(("c.yaml:", "vary ")) for line in lines)


@given(st.dictionaries(st.sampled_from(["rps", "podium", "superstructure", "x"]), VALUES))
def test_any_sections(content: dict[str, Any]) -> None:
    lines: list[str] = []
    try:
        case_from_mapping(Document("memory", content), "memory")
    except CaseError as error:
        lines = str(error).splitlines()
    assert lines
    assert all(line.startswith("memory: ") for line in lines)


@given(st.dictionaries(st.sampled_from(KEYS), NUMBERS, max_size=3))
def test_overrides_leave_the_document_alone(changes: dict[str, Any]) -> None:
    document = read_yaml(BUILDING, "c.yaml")
    reason = ""
    try:
        changed = apply_overrides(document, changes)
        assert changed.content is not document.content
    except CaseError as error:
        reason = str(error)
    assert document.content == read_yaml(BUILDING, "c.yaml").content
    assert "single value" in reason or not reason
