#!/bin/sh
# Checks the recipes of CONTRIBUTING.md, sections "## A ..." with lists of files: every file is there, with <...> for each
# existing thing of that kind, and the files in which several stand mention each of them. CHANGELOG.md has its own words.
# Conversely a recipe has every file that mentions all there is of its kind, as a list kept by hand does; lightings are
# left out here, whose names are common words.
# usage: check_recipes.sh SOURCE_DIRECTORY
set -u
cd "$1" || exit 1
failed=0
complain() {
  echo "check_recipes: $*"
  failed=1
}
names() { # pattern
  for file in $1; do
    [ -e "$file" ] && basename "$file" | sed 's/\..*//'
  done
}
# What there is of a kind; several spellings of one are joined by |.
examples() { # section
  case $1 in
    'A model') names 'kernels/models/*.clh' ;;
    'An anisotropic model') names 'kernels/models/*_anisotropic.clh' ;;
    'A factor on models') names 'kernels/factors/*.clh' ;;
    'A metric of the literature') sed -n '/^enum class LiteratureMetric /,/^}/s/^  \([a-z_0-9]*\),\{0,1\}\( .*\)\{0,1\}$/\1/p' lib/include/lobe/compare/literature_metric.hpp | grep . ;;
    'A lighting') sed -n '/enum class Kind/,/}/s/^ *\([a-z_]*\),\{0,1\} *\/\/\/<.*/\1/p' lib/include/lobe/metric/lighting.hpp | sed 's/^patches$/patches|patch/' ;;
    'A file format')
      for file in lib/src/formats/*.cpp; do
        sed -n "s/^const Format k\([A-Za-z]*\)Format{\"\([a-z-]*\)\", \"\([^,(\"]*\).*/$(basename "$file" .cpp)|\1|\2|\3/p" "$file" |
          sed -e 's/ *$//' -e 's/ /_/g'
      done ;;
    'A subcommand') names 'python-free-cli/commands/*.cpp' | sed 's/^\(.*\)_command$/\1_command|\1/' ;;
    *) complain "the section '$1' is of an unknown kind; tell check_recipes.sh where to find what there is" >&2 ;;
  esac
}

# Files other than those of a recipe in which all of a kind are mentioned as words of their own.
check_lists() { # section, examples, paths
  [ "$(echo "$2" | wc -w)" -ge 4 ] && [ "$1" != 'A lighting' ] || return 0
  files=$(find docs kernels lib python-free-cli studies tests -type f \( -name '*.?pp' -o -name '*.c' -o -name '*.cl*' -o -name '*.md' \
    -o -name '*.txt' -o -name '*.sh' -o -name '*.toml' -o -name '*.in' \))
  for example in $2; do
    [ -n "$files" ] || return 0
    # shellcheck disable=SC2086
    files=$(grep -liwE "$(echo "$example" | sed 's/[-_]/[-_ ]{0,1}/g')" $files /dev/null)
  done
  for file in $files; do
    case " docs/model-costs.md $(echo "$3" | tr '\n' ' ') " in
      *" $file "*) ;;
      *) complain "$1: $file lists all there are, and the recipe does not name it" ;;
    esac
  done
}

recipes=$(sed -n '/^## A/,/^## [^A]/{s/^## //p;/^- `/p;}' CONTRIBUTING.md)
[ -n "$recipes" ] || complain 'CONTRIBUTING.md has no recipe'
while read -r line; do
  case $line in
    '- '*) ;;
    *)
      [ -z "${section:-}" ] || check_lists "$section" "${found:-}" "$paths"
      section=$line
      found=
      paths=
      continue
      ;;
  esac
  found=${found:-$(examples "$section")}
  [ -n "$found" ] || complain "$section: there is none to compare with"
  # The paths before what is said of them; a pattern stands for several files.
  set -f
  paths="$paths $(echo "$line" | sed 's/:.*//' | grep -o '`[^`]*`' | tr -d '`')"
  for path in $(echo "$line" | sed 's/:.*//' | grep -o '`[^`]*`' | tr -d '`'); do
    case $path in script/* | CHANGELOG.md) [ -e "$path" ] || complain "$section: there is no $path"; continue ;; esac
    set +f
    # shellcheck disable=SC2086
    text=$(case $path in *'<'*) ;; *) cat $path ;; esac) || { complain "$section: there is no $path"; continue; }
    set -f
    for example in $found; do
      place=$(echo "$path" | sed "s/<[a-z]*>/${example%%|*}/")
      if [ "$place" != "$path" ]; then
        [ -e "$place" ] || complain "$section: there is no $place"
        continue
      fi
      words=$(echo "$example" | sed 's/[-_]/[-_ ]{0,1}/g')
      printf '%s\n' "$text" | grep -qiE "$words" || complain "$section: $path does not mention '${example%%|*}'"
    done
  done
  set +f
done <<END
$recipes
END
check_lists "$section" "$found" "$paths"
exit $failed
