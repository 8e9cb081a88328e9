"""Properties of a case from measured motion."""

OFFERS = {
    "commands": {"identify": "rpscli.tools.identify.command:command"},
}
