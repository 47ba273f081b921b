"""The command `birdmb birds`."""

from __future__ import annotations

import json
from typing import Any

import typer
from rich.padding import Padding
from rich.text import Text

from birdmb.cli.console import output
from birdmb.topology import load_bird
from birdmb.topology.shipped import bird_names, summary, topology_file
from birdmb.wing.outline import span_and_area


def run(*, as_json: bool) -> None:
    """List the birds that come with the package."""
    found = [_told(name) for name in bird_names()]
    if as_json:
        typer.echo(json.dumps(found, indent=2))
        return
    console = output()
    for bird in found:
        compliant = f", compliant: {', '.join(bird['compliant'])}" if bird["compliant"] else ""
        size = f"{bird['mass']:.4g} kg, span {bird['span']:.3g} m, {bird['frequency']:.3g} Hz"
        console.print(Text(f"{bird['name']}  ", "bold") + Text(f"{size}{compliant}", "default"))
        console.print(Padding(str(bird["summary"]), (0, 0, 1, 4)), highlight=False)
    console.print("Fly one: birdmb cycle NAME. Copy one: birdmb new FILE --like NAME.")


def _told(name: str) -> dict[str, Any]:
    path = topology_file(name)
    bird = load_bird(path)
    span, area = span_and_area(bird)
    return {
        "name": name,
        "summary": summary(path),
        "mass": bird.total_mass,
        "span": span,
        "area": area,
        "frequency": bird.gait.frequency,
        "compliant": [joint.name for joint in bird.compliant_joints]
        + [feather.hinge_name for feather in bird.hinged_feathers],
    }
