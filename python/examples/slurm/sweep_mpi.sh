#!/bin/bash
# Many runs of a scene on a cluster, by MPI: one rank sends runs and writes the file, the others make them.
#
#   sbatch sweep_mpi.sh scene.json --vary surface.floor.friction=0:1:1000001 --output energy.total --file rows.parquet
#
# The words behind the script are those of `carom sweep`. Where the job ends before the sweep does, the same line goes on
# with what is in the file. It needs mpi4py, and pyarrow or h5py for the file.
#SBATCH --job-name=carom-sweep
#SBATCH --ntasks=1024
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
set -euo pipefail

srun python -m mpi4py.futures -m carom sweep "$@" --mpi
