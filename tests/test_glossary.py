"""One word for one thing: labels of tables and figures are words of the glossary."""

import re

import pytest

from rpscli.analyses import result_quantities
from rpscli.analyses.outcomes import OUTCOMES
from rpscli.commands.explain import glossary
from rpscli.report.derived import DYNAMICS, FIRST_PERIOD, GEOMETRY
from rpscli.report.timehistory import OUTCOMES as SENTENCES

EXPLAINED = {
    part.strip().lower()
    for entry, _ in glossary()
    for part in re.split(r",|\(.*?\)|\bof a column\b", entry)
    if part.strip()
}

PLAIN = {
    # the field's, which need no explanation here
    "pga", "pgv", "period", "frequency", "frequency parameter", "damping", "damping ratio",
    "mode shape", "eigenvalue", "duration", "energy", "force over weight", "frequency ratio",
    "semi-diagonal", "slenderness angle", "arcs", "width", "stiffness",
}  # fmt: skip

LABELS = sorted(
    {
        quantity.label
        for value in vars(result_quantities).values()
        for quantity in (value if type(value) is tuple else (value,))
        if isinstance(quantity, result_quantities.ResultQuantity)
    }
    | {row.label for row in (*GEOMETRY, *DYNAMICS, FIRST_PERIOD)}
)


@pytest.mark.parametrize("label", LABELS)
def test_labels_are_made_of_words_of_the_glossary(label):
    words = EXPLAINED | PLAIN
    assert any(
        re.search(rf"\b{re.escape(word)}(s|es)?\b", label.lower()) for word in words
    )


def test_outcomes_are_explained_with_the_sentences_that_are_printed():
    entries = [entry for entry, _ in glossary()]
    for outcome in (*OUTCOMES.values(), "failed"):
        (entry,) = (entry for entry in entries if outcome in re.split(r", | \(", entry))
        assert SENTENCES[outcome].rpartition(": ")[2].partition(",")[0] in re.split(
            r"[,()]", entry
        )


def test_no_word_is_explained_twice():
    words = [part.strip() for entry, _ in glossary() for part in entry.split(",")]
    assert len(words) == len(set(words))
    assert not any("|" in meaning for _, meaning in glossary())  # two rows in one line
