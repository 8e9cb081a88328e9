"""A record format: a first line `TIDY dt=0.005 unit=cm/s2`, then one value a line."""

from __future__ import annotations

import re

import numpy as np

from rpscli.plugins import GroundMotion, RecordFormat, RecordText

HEAD = re.compile(r"TIDY dt=(\S+) unit=(\S+)")


def recognises(text: RecordText) -> bool:
    """Files whose first line is a head of TIDY."""
    return bool(text.lines) and HEAD.fullmatch(text.lines[0]) is not None


def read(text: RecordText) -> GroundMotion:
    """The motion; what the user says of step and unit may not contradict the file."""
    head = HEAD.fullmatch(text.lines[0])
    assert head is not None, "it was recognised"
    _, factor = text.agreed_factor(head[2])
    try:
        values = np.array([float(line) for line in text.lines[1:] if line.strip()])
    except ValueError as error:
        raise text.fault(f"{error}; write one number a line") from None
    dt = text.agreed_dt(float(head[1]))
    return GroundMotion(values * factor, dt, text.name, text.source, "TIDY")


TIDY = RecordFormat("TIDY", (".tidy",), recognises, read)
