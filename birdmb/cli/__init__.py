"""The command line: `birdmb` and `python -m birdmb`.

Only what a command needs is imported, and when it needs it: help and mistakes in the arguments are
answered at once.
"""

from birdmb.cli.app import main

__all__ = ["main"]
