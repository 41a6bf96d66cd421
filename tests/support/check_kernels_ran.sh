#!/bin/sh
# Fails unless every kernel of a folder is in one of the lists of kernels that ran, *.kernels (run_oclgrind.sh).
# usage: check_kernels_ran.sh KERNELS_DIRECTORY LISTS_DIRECTORY
set -u
attribute='__attribute__\(\([a-z_]+\([^)]*\)\)\)'
sources=$(find "$1" -name '*.cl' -exec cat {} +)
kernels=$(echo "$sources" | tr '\n' ' ' | grep -oE "__kernel( +$attribute)* +void +[a-z_0-9]+" | sed 's/.* //' | sort -u)
words=$(echo "$sources" | grep -c '^__kernel')
[ "$(echo "$kernels" | wc -l)" -eq "$words" ] || { echo "check_kernels_ran: not every __kernel is understood"; exit 1; }
failed=0
for kernel in $kernels; do
  cat "$2"/*.kernels | grep -qx "$kernel" || { echo "check_kernels_ran: $kernel has not run"; failed=1; }
done
[ "$failed" -ne 0 ] || echo "$words kernels have run"
exit "$failed"
