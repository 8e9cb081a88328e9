"""A place for each hunt, and kernels, whose compilation takes longer than any trial may."""

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import ground, podium

from rpscli.analyses.demand import DemandRequest, demands
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper
from rpscli.model.impact import ImpactLaw
from rpscli.records.ground_motion import MotionComponents


@pytest.fixture(autouse=True)
def _workplace(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture(scope="session", autouse=True)
def _compiled():
    record, settings = ground(np.zeros(2), 0.01), TimeHistorySettings(0.0)
    for storeys, devices in ((1, ()), (40, ()), (1, (FrictionDamper(1e5),))):
        structure = replace(podium(storeys), devices=devices)
        for worth_lanes in (1, 2):
            request = DemandRequest(structure, MotionComponents(record), settings)
            demands([request], worth_lanes=worth_lanes)
    soft = replace(
        podium(1), impact_law=ImpactLaw(), contact=Contact("plane", period_ratio=1.2)
    )
    demands([DemandRequest(soft, MotionComponents(record), settings)])
    both = MotionComponents(record, y=record)
    demands([DemandRequest(replace(podium(1), impact_law=ImpactLaw()), both, settings)])
