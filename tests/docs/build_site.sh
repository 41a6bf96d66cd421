#!/usr/bin/env bash
# Builds the whole site anew, but for the pictures of models. Without the programs that it takes the test is skipped.
# usage: build_site.sh PROGRAMS BUILD
set -euo pipefail
for program in pandoc doxygen; do
  if ! command -v "$program" >/dev/null; then
    echo "$program is not installed; the documentation stays unchecked (script/bootstrap docs)"
    exit 77
  fi
done
rm -rf "$2"
"$(dirname "$0")/../../docs/site/build.sh" "$1" "$2" --no-pictures
