"""Formulas of the texts, plain in an editor, set as formulas on the site: letters, no layout.

Words become letters, `_` and `^` subscripts and superscripts; nothing is moved, so that a formula
reads as it is written. Numbers at the right become anchors, and citations of them links.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from html import escape

GREEK = {
    name: chr(code)
    for name, code in {
        "alpha": 0x3B1, "beta": 0x3B2, "gamma": 0x3B3, "delta": 0x3B4, "zeta": 0x3B6, "eta": 0x3B7,
        "theta": 0x3B8, "kappa": 0x3BA, "lambda": 0x3BB, "mu": 0x3BC, "xi": 0x3BE, "pi": 0x3C0,
        "rho": 0x3C1, "sigma": 0x3C3, "phi": 0x3C6, "chi": 0x3C7, "psi": 0x3C8, "omega": 0x3C9,
        "Gamma": 0x393, "Delta": 0x394, "Phi": 0x3A6, "Omega": 0x3A9,
    }.items()
}  # fmt: skip
FUNCTIONS = {
    "sin", "cos", "tan", "cot", "sqrt", "abs", "sign", "sgn", "max", "min", "mean", "diag", "exp",
    "ln", "sum", "asin", "atan",
}  # fmt: skip
ROMAN = {"sqrt": "√", "sum": "∑"}
DIFFERENTIALS = {"du", "dv", "dx", "de", "dF", "dM", "dtheta", "dphi", "Io", "tol"}
NAMES = {"rim", "path", "sink", "jump", "root", "Re", "tau"}
"""Words that are formulas beside letters."""

SIGNS = {
    "->": "→", "<=": "≤", ">=": "≥", "+-": "±", "-": "−", "*": "·", "...": "…",
    "''": "″", "'": "′",
}  # fmt: skip
TOKEN = re.compile(
    r"(?P<measure>\d+\.\d+ (?:m/s2|m/s|rad/s|rad|mm|m|s)\b)"
    r"|(?P<number>\d+(?:\.\d+)?(?:e[+-]?\d+)?)|(?P<word>[A-Za-z]+)|(?P<sub>_)|(?P<sup>\^)"
    r"|(?P<side>''?[+-](?=[\s^,;)\]]|$))|(?P<sign>->|<=|>=|\+-|\.\.\.|''|'|-|\*)|(?P<other>.)",
    re.DOTALL,
)
GROUP = re.compile(r"\{([^{}]*)\}|\(([^()]*)\)|(-?\d+(?:\.\d+)?|[A-Za-z]+)")
NUMBER = re.compile(r"\((\d+\.\d+)\)")
LABEL = re.compile(r" +\((\d+\.\d+)\)$")
CELL = re.compile(r"\| \((\d+\.\d+)\) \|$", re.MULTILINE)
HEADING = re.compile(r"^## (\d+)\. (.+)$", re.MULTILINE)
BLOCK = re.compile(r"(?<=\n\n)(?: {4,}\S.*\n)+")
CITED = re.compile(r"(?:Theory|THEORY\.md),? (?:\(\d+\.\d+\)(?:, | and | to )?)+")
SECTIONS = re.compile(r"(?:Theory|THEORY\.md),? sections? \d+(?:(?:, | and | to )\d+)*")


def _letters(word: str) -> str:
    if word in GREEK or len(word) == 1:
        return f"<i>{GREEK.get(word, word)}</i>"
    if word in DIFFERENTIALS:
        return f"<i>{word.replace('theta', 'θ').replace('phi', 'φ')}</i>"
    return word


def _word(word: str, rest: str) -> str:
    """A word before the rest of a formula; `sum` is also a word, and a name in section 4."""
    if word == "sum" and not re.match(r"[(_]| [A-Za-z]+_", rest):
        return word
    return ROMAN.get(word) or _letters(word)


def _is_vector(text: str, token: re.Match[str]) -> bool:
    """Whether a 1 is the vector of ones: before or after a symbol, without an operator."""
    after, before = text[token.end() :], text[: token.start()]
    return token[0] == "1" and bool(
        re.match(r" (?:[A-Za-z](?![A-Za-z])|\d)|\^T|'[A-Z]", after)
        or re.search(r"M $|[CK]$", before)
    )


def typeset(text: str) -> str:
    """A formula as HTML."""
    out, place = [], 0
    while token := TOKEN.match(text, place):
        kind, piece = token.lastgroup, token[0]
        place = token.end()
        if kind in {"sub", "sup"} and (group := GROUP.match(text, place)):
            place = group.end()
            inner = group[1] or group[2] or group[3]
            if group[2] is not None and kind == "sup":
                inner = f"({inner})"
            words = re.fullmatch(r"[A-Za-z]{2,}", inner) and inner not in GREEK
            out.append(f"<{kind}>{inner if words else typeset(inner)}</{kind}>")
        elif kind == "word":
            out.append(_word(piece, text[place:]))
        elif kind == "measure":
            out.append(piece.replace("s2", "s²"))
        elif kind == "number" and _is_vector(text, token):
            out.append("<b>1</b>")
        elif kind == "side":
            if text.startswith("^", place):  # a power of what is before or after
                out[-1] = f"({out[-1]}"
            closed = ")" * text.startswith("^", place)
            prime, sign = SIGNS[piece[:-1]], SIGNS.get(piece[-1], piece[-1])
            out.append(f"{prime}<sup>{sign}</sup>{closed}")
        elif kind == "sign":
            out.append(SIGNS[piece])
        else:
            out.append(escape(piece))
    return "".join(out)


def is_formula(code: str) -> bool:
    """Whether a piece of code in a text holds letters of formulas alone, and no key or command."""
    if re.search(r"--|[\\\"$@%#&?`{}]|: |\.\w*[a-z]{2}|^-\w$|^/", code):
        return False
    words = re.findall(r"(_?)([A-Za-z]+)", re.sub(r"\d+(\.\d+)?e[+-]?\d+", "1", code))
    known = GREEK.keys() | FUNCTIONS | DIFFERENTIALS
    letters = [
        len(word) == 1 or word in known or (bool(sub) and len(word) <= 4)
        for sub, word in words
    ]
    named = [word in NAMES for _, word in words]
    return any(letters) and all(map(operator.or_, letters, named))


def _block(found: re.Match[str]) -> str:
    """An indented block as a table: parts that stand far apart are cells, numbers the last one."""
    lines = []
    for line in found[0].rstrip("\n").split("\n"):
        label = LABEL.search(line)
        body = line[: label.start()] if label else line
        indent = len(body) - len(body.lstrip()) - 4
        parts = re.split(r" {3,}", body.strip())
        lines.append((parts, indent, label[1] if label else ""))
    width = max(len(parts) for parts, *_ in lines)
    rows = []
    for parts, indent, number in lines:
        cells = [
            "".join(
                f"<code>{escape(piece)}</code>" if i % 2 else typeset(piece)
                for i, piece in enumerate(part.split("`"))
            )
            for part in parts
        ]
        if indent > 1:
            cells[0] = (
                f'<span style="padding-left:{0.4 * indent:.1f}em"></span>{cells[0]}'
            )
        span = width - len(cells) + 1
        body = "".join(f"<td>{cell}</td>" for cell in cells[:-1])
        body += f"<td{f' colspan={span}' if span > 1 else ''}>{cells[-1]}</td>"
        rows.append(f"<tr>{body}<td>{_anchor(number) if number else ''}</td></tr>")
    return f'<div class="formulas"><table>{"".join(rows)}</table></div>\n'


def _anchor(number: str) -> str:
    return f'<span id="eq-{number}">({number})</span>'


def set_formulas(text: str) -> str:
    """Displayed and inline formulas of a text without fences; what is no formula stays."""
    text = BLOCK.sub(_block, text)
    text = re.sub(
        r"\| \((\d+\.\d+)\) \|$",
        lambda n: f"| {_anchor(n[1])} |",
        text,
        flags=re.MULTILINE,
    )
    return re.sub(
        r"`([^`\n]+)`",
        lambda code: (
            f'<span class="formula">{typeset(code[1])}</span>'
            if is_formula(code[1])
            else code[0]
        ),
        text,
    )


def cite(text: str, link: Callable[[str, str], str], anchors: Mapping[str, str]) -> str:
    """Links, of a text and an anchor, for numbers of formulas and of sections of the theory."""

    def linked(number: re.Match[str]) -> str:
        anchor = anchors.get(number[1])
        return link(number[0], anchor) if anchor else number[0]

    text = CITED.sub(lambda found: NUMBER.sub(linked, found[0]), text)
    return SECTIONS.sub(lambda found: re.sub(r"\b(\d+)\b", linked, found[0]), text)


def cite_here(text: str, anchors: Mapping[str, str]) -> str:
    """The same on the page of the theory, where a number alone is a citation."""

    def linked(number: re.Match[str]) -> str:
        anchor = anchors.get(number[1])
        return f'<a href="#{anchor}">{number[0]}</a>' if anchor else number[0]

    return re.sub(r"(?<![>\w`])\((\d+\.\d+)\)(?![<`])", linked, text)


def anchors_of(theory: str) -> dict[str, str]:
    """The anchor of each number: of a section, of a formula at its right."""
    found = {
        number: slug(f"{number}. {title}") for number, title in HEADING.findall(theory)
    }
    labels = re.findall(r"^(?: {4}|\|).* \((\d+\.\d+)\)(?: \|)?$", theory, re.MULTILINE)
    return found | {number: f"eq-{number}" for number in labels}


def slug(heading: str) -> str:
    """The anchor of a heading, as GitHub and MyST make it."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")
