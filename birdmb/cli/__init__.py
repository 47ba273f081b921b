"""The command line: `birdmb` and `python -m birdmb`.

Only what a command needs is imported, and when it needs it: help and mistakes in the arguments are
answered at once, and Ctrl-C ends the imports like everything else.
"""

from birdmb.cli.interrupt import ending_the_process


def main() -> None:
    """Run the command line."""
    with ending_the_process():
        from birdmb.cli.app import app  # noqa: PLC0415 - it imports typer
        from birdmb.cli.streams import standard_streams  # noqa: PLC0415 - so does this

        with standard_streams():
            app()
