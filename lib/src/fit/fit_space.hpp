#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobe/fit/fit.hpp"

namespace lobe {

/// A quantity as a search sees it: what spans decades by its logarithm.
struct SearchScale {
  bool is_logarithmic = false;
  double offset = 0;  ///< added before the logarithm is taken

  /// Chooses the scale for a parameter: the logarithm if its range spans a factor of 100 or more; if the range is
  /// longer than 20 otherwise, the logarithm of its distance from the minimum plus 1; else the parameter itself.
  [[nodiscard]] static SearchScale of(double minimum, double maximum);

  [[nodiscard]] double coordinate(double value) const;
  [[nodiscard]] double value(double coordinate) const;
  /// dvalue / dcoordinate
  [[nodiscard]] double slope(double coordinate) const;
};

/// A family as a box of coordinates: its free scales, by term and channel, then its free parameters.
class FitSpace {
 public:
  /// \throws ArgumentError for ranges that the family has no parameter for or that are empty, and fixed scales of
  ///   another number of channels.
  FitSpace(const Family& family, std::size_t channels, std::span<const FitRange> ranges);

  struct Axis {
    std::string label;
    std::optional<std::size_t> channel = {};  ///< of scales, where there are several channels
    bool is_scale = false;
    std::size_t term = 0;
    std::size_t index = 0;  ///< channel of a scale, number of a parameter
    double minimum = 0;     ///< values
    double maximum = 0;
    double unit = 1;  ///< length of a coordinate that changes a material appreciably
    SearchScale scale = {};
  };

  [[nodiscard]] std::size_t size() const { return axes_.size(); }
  [[nodiscard]] std::size_t scales() const { return scales_; }
  [[nodiscard]] std::size_t parameters() const { return size() - scales_; }
  [[nodiscard]] std::size_t channels() const { return channels_; }
  [[nodiscard]] const Family& family() const { return family_; }
  [[nodiscard]] const Axis& axis(std::size_t j) const { return axes_[j]; }
  /// Axis of the first free parameter; those of scales are before it.
  [[nodiscard]] const Axis& parameter(std::size_t i) const { return axes_[scales_ + i]; }
  [[nodiscard]] double lower(std::size_t j) const;
  [[nodiscard]] double upper(std::size_t j) const;
  [[nodiscard]] double value(std::size_t j, double coordinate) const { return axes_[j].scale.value(coordinate); }
  /// Sets what counts as a change of a scale: a hundredth of the scale that makes the term as large as the target, or
  /// its value.
  void set_unit(std::size_t j, double unit) { axes_[j].unit = unit; }

  /// Number of the axis with a label.
  /// \throws ArgumentError for an unknown one, with the nearest known
  [[nodiscard]] std::size_t find_parameter(std::string_view label) const;

  /// One term with these values of the family's parameters, of which its own count, and with scale 1.
  [[nodiscard]] Material member(std::size_t term, std::span<const double> parameters) const;
  /// The member of the family at a point.
  [[nodiscard]] Material material(const Eigen::VectorXd& x) const;
  [[nodiscard]] std::vector<double> parameter_values(const Eigen::VectorXd& x) const;
  /// \param scales terms x channels, of which those of free scales are taken
  [[nodiscard]] Eigen::VectorXd point(const Eigen::MatrixXd& scales, std::span<const double> parameters) const;
  /// Numbers of the parameters that a term has.
  [[nodiscard]] std::vector<std::size_t> parameters_of(std::size_t term) const;

 private:
  [[nodiscard]] Term term_with(std::size_t term, std::span<const double> parameters) const;

  Family family_;
  std::size_t channels_ = 1;
  std::size_t scales_ = 0;
  std::vector<Axis> axes_;
};

}  // namespace lobe
