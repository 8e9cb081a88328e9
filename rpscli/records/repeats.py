"""Motions that are there twice, as a file and its conversion, or a copy by another
name.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path, PurePath

import numpy as np

from rpscli.records.directions import direction_of
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.recordings import clusters, events_among
from rpscli.records.source import Source

_ALIKE = 1e-4
"""Of the peak. Formats print four digits or more; samples of two recordings that agree to
them all along are the same ones."""


def repeats_among(
    motions: Mapping[Source, GroundMotion], folder: Path | None
) -> dict[Source, tuple[Source, bool]]:
    """Each motion that repeats another, that other, of which more is stated, and True if
    both name one component.

    Components of one recording by their names are none: what is amiss with them is told
    where they are a pair.
    """
    group = dict(zip(motions, clusters([*motions], folder), strict=True))
    by_length: dict[tuple[int, float], list[Source]] = {}
    for of in sorted(motions, key=lambda of: _silent(motions[of])):
        motion = motions[of]
        by_length.setdefault((motion.npts, round(motion.dt, 6)), []).append(of)
    found: dict[Source, tuple[Source, bool]] = {}
    for alike in by_length.values():
        kept: list[Source] = []
        for of in alike:
            same = (each for each in kept if _same_samples(motions[of], motions[each]))
            first = next(same, None)
            if first is None:
                kept.append(of)
                continue
            one = _one_component(of, first, motions)
            if one or group[of] != group[first]:
                found[of] = first, one
    return found


def _silent(motion: GroundMotion) -> int:
    """The number of facts that a motion does not state of its recording."""
    return sum(fact in ("", None) for fact in motion.recording)


def _same_samples(one: GroundMotion, other: GroundMotion) -> bool:
    """True if two motions of one length agree in all samples."""
    apart = float(np.max(np.abs(one.acceleration - other.acceleration)))
    return apart <= _ALIKE * one.pga


def _one_component(
    one: Source, other: Source, motions: Mapping[Source, GroundMotion]
) -> bool:
    """True if two sources of the same samples have one name, or state one component."""
    told = [motions[each].recording for each in (one, other)]
    dated = all(each.event or each.origin for each in told)
    if dated and len({*events_among(told, (0, 1))}) == 2:
        return False
    first, second = ((each.station, each.direction) for each in told)
    if all(first) and all(second):
        return first == second
    names = [PurePath(each.place) for each in (one, other)]
    by_ending = any(direction_of(name.suffix.strip(".0123456789")) for name in names)
    channels = [each.values.get("channel") for each in (one, other)]
    return names[0].stem == names[1].stem and channels[0] == channels[1] and not by_ending


def likenesses_among(
    motions: Mapping[Source, GroundMotion],
) -> list[tuple[Source, Source]]:
    """Motions that are another one times a factor, cut, or with samples left out."""
    found = []
    taken: list[tuple[Source, GroundMotion]] = []
    for of, motion in motions.items():
        for other, one in taken:
            if _is_alike(*sorted((motion, one), key=lambda each: each.npts)):
                found.append((of, other))
                break
        else:
            taken.append((of, motion))
    return found


def _is_alike(short: GroundMotion, long: GroundMotion) -> bool:
    """True if the shorter motion is a part of the longer one, times a factor."""
    ratio = short.dt / long.dt
    every = round(ratio)
    if every < 1 or abs(ratio - every) > 1e-6 * ratio or short.npts < _FEWEST:
        return False
    part = long.acceleration[::every][: short.npts]
    own = short.acceleration[: part.size]
    if part.size < _FEWEST or part.size < _PART * short.npts:
        return False
    place = int(np.argmax(np.abs(own)))
    if part[place] == 0.0 or own[place] == 0.0:
        return False
    factor = own[place] / part[place]
    is_same = short.npts == long.npts and every == 1 and abs(factor - 1.0) < _ALIKE
    off = float(np.max(np.abs(own - factor * part)))
    return not is_same and off <= _ALIKE * abs(own[place])


_FEWEST = 32
"""Samples that agree by more than chance."""
_PART = 0.9
