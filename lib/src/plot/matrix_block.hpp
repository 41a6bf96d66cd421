#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>

namespace lobe {

inline constexpr double kCharacterWidth = 0.6;  ///< of DejaVu Sans, in font heights
inline constexpr double kPixelsPerPoint = 4.0 / 3;

/// A block of a picture's data for gnuplot's `matrix`: a comment that says what it is and names the rows, which are the
/// columns, too; then the values.
[[nodiscard]] std::string matrix_block(std::string_view what, std::span<const std::string> names,
                                       const Eigen::MatrixXd& values);

/// Where a matrix stands in its picture, pixels from the left and from the bottom.
struct MatrixFrame {
  int left, bottom, side;
  int width, height;  ///< of the picture
};

/// Script lines that place the matrix, with a title and a note above.
/// \param heading_left of these, pixels
[[nodiscard]] std::string matrix_frame(const MatrixFrame& frame, double heading_left, std::string_view title,
                                       std::string_view note);

}  // namespace lobe
