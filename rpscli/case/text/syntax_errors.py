"""YAML's own complaints in the words of somebody who edits a case file."""

from __future__ import annotations

import yaml

REMEDIES = {
    "\\t' that cannot start": "a tab stands here; indent with spaces",
    "mapping values are not allowed": "a colon is not expected here; indent the keys of one"
    " mapping alike, and put text that holds a colon and a blank in quotes",
    "could not find expected ':'": "a key without its colon; write `key: value`, with a blank"
    " after the colon",
    "expected <block end>": "the indentation does not fit; the keys of one mapping begin in the"
    " same column",
    "expected ',' or": "a bracket or brace is not closed, or a comma is missing before this",
    "found undefined alias": "no anchor of this name stands before; text that begins with * needs"
    " quotes",
    "found unexpected end of stream": "a quotation mark is not closed",
    "cannot start any token": "text that begins with this character needs quotes",
    "nested over": "a case is five levels deep: close brackets, or take indentation out",
    "nodes": "no case or study has so many values",
}
"""What to do, by a part of PyYAML's message; the first that fits counts."""


def syntax_error(error: yaml.YAMLError, text: str, name: str) -> str:
    """One line: place, what is wrong, what to do."""
    if isinstance(error, yaml.reader.ReaderError):
        return _forbidden_character(error, text, name)
    assert isinstance(error, yaml.MarkedYAMLError), "PyYAML has no third kind of error"
    mark = error.problem_mark or error.context_mark
    place = f"{name}:{mark.line + 1}:{mark.column + 1}" if mark else name
    problem = error.problem or "cannot be read"
    remedy = next((remedy for part, remedy in REMEDIES.items() if part in problem), None)
    if remedy is None:
        return f"{place}: this is not YAML: {problem}; compare with what `rps init` writes"
    return f"{place}: {remedy}{_opened(error)} (YAML: {problem})"


def _opened(error: yaml.MarkedYAMLError) -> str:
    """Where the bracket or the quotation mark stands that is not closed."""
    start = error.context_mark
    if start is None or not any(word in (error.context or "") for word in ("flow", "quoted")):
        return ""
    return f"; it opens at line {start.line + 1}, column {start.column + 1}"


def _forbidden_character(error: yaml.reader.ReaderError, text: str, name: str) -> str:
    before = text[: error.position]
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    code = error.character if isinstance(error.character, int) else ord(error.character)
    return (
        f"{name}:{line}:{column}: the character U+{code:04X} is not allowed in YAML; delete it"
        " and save the file as UTF-8 text"
    )
