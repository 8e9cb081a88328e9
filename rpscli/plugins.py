"""Names with which a package of yours adds things to rps, by entry points
in its `pyproject.toml`.

Each entry point has a name, which users write, and belongs to one of these groups:

- `rpscli.formats`: a `RecordFormat` of files with ground motions, which is tried on files
  that none of ours but plain columns recognises;
- `rpscli.measures`: an `IntensityMeasure`, to scale records to and to
  stand on axes of reports;
- `rpscli.targets`: a function of the options behind ``NAME:`` and of the whole source
  that returns a `TargetSpectrum`, or raises `RecordError`;
- `rpscli.reports`: a `Report` of studies, a class of `ReportOptions` with a function of
  `StoredPoints` and such options that returns what was `Found`;
- `rpscli.dampers`: a `DamperLaw`, a kind of `podium.devices` whose force is compiled;
- `rpscli.impact_laws`: a `RestitutionLaw`, a law of `podium.impact`, likewise;
- `rpscli.figures`: a function that draws a result into axes, as those of `rpscli.figures`
  do; ``--figures png,NAME`` makes files of it;
- `rpscli.commands`: a `click.Command`, which is then `rps NAME`.

Names are letters, digits, _ and -; names of ours cannot be taken. What a function gives
must be of the kind that its annotation in rps says, and numbers finite: what is not, and
every error, is told as a fault of the package. Nothing of a package is imported before
one of its names is asked for; `rps explain plugins` lists all. What stands here changes
as slowly as `rpscli.__all__`. `rps init --package NAME` writes a package with one of
each.
"""

from __future__ import annotations

from rpscli.case.schema.fields import Quantity, Whole
from rpscli.case.study.reports import ReportOptions
from rpscli.errors import PluginError, RecordError
from rpscli.model.devices import OwnDamper
from rpscli.model.own import DamperLaw, RestitutionLaw
from rpscli.records.formats import RecordFormat
from rpscli.records.formats.record_text import RecordText
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import IntensityMeasure
from rpscli.records.source import parse_query
from rpscli.records.target import TargetSpectrum
from rpscli.report.figures.style import single
from rpscli.report.study.report import Found, Report
from rpscli.report.table import Column
from rpscli.sweep.table import StoredPoints, point_columns

__all__ = [
    "Column",
    "DamperLaw",
    "Found",
    "GroundMotion",
    "IntensityMeasure",
    "OwnDamper",
    "PluginError",
    "Quantity",
    "RecordError",
    "RecordFormat",
    "RecordText",
    "Report",
    "ReportOptions",
    "RestitutionLaw",
    "StoredPoints",
    "TargetSpectrum",
    "Whole",
    "parse_query",
    "point_columns",
    "single",
]
