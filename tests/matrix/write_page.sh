#!/usr/bin/env bash
# Writes what walk.sh found as docs/closure.md.
# usage: write_page.sh FOUND
set -euo pipefail
found=$1
count() { cut -f 3 "$found" | grep -cx "$1" || true; }
mapfile -t operands < <(cut -f 1 "$found" | awk '!seen[$0]++')
cat <<END
# What works with what

Every verb is meant to take every reflectance. This page is written by a program that asks all of them
(\`tests/matrix/walk.sh\`), and a test fails where a cell that held an answer holds none any more.

Cells: **±** an answer whose errors are known ($(count number)); **∞** a refusal because the quantity is infinite or does not exist,
as the message says ($(count undefined)); **–** another refusal, an error that is not known, or no answer within the time allowed ($(count hole)).

END
printf '| verb |'
printf ' %s |' "${operands[@]}"
printf '\n|---|'
printf -- '---|%.0s' "${operands[@]}"
printf '\n'
awk -F '\t' '
  { cell[$2, $1] = $3 == "number" ? "±" : $3 == "undefined" ? "∞" : "–"
    if (!($2 in verbs)) { verbs[$2] = 1; rows[++count] = $2 }
    if (!($1 in columns)) { columns[$1] = 1; order[++width] = $1 } }
  END { for (r = 1; r <= count; ++r) {
          printf "| %s |", rows[r]
          for (c = 1; c <= width; ++c) printf " %s |", cell[rows[r], order[c]]
          printf "\n" } }' "$found"
cat <<END

The operands are in \`tests/matrix/operands\`, the commands in \`tests/matrix/verbs\`, the cells that are to be closed in
\`tests/matrix/holes\`. \`tests/matrix/walk.sh build/bin/lobe --page docs/closure.md\` walks all of them.
END
