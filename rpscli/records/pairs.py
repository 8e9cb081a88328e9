"""Two components of one recording, held against each other."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import PurePath

from rpscli.errors import RecordError
from rpscli.records.directions import direction_in, directions_of
from rpscli.records.families import direction_by_name, forms_of, of_one_name
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.recordings import earthquake
from rpscli.records.source import FILE, Source
from rpscli.records.when import seconds_of

_LATE = 10.0  # seconds between the starts of components of one recording at most


def beside_each_other(
    first: GroundMotion, second: GroundMotion, source: str
) -> GroundMotion:
    """The second component, unless both state to be of different
    recordings, or the same one.
    """
    one = first.recording
    other = second.recording
    apart = _apart(one.start, other.start)
    begun = seconds_of(one.origin), seconds_of(other.origin)
    for name, differ in (
        ("station", one.station != other.station),
        ("event", earthquake(one.event) != earthquake(other.event)),
        ("origin", _differ(begun) if None not in begun else one.origin != other.origin),
        ("start", apart > _LATE),
    ):
        told = getattr(one, name), getattr(other, name)
        if all(told) and differ:
            raise RecordError(
                f"{source}: both components are of one recording, and their headers state"
                f" the {name} {told[0]!r} and {told[1]!r}; name two of one"
            )
    alike = (
        one.direction
        and one.direction == other.direction
        and one.station == other.station
    )
    made = first.format in ("pulse", "synthetic")
    if (first.digest == second.digest and not made) or alike:
        raise RecordError(
            f"{source}: both components are the same one,"
            f" {one.direction or first.source}; name two of one recording"
        )
    doubts: list[str] = []
    by_name = _words_of_directions(first, second)
    for words in dict.fromkeys([(one.direction, other.direction), by_name]):
        _require_horizontal(words, source)
        doubts += _angle_doubts(*words, source)
    doubts += _name_doubts(first, second)
    if apart > 0.5 * first.dt:
        doubts.append(
            f"its header states the start {other.start}, that of the other component"
            f" {one.start}: line them up"
        )
    return replace(second, warnings=(*second.warnings, *doubts))


def _words_of_directions(first: GroundMotion, second: GroundMotion) -> tuple[str, str]:
    """The words of two names of files that tell directions; empty without such."""
    places = [of.place for of in (first.source, second.source) if isinstance(of, Source)]
    if len(places) < 2 or places[0] == places[1]:
        return "", ""
    one, other = (PurePath(place).name for place in places)
    forms = forms_of(one), forms_of(other)
    for key in forms[0].keys() & forms[1].keys():
        words = forms[0][key], forms[1][key]
        if all(map(str.isalpha, words)) and None not in directions_of(words):
            return words
    return direction_by_name(one), direction_by_name(other)


def _require_horizontal(words: tuple[str, str], source: str) -> None:
    """Refuse a vertical component in a pair of horizontal ones."""
    for word, way in zip(words, directions_of(words), strict=True):
        found = way or direction_in(word)
        if found is not None and found.vertical:
            raise RecordError(
                f"{source}: {word} is a vertical component; name two horizontal ones, and"
                " that as `vertical`"
            )


def _name_doubts(first: GroundMotion, second: GroundMotion) -> Iterator[str]:
    """A doubt about names that differ in more than a direction, where no header tells."""
    told = first.recording, second.recording
    if all(each.station or each.event for each in told):
        return
    places = [of.place for of in (first.source, second.source) if isinstance(of, Source)]
    schemes = {
        of.scheme for of in (first.source, second.source) if isinstance(of, Source)
    }
    names = [PurePath(place).name for place in places]
    if len(names) < 2 or schemes != {FILE} or of_one_name(*names):
        return
    if all(map(direction_by_name, names)):
        yield (
            f"{names[0]} and {names[1]} differ in more than a direction: see that both"
            f" are"
            " components of one recording"
        )


def _differ(origins: tuple[float | None, float | None]) -> bool:
    """True if two origins are more than a minute apart."""
    one, other = origins
    return one is not None and other is not None and abs(one - other) > 60.0


LEAST_ANGLE = 30.0
USUAL_ANGLE = 60.0
"""Between components that are taken for a pair at right angles [deg]."""


def _angle_doubts(one: str, other: str, source: str) -> Iterator[str]:
    """A doubt about the angle between two directions; refuse those along one line."""
    first, second = directions_of((one, other))
    ways = first or direction_in(one), second or direction_in(other)
    known = [way.azimuth for way in ways if way is not None and way.azimuth is not None]
    if len(known) < 2:
        return
    turned = abs(known[0] - known[1]) % 180.0
    angle = min(turned, 180.0 - turned)
    if angle < LEAST_ANGLE:
        raise RecordError(
            f"{source}: components along {one} and {other} are {angle:g} degrees"
            f" apart, and"
            " a pair is taken for right angles; name two of different directions"
        )
    if angle < USUAL_ANGLE:
        yield f"{one} and {other} are {angle:g} degrees apart, and taken for right angles"


def _apart(one: str, other: str) -> float:
    """Seconds between two times in the same format; none where one is not stated."""

    def seconds(text: str) -> list[float]:
        numbers = [float(number) for number in re.findall(r"\d+(?:\.\d+)?|\.\d+", text)]
        if len(numbers) < 4:  # not apart: date, hour, minute, second
            return numbers
        return [*numbers[:-3], 3600.0 * numbers[-3] + 60.0 * numbers[-2] + numbers[-1]]

    first = seconds(one)
    second = seconds(other)
    if not (first and second):
        return 0.0
    return abs(first[-1] - second[-1]) if first[:-1] == second[:-1] else float("inf")
