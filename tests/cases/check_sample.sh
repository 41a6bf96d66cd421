#!/bin/sh
# Holds the lines that list_unnamed_cases finds in a sample against those that are marked there.
# usage: check_sample.sh LIST_UNNAMED_CASES SAMPLE
set -u
found=$("$1" "$2" | sed 's/^[^:]*:\([0-9]*\):.*/\1/')
expected=$(grep -n '// unnamed' "$2" | cut -d : -f 1)
[ -n "$expected" ] && [ "$found" = "$expected" ] && exit 0
echo "found lines:" $found
echo "expected lines:" $expected
exit 1
