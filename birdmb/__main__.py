"""`python -m birdmb`: the command line."""

from birdmb.cli import main

main()
