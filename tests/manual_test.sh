#!/usr/bin/env bash
# manual_test.sh CREDENCE: the manual page has every command with every option that --help names, every key of a
# scenario and every exit code, and its examples use options that there are.
set -uo pipefail
credence=$1
status=0
complain() {
  echo "$1"
  status=1
}
page=$("$credence" manual | sed 's/\\f[BIR]//g; s/\\-/-/g; s/\\(aq/'"'"'/g')
options_of() { "$credence" "$1" --help | sed -n 's/^  \(-. \[ \)\{0,1\}\(--[a-z-]*\).*/\2/p' | sort -u; }

commands=$("$credence" --help | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p')
[ "$(wc -w <<<"$commands")" -ge 8 ] || complain "--help lists too few commands: $commands"
for command in $commands; do
  part=$(awk -v name=".SS credence $command" '/^\.S[SH] /{there = index($0, name) == 1} there' <<<"$page")
  [ -n "$part" ] || complain "no section on $command"
  for option in $(options_of "$command"); do
    [ "$option" = --help ] || grep -q -- "^\(-., \|-. [A-Za-z.0-9]*, \)\{0,1\}$option\( \|$\)" <<<"$part" ||
      complain "$command: no $option"
  done
done
for key in $("$credence" show | sed -n 's/^\([a-z]*\.[a-zA-Z_]*\) = .*/\1/p'); do
  grep -q "^$key = " <<<"$page" || complain "no key $key"
done
for code in 0 1 2 3 130; do
  awk '/^\.SH/{there = $2 == "EXIT"} there' <<<"$page" | grep -qx "$code" || complain "no exit code $code"
done
for title in NAME SYNOPSIS DESCRIPTION COMMANDS SCENARIOS 'EXIT STATUS' ENVIRONMENT FILES EXAMPLES 'SEE ALSO'; do
  grep -qx ".SH $title" <<<"$page" || complain "no section $title"
done
while read -r _ command words; do
  for word in $words; do
    case $word in
      --*) options_of "$command" | grep -qx -- "${word%%=*}" || complain "example: $command has no $word" ;;
    esac
  done
done < <(awk '/^\.SH/{there = $2 == "EXAMPLES"} there && /^credence /' <<<"$page")
exit $status
