#!/bin/sh
# Checks that what launches kernels has their name: each file NAME.cl below kernels/ is built by one source of
# lib/src/device, which is called as one of the files that it builds, or as the first words of their names; and NAME.cl
# defines the kernel NAME.
# usage: check_launchers.sh SOURCE_DIRECTORY
set -u
cd "$1" || exit 1
failed=0
complain() {
  echo "check_launchers: $*"
  failed=1
}

# A line "launcher kernel" for each kernel that a launcher builds, in the order of the parts of a program.
built=$(for source in lib/src/device/*.cpp; do
  launcher=$(basename "$source" .cpp)
  [ "$launcher" = self_test ] || # which tells launchers apart by the names of their kernels
    tr '\n' ' ' <"$source" | grep -oE '(build_program|build_lobe_program|kernel)\([^;]*;' | grep -oE '[a-z_/]+\.cl"' |
    sed -e 's|.*/||' -e "s|\(.*\)\.cl\"|$launcher \1|" | sort -u
done)
checked=0
for file in $(find kernels -name '*.cl' | sort); do
  checked=$((checked + 1))
  kernel=$(basename "$file" .cl)
  tr '\n' ' ' <"$file" | grep -qE "__kernel[^{;]* void +$kernel\(" || complain "$file does not define the kernel '$kernel'"
  launchers=$(echo "$built" | grep " $kernel\$" | sed 's/ .*//')
  [ "$(echo "$launchers" | grep -c .)" -eq 1 ] ||
    complain "$file is built by $(echo "${launchers:-none}" | tr '\n' ' ')of lib/src/device; expected one launcher"
done
for launcher in $(echo "$built" | sed 's/ .*//' | sort -u); do
  echo "$built" | grep -qE "^$launcher $launcher(_[a-z_]+)?\$" || complain "lib/src/device/$launcher.cpp launches$(echo "$built" |
    sed -n "s/^$launcher / /p" | tr -d '\n'); expected it to be called as one of these"
done
[ "$checked" -gt 0 ] || { echo "check_launchers: no kernel in $1"; exit 1; }
exit $failed
