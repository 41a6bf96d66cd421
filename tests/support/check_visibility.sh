#!/bin/sh
# Checks that public headers declare what they declare visible, where the library hides its symbols: each but the
# collecting ones (lobe/ROOM.hpp) opens the namespace with the attribute, has no other one, and declares no friend that
# is a function, which the attribute does not reach. Nor does it name a class that no public header defines: the whole
# class would be visible.
# usage: check_visibility.sh LIB_DIRECTORY
set -u
cd "$1" || exit 1
opens='namespace [[gnu::visibility("default")]] lobe {'
checked=0
failed=0
for header in $(find include -path 'include/lobe/*/*.hpp' | sort) version.hpp.in; do
  [ -e "$header" ] || continue
  checked=$((checked + 1))
  if [ "$(grep '^ *namespace ' "$header")" != "$opens" ]; then
    echo "check_visibility: $header: expected one namespace, opened by: $opens"
    failed=1
  fi
  if grep -nE '^ *friend [^{]*\(.*;$' "$header"; then
    echo "check_visibility: $header: a friend that is a function is hidden; expected a member, or its definition there"
    failed=1
  fi
  for name in $(sed -nE 's/^(class|struct) ([A-Za-z_]+);$/\2/p' "$header"); do
    grep -rqE "^(class|struct) $name( final)?( :.*)? \{" include && continue
    echo "check_visibility: $header: no public header defines $name; expected a class within the one that holds it"
    failed=1
  done
  if ! grep -qx '}  // namespace lobe' "$header"; then
    echo "check_visibility: $header: expected the namespace to end with: }  // namespace lobe"
    failed=1
  fi
done
[ "$checked" -gt 0 ] || { echo "check_visibility: no public header in $1"; exit 1; }
exit $failed
