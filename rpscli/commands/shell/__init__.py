"""Parts that every command shares: options, streams, tables, errors and exit codes."""
