#!/usr/bin/env bash
# Label browser: the page of `report` and of `judge`, opened in headless Chromium [tests/browser/check_page.py], and its
# markup before an HTML parser.
set -euo pipefail
command -v chromium >/dev/null || { echo "SKIPPED: chromium is not installed"; exit 0; }
/usr/bin/python3 -c 'import websocket' 2>/dev/null || { echo "SKIPPED: python3-websocket is not installed"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A title that would run if it were not escaped, in a study of two scenarios; a record of another program's filter, and a
# hundred of its runs as one log.
build/credence run experiments/seed/kf-circle-constant.ini experiments/seed/ekf-straight-ranged.ini --trials 600 --quiet -o "$work/study.h5" \
  --set 'scenario.title=</title></style><script>document.title="run"</script><img src=x onerror=alert(1)> & "quotes"'
build/tests/write_record "$work/record.h5"
/usr/bin/python3 - "$work/record.h5" "$work/log.h5" <<'END'
import sys, h5py
with h5py.File(sys.argv[1]) as record, h5py.File(sys.argv[2], "w") as log:
    for name, values in record.items():
        if name.startswith(("error", "covariance", "innovation")):
            log[name] = values[:100].reshape(-1, *values.shape[2:])
END
for page in "report study" "judge record" "judge log"; do
  read -r command name <<<"$page"
  build/credence "$command" "$work/$name.h5" --format html -o "$work/$name.html" 2>"$work/progress"
  build/credence "$command" "$work/$name.h5" --format json -o "$work/$name.json" 2>"$work/progress"
  if command -v tidy >/dev/null; then
    # tidy 5.6 does not know `data`, nor `id` of SVG's `title`; it must find nothing else.
    tidy -q -e --new-inline-tags data "$work/$name.html" 2>&1 |
      grep -v -e '<data> is not approved' -e '<title> proprietary attribute "id"' && { echo "$name.html is not valid"; exit 1; }
  fi
  /usr/bin/python3 tests/browser/check_page.py "$work/$name.html" "$work/$name.json"
done
