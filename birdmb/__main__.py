"""`python -m birdmb`: the command line."""

from __future__ import annotations

from birdmb.cli import main

main()
