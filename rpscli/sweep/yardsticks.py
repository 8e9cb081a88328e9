"""The buildings of a study on a fixed base, as a yardstick for storey shears.

The response is linear: one run at scale 1 serves every scale, and systems that differ in their
bearings alone share it.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from rpscli.analyses.fixed_base import fixed_base_response
from rpscli.errors import RecordError
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import GroundMotion
from rpscli.sweep.batch import Bench
from rpscli.sweep.design import Design
from rpscli.sweep.points import RecordRequest
from rpscli.sweep.store import Store
from rpscli.sweep.table import Array

Yardsticks = dict[tuple[int, RecordRequest], Array]
"""Largest storey shears (n,) [N] of a system on a fixed base, under an unscaled record."""


class Run(NamedTuple):
    """One building under one record."""

    key: bytes
    structure: PodiumStructure
    motion: GroundMotion


def yardsticks(design: Design, bench: Bench, store: Store, jobs: int) -> Yardsticks:
    """All of a study; those that are not in the store are computed and stored.

    Systems without a building have none, nor have records that cannot be read.
    """
    known = {key: np.array(shears) for key, shears in store.yardsticks().items()}
    keys: dict[tuple[int, RecordRequest], bytes] = {}
    runs: dict[bytes, Run] = {}
    for system, facts in enumerate(design.facts):
        if not facts.building:
            continue
        for request in dict.fromkeys(request or facts.record for request in design.records):
            assert request is not None, "points of histories have a record"
            key = _key(design, bench, facts.building, request)
            try:
                if key not in known and key not in runs:
                    motion = bench.shelf.motion(request).horizontal
                    runs[key] = Run(key, design.system(system).structure, motion)
            except RecordError:
                continue
            keys[system, request] = key
    new = _computed(runs.values(), jobs)
    store.add_yardsticks({key: shears.tolist() for key, shears in new.items()})
    known |= new
    return {place: known[key] for place, key in keys.items()}


def _key(design: Design, bench: Bench, building: bytes, request: RecordRequest) -> bytes:
    digest = hashlib.sha256(design.plan.solver.encode())
    digest.update(building)
    digest.update(bench.shelf.digest(request))
    return digest.digest()


def _computed(runs: Iterable[Run], jobs: int) -> dict[bytes, Array]:
    with ThreadPoolExecutor(jobs) as pool:
        return dict(pool.map(_response, runs))


def _response(run: Run) -> tuple[bytes, Array]:
    building = run.structure.superstructure
    assert building is not None, "only buildings have a response"
    # The largest shear after the end of the record comes within a period.
    after = math.ceil(float(building.periods[0]) / run.motion.dt)
    response = fixed_base_response(run.structure, run.motion, run.motion.npts - 1 + after)
    return run.key, response.storey_shears
