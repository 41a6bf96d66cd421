#!/usr/bin/env bash
# Writes what walk.sh found as docs/closure.md. Of cells in several lines the last one counts.
# usage: write_page.sh FOUND
set -euo pipefail
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
found=$(mktemp)
trap 'rm -f "$found"' EXIT
# In the order of the lists of operands and verbs.
awk -F '\t' '
  function name(line) { sub(/^[+]/, "", line); sub(/ *[|].*/, "", line); return line }
  FILENAME == ARGV[1] { if (!/^(#|$)/) operand[++operands] = name($0); next }
  FILENAME == ARGV[2] { if (!/^(#|$)/) verb[++verbs] = name($0); next }
  NF > 3 { line[$1, $2] = $0 }
  END { for (o = 1; o <= operands; ++o)
          for (v = 1; v <= verbs; ++v)
            if ((operand[o], verb[v]) in line) print line[operand[o], verb[v]] }
' "$here/operands" "$here/verbs" "$1" >"$found"
count() { cut -f 3 "$found" | grep -cx "$1" || true; }
mapfile -t operands < <(cut -f 1 "$found" | awk '!seen[$0]++')
cat <<END
# What works with what

Every verb is meant to take every reflectance. This page is written by a program that asks all of them
(\`tests/matrix/walk.sh\`), and a test fails where a cell that held an answer holds none any more.

Cells: **±** an answer whose errors are known ($(count number)); **∞** a refusal because the quantity is infinite or does not exist,
as the message says ($(count undefined)); **–** another refusal, an error that is not known, or no answer within the time allowed
($(count hole)); empty: not asked when this page was written.

Tables on grids of the kinds \`uniform\` and \`cells\` are not among the operands: their products under \`patch\`, \`mixture\` and \`density\` lights
are answered with "(error unknown)".

END
# A table of verbs and reflectances: their classes, or the seconds that they took.
table() {
  printf '| verb |'
  printf ' %s |' "${operands[@]}"
  printf '\n|---|'
  printf -- '---|%.0s' "${operands[@]}"
  printf '\n'
  awk -F '\t' -v what="$1" '
    { mark = $3 == "number" ? "±" : $3 == "undefined" ? "∞" : "–"
      if (what == "seconds") mark = sprintf($4 < 9950 ? "%.1f" : "%.0f", $4 / 1000)
      cell[$2, $1] = mark
      if (!($2 in verbs)) { verbs[$2] = 1; rows[++count] = $2 }
      if (!($1 in columns)) { columns[$1] = 1; order[++width] = $1 } }
    END { for (r = 1; r <= count; ++r) {
            printf "| %s |", rows[r]
            for (c = 1; c <= width; ++c) printf " %s |", (rows[r], order[c]) in cell ? cell[rows[r], order[c]] : ""
            printf "\n" } }' "$found"
}

table classes
cat <<END

## What is missing, and why

| reflectance | verb | reason |
|---|---|---|
END
awk -F ' [|] ' '!/^#/ && NF > 2 { print "| " $1 " | " $2 " | " $3 " |" }' "$here/holes"
cat <<END

## How long it takes

Seconds from the start of the command to its end, on a machine with two cores that had other work, too:

END
table seconds
cat <<END

The operands are in \`tests/matrix/operands\`, the commands in \`tests/matrix/verbs\`, the cells that are to be closed in
\`tests/matrix/holes\`. \`tests/matrix/walk.sh build/bin/lobe --page docs/closure.md\` walks all of them.
END
