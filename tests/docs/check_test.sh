#!/usr/bin/env bash
# What check.sh finds in a page, and what --update makes of it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
page=$work/page.md
check() { CREDENCE=/bin/true bash "$(dirname "$0")/check.sh" "$@" "$page" >"$work/said" 2>&1; }
fail() { echo "$1"; cat "$work/said" "$page"; exit 1; }

cat >"$page" <<'END'
```console
$ printf 'one 1\ntwo 2 of 7 s\nthree\nfour\nfive\nsix 6\nseven\n'
one 1
two 2 of … s
…
six 6
…
```
```ini
# own.ini
[scenario]
```
```console
$ cat \
  own.ini
# own.ini
[scenario]
$ true
$ echo >>own.ini; wc -l <own.ini
3
$ echo >>own.ini; wc -l <own.ini
4
```
<!-- $ printf '| a | b |\n|---|---|\n| 1 ± 2 | 3 |\n\n| c |\n|---|\n| 4 |\n' -->
| a | b | *theirs* |
|---|---| --- |
| 1 ± 2 | 3 | 5 |
| *theirs* | 6 | |

<!-- $ printf '| a | b |\n|---|---|\n| 1 ± 2 | 3 |\n\n| c |\n|---|\n| 4 |\n' -->
| c |
|---|
| 4 |
<!-- slow $ false -->
| d |
|---|
| 7 ± 8 |
END
all='awk -f experiments/rows.awk -v rows=.* -v columns="1 2 3 4 5 6 7"' csv=experiments/estimators/nees.csv
printf '%s\n' "<!-- \$ $all $csv → $csv -->" >>"$page"
cp "$page" "$work/right.md"
check || fail "refuses a page that is right"
long=$(printf 'ü%.0s' {1..121})
printf '%s\n' "${long%ü}" '```text' "$long" '```' "| $long |" "$long https://example.org" >>"$page"
check || fail "refuses a line of 120 characters, or a long one of code, of a table or with a URL"
cp "$work/right.md" "$page"

# Each of these makes it wrong, and --update right again.
for wrong in 's/^one 1$/one 2/' '/^one 1$/d' 's/^six 6$/six 7/' 's/^one 1$/&\nzero/' 's/^|.4 |$/| 5 |/' '/^| 4 |$/d' \
    's/^| 1 ± 2 | 3/| 1 ± 3 | 4/' 's/^\$ true$/&\nfalse/' '0,/^\[scenario\]$/!s/^\[scenario\]$//'; do
  sed "$wrong" "$work/right.md" >"$page"
  if cmp -s "$page" "$work/right.md"; then fail "changes nothing: $wrong"; fi
  if check; then fail "does not find $wrong"; fi
  check --update && cmp -s "$page" "$work/right.md" || fail "does not renew $wrong"
done
# A file that is not the table.
for wrong in "s/columns=\"1 /columns=\"2 /" "s/→ experiments/→ nowhere/" 's/^<!-- \$ awk [^→]*/<!-- $ true /'; do
  sed "$wrong" "$work/right.md" >"$page"
  if cmp -s "$page" "$work/right.md"; then fail "changes nothing: $wrong"; fi
  if check; then fail "does not find $wrong"; fi
done
# Each of these is a mistake that --update cannot mend.
for wrong in '0,/^```console$/s//```/' 's/^six 6$/elsewhere/' 's/^\$ true$/$ false/' 's/^<!-- slow .*//' 's/^<!-- slow /<!-- /' \
    's/^<!-- slow .*/&\n/;$a - A bullet that stands in the page twice, word for word, as it was copied.\n- A bullet that stands in the page twice, word for word, as it was copied.' \
    '$a ```sh' "\$a $long"; do
  sed "$wrong" "$work/right.md" >"$page"
  cp "$page" "$work/before.md"
  if check --update; then fail "does not refuse $wrong"; fi
  cmp -s "$page" "$work/before.md" || fail "rewrites $wrong"
done
