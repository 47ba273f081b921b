"""`python -m birdmb.reproduction`: draws the figures and tables of the thesis."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from birdmb.errors import ArgumentError, BirdmbError
from birdmb.figures.page import paper
from birdmb.figures.saving import formats_of
from birdmb.files import make_directory
from birdmb.reproduction.figures import DRAWINGS
from birdmb.reproduction.figures.drawing import kept_as


def main(arguments: Sequence[str] | None = None) -> int:
    """Draw what the arguments name, or all; return the exit status."""
    options = _options().parse_args(arguments)
    if options.list:
        for name, drawing in DRAWINGS.items():
            print(f"{name:20} {drawing.title}")
        return 0
    try:
        names = list(_names(options.figure, options.table))
        formats = formats_of(options.format)
        make_directory(options.out)
        for number, name in enumerate(names, 1):
            print(f"{number}/{len(names)} {name}: {DRAWINGS[name].title}", file=sys.stderr)
            with paper(options.width), kept_as(formats):
                DRAWINGS[name].draw(options.out, options.coarse)
    except BirdmbError as error:
        print(f"Error: {' '.join(str(error).split())}", file=sys.stderr)
        return 2 if isinstance(error, ValueError) else 1
    except KeyboardInterrupt:
        print("Interrupted.", file=sys.stderr)
        return 130
    return 0


def _options() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m birdmb.reproduction", description=__doc__)
    known = "--list names them; repeatable"
    parser.add_argument("--figure", action="append", default=[], metavar="N", help=f"5.12; {known}")
    parser.add_argument("--table", action="append", default=[], metavar="N", help=f"6.2; {known}")
    parser.add_argument("--list", action="store_true", help="list the figures and tables")
    parser.add_argument("--coarse", action="store_true", help="few points and elements: quick")
    parser.add_argument(
        "--out", type=Path, default=Path("results"), metavar="DIR", help="default: results"
    )
    parser.add_argument("--format", default="png", metavar="LIST", help="as pdf,svg,png")
    parser.add_argument("--width", metavar="WIDTH", help="of a paper's column, as 90mm")
    return parser


def _names(figures: Sequence[str], tables: Sequence[str]) -> Iterator[str]:
    wanted = [f"figure {n}" for n in figures] + [f"table {n}" for n in tables]
    for name in wanted or DRAWINGS:
        if name not in DRAWINGS:
            raise ArgumentError(f"no {name} of the thesis is drawn here; --list names all.")
        yield name


if __name__ == "__main__":
    sys.exit(main())
