"""The kernels as plain Python do what they do as machine code, to the last bit."""

import hashlib
import json
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, needs_compiled_kernels, podium, printed_by, waves
from two_components import followed, frame, pair, two_pulses

from rpscli.analyses.kernels.history import HistoryRequest, run_of
from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.physics.integrate import integrate
from rpscli.physics.state import (
    IMPACT,
    LANES,
    RECONTACT,
    SLIDING,
    STICKING,
    STOP_LEFT,
    STOP_MET,
    TENDON_YIELDING,
    UPLIFT,
)
from rpscli.records.ground_motion import MotionComponents

DT = 0.02
ONE, TWO = waves(0.7, DT, 4.0, seed=5), waves(0.7, DT, 3.0, seed=8)
MOTIONS = [MotionComponents(*of) for of in ((ONE,), (TWO,), (ONE, TWO), (TWO, ONE))]
SETTINGS = TimeHistorySettings(free_vibration=0.3, recontact_tolerance=1e-3)
DEVICES = (
    FrictionDamper(6e5),
    Tendon(1e4, 2e6, 2e4),
    ViscousDamper(5e4, 0.5),
    Stop(0.02, 1e7, 1e5),
    RollingResistance(1e-4),
)
PLAIN = podium(2, 0.10, 0.5, R=0.4)
STRUCTURES = [
    PLAIN,
    podium(2, 0.15, FLAT, R=0.4, law=ImpactLaw("flexible")),
    replace(PLAIN, devices=DEVICES, columns=4),
]
REQUESTS = [
    HistoryRequest(0, 2),
    HistoryRequest(0, 1, scale=0.35),
    HistoryRequest(1, 3, scale=0.3),
]
ROWS = 256


def integrated(requests, lanes, rows=0):
    systems = stacked_systems([(structure, SETTINGS) for structure in STRUCTURES])
    run = run_of(systems, MOTIONS, requests, rows=rows, events=rows)
    # lanes without a history make empty steps, of zeros
    with np.errstate(all="ignore"):
        integrate(run, lanes)
    return run


def demands_of_all(run):
    """What every history leaves behind."""
    return [
        {name: np.ravel(result[name]).tolist() for name in result.dtype.names}
        for result in run.results
    ]


def sampled_history():
    """One with devices, with its samples and events."""
    run = integrated([HistoryRequest(2, 0)], lanes=1, rows=ROWS)
    kept = int(run.results.intervals[0]) + 1
    samples, log = (
        run.output.samples[:kept],
        run.output.log[: int(run.results.events[0].sum())],
    )
    found = {f"sampled {name}": samples[name].tolist() for name in samples.dtype.names}
    found |= {f"event {name}": log[name].tolist() for name in log.dtype.names}
    found |= demands_of_all(run)[0]
    count = len(STRUCTURES[-1].devices)
    found |= {"devices": run.output.devices[:kept, :, :count].ravel().tolist()}
    return found | {"floors": run.output.floors[:kept].ravel().tolist()}


def everything(lanes=2):
    """Histories side by side, and the sampled one.

    Python takes its time for each lane: with few of them, one takes several histories.
    """
    several = demands_of_all(integrated(REQUESTS, lanes))
    return {"several": several, "sampled": [sampled_history()]}


def digest_of_a_pair():
    """Of a storey that uplifts under two pulses, and passes near upright; samples included."""
    x, y = two_pulses()[:, 80:106]
    x[0] = y[0] = 0.0
    structure = frame(1, 1.0, tan_wedge=0.3, rho=0.5, contact_time=2e-3)
    history = followed(structure, pair(x, y, 0.01))
    assert len(history.passes)
    kept = history.left, history.samples, history.floors, history.log
    return hashlib.sha256(b"".join(of.tobytes() for of in kept)).hexdigest()


def as_python(function, **environment):
    """What a function of this module gives where nothing is compiled."""
    script = f"import json; from physics import {__name__.rpartition('.')[2]} as here\n"
    script += f"print(json.dumps(here.{function}()))"
    options = ("-P", "-W", "error", "-c", script)
    return json.loads(printed_by(*options, **{"RPS_INTERPRETED": "1"} | environment))


@pytest.fixture(scope="module")
def interpreted():
    return as_python("everything")


@needs_compiled_kernels
@pytest.mark.parametrize("kind", ["several", "sampled"])
def test_python_and_machine_code_agree(interpreted, kind):
    """Machine code in as many lanes as it has, Python in few."""
    compiled = everything(LANES)[kind]
    assert len(interpreted[kind]) == len(compiled)
    for slow, fast in zip(interpreted[kind], compiled, strict=True):
        assert slow.keys() == fast.keys()
        for name, values in fast.items():
            np.testing.assert_array_equal(slow[name], values, err_msg=name)


def test_the_histories_compared_are_not_trivial(interpreted):
    events = np.array([found["events"] for found in interpreted["several"]])
    assert events[:, UPLIFT].sum() >= 4
    assert events[:, IMPACT].sum() >= 8
    assert events[:, RECONTACT].any()
    for kind in (STICKING, SLIDING, STOP_MET, STOP_LEFT, TENDON_YIELDING):
        assert interpreted["sampled"][0]["events"][kind] > 0


@needs_compiled_kernels
def test_python_and_machine_code_agree_under_both_components(tmp_path):
    assert (
        as_python("digest_of_a_pair", RPS_CACHE_DIR=str(tmp_path)) == digest_of_a_pair()
    )
    assert not [*tmp_path.rglob("*.o")]
