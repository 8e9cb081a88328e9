"""Strict YAML: text -> Document with positions, core-schema
scalars and no duplicate keys.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import yaml
from yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from rpscli.case.text.document import Document, Fault, Path, Position, dotted, shown
from rpscli.errors import CaseError

REMEDIES = {
    "\\t' that cannot start": "there is a tab here; indent with spaces",
    "mapping values are not allowed": (
        "a colon is not expected here; indent the keys of one mapping alike, and put text"
        " that holds a colon and a blank in quotes"
    ),
    "could not find expected ':'": (
        "a key without its colon; write `key: value`, with a blank after the colon"
    ),
    "expected <block end>": (
        "the indentation does not fit; the keys of one mapping begin in the same column"
    ),
    "expected ',' or": (
        "a bracket or brace is not closed, or a comma is missing before this"
    ),
    "found undefined alias": (
        "no anchor of this name is defined before; text that begins with * needs quotes"
    ),
    "found unexpected end of stream": "a quotation mark is not closed",
    "unknown escape character": (
        "in double quotes a backslash begins an escape; write paths in single quotes, or"
        " with /"
    ),
    "escape sequence of": (
        "in double quotes a backslash begins an escape; write paths in single quotes, or"
        " with /"
    ),
    "cannot start any token": "text that begins with this character needs quotes",
    "nested over": "a case is five levels deep: close brackets, or remove indentation",
    "nodes": "no case or study has so many values",
}
"""Remedies by a part of PyYAML's message; the first that fits counts."""


def syntax_error(error: yaml.YAMLError, text: str, name: str) -> str:
    """One line: place, what is wrong, what to do."""
    if isinstance(error, yaml.reader.ReaderError):
        before = text[: error.position]
        line = before.count("\n") + 1
        column = len(before) - before.rfind("\n")
        code = (
            error.character if isinstance(error.character, int) else ord(error.character)
        )
        return (
            f"{name}:{line}:{column}: the character U+{code:04X} is not allowed in YAML;"
            " delete it and save the file as UTF-8 text"
        )
    assert isinstance(error, yaml.MarkedYAMLError), "PyYAML has no third kind of error"
    mark = error.problem_mark or error.context_mark
    start = error.context_mark
    place = f"{name}:{mark.line + 1}:{mark.column + 1}" if mark else name
    problem = error.problem or "cannot be read"
    remedy = next((remedy for part, remedy in REMEDIES.items() if part in problem), None)
    if remedy is None:
        return (
            f"{place}: this is not YAML: {problem}; compare with what `rps init` writes"
        )
    if mark and "\\t" in problem and _behind_text(text, mark):
        remedy = "there is a tab behind the text here; write a blank in its place"
    if start and any(word in (error.context or "") for word in ("flow", "quoted")):
        # The bracket or the quotation mark that is not closed.
        remedy += f"; it opens at line {start.line + 1}, column {start.column + 1}"
    return f"{place}: {remedy} (YAML: {problem})"


def _behind_text(text: str, mark: yaml.Mark) -> bool:
    """True where a line has more than blanks before a place."""
    lines = text.splitlines()
    return mark.line < len(lines) and bool(lines[mark.line][: mark.column].strip())


DEEPEST = 40
"""Levels of nesting; a case needs five."""
LARGEST = 20_000
"""Values in a document, aliases counted each time they are used."""

TAG = "tag:yaml.org,2002:"
SCALARS = {
    "null": re.compile(r"(?:null|Null|NULL|~|)\Z"),
    "bool": re.compile(r"(?:true|True|TRUE|false|False|FALSE)\Z"),
    "int": re.compile(r"(?:[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+)\Z"),
    "float": re.compile(
        r"(?:[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?"
        r"|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN))\Z"
    ),
    "str": re.compile(""),
}
"""Plain scalars of YAML 1.2, tried in this order."""


class CoreLoader(yaml.SafeLoader):
    """PyYAML's loader with the scalars of YAML 1.2, reading nodes only."""

    # Without this PyYAML would add to the YAML 1.1 table, in which `no` is false.
    yaml_implicit_resolvers: dict[Any, Any] = {}  # noqa: RUF012 -- PyYAML's own class attribute

    depth = 0
    nodes = 0

    def compose_node(self, parent: Node | None, index: int) -> Node | None:
        """Compose one node, unless there are more, or deeper
        ones, than anything sensible.
        """
        self.depth += 1
        self.nodes += 1
        if self.depth > DEEPEST or self.nodes > 2 * LARGEST:  # keys are nodes too
            mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]
            deep = self.depth > DEEPEST
            problem = (
                f"nested over {DEEPEST} deep" if deep else f"over {2 * LARGEST} nodes"
            )
            raise yaml.composer.ComposerError(None, None, problem, mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node


for _tag, _pattern in SCALARS.items():
    CoreLoader.add_implicit_resolver(TAG + _tag, _pattern, None)


def read_yaml(text: str, name: str) -> Document:
    r"""Read one YAML document whose root is a mapping."""
    root = _root(text, name)
    if root is None or (isinstance(root, ScalarNode) and not root.value):
        raise CaseError(
            f"{name}: the file is empty; `rps init` writes a case to start from"
        )
    reader = _Reader(name, text)
    content = reader.value(root, ())
    if not isinstance(content, dict):
        place = reader.place(root)
        raise CaseError(
            f"{place}: the file holds {shown(content, 22)}, not a mapping; it must begin"
            " with keys, as in `rps: 1`"
        )
    return Document(name, content, reader.keys, reader.values, tuple(reader.faults))


def read_value(text: str, name: str) -> Any:
    """Value of one YAML scalar or flow collection (``0.2``, ``[1,
    2]``), without positions.
    """
    root = _root(text, name)
    if root is None:
        raise CaseError(f"{name}: no value; write null to remove the key")
    reader = _Reader(name, text)
    value = reader.value(root, ())
    if reader.faults:
        raise CaseError("\n".join(f"{name}: {fault.text}" for fault in reader.faults))
    return value


def _root(text: str, name: str) -> Node | None:
    try:
        loader = CoreLoader(text)
        root = loader.get_node() if loader.check_node() else None
        second = loader.get_node() if loader.check_node() else None
    except yaml.YAMLError as error:
        raise CaseError(syntax_error(error, text, name)) from None
    if second is not None:
        raise CaseError(
            f"{name}:{second.start_mark.line + 1}:1: a second document begins here; one"
            " file holds one document: remove the `---` line, or split the file"
        )
    return root


@dataclass
class _Reader:
    """Nodes -> values, gathering positions and faults on the way."""

    name: str
    text: str
    keys: dict[Path, Position] = field(default_factory=dict)
    values: dict[Path, Position] = field(default_factory=dict)
    faults: list[Fault] = field(default_factory=list)
    open_nodes: list[Node] = field(default_factory=list)
    count: int = 0

    def place(self, node: Node) -> Position:
        return Position(self.name, node.start_mark.line + 1, node.start_mark.column + 1)

    def value(self, node: Node, path: Path) -> Any:
        place = self.values[path] = self.place(node)
        self.count += 1
        if self.count > LARGEST:
            raise CaseError(
                f"{place}: more than {LARGEST} values; do aliases multiply them?"
            )
        if any(node is other for other in self.open_nodes):
            raise CaseError(
                f"{place}: the anchor holds an alias of itself; write the value out"
            )
        self.open_nodes.append(node)
        value: Any = None
        tag = node.tag.removeprefix(TAG)
        named = f"{dotted(path)}: " if path else ""
        if isinstance(node, MappingNode) and tag == "map":
            value = {
                key: self.value(item, (*path, key))
                for key, item in self.pairs(node, path)
            }
        elif isinstance(node, SequenceNode) and tag == "seq":
            written = self.text[node.start_mark.index : node.end_mark.index]
            if node.flow_style and (text := _comma_in_list(written)):
                self.fault(path, node, named + text)
            else:
                value = [
                    self.value(item, (*path, i)) for i, item in enumerate(node.value)
                ]
        elif isinstance(node, ScalarNode) and tag in SCALARS:
            try:
                value = _scalar(tag, node.value)
            except ValueError as error:
                self.fault(path, node, f"{named}{error}")
        else:
            self.fault(path, node, f"the YAML tag {node.tag} is not used here; remove it")
        self.open_nodes.pop()
        return value

    def pairs(self, node: MappingNode, path: Path) -> Iterator[tuple[str, Node]]:
        """Keys with their nodes, each key once."""
        pairs = iter(node.value)
        for key_node, value_node in pairs:
            if text := _no_key(key_node):
                self.fault(path, key_node, text)
                continue
            key = str(key_node.value)
            here = (*path, key)
            if here in self.keys:
                first = (
                    f"first at line {self.keys[here].line}, column"
                    f" {self.keys[here].column}"
                )
                text = f"{dotted(here)} is written twice, {first}; keep one of them"
                self.fault(here, key_node, text)
                continue
            self.keys[here] = self.place(key_node)
            fraction = _FRACTION.match(self.text, value_node.end_mark.index)
            if node.flow_style and value_node.tag == TAG + "int" and fraction:
                text = f"{value_node.value}{fraction[0]}"
                text += f" has a decimal comma; write {text.replace(',', '.')}"
                self.fault(here, value_node, f"{dotted(here)} = {text}")
                value_node = ScalarNode(TAG + "null", "", value_node.start_mark)  # noqa: PLW2901
                next(pairs)  # the fraction
            yield key, value_node

    def fault(self, path: Path, node: Node, text: str) -> None:
        self.faults.append(Fault(path, text, place=self.place(node)))


def _no_key(node: Node) -> str:
    """Why a node is no key; empty if it is one."""
    if not isinstance(node, ScalarNode):
        return "a key must be a word, not a list or a mapping; check braces and brackets"
    if node.value == "<<" and node.style is None:
        return "`<<` (merging a mapping) is not YAML 1.2; write the keys out"
    if node.tag != TAG + "str":
        return f"the key {node.value or 'null'} must be text, as in `storeys: 6`"
    return ""


_FRACTION = re.compile(r",(\d+)(?=\s*[,}])")
"""What stands behind a decimal comma in braces, where YAML
reads a key without a value."""


def _comma_in_list(text: str) -> str:
    """The first decimal comma, as in ``[0,15, 0,2]``, in words; empty
    where blanks tell of none.
    """
    items = re.split(r",\s+", text[1:-1].strip())
    close = [re.fullmatch(r"(\d+),(\d[^,]*)", item) for item in items if "," in item]
    if len(items) == 1 or not close or not all(close) or (first := close[0]) is None:
        return ""
    return (
        f"{first[0]} has a decimal comma; write {first[1]}.{first[2]}, or for two numbers"
        " a blank behind the comma"
    )


def _scalar(tag: str, text: str) -> bool | int | float | str | None:
    """Value of a scalar whose tag (``int``, ``float``, ...) is known."""
    if not SCALARS[tag].match(text):
        raise ValueError(f"{text!r} is not a YAML {tag}")
    if tag == "str":
        try:  # JSON writes some letters as two halves
            return text.encode("utf-16", "surrogatepass").decode("utf-16")
        except UnicodeDecodeError:
            half = f"{text[:60]!r} holds half a letter, which no file can hold"
            raise ValueError(f"{half}; write the letter itself") from None
    if tag in {"null", "bool"}:
        return None if tag == "null" else text.lower() == "true"
    if tag == "float":
        return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))
    if len(text) > 400:  # far outside every quantity, and slow to convert
        raise ValueError(f"a whole number of {len(text)} digits is too long")
    return int(text, {"0o": 8, "0x": 16}.get(text[:2], 10))


def yaml_of(values: Mapping[str, Any]) -> str:
    """Values as the text of a file, which `read_yaml` reads as the same values."""
    text = yaml.safe_dump(dict(values), sort_keys=False, allow_unicode=True, width=100)
    if read_yaml(text, "").content != values:  # texts that are numbers in YAML 1.2 alone
        text = json.dumps(values, indent=2, ensure_ascii=False) + "\n"
    return text
