#include "lobe/formats/modes_file.hpp"

#include <fmt/format.h>

#include <vector>

#include "formats/npy.hpp"
#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5.hpp"
#include "hdf5/hdf5_output.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"

namespace lobe {
namespace {

constexpr std::string_view kBrdf =
    "f = f_0 + 2 sum_m f_m cos(m phi), phi the azimuth between the directions to light and viewer, 0 on the retro side";
constexpr std::string_view kDisort =
    "pi f = sum_m rho_m cos(m phi), phi the azimuth between the directions in which the light travels, 0 on the mirror "
    "side";

std::string modes_npy(const AzimuthalModes& modes) {
  std::vector<std::size_t> shape{modes.count, modes.cosines_out.size(), modes.cosines_in.size()};
  if (modes.channels.size() > 1) shape.insert(shape.begin(), modes.channels.size());
  return npy_content(shape, modes.values);
}

std::string modes_hdf5(const AzimuthalModes& modes, std::string_view command_line) {
  const bool is_brdf = modes.convention == ModeConvention::brdf;
  const std::string_view units = is_brdf ? "sr-1" : "1";
  const std::string image = hdf5::file_image([&](hid_t root) {
    hdf5::write_attributes(root, {{"Conventions", "CF-1.10, ACDD-1.3"},
                                  {"title", "azimuthal modes of " + modes.name},
                                  {"comment", is_brdf ? kBrdf : kDisort},
                                  {"history", command_line},
                                  {"source", fmt::format("lobe {} ({})", version(), commit())},
                                  {"lobe_schema", "lobe-modes/1"},
                                  {"material", modes.name},
                                  {"convention", mode_convention_names()[static_cast<std::size_t>(modes.convention)]}});
    hdf5::write_attribute(root, "tolerance", modes.tolerance);
    hdf5::write_attribute(root, "left_out", std::span<const double>(modes.left_out));
    hdf5::write_attribute(root, "one_sided", std::span<const double>(modes.one_sided));
    const auto channel = hdf5::create_text_axis(root, "channel", modes.channels);
    const auto mode = hdf5::create_index_axis(root, "mode", modes.count, 0);
    const auto out = hdf5::create_number_axis(root, "cosine_out", modes.cosines_out);
    const auto in = hdf5::create_number_axis(root, "cosine_in", modes.cosines_in);
    hdf5::write_attributes(out.id(), {{"long_name", "cosine of the viewer's angle from the normal"}, {"units", "1"}});
    hdf5::write_attributes(in.id(), {{"long_name", "cosine of the light's angle from the normal"}, {"units", "1"}});
    const std::vector<const hdf5::Dataset*> along{&channel, &mode, &out, &in};
    const auto values = hdf5::create_dataset(root, "modes", modes.values, along);
    hdf5::write_attributes(values.id(), {{"long_name", "Fourier coefficient over the azimuth"},
                                         {"units", units},
                                         {"ancillary_variables", "modes_error"}});
    const auto errors = hdf5::create_dataset(root, "modes_error", modes.errors, along);
    hdf5::write_attributes(errors.id(), {{"long_name", "bound on the error of modes"}, {"units", units}});
  });
  return image + digest_of(image);
}

}  // namespace

ModesFormat modes_format_of(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending == ".npy") return ModesFormat::npy;
  if (ending == ".h5" || ending == ".nc") return ModesFormat::hdf5;
  throw ArgumentError("'" + path.string() + "' names no format of modes; expected an ending .h5, .nc or .npy");
}

std::string modes_file(const AzimuthalModes& modes, ModesFormat format, std::string_view command_line) {
  return format == ModesFormat::npy ? modes_npy(modes) : modes_hdf5(modes, command_line);
}

}  // namespace lobe
