#!/bin/sh
# Fuzzes each format for two thousand inputs or two seconds, with a fixed seed, and leaves nothing behind.
# usage: smoke.sh DIRECTORY_OF_PROGRAMS
set -u
programs=$1
here=$(dirname "$0")
work=$(mktemp --directory "$PWD/smoke-XXXXXX")
trap 'rm -rf "$work"' EXIT
failed=0
formats=$("$programs/lobe_fuzz_seeds")
[ -n "$formats" ] || { echo "smoke: no formats"; exit 1; }
for format in $formats; do
  "$programs/lobe_fuzz_seeds" "$format" "$work/$format" || failed=1
  [ -n "$(ls "$work/$format")" ] || echo "smoke: no seeds of $format; set LOBE_DATA_DIR"
  set -- -seed=1 -runs=2000 -max_total_time=1 -timeout=60 -artifact_prefix="$work/"
  [ ! -f "$here/$format.dict" ] || set -- "$@" -dict="$here/$format.dict"
  if ! LOBE_FUZZ_FORMAT=$format "$programs/lobe_fuzz" "$work/$format" "$@" >"$work/log" 2>&1; then
    echo "smoke: the reader of $format fails; 'script/fuzz $format' finds and keeps the input"
    tail -n 40 "$work/log"
    failed=1
  fi
done
exit "$failed"
