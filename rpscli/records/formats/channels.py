"""Choosing one channel from a file that holds several."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.records.formats.record_text import RecordText


@dataclass(frozen=True)
class Channel:
    """A channel of a file: its number, the line where it begins, what it calls itself."""

    number: int
    line: int
    label: str


def chosen_channel(text: RecordText, channels: Sequence[Channel]) -> Channel:
    """The channel whose number the user asked for, or the only one.

    Parameters
    ----------
    text : RecordText
        The file, with the number that was asked for, if any.
    channels : sequence of Channel
        All that it holds.

    Raises
    ------
    RecordError
        If there is none, several and none was chosen, or the one chosen is not there.
    """
    if not channels:
        raise text.fault(
            "no series of accelerations begins in this file; if it is of another format than its"
            " name says, give it another ending (.txt for columns of numbers)"
        )
    listing = "; ".join(f"{channel.number}: {channel.label[:60]}" for channel in channels)
    if text.channel is None:
        if len(channels) == 1:
            return channels[0]
        raise text.fault(
            f"the file holds {len(channels)} channels; say which one by "
            f"?channel={channels[0].number} after the file name ({listing})"
        )
    wanted = [channel for channel in channels if channel.number == text.channel]
    if not wanted:
        raise text.fault(f"there is no channel {text.channel}; the file has {listing}")
    if len(wanted) > 1:
        raise text.fault(f"channel {text.channel} comes {len(wanted)} times: {listing}")
    return wanted[0]


def peak_warnings(values: NDArray[np.float64], stated: float, last_digit: float) -> tuple[str, ...]:
    """A warning if the peak of the values is not the one that the header states.

    Only its size is compared, since some agencies round it and some drop its sign.

    Parameters
    ----------
    values : array, shape (n,) [any unit]
        As the file prints them.
    stated : float [the same unit]
        The peak of the header.
    last_digit : float [the same unit]
        Unit of the last digit to which the header prints it.
    """
    peak = float(np.max(np.abs(values)))
    if abs(peak - abs(stated)) <= 0.51 * last_digit + 1e-3 * abs(stated):
        return ()
    return (f"the values peak at {peak:.6g} and the header says {abs(stated):.6g}",)
