# lobe_list_models(<folder> <file>)
# Writes a line LOBE_MODEL(<model>) for each <model>.cpp of a folder to private/<file> in the current binary folder.
function(lobe_list_models folder file)
  file(GLOB models CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.cpp)
  list(TRANSFORM models REPLACE "^(.*)\\.cpp$" "LOBE_MODEL(\\1)")
  list(JOIN models "\n" models)
  file(CONFIGURE OUTPUT private/${file} CONTENT "@models@\n" @ONLY)
endfunction()
