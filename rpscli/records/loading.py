"""From sources to ground motions: files, folders, lists, sets,
pulses, synthetic motions.

>>> pulse = load_record("pulse:sine?amplitude=0.4g&period=0.8")
>>> round(pulse.pga, 3), pulse.npts
(3.923, 2001)
>>> x = "pulse:sine?amplitude=0.4g&period=0.8"
>>> both = load_components(x, y="synthetic:?pga=0.2g&seed=1&dt=0.0004")
>>> round(both.y.pga, 3)
1.961
"""

from __future__ import annotations

import glob
import re
import stat
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path, PurePath
from typing import Any

from rpscli.errors import (
    RecordError,
    beginning,
    nearest,
    refused_by_system,
    require_kind,
    require_visible,
)
from rpscli.machine import mode_of
from rpscli.records import made, sets
from rpscli.records.families import (
    direction_by_name,
    require_horizontal_titles,
    require_two,
)
from rpscli.records.ground_motion import (
    GroundMotion,
    MotionComponents,
    rotated,
    scale_doubts,
)
from rpscli.records.pairs import beside_each_other
from rpscli.records.recordings import (
    channels,
    pairs_among,
    stated,
    vertical_of,
    verticals,
)
from rpscli.records.repeats import likenesses_among, repeats_among
from rpscli.records.source import (
    FILE,
    LIKENESS,
    LIST,
    PAIRING,
    SET,
    Source,
    is_file,
    split_options,
)
from rpscli.records.words import stands_in_a_structure

_MAKERS: dict[str, Callable[[Source], GroundMotion]] = {
    SET: sets.load_component,
    "pulse": made.load_pulse,
    "synthetic": made.load_synthetic,
}
_REMARK = re.compile(r"(?:^|\s)#")

_readable = partial(
    refused_by_system,
    fault=RecordError,
    verb="read",
    remedy="check the name and the permissions",
)

OWN = (
    "own"  # in place of a vertical source: the vertical component of the recording itself
)


def load_record(
    source: str,
    *,
    folder: Path | None = None,
    dt: float | None = None,
    units: str | None = None,
) -> GroundMotion:
    """Load one ground motion.

    Parameters
    ----------
    source : str
        A file, with options if it needs them (`rec.txt?dt=0.005&units=g`,
        `rec.V2?channel=1`), or `fema_p695:farfield/1/b`, `pulse:sine?...`,
        `synthetic:?...`. Two components at an angle from the first towards the second
        [deg]: `x.at2?second=y.at2&angle=30`, `fema_p695:farfield/1?angle=30`.
        `factor=1.5` multiplies any of them. Both components together,
        `fema_p695:farfield/1?both`, are read by `load_components`.
    folder : Path, optional
        Where relative paths start (the folder of the case file);
        else the working directory.
    dt : float, optional [s]
        Sampling interval of a file that does not state it.
    units : str, optional
        Units of the values of a file that does not state them: "g", "m/s2", "cm/s2", ...

    Raises
    ------
    RecordError
        If there is no such record, or it cannot be read without guessing.
    """
    require_kind(source, str, "the record", "give its name as text")
    of = single_source(source, folder)
    read = _described(of, dt=None if dt is None else float(dt), units=units)
    factor = of.factor
    if of.both:
        raise RecordError(
            f"{source}: holds two components, and one is wanted here; name one of them,"
            " or a direction between them by angle=30 in place of both"
        )
    with _readable(source):
        motion = replace(_unscaled(read.without("factor"), folder), source=of)
    return _multiplied(motion, factor) if "factor" in of.values else motion


def _multiplied(motion: GroundMotion, factor: float) -> GroundMotion:
    """A motion times the factor of its source, named so, with doubts about it."""
    # Results of different factors go to different folders.
    name = f"{motion.name}_x{factor:.4g}"
    warnings = scale_doubts(motion.name, factor)
    return replace(
        motion.scaled(factor), name=name, warnings=(*motion.warnings, *warnings)
    )


def _described(of: Source, **given: object) -> Source:
    """The source of a file with the step and the unit that are given beside it."""
    texts = {name: f"{value}" for name, value in given.items() if value is not None}
    if of.scheme and texts:
        raise RecordError(f"{of}: dt and units describe files; leave them out here")
    for name, text in texts.items():
        if (own := of.values.get(name, text)) != text:
            raise RecordError(
                f"{of}: {name} = {text} contradicts the {own} in it; keep one"
            )
    return of.plus(**texts)


def _unscaled(of: Source, folder: Path | None) -> GroundMotion:
    if of.scheme == LIST:
        raise RecordError(
            f"{of}: stands for several records; name one of its lines, or give the list"
            " by --record"
        )
    if (angle := of.angle) is None:
        if "second" in of.values:
            raise RecordError(
                f"{of}: two components need both options: second=FILE, seen from the"
                " folder of the first one, and angle=30, in degrees, or both"
            )
        return _MAKERS[of.scheme](of) if of.scheme else _read(of, folder)
    motion = rotated(*_components(of, folder), angle)
    return replace(motion, name=_named(motion, of, f"{angle:g}deg"))


def _named(motion: GroundMotion, of: Source, way: str) -> str:
    """The name of a pair: that of its first component, with the
    way in place of the side.
    """
    in_set = of.scheme == SET and of.of_pair
    return motion.name.replace("_a", f"_{way}", 1) if in_set else f"{motion.name}_{way}"


def _components(of: Source, folder: Path | None) -> tuple[GroundMotion, GroundMotion]:
    """Both components of a pair, held against each other."""
    if of.scheme == SET and of.place not in sets.PAIRS:
        raise sets.unknown(of)  # before a component is refused that nobody wrote
    one, other = (load_record(each, folder=folder) for each in of.components or ())
    return one, beside_each_other(one, other, of)


def _read(of: Source, folder: Path | None) -> GroundMotion:
    from rpscli.records.formats import read_record  # sets and pulses are not files

    path = _located(of.place, folder)
    _require_file(path, of)
    motion = read_record(path, of)
    recording = motion.recording
    if recording.direction or "channel" in of.values:
        return motion
    named = recording._replace(direction=direction_by_name(path.name))
    return replace(motion, recording=named)


def load_components(
    source: str,
    vertical: str | None = None,
    y: str | None = None,
    rotation: float = 0.0,
    **how: Any,
) -> MotionComponents:
    """The components of a motion, read alike: those of a pair if the
    source, or `y`, says so.

    Parameters
    ----------
    source : str
        As that of `load_record`, or both components: `fema_p695:farfield/1?both`,
        `x.at2?second=y.at2&both`.
    vertical, y : str, optional
        Sources of the vertical and of the second horizontal component; the
        vertical one may be `own`: that which lies beside the file, by its name
        or its header, or in it.
    rotation : float [deg]
        Of a pair from x towards y, in addition to what its source says.
    how
        `folder`, `dt` and `units` of `load_record`.

    Raises
    ------
    RecordError
        As `load_record`, and if the time steps of the components differ.
    """
    folder = how.get("folder")
    of = single_source(source, folder)
    if vertical == OWN and not is_file(OWN, folder):
        vertical = vertical_of(of, folder)
    above = None if vertical is None else load_record(vertical, **how)
    if not of.both:
        along = load_record(of, **how)
        if y is None:
            return MotionComponents(along, above)
        across = beside_each_other(along, load_record(y, **how), source)
    else:
        given = {name: value for name, value in how.items() if name != "folder"}
        along, across = _components(_described(of, **given), folder)
    along = replace(along, name=_named(along, of, "both"), source=source)
    return MotionComponents(along, above, y=across).turned(of.rotation + rotation)


def expanded(
    sources: Sequence[str], *, folder: Path | None = None
) -> tuple[list[str], list[str]]:
    """The single sources of a list that may hold folders, globs, lists
    and sets, and notes on it.

    What a source stands for keeps its place in the list, sorted by name, and nothing
    comes twice. Of a folder only files that are recognised as records count, each of
    their channels, not velocities or displacements, and of the components of a
    recording not the vertical one.
    """
    notes = repeated(sources)
    found = [single for source in sources for single in _expand(source, folder, notes)]
    return [*dict.fromkeys(found)], [*dict.fromkeys(notes)]


def single_source(text: str, folder: Path | None = None) -> Source:
    """The record that a text names: of a file, folder or list the
    one pair that is asked for.
    """
    of = Source.parse(text, folder)
    if not of.of_pair or of.components is not None:
        return of
    first, *others = expand_sources([of], folder=folder)
    if others:
        raise RecordError(f"{of}: is {len(others) + 1} pairs; name one: {first}, ...")
    return Source.parse(first, folder)


def expand_sources(sources: Sequence[str], *, folder: Path | None = None) -> list[str]:
    """The sources of `expanded`."""
    return expanded(sources, folder=folder)[0]


def repeated(sources: Sequence[str]) -> list[str]:
    """A note on sources that are given more than once, if there are any."""
    again = [source for source, count in Counter(sources).items() if count > 1]
    others = f" and {len(again) - 1} more" if len(again) > 1 else ""
    return [f"{first}{others}: given more than once, taken once" for first in again[:1]]


def _expand(text: str, folder: Path | None, notes: list[str]) -> list[Source]:
    of = Source.parse(text, folder)
    with _readable(text):
        if of.scheme == LIST:
            if "factor" in of.values:
                raise RecordError(f"{text}: each line of a list has a factor of its own")
            of.query()
            return _paired(of, _listed(of, folder, notes), folder)
        if of.scheme == SET:
            return sets.expand_set(of)
        if of.scheme:
            of.require_two()
            return [of]
        return _files(of, folder, notes)


def _files(of: Source, folder: Path | None, notes: list[str]) -> list[Source]:
    """Records of a folder or a glob, or the file itself."""
    files = _named_files(of, folder)
    if files is None:
        of.require_two()
        return [of]
    names = _readable_names(of, files, notes)
    single = [each for name in names for each in channels(of.at(name), folder)]
    single = _above_ground(of, single, folder, notes)
    require_horizontal_titles(single, folder)
    if upright := verticals(single, folder):
        left_out = [
            each.place if "channel" in of.values or "channel" not in each.values
            else f"{each.place} channel {each.values['channel']}"
            for each in upright
        ]  # fmt: skip
        notes.append(f"{of}: vertical components left out: {_some(left_out)}")
        single = [each for each in single if each not in upright]
    single = _once(of, single, folder, notes)
    return (
        single if of.components else _paired(of, [each.alone for each in single], folder)
    )


def _once(
    of: Source, single: list[Source], folder: Path | None, notes: list[str]
) -> list[Source]:
    """Sources without those that are another one by a further name, with notes on
    these.
    """
    motions = {}
    for each in single:
        with suppress(RecordError):  # told where it is read
            motions[each] = load_record(each.alone, folder=folder)
    repeats = repeats_among(motions, folder)
    for is_one, told in (
        (True, "the same component again, left out"),
        (False, "the same samples by other names, all taken"),
    ):
        names = [
            f"{PurePath(each.place).name} (as {PurePath(first.place).name})"
            for each, (first, one) in repeats.items()
            if one is is_one
        ]
        if names:
            notes.append(f"{of}: {told}: {_some(names)}")
    alike = [
        f"{PurePath(each.place).name} (of {PurePath(other.place).name})"
        for each, other in likenesses_among(motions)
        if each not in repeats and other not in repeats
    ]
    if alike:
        notes.append(
            f"{of}: the same samples times a factor, cut, or with samples left out, all"
            f" taken: {_some(alike)}"
        )
    again = {each for each, (_, one) in repeats.items() if one}
    kept = [each for each in single if each not in again]
    require_two({each: motions[each] for each in kept if each in motions}, folder)
    return kept


_BELOW_BY_NAME = re.compile(
    r"bore-?hole|down-?hole|in-?hole|(?<![A-Za-z])(?:GL-?[1-9]|bottom|DH\d*|BH\d*|bedrock"
    r"|pozz?o|forage|bohrloch|sondaj|kuyu|skv|well|subsurface|depth\d+m?)(?![A-Za-z])"
    r"|(?<=[_ .-])-?\d+m(?![A-Za-z])|скважин|地中|井下",
    re.IGNORECASE,
)
"""Words in names of files of instruments below the ground."""


def _above_ground(
    of: Source, single: list[Source], folder: Path | None, notes: list[str]
) -> list[Source]:
    """Sources without those in boreholes, with a note on these; all if there are no
    others.
    """
    below = [
        each
        for each in single
        if _BELOW_BY_NAME.search(PurePath(each.place).stem)
        or stands_in_a_structure(PurePath(each.place).stem)
        or stated(each, folder).in_borehole
    ]
    if not below or len(below) == len(single):
        return single
    notes.append(
        f"{of}: in buildings or in boreholes, left out: {_some([b.place for b in below])}"
    )
    return [each for each in single if each not in below]


def _named_files(of: Source, folder: Path | None) -> dict[str, Path] | None:
    """Files of a folder or a glob by their names in sources, or one with several
    channels; None if the source is a single record.
    """
    from rpscli.records.formats import contents

    place = of.place
    path = _located(of.place, folder)
    if path.is_dir():
        names = sorted(entry.name for entry in path.iterdir() if entry.is_file())
        return {f"{Path(place) / name}": path / name for name in names}
    if glob.has_magic(place) and not path.exists():
        start = folder or Path()
        pattern = str(Path(place).expanduser())
        # Path.glob refuses absolute patterns.
        matches = sorted(glob.glob(pattern, root_dir=start, recursive=True))  # noqa: PTH207
        # no pipe, no device
        return {match: start / match for match in matches if (start / match).is_file()}
    _require_file(path, of)
    single = of.components or "channel" in of.values or len(contents(path)) < 2
    return None if single else {place: path}


def _readable_names(of: Source, files: dict[str, Path], notes: list[str]) -> list[str]:
    """Names of the files that are records, and notes on those that cannot be read."""
    from rpscli.records.formats import contents

    held = {name: inside for name, file in files.items() if (inside := contents(file))}
    refused = {
        name: inside[0].refusal for name, inside in held.items() if inside[0].refusal
    }
    why = [
        f"left out: {_some([name for name in refused if refused[name] == text])}: {text}"
        for text in dict.fromkeys(refused.values())
    ]
    names = [name for name in held if name not in refused]
    if not names:
        raise RecordError(
            "; ".join([f"{of}: no record file there that can be read", *why[:1]])
        )
    notes += [f"{of}: {text}" for text in why]
    return names


def _some(names: Sequence[str]) -> str:
    """The first of some files, without their folders."""
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return f"{', '.join(PurePath(name).name for name in names[:3])}{more}"


def _paired(of: Source, single: Iterable[Source], folder: Path | None) -> list[Source]:
    """Sources of single components, or pairs of them if a source asks for two."""
    asked = {name: value for name, value in of.values.items() if name in PAIRING}
    return pairs_among(single, of, asked, folder) if asked else list(single)


def _listed(of: Source, folder: Path | None, notes: list[str]) -> Iterator[Source]:
    """Sources of a list, one a line, files as seen from it; # after
    a blank begins a remark.
    """
    path = _located(of.place, folder)
    _require_file(path, of)
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise RecordError(
            f"{of}: is not text; name a list with one source a line"
        ) from None
    sources = [(n, source) for n, line in enumerate(lines, 1)
               if (source := _without_remark(line, path.parent))]  # fmt: skip
    if not sources:
        raise RecordError(f"{of}: holds no sources; write one a line")
    for number, line in sources:
        scheme = FILE
        try:
            scheme = Source.parse(line, path.parent).scheme
            seen = line if scheme else str(Path(of.place).parent / line)
            found = [] if scheme == LIST else _expand(seen, folder, notes)
        except RecordError:
            if scheme:
                raise
            raise RecordError(
                f"{of}:{number}: {beginning(line)} is neither there nor another source;"
                " name files as seen from the folder of the list"
            ) from None
        if scheme == LIST:
            raise RecordError(
                f"{of}: {line}: a list holds no lists; write its sources here"
            )
        yield from found


def _without_remark(line: str, folder: Path) -> str:
    """The source in a line; the name of a file that is there may
    hold the mark of a remark.
    """
    place = split_options(line.strip())[0]
    named = len(place) if is_file(place, folder) else 0
    return line.strip()[:named] + _REMARK.split(line.strip()[named:])[0].strip()


def _located(place: str, folder: Path | None) -> Path:
    try:
        path = Path(place).expanduser()
    except RuntimeError:
        raise RecordError(
            f"{place}: there is no such user; write the folder out"
        ) from None
    if "\0" in place:
        raise RecordError(f"{place[:200]!r}: no path holds a zero byte; correct the name")
    require_visible(place, RecordError)
    return (folder or Path()) / path


def _require_file(path: Path, source: str) -> None:
    if stat.S_ISREG(found := mode_of(path)):
        return
    if found:
        what = (
            "a folder; name one of its files"
            if stat.S_ISDIR(found)
            else "not a regular file"
        )
        raise RecordError(f"{path}: {what}")
    if not path.parent.is_dir():
        raise RecordError(f"{source}: there is no folder {path.parent}")
    entries = (
        entry for entry in path.parent.iterdir() if entry.suffix not in {".yaml", ".yml"}
    )
    names = sorted(entry.name for entry in entries)
    close = nearest(path.name, names, LIKENESS)
    suggestion = f"; did you mean {path.parent / close}?" if close else ""
    raise RecordError(f"{source}: there is no file {path}{suggestion}")
