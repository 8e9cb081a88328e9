"""K-NET and KiK-net ASCII files: counts of one component, to be scaled and centred."""

from __future__ import annotations

import re

import numpy as np

from rpscli.records.formats.channels import peak_warnings
from rpscli.records.formats.record_text import RecordText
from rpscli.records.ground_motion import GroundMotion

_KEYS = 17
_SCALE = re.compile(r"([0-9.]+)\s*\(gal\)\s*/\s*([0-9.]+)")
_RATE = re.compile(r"([0-9.]+)\s*Hz")


def recognises_knet(text: RecordText) -> bool:
    """Whether the header has the keys of K-NET."""
    head = "\n".join(text.lines[:_KEYS])
    return head.startswith("Origin Time") and "Scale Factor" in head


def read_knet(text: RecordText) -> GroundMotion:
    """Read a K-NET or KiK-net file; the mean of the record is removed, and that is said.

    The counts carry the offset of the sensor. The agency's own peak is that about the mean.
    """
    text.single_channel()
    header = {line[:18].strip(): line[18:].strip() for line in text.lines[:_KEYS]}
    scale = _SCALE.search(header.get("Scale Factor", ""))
    rate = _RATE.search(header.get("Sampling Freq(Hz)", ""))
    duration = header.get("Duration Time(s)", "")
    if not (scale and rate and re.fullmatch(r"[0-9.]+", duration)):
        raise text.fault("the header lacks the scale factor, the sampling rate or the duration")
    count = round(float(duration) * float(rate[1]))
    _, factor = text.agreed_factor("gal")
    values = np.array(text.values(_KEYS, count)) * (float(scale[1]) / float(scale[2]))
    mean = float(values.mean())
    peak = header.get("Max. Acc. (gal)", "")
    station = f"{header.get('Station Code', '')} {header.get('Dir.', '')}".strip()
    return GroundMotion(
        (values - mean) * factor,
        text.agreed_dt(1.0 / float(rate[1])),
        text.path.name.replace(".", "_"),  # the extension tells the component
        text.source,
        "K-NET ASCII",
        f"{station}, {header['Origin Time']}; values in gal; mean of {mean:.4g} gal removed",
        peak_warnings(values - mean, float(peak), 1e-3) if re.fullmatch(r"[0-9.]+", peak) else (),
    )
