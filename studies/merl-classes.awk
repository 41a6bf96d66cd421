# Which family represents which class of materials best: means over classes of a table of residuals.
#
#     awk -f studies/merl-classes.awk out/merl-fits.point.non-negative-residuals.csv
#
# Per class of MERL materials and family: the mean relative residual over the fits of other families, and how many of
# them it represents best among the families that are not their own.

BEGIN {
  FS = ","
  order = "metal paint metallic-paint plastic phenolic acrylic rubber fabric wood stone"
}

function class_of(name) {
  if (name ~ /metallic-paint/) return "metallic-paint"
  if (name ~ /paint/) return "paint"
  if (name ~ /phenolic/) return "phenolic"
  if (name ~ /acrylic/) return "acrylic"
  if (name ~ /rubber|latex/) return "rubber"
  if (name ~ /fabric|felt|foam/) return "fabric"
  if (name ~ /-2[0-9][0-9]$/) return "wood"
  if (name ~ /oxide|aventurnine|obsidian|jasper|nitrade|hematite/) return "stone"
  if (name ~ /steel|brass|bronze|aluminium|chrome|nickel|ss440|tungsten/) return "metal"
  return "plastic"
}

FNR == 1 {
  families = NF - 2
  for (f = 1; f <= families; ++f) family[f] = $(f + 1)
  next
}

{
  own = 0
  best = 0
  for (f = 1; f <= families; ++f) if (index($1, family[f] " ") == 1) own = f
  class = class_of($1)
  for (f = 1; f <= families; ++f) {
    if (f == own || $(f + 1) == "") continue
    sum[class, f] += $(f + 1)
    ++count[class, f]
    sum["all", f] += $(f + 1)
    ++count["all", f]
    if (best == 0 || $(f + 1) < $(best + 1)) best = f
  }
  ++wins[class, best]
  ++wins["all", best]
}

END {
  printf "| class |"
  for (f = 1; f <= families; ++f) printf " %s |", family[f]
  printf "\n|---|"
  for (f = 1; f <= families; ++f) printf "---|"
  printf "\n"
  n = split(order " all", classes, " ")
  for (k = 1; k <= n; ++k) {
    class = classes[k]
    printf "| %s |", class
    for (f = 1; f <= families; ++f) {
      if (count[class, f]) printf " %.3f (%d) |", sum[class, f] / count[class, f], wins[class, f]
      else printf " |"
    }
    printf "\n"
  }
}
