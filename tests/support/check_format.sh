#!/bin/sh
# Checks the layout of all sources against .clang-format.
# usage: check_format.sh CLANG_FORMAT ROOT
set -u
root=$2
files=$(find "$root/lib" "$root/kernels" "$root/tests" "$root/python-free-cli" "$root/bench" -type f \
  \( -name '*.cpp' -o -name '*.hpp' -o -name '*.cl' -o -name '*.clh' \) 2>/dev/null | sort)
[ -n "$files" ] || { echo "check_format: no sources below $root"; exit 1; }
echo "$files" | xargs "$1" --style=file --dry-run -Werror
