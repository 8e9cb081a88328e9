"""Values of a case that meet limits and minimise an objective."""

OFFERS = {
    "commands": {"design": "rpscli.tools.design.command:command"},
    "files": {"design": "rpscli.tools.design.format:DESIGN"},
    "pages": {"design": "rpscli.tools.design.page:design_page"},
}
