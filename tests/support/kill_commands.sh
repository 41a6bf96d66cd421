#!/usr/bin/env bash
# Kills commands that write files at random moments, and gives each again: what is there has to be whole, the second
# command has to succeed without --force, and nothing else may be left.
# usage: kill_commands.sh LOBE [KILLS [SEED]]   prints each violation and, last, a summary; status 1 if there is any
set -euo pipefail
lobe=$(realpath "$1") kills=${2:-100}
RANDOM=${3:-1}

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
"$lobe" export phong:n=5 --format csv -o in.csv >/dev/null 2>&1

commands=(
  "run s.toml -o out"
  "compose ward:m=0.3 phong:n=5 --grid gauss:16x32 -o c.h5"
  "tabulate ward:m=0.2 --grid gauss:32x64 -o t.h5"
  "import in.csv --grid gauss:16x32 -o i.h5"
  "export phong:n=5 --format utia -o p.utia"
  "run s.toml --shard 1/2 -o d"
)
written=("out/s.h5 out/s.point.distance.csv out/s.daylight.distance.csv" c.h5 t.h5 i.h5 p.utia d/s.1-of-2.shard)

clean() {
  find . -mindepth 1 ! -name s.toml ! -name in.csv -delete
}

# Milliseconds that each takes unhindered.
durations=()
for command in "${commands[@]}"; do
  clean
  begin=$(date +%s%3N)
  # shellcheck disable=SC2086 # words of a command
  "$lobe" $command >/dev/null 2>&1
  durations+=($(($(date +%s%3N) - begin)))
done

killed=0 lost=0 refused=0 left=0
violation() {
  echo "$1: $2"
}
for ((round = 0; round < kills; ++round)); do
  which=$((RANDOM % ${#commands[@]}))
  duration=${durations[which]}
  # Half of them in the last part, where files appear.
  if ((RANDOM % 2)); then
    after=$((duration * (RANDOM % 110) / 100))
  else
    after=$((duration * (75 + RANDOM % 40) / 100))
  fi
  clean
  status=0
  # shellcheck disable=SC2086
  "$lobe" ${commands[which]} >/dev/null 2>&1 &
  sleep "$((after / 1000)).$(printf %03d $((after % 1000 + 1)))"
  kill -KILL $! 2>/dev/null || true
  { wait $! || status=$?; } 2>/dev/null
  ((status == 137)) || continue
  killed=$((killed + 1))
  for file in ${written[which]}; do
    if [[ $file = *.@(h5|shard) && -e $file ]] && ! "$lobe" verify "$file" >/dev/null 2>&1; then
      lost=$((lost + 1))
      violation "not whole after $after ms" "$file of ${commands[which]}"
    fi
  done
  # shellcheck disable=SC2086
  if ! "$lobe" ${commands[which]} >/dev/null 2>error; then
    refused=$((refused + 1))
    violation "refused after $after ms" "${commands[which]}: $(cat error)"
  else
    for file in ${written[which]}; do
      if [ ! -e "$file" ]; then
        lost=$((lost + 1))
        violation "missing after $after ms" "$file"
      fi
    done
  fi
  rest=$(find . -mindepth 1 \( -name '.*' -o -name '*.tmp-*' -o -name '*.unfinished' -o -name '*.lock' \))
  if [ -n "$rest" ]; then
    left=$((left + 1))
    violation "left after $after ms" "$rest"
  fi
done
echo "$kills commands, $killed of them killed in time: $lost files lost, $refused refusals to go on, $left leftovers"
((lost + refused + left == 0))
