# Sourced by no_space.sh: the system refuses without our help.

# fails WHAT WORDS COMMAND...: it says one line with these words, and ends with the code that `expected` has.
fails() {
  local what=$1 words=$2 status=0
  shift 2
  "$@" >../said 2>&1 || status=$?
  [ $status -eq "$expected" ] || fail "$what: ended with $status"
  check_message "$what" "$words"
}

goes_on() {
  "$credence" "${study[@]}" --resume >../said 2>&1 || fail "$1: going on failed"
  check_whole "$1"
}

# limited_to BLOCKS COMMAND...: what it says goes through a pipe, as the limit is on every file.
limited_to() {
  { (ulimit -f "$1" && shift && exec "$@") 2>&1 || echo "$?" >../status; } | cat
  return "$(cat ../status)"
}

limit_on_file_sizes() {
  local blocks
  for blocks in 0 1 60 200 400 560; do  # of 1 kB: the journal's, or the results'
    start_with ""
    echo 0 >../status
    fails "ulimit -f $blocks" "file too large" limited_to $blocks "$credence" "${study[@]}"
    goes_on "ulimit -f $blocks"
  done
  echo "limit on file sizes: refused with a message, and resumed"
}

# In a mount namespace of its own, so that nothing of it stays.
small_disk() {
  local own=(unshare --mount) size status=0
  if [ "$(id -u)" -ne 0 ]; then own=(unshare --user --map-root-user --mount); fi
  mkdir -p ../small
  if ! "${own[@]}" mount -t tmpfs none ../small 2>/dev/null; then
    not_tried "small disk" "nothing can be mounted here"
    return
  fi
  for size in 8k 100k 400k 800k; do
    "${own[@]}" bash -c '
      mount -t tmpfs -o size='$size' none ../small && cd ../small || exit 1
      status=0
      "$@" >"$OLDPWD/../said" 2>&1 || status=$?
      mount -o remount,size=20m ../small || exit 1
      "$@" --resume || exit 1
      cp ../small/* "$OLDPWD"
      exit $((100 + status))' - "$credence" "${study[@]}" --force || status=$?
    [ $status -eq 101 ] || fail "disk of $size: ended with $status"
    check_message "disk of $size" "no space left on device"
    check_whole "disk of $size"
    rm x.h5
  done
  echo "small disk: refused with a message, and resumed"
}

# To root every folder can be written to.
folder_that_is_read_only() {
  local as=()
  if [ "$(id -u)" -eq 0 ]; then as=(setpriv --reuid=65534 --regid=65534 --clear-groups); fi
  cp "$credence" ../program
  chmod -R a+rX "$work"
  if ! "${as[@]}" ../program --version >/dev/null 2>&1; then
    not_tried "read-only folder" "there is no other user to be"
    return
  fi
  start_with ""
  chmod a=rx .
  expected=2 fails "read-only folder" "permission denied" "${as[@]}" ../program "${study[@]}"
  chmod u=rwx .
  goes_on "read-only folder"
  echo "read-only folder: refused with a message"
}

folder_that_goes() {
  start_with ""
  mkdir ../gone
  "$credence" run ../tiny.ini --trials 100000000 --force -o ../gone/x.h5 --quiet --commit-every 1 >../said 2>&1 &
  local run=$! status=0
  until [ -s ../gone/x.h5.journal ]; do sleep 0.01; done
  rm -r ../gone
  kill -TERM $run  # it would find out at its end only
  wait $run || status=$?
  [ $status -eq 1 ] || fail "folder that goes: ended with $status"
  check_message "folder that goes" "no such file or directory"
  goes_on "folder that goes"
  echo "folder that goes: refused with a message"
}

expected=1
limit_on_file_sizes
small_disk
folder_that_is_read_only
folder_that_goes
