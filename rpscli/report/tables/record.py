"""A ground motion as a JSON document, a CSV table, and a two-column text file."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import IntensityMeasures, displacement, velocity
from rpscli.records.spectrum import ResponseSpectrum
from rpscli.report.table import Column


def record_document(motion: GroundMotion, measures: IntensityMeasures) -> dict[str, Any]:
    """What was read, and its intensity measures in SI units."""
    return {
        "name": motion.name,
        "source": motion.source,
        "format": motion.format,
        "description": motion.description,
        "npts": motion.npts,
        "dt": motion.dt,
        "duration": motion.duration,
        **asdict(measures),
        "sha256": motion.digest,
        "warnings": motion.warnings,
    }


def motion_columns(motion: GroundMotion) -> list[Column]:
    """`record.csv`: the motion and its integrals, one row a sample."""
    a, dt = motion.acceleration, motion.dt
    return [
        Column("time", "s", motion.time),
        Column("acceleration", "m/s2", a),
        Column("velocity", "m/s", velocity(a, dt)),
        Column("displacement", "m", displacement(a, dt)),
    ]


def spectrum_columns(spectrum: ResponseSpectrum) -> list[Column]:
    """`spectrum.csv`: one row a period."""
    return [
        Column("period", "s", spectrum.periods),
        Column("pseudo_acceleration", "m/s2", spectrum.pseudo_acceleration),
        Column("total_acceleration", "m/s2", spectrum.total_acceleration),
        Column("displacement", "m", spectrum.displacement),
    ]


def two_column_text(motion: GroundMotion) -> str:
    """Time [s] and acceleration [m/s2], under a header that every reader of ours understands."""
    header = " ".join(f"{motion.name}: {motion.description}; from {motion.source}".split())
    lines = [f"# {header}", f"# dt: {motion.dt!r}", "# Time (s)  Acceleration (m/s2)"]
    lines += [f"{t:.10g} {a:.9g}" for t, a in zip(motion.time, motion.acceleration, strict=True)]
    return "\n".join(lines) + "\n"
