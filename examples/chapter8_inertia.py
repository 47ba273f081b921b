"""Chapter 8 along the inertia of the wings: python examples/chapter8_inertia.py [DIR].

Follows the limit cycle of each of the five published pairs of stiffness and damping while the same
moment of inertia is added about every axis of every segment, from none (slender bones) to the
printed 0.01 kg m2; prints where the branches turn, change their stability and meet the published
values, and draws them as far as the two wings do not swing through one another. Branches are kept
in DIR (default results/); a run that was stopped goes on with them. At 16 elements a wing and 60
steps a beat, some minutes.
"""

import functools
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import birdmb
from birdmb.orbits import Branch, Steps, continue_branch, load_branch
from birdmb.studies import flight_observables

TOPOLOGY = Path(__file__).parent.parent / "topologies" / "ibis_compliant_shoulder.toml"
# k (N m/rad), C (N m s/rad): |Lambda| max, P_act (W), P_g (W)
PUBLISHED = {
    (20.0, 0.2): (1.37, 1.42, 7.41),
    (15.0, 0.2): (1.31, 0.25, 8.90),
    (10.0, 0.2): (1.22, -2.18, 11.92),
    (20.0, 0.1): (1.39, 0.33, 8.45),
    (20.0, 0.0): (1.45, -3.76, 12.55),
}
QUANTITIES = ("|Λ|max", "P_act (W)", "P_g (W)")
BONES = ("humerus", "forearm", "hand")
PRINTED = 0.01  # kg m2
ELEMENTS, STEPS_PER_BEAT = 16, 60
MOST_POINTS = 24  # by then most wings have swung through one another
VALID = np.radians(15.0)
UPRIGHT = np.radians(90.0)  # there the two wings meet


def with_added_inertia(bird: birdmb.Bird, moment: float) -> birdmb.MultibodyModel:
    """The bird with this moment (kg m2) added about every axis of every segment."""
    heavier = {
        f"segments.{bone}.inertia": np.add(
            getattr(bird.segments, bone).inertia, moment * np.eye(3)
        ).tolist()
        for bone in BONES
    }
    return birdmb.MultibodyModel(
        bird.with_values(heavier), steps_per_beat=STEPS_PER_BEAT, integrator="explicit"
    )


def followed(k: float, c: float, directory: Path) -> Branch:
    """The branch of one pair of stiffness and damping, computed or as it was kept."""
    bird = birdmb.load_bird(TOPOLOGY).with_values({"wing.discretisation": ELEMENTS})
    bird = bird.with_joint("shoulder.flap", stiffness=k, damping=c)
    store = directory / f"inertia_{k:g}_{c:g}.nc"
    kept = load_branch(store) if store.exists() else None
    if kept is not None and (kept.stopped is None or "interrupted" not in kept.stopped.reason):
        return kept
    return continue_branch(
        functools.partial(with_added_inertia, bird),
        (0.0, PRINTED),
        parameter_name="added moment of inertia",
        steps=Steps(first=0.05, longest=0.25),
        max_points=MOST_POINTS,
        observables=flight_observables(bird),
        resume=kept,
        store=store,
    )


def quantities(branch: Branch) -> np.ndarray:
    """|Lambda| max, P_act (W) and P_g (W) along a branch, (3, number of points)."""
    weight = birdmb.load_bird(TOPOLOGY).total_mass * 9.81
    modulus = [abs(point.multipliers[0]) for point in branch.points]
    return np.array([modulus, branch.values("power"), -weight * branch.values("mean_climb_rate")])


def crossings(moments: np.ndarray, values: np.ndarray, wanted: float) -> list[float]:
    """Moments at which the values pass what is wanted, by linear interpolation."""
    apart = values - wanted
    at = np.flatnonzero(apart[:-1] * apart[1:] < 0)
    share = apart[at] / (apart[at] - apart[at + 1])
    return list(moments[at] + share * (moments[at + 1] - moments[at]))


def report(pair: tuple[float, float], branch: Branch) -> None:
    """Print what happens along a branch."""
    moments, found = branch.parameters, quantities(branch)
    end = branch.points[-1]
    print(f"k = {pair[0]:g}, C = {pair[1]:g}: {len(branch.points)} flights")
    for bifurcation in branch.bifurcations:
        print(f"  {bifurcation.kind} at {bifurcation.parameter:.5f} kg m2")
    for text, values in (
        ("beyond 15 deg of effective angle", branch.values("largest_angle_of_attack") - VALID),
        ("flap beyond 90 deg, wings through one another", _widest(branch) - UPRIGHT),
    ):
        if (values > 0).any():
            print(f"  {text} from {crossings(moments, values, 0.0)[0]:.5f} kg m2")
    print(
        f"  left at {end.parameter:.5f} kg m2, {end.observables['mean_speed']:.1f} m/s, "
        f"|Lambda| {abs(end.multipliers[0]):.3f}: "
        f"{branch.stopped.reason if branch.stopped else 'the end of the range'}"
    )
    for name, values, wanted in zip(QUANTITIES, found, PUBLISHED[pair], strict=True):
        at = ", ".join(f"{moment:.5f}" for moment in crossings(moments, values, wanted))
        print(f"  {name} {values[0]:.2f} at first; published {wanted:g} met at {at or 'none'}")


def _widest(branch: Branch) -> np.ndarray:
    """Largest modulus of the flap along a branch, rad."""
    return np.maximum(branch.values("highest_flap"), -branch.values("lowest_flap"))


def drawn(branches: dict[tuple[float, float], Branch]) -> Figure:
    """|Lambda| max, P_act and P_g over the added moment, with the published values."""
    figure = Figure(figsize=(13, 7.5), layout="constrained")
    panels = figure.subplots(3, len(branches), sharex=True, sharey="row")
    for column, (pair, branch) in enumerate(branches.items()):
        moments, valid = branch.parameters, branch.values("largest_angle_of_attack") <= VALID
        for axes, name, values, wanted in zip(
            panels[:, column], QUANTITIES, quantities(branch), PUBLISHED[pair], strict=True
        ):
            seen = np.where(_widest(branch) < UPRIGHT, values, np.nan)
            axes.plot(1e3 * moments, seen, "-", color="0.6", lw=1)
            axes.plot(1e3 * moments, np.where(valid, seen, np.nan), "-", color="C0", lw=2.5)
            axes.axhline(wanted, color="C3", ls="--", lw=1.2)
            if column == 0:
                axes.set_ylabel(name)
            axes.spines[["top", "right"]].set_visible(False)
        panels[0, column].set_title(f"k = {pair[0]:g}, C = {pair[1]:g}")
    panels[0, 0].set_ylim(1.0, 1.6)
    panels[1, 0].set_ylim(-40.0, 20.0)
    panels[2, 0].set_ylim(-10.0, 60.0)
    figure.supxlabel("moment of inertia added to each segment about every axis (g m²)")
    return figure


def main(directory: Path) -> None:
    """Follow, print and draw."""
    directory.mkdir(parents=True, exist_ok=True)
    branches = {}
    for pair in PUBLISHED:
        branches[pair] = followed(*pair, directory)
        report(pair, branches[pair])
    drawn(branches).savefig(directory / "chapter8_inertia.png", dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
