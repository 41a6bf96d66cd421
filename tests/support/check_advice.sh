#!/bin/sh
# Checks that the library's messages do not name options of the command, which adds them itself
# (python-free-cli/interface/failure.cpp): no text in lib/src has a word --option. Excepted are the command lines that
# reports print, and "--set", by which studies call values from outside their files.
# usage: check_advice.sh LIB_DIRECTORY
set -u
files=$(find "$1/src" -type f \( -name '*.cpp' -o -name '*.hpp' \) ! -name report_data.cpp | sort)
[ -n "$files" ] || { echo "check_advice: no sources below $1/src"; exit 1; }
found=$(echo "$files" | xargs grep -nE '"[^"]*--[a-z][^"]*"' /dev/null | sed -E 's|[ \t]//.*||' |
  sed -E 's/--set([^a-z-])/set\1/g' | grep -E '"[^"]*--[a-z][^"]*"')
[ -z "$found" ] && exit 0
echo "$found" | sed 's/^/check_advice: an option of the command in a text of the library: /'
exit 1
