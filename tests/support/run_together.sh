#!/usr/bin/env bash
# Six commands at a time that write the same new file, and six runs of a study into the same new folder: of each six one
# has to say that it did, and what is there has to be whole.
# usage: run_together.sh LOBE [ROUNDS]   prints each violation and, last, a summary; status 1 if there is any
set -euo pipefail
lobe=$(realpath "$1") rounds=${2:-10}

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
cd "$folder"
cat >s.toml <<'END'
[study]
name = "s"
lightings = ["point", "daylight"]
[[family]]
name = "Ward"
model = "ward"
m = [0.1, 0.2, 0.3]
END

lost=0 others=0
# together FILE COMMAND...: the file that has to be whole afterwards
together() {
  local file=$1 one
  shift
  rm -f status.*
  for one in 1 2 3 4 5 6; do
    (
      status=0
      "$lobe" "$@" >/dev/null 2>&1 || status=$?
      echo "$status" >"status.$one"
    ) &
  done
  wait
  local succeeded
  succeeded=$(cat status.* | grep -c '^0$' || true)
  if [ "$succeeded" != 1 ]; then
    others=$((others + 1))
    echo "$succeeded of six say that they wrote $file"
  fi
  if ! "$lobe" verify "$file" >/dev/null 2>&1; then
    lost=$((lost + 1))
    echo "$file is not whole"
  fi
}
for ((round = 0; round < rounds; ++round)); do
  rm -rf out t.h5
  together out/s.h5 run s.toml -o out
  together t.h5 tabulate ward:m=0.2 --grid gauss:16x32 -o t.h5
  for file in out/s.point.distance.csv out/s.daylight.distance.csv; do
    if [ ! -s "$file" ]; then
      lost=$((lost + 1))
      echo "$file is missing"
    fi
  done
done
echo "$rounds rounds of six runs and six tabulations: $lost files lost, $others sixes with other than one success"
((lost + others == 0))
