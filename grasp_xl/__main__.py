"""``python -m grasp_xl``: the same as the command ``grasp-xl``."""

import sys

from grasp_xl.cli import main

if __name__ == "__main__":
    sys.exit(main())
