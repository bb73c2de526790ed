#!/usr/bin/env bash
# mpi_configure_test.sh SOURCE: where MPI has no headers, cmake/mpi.cmake goes without it, or says what is wrong.
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# What Open MPI's wrapper says where its programs are installed and its headers are not.
mkdir "$work/bin"
cat >"$work/bin/mpicc" <<'WRAPPER'
#!/bin/sh
case "$*" in
  *-showme:incdirs*) echo "/nonexistent/openmpi/include" ;;
  *-showme:version*) echo "mpicc: Open MPI 4.1.4 (Language: C)" ;;
  *-showme*) echo "cc -I/nonexistent/openmpi/include -lmpi" ;;
  *) echo "cannot compile" >&2; exit 1 ;;
esac
WRAPPER
printf '#!/bin/sh\necho "mpiexec (OpenRTE) 4.1.4"\n' >"$work/bin/mpiexec"
chmod +x "$work/bin/mpicc" "$work/bin/mpiexec"
cat >"$work/CMakeLists.txt" <<PROJECT
cmake_minimum_required(VERSION 3.22)
project(mpi_test LANGUAGES NONE)
include($source/cmake/mpi.cmake)
credence_find_mpi()
PROJECT

# configured CHOICE: the exit code; what was said is in $work/said.
configured() { PATH="$work/bin:$PATH" cmake -S "$work" -B "$work/$1" -DCREDENCE_MPI="$1" >"$work/said" 2>&1 && echo 0 || echo $?; }
expect() { grep -q "$1" "$work/said" || { echo "does not say: $1"; cat "$work/said"; exit 1; }; }
[ "$(configured AUTO)" -eq 0 ] || { cat "$work/said"; exit 1; }
expect 'MPI: its compiler includes /nonexistent/openmpi/include, which does not exist; credence is built without it'
[ "$(configured ON)" -ne 0 ] || { echo "ON goes without MPI"; exit 1; }
expect 'invalid CREDENCE_MPI=ON'
[ "$(configured MAYBE)" -ne 0 ] || { echo "takes any choice"; exit 1; }
expect 'invalid CREDENCE_MPI=MAYBE (not one of its choices)'
