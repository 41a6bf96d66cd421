#!/bin/sh
# Succeeds when a command fails and says why: for tests of the checks themselves.
# usage: expect_failure.sh PATTERN COMMAND [ARGUMENT...]
set -u
pattern=$1
shift
output=$("$@" 2>&1)
status=$?
if [ "$status" -eq 0 ]; then
  echo "expected a failure of: $*"
  exit 1
fi
if ! printf '%s\n' "$output" | grep -q -e "$pattern"; then
  echo "failed with status $status, but without '$pattern' in its output:"
  printf '%s\n' "$output"
  exit 1
fi
