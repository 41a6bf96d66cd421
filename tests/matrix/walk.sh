#!/usr/bin/env bash
# Asks every verb of every kind of reflectance, and says of each cell of that matrix whether it holds
#   number     an answer whose errors are known
#   undefined  a refusal to measure whose message says what does not exist (tests/matrix/undefined)
#   hole       anything else: another refusal, an error that is not known, no answer in time
# No answer in time is one in so many seconds of processor time.
# usage: walk.sh LOBE [--short] [--jobs N] [--seconds N] [--page FILE] [--found FILE] [--only OPERAND] [--verb VERB]
# Fails where a hole is not among the known ones (tests/matrix/holes), and where one of these is none any more: the list
# only becomes shorter. --page writes the matrix as docs/closure.md, for which all cells are walked. --found keeps what
# was found, one cell a line, of which write_page.sh makes the page: of cells in several lines the last one counts.
# Of measured files those below LOBE_DATA_DIR are taken, where that is set.
set -euo pipefail

# One cell, in a folder of its own: prints "operand<TAB>verb<TAB>class<TAB>seconds<TAB>message".
walk_cell() {
  local name=$1 verb=$2 command=$3 here=$MATRIX_WORK/cell.$BASHPID status=0 begin end class message
  mkdir "$here"
  begin=$(date +%s%N)
  # The words of a command hold no blanks but in the options of files.
  local words=()
  read -ra words <<<"$command"
  for k in "${!words[@]}"; do
    case ${words[k]} in
      F) words[k]=$MATRIX_OPERAND ;;
      PHONG) words[k]=phong:n=5 ;;
      STUDY) words[k]=$MATRIX_STUDY ;;
      O | O.*) words[k]=$here/out${words[k]#O} ;;
      table:LIGHT) words[k]=table:light.h5 ;;
    esac
  done
  (cd "$MATRIX_WORK" && ulimit -t "$MATRIX_SECONDS" && "$MATRIX_LOBE" "${words[@]}" --no-progress) \
    >"$here/stdout" 2>"$here/stderr" </dev/null || status=$?
  end=$(date +%s%N)
  message=$(grep -m 1 '^lobe: error: ' "$here/stderr" | sed 's/^lobe: error: //' || true)
  class=hole
  case $status in
    0) class=number ;;
    1) [ "${words[0]}" = check ] && class=number ;;
    137 | 152) message="no answer in $MATRIX_SECONDS s of processor time" ;;
    *) if [ -n "$message" ] && [[ "${words[0]}" =~ ^(product|norm|distance|angle|gram|distance-matrix|approximate|fit|run|square-root|export)$ ]] && grep -qEf <(sed '/^#/d;/^$/d' "$MATRIX_HERE/undefined") <<<"$message"; then
         class=undefined
       fi ;;
  esac
  if [ $class = number ] && grep -qE 'unknown|\bnan\b' "$here/stdout"; then
    class=hole
    message=$(grep -m 1 -E 'unknown|\bnan\b' "$here/stdout")
  fi
  if [ $class = number ] && [ "$verb" = "largest albedo" ] && ! grep -q 'albedo' "$here/stdout"; then
    class=hole
    message="no largest albedo"
  fi
  printf '%s\t%s\t%s\t%s\t%s\n' "$name" "$verb" "$class" $(((end - begin) / 1000000)) "$message"
  rm -r "$here"
}

trimmed() {
  local text=${1#"${1%%[![:space:]]*}"}
  printf "%s" "${text%"${text##*[![:space:]]}"}"
}

# The study of an operand beside phong:n=5, with all metrics of the literature.
write_study() {
  local operand=$1 content=$2
  echo '[study]'
  echo 'name = "s"'
  echo 'lightings = ["mean-albedo"]'
  echo "comparison_metrics = [$MATRIX_METRICS]"
  echo 'comparison_tolerance = 1e-2'
  if [ "$content" = file ]; then
    echo '[[measured]]'
    echo "name = \"a\""
    echo "file = \"$operand\""
  else
    echo '[[material]]'
    echo 'name = "a"'
    sed 's/; /\n/g' <<<"$content"
  fi
  printf '[[material]]\nname = "b"\nmodel = "phong"\nn = 5\n'
}

if [ "${1:-}" = --cell ]; then
  MATRIX_OPERAND=$4
  MATRIX_STUDY=$5
  walk_cell "$2" "$3" "$6"
  exit 0
fi

MATRIX_LOBE=$(realpath "$1")
shift
MATRIX_HERE=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
MATRIX_SECONDS=120
is_short=false
jobs=1
page=
kept=
only=
only_verb=
while [ $# -gt 0 ]; do
  case $1 in
    --short) is_short=true ;;
    --jobs) jobs=$2; shift ;;
    --seconds) MATRIX_SECONDS=$2; shift ;;
    --page) page=$2; shift ;;
    --found) kept=$2; shift ;;
    --only) only=$2; shift ;;
    --verb) only_verb=$2; shift ;;
    *) echo "walk.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift
done
MATRIX_WORK=$(mktemp -d)
trap 'rm -rf "$MATRIX_WORK"' EXIT
MATRIX_METRICS='"ngan-l2", "low-l2", "bieron-l2", "bieron-log", "cube-root-l2"'
export MATRIX_LOBE MATRIX_HERE MATRIX_SECONDS MATRIX_WORK MATRIX_METRICS

make() { (cd "$MATRIX_WORK" && "$MATRIX_LOBE" "$@" --no-progress >/dev/null 2>&1) || echo "walk.sh: lobe $* failed" >&2; }
printf 'model = "custom"\nformula = "(n + 2) / (2 * pi) * exp(n * log_rv)"\nn = 7\n' >"$MATRIX_WORK/custom.toml"
make tabulate lambert:scale=0.4 --grid gauss:16x32 -o light.h5

cells=$MATRIX_WORK/cells
: >"$cells"
number=0
while IFS='|' read -r name operand content command; do
  name=$(trimmed "$name")
  [ -z "$name" ] || [ "${name:0:1}" = "#" ] && continue
  if [ "${name:0:1}" = + ]; then name=${name#+}; elif $is_short; then continue; fi
  [ -n "$only" ] && [ "$only" != "$name" ] && continue
  operand=$(trimmed "$operand")
  if [[ $operand == DATA/* ]]; then
    [ -n "${LOBE_DATA_DIR:-}" ] || continue
    operand=$LOBE_DATA_DIR/${operand#DATA/}
  fi
  command=$(trimmed "$command")
  if [ -n "$command" ]; then
    read -ra words <<<"$command"
    make "${words[@]}"
  fi
  number=$((number + 1))
  write_study "$operand" "$(trimmed "$content")" >"$MATRIX_WORK/study$number.toml"
  while IFS='|' read -r verb asked; do
    verb=$(trimmed "$verb")
    [ -z "$verb" ] || [ "${verb:0:1}" = "#" ] && continue
    if [ "${verb:0:1}" = + ]; then verb=${verb#+}; elif $is_short; then continue; fi
    [ -n "$only_verb" ] && [ "$only_verb" != "$verb" ] && continue
    asked=$(trimmed "$asked")
    printf '%s\0%s\0%s\0%s\0%s\0' "$name" "$verb" "$operand" "study$number.toml" "$asked" >>"$cells"
  done <"$MATRIX_HERE/verbs"
done <"$MATRIX_HERE/operands"

found=$MATRIX_WORK/found
xargs -0 -n 5 -P "$jobs" "$MATRIX_HERE/walk.sh" --cell <"$cells" | tee "$found" >&2

known=$(awk -F ' [|] ' '!/^#/ && NF > 1 { print $1 " | " $2 }' "$MATRIX_HERE/holes")
fault=0
while IFS=$'\t' read -r name verb class _ message; do
  if grep -qxF "$name | $verb" <<<"$known"; then
    if [ "$class" != hole ]; then
      echo "walk.sh: '$verb' of '$name' is no hole any more ($class); take it out of tests/matrix/holes"
      fault=1
    fi
  elif [ "$class" = hole ]; then
    echo "walk.sh: '$verb' of '$name' is a new hole: $message"
    fault=1
  fi
done <"$found"
for class in number undefined hole; do
  echo "$class: $(cut -f 3 "$found" | grep -cx $class || true)"
done
if [ -n "$kept" ]; then cp "$found" "$kept"; fi
if [ -n "$page" ]; then "$MATRIX_HERE/write_page.sh" "$found" >"$page"; fi
exit $fault
