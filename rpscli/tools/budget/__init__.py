"""Sensitivity of limited results and verdicts."""

OFFERS = {
    "commands": {"budget": "rpscli.tools.budget.command:command"},
    "page_sections": {"budget": "rpscli.tools.budget.section:SECTION"},
}
