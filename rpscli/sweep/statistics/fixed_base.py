"""The buildings of a study on a fixed base, as a reference for storey shears.

The response is linear: one run at scale 1 serves every scale, and systems that differ in their
bearings alone share it.
"""

from __future__ import annotations

import hashlib
from concurrent.futures import ThreadPoolExecutor

from rpscli.errors import RecordError
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.sweep.evaluation.batch import reference_shears
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import RecordRequest
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.store import Store
from rpscli.sweep.table import Array

FixedBaseReferences = dict[tuple[int, RecordRequest], Array]
"""Largest storey shears (n,) [N] of a system on a fixed base, under an unscaled record."""


def fixed_base_references(
    layout: StudyPoints, context: StudyContext, store: Store, jobs: int
) -> FixedBaseReferences:
    """Those of all systems with a building; what is not in the store is computed and stored."""
    known = store.fixed_base()
    keys: dict[tuple[int, RecordRequest], bytes] = {}
    runs: dict[bytes, tuple[PodiumStructure, MotionComponents]] = {}
    structures: dict[bytes, PodiumStructure] = {}  # buildings of many systems are the same
    for system, properties in enumerate(layout.properties):
        if not properties.building:
            continue
        for request in dict.fromkeys(request or properties.record for request in layout.records):
            assert request is not None, "points of histories have a record"
            key = _key(layout, context, properties.building, request)
            try:
                if key not in known and key not in runs:
                    motion = context.records.motion(request)
                    if properties.building not in structures:
                        structures[properties.building] = layout.system(system).structure
                    runs[key] = structures[properties.building], motion
            except RecordError:
                continue
            keys[system, request] = key
    with ThreadPoolExecutor(jobs) as pool:
        shears = pool.map(lambda run: reference_shears(*run), runs.values())
        new = dict(zip(runs, shears, strict=True))
    store.add_fixed_base(new)
    known |= new
    return {place: known[key] for place, key in keys.items()}


def _key(
    layout: StudyPoints, context: StudyContext, building: bytes, request: RecordRequest
) -> bytes:
    digest = hashlib.sha256(layout.plan.solver.encode())
    digest.update(building)
    digest.update(context.records.digest(request))
    return digest.digest()
