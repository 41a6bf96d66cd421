#pragma once

#include "interface/handle.hpp"

/// The options that several commands take.
namespace lobe::cli::option {

inline constexpr Flag allow_unresolved{"allow-unresolved"};
inline constexpr Flag catalogue{"catalogue"};
inline constexpr Count cell_points{"cell-points"};
inline constexpr Words channels{"channels"};
inline constexpr Text color{"color"};
inline constexpr Text component{"component"};
inline constexpr Flag csv{"csv"};
inline constexpr Flag dense{"dense"};
inline constexpr Text device{"device"};
inline constexpr Number domain_theta_max{"domain-theta-max"};
inline constexpr Text entry{"entry"};
inline constexpr Flag exact_grid{"exact-grid"};
inline constexpr Flag force{"force"};
inline constexpr Text format{"format"};
inline constexpr Text grid{"grid"};
inline constexpr Flag header_only{"header-only"};
inline constexpr Flag help{"help"};
inline constexpr Flag json{"json"};
inline constexpr Texts lighting{"lighting"};
inline constexpr Text luminance{"luminance"};
inline constexpr Text memory{"memory"};
inline constexpr Flag no_checkpoint{"no-checkpoint"};
inline constexpr Flag no_compress{"no-compress"};
inline constexpr Flag no_progress{"no-progress"};
inline constexpr Text output{"output"};
inline constexpr Text plot{"plot"};
inline constexpr Text precision{"precision"};
inline constexpr Flag quiet{"quiet"};
inline constexpr Count samples{"samples"};
inline constexpr Texts set{"set"};
inline constexpr Flag srgb{"srgb"};
inline constexpr Flag strict{"strict"};
inline constexpr Flag study{"study"};
inline constexpr Number theta_max{"theta-max"};
inline constexpr Number tolerance{"tolerance"};
inline constexpr Texts uniform{"uniform"};
inline constexpr Flag verbose{"verbose"};
inline constexpr Flag version{"version"};
inline constexpr Numbers wavelengths{"wavelengths"};

}  // namespace lobe::cli::option

/// The positional arguments that several commands take.
namespace lobe::cli::argument {

inline constexpr Text a{"A"};
inline constexpr Text b{"B"};
inline constexpr Text target{"TARGET"};
inline constexpr Text file{"FILE"};
inline constexpr Texts files{"FILE"};
inline constexpr Text material{"MATERIAL"};
inline constexpr Texts materials{"MATERIAL"};

}  // namespace lobe::cli::argument
