#!/bin/sh
# Checks that claims in loops of tests say which case failed.
# usage: check_cases.sh LIST_UNNAMED_CASES DIRECTORY
set -eu
find "$2" \( -name '*.cpp' -o -name '*.hpp' \) -exec "$1" {} +
