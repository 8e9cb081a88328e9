"""Write a case as a model for mujoco or OpenSees."""

OFFERS = {
    "commands": {"export": "rpscli.tools.export.command:command"},
}
