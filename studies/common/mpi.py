"""The environment of a program of MPI, on one rank or several."""

import os

# One thread each: the problems are small, and threads of the BLAS only wait for each other. The others let Open MPI run in
# containers, where one usually is root.
SETTINGS = {"OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def environment(**more):
    return {**os.environ, **SETTINGS, **more}
