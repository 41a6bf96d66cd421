#!/bin/sh
# Checks the order of the library's rooms (lib/CMakeLists.txt): a file includes only files of its own room and of rooms
# before it; OpenCL is seen in device/ alone, HDF5 in hdf5/ and formats/ (its version macros also in core/version.cpp), and
# public headers show neither. Public headers lie in include/lobe/ROOM; lobe/ROOM.hpp, for users only, includes all of a room,
# lobe/lobe.hpp all rooms.
# usage: check_rooms.sh LIB_DIRECTORY
set -u
lib=$1
files=$(find "$lib/src" "$lib/include" -type f \( -name '*.cpp' -o -name '*.hpp' \) | sort)
[ -n "$files" ] || { echo "check_rooms: no sources below $lib"; exit 1; }
echo "$files" | xargs awk -v lib="$lib/" '
  BEGIN {
    split("core device hemisphere model table algebra energy sampling reflectance metric compare cluster fit render " \
          "hdf5 formats lut plot study study/read study/run study/write study/report", names, " ")
    for (i in names) floor[names[i]] = i + 0
  }
  function complain(text) { print path ":" FNR ": " text; failed = 1 }
  FNR == 1 {
    path = FILENAME
    sub(lib, "", path)
    count = split(path, parts, "/")
    is_public = parts[1] == "include"
    is_umbrella = is_public && count == 3
    room = is_public ? parts[3] : parts[2]
    if (!is_public && room == "study") room = room "/" parts[3]
    if (is_umbrella) {
      sub(/\.hpp$/, "", room)
      umbrellas[room] = 1
    } else if (is_public) {
      seen[parts[3] "/" parts[4]] = 1
    }
    if (!(room in floor) && room != "lobe") complain("belongs to no known room; expected one of check_rooms.sh")
  }
  /^[ \t]*#[ \t]*include/ {
    name = $0
    sub(/^[ \t]*#[ \t]*include[ \t]*["<]/, "", name)
    sub(/[">].*/, "", name)
    if (name ~ /^CL\// && path != "src/device/opencl.hpp") complain("includes OpenCL outside src/device/opencl.hpp")
    if (name ~ /^(hdf5(_hl)?\.h|H5)/ && room != "hdf5" && room != "formats" && !(name == "H5public.h" && path == "src/core/version.cpp")) {
      complain("includes HDF5 outside hdf5/ and formats/")
    }
    if (is_public && name ~ /^(fmt|nlohmann|toml)/) complain("shows a private dependency in a public header")
    target = ""
    count = split(name, parts, "/")
    if (parts[1] == "lobe" && is_umbrella) {
      collected[room, substr(name, 6)] = 1
      if (room != "lobe" && parts[2] != room) complain("the header of the room " room " includes " name)
    } else if (parts[1] == "lobe") {
      target = parts[2]
      if (count != 3) complain("includes " name ", which is for users; expected the headers of what it takes")
    } else if (count > 1) {
      if (parts[1] in floor) target = parts[1]
      if (count == 3 && target == "study") target = target "/" parts[2]
      if (target != "" && is_public) complain("a public header includes the private " name)
    }
    if (target in floor && floor[target] > floor[room]) complain("room " room " includes " name " of the later room " target)
  }
  END {
    FNR = 1
    for (header in seen) {
      split(header, parts, "/")
      path = "include/lobe/" parts[1] ".hpp"
      if (!((parts[1], header) in collected)) complain("does not include lobe/" header)
    }
    path = "include/lobe/lobe.hpp"
    for (room in umbrellas) {
      if (room != "lobe" && !(("lobe", room ".hpp") in collected)) complain("does not include lobe/" room ".hpp")
    }
    exit failed
  }
'
