#!/usr/bin/env bash
# Builds the documentation site: pages by pandoc, the C++ reference by Doxygen, commands and models from the command's
# own tables, models with pictures unless told otherwise. What is not older than its source is kept.
# usage: build.sh PROGRAMS BUILD [--no-pictures]
#   PROGRAMS  folder of lobe, lobe_make_pages and lobe_make_site
#   BUILD     folder for site/ and for what is made on the way to it
set -euo pipefail
programs=$(realpath "$1")
mkdir -p "$2"
build=$(realpath "$2")
cd "$(dirname "$0")/../.."
fragments=$build/fragments
mkdir -p "$fragments/docs" "$fragments/models" "$build/site"

# Pictures of all models: spheres beside a grey one, values and albedos as charts of a study. New programs draw anew.
if [ "${3:-}" != --no-pictures ]; then
  pictures=$build/pictures
  mkdir -p "$pictures"
  if [ ! "$pictures/models.h5" -nt "$programs/lobe" ]; then
    "$programs/lobe_make_pages" study >"$pictures/models.toml"
    "$programs/lobe" run "$pictures/models.toml" --output "$pictures" --force --quiet >/dev/null
    for picture in "$pictures"/models.chart.*.png; do
      mv "$picture" "$pictures/${picture##*/models.chart.}"
    done
  fi
  "$programs/lobe_make_pages" examples | while read -r model material; do
    [ "$pictures/$model.png" -nt "$programs/lobe" ] || printf '%s\0%s\0' "$material" "$pictures/$model.png"
  done | xargs --null --no-run-if-empty --max-args=2 --max-procs="$(nproc)" \
    sh -c '"$0" preview "$1" -o "$2" --columns 2 --force --quiet >/dev/null' "$programs/lobe"
  cp "$pictures"/*.png "$fragments/models/"
fi
"$programs/lobe_make_pages" site "$fragments" "$fragments/models"

# Example programs, one after the other.
examples=$build/examples.md
{
  printf '# Example programs\n\nComplete programs that use the installed library; `examples/` has their build file.\n'
  for program in examples/*.cpp; do
    printf '\n## %s\n\n```cpp\n' "$(basename "$program")"
    cat "$program"
    printf '```\n'
  done
} >"$examples.new"
cmp -s "$examples.new" "$examples" || cp "$examples.new" "$examples"

# The page of the last benchmarks, or how to get one.
performance=$build/performance.md
for measured in build/performance.md docs/site/performance.md; do
  [ -f "$measured" ] || continue
  cmp -s "$measured" "$performance" || cp "$measured" "$performance"
  break
done

# GitHub's Markdown with formulas.
for page in README.md CONTRIBUTING.md CHANGELOG.md docs/*.md "$examples" "$performance"; do
  fragment=$fragments/${page#"$build"/}
  fragment=${fragment%.md}.html
  [ "$fragment" -nt "$page" ] || printf '%s\0%s\0' "$page" "$fragment"
done | xargs --null --no-run-if-empty --max-args=2 --max-procs="$(nproc)" \
  sh -c 'pandoc --from=gfm+tex_math_dollars --to=html5 --mathml --wrap=none --fail-if-warnings \
         --lua-filter=docs/site/blocks.lua "$0" -o "$1"'

# The C++ reference.
api=$build/site/api/index.html
sources=(lib/include docs/site/Doxyfile docs/site/library.dox docs/site/room.sh docs/site/api.css)
if [ ! -f "$api" ] || [ -n "$(find "${sources[@]}" -newer "$api")" ]; then
  mkdir -p "$build/site/api"
  # The name at the head of its pages leads back to the site.
  (cd "$build" && doxygen -w html header.html footer.html doxygen.css)
  sed -i '/id="projectname"/s|$projectname|<a href="../index.html">&</a>|' "$build/header.html"
  if ! { cat docs/site/Doxyfile && printf 'HTML_HEADER = "%s"\nOUTPUT_DIRECTORY = "%s"\n' "$build/header.html" "$build/site"; } |
    doxygen -; then
    rm -f "$api" # to be made again
    exit 1
  fi
fi

"$programs/lobe_make_site" . "$fragments" "$build/site"
