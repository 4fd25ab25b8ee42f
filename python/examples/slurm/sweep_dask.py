"""Many runs of a scene on a cluster with Slurm, by Dask: this program sends runs and writes the file, jobs make them.

Usage: sweep_dask.py <scene> <file>, on a node that may submit jobs. It needs dask-jobqueue, and pyarrow (.parquet) or
h5py (.h5) for the file. Jobs may come late, and end early: runs of those that are lost are made by others. Where this
program ends, the same line goes on with what is in the file. On the cluster at hand JOB, JOBS and GRID are others.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy
from dask.distributed import Client
from dask_jobqueue import SLURMCluster

import carom

# A process for each core, as a run has one thread.
JOB: dict[str, Any] = {"cores": 32, "processes": 32, "memory": "32GB", "walltime": "01:00:00"}
JOBS = 32
GRID = {
    "surface.lower table.normal_restitution": numpy.linspace(0.5, 1.0, 101),
    "body.ball.spin": numpy.linspace(-100.0, 100.0, 101),
}
OUTPUTS = ["energy.total", "body.ball.position"]


def main(scene: str, file: str) -> None:
    with SLURMCluster(**JOB) as cluster, Client(cluster) as client:
        cluster.scale(jobs=JOBS)
        client.wait_for_workers(1)
        runs = carom.ensemble(
            scene, GRID, outputs=OUTPUTS, executor=client.get_executor(), file=file, progress=sys.stderr.isatty()
        )
        print(runs)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
