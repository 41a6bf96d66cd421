#!/bin/sh
# Checks that a library built with LOBE_HIDE_SYMBOLS exports what its public headers declare, and nothing else of lobe's:
# each function, class and variable that it exports is named in one of them. Instances of templates of the standard
# library, which the language has every library export, are left out.
# usage: check_exports.sh LIBRARY INCLUDE_DIRECTORY...
set -u
library=$1
shift
symbols=$(nm -DC --defined-only "$library" | sed 's/^[0-9a-f]* *//') || exit 1
[ -n "$symbols" ] || { echo "check_exports: no symbols in $library"; exit 1; }
words=$(find "$@" -name '*.hpp' -exec cat {} + | sed 's|//.*||' | grep -oE '[A-Za-z_][A-Za-z0-9_]*' | sort -u)
{ echo "$words"; echo "--"; echo "$symbols"; } | awk '
  /^--$/ { reads_symbols = 1; next }
  !reads_symbols { is_declared[$0] = 1; next }
  {
    kind = $1
    name = $0
    sub(/^[^ ]+ /, "", name)
    sub(/^(vtable|typeinfo|typeinfo name|VTT|guard variable|construction vtable) for /, "", name)
    if (name ~ /^(std|__gnu_cxx|void std|bool std|decltype)/ || (name !~ /lobe::/)) {
      if (kind == "W" || kind == "V" || kind == "u" || name ~ /^(_init|_fini|_edata|_end|__bss_start)$/) next
    }
    # The name itself: no arguments, no template arguments, no return type.
    sub(/\[abi:[^]]*\]/, "", name)
    while (sub(/<[^<>]*>/, "", name)) {}
    sub(/\(.*/, "", name)
    sub(/.* /, "", name)
    if (name ~ /^(std|__gnu_cxx|Eigen|fmt)::/ && (kind == "W" || kind == "V" || kind == "u")) next
    count = split(name, parts, "::")
    for (i = 1; i <= count; ++i) {
      part = parts[i]
      sub(/^~/, "", part)
      if (part == "" || part ~ /^operator/ || part in is_declared) continue
      print "check_exports: " $0 " is exported, and no public header declares " part
      failed = 1
      break
    }
  }
  END { exit failed }
'
