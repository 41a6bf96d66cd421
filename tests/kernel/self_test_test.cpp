// A device that computes wrongly is not believed: kernels with a planted fault, in place of those built.
#include "lobe/device/self_test.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "device/implementation.hpp"
#include "energy/prepare.hpp"
#include "lobe/core/error.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/table.hpp"
#include "model/evaluate.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

/// A fault in all programs that have a text: another one in its place.
struct Fault {
  std::string name;
  std::string from;
  std::string to;
  std::string kernel;  ///< what has to be found wrong, a part of its name
  unsigned width = 0;  ///< of packs, where the text is in kernels for these alone
};
std::ostream& operator<<(std::ostream& out, const Fault& fault) {
  return out << fault.name;
}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      {"model_ggx", "schlick_fresnel(g.cos_d, c.c2, c.c3) * smith", "schlick_fresnel(g.cos_o, c.c2, c.c3) * smith",
       "evaluate_lobes.cl of ggx"},
      {"model_launcher", "factor * TO_PACK(MODEL(g, c))", "(pack)(1.000001) * factor * TO_PACK(MODEL(g, c))",
       "evaluate_lobes.cl of lambert"},
      {"factor", "exp(k.a / g.cos_i + k.a / g.cos_o)", "exp(k.a / g.cos_i)", "lambert * lacquer"},
      {"pumping", "divisor *= fmax(larger_albedo(c, k, &in, &out), fmax(cos_i, cos_o));",
       "divisor *= larger_albedo(c, k, &in, &out);", "g2 2 times"},
      {"table", "total += lobe_coefficients[LOBE_NUMBERS]", "total += 1.000001 * lobe_coefficients[LOBE_NUMBERS]",
       "tabulate_pairs.cl of ggx"},
      {"weights", "numbers[LOBE_NUMBERS + c] * weight", "1.000001 * numbers[LOBE_NUMBERS + c] * weight",
       "weigh_directions.cl of ggx"},
      {"spheres", "before + numbers[LOBE_NUMBERS + channel] * sum",
       "before + 1.000001 * numbers[LOBE_NUMBERS + channel] * sum", "shade_sphere.cl of ggx"},
      {"gram", "c##lane = fma(r, column2, c##lane);", "c##lane = fma(r, column1, c##lane);", "accumulate_gram.cl", 8},
      {"gram_scalar", "sum = fma(row_tile[y][k], column_tile[x][k], sum);",
       "sum = fma(row_tile[y][k], column_tile[y][k], sum);", "accumulate_gram.cl", 1},
      {"differences", "sum += value * value;", "sum += fabs(value);", "accumulate_differences.cl"},
      {"segments", "STORE_PACK(LOAD_PACK(at, out) + sum, at, out);", "STORE_PACK(1.000001 * sum, at, out);",
       "sum_segments.cl"},
      {"segment_map", "c##k = fma(value2, t, c##k);", "c##k = fma(value1, t, c##k);", "map_segments.cl"},
      {"segment_map_of_pack", "only##k = fma(value, (pack)(row[k]), only##k);",
       "only##k = fma(value, (pack)(row[0]), only##k);", "map_segments.cl"},
      {"map", "value += term_weight[t] * samples", "value += 1.000001 * term_weight[t] * samples", "map_linear"},
      {"cube_root", "r -= fma(square, r, -a) / ((pack)(3.0) * square);",
       "r -= fma(square, r, -a) / ((pack)(3.1) * square); r += (pack)(1e-9) * r;", "map_cube_root"},
      {"pairs", "return fma(d, d, sum);", "return fma(d, fabs(d) * 1.000001, sum);", "add_square"},
      {"pairs_two_thirds", "return sum + FROM_HALF(fma(y * e, (half_pack)(1.0f / 3.0f), y));",
       "return sum + FROM_HALF(y) * 1.001;", "add_two_thirds"},
      {"matrices", "STORE_WIDE(add ? LOAD_WIDE(0, c) + sum0 : sum0, 0, c);",
       "STORE_WIDE(add ? LOAD_WIDE(0, c) + sum0 : sum1, 0, c);", "product of matrices", 8},
      {"matrices_scalar", "total##r += convert_double4(sum##r);", "total##r += 1.000001 * convert_double4(sum##r);",
       "product of matrices", 1},
      {"orders", "b##r = fma(factor, right1, b##r);", "b##r = fma(factor, right0, b##r);",
       "product of isotropic tables", 8},
      {"transform", "STORE_WIDE(head0 + tail0, 0, head);", "STORE_WIDE(head0 - tail0, 0, head);",
       "product of isotropic tables", 8},
      {"restore", "STORE_WIDE(even0 + odd0, 0, head);", "STORE_WIDE(even0 - odd0, 0, head);",
       "product of isotropic tables", 8},
      {"isotropic_scalar", "sum = fma(left_tile[y][k], right_tile[k][x], sum);",
       "sum = fma(left_tile[y][k], right_tile[k][y], sum);", "product of isotropic tables", 1},
      {"patch_light", "total += shares[2 * k + 1]", "total += 1.0001 * shares[2 * k + 1]", "tabulate_patch_light.cl"},
      {"drawing", "STORE_PACK(one.v.z, p, drawn + DRAWN_Z * stride);",
       "STORE_PACK(one.v.x, p, drawn + DRAWN_Z * stride);", "draw_directions.cl"},
      {"drawing_each", "numbers[i], seed)", "numbers[0], seed)", "draw_each.cl"},
      {"density", "STORE_PACK(pdf_proposal(light, v, parts, count, tables), p, drawn + 3 * stride);",
       "STORE_PACK(1.000001 * pdf_proposal(light, v, parts, count, tables), p, drawn + 3 * stride);",
       "find_density.cl"},
  };
  return all;
}

/// A device of its own, whose programs for some kernels have been built by a first self-test.
Device built_device(const std::string& kernel) {
  Device device = Device::choose();
  (void)self_test(device, kernel);
  return device;
}

/// Puts faulty programs in place of all that have the text.
/// \return how many
std::size_t plant(const Device& device, const Fault& fault) {
  auto& implementation = device.implementation();
  std::size_t count = 0;
  for (auto& [key, program] : implementation.programs) {
    auto text = program.getInfo<CL_PROGRAM_SOURCE>();
    const auto at = text.find(fault.from);
    if (at == std::string::npos) continue;
    text.replace(at, fault.from.size(), fault.to);
    const cl::Program faulty(implementation.context, text);
    faulty.build(implementation.device, program.getBuildInfo<CL_PROGRAM_BUILD_OPTIONS>(implementation.device).c_str());
    program = faulty;
    ++count;
  }
  return count;
}

TEST(SelfTest, FindsAllKernelsOfADeviceThatComputesRightly) {
  const auto results = self_test(Device::choose());
  std::set<std::string> names;
  for (const auto& result : results) {
    EXPECT_TRUE(result.is_sound) << result.kernel << ": " << result.deviation << " " << result.error;
    EXPECT_TRUE(names.insert(result.kernel).second) << result.kernel << " twice";
    // What it is held to is not much more than what is there.
    EXPECT_LE(result.allowed, 1e-4) << result.kernel;
  }
  EXPECT_GT(results.size(), 120U);
}

class PlantedFault : public ::testing::TestWithParam<Fault> {};

TEST_P(PlantedFault, IsFound) {
  const Device device = built_device(GetParam().kernel);
  const bool is_here = GetParam().width == 0 || GetParam().width == device.implementation().pack_width;
  ASSERT_EQ(plant(device, GetParam()) > 0, is_here);
  if (!is_here) return;  // it is in the other pass of this program

  const auto results = self_test(device, GetParam().kernel);

  ASSERT_FALSE(results.empty());
  EXPECT_FALSE(std::ranges::all_of(results, &SelfTestResult::is_sound));
}

INSTANTIATE_TEST_SUITE_P(all, PlantedFault, ::testing::ValuesIn(faults()), ByName{});

/// Formulas of users have no known values: the host computes them.
TEST(SelfTest, HoldsFormulasAgainstTheHostBeforeTheirFirstUse) {
  Term term{.model = std::string(kCustomModel), .values = {0.8, 5}, .weight = {1.0}};
  term.formula = Formula{.text = "rho / pi * exp(-n * (1 - cos_h))", .parameters = {"rho", "n"}};
  const Device device = Device::choose();
  EXPECT_NO_THROW((void)prepare(device, {"mine", "", {term}}));
  ASSERT_GT(plant(device, {"", "= exp(", "= (pack)(1.0 + 1e-9) * exp(", ""}), 0U);
  try {
    (void)prepare(device, {"mine", "", {term}});
    FAIL() << "believed";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("computes wrongly: the formula of 'mine' is"));
  }
}

/// What a process does without being asked.
TEST(SelfTest, ComesBeforeTheFirstUseOfAKernel) {
  const Device device = built_device("of ggx");
  ASSERT_GT(plant(device, faults()[0]), 0U);
  device.implementation().sound_kernels.clear();
  const std::vector<Directions> directions{{0.1, 0.2, 0.3, 0}};
  EXPECT_NO_THROW((void)evaluate(device, parse_material("ward:m=0.3"), directions));
  try {
    (void)evaluate(device, parse_material("ggx:alpha=0.5"), directions);
    FAIL() << "believed";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("computes wrongly: evaluate_lobes.cl of ggx is off by"));
    EXPECT_EQ(error.fault(), lobe::Fault::wrong_results);
  }
}

TEST(SelfTest, IsDoneOnceForEachKernel) {
  const Device device = Device::choose();
  const std::vector<Directions> directions{{0.1, 0.2, 0.3, 0}};
  (void)evaluate(device, parse_material("ward:m=0.3"), directions);
  const auto tested = device.implementation().sound_kernels;
  EXPECT_THAT(tested, ::testing::ElementsAre("evaluate_lobes.cl of ward"));
  (void)evaluate(device, parse_material("ward:m=0.2"), directions);
  EXPECT_EQ(device.implementation().sound_kernels, tested);
}

}  // namespace
}  // namespace lobe::test
