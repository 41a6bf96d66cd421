#!/bin/sh
# Says how many tests ctest left out, and why, by its log: entries that count as passed may hold tests that were skipped.
# usage: count_skips.sh BUILD_DIRECTORY
set -u
log=$1/Testing/Temporary/LastTest.log
[ -f "$log" ] || { echo "count_skips: $log is not there; run ctest first" >&2; exit 1; }
# GoogleTest prints its reason between the names of the test that is run and that is skipped.
awk '
  /^\[ RUN      \]/ { reason = "" }
  /: Skipped$/ { getline reason }
  /^\[  SKIPPED \] .*\(.* ms\)$/ { reasons[reason]++; count++ }
  END {
    print count + 0 " tests skipped"
    for (reason in reasons) print "  " reasons[reason] ": " reason
  }
' "$log"
