"""`python docs/_extensions/check_site.py build/site`: is what was built all that it should be?"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import birdmb

# What a page would fetch by itself; links that a reader may follow are another thing.
FETCHED = re.compile(r"""<(?:script|img|link|iframe)[^>]+(?:src|href)=["'](?:https?:)?//[^"']+""")
NO_FETCH = re.compile(r'rel="(?:canonical|license)"')


def missing(site: Path) -> list[str]:
    """What is wrong with a site, in sentences."""
    wrong = []
    for name in birdmb.__all__:
        page = site / "python" / f"{name}.html"
        if not page.exists():
            wrong.append(f"{name} has no page.")
            continue
        text = page.read_text(encoding="utf-8")
        if f'id="birdmb.{name}"' not in text:
            wrong.append(f"The page of {name} does not describe it.")
        if "sphx-glr-thumbcontainer" not in text:
            wrong.append(f"No example uses {name}; let one of examples/ do so.")
    for page in site.rglob("*.html"):
        for found in FETCHED.findall(page.read_text(encoding="utf-8")):
            if not NO_FETCH.search(found):
                wrong.append(f"{page.relative_to(site)} fetches {found.split('//')[1]}.")
    return wrong


if __name__ == "__main__":
    sentences = missing(Path(sys.argv[1]))
    print("\n".join(sentences) or "Each public name has a page and an example.")
    sys.exit(bool(sentences))
