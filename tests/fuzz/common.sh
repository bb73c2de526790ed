# Sourced by the scripts beside it, in the root of the project, with the target's name in `target`: limits and options
# of a run, and a folder for its files in `scratch`, in memory where there is such a folder.

memory=/dev/shm
[ -w "$memory" ] || memory=${TMPDIR:-/tmp}
scratch=$(mktemp -d -p "$memory" credence-fuzz.XXXXXX)

# Also what OpenMP's library leaves in memory when its process crashes.
clean_up() {
  rm -rf "$scratch"
  local left process
  for left in /dev/shm/__KMP_REGISTERED_LIB_*; do
    process=${left#*LIB_}
    [ ! -O "$left" ] || [ -d "/proc/${process%%_*}" ] || rm -f "$left"
  done
}
trap clean_up EXIT
export TMPDIR=$scratch OMP_NUM_THREADS=1

# Of more than a gigabyte HDF5 gets nothing, as a system with less memory would answer it; our own code ends there.
limits=(-timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=1000000)
# HDF5 1.10 leaks what it could not parse, so leaks tell nothing of our readers there. Stacks of allocations and a large
# quarantine would halve the speed.
leaks=$([ "$target" = scenario ] && echo 1 || echo 0)
ASAN_OPTIONS=detect_leaks=$leaks:allocator_may_return_null=1:max_allocation_size_mb=1024
export ASAN_OPTIONS=$ASAN_OPTIONS:detect_stack_use_after_return=1:malloc_context_size=1:quarantine_size_mb=8
export UBSAN_OPTIONS=print_stacktrace=1

build_target() {
  cmake --preset fuzz >/dev/null
  nice -n 15 cmake --build --preset fuzz --target "$@" -j "${FUZZ_JOBS:-1}" | tail -n 1
}
