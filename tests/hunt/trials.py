"""Many trials with hostile input: how they are drawn, damaged, counted, bounded and judged.

Each trial draws from its own seed, so that one that fails is repeated by its number alone.
`RPS_HUNT_SEED` sets the seed of all, `RPS_HUNT_TIMES` multiplies the counts of the long hunt, and
`RPS_HUNT_TABLE` names a file to which each hunt adds a row after so many trials.
"""

import json
import os
import re
import signal
import time
from collections import Counter
from contextlib import contextmanager
from pathlib import Path
from random import Random

import pytest
from click.testing import CliRunner

from rpscli.cli import program

SEED = os.environ.get("RPS_HUNT_SEED", "1")
TIMES = float(os.environ.get("RPS_HUNT_TIMES", "1"))
TABLE = os.environ.get("RPS_HUNT_TABLE")

EACH = 250
"""Trials after which a row is written, so that a hunt that is stopped has not been for nothing."""

PROMISED = frozenset({0, 3, 4, 5, 7, 10})
"""Exit codes that input may lead to; 1 is a fault of ours, 2 one of the command line."""

LONGEST_LINE = 700
"""Letters of a message: place, value, rule and remedy, beside the path of a temporary folder."""

SLOWEST = 90.0
"""Seconds that one trial may compute: some histories of 5 s, as estimated, and four times as long
on a slow machine. It may wait ten times as long on a busy one."""


class TooSlow(BaseException):
    """A trial that is not over in time; no part of the program may take it for its own error."""


shares = pytest.mark.parametrize(
    "long", [False, pytest.param(True, marks=pytest.mark.long)], ids=["quick", "long"]
)


def hunt(name, trial, quick, long=None):
    """Run trials of a kind, `long` if given in place of `quick`; failures by their numbers."""
    count = quick if long is None else round(long * TIMES)
    seed = SEED if long is not None else "1"
    ends = Counter()
    failures = []
    slowest = 0.0
    for number in range(count):
        begin = time.process_time()
        try:
            with time_limit(SLOWEST):
                draw = Random(f"{seed}-{name}-{number}")  # noqa: S311 -- no secret
                ends[trial(draw)] += 1
        except (Exception, TooSlow) as error:  # noqa: BLE001 -- it is what is looked for
            failures.append(
                f"{name} {number} of seed {seed}: {type(error).__name__}: {error}"
            )
        slowest = max(slowest, time.process_time() - begin)
        if TABLE and (number % EACH == EACH - 1 or number == count - 1):
            row = {
                "name": name,
                "seed": seed,
                "tried": number + 1,
                "failed": len(failures),
            }
            row |= {
                "slowest": round(slowest, 1),
                "ends": dict(ends),
                "failures": failures,
            }
            with Path(TABLE).open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
    assert not failures, f"{len(failures)} of {count}:\n" + "\n".join(failures[:20])


def hunted(name, quick, many):
    """A trial as two tests: so many in every run, and `many` on demand."""

    def tests_of(trial):
        @shares
        def test(long):
            hunt(name, trial, quick, many if long else None)

        return test

    return tests_of


@contextmanager
def time_limit(seconds):
    """An error after so many seconds of computing, wherever Python is."""

    def over(number, frame):
        raise TooSlow(f"not over after {seconds:g} s")

    timers = {signal.ITIMER_PROF: signal.SIGPROF, signal.ITIMER_REAL: signal.SIGALRM}
    before = {number: signal.signal(number, over) for number in timers.values()}
    signal.setitimer(signal.ITIMER_PROF, seconds)
    signal.setitimer(signal.ITIMER_REAL, 10.0 * seconds)
    try:
        yield
    finally:
        for timer, number in timers.items():
            signal.setitimer(timer, 0.0)
            signal.signal(number, before[number])


def judged(*arguments, places=(), text="", codes=PROMISED):
    """Run `rps`; its exit code and messages must be as promised.

    The first line of a refusal names one of `places`, or begins with what stands in `text`.
    """
    result = CliRunner().invoke(program, list(arguments))
    shown = f"{' '.join(arguments)[:300]}: {result.stderr[-600:]}"
    assert result.exit_code in codes, f"exit code {result.exit_code}: {shown}"
    if "--json" in arguments:
        document = json.loads(result.stdout, parse_constant=_no_json)
        assert document["schema_version"] == 1
    if result.exit_code == 0:
        assert "error:" not in result.stderr, shown
        return "done"
    _judge_message(result, places, text, shown)
    return f"exit {result.exit_code}"


def _judge_message(result, places, text, shown):
    lines = [line for line in result.stderr.splitlines() if line.startswith("error: ")]
    assert lines, f"no message: {shown}"
    assert len(lines) <= 101, f"{len(lines)} lines: {shown}"
    assert not any("internal error" in line for line in lines), shown
    begin = lines[0].removeprefix("error: ").split(": ")[0].split("...")[0]
    # a YAML line that is broken in two is one with a blank
    named = any(place in lines[0] for place in places) or begin in " ".join(text.split())
    assert named or not places, f"no place: {shown}"
    longest = max(lines, key=len)
    assert len(longest) <= LONGEST_LINE, (
        f"a line of {len(longest)} letters: {longest[:300]}"
    )
    assert all(len(line.split()) >= 5 for line in lines), f"no rule: {shown}"


def _no_json(constant):
    raise AssertionError(f"{constant} is no JSON")


# Texts damaged at random: by slips of the hand, by transfer, and on purpose.

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?")
NUMBERS = [
    "0", "-1", "1", "2", "1e-320", "1E999", "-1e300", "1e20", "0.0", "nan", "inf", ".", "-",
    "1.2.3", "0,5", "1_000", "٣", "4000000000", "9" * 30, "9" * 400, "1E+99999999999999999999",
    "0x10", "1e",
]  # fmt: skip
PIECES = [
    "", " ", "\t", ":", "-", "{", "}", "[", "]", ",", ";", "#", "'", '"', "&a", "*a", "!!python/x",
    "<<", "null", "true", "~", "|", "?", "units: g", "NPTS= 3, DT= .1", "dt: 0.01", "END", "\x1a",
    "é", "建物", "\x00", "\x85", "\u2028", "1 2 3", "x" * 3000, "--- a", "storeys: 6",
    "@", "%", "`",
]  # fmt: skip


def mutated(text, random):
    """The text after one to four damages."""
    for _ in range(random.choice([1, 1, 1, 2, 4])):
        text = random.choice(DAMAGES)(text, random)
    return text


def _number(text, random):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    # The numbers of a header are worth more than the thousands that follow.
    match = random.choice(found[:60] if random.random() < 0.7 else found)
    return text[: match.start()] + random.choice(NUMBERS) + text[match.end() :]


def _scaled_number(text, random):
    found = list(NUMBER.finditer(text))[:60]
    if not found:
        return text
    match = random.choice(found)
    factor = random.choice([-1.0, 0.5, 2.0, 1e3, 1e-3, 1e9])
    value = float(re.sub("[dD]", "e", match[0])) * factor
    return f"{text[: match.start()]}{value:g}{text[match.end() :]}"


def _lines(change):
    def damage(text, random):
        lines = text.split("\n")
        place = random.randrange(
            min(len(lines), 60) if random.random() < 0.7 else len(lines)
        )
        return "\n".join(change(lines, place, random))

    return damage


def _swapped(lines, i, random):
    j = random.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return lines


def _indented(lines, i, random):
    lines[i] = random.choice(["", " ", "  ", "\t", "        "]) + lines[i].lstrip()
    return lines


def _letter(text, random):
    if not text:
        return text
    place = random.randrange(min(len(text), 2000) if random.random() < 0.7 else len(text))
    letter = chr(random.choice([random.randrange(32, 127), random.randrange(0, 0x250)]))
    return text[:place] + letter + text[place + random.randrange(2) :]


def _piece(text, random):
    place = random.randrange(min(len(text), 2000) + 1)
    return text[:place] + random.choice(PIECES) + text[place:]


def _word(text, random):
    words = list(re.finditer(r"\w+", text[:4000]))
    if not words:
        return text
    here, other = random.choice(words), random.choice(words)
    return text[: here.start()] + other[0] + text[here.end() :]


DAMAGES = [
    _number,
    _number,
    _scaled_number,
    _letter,
    _letter,
    _piece,
    _word,
    _lines(lambda lines, i, _: [*lines[:i], *lines[i + 1 :]]),
    _lines(lambda lines, i, _: [*lines[: i + 1], *lines[i:]]),
    _lines(_swapped),
    _lines(_indented),
    lambda text, random: text[: random.randrange(len(text) + 1)],
    lambda text, random: text + text[random.randrange(len(text) + 1) :],
    lambda text, random: text.replace(
        *random.choice([(".", ","), (" ", ";"), (":", ""), ("\n", "")])
    ),
    lambda text, random: text.replace("\n", random.choice(["\r\n", "\r", "\n\n", " \n"])),
]
