"""The levels of evidence that VERIFICATION.md lists are those that tests are marked with."""

from __future__ import annotations

import ast

import pytest
from evidence import DOCUMENT, marks, with_table


def test_the_table_is_what_the_marks_say() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    assert with_table(text) == text, "write it again: cd tests; python -m evidence"


@pytest.mark.parametrize("words", ["'device', 'exact'", "'devices', 'sure'"])
def test_a_mark_has_known_words(words: str) -> None:
    with pytest.raises(ValueError, match=r"add it to tests/evidence\.py"):
        list(marks(ast.parse(f"pytest.mark.evidence({words})")))


def test_marks_count_by_test_or_for_all_of_a_module() -> None:
    tree = ast.parse("@pytest.mark.evidence('modes', 'exact')\ndef test_one(): ...")
    assert list(marks(tree)) == [("modes", "exact")]
