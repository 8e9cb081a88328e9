"""K-NET and KiK-net ASCII files: counts of one component, to be scaled and centred."""

from __future__ import annotations

import re

from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.statements import (
    MOST_VALUES,
    Statement,
    agreed,
    peak_warnings,
    series,
    stated_number,
    stated_positive,
)
from rpscli.records.ground_motion import GroundMotion, Recording

_KEYS, _KEY_WIDTH, _ROW = 17, 18, 8
_SCALE = re.compile(r"(.*)\(gal\)\s*/(.*)")
_RATE = re.compile(r"(.*?)\s*Hz")


def recognises_knet(text: RecordText) -> bool:
    """Whether the header has the keys of K-NET."""
    head = "\n".join(text.heads[:_KEYS])
    return head.startswith("Origin Time") and "Scale Factor" in head


def read_knet(text: RecordText) -> GroundMotion:
    """Read a K-NET or KiK-net file; the mean, the sensor's offset, is removed, and that is said."""
    text.single_channel()
    scale = _stated(text, "Scale Factor", _SCALE)
    (rate,) = _stated(text, "Sampling Freq(Hz)", _RATE)
    (duration,) = _stated(text, "Duration Time(s)", re.compile("(.+)"))
    per_second = stated_positive(text, rate)
    count = stated_positive(text, duration) * per_second
    if not 0.5 < count < MOST_VALUES:
        raise text.fault(
            f"{duration.value} s at {per_second:g} Hz are {count:.3g} values, which is more or less"
            " than a record can have; correct the header",
            duration.line,
        )
    _, factor = text.agreed_factor("gal")
    counts = series(text, _KEYS, round(count), width=_ROW)
    values = counts * (stated_positive(text, scale[0]) / stated_positive(text, scale[1]))
    mean = float(values.mean())
    peaks, magnitudes = _said(text, "Max. Acc. (gal)"), _said(text, "Mag.")
    code, direction, origin = (
        said[0].value if (said := _said(text, key)) else ""
        for key in ("Station Code", "Dir.", "Origin Time")
    )
    return GroundMotion(
        (values - mean) * factor,
        text.agreed_dt(1.0 / per_second),
        text.path.name.replace(".", "_"),  # the extension tells the component
        text.source,
        "K-NET ASCII",
        f"{code} {direction}, {origin}; values in gal; mean of {mean:.4g} gal removed",
        peak_warnings(values - mean, stated_number(text, peaks[0]), 1e-3) if peaks else (),
        recording=Recording(
            station=code,
            magnitude=stated_number(text, magnitudes[0]) if magnitudes else None,
            origin=origin,
            direction=direction,
        ),
    )


def _said(text: RecordText, key: str) -> list[Statement]:
    """What the lines of a key say; an empty value says nothing."""
    return [
        Statement(key, line[_KEY_WIDTH:].strip(), index)
        for index, line in enumerate(text.heads[:_KEYS])
        if line[:_KEY_WIDTH].strip() == key and line[_KEY_WIDTH:].strip()
    ]


def _stated(text: RecordText, key: str, form: re.Pattern[str]) -> list[Statement]:
    """The numbers of a key that must be there, once."""
    said = agreed(text, _said(text, key), lambda _, statement: statement.value)
    match = form.fullmatch(said.value) if said else None
    if said is None or match is None:
        raise text.fault(
            f"the header lacks {key}, or not in the form of K-NET; fetch the file again",
            said.line if said else None,
        )
    return [Statement(key, part.strip(), said.line) for part in match.groups()]
