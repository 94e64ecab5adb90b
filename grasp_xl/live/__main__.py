"""The worker of a button: ``python -m grasp_xl.live COMMAND CLAIM``, then what Excel gave it."""

import sys

from grasp_xl.live.worker import work

if __name__ == "__main__":
    work(*sys.argv[1:3])
