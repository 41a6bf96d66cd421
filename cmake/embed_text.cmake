# Turns a text file into a C++ source that holds it as a string_view.
# Run with: cmake -D IN=file -D OUT=source -D ID=identifier -D NAME=shown-name -P embed_text.cmake
# #include lines become comments, from which the launcher reads what comes first; the line count stays, so that compiler
# messages name the right line of the right file.
file(READ "${IN}" text)
string(REGEX REPLACE "(^|\n)(#include \"[^\"\n]*\")" "\\1//\\2" text "${text}")
file(WRITE "${OUT}" "#include \"kernels.hpp\"
namespace lobe::kernels {
constinit const std::string_view ${ID} =
R\"__CLC__(#line 1 \"${NAME}\"
${text})__CLC__\";
}  // namespace lobe::kernels
")
