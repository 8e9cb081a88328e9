"""Podiums as rows of numbers."""

from __future__ import annotations

from typing import Any

from paper_structures import podium

from rpscli.analyses.kernel_input import podium_parameters
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.physics import podium_layout
from rpscli.physics.geometry import Phase
from rpscli.physics.parameters import Podium, podium_numbers


def test_every_number_stands_where_the_layout_says() -> None:
    """All numbers of the row differ, so none can stand in another's place."""
    numbers = iter(range(100))
    fields: dict[str, Any] = {
        name: Phase(*(float(next(numbers)) for _ in Phase._fields))
        if name in ("rolling", "rocking")
        else float(next(numbers))
        for name in Podium._fields
    }
    row = podium_numbers(Podium(**fields))
    assert len(row) == podium_layout.PODIUM_NUMBERS
    for name, value in fields.items():
        place = f"{name.upper()}_PHASE" if isinstance(value, Phase) else name.upper()
        at = getattr(podium_layout, place)
        assert row[at] == (value.p if isinstance(value, Phase) else value)


def test_the_row_of_a_structure_is_as_long() -> None:
    parameters = podium_parameters(podium(2, 0.15, 0.5), TimeHistorySettings())
    assert len(podium_numbers(parameters)) == podium_layout.PODIUM_NUMBERS
