"""Rocking podium structures: multi-storey buildings on kinematic bearings.

The names below are imported when they are first used:

>>> import rpscli
>>> bearing = rpscli.Bearing(
...     semi_diagonal=1.5, slenderness=0.15, wedge_slenderness=0.30, curvature_ratio=0.5
... )
>>> round(bearing.critical_rotation, 4)
0.2946
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rpscli import figures, plugins
    from rpscli.analyses.demand import demand
    from rpscli.analyses.demands_table import table
    from rpscli.analyses.floor_spectra import (
        fixed_base_floor_spectra,
        isolated_floor_spectra,
    )
    from rpscli.analyses.largest_demands import Demand
    from rpscli.analyses.modal import ModalResult, modal
    from rpscli.analyses.pushover import PushoverResult, pushover
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.analyses.settings import TimeHistorySettings
    from rpscli.analyses.timehistory import time_history
    from rpscli.analyses.twist import twist_history
    from rpscli.case.case import Case, load_case
    from rpscli.errors import RpsError
    from rpscli.model.bearing import Bearing
    from rpscli.model.impact import ImpactLaw
    from rpscli.model.podium import PodiumStructure
    from rpscli.model.superstructure import (
        ModalDamping,
        RayleighDamping,
        Superstructure,
        profile_stiffnesses,
    )
    from rpscli.model.twist import Twist
    from rpscli.records.ground_motion import GroundMotion, MotionComponents
    from rpscli.records.loading import load_components, load_record
    from rpscli.records.measures import response_spectrum
    from rpscli.studies import Study, StudyResult, load_study

    __version__: str

_HOMES = {
    "analyses.demand": "demand",
    "analyses.demands_table": "table",
    "analyses.floor_spectra": "fixed_base_floor_spectra isolated_floor_spectra",
    "analyses.largest_demands": "Demand",
    "analyses.modal": "ModalResult modal",
    "analyses.pushover": "PushoverResult pushover",
    "analyses.results": "TimeHistoryResult",
    "analyses.settings": "TimeHistorySettings",
    "analyses.timehistory": "time_history",
    "analyses.twist": "twist_history",
    "case.case": "Case load_case",
    "errors": "RpsError",
    "model.bearing": "Bearing",
    "model.impact": "ImpactLaw",
    "model.podium": "PodiumStructure",
    "model.twist": "Twist",
    "model.superstructure": "ModalDamping RayleighDamping Superstructure profile_stiffnesses",
    "records.ground_motion": "GroundMotion MotionComponents",
    "records.measures": "response_spectrum",
    "records.loading": "load_components load_record",
    "studies": "Study StudyResult load_study",
}

__all__ = [
    "Bearing",
    "Case",
    "Demand",
    "GroundMotion",
    "ImpactLaw",
    "ModalDamping",
    "ModalResult",
    "MotionComponents",
    "PodiumStructure",
    "PushoverResult",
    "RayleighDamping",
    "RpsError",
    "Study",
    "StudyResult",
    "Superstructure",
    "TimeHistoryResult",
    "TimeHistorySettings",
    "Twist",
    "__version__",
    "demand",
    "figures",
    "fixed_base_floor_spectra",
    "isolated_floor_spectra",
    "load_case",
    "load_components",
    "load_record",
    "load_study",
    "modal",
    "plugins",
    "profile_stiffnesses",
    "pushover",
    "response_spectrum",
    "table",
    "time_history",
    "twist_history",
]


def __getattr__(name: str) -> Any:
    """Import a public name now that it is wanted."""
    from importlib import import_module  # not every import of rpscli needs it

    if name == "__version__":
        return import_module("rpscli.version").VERSION
    if name in {"figures", "plugins"}:
        return import_module(f"rpscli.{name}")
    for module, names in _HOMES.items():
        if name in names.split():
            return getattr(import_module(f"rpscli.{module}"), name)
    raise AttributeError(f"module 'rpscli' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
