"""The command ``grasp-xl``, and ``python -m grasp_xl``."""

import sys


def entry() -> None:
    """Load the command line and start it; Ctrl-C while it loads ends it in a sentence, too."""
    try:
        from grasp_xl.cli.program import entry as start
    except KeyboardInterrupt:
        sys.stderr.write("Interrupted; nothing was written.\n")
        sys.exit(130)
    start()


if __name__ == "__main__":
    entry()
