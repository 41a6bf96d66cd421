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

# Models and factors of the same name do not hide each other.
models=$("$1/lobe_make_pages" examples | wc -l)
pages=$(find "$2/site/models" -name '*.html' ! -name '*-factor.html' ! -name index.html | wc -l)
if [ "$models" -ne "$pages" ]; then
  echo "$models models, but $pages pages of models" >&2
  exit 1
fi
if ! grep -q 'id="properties"' "$2/site/models/lacquer.html" || ! [ -f "$2/site/models/lacquer-factor.html" ]; then
  echo "lacquer is a model and a factor; expected a page of each" >&2
  exit 1
fi
