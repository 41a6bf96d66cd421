#!/bin/sh
# Fuzzes every format for two seconds, with a fixed seed, and leaves nothing behind.
# usage: smoke.sh DIRECTORY_OF_PROGRAMS
set -u
programs=$1
here=$(dirname "$0")
work=$(mktemp --directory "$PWD/smoke-XXXXXX")
trap 'rm -rf "$work"' EXIT
failed=0
for format in $("$programs/lobe_fuzz_seeds"); do
  "$programs/lobe_fuzz_seeds" "$format" "$work/$format" || failed=1
  set -- -seed=1 -max_total_time=2 -timeout=10 -artifact_prefix="$work/"
  [ ! -f "$here/$format.dict" ] || set -- "$@" -dict="$here/$format.dict"
  if ! LOBE_FUZZ_FORMAT=$format "$programs/lobe_fuzz" "$work/$format" "$@" >"$work/log" 2>&1; then
    echo "smoke: the reader of $format fails; 'script/fuzz $format' finds and keeps the input"
    tail -n 40 "$work/log"
    failed=1
  fi
done
exit "$failed"
