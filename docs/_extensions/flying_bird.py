"""The moving picture of the page on them: the package's ibis, as `birdmb show` has it."""

from __future__ import annotations

from pathlib import Path

from sphinx.application import Sphinx

import birdmb


def write(app: Sphinx, exception: Exception | None) -> None:
    """Write the page that the documentation frames."""
    if exception is None and app.builder.format == "html":
        ibis = birdmb.find_limit_cycle(birdmb.RigidModel(birdmb.load_bird("ibis")))
        ibis.animate().save(Path(app.outdir) / "_static" / "ibis.html")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.connect("build-finished", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
