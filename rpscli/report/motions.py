"""A ground motion, or several that were chosen, as documents, tables and files."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from typing import Any

from rpscli.constants import STANDARD_GRAVITY
from rpscli.records.formats.statements import remark
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import (
    IntensityMeasures,
    ResponseSpectrum,
    displacement,
    velocity,
)
from rpscli.report.figures import motions as figures
from rpscli.report.figures.look import USUAL, Look
from rpscli.report.figures.style import figure_files
from rpscli.report.files import Files
from rpscli.report.table import (
    Column,
    Table,
    csv_lines,
    csv_text,
    shown,
)


def record_document(motion: GroundMotion, measures: IntensityMeasures) -> dict[str, Any]:
    """Description of the motion that was read, and its intensity measures in SI units."""
    told = ("name", "source", "format", "description", "npts", "dt", "duration")
    return {
        **{name: getattr(motion, name) for name in told},
        **asdict(measures),
        "sha256": motion.digest,
        "warnings": motion.warnings,
    }


def record_table(motion: GroundMotion, measures: IntensityMeasures) -> Table:
    """Table of the motion that was read, and of how strong it is."""
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
        ("significant duration, 5-75 %", f"{shown(measures.d5_75)} s"),
        ("significant duration, 5-95 %", f"{shown(measures.d5_95)} s"),
    ]
    return Table.listing([("name", motion.name), *rows])


def record_files(
    motion: GroundMotion, spectrum: ResponseSpectrum, look: Look = USUAL
) -> Files:
    """Files of a ground motion: a row a sample with its integrals, and a row a period."""
    a = motion.acceleration
    dt = motion.dt
    yield "record.csv", csv_lines([
        Column("time", "s", motion.time),
        Column("acceleration", "m/s2", a),
        Column("velocity", "m/s", velocity(a, dt)),
        Column("displacement", "m", displacement(a, dt)),
    ])  # fmt: skip
    yield "spectrum.csv", csv_text([
        Column("period", "s", spectrum.periods),
        Column("pseudo_acceleration", "m/s2", spectrum.pseudo_acceleration),
        Column("total_acceleration", "m/s2", spectrum.total_acceleration),
        Column("displacement", "m", spectrum.displacement),
    ])  # fmt: skip
    draw = partial(figures.record_figure, motion, spectrum, None)
    yield from figure_files({"record": draw}, look).items()


def two_column_text(motion: GroundMotion) -> str:
    """Time [s] and acceleration [m/s2], under a header that every
    reader of ours understands.
    """
    header = remark(f"{motion.name}: {motion.description}; from {motion.source}")
    of = motion.recording
    said = {
        "station": of.station,
        "component": of.direction,
        "event": of.event,
        "origin": of.origin,
    }
    lines = [f"# {header}"]
    lines += [f"# {key}: {remark(text)}" for key, text in said.items() if text]
    lines += [f"# dt: {motion.dt!r}", "# Time (s)  Acceleration (m/s2)"]
    lines += [
        f"{t:.10g} {a:.9g}" for t, a in zip(motion.time, motion.acceleration, strict=True)
    ]
    return "\n".join(lines) + "\n"
