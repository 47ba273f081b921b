"""What a load evaluation, an integration and a limit cycle cost: `python benchmarks/speed.py`.

Best of several runs with compiled kernels, limit cycles in processor time. Times depend on the
machine; ratios within a run and counts of evaluations do not, or hardly.
"""

import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb
from birdmb.aerodynamics.prescribed import prescribed_wing, symmetric_loads
from birdmb.models.air_kernel import Motion, air_forces
from birdmb.models.exudyn_bird import ExudynBird
from birdmb.models.springs import spring_torques, springs_of
from birdmb.models.tree_coordinates import IN_PLANE
from birdmb.models.tree_forces import TreeLoads

TOPOLOGIES = Path(__file__).parent.parent / "topologies"


def best(run: Callable[[], object], repeat: int = 5, inner: int = 1) -> float:
    """Shortest time of one run in s, after a first that compiles and fills caches."""
    run()
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        for _ in range(inner):
            run()
        times.append((time.perf_counter() - start) / inner)
    return min(times)


def seconds(run: Callable[[], object], repeat: int) -> float:
    """Shortest processor time of one run in s, after a first."""
    run()
    times = []
    for _ in range(repeat):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return min(times)


def load_evaluations(prescribed: birdmb.Bird, compliant: birdmb.Bird) -> tuple[float, float]:
    """Seconds of one evaluation of the loads in the two models' right-hand sides."""
    rigid = birdmb.RigidModel(prescribed)
    aero = rigid.aero
    table = prescribed_wing(rigid.wing, aero.tail, np.array([0.01]), *rigid.discretisation)
    twist, planar = np.array([18.0, 0.0, -2.0, 0.0, 0.1, 0.0]), rigid.motion.directions
    fixed = best(lambda: symmetric_loads(table, 0, aero, twist, planar), inner=2000)

    model = birdmb.MultibodyModel(compliant)
    tree, times, x = model.tree, np.array([0.01]), model.driven_state(0.01)
    q, v = model.coordinates(0.01, x)
    drivers, instants = tree.drivers_at(times)
    joints = slice(IN_PLANE.size, IN_PLANE.size + drivers.angles.shape[1])
    angles, rates = q[None, joints], v[None, joints]
    motion = Motion(twist[None], np.zeros((1, 3)), angles, rates, np.empty((1, 0)))
    row = np.zeros(1, np.int64)
    shapes = tree.shapes_at(instants, times, row, angles, rates)
    driven = drivers.accelerations[0]
    free = best(lambda: air_forces(tree.constants, shapes, motion, driven, row), inner=2000)
    return fixed, free


def right_hand_sides(bird: birdmb.Bird) -> tuple[float, float]:
    """Seconds of one evaluation of the multibody rates: of many in a call, and of a single one.

    Those of a Jacobian by central differences at 27 instants.
    """
    model = birdmb.MultibodyModel(bird)
    instants = bird.period * np.arange(27) / 27
    near = np.array([model.driven_state(t) for t in instants])
    shifts = np.diag(1e-5 * model.state_scale)
    states = np.concatenate([near[:, None] + shifts, near[:, None] - shifts], axis=1)
    times = np.repeat(instants, states.shape[1])
    rows = states.reshape(times.size, -1)
    many = best(lambda: model.rates(times, rows), inner=3) / times.size
    return many, best(lambda: model.rhs(times[5], rows[5]), inner=100)


def integrations(bird: birdmb.Bird) -> tuple[float, float, int]:
    """Seconds of a beat in Exudyn with and without the air's loads; evaluations of the forces."""
    model = birdmb.MultibodyModel(bird)
    x0, steps, calls = model.initial_guess(), model.steps_per_beat, 0
    none = np.empty(0)
    springs = springs_of(bird)
    joints = slice(IN_PLANE.size, IN_PLANE.size + springs.damping.size)

    def springs_alone(t: float, q: np.ndarray, v: np.ndarray, lags: np.ndarray) -> TreeLoads:
        nonlocal calls
        calls += 1
        drivers, _ = model.tree.drivers_at(np.array([t]))
        torques = spring_torques(
            springs, q[joints] - drivers.angles[0], v[joints] - drivers.rates[0]
        )
        forces = np.concatenate([np.zeros(IN_PLANE.size), torques, torques])
        return TreeLoads(forces, np.empty((0, 0)), lags)

    bare = ExudynBird(
        bird, IN_PLANE, springs_alone, model.prescribed, model.tree.driver_accelerations
    )
    q, v = model.coordinates(0.0, x0)
    bare.integrate(q, v, none, 0.0, bird.period, steps)
    evaluations, calls = calls, 0
    without = best(lambda: bare.integrate(q, v, none, 0.0, bird.period, steps))
    return best(lambda: model.flow(x0, 0.0, bird.period)), without, evaluations


def search(
    kind: type[birdmb.RigidModel | birdmb.MultibodyModel],
    bird: birdmb.Bird,
    guess: birdmb.LimitCycle | None,
    method: Literal["collocation", "shooting"],
) -> birdmb.LimitCycle:
    """The limit cycle of a bird, its model made anew."""
    return birdmb.find_limit_cycle(kind(bird), guess, method=method)


class TimedCycle(NamedTuple):
    """Processor times of one limit cycle with multipliers; from a cold guess but for `warm`."""

    name: str
    states: int
    nodes: int | None
    collocation: float  # s
    shooting: float  # s
    warm: float  # s, by collocation from a neighbour's orbit


def timed_cycles() -> Iterator[TimedCycle]:
    """Limit cycles of several birds by both methods."""
    # The published wing jumps in time: a mesh is taken.
    published = {"wing.discretisation": "published"}
    for name, kind, values in (
        ("ibis", birdmb.RigidModel, {}),
        ("ibis_compliant_shoulder", birdmb.MultibodyModel, {}),
        ("ibis_hinged_feathers", birdmb.MultibodyModel, {}),
        ("ibis", birdmb.RigidModel, published),
    ):
        bird = birdmb.load_bird(TOPOLOGIES / f"{name}.toml").with_values(values)
        cycle = search(kind, bird, None, "collocation")
        near = bird.with_values({"body.mass": 1.02 * bird.body.mass})
        yield TimedCycle(
            f"{name}, {'rigid' if kind is birdmb.RigidModel else 'multibody'}"
            f"{', published wing' if values else ''}",
            len(cycle.x0),
            cycle.nodes,
            seconds(partial(search, kind, bird, None, "collocation"), 5),
            seconds(partial(search, kind, bird, None, "shooting"), 1),
            seconds(partial(search, kind, near, cycle, "collocation"), 5),
        )


def cycles() -> Table:
    """Limit cycles with multipliers from a cold guess by both methods, and from a neighbour."""
    table = Table(
        "limit cycle", "states", "collocation", "nodes", "shooting", "ratio", "from a neighbour"
    )
    for timed in timed_cycles():
        table.add_row(
            timed.name,
            str(timed.states),
            f"{timed.collocation * 1e3:.0f} ms",
            str(timed.nodes),
            f"{timed.shooting * 1e3:.0f} ms",
            f"{timed.shooting / timed.collocation:.1f}",
            f"{timed.warm * 1e3:.0f} ms",
        )
    return table


def memory() -> Table:
    """Limit cycles with multipliers from a cold guess, in air without a memory and with one."""
    table = Table("limit cycle", "air", "states", "nodes", "collocation", "ratio")
    for name, kind in (
        ("ibis", birdmb.RigidModel),
        ("ibis_compliant_shoulder", birdmb.MultibodyModel),
        ("ibis_hinged_feathers", birdmb.MultibodyModel),
    ):
        plain = birdmb.load_bird(TOPOLOGIES / f"{name}.toml")
        birds = plain, plain.with_values({"air.wake": "unsteady", "air.wake_points": 6})
        # By turns: the machine may be busy for a while.
        times = [
            [seconds(partial(search, kind, bird, None, "collocation"), 2) for bird in birds]
            for _ in range(3)
        ]
        shortest = np.min(times, axis=0)
        for bird, time_taken in zip(birds, shortest, strict=True):
            cycle = search(kind, bird, None, "collocation")
            table.add_row(
                name,
                bird.air.wake,
                str(len(cycle.x0)),
                str(cycle.nodes),
                f"{time_taken * 1e3:.0f} ms",
                f"{time_taken / shortest[0]:.1f}",
            )
    return table


def main() -> None:
    """Print the tables."""
    console = Console()
    ibis = birdmb.load_bird(TOPOLOGIES / "ibis.toml")
    compliant = birdmb.load_bird(TOPOLOGIES / "ibis_compliant_shoulder.toml")
    loaded, bare, evaluations = integrations(compliant)

    table = Table("what", "time", "remark")
    fixed, free = load_evaluations(ibis, compliant)
    table.add_row("loads and derivatives, joints prescribed", f"{fixed * 1e6:.1f} us", "as called")
    table.add_row("loads, shoulder compliant", f"{free * 1e6:.1f} us", "as called")
    many, single = right_hand_sides(compliant)
    table.add_row("multibody rates, many in a call", f"{many * 1e6:.0f} us", "each")
    table.add_row("multibody rates, one in a call", f"{single * 1e6:.0f} us", "")
    table.add_row("a beat in Exudyn with loads", f"{loaded * 1e3:.1f} ms", f"{evaluations} calls")
    table.add_row("a beat in Exudyn without", f"{bare * 1e3:.1f} ms", f"ratio {loaded / bare:.2f}")
    console.print(table)
    console.print(cycles())
    console.print(memory())

    scaling = Table("elements a wing", "joints prescribed", "shoulder compliant")
    for n in (8, 16, 32, 64):
        values = {"wing.discretisation": n}
        fixed, free = load_evaluations(ibis.with_values(values), compliant.with_values(values))
        scaling.add_row(str(n), f"{fixed * 1e6:.1f} us", f"{free * 1e6:.1f} us")
    console.print(scaling)


if __name__ == "__main__":
    main()
