#!/bin/sh
# Checks the rules of wording that a tool can check (CONTRIBUTING.md, "Wording"): in public headers \throws, \param and
# \return stand on lines of their own, and no docstring begins with "The same", "Of", "What" or "That of"; neither these
# headers nor README.md nor docs/*.md say "idem".
# usage: check_wording.sh SOURCE_DIRECTORY
set -u
cd "$1" || exit 1
headers=$(find lib/include -name '*.hpp' | sort)
[ -n "$headers" ] || { echo "check_wording: no headers below $1/lib/include"; exit 1; }
failed=0
refuse() { # complaint, lines FILE:NUMBER:TEXT
  [ -z "$2" ] || { printf '%s\n' "$2" | sed -E "s|^([^:]*:[0-9]*):[ ]*|\1: $1: |"; failed=1; }
}
# shellcheck disable=SC2086
refuse 'the tag belongs on a line of its own' "$(grep -nHE '//.*[^/ ].*[\](throws|param|returns?)( |$)' $headers)"
# shellcheck disable=SC2086
refuse 'say what it is instead of "idem"' "$(grep -nHiwE 'idem' README.md docs/*.md $headers)"
# The first line of a docstring, after a declaration or beside one.
# shellcheck disable=SC2086
refuse 'begin with what it is or does' "$(awk '
  FNR == 1 { previous = "" }
  { first = /^ *\/\/\/ / && previous !~ /^ *\/\/\// || /\/\/\/</ }
  first && /\/\/\/<? +(The same|[Oo]f|[Ww]hat|[Tt]hat of)( |$)/ { print FILENAME ":" FNR ":" $0 }
  { previous = $0 }' $headers)"
exit $failed
