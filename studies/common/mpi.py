"""The environment of a program of MPI, on one rank or several."""

import os
import tempfile

# Where Open MPI keeps what its processes tell each other by: programs that are called side by side remove each other's folder as they end.
SESSIONS = tempfile.TemporaryDirectory(prefix="mpi_")
# One thread each: the problems are small, and threads of the BLAS only wait for each other. The others let Open MPI run in
# containers, where one usually is root.
SETTINGS = {"OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def environment(**more):
    return {**os.environ, **SETTINGS, "OMPI_MCA_orte_tmpdir_base": SESSIONS.name, **more}
