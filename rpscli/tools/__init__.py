"""Tools that nobody needs in order to understand the program.

Each is whole in its folder: its keys, command, report and figures. A tool imports the
core; nothing in the core imports a tool, and no tool another. What a tool adds stands in
its `OFFERS`, by which `rpscli.registry` finds it.
"""
