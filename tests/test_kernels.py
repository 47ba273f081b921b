"""Compiled kernels outlive what happens to the files that they are kept in."""

import os
import re
import subprocess
import sys
import textwrap
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

import pytest

import birdmb
from birdmb._kernel_files import KernelCacheWarning, cache_folders, config
from birdmb._kernels import _LightCompiler, kernel

HANGS = 900  # s
BASE = 10.0


def inner(x):
    return x + 1.0


def other_inner(x):
    return x + 2.0


def outer(x):
    return 2.0 * called(x)


called = kernel(inner)


def added(x):
    return x + BASE


def refusing(x):
    if x < 0.0:
        raise ValueError("negative", x)  # its arguments are made by Python code
    return x


def calling_twice(x):
    return called(x) + called(x + 1.0) + refused(x)


refused = kernel(refusing)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """The folder of the compiled kernels, empty and of this test alone."""
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path))
    monkeypatch.setitem(globals(), "called", kernel(inner))
    monkeypatch.setitem(globals(), "refused", kernel(refusing))
    (folder,) = cache_folders()
    return folder


def fresh(function):
    """What a new process gets at 3: the value, and whether it had to be compiled."""
    dispatcher = kernel(function)
    value = dispatcher(3.0)
    return value, not dispatcher.stats.cache_hits


def truncated(path):
    path.write_bytes(path.read_bytes()[:-1000])


def with_a_flipped_bit(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


DAMAGES = {
    "truncated": truncated,
    "flipped": with_a_flipped_bit,
    "empty": lambda path: path.write_bytes(b""),
    "foreign": lambda path: path.write_bytes(b"PK\x03\x04" * 1000),
    "gone": Path.unlink,
}


def test_damaged_files_are_compiled_again(cache):
    assert fresh(inner) == (4.0, True)
    (path,) = cache.iterdir()
    for name, damage in DAMAGES.items():
        assert fresh(inner) == (4.0, False), name
        damage(path)
        assert fresh(inner) == (4.0, True), name
    assert list(cache.iterdir()) == [path]


def test_a_file_under_the_name_of_another_is_not_taken_for_it(cache):
    fresh(inner)
    (path,) = cache.iterdir()
    fresh(added)
    (another,) = set(cache.iterdir()) - {path}
    path.write_bytes(another.read_bytes())
    assert fresh(inner) == (4.0, True)


def test_a_change_in_a_kernel_that_is_called_is_seen(cache, monkeypatch):
    assert fresh(outer) == (8.0, True)
    assert fresh(outer) == (8.0, False)
    monkeypatch.setitem(globals(), "called", kernel(other_inner))
    assert fresh(outer) == (10.0, True)
    of_outer = [path.name for path in cache.iterdir() if ".outer." in path.name]
    assert len(of_outer) == 1  # what is stale is removed


def test_a_kernel_that_kernels_call_is_compiled_once_and_not_for_python(cache):
    assert fresh(outer) == (8.0, True)
    assert fresh(calling_twice) == (12.0, True)
    assert called.signatures == []
    assert len(list(cache.iterdir())) == 4
    assert called(3.0) == 4.0  # for Python after all
    assert len(called.signatures) == 1


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_code_for_callers_is_kept_and_damage_to_it_is_harmless(cache, monkeypatch, damage):
    fresh(outer)
    (path,) = (path for path in cache.iterdir() if ".inner." in path.name)
    kept = path.read_bytes()

    def with_a_callee_of_a_new_process():
        monkeypatch.setitem(globals(), "called", kernel(inner))
        return fresh(calling_twice)[0]

    before = path.stat().st_mtime_ns
    assert with_a_callee_of_a_new_process() == 12.0
    assert (path.stat().st_mtime_ns, path.read_bytes()) == (before, kept)  # read
    for caller in cache.glob("*.calling_twice.*"):
        caller.unlink()
    damage(path)
    damaged = path.read_bytes() if path.exists() else b""
    assert with_a_callee_of_a_new_process() == 12.0
    again = path.read_bytes()
    assert again != damaged
    assert sha256(again[32:]).digest() == again[:32]  # written whole


@pytest.mark.usefixtures("cache")
def test_what_a_called_kernel_raises_reaches_python():
    for _ in "compiled", "read from its file":
        with pytest.raises(ValueError, match="negative") as raised:
            kernel(calling_twice)(-1.0)
        assert raised.value.args == ("negative", -1.0)


def test_a_change_in_a_constant_is_seen(cache, monkeypatch):
    assert fresh(added) == (13.0, True)
    monkeypatch.setitem(globals(), "BASE", 20.0)
    assert fresh(added) == (23.0, True)
    assert len(list(cache.iterdir())) == 1


def test_no_folder_to_write_to_is_one_warning(monkeypatch, tmp_path):
    (tmp_path / "file").touch()  # a folder below it cannot be made, not even by root
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path / "file"))
    with pytest.warns(KernelCacheWarning, match="let NUMBA_CACHE_DIR name a folder") as warned:
        values = [fresh(inner), fresh(added)]
    assert values == [(4.0, True), (13.0, True)]
    assert len(warned) == 1
    assert f"cannot be kept in {tmp_path / 'file'}" in str(warned[0].message)


def test_installation_that_cannot_be_written_is_still_read(monkeypatch, tmp_path):
    package, users = tmp_path / "package", tmp_path / "users"
    monkeypatch.setattr("birdmb._kernel_files.cache_folders", lambda: [package, users])
    fresh(inner)
    (kept,) = package.iterdir()
    assert fresh(inner) == (4.0, False)
    package.rename(users)
    package.touch()  # no folder any more
    assert fresh(inner) == (4.0, False)
    assert fresh(added) == (13.0, True)
    assert fresh(added) == (13.0, False)
    assert len(list(users.iterdir())) == 2
    assert (users / kept.name).exists()


def test_without_a_home_nothing_is_written_where_the_process_happens_to_be(monkeypatch):
    monkeypatch.setattr("numba.core.config.CACHE_DIR", "")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr("os.path.expanduser", lambda path: path)  # as if there were no user
    assert cache_folders() == [Path(birdmb.__file__).parent / "__pycache__"]


def test_a_command_says_in_one_line_where_its_kernels_cannot_be_kept(tmp_path):
    (tmp_path / "file").touch()
    script = (
        "from birdmb.cli.outcome import reported; from tests.test_kernels import fresh, inner\n"
        "with reported(): print(fresh(inner))"
    )
    result = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "file")},
        cwd=Path(__file__).parents[1],
        capture_output=True,
        text=True,
        timeout=HANGS,
        check=True,
    )
    assert result.stdout == "(4.0, True)\n"
    assert len(result.stderr.splitlines()) == 1
    assert result.stderr.startswith(f"Warning: The compiled kernels cannot be kept in {tmp_path}")


def test_all_kernels_are_kept_in_this_way():
    package = Path(birdmb.__file__).parent
    others = {
        path.name
        for path in package.rglob("*.py")
        if re.search(r"\bn?jit\b", path.read_text(encoding="utf-8"))
    }
    assert others == {"_kernel_files.py"}


@pytest.mark.parametrize("fails", [False, True])
def test_kernels_are_optimised_lightly_and_others_as_before(monkeypatch, fails):
    seen = []

    class Result:
        def _find_referenced_environments(self):
            return []

    class Compiler:
        name = "numba's"

        def compile(self, *arguments):
            seen.append((int(config.OPT), arguments))
            if fails:
                raise ValueError
            return Result()

    before = config.OPT
    monkeypatch.setattr(config, "OPT", type(before)(3))
    compiler = _LightCompiler(Compiler())
    with suppress(ValueError):
        compiler.compile("arguments", "return type")
    assert seen == [(1, ("arguments", "return type"))]
    assert config.OPT == 3
    assert compiler.name == "numba's"


@pytest.mark.long
def test_a_signal_while_a_kernel_runs_is_raised_when_it_returns():
    """Its handler raises where numba makes the named tuple of the result; see `birdmb._boxing`."""
    stopped = textwrap.dedent("""
        import signal
        import numpy as np
        import birdmb

        class Stopped(Exception):
            pass

        def stop(*_):
            raise Stopped

        model = birdmb.RigidModel(birdmb.load_bird("ibis").with_values({"wing.discretisation": 8}))
        times = np.linspace(0.0, 0.2, 2000)
        states = np.tile(model.initial_guess(), (times.size, 1))
        model.loads_along(times, states)
        signal.signal(signal.SIGALRM, stop)
        stops = 0
        while stops < 20:
            try:
                signal.setitimer(signal.ITIMER_REAL, 1e-3)
                while True:
                    model.loads_along(times, states)
            except Stopped:
                stops += 1
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        print("stopped", stops)
    """)
    done = subprocess.run(
        [sys.executable, "-c", stopped], check=False, capture_output=True, text=True
    )
    assert (done.returncode, done.stdout) == (0, "stopped 20\n"), done.stderr
