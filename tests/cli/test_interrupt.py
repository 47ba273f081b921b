"""Ctrl-C in the commands that have no search of their own to stop."""

import os
import random
import signal
import subprocess
import sys
import threading

import pytest

from birdmb.cli import interrupt

from .conftest import IBIS, TOPOLOGIES

# A shell that runs tests in the background has them ignore Ctrl-C.
SCRIPT = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    "from birdmb.cli import main; print('at work', flush=True); main()"
)


@pytest.mark.skipif(os.name != "posix", reason="sends a POSIX signal")
@pytest.mark.parametrize("command", ["validate", "sweep"])
def test_ctrl_c_at_a_random_moment(tmp_path, command):
    arguments = {
        "validate": ["--topologies", str(TOPOLOGIES)],
        "sweep": [
            IBIS, "--vary", "shoulder.flap.amplitude_deg=38:46:200", "--store",
            str(tmp_path / "s.db"), "--workers", "2",
        ],
    }[command]  # fmt: skip
    with subprocess.Popen(
        [sys.executable, "-c", SCRIPT, command, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        threading.Event().wait(random.Random(command).uniform(0.5, 3.0))
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
    assert process.returncode == 130
    assert errors.splitlines()[-1] == "Interrupted."
    assert "Traceback" not in errors
    assert "leaked" not in errors


def test_what_is_left_is_tidied_also_where_ctrl_c_is_an_exception():
    tidied = []
    with pytest.raises(KeyboardInterrupt), interrupt.tidied(lambda: tidied.append(1)):
        raise KeyboardInterrupt
    assert tidied == [1]
    assert interrupt._tidying == []


def test_where_ctrl_c_is_ignored_it_stays_so():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with interrupt.ending_the_process():
            assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
