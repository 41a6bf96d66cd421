#pragma once

#include <functional>
#include <string>

#include "device/accumulate_pairs.hpp"
#include "device/lobe_batch.hpp"
#include "lobe/device/device.hpp"

/// Before a kernel's results are believed, each process has it compute what is known: a device, a driver or a file of a
/// kernel cache may be broken. Each costs some launches of a handful of items.
namespace lobe {

/// How far results are from what they have to be, as shares of it, and how far rounding may take them.
struct Accuracy {
  double deviation = 0;
  double allowed = 0;
  [[nodiscard]] bool is_sound() const { return deviation <= allowed; }  // not of what is no number
};

/// Name of a kernel in self-tests.
[[nodiscard]] std::string with_precision(std::string_view kernel, Precision precision);

/// Tests once per device and `kernel`, a name for it with its options; nothing while another test runs, whose kernels
/// these are.
/// \throws DeviceError where it is not sound
void require_sound(const Device& device, const std::string& kernel, const std::function<Accuracy()>& test);

/// Tests programs of build_lobe_program(). Formulas have no known values and are not tested.
void require_sound_model(const Device& device, const LobeKernel& kernel, std::string_view launcher,
                         Precision precision);

[[nodiscard]] Accuracy test_gram(const Device& device);
[[nodiscard]] Accuracy test_differences(const Device& device);
[[nodiscard]] Accuracy test_segments(const Device& device);
[[nodiscard]] Accuracy test_segment_map(const Device& device);
[[nodiscard]] Accuracy test_pairs(const Device& device, NodeMap map, PairTerm term);
[[nodiscard]] Accuracy test_matrix_product(const Device& device, Precision precision);
[[nodiscard]] Accuracy test_isotropic_product(const Device& device, Precision precision);
[[nodiscard]] Accuracy test_patch_light(const Device& device);
[[nodiscard]] Accuracy test_drawing(const Device& device);
[[nodiscard]] Accuracy test_drawing_each(const Device& device);
[[nodiscard]] Accuracy test_density(const Device& device);

}  // namespace lobe
