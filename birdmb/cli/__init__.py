"""The command line: `birdmb` and `python -m birdmb`.

Only what a command needs is imported, and when it needs it: help and mistakes in the arguments are
answered at once, and Ctrl-C ends the imports like everything else.
"""

import os
import signal


def main() -> None:
    """Run the command line."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # Until what ends the process otherwise is imported.
        signal.signal(signal.SIGINT, lambda *_: os._exit(130))
    from birdmb.cli.interrupt import ending_the_process  # noqa: PLC0415 - slow to import

    with ending_the_process():
        from birdmb.cli.app import app  # noqa: PLC0415 - it imports typer
        from birdmb.cli.console import fit_help  # noqa: PLC0415 - it imports typer
        from birdmb.cli.streams import standard_streams  # noqa: PLC0415 - so does this

        with standard_streams():
            fit_help(app)
            app()
