#!/bin/sh
# Runs a program on the instrumented OpenCL runtime oclgrind and fails unless it exits with 0 and oclgrind has nothing
# to report. oclgrind itself exits with 0 even after an out-of-bounds write, so its log decides: it must exist and be
# empty.
# With LOBE_CL_KERNELS the names of the kernels that were launched go into that file, by the library LOBE_OPENCL_SHIM.
# usage: run_oclgrind.sh LOG PROGRAM [ARGUMENT...]
set -u
log=$1
shift
rm -f "$log"
if [ -n "${LOBE_CL_KERNELS:-}" ]; then
  rm -f "$LOBE_CL_KERNELS"
  # oclgrind preloads its own library, and nothing else.
  # shellcheck disable=SC2016
  set -- sh -c 'LD_PRELOAD="$LOBE_OPENCL_SHIM:$LD_PRELOAD" exec "$@"' sh "$@"
fi
LOBE_TEST_SCALE=small LOBE_DEVICE='' oclgrind --check-api --data-races --uninitialized --log "$log" "$@"
status=$?
if [ "$status" -ne 0 ]; then
  echo "run_oclgrind: the program failed with exit status $status"
  [ -f "$log" ] && head -n 40 "$log"
  exit 1
fi
if [ ! -f "$log" ]; then
  echo "run_oclgrind: no log at $log; oclgrind did not run"
  exit 1
fi
if [ -s "$log" ]; then
  echo "run_oclgrind: oclgrind reports:"
  head -n 40 "$log"
  exit 1
fi
