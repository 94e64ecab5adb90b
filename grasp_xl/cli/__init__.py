"""The command line: options in, one sentence or one JSON object out, and an exit code."""
