"""From what a user writes to ground motions: files, folders, sets, pulses, synthetic motions."""

from __future__ import annotations

import glob
import re
import stat
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from rpscli.errors import RecordError, beginning, nearest, require_kind, require_visible
from rpscli.machine import mode_of
from rpscli.records import pulses, sets, synthetic
from rpscli.records.families import two_by_two
from rpscli.records.ground_motion import GroundMotion, MotionComponents, is_usual, scale_warning
from rpscli.records.pair import angle_of, direction_of, rotated, together, turned
from rpscli.records.quantities import (
    LIKENESS,
    Query,
    canonical_unit,
    hint,
    parse_query,
    split_option,
    unit_factor,
)

_MAKERS: dict[str, Callable[[str, str], GroundMotion]] = {
    sets.SCHEME: sets.load_component,
    pulses.SCHEME: pulses.load_pulse,
    synthetic.SCHEME: synthetic.load_synthetic,
}
# Two letters at least: C: is a drive.
_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9_.+-]+):(.*)", re.DOTALL)
_REMARK = re.compile(r"(?:^|\s)#")
LIST = "list"
"""Scheme of a text file with one source a line, seen from its folder."""
# A question mark may also stand in a glob or a file name: options are key=value, or `both`.
_OPTION = r"(?:[A-Za-z_]\w*=[^&?]*|both)"
_FILE_OPTIONS = re.compile(rf"(.+?)\?({_OPTION}(?:&{_OPTION})*)", re.DOTALL)


def load_record(
    source: str, *, folder: Path | None = None, dt: float | None = None, units: str | None = None
) -> GroundMotion:
    """Load one ground motion.

    Parameters
    ----------
    source : str
        A file, with options if it needs them (`rec.txt?dt=0.005&units=g`, `rec.V2?channel=1`), or
        `fema_p695:farfield/1/b`, `pulse:sine?...`, `synthetic:?...`. Two components at an angle
        from the first towards the second [deg]: `x.at2?second=y.at2&angle=30`,
        `fema_p695:farfield/1?angle=30`. `factor=1.5` multiplies any of them. Both components
        together, `fema_p695:farfield/1?both`, are read by `load_components`.
    folder : Path, optional
        Where relative paths start (the folder of the case file); else the working directory.
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
    if together(source) is not None:
        raise RecordError(
            f"{source}: holds two components, and one is wanted here; name one of them, or a"
            " direction between them by angle=30 in place of both"
        )
    with _readable(source):
        plain, option = split_factor(source)
        motion = _loaded(plain, folder, dt, units)
        if not option:
            return motion
        factor = parse_query(option, source, ("factor",)).quantity("factor", "ratio")
        doubt = () if is_usual(factor) else (scale_warning(motion.name, factor),)
        warnings = (*motion.warnings, *doubt)
        # Results of different factors go to different folders.
        name = f"{motion.name}_x{factor:.4g}"
        return replace(motion.scaled(factor), name=name, source=source, warnings=warnings)


def load_components(
    source: str,
    vertical: str | None = None,
    y: str | None = None,
    rotation: float = 0.0,
    **how: Any,
) -> MotionComponents:
    """The components of a motion, read alike: those of a pair if the source, or `y`, says so.

    Parameters
    ----------
    source : str
        As that of `load_record`, or both components: `fema_p695:farfield/1?both`,
        `x.at2?second=y.at2&both`.
    vertical, y : str, optional
        Sources of the vertical and of the second horizontal component.
    rotation : float [deg]
        Of a pair from x towards y, in addition to what its source says.
    how
        `folder`, `dt` and `units` of `load_record`.

    Raises
    ------
    RecordError
        As `load_record`, and if the time steps of the components differ.
    """
    above = None if vertical is None else load_record(vertical, **how)
    parts = parts_of(source)
    in_set = source.startswith(f"{sets.SCHEME}:") and parts.both
    if not parts.both:
        along = load_record(source, **how)
        if y is None:
            return MotionComponents(along, above)
        across = load_record(y, **how)
    else:
        _require_two(parts, source)
        if in_set:  # before a component is refused that nobody wrote
            _describes_no_file(source, **{key: how.get(key) for key in ("dt", "units")})
            sets.expand_set(source.partition(":")[2], source)
        along, across = (load_record(one, **how) for one in parts.pair or ())
    name = along.name.replace("_a", "_both", 1) if in_set else f"{along.name}_both"
    motion = MotionComponents(replace(along, name=name, source=source), above, y=across)
    return turned(motion, parts.rotation + rotation)


class SourceParts(NamedTuple):
    """A source taken apart: its place, the rest of its options, the second file, the factor.

    It is `turned` by an angle, or `both` components act together, turned by a `rotation` [deg].
    """

    place: str
    options: str
    second: str | None
    factor: str
    turned: bool
    both: bool
    rotation: float

    def component(self, place: str) -> str:
        """One component, under the options and the factor of this source."""
        options = "&".join(filter(None, (self.options, self.factor)))
        return f"{place}?{options}" if options else place

    @property
    def pair(self) -> tuple[str, str] | None:
        """Sources of both components that it names itself."""
        places: tuple[str, str] | None = None
        if self.place.startswith(f"{sets.SCHEME}:"):
            pair = re.sub("/[ab]$", "", self.place)
            places = f"{pair}/a", f"{pair}/b"
        elif self.second is not None:
            places = self.place, self.second
        return places and (self.component(places[0]), self.component(places[1]))


def _require_two(parts: SourceParts, source: str) -> None:
    if parts.both and parts.pair is None:
        raise RecordError(
            f"{source}: both needs two components: a pair of a set, fema_p695:farfield/1?both, or"
            " second=FILE, seen from the folder of the first one"
        )


def parts_of(source: str) -> SourceParts:
    """A source taken apart."""
    without, factor = split_factor(source)
    angled, both = direction_of(without), together(without)
    single = both or angled
    text, second = split_option(single.pair if single else without, "second")
    in_set = text.startswith(f"{sets.SCHEME}:")
    place, options = text.partition("?")[::2] if in_set else split_options(text)
    if second is not None:
        second = str(PurePath(place).parent / second)
    rotation = both.angle if both else 0.0
    return SourceParts(
        place, options, second, factor, angled is not None, both is not None, rotation
    )


def split_factor(source: str) -> tuple[str, str]:
    """A source without its factor, and that option; empty without one."""
    plain, factor = split_option(source, "factor")
    return plain, "" if factor is None else f"factor={factor}"


def _describes_no_file(source: str, dt: float | None, units: str | None) -> None:
    if dt is not None or units is not None:
        raise RecordError(f"{source}: dt and units describe files; leave them out here")


def _loaded(source: str, folder: Path | None, dt: float | None, units: str | None) -> GroundMotion:
    scheme, rest = _split_scheme(source, folder)
    if scheme == LIST:
        raise RecordError(f"{source}: stands for several records; name one of its lines")
    if scheme:
        _describes_no_file(source, dt, units)
        return _MAKERS[scheme](rest, source)
    place, options = file_and_options(source, folder)
    query = parse_query(options, source, ("dt", "units", "channel", "second", "angle"))
    path = _located(place, folder)
    motion = _read(path, source, query, dt, units)
    second, angle = query.values.get("second"), query.values.get("angle")
    if (second is None) != (angle is None):
        raise RecordError(
            f"{source}: two components need both options: second=FILE, seen from the folder of the"
            " first one, and angle=30, in degrees"
        )
    if second is None:
        return motion
    # Beside the first one, so that a source means the same from wherever it is seen.
    turn = angle_of(query)
    motion = rotated(motion, _read(_located(second, path.parent), source, query, dt, units), turn)
    return replace(motion, name=f"{motion.name}_{turn:g}deg")


def _read(
    path: Path, source: str, query: Query, dt: float | None, units: str | None
) -> GroundMotion:
    in_source = query.quantity("dt", "time") if "dt" in query.values else None
    if dt is not None and in_source not in {None, dt}:
        raise RecordError(f"{source}: dt = {dt} s contradicts the {in_source} s in the source")
    spelled = query.values.get("units")
    if units is not None and spelled is not None and _differ(units, spelled):
        raise RecordError(f"{source}: units = {units} contradicts the {spelled} in the source")
    _require_file(path, source)
    from rpscli.records.formats import read_record  # sets and pulses are not files

    return read_record(
        path,
        source,
        dt=dt if in_source is None else in_source,
        units=spelled or units,
        channel=query.integer("channel") if "channel" in query.values else None,
    )


def expand_sources(sources: Sequence[str], *, folder: Path | None = None) -> list[str]:
    """The single sources of a list that may hold folders, globs and patterns of record sets."""
    # What a source stands for keeps its place in the list, sorted by name, and nothing comes twice.
    # Of a folder only files that are recognised as records count, not velocities or displacements.
    expanded = [single for source in sources for single in _expand(source, folder)]
    return list(dict.fromkeys(expanded))


def repeated(sources: Sequence[str]) -> list[str]:
    """What is to be said of sources that are given more than once, if there are any."""
    again = [source for source, count in Counter(sources).items() if count > 1]
    others = f" and {len(again) - 1} more" if len(again) > 1 else ""
    return [f"{first}{others}: given more than once, taken once" for first in again[:1]]


@contextmanager
def _readable(source: str) -> Iterator[None]:
    """Paths that the system refuses: no permission, too long, a working folder that is gone."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        raise RecordError(
            f"{source[:200]}: cannot be read: {reason}; check the name and the permissions"
        ) from None


def _differ(one: str, other: str) -> bool:
    units = canonical_unit(one), canonical_unit(other)
    if units[0] is None or units[1] is None:
        return one != other
    return unit_factor(units[0]) != unit_factor(units[1])


def _expand(source: str, folder: Path | None) -> list[str]:
    with _readable(source):
        plain, factor = split_factor(source)
        found = _expanded(plain, folder)
        for single in found:
            _require_two(parts_of(single), single)
        if not factor:
            return found
        if plain.startswith(f"{LIST}:"):
            raise RecordError(f"{source}: each line of a list has a factor of its own")
        bare = [each for each in found if "?" not in each or _is_file(each, folder)]
        return [f"{single}{'?' if single in bare else '&'}{factor}" for single in found]


def _expanded(source: str, folder: Path | None) -> list[str]:
    scheme, rest = _split_scheme(source, folder)
    if scheme == LIST:
        return _listed(rest, source, folder)
    if scheme == sets.SCHEME:
        return sets.expand_set(rest, source)
    if scheme:
        return [source]
    from rpscli.records.formats import is_record

    place, options = file_and_options(source, folder)
    suffix = f"?{options}" if options else ""
    path = _located(place, folder)
    if path.is_dir():
        names = sorted(entry.name for entry in path.iterdir() if entry.is_file())
        found = [f"{Path(place) / name}" for name in names if is_record(path / name)]
    elif glob.has_magic(place) and not path.exists():
        start = folder or Path()
        pattern = str(Path(place).expanduser())
        # Path.glob refuses absolute patterns.
        matches = sorted(glob.glob(pattern, root_dir=start, recursive=True))  # noqa: PTH207
        files = [match for match in matches if (start / match).is_file()]  # no pipe, no device
        found = [match for match in files if is_record(start / match)]
    else:
        _require_file(path, source)
        return [source]
    if not found:
        raise RecordError(f"{source}: no record file there that can be read")
    parts = parts_of(source)
    if (parts.both or parts.turned) and parts.second is None:
        pairs = two_by_two(found, source)
        return [f"{first}?second={second}&{options}" for first, second in pairs]
    return [f"{name}{suffix}" for name in found]


def _listed(place: str, source: str, folder: Path | None) -> list[str]:
    """Sources of a list, one a line, files as seen from it; # after a blank begins a remark."""
    path = _located(place, folder)
    _require_file(path, source)
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise RecordError(f"{source}: is not text; name a list with one source a line") from None
    found = []
    for number, written in enumerate(lines, 1):
        line, scheme = written, ""
        try:
            line = _without_remark(written, path.parent)
            scheme, _ = _split_scheme(split_factor(line)[0], path.parent)
            if line and scheme != LIST:
                found += _expand(line if scheme else str(Path(place).parent / line), folder)
        except RecordError:
            if scheme:
                raise
            raise RecordError(
                f"{source}:{number}: {beginning(line)} is neither there nor another source; name"
                " files as seen from the folder of the list"
            ) from None
        if scheme == LIST:
            raise RecordError(f"{source}: {line}: a list holds no lists; write its sources here")
    if not found:
        raise RecordError(f"{source}: holds no sources; write one a line")
    return found


def _without_remark(line: str, folder: Path) -> str:
    """What a line names; the name of a file that is there may hold the mark of a remark."""
    whole = line.strip()
    place, _ = file_and_options(split_factor(whole)[0], folder)
    named = len(place) if "#" in place and _is_file(place, folder) else 0
    return whole[:named] + _REMARK.split(whole[named:])[0].strip()


def _split_scheme(source: str, folder: Path | None) -> tuple[str, str]:
    """Scheme and rest of a source that is not a file; an empty scheme means a file."""
    match = _SCHEME.fullmatch(source)
    if not match or _located(file_and_options(source, folder)[0], folder).exists():
        return "", source
    kinds = [*_MAKERS, LIST]
    if match[1] not in kinds:
        raise RecordError(
            f"{source}: {match[1]!r} is not a kind of record source; {hint(match[1], kinds)}"
        )
    return match[1], match[2]


def file_and_options(source: str, folder: Path | None = None) -> tuple[str, str]:
    """The name of a file, which may itself look like options, and its options."""
    return (source, "") if _is_file(source, folder) else split_options(source)


def _is_file(place: str, folder: Path | None) -> bool:
    try:
        return ((folder or Path()) / Path(place).expanduser()).is_file()
    except (OSError, ValueError, RuntimeError):  # too long, a zero byte, no such user
        return False


def split_options(source: str) -> tuple[str, str]:
    """The name of a file, and its options."""
    match = _FILE_OPTIONS.fullmatch(source)
    return (match[1], match[2]) if match else (source, "")


def _located(place: str, folder: Path | None) -> Path:
    try:
        path = Path(place).expanduser()
    except RuntimeError:
        raise RecordError(f"{place}: there is no such user; write the folder out") from None
    if "\0" in place:
        raise RecordError(f"{place[:200]!r}: no path holds a zero byte; correct the name")
    require_visible(place, RecordError)
    return (folder or Path()) / path


def _require_file(path: Path, source: str) -> None:
    if stat.S_ISREG(found := mode_of(path)):
        return
    if found:
        what = "a folder; name one of its files" if stat.S_ISDIR(found) else "not a regular file"
        raise RecordError(f"{path}: {what}")
    if not path.parent.is_dir():
        raise RecordError(f"{source}: there is no folder {path.parent}")
    names = sorted(entry.name for entry in path.parent.iterdir())
    close = nearest(path.name, names, LIKENESS)
    suggestion = f"; did you mean {path.parent / close}?" if close else ""
    raise RecordError(f"{source}: there is no file {path}{suggestion}")
