"""Comparison of a study with what was observed in tests or after earthquakes."""

OFFERS = {
    "keys": {"observed": "rpscli.tools.comparison.key:OBSERVED"},
    "reports": {"comparison": "rpscli.tools.comparison.report:REPORT"},
}
