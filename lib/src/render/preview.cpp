#include "lobe/render/preview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string_view>

#include "core/text.hpp"
#include "energy/known_as.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "render/sphere_parts.hpp"
#include "render/sphere_surface.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using Light = std::array<double, 4>;  // unit vector, irradiance

constexpr std::size_t kLargest = 4096;

/// \throws ArgumentError
std::vector<Light> lights_of(const SphereLighting& lighting) {
  const auto is_amount = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!is_amount(lighting.sky)) {
    throw ArgumentError("a sky of radiance " + shortest(lighting.sky) + "; expected a finite number, at least 0");
  }
  std::vector<Light> lights;
  for (const PointLight& light : lighting.points) {
    const auto& [x, y, z] = light.direction;
    const double length = std::hypot(x, y, z);
    if (!(std::isfinite(length) && length > 0)) {
      throw ArgumentError("a point light has no direction; expected three finite numbers, not all of them 0");
    }
    if (!is_amount(light.irradiance)) {
      throw ArgumentError("a point light of irradiance " + shortest(light.irradiance) +
                          "; expected a finite number, at least 0");
    }
    lights.push_back({x / length, y / length, z / length, light.irradiance});
  }
  return lights;
}

void require_valid(const SphereOptions& options) {
  if (options.size < 1 || options.size > kLargest) {
    throw ArgumentError("a picture of " + std::to_string(options.size) + " pixels; expected 1 to " +
                        std::to_string(kLargest));
  }
  if (!(options.white > 0) || !(options.tolerance > 0)) {
    throw ArgumentError("white and tolerance of a picture are to be above 0");
  }
}

/// Where a sphere mirrors a light to the viewer: the half-vector.
std::array<double, 3> half_vector(const Light& light) {
  const auto& [x, y, z, irradiance] = light;
  const double length = std::hypot(x, y, z + 1);
  return {x / length, y / length, (z + 1) / length};
}

/// The angle between two unit vectors.
double angle_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return 2 * std::asin(std::min(1.0, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) / 2));
}

/// Normal at the middle of a part, and how much normals turn over it.
struct PartNormal {
  std::array<double, 3> at;
  double turn;
};

PartNormal normal_of(const SpherePart& part, double pixel) {
  const double x = std::midpoint(part.x_low, part.x_high);
  const double y = std::midpoint(part.y_low, part.y_high);
  const double radius = std::min(std::hypot(x, y), 1.0);
  const double depth = std::sqrt((1 - radius) * (1 + radius));
  return {{x, y, depth}, pixel / std::max(depth, std::sqrt(pixel))};
}

/// Orders that the rules of parts begin with: where lobes peak they have to see them.
std::vector<int> first_orders(const SphereParts& parts, std::span<const Light> lights, const SphereSurface& surface) {
  constexpr double kReach = 6;          // of a peak, in widths of the lobe
  constexpr double kNodesPerWidth = 2;  // of the coarser rule
  constexpr int kLowest = 2;
  constexpr int kHighest = 256;
  std::vector<int> orders(parts.parts.size(), kLowest);
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const PartNormal normal = normal_of(parts.parts[k], parts.pixel);
    for (const Light& light : lights) {
      const double distance = angle_between(normal.at, half_vector(light));
      if (distance > kReach * surface.width + 2 * normal.turn) continue;
      const double wanted = kNodesPerWidth * normal.turn / surface.width;
      if (wanted > kHighest) {
        throw NumericError(
            fmt::format("'{}' has a lobe of a width of {:.2g} rad, too narrow for pixels that turn by "
                        "{:.2g} rad; expected a larger picture, or an ideal mirror",
                        surface.name, surface.width, normal.turn));
      }
      orders[k] = std::max(orders[k], static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(wanted)))));
    }
  }
  return orders;
}

/// Adds integrals over parts to pixels as means.
void add_to(SphereImage& image, const SphereParts& parts, const Eigen::MatrixXd& value, const Eigen::MatrixXd& error,
            double factor) {
  const double area = parts.pixel * parts.pixel;
  for (std::size_t k = 0; k < parts.parts.size(); ++k) {
    const auto part = static_cast<Eigen::Index>(k);
    image.radiance.col(parts.pixel_of[k]) += factor / area * value.col(part);
    image.error.col(parts.pixel_of[k]) += factor / area * error.col(part);
  }
}

/// Point lights in an ideal mirror: discs in which the mirrored view hits the light.
void add_mirrored(SphereImage& image, const SphereParts& parts, const SphereSurface& surface,
                  std::span<const Light> lights) {
  constexpr int kOrder = 32;
  const GaussRule coarse = gauss_rule(kOrder / 2);
  const GaussRule fine = gauss_rule(kOrder);
  for (const Light& light : lights) {
    const auto normal = half_vector(light);
    if (!(normal[2] > 0) || light[3] == 0) continue;  // a light behind the sphere
    const auto view = SpherePoint(normal[0], normal[1], std::hypot(normal[0], normal[2])).view();
    const Eigen::VectorXd share = surface.mirror({std::acos(std::min(view[2], 1.0)), std::atan2(view[1], view[0])});
    const double sine = std::sin(kLightDiscRadius);
    const Eigen::VectorXd radiance = share * light[3] / (pi * sine * sine);
    const auto seen = [&](const SpherePart& part, const GaussRule& rule) {
      double area = 0;
      for_each_node(part, rule, [&](const SpherePoint& point, double weight) {
        // V mirrored at N is 2 (N.V) N - V.
        const double twice = 2 * point.depth();
        const std::array<double, 3> mirrored{twice * point.x(), twice * point.y(), twice * point.depth() - 1};
        if (angle_between(mirrored, {light[0], light[1], light[2]}) < kLightDiscRadius) area += weight;
      });
      return area;
    };
    for (std::size_t k = 0; k < parts.parts.size(); ++k) {
      const PartNormal middle = normal_of(parts.parts[k], parts.pixel);
      // Across the plane of light and viewer normals see the light farther off.
      if (angle_between(middle.at, normal) > kLightDiscRadius / 2 / normal[2] + 2 * middle.turn) continue;
      const double area = seen(parts.parts[k], fine);
      const double change = std::abs(area - seen(parts.parts[k], coarse));
      const double pixel = parts.pixel * parts.pixel;
      image.radiance.col(parts.pixel_of[k]) += radiance * (area / pixel);
      image.error.col(parts.pixel_of[k]) += radiance.cwiseAbs() * (change / pixel);
    }
  }
}

/// Radiances under a sky of radiance 1 integrated over parts, and below them their errors.
using SkyIntegrator = std::function<Eigen::MatrixXd(std::span<const SpherePart> parts, const GaussRule& rule)>;

Direction view_at(const SpherePoint& point) {
  const auto view = point.view();
  return {std::acos(std::min(view[2], 1.0)), std::atan2(view[1], view[0])};
}

SkyIntegrator interpolated_sky(const SphereSurface& surface, double tolerance) {
  return [map = SkyMap(surface.sky, surface.symmetry, tolerance), rows = surface.rows](
             std::span<const SpherePart> parts, const GaussRule& rule) {
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(2 * rows, static_cast<Eigen::Index>(parts.size()));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for_each_node(parts[k], rule, [&](const SpherePoint& point, double share) {
        map.add(view_at(point), share, sums.col(static_cast<Eigen::Index>(k)));
      });
    }
    return sums;
  };
}

SkyIntegrator stepped_sky(const SphereSurface& surface) {
  return [sky = surface.sky, rows = surface.rows](std::span<const SpherePart> parts, const GaussRule& rule) {
    Eigen::MatrixXd sums(2 * rows, static_cast<Eigen::Index>(parts.size()));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      std::vector<Direction> views;
      std::vector<double> shares;
      for_each_node(parts[k], rule, [&](const SpherePoint& point, double share) {
        views.push_back(view_at(point));
        shares.push_back(share);
      });
      const SkyValues seen = sky(views);
      const Eigen::Map<const Eigen::VectorXd> by_node(shares.data(), static_cast<Eigen::Index>(shares.size()));
      sums.col(static_cast<Eigen::Index>(k)) << seen.value * by_node, seen.error * by_node;
    }
    return sums;
  };
}

void require_visible(const SphereSurface& surface, std::span<const Light> lights) {
  for (const auto& [x, y, z, irradiance] : lights) {
    if (!surface.has_retro || angle_between({x, y, z}, {0, 0, 1}) >= kLightDiscRadius) continue;
    throw ArgumentError("'" + surface.name +
                        "' sends the light of a point light straight back, to a viewer who stands " +
                        "in its way; expected it at least " + shortest(kLightDiscRadius) + " rad off");
  }
}

SphereImage render(const SphereSurface& surface, const SphereLighting& lighting, const SphereOptions& options,
                   const std::function<void()>& stop) {
  const auto lights = lights_of(lighting);
  require_visible(surface, lights);
  const SphereParts parts = sphere_parts(options.size);
  SphereImage image{options.size, parts.coverage, Eigen::MatrixXd::Zero(surface.rows, parts.coverage.size()), {}};
  image.error = image.radiance;
  const double absolute = options.tolerance * options.white * parts.pixel * parts.pixel;
  const auto of_parts = [&](const auto& integrate) {
    return [&](std::span<const std::size_t> numbers, const GaussRule& rule) {
      stop();
      std::vector<SpherePart> some;
      for (const std::size_t k : numbers) some.push_back(parts.parts[k]);
      return Eigen::MatrixXd(integrate(some, rule));
    };
  };
  if (!lights.empty()) {
    const auto lit = [&](std::span<const SpherePart> some, const GaussRule& rule) {
      return surface.lit(some, rule, lights);
    };
    const auto found = integrate_parts(first_orders(parts, lights, surface), surface.highest_order, surface.rows,
                                       {absolute, options.tolerance}, of_parts(lit));
    add_to(image, parts, found.value, found.error, 1);
  }
  if (surface.mirror) add_mirrored(image, parts, surface, lights);
  if (lighting.sky > 0) {
    stop();
    const double tolerance = options.tolerance * std::min(1.0, options.white / lighting.sky);
    const SkyIntegrator sky = surface.has_steps ? stepped_sky(surface) : interpolated_sky(surface, tolerance / 2);
    constexpr int kHighest = 8;
    const auto found = integrate_parts(std::vector<int>(parts.parts.size(), 1), kHighest, 2 * surface.rows,
                                       {absolute / lighting.sky, options.tolerance}, of_parts(sky));
    add_to(image, parts, found.value.topRows(surface.rows),
           found.error.topRows(surface.rows) + found.value.bottomRows(surface.rows), lighting.sky);
  }
  if (!image.radiance.allFinite()) {
    throw NumericError("the radiance of '" + surface.name + "' is no finite number somewhere on the sphere");
  }
  return image;
}

std::function<void()> stop_of(const SphereOptions& options) {
  return [progress = options.progress] {
    if (progress && !progress("rendering", 0)) throw Cancelled("cancelled");
  };
}

SphereSurface surface_of(const Device& device, const Reflectance& reflectance, const SphereOptions& options,
                         const std::function<void()>& stop) {
  return known_as(device, reflectance,
                  Cases{[&](const Material& formula) { return lobe::surface_of(device, formula, options); },
                        [&](const BrdfFunction& function) { return lobe::surface_of(function, options, stop); },
                        [&](const BrdfTable& table) { return lobe::surface_of(table, options, stop); }});
}

}  // namespace

SphereLighting three_point_lights() {
  return {
      .points = {{{-0.55, 0.60, 0.58}, 0.8 * pi}, {{0.80, 0.10, 0.59}, 0.25 * pi}, {{0.35, 0.45, -0.82}, 0.5 * pi}}};
}

SphereLighting homogeneous_daylight() {
  return {.points = {}, .sky = 1};
}

SphereImage render_sphere(const Device& device, const Reflectance& reflectance, const SphereLighting& lighting,
                          const SphereOptions& options) {
  require_valid(options);
  const auto stop = stop_of(options);
  return render(surface_of(device, reflectance, options, stop), lighting, options, stop);
}

SkyRadiance sky_radiance(const Device& device, const Reflectance& reflectance, std::span<const Direction> viewers,
                         const SphereOptions& options) {
  if (!(options.tolerance > 0)) throw ArgumentError("the tolerance of radiances is to be above 0");
  for (const Direction& viewer : viewers) {
    if (viewer.theta >= 0 && viewer.theta < pi / 2 && std::isfinite(viewer.phi)) continue;
    throw ArgumentError("a viewer at theta " + shortest(viewer.theta) + ", phi " + shortest(viewer.phi) +
                        "; expected 0 <= theta < pi/2 and a finite azimuth");
  }
  const auto stop = stop_of(options);
  const SphereSurface surface = surface_of(device, reflectance, options, stop);
  SkyRadiance all{Eigen::MatrixXd(surface.rows, static_cast<Eigen::Index>(viewers.size())), {}};
  all.error = all.value;
  constexpr std::size_t kTogether = 16;  // between two looks at whether to stop
  for (std::size_t first = 0; first < viewers.size(); first += kTogether) {
    stop();
    const auto some = viewers.subspan(first, std::min(kTogether, viewers.size() - first));
    const SkyValues values = surface.sky(some);
    const auto columns = static_cast<Eigen::Index>(some.size());
    all.value.middleCols(static_cast<Eigen::Index>(first), columns) = values.value;
    all.error.middleCols(static_cast<Eigen::Index>(first), columns) = values.error;
  }
  if (!all.value.allFinite()) {
    throw NumericError("the radiance of '" + surface.name + "' under daylight is no finite number for some viewer");
  }
  return all;
}

double reference_exposure(const SphereLighting& lighting) {
  constexpr int kGrid = 256;  // pixels over the sphere
  const auto lights = lights_of(lighting);
  std::vector<double> radiances;
  for (int row = 0; row < kGrid; ++row) {
    for (int column = 0; column < kGrid; ++column) {
      const double x = (2 * column + 1 - kGrid) / static_cast<double>(kGrid);
      const double y = (2 * row + 1 - kGrid) / static_cast<double>(kGrid);
      if (x * x + y * y >= 1) continue;
      double irradiance = pi * lighting.sky;
      for (const auto& [l_x, l_y, l_z, strength] : lights) {
        irradiance += strength * std::max(0.0, l_x * x + l_y * y + l_z * std::sqrt(1 - x * x - y * y));
      }
      radiances.push_back(kReferenceAlbedo / pi * irradiance);
    }
  }
  const auto middle = radiances.begin() + static_cast<std::ptrdiff_t>(radiances.size() / 2);
  std::ranges::nth_element(radiances, middle);
  if (!(*middle > 0)) {
    throw ArgumentError(
        "half of the grey reference sphere is dark, which leaves the exposure open; expected more light");
  }
  return decode_srgb(kReferenceLightness) / *middle;
}

}  // namespace lobe
