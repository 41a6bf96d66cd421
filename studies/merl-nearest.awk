# How often the nearest fit is one of the same measured material, how often one of the same model.
#
#     awk -f studies/merl-nearest.awk out/merl-fits.*.distance.csv

BEGIN { FS = "," }

function family_of(name) { sub(/ .*/, "", name); return name }
function measured(name) { sub(/[^ ]* /, "", name); return name }
function report() { if (total) printf "| %s | %.0f %% | %.0f %% |\n", metric, 100 * same / total, 100 * kin / total }

FNR == 1 {
  report()
  metric = FILENAME
  sub(/.*merl-fits\./, "", metric)
  sub(/\.distance\.csv/, "", metric)
  same = kin = total = 0
  for (c = 2; c <= NF; ++c) name[c] = $c
  next
}

{
  nearest = 0
  for (c = 2; c <= NF; ++c) if (name[c] != $1 && (nearest == 0 || $c < $nearest)) nearest = c
  ++total
  same += measured(name[nearest]) == measured($1)
  kin += family_of(name[nearest]) == family_of($1)
}

END { report() }
