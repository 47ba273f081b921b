"""What CONTRIBUTING.md names is there, and the citation is of this version."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_the_files_that_it_names_exist():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    sentences = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    named = [word for code in re.findall(r"`([^`]+)`", sentences) for word in code.split()]
    named += re.findall(r"\]\(([^)]+)\)", sentences)
    paths = {word for word in named if re.fullmatch(r"[.\w/]+/[\w.]*", word)}
    assert len(paths) > 20
    assert [path for path in sorted(paths) if not (ROOT / path).exists()] == []


def test_the_citation_is_of_this_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {project['version']}\n" in citation
    assert f"\nlicense: {project['license']}\n" in citation
