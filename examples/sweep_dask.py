"""One study on a local Dask cluster and on the package's own processes: the same to the last bit.

Run `pip install 'birdmb[dask]'` (in a checkout: `pip install '.[dask]'`), then
`python examples/sweep_dask.py [DIRECTORY] [--coarse]`; stores and figure go to the directory.
On a real cluster only the lines that make the `Client` change.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

from dask.distributed import Client, LocalCluster

import birdmb

COMPLIANT = Path(__file__).parent.parent / "topologies" / "ibis_compliant_shoulder.toml"
VARY: dict[str, list[float]] = {
    "shoulder.flap.stiffness": [60, 50, 40, 30],
    "shoulder.flap.damping": [0.2, 0.1],
}


def main(directory: Path, *, coarse: bool) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    # A coarse wing, so that the example takes a minute.
    bird = birdmb.load_bird(COMPLIANT).with_values({"wing.discretisation": 4 if coarse else 8})
    vary = {name: values[:2] for name, values in VARY.items()} if coarse else VARY
    run = partial(birdmb.sweep, bird, vary, model=partial(birdmb.MultibodyModel, steps_per_beat=60))

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        on_dask = run(store=directory / "dask.db", executor=client.get_executor())
    on_processes = run(store=directory / "processes.db", workers=2)

    data = on_dask.to_xarray()
    print(data.largest_modulus.to_series().unstack().to_string())
    same = data.identical(on_processes.to_xarray())
    print(f"Dask and processes: {'the same to the last bit' if same else 'NOT the same'}")
    on_dask.plot().savefig(directory / "sweep_dask.png")
    if not same:
        sys.exit(1)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few flights, coarse wings: quick")
    options = parser.parse_args()
    main(options.directory, coarse=options.coarse)
