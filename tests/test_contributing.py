"""What CONTRIBUTING.md names is there."""

import re
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_the_files_that_it_names_exist():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    named = [word for code in re.findall(r"`([^`]+)`", text) for word in code.split()]
    paths = {word for word in named if re.fullmatch(r"[.\w/]+/[\w.]*", word)}
    assert len(paths) > 15
    assert [path for path in sorted(paths) if not (ROOT / path).exists()] == []
