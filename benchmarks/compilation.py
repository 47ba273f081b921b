"""Processor time of the first compilation of each model's kernels, and what linking callees saves.

Each model finds its first limit cycle in a process of its own with an empty cache: as it is, and
with callees compiled as numba compiles them, as if Python called them. Then it finds it again, for
what the compiled code takes must be the same.

Run: python benchmarks/compilation.py
"""

import os
import subprocess
import sys
import tempfile

CASES = {"ibis": "RigidModel", "ibis_compliant_shoulder": "MultibodyModel"}
FIRST_CYCLE = """
import sys, time
from numba.core.registry import CPUDispatcher
import birdmb
from birdmb import _kernels

bird, model, callees = sys.argv[1:]
if callees == "numba":
    _kernels._Kernel.get_call_template = CPUDispatcher.get_call_template
    _kernels._Kernel.get_overload = CPUDispatcher.get_overload
flown = getattr(birdmb, model)(birdmb.load_bird(bird))
times = []
for _ in range(15):
    began = time.process_time()
    birdmb.find_limit_cycle(flown)
    times.append(time.process_time() - began)
print(times[0], min(times[1:]))
"""


def cycle_times(bird: str, model: str, callees: str) -> tuple[float, float]:
    """Processor times in s of the first search, and of the shortest of those after it."""
    with tempfile.TemporaryDirectory() as cache:
        done = subprocess.run(
            [sys.executable, "-c", FIRST_CYCLE, bird, model, callees],
            env={**os.environ, "NUMBA_CACHE_DIR": cache},
            capture_output=True,
            text=True,
            check=True,
        )
    first, again = map(float, done.stdout.split())
    return first, again


def main() -> None:
    """Print a line per model."""
    for bird, model in CASES.items():
        linked, own = (cycle_times(bird, model, callees) for callees in ("linked", "numba"))
        print(
            f"{bird} ({model}): {linked[0]:.0f} s, {own[0] / linked[0]:.1f} times as fast as "
            f"numba's own; a search afterwards {1e3 * linked[1]:.1f} ms, {1e3 * own[1]:.1f} by it"
        )


if __name__ == "__main__":
    main()
