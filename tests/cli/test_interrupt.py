"""Ctrl-C in the commands that have no search of their own to stop."""

import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from birdmb.cli import interrupt

from .conftest import HANGS, IBIS

# A shell that runs tests in the background has them ignore Ctrl-C.
SCRIPT = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    "from birdmb.cli import main; print('at work', flush=True); main()"
)


@pytest.mark.skipif(os.name != "posix", reason="sends a POSIX signal")
@pytest.mark.parametrize("command", ["validate", "sweep"])
def test_ctrl_c_at_a_random_moment(tmp_path, command):
    arguments = {
        "validate": [],
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


HALF_DONE = """
import os, signal, sys, time
from multiprocessing import process, resource_tracker, synchronize, util
from birdmb.cli.interrupt import ending_the_process
from birdmb.studies.sweeps.workers import process_pool

signal.signal(signal.SIGINT, signal.default_int_handler)
process.current_process()._config["semprefix"] = sys.argv[2]


keys = [signal.SIGINT]


def interrupt():
    if keys:
        os.kill(os.getpid(), keys.pop())
    time.sleep(0.2)


def unregistered(*name):
    interrupt()
    register(*name)


def never_unregistered(name):
    interrupt()


def without_its_data(path, arguments, *files):
    started = spawn(path, arguments, *files)
    if "spawn_main" in str(arguments):
        interrupt()
    return started


register, spawn = resource_tracker.register, util.spawnv_passfds
if sys.argv[1] == "semaphore half made":
    resource_tracker.register = unregistered
elif sys.argv[1] == "semaphore half given back":
    synchronize.SemLock._cleanup = never_unregistered
else:
    util.spawnv_passfds = without_its_data
with ending_the_process():
    with process_pool(1, None, None):
        pass
    time.sleep(60)
"""


@pytest.mark.skipif(not Path("/dev/shm").is_dir(), reason="looks for semaphores in /dev/shm")
@pytest.mark.parametrize(
    "when", ["semaphore half made", "semaphore half given back", "worker half made"]
)
def test_ctrl_c_when_workers_or_what_they_share_are_half_made(tmp_path, when):
    prefix = f"/{tmp_path.name}-{os.getpid()}"
    ended = subprocess.run(
        [sys.executable, "-c", HALF_DONE, when, prefix],
        capture_output=True,
        text=True,
        check=False,
        timeout=HANGS,
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "", "Interrupted.\n")
    # Python's resource tracker removes them after the process has ended, and where it was started
    # after the key it has no output by which its end would be seen.
    hangs_at = time.monotonic() + HANGS
    while list(Path("/dev/shm").glob(f"sem.{prefix[1:]}*")):
        assert time.monotonic() < hangs_at
        time.sleep(0.05)


def test_ctrl_c_pressed_twice_at_once_is_one_and_later_on_ends_what_hangs(monkeypatch):
    now, ended = [10.0], []
    monkeypatch.setattr(interrupt.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(interrupt.os, "_exit", ended.append)
    before = signal.signal(signal.SIGINT, interrupt._first_time)
    try:
        for now[0] in (10.0, 10.5, 11.5):
            assert ended == []
            signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)
    assert ended == [130]


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
