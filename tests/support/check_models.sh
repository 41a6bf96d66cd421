#!/bin/sh
# Checks that a model is three files of one name: kernels/models/NAME.clh, lib/src/model/catalogue/NAME.cpp and
# tests/models/NAME.cpp. An entry may take the kernel of another model; a delta part has neither a kernel nor a test of
# its own. A kernel states the error that its test holds it to, and includes only files that there are.
# usage: check_models.sh SOURCE_DIRECTORY
set -u
cd "$1" || exit 1
failed=0
complain() {
  echo "check_models: $*"
  failed=1
}
need() { # file whose
  [ -f "$1" ] || complain "$2 has no $1"
}

checked=0
for kernel in kernels/models/*.clh; do
  [ -e "$kernel" ] || continue
  checked=$((checked + 1))
  name=$(basename "$kernel" .clh)
  need "lib/src/model/catalogue/$name.cpp" "$kernel"
  need "tests/models/$name.cpp" "$kernel"
  grep -q "^real $name(" "$kernel" || complain "$kernel does not define 'real $name('"
  # The bound in double precision, where the comment has it as a number.
  stated=$(tr '\n' ' ' <"$kernel" | sed 's|// ||g' | sed -n 's/.*Relative error: \([0-9.]*\) eps.*/\1/p')
  budget=$(sed -n 's/.*\.budget = {\([0-9.]*\),.*/\1/p' "tests/models/$name.cpp" 2>/dev/null)
  if [ -n "$stated" ] && [ -n "$budget" ] && [ "$stated" != "$budget" ]; then
    complain "$kernel states an error of $stated eps, tests/models/$name.cpp has $budget"
  fi
done
for entry in lib/src/model/catalogue/*.cpp; do
  [ -e "$entry" ] || continue
  checked=$((checked + 1))
  name=$(basename "$entry" .cpp)
  grep -q "^CatalogueEntry ${name}_entry() {" "$entry" || complain "$entry does not define '${name}_entry()'"
  grep -q "\.name = \"$name\"" "$entry" || complain "$entry does not describe the model '$name'"
  grep -q '\.has_delta = true' "$entry" && continue
  need "tests/models/$name.cpp" "$entry"
  kernel=$(sed -n 's/.*\.kernel = "\([^"]*\)".*/\1/p' "$entry")
  need "kernels/models/$kernel.clh" "$entry"
  if [ "$kernel" != "$name" ] && [ -f "kernels/models/$name.clh" ]; then
    complain "$entry takes the kernel '$kernel' beside kernels/models/$name.clh"
  fi
done
for test in tests/models/*.cpp; do
  [ -e "$test" ] || continue
  checked=$((checked + 1))
  name=$(basename "$test" .cpp)
  need "lib/src/model/catalogue/$name.cpp" "$test"
  grep -q "^ModelTest ${name}_test() {" "$test" || complain "$test does not define '${name}_test()'"
done
includes='s/^[ \t]*#[ \t]*include[ \t]*"\([^"]*\)".*/\1/p'
for included in $(find kernels \( -name '*.cl' -o -name '*.clh' \) -exec sed -n "$includes" {} + | sort -u); do
  need "kernels/$included" "an #include below kernels/"
done
[ "$checked" -gt 0 ] || { echo "check_models: no model in $1"; exit 1; }
exit $failed
