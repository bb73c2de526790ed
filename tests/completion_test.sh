#!/usr/bin/env bash
# completion_test.sh CREDENCE: the completion of command lines in bash, as its function answers.
set -uo pipefail
export LC_ALL=C
credence=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir sub
touch world.ini study.h5 running.h5.journal notes.txt
source <("$credence" completion bash)
COMP_WORDBREAKS=$' \t\n"\'><=;|&(:'  # as bash has it
status=0

# answers WORD...: what is offered for the last word, sorted, on one line.
answers() {
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _credence
  [ ${#COMPREPLY[@]} -eq 0 ] || printf '%s\n' "${COMPREPLY[@]}" | sort -u | tr '\n' ' '
}
# expect ANSWER WORD...
expect() {
  local wanted=$1 got
  shift
  got=$(answers "$@")
  [ "${got% }" = "$wanted" ] && return
  echo "for: $*; offered: $got; expected: $wanted"
  status=1
}

expect run credence ru
expect '--help --version' credence --
expect '--failed --format' credence report --f
expect --format credence report --fo
expect 'csv html json text' credence report --format ''
expect 'json' credence report --format j
expect 'json' credence report --format = j
expect 'csv html json text' credence report --format =
expect '--failed' credence report --format json --f
expect '--seed --set' credence run --set noise.heading = 1 --se
expect 'consistent no-finding' credence judge record.h5 --require ''
expect '' credence run --trials ''
expect 'sub world.ini' credence run ''
expect 'sub world.ini' credence run --quiet ''
expect 'study.h5 sub' credence report ''
expect 'study.h5 sub' credence run world.ini -o ''
expect 'study.h5 sub' credence run world.ini --output = ''
expect 'notes.txt running.h5.journal study.h5 sub world.ini' credence report -o ''
expect 'running.h5 study.h5 sub' credence watch ''
expect 'study.h5 sub world.ini' credence replay ''
expect 'study.h5 sub' credence replay world.ini --noise ''
expect 'bash' credence completion ''
expect 'noise.heading=' credence run --set noise.he
expect 'static straight' credence run --set features.path = s
expect 'circle static straight' credence run --set features.path =
expect '' credence run --set noise.heading = ''
expect 'ekf' credence show --set arms.estimators = e
expect 'noise.heading=' credence run --sweep noise.he
expect 'explore' credence run --set scenario.world = e
expect 'circle' credence run --sweep features.path = c
keys=$({ "$credence" show; "$credence" show --set scenario.world=explore; echo "scenario.world = "; } | sed -n 's/^\([a-z]*\.[a-zA-Z_]*\) = .*/\1=/p' | sort -u | tr '\n' ' ')
expect "${keys% }" credence run --set ''
[ "$(wc -w <<<"$keys")" -gt 30 ] || { echo "show has too few keys: $keys"; status=1; }

# Where bash does not break words at =, as some people have it.
COMP_WORDBREAKS=${COMP_WORDBREAKS//=}
expect '--format=json' credence report --format=j
expect 'features.path=static features.path=straight' credence run --set features.path=st

# Every command and every option that --help names.
commands=$("$credence" --help | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p' | sort | tr '\n' ' ')
expect "--help --version ${commands% }" credence ''
for command in $commands; do
  options=$("$credence" "$command" --help | sed -n 's/^  \(-. \[ \)\{0,1\}\(--[a-z-]*\).*/\2/p' | sort -u | tr '\n' ' ')
  [[ $options == *--help* ]] || { echo "$command --help names no option"; status=1; }
  expect "${options% }" credence "$command" -
done
exit $status
