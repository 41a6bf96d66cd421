# Turns a text file into a C++ source that holds it as a string_view.
# Run with: cmake -D IN=file -D OUT=source -D ID=identifier -D HEADER=its-declaration -D NAMESPACE=name
#                 [-D NAME=shown-name] -P embed_text.cmake
# With NAME it is a kernel: its #include lines become comments, from which the launcher reads what comes first; the line
# count stays, so that compiler messages name the right line of the right file.
file(READ "${IN}" text)
if(NAME)
  string(REGEX REPLACE "(^|\n)(#include \"[^\"\n]*\")" "\\1//\\2" text "${text}")
  string(PREPEND text "#line 1 \"${NAME}\"\n")
endif()
file(WRITE "${OUT}" "#include \"${HEADER}\"
namespace ${NAMESPACE} {
constinit const std::string_view ${ID} =
R\"__TEXT__(${text})__TEXT__\";
}  // namespace ${NAMESPACE}
")
