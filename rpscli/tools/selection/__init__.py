"""Motions and factors that fit a spectrum."""

OFFERS = {
    "page_sections": {"target": "rpscli.tools.selection.section:SECTION"},
    "record_commands": {"select": "rpscli.tools.selection.command:command"},
}
