"""What `import rpscli` offers gives no array that can be written to, in copies either."""

import copy
import inspect
import pickle
from dataclasses import replace
from functools import cache, cached_property
from pathlib import Path

import numpy as np
import pytest
from paper_structures import podium, waves

import rpscli
from rpscli.errors import RecordError
from rpscli.model.devices import FrictionDamper, Tendon

STRUCTURE = replace(
    podium(2, 0.15, 0.5), devices=(FrictionDamper(1e5), Tendon(1e4, 1e6)), columns=2
)
RECORD = waves(1.0, 0.02, 4.0, seed=3)
STUDY = {
    "rps": 1, "title": "read-only", "base": str(Path("cases/rigid_frame.yaml").resolve()),
    "vary": [{"podium.bearing.wedge_slenderness": [0.2, 0.3]}],
    "records": ["pulse:sine?amplitude=0.2g&period=1.0"],
}  # fmt: skip


@cache
def history():
    return rpscli.time_history(STRUCTURE, RECORD)


def study():
    return rpscli.load_study(STUDY).run(jobs=1)


OBJECTS = {
    "Bearing": lambda: STRUCTURE.bearing,
    "Case": lambda: rpscli.load_case("cases/six_storey.yaml"),
    "Demand": lambda: rpscli.demand(STRUCTURE, RECORD),
    "GroundMotion": lambda: RECORD,
    "MotionComponents": lambda: rpscli.MotionComponents(RECORD, y=RECORD),
    "ImpactLaw": lambda: STRUCTURE.impact_law,
    "ModalDamping": lambda: rpscli.ModalDamping(0.05),
    "ModalResult": lambda: rpscli.modal(STRUCTURE),
    "PodiumStructure": lambda: STRUCTURE,
    "PushoverResult": lambda: rpscli.pushover(STRUCTURE),
    "RayleighDamping": lambda: rpscli.RayleighDamping(0.05),
    "RpsError": lambda: rpscli.RpsError("text"),
    "Study": lambda: rpscli.load_study(STUDY),
    "StudyResult": study,
    "Superstructure": lambda: STRUCTURE.superstructure,
    "Twist": lambda: rpscli.Twist(factors=(1.0, 1.02)),
    "TimeHistoryResult": history,
    "TimeHistorySettings": lambda: history().settings,
    "fixed_base_floor_spectra": lambda: rpscli.fixed_base_floor_spectra(history()),
    "isolated_floor_spectra": lambda: rpscli.isolated_floor_spectra(history()),
    "response_spectrum": lambda: rpscli.response_spectrum(RECORD, [0.5, 1.0]),
}
"""Every class that is offered, and what functions without a class of theirs give."""

OTHER = {
    "demand", "figures", "load_case", "load_components", "load_record", "load_study", "modal",
    "plugins", "pushover", "time_history", "twist_history", "profile_stiffnesses", "table",
    "__version__",
}  # fmt: skip
"""They give objects of the classes above, texts, or an array that nobody else knows."""


def parts(value, name, seen):
    """All arrays inside, by the way to them: fields, properties, what is cached."""
    if isinstance(value, np.ndarray | np.void):
        yield name, value
        return
    if id(value) in seen or isinstance(value, str | bytes | Path | type):
        return
    seen[id(value)] = value
    if isinstance(value, dict | list | tuple):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from parts(part, f"{name}[{key!r}]", seen)
    if (
        not type(value).__module__.startswith("rpscli.")
        or "schema" in type(value).__module__
    ):
        return
    for attribute, member in inspect.getmembers_static(type(value)):
        if isinstance(member, property | cached_property) and not attribute.startswith(
            "_"
        ):
            yield from parts(getattr(value, attribute), f"{name}.{attribute}", seen)
    for attribute, part in list(getattr(value, "__dict__", {}).items()):
        if not attribute.startswith("_"):
            yield from parts(part, f"{name}.{attribute}", seen)


def pickled(value):
    return pickle.loads(pickle.dumps(value))  # noqa: S301


def writable(value):
    return {name for name, array in parts(value, "", {}) if array.flags.writeable}


def test_nothing_that_is_offered_is_forgotten():
    assert set(rpscli.__all__) == OBJECTS.keys() | OTHER


@pytest.mark.parametrize("name", OBJECTS)
def test_arrays_are_read_only_in_copies_too(name):
    made = OBJECTS[name]()
    assert not writable(made)
    if name not in {
        "Case",
        "Study",
        "StudyResult",
    }:  # copies of these hold more than results
        for again in (copy.copy(made), copy.deepcopy(made), pickled(made)):
            assert not writable(again)


def test_periods_of_the_user_stay_the_users():
    periods = np.array([0.5, 1.0])
    rpscli.isolated_floor_spectra(history(), periods)
    periods *= 2.0
    assert periods.tolist() == [1.0, 2.0]


def test_masked_samples_are_refused():
    gap = np.ma.array([0.0, 999.0, 1.0], mask=[False, True, False])
    with pytest.raises(RecordError, match=r"sample 2 is masked, a gap; fill it"):
        rpscli.GroundMotion(gap, 0.1)
    whole = np.ma.array([0.0, 2.0], mask=False)
    assert rpscli.GroundMotion(whole, 0.1).pga == 2.0
