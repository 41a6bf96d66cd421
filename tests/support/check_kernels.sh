#!/bin/sh
# Type-checks every kernel file as OpenCL C 1.2, models as the launcher combines them (first, so that they have to
# include what they need), in both precisions and both pack widths. The compilers of OpenCL drivers do not report
# warnings; this is where they are seen.
# usage: check_kernels.sh CLANG KERNELS_DIRECTORY
set -u
clang=$1
directory=$2
failed=0
checked=0

# Clang 19 takes `?:` by lanes for a conversion of its condition to bool; then the groups of -Wconversion, which lacks a name
# for that alone.
conversions=-Wconversion
if ! echo 'double8 larger(double8 a, double8 b); double8 larger(double8 a, double8 b) { return a < b ? b : a; }' |
  "$clang" -x cl -cl-std=CL1.2 -fsyntax-only -Werror -Wconversion - 2>/dev/null; then
  conversions='-Wbool-conversion -Wconstant-conversion -Wenum-conversion -Wfloat-conversion -Wint-conversion
    -Wimplicit-float-conversion -Wimplicit-int-conversion -Wliteral-conversion -Wshorten-64-to-32 -Wsign-conversion'
fi

check() { # file [option...]
  file=$1
  shift
  for bits in 64 32; do
    for width in 8 1; do
      checked=$((checked + 1))
      "$clang" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -Xclang -fdeclare-opencl-builtins -fsyntax-only \
        -Wall -Wextra $conversions -Wdouble-promotion -Werror -I "$directory" \
        -D REAL_BITS=$bits -D REAL_WIDTH=$width "$@" "$file" || {
        echo "check_kernels: $file fails with REAL_BITS=$bits REAL_WIDTH=$width $*"
        failed=1
      }
    done
  done
}

for file in "$directory"/*.cl* "$directory"/parts/*.clh "$directory"/factors/*.clh "$directory"/lobes/*.cl* "$directory"/sampling/*.cl* "$directory"/products/*.cl*; do
  [ -e "$file" ] && check "$file"
done
for model in "$directory"/models/*.clh; do
  [ -e "$model" ] || continue
  case $model in
    *_anisotropic.clh) set -- -D ANISOTROPIC=1 ;;
    *) set -- ;;
  esac
  check "$directory/lobes/evaluate_lobes.cl" -include "$model" -D MODEL="$(basename "$model" .clh)" "$@"
done
for correction in g1 g2 controlled; do
  [ -e "$directory/lobes/pumping.clh" ] || continue
  for launcher in evaluate_lobes tabulate_pairs; do
    check "$directory/lobes/$launcher.cl" -D CURVES=2 -D PUMPING=pumping_$correction -include "$directory/lobes/pumping.clh" \
      -D FACTOR_0=factor_lacquer -include "$directory/factors/lacquer.clh" -include "$directory/lobes/combined.clh" \
      -D MODEL=combined
  done
done
[ "$checked" -gt 0 ] || { echo "check_kernels: no kernel in $directory"; exit 1; }
exit $failed
