#!/bin/sh
# For Doxygen: a header whose declarations are in the group of its room, which is its folder (lib/include/lobe/ROOM).
# usage: room.sh FILE
room=$(basename "$(dirname "$1")")
case $1 in *.dox | */lobe/"$(basename "$1")") cat "$1" && exit ;; esac
# In place of the empty line behind the brace, so that lines keep their numbers.
sed -e "/^namespace .*lobe {\$/{N;s|{\n|{ /** @addtogroup $room\n@{ */|}" -e "s|^}  // namespace lobe\$|/** @} */ }|" "$1"
