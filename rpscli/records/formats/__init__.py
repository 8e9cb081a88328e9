"""The record formats that can be read: told apart by content first, by extension second."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import PluginError, RecordError
from rpscli.records.formats.at2 import read_at2, recognises_at2
from rpscli.records.formats.columns import read_columns, recognises_columns
from rpscli.records.formats.cosmos import (
    read_cosmos,
    read_csmip,
    recognises_cosmos,
    recognises_csmip,
)
from rpscli.records.formats.esm import read_esm, recognises_esm
from rpscli.records.formats.geonet import read_geonet, recognises_geonet
from rpscli.records.formats.knet import read_knet, recognises_knet
from rpscli.records.formats.record_text import RecordText, read_text
from rpscli.records.formats.smc import read_smc, recognises_smc
from rpscli.records.ground_motion import GroundMotion
from rpscli.registry import Registry


@dataclass(frozen=True)
class RecordFormat:
    """A file format: what it is called, how it is recognised, how it is read."""

    name: str
    extensions: tuple[str, ...]
    recognises: Callable[[RecordText], bool]
    read: Callable[[RecordText], GroundMotion]


_OURS = (
    RecordFormat("PEER AT2", (".at2",), recognises_at2, read_at2),
    RecordFormat("COSMOS v1", (".v1", ".v1c", ".v2c"), recognises_cosmos, read_cosmos),
    RecordFormat("CSMIP volume 2", (".v2",), recognises_csmip, read_csmip),
    RecordFormat("GeoNet volume 2", (".v2a",), recognises_geonet, read_geonet),
    RecordFormat(
        "K-NET ASCII",
        (".ns", ".ew", ".ud", ".ns1", ".ew1", ".ud1", ".ns2", ".ew2", ".ud2"),
        recognises_knet,
        read_knet,
    ),
    RecordFormat("ESM ASCII", (".asc",), recognises_esm, read_esm),
    RecordFormat("SMC", (".smc",), recognises_smc, read_smc),
)
_PLAIN = RecordFormat("columns", (".txt", ".dat", ".csv", ".tsv"), recognises_columns, read_columns)
"""Accepts most, so it comes last."""

FORMATS = Registry("formats", {form.name: form for form in (*_OURS, _PLAIN)}, RecordFormat)
"""In the order of recognition."""

_OTHER_QUANTITIES = {".vt2": "velocity", ".dt2": "displacement"}
_STRONGEST, _WEAKEST = 4.0, 1e-3  # g
_NONSENSE = 1e9  # g; raw counts taken for g have a hundredth, and squares stay finite
_FINEST, _COARSEST = 1e-4, 0.1  # s
_OFFSET, _MANY = 0.1, 100  # of the peak, samples


def read_record(
    path: Path,
    source: str,
    *,
    dt: float | None = None,
    units: str | None = None,
    channel: str | None = None,
) -> GroundMotion:
    """Read one record file of any known format."""
    if quantity := _OTHER_QUANTITIES.get(path.suffix.lower()):
        raise RecordError(
            f"{path}: {path.suffix} files hold {quantity}; give the acceleration record of the "
            f"same station, {path.with_suffix('.AT2').name}"
        )
    text = read_text(path, source, dt=dt, units=units, channel=channel)
    form = _by_content(text)
    try:
        motion = (form or _by_extension(text)).read(text)
    except RecordError as error:
        unusable = [] if form in _OURS else [o.fault for o in FORMATS.offers() if o.fault]
        raise RecordError("\n".join([str(error), *unusable])) from error
    if motion.pga > _NONSENSE * STANDARD_GRAVITY:
        raise text.fault(
            f"the largest value is {motion.pga / STANDARD_GRAVITY:.3g} g, which is not a"
            " ground acceleration; the file is damaged, fetch it again"
        )
    return replace(motion, warnings=(*motion.warnings, *_implausible(motion)))


_VERTICAL = re.compile(
    r"^(?:Dir\.\s+(?:U-?D|[36])|STREAM:\s*\w*Z|(?:[^,]*,){3}\s*(?:UP|DOWN|DWN|VERT?\w*|UD|V|Z))\s*$"
    r"|\bChan\s*\d+:\s*(?:Up|Down|Vert)",
    re.IGNORECASE | re.MULTILINE,
)
"""How headers of K-NET and KiK-net, ESM, AT2, COSMOS and CSMIP state a vertical component."""

_HEADER = 60  # lines


def is_record(path: Path) -> bool:
    """Whether a file's content is recognised as a record; what else lies in a folder is not."""
    return kind_of(path) != ""


def kind_of(path: Path) -> Literal["", "record", "vertical"]:
    """What a file is by its content: nothing known, a record, or one that states to be vertical."""
    if path.suffix.lower() in _OTHER_QUANTITIES:
        return ""
    try:
        text = read_text(path, str(path))
        form = _by_content(text)
    except RecordError:
        return ""
    if form is None:
        return ""
    stated = form is not _PLAIN and _VERTICAL.search("\n".join(text.heads[:_HEADER]))
    return "vertical" if stated else "record"


def _in_order() -> Iterator[RecordFormat]:
    yield from _OURS
    yield from (form for _, form in FORMATS.theirs())
    yield _PLAIN


def _by_content(text: RecordText) -> RecordFormat | None:
    for form in _in_order():
        with suppress(PluginError):  # a fault of one format is none of other files
            if form.recognises(text):
                return form
    return None


def _by_extension(text: RecordText) -> RecordFormat:
    # The format of that name then says what is missing.
    extension = text.path.suffix.lower()
    return next((form for form in _in_order() if extension in form.extensions), _PLAIN)


def _implausible(motion: GroundMotion) -> tuple[str, ...]:
    peak, mean = motion.pga / STANDARD_GRAVITY, abs(float(motion.acceleration.mean()))
    doubts = {
        f"the mean is {mean / max(motion.pga, 1e-300):.2g} of the peak: an offset of the"
        " instrument? Correct the record": motion.npts >= _MANY and mean > _OFFSET * motion.pga,
        f"dt = {motion.dt:g} s is unusual for an accelerograph ({_FINEST:g} s to"
        f" {_COARSEST:g} s): check the time step": not _FINEST <= motion.dt <= _COARSEST,
        f"PGA = {peak:.3g} g is beyond any recorded earthquake: check the units": peak > _STRONGEST,
        f"PGA = {peak:.3g} g is weaker than can be felt: check the units": peak < _WEAKEST,
    }
    return tuple(doubt for doubt, doubtful in doubts.items() if doubtful)
