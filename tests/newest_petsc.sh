#!/bin/sh
# The driver on the newest PETSc of PyPI: `make newest-petsc`. newest_petsc.sh BUILD: builds PETSc and the driver in BUILD/newest-petsc, with
# what there is on this machine (MUMPS with ScaLAPACK, HDF5; without MUMPS one rank has PETSc's own LU), and runs the acceptance
# tests that say whether a PETSc will do. What has been built stays; VERSION=3.26.1 takes that one.
set -eu

build=$1
python=${PYTHON:-python3}
jobs=${JOBS:-2}
source=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$build/newest-petsc"
cd "$build/newest-petsc"
here=$(pwd)
unset PETSC_DIR PETSC_ARCH

version=${VERSION:-$("$python" -m pip index versions petsc 2>/dev/null | sed -n 's/^petsc (\(.*\))$/\1/p')}
test -n "$version" || { echo "newest_petsc.sh: PyPI does not say which version of petsc is the newest" >&2; exit 1; }
petsc="$here/petsc-$version"
echo "PETSc $version, in $petsc"
if ! test -d "$petsc"; then
	"$python" -m pip download -q --no-deps --no-binary petsc -d "$here" "petsc==$version"
	tar xzf "petsc-$version.tar.gz"
fi

# What configure is told about: whatever compiles and links here.
links() { # HEADER LIBRARIES...
	printf '#include <%s>\nint main(void) { return 0; }\n' "$1" >try.c
	shift
	mpicc $hdf5_flags try.c -o try "$@" 2>/dev/null
}
hdf5_flags=$(pkg-config --cflags hdf5-mpi 2>/dev/null || true)
hdf5=$(pkg-config --libs-only-L hdf5-mpi 2>/dev/null || true)
with=""
mumps="-ldmumps -lmumps_common -lpord"
if links dmumps_c.h $mumps -lscalapack-openmpi; then
	with="--with-scalapack-lib=-lscalapack-openmpi --with-mumps-include=/usr/include"
else
	mumps=""
	echo "There is no MUMPS for MPI (libmumps-dev): PETSc's LU, of one rank, takes its place."
fi
links hdf5.h $hdf5 -lhdf5_hl -lhdf5 || hdf5_flags=""
hdf5_flags=${hdf5_flags%% *} # the others are MPI's
if ! test -e "$petsc/newest/lib/libpetsc.so"; then
	cd "$petsc"
	PETSC_DIR=$petsc PETSC_ARCH=newest "$python" ./configure --with-cc=mpicc --with-cxx=0 --with-fc=mpif90 --with-fortran-bindings=0 \
		--with-debugging=0 --with-x=0 --with-make-np="$jobs" COPTFLAGS=-O2 FOPTFLAGS=-O2 --with-blaslapack-lib="-llapack -lblas" $with \
		${mumps:+--with-mumps-lib="$mumps"} \
		${hdf5_flags:+--with-hdf5-include="${hdf5_flags#-I}" --with-hdf5-lib="$hdf5 -lhdf5_hl -lhdf5"} >../configure.log 2>&1 ||
		{ tail -30 ../configure.log >&2; exit 1; }
	PETSC_DIR=$petsc PETSC_ARCH=newest make -f gmakefile -j"$jobs" libs >../make.log 2>&1 || { tail -30 ../make.log >&2; exit 1; }
	cd "$here"
fi

export PKG_CONFIG_PATH="$petsc/newest/lib/pkgconfig"
cmake -S "$source" -B driver -DSTICKSLIP_TESTS=OFF -DPython3_EXECUTABLE="$python" >cmake.log 2>&1 || { tail -30 cmake.log >&2; exit 1; }
cmake --build driver -j"$jobs" --target stickslip_program >driver.log 2>&1 || { tail -30 driver.log >&2; exit 1; }
grep -E "warning:|error:" driver.log && exit 1
ldd driver/program/stickslip | grep "$petsc" >/dev/null || { echo "the driver has another PETSc" >&2; exit 1; }
groups="patch block steps invariance errors jacobian iterative"
test -z "$mumps" || groups="$groups parallel ranks"
exec "$python" "$source/tests/acceptance/check.py" --build driver $groups
