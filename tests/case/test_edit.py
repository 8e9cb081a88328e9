"""Values are put into files of users, and everything else stays."""

from __future__ import annotations

import difflib

import pytest

from rpscli.case.text.edit import edited
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError

TEXT = """\
# a building
podium:
  impact: {law: flexible, loss: 1.0}   # measured?
  bearing:
    slenderness: 0.15  # tan(alpha)
    title: 'a # b'
  devices:
    - {kind: viscous, coefficient: 100 kN s/m}
    - kind: rolling_resistance
      lever: 2 mm   # guessed
"""


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        ("podium.impact.loss", "0.62", "  impact: {law: flexible, loss: 0.62}   # measured?"),
        ("podium.impact.x", "1", "  impact: {x: 1, law: flexible, loss: 1.0}   # measured?"),
        ("podium.bearing.slenderness", "0.2", "    slenderness: 0.2  # tan(alpha)"),
        ("podium.bearing.title", "b", "    title: b"),
        ("podium.devices.0.coefficient", "5", "    - {kind: viscous, coefficient: 5}"),
        ("podium.devices.1.lever", "0.0013", "      lever: 0.0013   # guessed"),
        ("podium.friction", "0.5", "  friction: 0.5"),
        ("podium.contact.period_ratio", "1.2", "  contact: {period_ratio: 1.2}"),
        ("rps", "1", "rps: 1"),
    ],
)  # fmt: skip
def test_one_line_changes(key: str, value: str, line: str) -> None:
    changed = edited(TEXT, "case.yaml", {key: value})
    new = [each[2:] for each in difflib.ndiff(TEXT.splitlines(), changed.splitlines())
           if each.startswith("+ ")]  # fmt: skip
    assert new == [line]
    before, after = (read_yaml(text, "case.yaml").content for text in (TEXT, changed))
    assert after != before
    assert list(after["podium"]["bearing"]) == list(before["podium"]["bearing"])


@pytest.mark.parametrize("key", ["podium.devices.7.lever", "podium.impact", "podium.devices"])
def test_what_cannot_be_written_says_so(key: str) -> None:
    with pytest.raises(CaseError, match="by hand"):
        edited(TEXT, "case.yaml", {key: "3"})
