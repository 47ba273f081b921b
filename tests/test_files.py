"""Files are whole or as they were, and nothing is left beside them."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from birdmb import files
from birdmb.errors import OutputError


def names(directory):
    return sorted(file.name for file in directory.iterdir())


def test_a_file_is_written_and_replaced(tmp_path):
    path = tmp_path / "a.txt"
    assert files.write_whole(path, b"one") == path
    files.write_whole(str(path), b"two")
    assert path.read_bytes() == b"two"
    assert names(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("failure", [OSError(errno.ENOSPC, "full"), KeyboardInterrupt()])
@pytest.mark.parametrize("where", ["fsync", "replace"])
def test_what_fails_leaves_the_older_file_and_no_draft(tmp_path, monkeypatch, failure, where):
    path = tmp_path / "a.txt"
    path.write_bytes(b"one")

    def fail(*_):
        raise failure

    monkeypatch.setattr(*((os, "fsync") if where == "fsync" else (Path, "replace")), fail)
    with pytest.raises((OutputError, KeyboardInterrupt)) as caught:
        files.write_whole(path, b"two")
    monkeypatch.undo()
    if isinstance(failure, OSError):
        assert str(caught.value) == (
            f"{path} cannot be written (full; free some space and try again)."
        )
    assert path.read_bytes() == b"one"
    assert names(tmp_path) == ["a.txt"]


def test_content_and_name_are_on_the_disk_before_and_after_the_replacement(tmp_path, monkeypatch):
    order, fsync, replace = [], os.fsync, Path.replace

    def synced(descriptor):
        order.append("directory" if os.path.isdir(descriptor) else "content")  # noqa: PTH112
        fsync(descriptor)

    def replaced(draft, target):
        order.append("replaced")
        return replace(draft, target)

    monkeypatch.setattr(os, "fsync", synced)
    monkeypatch.setattr(Path, "replace", replaced)
    files.write_whole(tmp_path / "a.txt", b"one")
    assert order == ["content", "replaced", "directory"]


@pytest.mark.skipif(os.name != "posix", reason="asks for processes as POSIX does")
def test_drafts_of_killed_processes_are_removed_and_no_others(tmp_path):
    with subprocess.Popen([sys.executable, "-c", ""]) as ended:
        pass
    mine = tmp_path / f".a.txt.{os.getppid()}.draft"
    for name in (f".a.txt.{ended.pid}.draft", mine.name, f".b.txt.{ended.pid}.draft", "c.draft"):
        (tmp_path / name).touch()
    files.write_whole(tmp_path / "a.txt", b"one")
    assert names(tmp_path) == sorted([mine.name, f".b.txt.{ended.pid}.draft", "a.txt", "c.draft"])


@pytest.mark.skipif(os.name != "posix", reason="has links and devices as POSIX has")
def test_links_stay_links_and_devices_devices(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link.txt").symlink_to(tmp_path / "real" / "a.txt")
    files.write_whole(tmp_path / "link.txt", b"one")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real" / "a.txt").read_bytes() == b"one"
    files.write_whole(os.devnull, b"one")
    assert not Path(os.devnull).is_file()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no device that is full")
def test_a_device_that_is_full_is_said():
    with pytest.raises(OutputError, match="/dev/full cannot be written"):
        files.write_whole("/dev/full", b"one")


@pytest.mark.parametrize(
    ("name", "says"), [("", "is a directory"), ("a\0b", "null"), ("no/where", "no such file")]
)
def test_places_that_cannot_be_written(tmp_path, name, says):
    with pytest.raises(OutputError, match=says):
        files.write_whole(f"{tmp_path}/{name}", b"one")
    assert names(tmp_path) == []


def test_interrupted_drafts_are_removed_and_those_of_others_stay(tmp_path):
    other = tmp_path / ".a.txt.1.draft"
    for draft in (tmp_path / f".a.txt.{os.getpid()}.draft", other):
        draft.touch()
    files.remove_drafts(tmp_path)
    assert names(tmp_path) == [other.name]
