"""Texts of small cases; the tests count their lines."""

import pytest

from rpscli.case.case import parse_case
from rpscli.errors import CaseError

BUILDING = """\
rps: 1
superstructure:
  storeys: 3
  storey_mass: 200 t
  storey_height: 3.0
  period: 0.3
  profile: sine
  damping: {ratio: 0.05, modes: [1, 2]}
podium:
  bearing:
    semi_diagonal: 1.5
    slenderness: 0.15
    wedge_slenderness: 0.30
    curvature_ratio: 0.5
  cap_beam_mass_ratio: 10
  superstructure_mass_ratio: 3
  impact: {law: rigid}
record: {source: motion.at2}
analysis: {free_vibration: auto}
limits: {rotation_ratio: 0.5}
"""
FRAME = """\
rps: 1
superstructure: {storeys: 0}
podium:
  bearing:
    dimensions: {height: 3000 mm, width: 400 mm, wedge_width: 900 mm, radius: 1.2}
  cap_beam_mass: 200 t
  column_mass: 5 t
  columns: 4
"""

COLUMNS = "  column_mass: 5 t\n  columns: 4\n"
EQUIPPED = BUILDING.replace("  cap_beam_mass_ratio: 10\n", COLUMNS).replace(
    "record",
    """\
  devices:
    - {kind: viscous, coefficient: 2 MN s/m, exponent: 0.5}
    - {kind: friction, force: 400 kN}
    - {kind: stop, gap: 200 mm, stiffness: 50 kN/mm, damping: 100 kN s/m}
    - {kind: tendon, prestress: 100 kN, stiffness: 20 kN/mm, yield_force: 300 kN}
    - {kind: rolling_resistance, lever: 2 mm}
record""",
    1,
)
FLAT = (
    "podium.bearing.wedge_slenderness=0.15", "podium.bearing.curvature_ratio=0",
    "podium.impact.law=flexible", "podium.columns=4",
)  # fmt: skip
"""Ends that may bear on joints, put over the building; and joints."""

PLANE, EDGES = (
    f"podium.contact={{kind: {of}, period_ratio: 1.2}}" for of in ("plane", "edges")
)


def case_of(*overrides, text=BUILDING):
    """The case of a text, and of what is put over it."""
    return parse_case(text, name="c.yaml", overrides=overrides)


def refusal(text, old="", new="", overrides=()):
    """What a case is refused with, after one replacement in its text."""
    assert old in text
    with pytest.raises(CaseError) as refused:
        case_of(*overrides, text=text.replace(old, new) if old else text)
    return str(refused.value)
