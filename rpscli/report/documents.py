"""What `--json` prints: the results of each analysis under their published names."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from rpscli.analyses.result_quantities import SAMPLED, STOREYS, values_of
from rpscli.report.files.json_text import SCHEMA_VERSION
from rpscli.report.files.versions import program_version

if TYPE_CHECKING:
    from rpscli.analyses.pushover import PushoverResult
    from rpscli.analyses.results import TimeHistoryResult

Document = dict[str, Any]

ONE_DIRECTION = "one horizontal direction at a time, which is not conservative: see the README"
"""What has to be known wherever results of histories are read."""


def heading(status: str = "ok") -> Document:
    """The keys with which every document begins."""
    return {
        "schema_version": SCHEMA_VERSION,
        "rps_version": program_version(),
        "status": status,
    }


def failure_document(kind: str, message: str, exit_code: int) -> Document:
    """The keys by which a document says that its command failed."""
    return {
        **heading("error"),
        "passed": False,
        "exit_code": exit_code,
        "error": {"type": kind, "message": message, "exit_code": exit_code},
    }


def pushover_document(result: PushoverResult) -> Document:
    """Forces in N, displacements in m, the storey's curve and one entry a load pattern."""
    return {**result.results(), "capacity": [asdict(curve) for curve in result.capacity]}


def timehistory_document(result: TimeHistoryResult) -> Document:
    """Scalar results, demands of each storey, energies [J], and what to be warned of."""
    # Every command begins a document, few need numpy for it.
    from rpscli.report.tables.storeys import fixed_base_demands, isolated_demands

    isolated, fixed = isolated_demands(result), fixed_base_demands(result)
    return {
        "record": {
            "name": result.record.name,
            "source": result.record.source,
            "npts": result.record.npts,
            "dt": result.record.dt,
            "pga": result.record.pga,
        },
        "failure": result.failure,
        **result.scalars(),
        **values_of(result, SAMPLED),
        "column_forces": {end: asdict(forces) for end, forces in result.column_forces.items()},
        **values_of(isolated, STOREYS),
        "fixed_base": None if fixed is None else values_of(fixed, STOREYS),
        "energy": asdict(result.energy),
        "devices": [asdict(demand) for demand in result.devices],
        "warnings": result.warnings,
    }
