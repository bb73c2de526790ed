#!/usr/bin/env bash
# Label readers: credence's files as read by other programs, and the scripts of analysis/, in the languages that run
# them; the claims of docs/planning.md and docs/theory/planning.md, of their tables;
# the draws as docs/model.md defines them; the world polygon in numpy and its study, beside another program's, where its
# runs are there; and the columns of the filter in numpy, and in JAX where it is installed,
# beside credence's.
set -euo pipefail
/usr/bin/python3 -c 'import h5py, numpy, scipy' 2>/dev/null || { echo "SKIPPED: python3-h5py or python3-scipy is not installed"; exit 0; }
bash tests/readers/run.sh build/credence
bash tests/record_example.sh build/credence /usr/bin/python3 analysis/record/write_record.py
records=$(mktemp -d)
trap 'rm -rf "$records"' EXIT
claims() { /usr/bin/python3 experiments/claims.py experiments/planning/claims.py "$@"; }
claims docs/planning.md docs/theory/planning.md experiments/planning/*.csv
# With another number in a sentence or in a table, and with a number that nothing checks, the pages are refused.
for wrong in 's/it ends 11 % higher/it ends 12 % higher/' 's/^- \*\*Where it harms/- It is 7 times faster. &/' \
    's/three steps regain 40 %/three steps regain 41 %/' 's/^- The mean is carried/- It is 7 times faster. &/' \
    's/^document,follow,0.1137/document,follow,0.1237/'; do
  sed "$wrong" docs/planning.md >"$records/page.md"
  sed "$wrong" docs/theory/planning.md >"$records/theory.md"
  for table in experiments/planning/*.csv; do sed "$wrong" "$table" >"$records/${table##*/}"; done
  if claims "$records/page.md" "$records/theory.md" "$records"/*.csv 2>/dev/null; then
    echo "claims.py does not find $wrong"
    exit 1
  fi
done
/usr/bin/python3 experiments/claims.py experiments/worlds/polygon_claims.py docs/polygon.md experiments/worlds/polygon.csv
/usr/bin/python3 tests/oracle/draws_oracle.py build/credence docs/model.md
/usr/bin/python3 tests/oracle/explore_oracle.py build/credence
successor=../shared/data/successor.h5
if [ -f "$successor" ]; then
  /usr/bin/python3 tests/oracle/polygon_oracle.py "$successor" fixed >"$records/polygon" || { cat "$records/polygon"; exit 1; }
  /usr/bin/python3 experiments/worlds/compare/successor.py experiments/worlds/polygon.csv ../shared/successor.md
else
  echo "the world polygon was not compared with another program's runs: $successor is not there"
fi
/usr/bin/python3 bench/peers/peers.py --credence build/credence --check
/usr/bin/python3 tests/reference/make_records.py --big "$records"
/usr/bin/python3 tests/judge_records.py build/credence "$records"
if command -v octave >/dev/null; then
  bash tests/record_example.sh build/credence octave --no-gui --quiet analysis/record/write_record.m
fi
