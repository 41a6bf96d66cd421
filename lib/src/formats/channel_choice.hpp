#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "lobe/formats/measured.hpp"

namespace lobe {

/// Luminance of linear sRGB (ITU-R BT.709): weights of red, green and blue.
inline constexpr std::array<double, 3> kRec709{0.2126, 0.7152, 0.0722};

/// Channels made of those of a file: each a weighted sum of them.
struct ChannelChoice {
  std::vector<std::string> names;
  std::vector<double> wavelengths;  ///< nm; empty: channels are no single wavelengths
  Eigen::MatrixXd weights;          ///< channels of the file x chosen ones
};

/// Chooses a file's channels by the options; names are compared without regard to case.
/// \throws ArgumentError for choices that the file does not have, and for more than one kind of choice
[[nodiscard]] ChannelChoice choose_channels(const BrdfFunction& brdf, const ReadOptions& options);

/// The function, and its table of cells, with chosen channels. Where it has replicates, `at` has the columns of all of
/// them and `channels` the names of its own.
[[nodiscard]] BrdfFunction with_channels(BrdfFunction brdf, const ChannelChoice& choice);

}  // namespace lobe
