"""Processor time of the first compilation of each model's kernels, and what linking callees saves.

Each model finds its first limit cycle in a process of its own with an empty cache: as it is, and
with callees compiled as numba compiles them, as if Python called them.

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
began = time.process_time()
birdmb.find_limit_cycle(getattr(birdmb, model)(birdmb.load_bird(bird)))
print(time.process_time() - began)
"""


def first_cycle(bird: str, model: str, callees: str) -> float:
    """Processor time in s."""
    with tempfile.TemporaryDirectory() as cache:
        done = subprocess.run(
            [sys.executable, "-c", FIRST_CYCLE, bird, model, callees],
            env={**os.environ, "NUMBA_CACHE_DIR": cache},
            capture_output=True,
            text=True,
            check=True,
        )
    return float(done.stdout)


def main() -> None:
    """Print a line per model."""
    for bird, model in CASES.items():
        linked, own = (first_cycle(bird, model, callees) for callees in ("linked", "numba"))
        print(f"{bird} ({model}): {linked:.0f} s, {own / linked:.1f} times as fast as numba's own")


if __name__ == "__main__":
    main()
