"""What a statistic keeps apart, and what it pools: intensities, systems, samples, members."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpscli.sweep.design.layout import Design

INTENSITY = "scale"
"""How the groups of a table call the axis of factors and intensities."""


def apart(design: Design, keys: Sequence[str]) -> tuple[str, ...]:
    """The keys, and the intensity with them if the study has several.

    Parameters
    ----------
    keys
        Of groups that a report makes when the study does not say otherwise.
    """
    several = len(design.scales) > 1 and INTENSITY not in keys
    return (*keys, INTENSITY) if several else tuple(keys)


def pooled(design: Design, keys: Sequence[str]) -> tuple[str, ...]:
    """In words, what differs within groups of these keys besides the record.

    Parameters
    ----------
    keys
        Varied keys, ``record`` or ``scale``, by which points are grouped.
    """
    return tuple(_pooled(design, set(keys)))


def _pooled(design: Design, keys: set[str]) -> Iterator[str]:
    for axis in design.study.axes:
        if len(axis.rows) > 1 and not keys & set(axis.keys):
            yield f"{len(axis.rows)} values of {axis.keys[0]}"
    if (samples := design.combinations.shape[-1]) > 1:
        yield f"{samples} samples"
    if len(design.scales) > 1 and INTENSITY not in keys:
        yield f"{len(design.scales)} intensities"
    if len(design.members) > 1:
        yield f"{len(design.members)} members"


def pooling_note(design: Design, keys: Sequence[str]) -> list[str]:
    """The warning that belongs to what is pooled; empty if nothing is."""
    found = pooled(design, keys)
    if not found:
        return []
    text = f"pools {' and '.join(found)}, which differ"
    return [f"{text}: histories of one record are not independent, so intervals are too narrow"]


def shown_keys(design: Design, keys: Sequence[str]) -> tuple[str, ...]:
    """The keys as tables and figures call them: an intensity by its measure."""
    measure = design.plan.measure
    name = INTENSITY if measure is None else measure.measure
    return tuple(name if key == INTENSITY else key for key in keys)
