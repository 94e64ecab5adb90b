"""The worker of a button: ``python -m grasp_xl.live COMMAND`` and what Excel gave the button."""

import sys

from grasp_xl.live.worker import work

if __name__ == "__main__":
    work(sys.argv[1])
