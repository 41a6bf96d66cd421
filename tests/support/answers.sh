#!/usr/bin/env bash
# The --json answers of a fixed list of commands, one file each, to be compared before and after a change that is to change
# no number: every command, every kind of operand, every lighting.
# usage: answers.sh LOBE FOLDER [MAKER]    makes FOLDER; then: diff -r BEFORE AFTER
# MAKER is the program that makes the files that LOBE is asked about, so that both programs can be asked about the same ones.
# Of real files those below LOBE_DATA_DIR stand in, where that is set. Times, sizes of machines and paths are left out.
set -euo pipefail
lobe=$(realpath "$1")
maker=$(realpath "${3:-$1}")
mkdir -p "$2"
out=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
cd "$work"
quiet() { "$maker" "$@" >/dev/null 2>&1 || echo "answers.sh: $maker $* failed" >&2; }

quiet tabulate ward:m=0.4 --grid gauss:16x32 -o iso.h5
quiet tabulate lambert:scale=0.4 --grid gauss:16x32 -o lambert.h5
quiet tabulate ward_anisotropic:m_x=0.5,m_y=0.8 --grid gauss:8x16 -o dense.h5
quiet tabulate ward:m=0.3 --grid uniform:12x24 -o uniform.h5
quiet export ward:m=0.4 --format csv -o rows.csv
quiet export phong:n=5 --format utia -o p.utia
quiet export ward:m=0.4,scale=0.5 --format merl -o paint.binary
quiet export ward:m=0.4 --format klems -o cells.xml
quiet export lambert:scale=0.3+mirror:rho=0.2 --format klems -o delta.xml
printf 'model = "custom"\nformula = "(n + 2) / (2 * pi) * exp(n * log_rv)"\nn = 7\n' >custom.toml
quiet approximate ward:m=0.2 -b lambert -b phong:n=20 -o mix.toml
cat >s.toml <<'END'
[study]
name = "s"
lightings = ["point", "daylight", "mean-albedo", "patch:0.5"]
[[family]]
name = "Ward"
model = "ward"
m = [0.2, 0.4, 0.6]
[[measured]]
file = "rows.csv"
name = "rows"
[[measured]]
file = "paint.binary"
name = "paint"
channels = ["green"]
END
sed '/measured/,$d' s.toml >formulas.toml
data=${LOBE_DATA_DIR:-}
hidden=${data:-no data}  # as it stands in paths
measured=(rows.csv p.utia paint.binary cells.xml)
if [ -n "$data" ]; then
  measured+=("$data/rgl_bsdf/vch_golden_yellow_rgb.bsdf" "$data/nbrdf/merl/alum-bronze.h5")
fi

count=0
ask() {
  count=$((count + 1))
  local file
  file=$out/$(printf '%03d' $count).json
  { echo "lobe $*" | sed "s|$hidden|\$LOBE_DATA_DIR|g"
    (ulimit -t 600; exec "$lobe" "$@" --json) 2>error || echo "status $?: $(tail -n 1 error)"
  } | sed -E -e "s|$hidden|\$LOBE_DATA_DIR|g" -e '/"(seconds|memory|global_memory|largest_buffer|driver|commit|version|file_bytes|available_bytes|built|git_commit)[a-z_]*": *[^ {[]/d' >"$file"
}

formulas=("ward:m=0.2" "cook_torrance:m=0.3" "lafortune:c_xy=-1,c_z=1,n=20" "ward_anisotropic:m_x=0.5,m_y=0.6"
  "lambert:scale=0.3+mirror:rho=0.2" "phong:n=5@pump" custom.toml "lambert:scale=0.5/0.3/0.2+ward:m=0.5")
lightings=("point" "daylight" "mean-albedo" "patch:0.5" "table:lambert.h5")
for lighting in "mixture:0.8=0.3,1.5=0.7" "density:1=1,2=0.5"; do
  ask gram ward:m=0.5 phong:n=5 --lighting "$lighting" --tolerance 1e-3
  ask gram rows.csv iso.h5 --lighting "$lighting"
done
for lighting in "${lightings[@]}"; do
  for formula in "${formulas[@]}"; do ask distance "$formula" phong:n=5 --lighting "$lighting" --tolerance 1e-3; done
  for file in iso.h5 dense.h5 "${measured[@]}" delta.xml; do
    ask gram "$file" lambert:scale=0.5 --lighting "$lighting"
  done
  ask gram mix.toml ward:m=0.3 --lighting "$lighting"
done
for lighting in point daylight patch:0.5; do
  ask product iso.h5 uniform.h5 --lighting "$lighting"
  ask product rows.csv rows.csv --lighting "$lighting"
  ask norm rows.csv --lighting "$lighting"
  ask norm rows.csv --grid gauss:16x32 --allow-unresolved --lighting "$lighting"
  ask norm iso.h5 --lighting "$lighting"
  ask norm ward:m=0.3 --lighting "$lighting"
  ask angle ward:m=0.3 ward:m=0.31 --lighting "$lighting"
  ask angle rows.csv lambert --lighting "$lighting"
  ask distance rows.csv mirror:rho=0.3 --lighting "$lighting"
  ask distance-matrix formulas.toml --lighting "$lighting"
  ask distance-matrix s.toml --lighting "$lighting"
  for target in cook_torrance:m=0.3 rows.csv iso.h5 p.utia; do
    ask approximate "$target" -b lambert -b phong:n=5 -b phong:n=20 --lighting "$lighting"
    ask approximate "$target" -b lambert -b phong:n=5 -b phong:n=20 --greedy 2 --lighting "$lighting"
  done
done
for target in ward:m=0.3 iso.h5 rows.csv; do
  for objective in l2 log perceptual; do ask fit "$target" --family lambert+ward --objective "$objective"; done
done
ask fit iso.h5 --family ward --lighting daylight
ask gram ward:m=0.3 rows.csv --domain-theta-max 70
ask gram iso.h5 rows.csv --domain-theta-max 70
for file in iso.h5 dense.h5 "${measured[@]}" delta.xml ward:m=0.2; do
  ask albedo "$file" --theta 0,30,60
  ask mean-albedo "$file"
  ask eval "$file" --theta-in 30 --theta-out 0,30 --delta-phi 180
  ask check "$file"
done
for file in iso.h5 dense.h5 "${measured[@]}" delta.xml; do ask info "$file"; done
ask tabulate ward:m=0.4 --grid gauss:12x24 --allow-unresolved -o t.h5 --force
for file in iso.h5 rows.csv cells.xml ward:m=0.4; do
  ask transpose "$file" -o t.h5 --force
  ask scale "$file" 0.5 -o t.h5 --force
  ask compose "$file" lambert:scale=0.5 --grid gauss:12x24 --allow-unresolved -o t.h5 --force
  ask self-compose "$file" --grid gauss:12x24 --allow-unresolved -o t.h5 --force
  ask spectrum "$file" --grid gauss:12x24 --allow-unresolved
  ask symmetrise "$file" --grid gauss:12x24 --allow-unresolved -o t.h5 --force
  ask normalise "$file" --grid gauss:12x24 --allow-unresolved -o t.h5 --force
done
ask compose ward:m=0.3 rows.csv --at 30,40,180
ask mix iso.h5 lambert.h5 --weights 0.5,0.5 -o t.h5 --force
ask resample iso.h5 --grid gauss:12x24 -o t.h5 --force
ask solve iso.h5 lambert.h5
ask square-root lambert.h5
ask balance iso.h5 -o t.h5 --force
for correction in g1 g2 controlled; do ask pump ward:m=0.3 --correction "$correction"; done
ask sample ward:m=0.3 --theta 30 --count 3 --seed 1
ask sample iso.h5 --theta 30 --count 3 --seed 1
ask import rows.csv --grid gauss:12x24 --allow-unresolved -o t.h5 --force
ask export ward:m=0.4 --format csv -o t.csv --force
ask models ward
ask verify iso.h5
ask run formulas.toml -o out1
ask run s.toml -o out2
for study in out1 out2; do
  for distances in "$study"/*.csv; do cp "$distances" "$out/$study.$(basename "$distances")"; done
done
echo "$count answers in $2"
