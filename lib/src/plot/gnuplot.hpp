#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobe/plot/table_pictures.hpp"

namespace lobe::gnuplot {

/// A picture as gnuplot makes it: the script reads the data file, both stand in one directory under a common stem.
struct Picture {
  std::string script;
  std::string data;
};

/// A text as a gnuplot string literal, exactly, whatever it holds: in double quotes, and what gnuplot could read as
/// anything but a letter (quotes, backquotes, backslashes, '@', '$', control characters) as octal numbers.
[[nodiscard]] std::string string_literal(std::string_view text);

/// A line of comment in a script, with its end; what is neither letter nor plain sign is a blank.
[[nodiscard]] std::string comment(std::string_view text);

/// A line of comment in data, with its end; control characters are blanks.
[[nodiscard]] std::string data_comment(std::string_view text);

/// The name of a file in the script's directory as a string literal; gnuplot starts a command where a name begins with
/// '<' or '|', so it never does.
[[nodiscard]] std::string file_literal(std::string_view name);

/// Number of characters of a UTF-8 text, to estimate its width.
[[nodiscard]] std::size_t character_count(std::string_view text);

/// Colour ("#rrggbb", told apart by the colour-blind too) and point type of the k-th family.
[[nodiscard]] std::string family_colour(std::size_t family);
[[nodiscard]] int family_point(std::size_t family);

/// The palette of all pictures: viridis, perceptually uniform, readable by the colour-blind and in grey.
[[nodiscard]] std::string viridis();

/// ".png" or ".svg".
[[nodiscard]] std::string extension(PictureFormat format);

/// First lines of every script: what it is, terminal and output file.
/// \param stem the files are STEM.gp, STEM.dat and STEM.png (or .svg)
[[nodiscard]] std::string preamble(std::string_view stem, std::string_view what, int width, int height,
                                   PictureFormat format = PictureFormat::png);

/// Runs DIRECTORY/STEM.gp, which must begin with preamble(), to make TARGET/STEM.png (or .svg). The picture is complete
/// or absent. gnuplot is looked up in PATH and started without a shell; nothing is printed.
/// \return why there is no picture; empty when there is one
[[nodiscard]] std::string render(const std::filesystem::path& directory, const std::string& stem, PictureFormat format,
                                 const std::filesystem::path& target);
[[nodiscard]] inline std::string render(const std::filesystem::path& directory, const std::string& stem,
                                        PictureFormat format = PictureFormat::png) {
  return render(directory, stem, format, directory.empty() ? "." : directory);
}

}  // namespace lobe::gnuplot
