"""The list of experiments."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.errors import ArgumentError
from birdmb.studies.experiments import (
    derivatives,
    jackdaw,
    scherer,
    section,
    sprung_plate,
    yeo,
)
from birdmb.studies.experiments.comparison import Experiment

EXPERIMENTS: Mapping[str, Experiment] = {
    module.EXPERIMENT.case: module.EXPERIMENT
    for module in (scherer, yeo, section, sprung_plate, derivatives, jackdaw)
}


def experiments(case: str | None = None) -> list[Experiment]:
    """All experiments, or that of one letter.

    Raises:
        ArgumentError: no experiment has the letter.
    """
    if case is None:
        return list(EXPERIMENTS.values())
    if case.upper() not in EXPERIMENTS:
        raise ArgumentError(f"the cases are {', '.join(EXPERIMENTS)}, not {case}.")
    return [EXPERIMENTS[case.upper()]]
