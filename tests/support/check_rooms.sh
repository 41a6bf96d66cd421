#!/bin/sh
# Checks the order of the library's rooms (lib/CMakeLists.txt): a file includes only files of its own room and of rooms
# before it; OpenCL is seen in device/ alone, HDF5 in io/ alone (its version macros also in core/version.cpp), and
# public headers show neither.
# usage: check_rooms.sh LIB_DIRECTORY
set -u
lib=$1
files=$(find "$lib/src" "$lib/include" -type f \( -name '*.cpp' -o -name '*.hpp' \) | sort)
[ -n "$files" ] || { echo "check_rooms: no sources below $lib"; exit 1; }
echo "$files" | xargs awk -v lib="$lib/" '
  BEGIN {
    split("core device hemisphere model table algebra energy metric io study", names, " ")
    for (i in names) floor[names[i]] = i + 0
    # The room that a public header belongs to.
    split("algebra:algebra any_material:study brdf_function:table comparison:metric rank_correlation:metric clustering:metric device:device directions:core embedding:metric approximation:metric approximation_pictures:io material_file:io energy:energy error:core estimate:core fit:metric foreign_export:io function_metric:metric fit_pictures:io lighting:metric " \
          "evaluate:model grid:hemisphere lobe:study material:model measured:io metric:metric model:model plausibility:energy plausibility_page:io pointwise:algebra prepare:energy repair:energy profile:model sampling_page:io proposal:model sampling:energy inverse:algebra least_value:table spectrum:algebra square_root:algebra " \
          "progress:core published:study chart:study study:study table:table table_file:io table_metric:metric table_lighting:metric table_pictures:io version:core " \
          "work:core", pairs, " ")
    for (i in pairs) { split(pairs[i], pair, ":"); public[pair[1] ".hpp"] = pair[2] }
  }
  function complain(text) { print path ":" FNR ": " text; failed = 1 }
  FNR == 1 {
    path = FILENAME
    sub(lib, "", path)
    split(path, parts, "/")
    is_public = parts[1] == "include"
    room = is_public ? public[parts[3]] : parts[2]
    if (!(room in floor)) complain("belongs to no known room; add it to check_rooms.sh")
  }
  /^[ \t]*#[ \t]*include/ {
    name = $0
    sub(/^[ \t]*#[ \t]*include[ \t]*["<]/, "", name)
    sub(/[">].*/, "", name)
    if (name ~ /^CL\// && path != "src/device/opencl.hpp") complain("includes OpenCL outside src/device/opencl.hpp")
    if (name ~ /^(hdf5|H5)/ && room != "io" && !(name == "H5public.h" && path == "src/core/version.cpp")) {
      complain("includes HDF5 outside io/")
    }
    if (is_public && name ~ /^(fmt|nlohmann|toml)/) complain("shows a private dependency in a public header")
    target = ""
    if (name ~ /^lobe\//) {
      target = public[substr(name, 6)]
      if (target == "") complain("includes " name ", which belongs to no known room; add it to check_rooms.sh")
    } else if (index(name, "/") > 0) {
      split(name, parts, "/")
      if (parts[1] in floor) target = parts[1]
      if (target != "" && is_public) complain("a public header includes the private " name)
    }
    if (target != "" && floor[target] > floor[room]) complain("room " room " includes " name " of the later room " target)
  }
  END { exit failed }
'
