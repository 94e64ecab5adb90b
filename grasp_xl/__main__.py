"""``python -m grasp_xl``: the same as the command ``grasp-xl``."""

from grasp_xl.cli import entry

if __name__ == "__main__":
    entry()
