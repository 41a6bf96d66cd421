// Random numbers, densities and directions of importance sampling as the device computes them.
#include "lobe/sampling/sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "device/buffers.hpp"
#include "device/draw_each.hpp"
#include "device/program.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"
#include "lobe/plot/sampling_page.hpp"
#include "model/sampling_strategy.hpp"
#include "reference/models.hpp"
#include "reference/sampling.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/random_materials.hpp"
#include "support/scale.hpp"
#include "table/evaluate.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using Words = std::array<std::uint32_t, 4>;

/// What the device's Philox makes of a counter, by a kernel that writes its words.
Words device_philox(const Words& counter, std::array<std::uint32_t, 2> key) {
  const std::string text = R"(
__kernel void show_words(const uint a, const uint b, const uint c, const uint d, const uint key_0, const uint key_1,
                         __global uint* words_out) {
  const philox_block block = {(words)(a), (words)(b), (words)(c), (words)(d)};
  const philox_block drawn = philox(block, key_0, key_1);
#if REAL_WIDTH == 8
  vstore8(drawn.a, 0, words_out);
  vstore8(drawn.b, 1, words_out);
  vstore8(drawn.c, 2, words_out);
  vstore8(drawn.d, 3, words_out);
#else
  words_out[0] = drawn.a;
  words_out[1] = drawn.b;
  words_out[2] = drawn.c;
  words_out[3] = drawn.d;
#endif
})";
  const auto program = build_program(device(), std::vector<KernelText>{{"sampling/random.clh"}, {{}, text}},
                                     Precision::double_precision);
  cl::Kernel kernel = make_kernel(program, "show_words", 7);
  const std::size_t width = device().implementation().pack_width;
  std::vector<std::uint32_t> words(4 * width);
  const cl::Buffer buffer = make_workspace(device(), words.size() * sizeof(std::uint32_t));
  set_arguments(kernel, counter[0], counter[1], counter[2], counter[3], key[0], key[1], buffer);
  auto& queue = device().implementation().queue;
  queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1));
  queue.enqueueReadBuffer(buffer, CL_TRUE, 0, words.size() * sizeof(std::uint32_t), words.data());
  return {words[0], words[width], words[2 * width], words[3 * width]};
}

// The vectors of Random123, tests/kat_vectors, "philox4x32 10".
constexpr Words kZeros{0, 0, 0, 0};
constexpr Words kOnes{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff};
constexpr Words kPi{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344};
constexpr Words kOfZeros{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8};
constexpr Words kOfOnes{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd};
constexpr Words kOfPi{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};

TEST(Philox, OnTheDeviceGivesThePublishedWords) {
  EXPECT_EQ(device_philox(kZeros, {0, 0}), kOfZeros);
  EXPECT_EQ(device_philox(kOnes, {0xffffffff, 0xffffffff}), kOfOnes);
  EXPECT_EQ(device_philox(kPi, {0xa4093822, 0x299f31d0}), kOfPi);
}

TEST(Philox, OfTheReferenceGivesThePublishedWords) {
  EXPECT_EQ(reference::philox(kZeros, {0, 0}), kOfZeros);
  EXPECT_EQ(reference::philox(kOnes, {0xffffffff, 0xffffffff}), kOfOnes);
  EXPECT_EQ(reference::philox(kPi, {0xa4093822, 0x299f31d0}), kOfPi);
}

TEST(Sampling, DrawsLambertianDirectionsFromTheWordsOfSeedAndNumber) {
  const std::uint64_t seed = 0x123456789abcdef0;
  const std::uint64_t first = (std::uint64_t{1} << 32) - 3;  // the numbers go on beyond 32 bits
  constexpr std::size_t kCount = 19;

  const auto samples = sample(device(), parse_material("lambert"), {0.5, 0}, kCount, {.seed = seed, .first = first});

  const auto unit = [](std::uint32_t high, std::uint32_t low) {
    return std::ldexp(high, -32) + std::ldexp((low >> 12) + 0.5, -52);
  };
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::uint64_t number = first + i;
    const auto words =
        reference::philox({static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), 1, 0},
                          {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
    const double radius = std::sqrt(unit(words[0], words[1]));
    const double azimuth = 2 * pi * unit(words[2], words[3]);
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(samples.directions(row, 0), radius * std::cos(azimuth), 1e-14) << i;
    EXPECT_NEAR(samples.directions(row, 1), radius * std::sin(azimuth), 1e-14) << i;
    EXPECT_NEAR(samples.weights(row, 0), 1, 1e-14) << i;
  }
}

TEST(Sampling, GivesTheSameSamplesInPartsAsAtOnce) {
  const Material material = parse_material("lambert:scale=0.4+ggx:alpha=0.3,scale=0.5+basic_patch:R=0.7,scale=0.1");
  const std::size_t count = scaled<std::size_t>(40'000, 100);
  const std::size_t half = count / 3;

  const auto all = sample(device(), material, {1.2, 0.4}, count, {.patches = PatchDraw::rejection});
  const auto rest =
      sample(device(), material, {1.2, 0.4}, count - half, {.first = half, .patches = PatchDraw::rejection});

  const auto rows = static_cast<Eigen::Index>(count - half);
  EXPECT_EQ(all.directions.bottomRows(rows), rest.directions);
  EXPECT_EQ(all.density.tail(rows), rest.density);
  EXPECT_EQ(all.weights.bottomRows(rows), rest.weights);
}

TEST(Sampling, DrawsForEachOfManyDirectionsWhatItDrawsForEachAlone) {
  constexpr std::uint64_t kSeed = 0x123456789abcdef0;
  const auto light_of = [](std::size_t i) {
    const double theta = 1.5 * static_cast<double>(i % 7) / 6;
    const double phi = static_cast<double>(i);
    return UnitVector{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  const auto number_of = [](std::size_t i) { return (std::uint64_t{1} << 32) - 40 + 977 * i; };
  // Every strategy of the catalogue, and a mirror beside another one.
  std::vector<std::string> names;
  for (const auto& model : catalogue()) {
    if (!model.traits.has_delta) names.emplace_back(model.name);
  }
  const std::size_t step = scaled<std::size_t>(1, 9);
  DrawOrders orders;
  std::vector<std::vector<ProposalPart>> densities;
  for (std::size_t i = 0; i < names.size() + 2; ++i) {
    const bool is_mirror = i >= names.size();
    const Term term = typical_material(is_mirror ? "ggx" : names[i]).terms.front();
    densities.push_back(propose(term, light_of(i), i % 2 == 0 ? PatchDraw::exact : PatchDraw::rejection));
    if (!is_mirror) continue;
    for (auto& part : densities.back()) part.share *= 0.25;
    densities.back().push_back({.strategy = Strategy::delta, .share = 0.75, .numbers = {0, 0, 1}});
  }
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < densities.size(); i += step) chosen.push_back(i);
  chosen.push_back(densities.size() - 1);
  for (const std::size_t i : chosen) orders.add(light_of(i), orders.add_density(densities[i]), number_of(i));

  const auto drawn = EachDrawer(device()).draw(orders, kSeed);

  ASSERT_EQ(drawn.size(), chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::size_t i = chosen[k];
    SCOPED_TRACE(i < names.size() ? names[i] : "with a mirror");
    DirectionSampler alone(device(), light_of(i), densities[i], {}, {}, 1, Precision::double_precision, 1);
    alone.draw(kSeed, number_of(i), 1);
    EXPECT_EQ(drawn[k].direction[0], alone.row(DirectionSampler::x)[0]);
    EXPECT_EQ(drawn[k].direction[1], alone.row(DirectionSampler::y)[0]);
    EXPECT_EQ(drawn[k].direction[2], alone.row(DirectionSampler::z)[0]);
    EXPECT_EQ(drawn[k].density, alone.row(DirectionSampler::density)[0]);
    EXPECT_EQ(static_cast<double>(drawn[k].part), alone.row(DirectionSampler::part)[0]);
  }
}

TEST(Sampling, GivesOtherSamplesForOtherSeeds) {
  const auto one = sample(device(), parse_material("lambert"), {0.5, 0}, 8, {.seed = 1});
  const auto other = sample(device(), parse_material("lambert"), {0.5, 0}, 8, {.seed = 2});

  EXPECT_GT((one.directions - other.directions).rowwise().norm().minCoeff(), 1e-6);
}

/// A material whose density the reference knows.
struct DensityCase {
  std::string name;
  std::function<reference::Real(const reference::Vector& light, const reference::Vector& view)> expected;
  PatchDraw patches = PatchDraw::exact;
  double tolerance = 1e-11;  // relative: a few hundred ulps of what cancels
};

std::ostream& operator<<(std::ostream& out, const DensityCase& one) {
  return out << one.name;
}

using reference::Vector;

class SamplingDensity : public ::testing::TestWithParam<DensityCase> {};

TEST_P(SamplingDensity, IsThatOfTheReference) {
  constexpr double kNothing = 1e-20;  // a power of a cosine of nearly 0
  Dice dice(11);
  const int count = scaled(400, 8);
  for (const double theta : {0.0, 0.7, 89 * pi / 180}) {
    const Direction in{theta, 0.4};
    const Vector light = reference::direction(in.theta, in.phi);
    std::vector<std::array<double, 3>> directions;
    for (int k = 0; k < count; ++k) {
      const double out = std::acos(dice.uniform(0.01, 1));
      const double phi = dice.uniform(0, 2 * pi);
      directions.push_back({std::sin(out) * std::cos(phi), std::sin(out) * std::sin(phi), std::cos(out)});
    }

    const auto found =
        sampling_density(device(), parse_material(GetParam().name), in, directions, {.patches = GetParam().patches});

    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Vector view{directions[k][0], directions[k][1], directions[k][2]};
      const auto expected = static_cast<double>(GetParam().expected(light, view));
      EXPECT_NEAR(found(static_cast<Eigen::Index>(k)), expected, GetParam().tolerance * expected + kNothing)
          << "theta " << theta << ", direction " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfStrategies, SamplingDensity,
    ::testing::Values(
        DensityCase{"lambert", [](const Vector&, const Vector& v) { return v.z / reference::kPi; }},
        DensityCase{"phong:n=20",
                    [](const Vector& l, const Vector& v) { return reference::power_density(mirrored(l), v, 20); }},
        DensityCase{"retro_metal_phong:n=7",
                    [](const Vector& l, const Vector& v) { return reference::power_density(l, v, 7); }},
        DensityCase{"ward_anisotropic:m_x=0.3,m_y=0.7,rotation=0.6",
                    [](const Vector& l, const Vector& v) { return reference::ward_density(l, v, 0.3L, 0.7L, 0.6L); },
                    PatchDraw::exact, 1e-10},
        DensityCase{"ashikhmin_shirley_anisotropic:n_u=30,n_v=5,rotation=0.6",
                    [](const Vector& l, const Vector& v) { return reference::ashikhmin_density(l, v, 30, 5, 0.6L); }},
        DensityCase{
            "ggx_anisotropic:alpha_x=0.2,alpha_y=0.5,rotation=0.6",
            [](const Vector& l, const Vector& v) { return reference::visible_density(l, v, 0.2L, 0.5L, 0.6L); }},
        DensityCase{"basic_patch:R=0.6",
                    [](const Vector& l, const Vector& v) { return reference::patch_density(l, v, 0.6L); }},
        DensityCase{"basic_patch:R=1.3",
                    [](const Vector& l, const Vector& v) { return reference::patch_density(l, v, 1.3L); },
                    PatchDraw::rejection},
        DensityCase{"basic_patch:R=0.8",
                    [](const Vector& l, const Vector& v) { return reference::roulette_density(l, v, 0.8L); },
                    PatchDraw::roulette},
        // The density of a mixture is the reflectance itself, but for its polygon: (8 * 0.03 * 2)^2 / 8 at the far end.
        DensityCase{"exponential_patch:s=8",
                    [](const Vector& l, const Vector& v) { return v.z * reference::exponential_patch(l, v, 8); },
                    PatchDraw::exact, 0.03},
        DensityCase{"tobler_power:n=9",
                    [](const Vector& l, const Vector& v) { return v.z * reference::tobler_power(l, v, 9); },
                    PatchDraw::exact, 1e-11}),
    ByName());

TEST(Sampling, OfPatchesInAllThreeWaysFindsTheSameAlbedo) {
  const Material material = parse_material("basic_patch:R=0.6");
  const Direction in{1.2, 0};
  const std::size_t count = scaled<std::size_t>(100'000, 200);
  const auto albedo = static_cast<double>(reference::lens_area(1, 0.6L, std::sin(1.2L)) / (reference::kPi * 0.36L));

  const auto exact = sampled_albedo(device(), material, in, count, {.patches = PatchDraw::exact});
  const auto rejected = sampled_albedo(device(), material, in, count, {.patches = PatchDraw::rejection});
  const auto roulette = sampled_albedo(device(), material, in, count, {.patches = PatchDraw::roulette});

  // All weights are the albedo, and none is lost; of the roulette they are 1 or 0.
  EXPECT_NEAR(exact.albedo.at(0).value, albedo, 1e-12);
  EXPECT_NEAR(rejected.albedo.at(0).value, albedo, 1e-12);
  EXPECT_EQ(exact.lost, 0);
  EXPECT_EQ(rejected.lost, 0);
  EXPECT_NEAR(roulette.albedo.at(0).value, albedo, 4 * roulette.albedo.at(0).error);
  EXPECT_NEAR(roulette.albedo.at(0).value, 1 - roulette.lost, 1e-12);
}

TEST(Sampling, DrawsMirrorsByTheirShareOfTheLight) {
  const Material material = parse_material("mirror:rho=0.3+lambert:scale=0.6+rrim:rho=0.1");
  const Direction in{0.7, 0.2};
  const std::size_t count = scaled<std::size_t>(20'000, 200);

  const auto samples = sample(device(), material, in, count);

  std::array<double, 3> counts{};
  for (std::size_t i = 0; i < count; ++i) {
    SCOPED_TRACE(i);
    const auto row = static_cast<Eigen::Index>(i);
    ++counts.at(static_cast<std::size_t>(samples.kinds[i]));
    EXPECT_NEAR(samples.weights(row, 0), 1, 1e-12);  // albedos are known exactly here
    if (samples.kinds[i] == SampleKind::smooth) continue;
    const double side = samples.kinds[i] == SampleKind::mirror ? -1 : 1;
    EXPECT_NEAR(samples.directions(row, 0), side * std::sin(0.7) * std::cos(0.2), 1e-15) << i;
    EXPECT_NEAR(samples.directions(row, 2), std::cos(0.7), 1e-15) << i;
  }
  const auto near_share = [&](double found, double share) {
    return std::abs(found - share * static_cast<double>(count)) <=
           4 * std::sqrt(share * (1 - share) * static_cast<double>(count));
  };
  EXPECT_TRUE(near_share(counts[0], 0.6));
  EXPECT_TRUE(near_share(counts[1], 0.3));
  EXPECT_TRUE(near_share(counts[2], 0.1));
}

TEST(Sampling, WeighsByChannel) {
  constexpr double kRounding = 1e-12;  // weights may be all the same
  const Material material = parse_material("lambert:scale=0.9/0.5/0.1+mirror:scale=0/0.2/0.4");

  const auto found = sampled_albedo(device(), material, {0.7, 0}, scaled<std::size_t>(20'000, 200));

  ASSERT_EQ(found.albedo.size(), 3u);
  EXPECT_NEAR(found.albedo[0].value, 0.9, 4 * found.albedo[0].error + kRounding);
  EXPECT_NEAR(found.albedo[1].value, 0.7, 4 * found.albedo[1].error + kRounding);
  EXPECT_NEAR(found.albedo[2].value, 0.5, 4 * found.albedo[2].error + kRounding);
}

TEST(Sampling, StatesRoundingWhereWeightsDoNotVary) {
  // Lambert's weights are all the same: no variance tells how far their mean is off.
  for (const std::size_t count : {std::size_t{2}, std::size_t{200}, std::size_t{small_scale() ? 300U : 50'000U}}) {
    const auto found = sampled_albedo(device(), parse_material("lambert:scale=0.2/0.3"), {0.2, 0}, count);
    const auto single = sampled_albedo(device(), parse_material("lambert:scale=0.2/0.3"), {0.2, 0}, count,
                                       {.precision = Precision::single_precision});
    for (const auto& [channel, albedo] : {std::pair{0, 0.2}, std::pair{1, 0.3}}) {
      const auto c = static_cast<std::size_t>(channel);
      EXPECT_LE(std::abs(found.albedo[c].value - albedo), found.albedo[c].error) << count << ", " << channel;
      EXPECT_LT(found.albedo[c].error, 1e-14) << count << ", " << channel;
      EXPECT_LE(std::abs(single.albedo[c].value - albedo), single.albedo[c].error) << count << ", " << channel;
      EXPECT_LT(single.albedo[c].error, 1e-5) << count << ", " << channel;
    }
  }
}

TEST(Sampling, OfBlackHasNoVariance) {
  const auto found = sampled_albedo(device(), parse_material("lambert:scale=0"), {0.2, 0}, 100);
  EXPECT_EQ(found.albedo[0].value, 0);
  EXPECT_EQ(found.relative_variance(0), 0);
}

/// An isotropic table of a lobe about the mirror direction and a mirror.
BrdfTable made_table() {
  BrdfTable table;
  table.grid = HemisphereGrid::gauss(scaled<std::size_t>(24, 4), scaled<std::size_t>(48, 8));
  const auto rings = table.grid.rings();
  for (const Ring& in : rings) {
    for (const Ring& out : rings) {
      for (std::size_t k = 0; k < table.grid.half_azimuths(); ++k) {
        const double delta_phi = 2 * pi * static_cast<double>(k) / static_cast<double>(table.grid.n_phi());
        table.values.push_back(0.1 + std::exp(-6 * std::pow(in.theta - out.theta, 2) - 3 * (1 + std::cos(delta_phi))));
      }
    }
  }
  table.mirror.assign(rings.size(), 0.2);
  table.error.assign(rings.size() * rings.size(), 0.0);
  return table;
}

TEST(Sampling, OfATableIsUnbiasedForItsValues) {
  const BrdfTable table = made_table();
  const Direction in{0.8, 0};
  const auto exact = albedo(table, std::array{in}).at(0).at(0);
  const std::size_t count = scaled<std::size_t>(50'000, 64);

  const auto found = sampled_albedo(device(), table, in, count);
  const auto by_cosine = sampled_albedo(device(), table, in, count, {.proposal = SamplingStrategy::cosine});

  EXPECT_NEAR(found.albedo.at(0).value, exact.value, 4 * found.albedo.at(0).error + exact.error);
  EXPECT_NEAR(by_cosine.albedo.at(0).value, exact.value, 4 * by_cosine.albedo.at(0).error + exact.error);
  EXPECT_LT(found.variance.at(0), by_cosine.variance.at(0));
}

TEST(Sampling, OfATableHasADensityThatAddsUpToAllButItsMirror) {
  const BrdfTable table = made_table();
  const int rings = scaled(200, 8);
  const int azimuths = scaled(192, 8);  // cells of the table end between them
  std::vector<std::array<double, 3>> directions;
  for (int i = 0; i < rings; ++i) {
    const double square = (i + 0.5) / rings;
    for (int k = 0; k < azimuths; ++k) {
      const double phi = 2 * pi * (k + 0.5) / azimuths;
      directions.push_back(
          {std::sqrt(square) * std::cos(phi), std::sqrt(square) * std::sin(phi), std::sqrt(1 - square)});
    }
  }

  const auto densities = sampling_density(device(), table, {0.8, 0}, directions);
  const auto samples = sample(device(), table, {0.8, 0}, scaled<std::size_t>(50'000, 500));

  double total = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    total += densities(static_cast<Eigen::Index>(i)) / directions[i][2] * pi / static_cast<double>(directions.size());
  }
  const auto smooth = static_cast<double>(std::ranges::count(samples.kinds, SampleKind::smooth));
  const auto count = static_cast<double>(samples.size());
  const double share = smooth / count;
  // A band ends within a ring of the sum, by up to a hundredth of the whole; a share of samples has a standard error.
  EXPECT_NEAR(total, share, 0.01 + scaled(0.0, 0.2) + 4 * std::sqrt(share * (1 - share) / count));
}

TEST(Sampling, RefusesWhatItCannotDraw) {
  const Material lambert = parse_material("lambert");

  EXPECT_THROW((void)sample(device(), lambert, {pi / 2, 0}, 1), ArgumentError);
  EXPECT_THROW((void)sample(device(), lambert, {-0.1, 0}, 1), ArgumentError);
  EXPECT_THROW((void)sample(device(), lambert, {0.1, std::nan("")}, 1), ArgumentError);
  EXPECT_THROW((void)sample(device(), lambert, {0.1, 0}, 0), ArgumentError);
  EXPECT_THROW((void)sampled_albedo(device(), lambert, {0.1, 0}, 1), ArgumentError);
  EXPECT_THROW((void)sample(device(), Material{"nothing", "", {}}, {0.1, 0}, 1), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
