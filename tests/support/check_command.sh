#!/bin/sh
# Checks that the command knows the library by its public headers alone: what it includes lies in lobe/ROOM, in its own
# folders, or is a header of lobe_text (lib/CMakeLists.txt).
# usage: check_command.sh COMMAND_DIRECTORY
set -u
files=$(find "$1" -type f \( -name '*.cpp' -o -name '*.hpp' \) | sort)
[ -n "$files" ] || { echo "check_command: no sources below $1"; exit 1; }
echo "$files" | xargs awk -v directory="$1/" '
  /^[ \t]*#[ \t]*include[ \t]*"/ {
    name = $0
    sub(/^[^"]*"/, "", name)
    sub(/".*/, "", name)
    if (name ~ /^(commands|interface|view)\// || name ~ /^lobe\/[a-z0-9_]+\/[a-z_]+\.hpp$/) next
    if (name == "core/text.hpp" || name == "core/shell.hpp" || name == "view_files.hpp") next
    path = FILENAME
    sub(directory, "", path)
    print path ":" FNR ": the command includes " name "; expected a public header of a room, or lobe_text"
    failed = 1
  }
  END { exit failed }
'
