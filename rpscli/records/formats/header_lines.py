"""What lines of a header say by their values, whatever their keys are.

A key that is not known says nothing, in the language of the file or in another; a number
or a unit behind it does. What is neither understood nor said of something else than the
motion is never skipped: it is refused with its words and what to write.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rpscli.errors import stem_of
from rpscli.records.formats.record_text import Array, RecordText
from rpscli.records.formats.statements import STATED_PATTERN, Statement
from rpscli.records.quantities import (
    ACCELERATIONS,
    HERTZ_PATTERN,
    NUMBER_PATTERN,
    TIME_UNITS,
    UNIT_PATTERN,
    canonical_unit,
    last_digit,
    to_float,
)
from rpscli.records.words import (
    BESIDE_QUANTITIES,
    COUNTED,
    DIRECTIONS,
    FACTORS,
    LIMITS,
    NO_SERIES,
    NOT_OF_THE_MOTION,
    OTHER_QUANTITIES,
    PEAKS,
    PLACES,
    SAMPLING,
    SERIALS,
    STEPS,
    STRUCTURES,
    TIMES,
    UNITS,
    folded,
    speaks_of,
    vocabulary,
    words_of,
)

_UNIT = rf"(?:{UNIT_PATTERN})"
_WHOLE_UNIT = re.compile(rf"[\[(]?\s*({_UNIT})\s*[\])]?\.?", re.IGNORECASE)
_UNIT_INSIDE = re.compile(
    rf"(?:(?<!\w)(?:in|of|en|auf|als|de|em|w|v|в)\s+|[\[(]\s*)({_UNIT})\s*(?:[\])]|$"
    rf"|[,;.])",
    re.IGNORECASE,
)
_UNIT_OF_KEY = re.compile(rf"(?:{_UNIT_INSIDE.pattern})\s*$", re.IGNORECASE)
_UNIT_AT_THE_END = re.compile(rf"[^\W\d_]\s+(?!g$|gravity$)({_UNIT})$", re.IGNORECASE)
_NUMBER = STATED_PATTERN.replace("[+-]?", "[-+−]?", 1)
_BEHIND = rf"\s*({_UNIT}|[^\W\d][\w/^*.%²-]{{0,15}}|%\w*)?"
_KEYED = re.compile(
    rf"([^\W\d_][^:=;|]{{0,60}}?)\s*[:=]\s*[\[(]?\s*({_NUMBER})(?![\d.,:])[\])]?{_BEHIND}",
    re.IGNORECASE,
)
_AT_THE_END = re.compile(
    rf"\W{{0,9}}([^\W\d_][^:=;|]{{0,60}}?)\s+({_NUMBER})(?![\d.,:]){_BEHIND}"
    r"\s*[.)\]]*",
    re.IGNORECASE,
)
_ALONE = re.compile(rf"[\s#x×*]*({_NUMBER})()\s*", re.IGNORECASE)
_WIDTH = 240
"""Letters of a line that state something."""
_IN_CELLS = re.compile(
    rf"^([^\W\d](?:[^,;:=]*[^,;:=\d])?)[,;\t]\s*({_NUMBER}(?:\s*{_UNIT})?|{_UNIT})\s*[,;]*$",
    re.IGNORECASE,
)
"""A key and its value in two cells."""
_PART = re.compile(
    r"[;|\t]|,(?=\s*[^\W\d][^:=,]{0,60}[:=])|\s{2,}(?=[^\W\d][^:=]{0,60}[:=])"
)
_TIMES = re.compile(
    r"\d{4}年(?:\s?\d{1,2}月\s?\d{1,2}日)?|\d{1,2}時\s?\d{2}分(?:\s?\d{2}(?:\.\d+)?秒)?"
    r"|\b\d{1,2}h\s?\d{2}m(?:in)?(?:\s?\d{2}s)?"
    r"|\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}(?:T(?=\d))?"
    r"|\d{1,2}:\d{2}(?!\d)(?::\d{2}(?:\.\d*)?)?Z?"
    r"|\b\d{1,2}\.? [^\W\d]{3,9}\.?,? \d{4}\b|\b[^\W\d]{3,9}\.? \d{1,2},? \d{4}\b"
)
"""Dates and clock times, which state nothing of the values."""
_OF_A_SOURCE = re.compile(r"[?&]\w+=\S*|\S+:/\S*")
_TITLED = re.compile(r"[^:=]*\w,[^:=]*,\s*[0-3]?\d\d\s*$")
"""A title of a recording that ends in an azimuth."""
_YEAR = re.compile(r"(?:18|19|20)\d\d")
_IN_BRACKETS = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")

_RATE = re.compile(rf"{HERTZ_PATTERN}|sps|samples?(?:/s\w*|persec\w*)?")

_SCALED = re.compile(
    r"(?<![?&(_-])\b(?:normali[sz]ed|normalis\w+|normier\w*|scaled|rescaled|skaliert"
    r"|escalad\w+"
    r"|scalat[oi]|normalizzat\w+|normalizad\w+|olceklen\w+|масштабир\w+|нормир\w+"
    r"|amplified|factored|upscaled|downscaled|adjusted to|peak[- ]adjusted|unit amplitude"
    r"|\d/\d+ (?:amplitude|scale|model)|times (?:two|three|four|five|ten)"
    r"|reduced (?:by|to)|\d+ ?% (?:level|scale|amplitude)|at \d+ ?%|dimensionless"
    r"|log10|squared|absolute values|derivative|normiran\w*|mise a l.echelle|a l.echelle"
    r"|x ?10+|\d(?:\.\d+)? ?x [a-z]+|absolute value|rectified|\ba\^2|verdubbeld"
    r"|peak-normali[sz]ed|sensitivity|length scale|time scale|prototype|compressed time"
    r"|percent(?:age)?|per cent|porcentaje|percentuale|prozent|pourcent\w*|promille"
    r"|per ?mil(?:le)?|hundredths?|thousandths?|tenths?"
    r"|divided?|dividid\w+|divis[oi]|multipli\w+|moltiplicat\w+|integrated|integriert"
    r"|integrad\w+|integrat[oi]|half|halved|doubled|twice|\d\s*times|x\s*\d|\*\s*\d)\b"
    r"|\btimes \d|\blevel \d+ ?%|^\W*[x×*]\s*\d|規格化|正規化|正规化|归一化|放大|缩小|‰|1/1000"
    r"|\bin \w+, kilo\b"
)
"""Words of sentences that say that values are others than they look."""
_RAW = re.compile(
    r"\b(?:raw|uncorrected|unprocessed|unfiltered|unkorrigiert|non corrig\w+"
    r"|non corrett\w+"
    r"|no corregid\w+|sin corregir|ham (?:veri|kayit)|duzeltilmemis|brut"
    r"|необработан\w+)\b"
)


_LENGTHS = vocabulary(
    "km mi miles kilometers m ft hz khz nm dyn db deg bit bits % ° yr years j mpa kpa °c"
)
"""Units of other things than a motion over time."""
OF_SOMETHING_ELSE = NOT_OF_THE_MOTION | LIMITS | DIRECTIONS | PLACES | STRUCTURES
"""Keys whose numbers do not bear on the values."""


class Said(NamedTuple):
    """A number that a line states: its key, its numeral, what stands behind it or in
    brackets of the key, the line (from zero), and its words.
    """

    key: str
    numeral: str
    behind: str
    line: int
    words: str
    keyed: bool = True  # by : or =

    @property
    def number(self) -> float:
        """The number, a decimal comma as a point."""
        return to_float(self.numeral.replace(",", ".").replace("−", "-"))

    @property
    def unit(self) -> str | None:
        """The unit of acceleration that it is in; None without one."""
        inside = _UNIT_OF_KEY.search(self.key)
        return canonical_unit(self.behind or (inside[1] if inside else "") or "-")

    @property
    def unit_of_time(self) -> str:
        """What is behind it, or in brackets of its key, folded, without blanks."""
        bracket = _IN_BRACKETS.search(self.key)
        own = self.behind or (bracket[1] if bracket else "")
        return re.sub(r"[\s.]", "", folded(own))


class Facts(NamedTuple):
    """What was read of a motion: values in a unit of so many m/s2, and the step [s]."""

    values: Array
    unit: str
    factor: float
    step: float
    numbers: int  # in the file

    @property
    def peak(self) -> float:
        """The largest value."""
        return float(np.max(np.abs(self.values)))


@dataclass(frozen=True)
class HeaderLines:
    """Lines of a header that no reader has understood yet.

    `lines` are numbered; with `loose` ones also `words 0.5` at the end of a line and a
    number by itself are statements, not in titles of recordings.
    """

    text: RecordText
    lines: Sequence[tuple[int, str]]
    loose: bool = True

    @property
    def parts(self) -> Iterator[tuple[int, str]]:
        """Parts of the lines, with neither dates, clock times nor options of sources."""
        for index, line in self.lines:
            bare = _OF_A_SOURCE.sub(" ", line[:_WIDTH])
            bare = _IN_CELLS.sub(r"\1: \2", bare)
            for part in _PART.split(_TIMES.sub(" ", bare)):
                if part.strip():
                    yield index, part.strip()

    @property
    def numbers(self) -> Iterator[Said]:
        """Numbers that the lines state, with their keys."""
        for index, part in self.parts:
            keyed = [*_KEYED.finditer(part)]
            if not keyed and self.loose and not re.search(r"[:=]\s*\S", part):
                yield from _loose_number(index, part)
            for match in keyed:
                if canonical_unit(match[1]) and canonical_unit(match[3] or "-"):
                    continue  # 1 g = 9.81 m/s2
                yield Said(match[1], match[2], match[3] or "", index, part[:60])

    def units(self) -> list[Statement]:
        """Units of acceleration that stand as values, whatever their keys are."""
        found: list[Statement] = []
        for index, part in self.parts:
            key, mark, value = part.rpartition(":")
            if not mark:
                key, mark, value = part.rpartition("=")
            bare = re.search(r"\d", _IN_BRACKETS.sub("", value)) is None
            if not bare and self.loose:
                found += _units_beside_numbers(value, index)
            whole = _WHOLE_UNIT.fullmatch(value.strip(" ,;"))
            inside = _UNIT_INSIDE.search(value) if bare and not whole else None
            if bare and self.loose:
                inside = inside or _UNIT_AT_THE_END.search(value)
            if not (match := whole or inside):
                continue
            short = match[1].lower() in ("g", "gravity") and mark and whole
            other = speaks_of(key, NOT_OF_THE_MOTION) and not speaks_of(key, UNITS)
            if short and other:
                continue
            found.append(Statement(key.strip() or "the header", match[1], index))
        return found

    def steps(self) -> list[Statement]:
        """Steps and rates of sampling in other words than those of a reader [s]."""
        found = [
            Statement(said.key.strip(), f"{step:.15g}", said.line)
            for said in self.numbers
            if (step := _step_of(said)) is not None
        ]
        return found or [*self._steps_in_clauses()]

    def _steps_in_clauses(self) -> Iterator[Statement]:
        """Steps and rates between commas, as in `values in gal, step 0.01 s`."""
        for index, part in self.parts if self.loose else ():
            clauses = _CLAUSE.split(part)
            for clause in clauses if len(clauses) > 1 else ():
                for said in _loose_number(index, clause.strip(" .,;")):
                    if (step := _step_of(said)) is not None:
                        yield Statement(said.key.strip(), f"{step:.15g}", index)
                if match := _RATE_ALONE.fullmatch(clause.strip(" .,;")):
                    rate = to_float(match[1])
                    yield Statement("the header", f"{1.0 / rate:.15g}", index)


_LONGEST = 0.5
"""Of a step [s]: what is longer is another time."""
_PER_SAMPLE = re.compile(r"m?s/(?:sample|point|scan)")


def _loose_number(index: int, part: str) -> Iterator[Said]:
    """A number at the end of words, or by itself, that is no year."""
    match = _AT_THE_END.fullmatch(part)
    if match and not _TITLED.match(part):
        key, numeral, behind = match.groups("")
        if not _YEAR.fullmatch(numeral) or speaks_of(key, COUNTED):
            yield Said(key, numeral, behind, index, part[:60], keyed=False)
            return
    alone = _ALONE.fullmatch(part)
    if alone and not _YEAR.fullmatch(alone[1]):
        yield Said("", alone[1], "", index, part)


_RATE_ALONE = re.compile(rf"({NUMBER_PATTERN})\s*(?:hz|sps)", re.IGNORECASE)
_CLAUSE = re.compile(r"[,;]\s+|\.\s+|,$|;$")
_UNIT_IN_CLAUSE = re.compile(
    rf"(?:\b(?:in|en|auf|w|v|в|i)\s+|[\[(]\s*)({_UNIT})\s*[\])]?$|^({_UNIT})$",
    re.IGNORECASE,
)


def _units_beside_numbers(line: str, index: int) -> Iterator[Statement]:
    """Units in clauses of a line without numbers, as in `step 0.01 s, values in gal`."""
    for clause in _CLAUSE.split(line):
        bare = clause.strip(" .,;")
        match = _UNIT_IN_CLAUSE.search(bare)
        if match and not re.search(r"\d", bare[: match.start()]):
            unit = match[1] or match[2] or match[3]
            if unit.lower() not in ("g", "gravity") or match[1]:
                yield Statement("the header", unit, index)


def _step_of(said: Said) -> float | None:
    """The step that a statement is of [s]; None if it is of something else."""
    number = said.number
    if _PER_SAMPLE.fullmatch(said.unit_of_time):
        return number * (1e-3 if said.unit_of_time.startswith("m") else 1.0)
    samples = speaks_of(said.key, SAMPLING)
    others = FACTORS | COUNTED | (NOT_OF_THE_MOTION - TIMES)
    if number <= 0.0 or not (samples or speaks_of(said.key, STEPS)):
        return None
    behind = said.unit_of_time
    if behind and behind in TIME_UNITS:
        step = number * TIME_UNITS[behind]
        return None if speaks_of(said.key, others) or step > _LONGEST else step
    if speaks_of(said.key, others):
        return None
    if samples and (_RATE.fullmatch(behind) or (not behind and number > 1.0)):
        return 1.0 / number
    return number if not behind and number <= _LONGEST else None


def doubts_of_header(header: HeaderLines, facts: Facts) -> list[str]:
    """What is to be said of statements that the samples contradict.

    Raises RecordError for numbers and sentences that are not understood, unless the user
    says what a value is.
    """
    doubts = []
    for said in header.numbers:
        if speaks_of(header.text.heads[said.line], NO_SERIES):
            continue  # of the spectrum that was the target
        if doubt := _contradiction(said, facts):
            doubts.append(doubt)
        elif header.text.multiple is None and not _is_understood(said, facts):
            _refuse(header.text, said.words, said.line, facts)
    for index, line in header.lines:
        plain = folded(line[:_WIDTH])
        scaled = _SCALED.search(plain) or _is_factor_in_words(line)
        if header.text.multiple is None and scaled:
            _refuse(header.text, line.strip()[:60], index, facts)
        if header.text.multiple is None and _UNKNOWN_UNIT.search(plain):
            _refuse(header.text, line.strip()[:60], index, facts)
        if header.text.multiple is None and _names_other_quantity(line):
            raise header.text.fault(
                f"{line.strip()[:60]!r} says that these are no accelerations; they were"
                f" read in {facts.unit}: if that is right, say ?units=1 {facts.unit}",
                index,
            )
        doubts += _other_counts(line, facts)
        doubts += raw_doubts(line)
    if header.text.multiple is None and not doubts:
        doubts += filter(None, [_doubt_of_name(stem_of(header.text.path), facts.unit)])
    return doubts


def _doubt_of_name(name: str, unit: str) -> str:
    """What the name of a file says of its values, which are read as they stand."""
    words = re.split(r"[_\s-]+", folded(name))
    factors = [word for word in words if _is_factor(word)]
    # Commas keep apart what a name joins: the 1 of "acc_x_1" is no factor.
    plain = ", ".join(word for word in words if not _FACTOR_OF_NAME.fullmatch(word))
    if raw := _RAW.search(plain):
        return f"its name says {raw[0]!r}: give the corrected record"
    if scaled := _SCALED.search(plain):
        factors.append(scaled[0])
    if factors:
        return (
            f"its name says {factors[0]!r}, and the values are read as they stand, in"
            f" {unit}: say ?units=1 {unit} if they are right"
        )
    for place, word in enumerate(words, 1):
        joined = _JOINED_UNIT.fullmatch(word)
        named = canonical_unit(f"{joined[1]}/s2" if joined else word)
        # One letter is a unit at the end alone: elsewhere it is a network or a direction.
        if named is None or (len(word) == 1 and place < len(words)):
            continue
        if ACCELERATIONS[named] != ACCELERATIONS[unit]:
            return (
                f"its name says {word!r}, and the values are read in {unit}: say"
                f" ?units=1 {unit} if they are, or ?units=1 {named}"
            )
    return ""


def _is_factor(word: str) -> bool:
    """True of x2 and 2x, not of x1."""
    match = _FACTOR_OF_NAME.fullmatch(word)
    return match is not None and to_float(match[1] or match[2]) != 1.0


_FACTOR_OF_NAME = re.compile(r"x(\d+(?:\.\d+)?)|(\d+(?:\.\d+)?)x")
_JOINED_UNIT = re.compile(r"([cm]?m)p?s[s2]")
"""Units as names of files write them, which can hold no slash."""


def raw_doubts(line: str) -> list[str]:
    """A doubt about values that a line says are not corrected."""
    match = _RAW.search(folded(line[:_WIDTH]))
    return [f"the header says {match[0]!r}: give the corrected record"] if match else []


_UNKNOWN_UNIT = re.compile(
    r"\b(?:si|cgs|mks|metric|imperial|metrische?|metriques?) (?:units?|einheiten|unites?)\b"
    r"|\bunidades del? si\b|\b(?:par|pro|per|al|por) (?:second|sekund|segundo)"
)
"""Words for units that do not say which."""
_KEY_AND_WORDS = re.compile(r"\W*([^:=]{2,60}?)\s*[:=]\s*([^\W\d].*)")
_NUMERALS = vocabulary(
    "two three four five ten zwei drei vier funf zehn deux trois dix due tre dieci dos"
    " tres diez iki uc on два три десять"
)


def _is_factor_in_words(line: str) -> bool:
    """True of a factor whose value is a word."""
    match = _KEY_AND_WORDS.fullmatch(line.strip())
    return bool(
        match and speaks_of(match[1], FACTORS) and {*words_of(match[2])} & _NUMERALS
    )


def _names_other_quantity(line: str) -> bool:
    """True of a line, or of what stands behind its key, of words for another quantity."""
    line = re.sub(r"[\[(].*?[\])]", " ", line)
    if re.search(r"\d", re.sub(r"\w*/\s?\w+\d?", "", line)):
        return False
    match = _KEY_AND_WORDS.fullmatch(line.strip())
    for part in filter(None, (match[2] if match else "", line)):
        words = words_of(part)
        others = [word for word in words if speaks_of(word, OTHER_QUANTITIES)]
        rest = (word for word in words if word not in others and len(word) > 2)
        if others and all(speaks_of(word, BESIDE_QUANTITIES) for word in rest):
            return True
    return False


_COUNT_FIRST = re.compile(
    r"(?<![\d.,])(\d{3,})\s*(?:values|points|samples|data|werte|valori)\b"
)
_LASTS = re.compile(
    r"^\W*(?:total |record(?:ing)? ?)?(?:time(?= ?=)|t_end|ends? at"
    r"|持续时间|duration|dauer|duracion|duree|durata|sure(?:si)?"
    r"|длительность|length|end time|time span)\b"
)
_FROM_TO = re.compile(r"^\s*0*(?:\.0*)?\s*(?:-|to|\.\.)\s*")


def _other_counts(line: str, facts: Facts) -> Iterator[str]:
    """Doubts about numbers of values and durations that the samples are not of."""
    plain = folded(line)
    if (match := _COUNT_FIRST.search(plain)) and int(match[1]) not in (
        facts.values.size, facts.numbers
    ):  # fmt: skip
        yield f"the header says {match[0]}, and the file holds {facts.values.size}"
    if not (match := _LASTS.match(plain)):
        return
    value = re.sub(r"^[^:=\d]*[:=]?\s*", "", plain[match.end() :])
    value = _FROM_TO.sub("", value)
    number = re.match(rf"({NUMBER_PATTERN}|\d+,\d+)\s*([^\W\d]*)", value)
    if number is None or number[2] not in TIME_UNITS:
        return
    seconds = to_float(number[1].replace(",", ".")) * TIME_UNITS[number[2]]
    lasts = facts.values.size * facts.step
    if abs(seconds - lasts) > max(0.02 * lasts, 2.0 * facts.step):
        yield f"the header says {line.strip()[:40]!r}, and the values last {lasts:.6g} s"


def _refuse(text: RecordText, words: str, line: int, facts: Facts) -> None:
    raise text.fault(
        f"{words!r} is not understood, and may change what the values are; they were read"
        f" in {facts.unit}, {facts.step:g} s apart: if that is right, say"
        f" ?units=1 {facts.unit}",
        line,
    )


def _contradiction(said: Said, facts: Facts) -> str:
    """A doubt about another peak, or an acceleration above that of the values."""
    peak = _states_peak(said)
    if (said.unit is None and not peak) or speaks_of(said.key, LIMITS | FACTORS):
        return ""
    each = _size(said, facts)
    wanted = each * abs(said.number)
    if wanted - facts.peak <= _rounding(said) * each and (
        not peak or _is_peak(said, facts)
    ):
        return ""
    return f"the values peak at {facts.peak:.6g} and the header says {wanted:.6g}"


def _is_understood(said: Said, facts: Facts) -> bool:
    """True of what the samples confirm, and of what is said of something else."""
    whole = said.unit is None and said.number == round(said.number)
    if _is_peak(said, facts) or (whole and said.number in (0.0, 1.0)):
        return True
    if _CODE.search(said.words) or _TITLED_DATE.search(said.words):
        return True
    counts = whole and not said.behind and speaks_of(said.key, COUNTED)
    if counts and not speaks_of(said.key, SERIALS):
        return said.number in (facts.values.size, facts.numbers)
    if speaks_of(said.key, FACTORS) and not speaks_of(said.key, LIMITS):
        return False
    other = speaks_of(said.key, OF_SOMETHING_ELSE) or said.behind.lower() in _LENGTHS
    other = other or (whole and not said.keyed and not speaks_of(said.key, COUNTED))
    return other or _is_of_time(said, facts)


_CODE = re.compile(r"[:=]\s*\d+[A-Z]+\d*\.?\d*(?=\s|$)")
"""A code of digits and capital letters: a station, a form of numbers."""
_TITLED_DATE = re.compile(r"[^\W\d]{3,9}\.? \d{1,2}(?:: | ,?)(?:18|19|20)\d\d\W*$")


def _states_peak(said: Said) -> bool:
    """True of a largest value, of nothing else by its words and its unit."""
    whose = speaks_of(said.key, NOT_OF_THE_MOTION - TIMES)
    return (
        speaks_of(said.key, PEAKS) and not whose and (not said.behind or bool(said.unit))
    )


def _size(said: Said, facts: Facts) -> float:
    """The unit of a statement in those of the values."""
    return ACCELERATIONS[said.unit] / facts.factor if said.unit else 1.0


def _rounding(said: Said) -> float:
    """What the printed digits of a statement leave open."""
    return 0.51 * last_digit(said.numeral.replace(",", ".")) + 1e-3 * abs(said.number)


def _is_peak(said: Said, facts: Facts) -> bool:
    """True of the largest acceleration."""
    if said.unit is None and not _states_peak(said):
        return False
    each = _size(said, facts)
    return abs(abs(said.number) * each - facts.peak) <= _rounding(said) * each


def _is_of_time(said: Said, facts: Facts) -> bool:
    """True of the step, the rate of samples, their number and their duration."""
    seconds = TIME_UNITS.get(said.unit_of_time, 1.0) * said.number
    count = facts.values.size
    known = (facts.step, count * facts.step, (count - 1) * facts.step)
    near = any(abs(seconds - each) <= 1e-6 * facts.step for each in known)
    return near or said.number == count or abs(said.number * facts.step - 1.0) < 1e-6
