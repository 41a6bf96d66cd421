#!/bin/sh
# Fails unless the shim (tests/support/opencl_shim.cpp) stands before every OpenCL entry point that some programs call.
# usage: check_shim.sh SHIM PROGRAM...
set -u
shim=$1
shift
called=$(nm --dynamic --undefined-only "$@" | sed -n 's/^ *U \(cl[A-Z][A-Za-z]*\)\(@.*\)\{0,1\}$/\1/p' | sort -u)
[ -n "$called" ] || { echo "check_shim: no OpenCL entry point is called"; exit 1; }
covered=$(nm --dynamic --defined-only "$shim" | sed -n 's/^.* T \(cl[A-Z][A-Za-z]*\)$/\1/p' | sort -u)
failed=0
for name in $called; do
  echo "$covered" | grep -qx "$name" || { echo "check_shim: $name is called and not in tests/support/opencl_shim.cpp"; failed=1; }
done
exit "$failed"
