"""What a statistic keeps apart, and what it pools: intensities, systems, samples, members."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpscli.sweep.points.layout import StudyPoints

INTENSITY = "scale"
"""How the groups of a table call the axis of factors and intensities."""


def apart(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """The keys, and the intensity with them if the study has several.

    Parameters
    ----------
    keys
        Of groups that a report makes when the study does not say otherwise.
    """
    several = len(layout.scales) > 1 and INTENSITY not in keys
    return (*keys, INTENSITY) if several else tuple(keys)


def pooled(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """In words, what differs within groups of these keys besides the record.

    Parameters
    ----------
    keys
        Varied keys, ``record`` or ``scale``, by which points are grouped.
    """
    return tuple(_pooled(layout, set(keys)))


def _pooled(layout: StudyPoints, keys: set[str]) -> Iterator[str]:
    for axis in layout.study.axes:
        if len(axis.rows) > 1 and not keys & set(axis.keys):
            yield f"{len(axis.rows)} values of {axis.keys[0]}"
    if (samples := layout.combinations.shape[-1]) > 1:
        yield f"{samples} samples"
    if len(layout.scales) > 1 and INTENSITY not in keys:
        yield f"{len(layout.scales)} intensities"
    if len(layout.members) > 1:
        yield f"{len(layout.members)} members"


def pooling_note(layout: StudyPoints, keys: Sequence[str]) -> list[str]:
    """The warning that belongs to what is pooled; empty if nothing is."""
    found = pooled(layout, keys)
    if not found:
        return []
    text = f"pools {' and '.join(found)}, which differ"
    return [f"{text}: histories of one record are not independent, so intervals are too narrow"]


def shown_keys(layout: StudyPoints, keys: Sequence[str]) -> tuple[str, ...]:
    """The keys as tables and figures call them: an intensity by its measure."""
    measure = layout.plan.measure
    name = INTENSITY if measure is None else measure.measure
    return tuple(name if key == INTENSITY else key for key in keys)
