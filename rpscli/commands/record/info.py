"""`rps record info`: what was read, and how strong it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpscli.commands.record.input import source_options
from rpscli.commands.shell.options import terminal_options
from rpscli.commands.shell.terminal import Terminal
from rpscli.constants import STANDARD_GRAVITY
from rpscli.report.documents import heading
from rpscli.report.numbers import shown
from rpscli.report.table import Part, Table

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rpscli.records.ground_motion import GroundMotion
    from rpscli.records.measures import IntensityMeasures


@click.command("info")
@terminal_options
@source_options
def command(motion: GroundMotion, terminal: Terminal) -> None:
    """What was understood of SRC, and its intensity measures in SI units."""
    from rpscli.records.measures import intensity_measures
    from rpscli.report.tables.record import record_document

    measures = intensity_measures(motion)
    document = {**heading(), "command": "record info", **record_document(motion, measures)}
    terminal.result(document, record_tables(motion, measures))


def record_tables(motion: GroundMotion, measures: IntensityMeasures) -> Iterator[Part]:
    """What was read, and how strong it is."""
    rows = [
        ("source", motion.source),
        ("format", motion.format),
        ("understood", motion.description or "-"),
        ("samples", f"{motion.npts} at {motion.dt:g} s"),
        ("duration", f"{shown(motion.duration)} s"),
        ("PGA", f"{shown(measures.pga)} m/s2 = {measures.pga / STANDARD_GRAVITY:.4f} g"),
        ("PGV", f"{shown(measures.pgv)} m/s"),
        ("PGD", f"{shown(measures.pgd)} m"),
        ("Arias intensity", f"{shown(measures.arias)} m/s"),
        ("CAV", f"{shown(measures.cav)} m/s"),
        ("significant duration, 5-95 %", f"{shown(measures.d5_95)} s"),
    ]
    yield Table.listing([("name", motion.name), *rows])
