"""Ratios of a version for `benchmarks/history.md`: `python benchmarks/record.py`.

Adds a row of the installed version, or replaces the one it has. Times are not kept, for they depend
on the machine: each entry is a ratio of two processor times of the same run.
"""

from importlib.metadata import version
from pathlib import Path

from speed import timed_cycles

from birdmb.files import write_whole

HISTORY = Path(__file__).parent / "history.md"
HEADING = """# Speed by version

`python benchmarks/record.py` writes the row of the installed version. Entries are ratios of
processor times within one run. "Shooting": how many times as long shooting takes as collocation
from a cold start. "A state": how many times as long collocation takes for each state of the cycle
as for one of the rigid ibis.

"""


def main() -> None:
    timed = list(timed_cycles())
    per_state = [cycle.collocation / cycle.states for cycle in timed]
    columns = ["version"]
    entries = [version("birdmb")]
    for cycle, of_state in zip(timed, per_state, strict=True):
        columns += [f"{cycle.name}: shooting", "a state"]
        entries += [f"{cycle.shooting / cycle.collocation:.1f}", f"{of_state / per_state[0]:.1f}"]
    rows = {}
    if HISTORY.exists():
        lines = HISTORY.read_text(encoding="utf-8").splitlines()
        rows = {line.split("|")[1].strip(): line for line in lines if line.startswith("| ")}
        rows.pop("version", None)
    rows[entries[0]] = f"| {' | '.join(entries)} |"
    table = [f"| {' | '.join(columns)} |", "|---" * len(columns) + "|", *rows.values()]
    write_whole(HISTORY, (HEADING + "\n".join(table) + "\n").encode())
    print(rows[entries[0]])


if __name__ == "__main__":
    main()
