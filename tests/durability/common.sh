# Sourced by the scripts here, with the program as their first argument: the library that crashes it (shim/crash.c), a
# folder to work in, a scenario whose file takes few writes, and what must be true of every file that a run leaves.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
credence=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cc -O1 -Wall -Wextra -Wno-missing-field-initializers -shared -fPIC -o "$work/shim.so" "$here"/shim/*.c -ldl
mkdir "$work/at"
cd "$work/at"

cp "$here/tiny.ini" ..
trials=1500  # five blocks and a partial one
study=(run ../tiny.ini --trials $trials --quiet -o x.h5 --commit-every 1)
"$credence" run ../tiny.ini --trials $trials --quiet -o ../whole.h5
"$credence" run ../tiny.ini --trials 700 --quiet -o ../less.h5  # two blocks and a partial one
"$credence" run ../tiny.ini --trials 300 --seed 2 --quiet -o ../other.h5
for shard in 0 1 2; do
  "$credence" run ../tiny.ini --trials $trials --shard $shard/3 --quiet -o ../$shard.h5
done
shards=(../2.h5 ../0.h5 ../1.h5)

fail() {
  echo "FAILED: $*" >&2
  echo "what the program said last:" >&2
  tail -n 5 ../said >&2
  ls -l >&2
  exit 1
}

# left_out N: of the changes 1 to `total` every one is looked at where the journal is written at one end, and at the
# other where files are synced, renamed and removed; of the long middle only each `every`-th from `offset` on.
first=17 last=7
left_out() {
  [ "$1" -gt $first ] && [ "$1" -le $((total - last)) ] && [ $(($1 % every)) -ne $((offset % every)) ]
}

# crashing "VARIABLE=value ..." ARGUMENTS...: the program with the library; sets `status`, what it says goes to ../said.
crashing() {
  local environment=$1
  shift
  status=0
  { env $environment LD_PRELOAD="$work/shim.so" "$credence" "$@" >../said 2>&1; } 2>/dev/null || status=$?
}

# Empties the folder, but for the file that the run starts with.
start_with() {
  rm -rf ./*
  : >../log
  : >../log2
  if [ -n "$1" ]; then cp "$1" x.h5; fi
}

# count_changes "VARIABLE=value ...": sets `total`, the changes of `command` on the file `before`, undisturbed. Where
# there are few, the library does not see them, and what follows would show nothing.
count_changes() {
  start_with "$before"
  crashing "CRASH_LOG=../log OMP_NUM_THREADS=1 $1" "${command[@]}"
  [ $status -eq 0 ] || [ $status -eq 3 ] || fail "$name: ended with $status undisturbed"
  total=$(wc -l <../log)
  [ "$total" -gt 10 ] || fail "$name: the library saw $total changes only"
}

# not_tried WHAT WHY: what cannot be tried here is no line of what was done.
not_tried() { echo "LEFT OUT: $1, $2" >&2; }

# The results are those of an undisturbed run, and nothing else is there.
check_whole() {
  [ "$(ls -A)" = x.h5 ] || fail "$1: it left $(ls -A | tr '\n' ' ')"
  h5diff --exclude-path /run ../whole.h5 x.h5 >../said 2>&1 || fail "$1: other results"
}
