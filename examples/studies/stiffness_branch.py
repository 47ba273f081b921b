"""The ibis with an ever softer shoulder: the fold in which its flight ends, and how it is known.

Run `python examples/studies/stiffness_branch.py [DIRECTORY]` for the branch from 60 to 2 N m/rad:
its picture goes to the directory, and a run that was stopped goes on. With `--evidence` instead of
a directory it prints what tells that the branch turns, with `--refined` where the fold is on other
wings, with other steps and inertias; `--coarse` is a quick piece of the branch on a coarse wing.
"""

import argparse
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

import birdmb
from birdmb.figures import plot_bird_branch
from birdmb.orbits import Bifurcation, BranchPoint, Steps
from birdmb.orbits.newton import Damping
from birdmb.studies import bird_branch

IBIS = Path(__file__).parents[2] / "topologies" / "ibis_compliant_shoulder.toml"
STIFFNESS = "shoulder.flap.stiffness"


def table_row(item: BranchPoint | Bifurcation) -> None:
    if isinstance(item, Bifurcation):
        print(f"{item.kind} at {item.parameter:.6f} +- {item.parameter_error:.0e}:")
        item = item.point
    seen = item.observables
    print(
        f"{item.parameter:12.6f}  {np.abs(item.multipliers[0]):8.5f}  {item.stability:9s}  "
        f"{seen['mean_speed']:7.3f}  {seen['mean_climb_rate']:+7.3f}  {seen['power']:7.2f}  "
        f"{np.degrees(seen['mean_pitch']):7.1f}  "
        f"{np.degrees(seen['largest_angle_of_attack']):7.1f}  {seen['reduced_frequency']:6.3f}",
        flush=True,
    )


def whole_branch(bird: birdmb.Bird, directory: Path, lowest: float) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    store = directory / "stiffness_branch.nc"
    kept = birdmb.load_branch(store) if store.exists() else None
    print(
        " k, N m/rad    |L|max  stability    speed    climb    power    pitch   attack   k_red\n"
        "                                      m/s      m/s        W      deg      deg"
    )
    branch = bird_branch(
        bird, STIFFNESS, (60.0, lowest), resume=kept, store=store, callback=table_row
    )
    plot_bird_branch(branch).savefig(directory / "stiffness_branch.png", dpi=100)


def evidence(bird: birdmb.Bird) -> None:
    family = partial(member, bird)
    branch = bird_branch(bird, STIFFNESS, (6.6, 5.5), max_bifurcations=1, steps=Steps(longest=0.2))
    (fold,) = branch.bifurcations
    at_fold = fold.point.observables["mean_speed"]
    print(
        f"fold at k = {fold.parameter:.6f}: {at_fold:.3f} m/s, closure {fold.point.residual:.0e}, "
        f"multipliers {fold.point.multipliers[0]:.6f}, {fold.point.multipliers[1]:.6f}"
    )
    ends = [branch.points[i].points - fold.point.points for i in (-2, -1)]
    print("distance above the fold: speed, (its change)^2 over the distance, first two multipliers")
    for distance in (1e-3, 1e-2):
        for towards in ends:
            model = family(fold.parameter + distance)
            cycle = birdmb.find_limit_cycle(model, fold.point.points + 0.3 * towards)
            print(
                f"  {distance:.0e}: {cycle.mean_speed:.3f} m/s, "
                f"{(cycle.mean_speed - at_fold) ** 2 / distance:.2f}, "
                f"{cycle.multipliers[0]:.5f}, {cycle.multipliers[1]:.5f}: {cycle.stability}",
                flush=True,
            )
    print("distance below the fold: what searches from the flight at the fold end with")
    for distance in (1e-3, 1e-2, 1e-1):
        for damping in ("line-search", "levenberg-marquardt"):
            outcome = searched(family(fold.parameter - distance), fold, damping)
            print(f"  {distance:.0e}, {damping}: {outcome}", flush=True)


def member(bird: birdmb.Bird, stiffness: float) -> birdmb.MultibodyModel:
    return birdmb.MultibodyModel(bird.with_values({STIFFNESS: stiffness}))


def searched(model: birdmb.MultibodyModel, fold: Bifurcation, damping: Damping) -> str:
    try:
        cycle = birdmb.find_limit_cycle(
            model, fold.point.points[0], method="shooting", damping=damping, max_iterations=25
        )
    except birdmb.ConvergenceError as error:
        return f"no cycle, best closure {error.residual:.1e}"
    return f"a cycle at {cycle.mean_speed:.2f} m/s, pitch {np.degrees(cycle.x0[3]):.0f} deg"


def variations() -> Iterator[tuple[str, dict[str, object], int | None]]:
    yield "as it is: 32 elements, collocation", {}, None
    for elements in (16, 48):
        yield f"{elements} elements", {"wing.discretisation.elements": elements}, None
    for steps in (60, 240):
        yield f"shooting, {steps} steps per beat", {}, steps
    yield "published wing", {"wing.discretisation": "published"}, None
    for inertia in (0.0003, 0.002):
        values: dict[str, object] = {
            f"segments.{bone}.inertia": [inertia] * 3 for bone in ("humerus", "forearm", "hand")
        }
        yield f"inertia {inertia} kg m2 of each segment", values, None


def refined(bird: birdmb.Bird) -> None:
    for label, values, steps_per_beat in variations():
        branch = bird_branch(
            bird.with_values(values),
            STIFFNESS,
            (10.0, 3.0),
            steps_per_beat=steps_per_beat,
            max_bifurcations=1,
            steps=Steps(first=0.1, longest=0.4),
            max_points=60,
        )
        for found in branch.bifurcations:
            seen = found.point.observables
            print(
                f"{label}: {found.kind} at {found.parameter:.6f} +- {found.parameter_error:.0e}, "
                f"{seen['mean_speed']:.2f} m/s, attack "
                f"{np.degrees(seen['largest_angle_of_attack']):.1f} deg, error of the states "
                f"{seen['integration_error']:.0e}",
                flush=True,
            )
        if not branch.bifurcations:
            why = branch.stopped.reason if branch.stopped else "the end of the range"
            print(f"{label}: no bifurcation up to {branch.parameters[-1]:.4f}, {why}", flush=True)


def main(options: argparse.Namespace) -> None:
    bird = birdmb.load_bird(IBIS)
    if options.evidence:
        evidence(bird)
    elif options.refined:
        refined(bird)
    elif options.coarse:
        whole_branch(bird.with_values({"wing.discretisation": 4}), options.directory, 58.0)
    else:
        whole_branch(bird, options.directory, 2.0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    for name in ("evidence", "refined", "coarse"):
        parser.add_argument(f"--{name}", action="store_true")
    main(parser.parse_args())
