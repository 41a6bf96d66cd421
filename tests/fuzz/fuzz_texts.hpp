#pragma once

#include <string_view>

namespace lobe::test {

// Texts that users and strangers write: understood, or refused in one clear line.
void fuzz_study(std::string_view text);
void fuzz_material_file(std::string_view text);
void fuzz_scene(std::string_view text);
void fuzz_mesh(std::string_view text);
void fuzz_specification(std::string_view text);
void fuzz_judgements(std::string_view text);
void fuzz_pairs(std::string_view text);
void fuzz_lut_axis(std::string_view text);
void fuzz_lut_image(std::string_view bytes);
void fuzz_lut_exr(std::string_view bytes);
void fuzz_lut_ktx2(std::string_view bytes);
void fuzz_lut_array(std::string_view text);

}  // namespace lobe::test
