"""A page in Russian: other words, the same numbers; one table for pages and glossary."""

import re

import pytest
import shown_commands as docs

from rpscli.commands.explain import glossary_rows
from rpscli.report.page import Notice, ReportSection, page
from rpscli.report.russian import NOTE, TERMS, WORDS, in_russian
from rpscli.report.table import Table

CYRILLIC = re.compile("[А-Яа-яё]")
SOURCES = " ".join(
    " ".join(path.read_text("utf-8").split())
    for path in sorted(docs.PACKAGE.rglob("*.py"))
    if path.name != "russian.py"
)


COMPOSED = {
    "All limits are met.": ("All ", " are met"),
    "All {} limits are met.": ("All ", " are met", "limits"),
    "elastic, fixed base": ("elastic, ", "fixed base"),
    "elastic, fixed": ("elastic, ", '"fixed"'),
    "shear, most loaded column": ("shear, ", "most loaded column"),
    "shear, mean of the columns": ("shear, ", "mean of the columns"),
    "Outcome: survived: uplifts and comes back.": ("Outcome: ", "survived: uplifts and comes back"),
}  # fmt: skip
"""Texts that are put together, and of what."""


def test_entries_are_words_that_stand_somewhere():
    """A label that is renamed would stay English; here it fails."""
    theory = docs.THEORY.read_text("utf-8")
    glossary = " ".join(name for name, *_ in glossary_rows())
    everything = f"{SOURCES} {theory} {glossary}"
    parts = {
        word: COMPOSED.get(word) or [p.strip() for p in word.split("{}") if p.strip()]
        for word in WORDS
    }
    joined = re.sub(r'"\s+f?"', "", everything)  # texts over several lines
    lost = [w for w, of in parts.items() if not all(p in joined for p in of)]
    assert lost == []


def test_entries_change_words_alone():
    for english, russian in WORDS.items():
        assert CYRILLIC.search(russian), english
        assert not CYRILLIC.search(english)
        assert english.count("{}") == russian.count("{}")
        assert not re.search(r"\d", english.replace("m_i", "") + russian), english


@pytest.mark.parametrize(
    ("english", "russian"),
    [
        ("at most 350 mm in every record", "не более 350 mm при каждой записи"),
        ("0 of 7 beyond", "превышено в 0 из 7"),
        ("base shear kN", "поперечная сила в основании здания kN"),
        ("height [m]", "высота [m]"),
        ("Warning: podium.x = 0.3 is odd", "Предупреждение: podium.x = 0.3 is odd"),
        ("atan(0.3 / 2.97)", "atan(0.3 / 2.97)"),
        ("farfield_1_a_x0.66", "farfield_1_a_x0.66"),
        ("M_tot g tan α", "M_tot g tan α"),
    ],
)
def test_numbers_formulas_and_names_stay(english, russian):
    assert in_russian(english) == russian


def test_the_glossary_has_the_terms_of_the_pages():
    found = {}
    for name, _, russian in glossary_rows():
        parts = [part.strip() for part in re.split(r", | \(.*?\)", name)]
        known = [TERMS[part] for part in parts if part in TERMS]
        assert russian == "; ".join(known), name
        found |= dict.fromkeys(part for part in parts if part in TERMS)
    assert {*found} == {*TERMS}


def made(language):
    table = Table.of_texts(
        ("limit", "", "value"), [("friction_ratio", "met", "0.39")], words=2
    )
    blocks = [
        table,
        Notice("Warning: it is odd"),
        "All 3 limits are met.",
        "Some sentence.",
    ]
    signed = {"project": "X", "made by": None}
    sections = [ReportSection("In short", blocks)]
    return page("A title", "at 1.5", sections, "x", signed, language).decode()


def test_a_page_of_blocks_in_both_languages():
    english, russian = made("en"), made("ru")
    assert 'lang="ru"' in russian
    assert 'lang="en"' in english
    words = (
        "Кратко", "предельное условие", "выполнено", "Все условия выполнены, их 3.",
        "Предупреждение: it is odd", "объект", "составил", NOTE, "Some sentence.",
    )  # fmt: skip
    for told in words:
        assert told in russian
    assert not CYRILLIC.search(english)
    assert ("friction_ratio" in russian, "0.39" in russian) == (True, True)
