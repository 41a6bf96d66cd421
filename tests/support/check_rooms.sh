#!/bin/sh
# Checks the order of the library's rooms (lib/CMakeLists.txt): a file includes only files of its own room and of rooms
# before it; OpenCL is seen in device/ alone, HDF5 in io/ alone (its version macros also in core/version.cpp), and
# public headers show neither. The header lobe/lobe.hpp includes all others.
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
    headers["core"] = "colour directions error estimate form progress tolerance version work"
    headers["device"] = "device self_test"
    headers["hemisphere"] = "grid"
    headers["model"] = "evaluate material model profile proposal specification"
    headers["table"] = "brdf_function cell_error least_value reflectance table"
    headers["algebra"] = "algebra function_composition inverse pointwise spectrum square_root"
    headers["energy"] = "energy plausibility prepare preview repair sampling"
    headers["metric"] = "approximation clustering comparison embedding fit judgement lighting metric " \
           "rank_correlation table_lighting table_metric"
    headers["io"] = "approximation_pictures fit_pictures foreign_export chosen_file direction_pairs " \
           "material_file measured measurement " \
           "plausibility_page preview_sheet sampling_page table_file table_pictures"
    headers["study"] = "chart checkpoint load_reflectance lobe material_curves published report_page study " \
           "study_plan study_results study_schema verify"
    for (room in headers) {
      count = split(headers[room], names, " ")
      for (i = 1; i <= count; ++i) public[names[i] ".hpp"] = room
    }
  }
  function complain(text) { print path ":" FNR ": " text; failed = 1 }
  FNR == 1 {
    path = FILENAME
    sub(lib, "", path)
    split(path, parts, "/")
    is_public = parts[1] == "include"
    if (is_public) seen[parts[3]] = 1
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
    if (path == "include/lobe/lobe.hpp") collected[substr(name, 6)] = 1
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
  END {
    for (header in seen) {
      if (header != "lobe.hpp" && !(header in collected)) {
        path = "include/lobe/lobe.hpp"
        FNR = 1
        complain("does not include lobe/" header)
      }
    }
    exit failed
  }
'
