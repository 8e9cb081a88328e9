"""`rps record`: one module a subcommand."""
