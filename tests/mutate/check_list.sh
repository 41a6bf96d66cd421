#!/bin/sh
# Holds the mutants of a small source against those that it ought to have: places (line: what stands there), as each has
# one of its mutants.
# usage: check_list.sh LIST_MUTANTS SAMPLE
set -eu
found=$("$1" 1 "$2" | cut -f 3,6 | sort)
expected=$(printf '%s\t%s\n' 4 2.5 4 - 5 += 6 '<=' 6 4 6 '&&' 6 '!=' 8 'std::max(sum, 1e-3)' 8 max 8 1e-3 8 'std::abs(-sum)' \
  8 'std::fmin(sum, 0)' 8 fmin 8 0 | sort)
[ "$found" = "$expected" ] && exit 0
echo "found:"
echo "$found"
echo "expected:"
echo "$expected"
exit 1
