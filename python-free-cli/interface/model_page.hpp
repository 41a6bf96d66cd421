#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobe/model/model.hpp"

namespace lobe::cli {

/// A picture of a model for its page.
struct ModelPicture {
  std::string path;     ///< from the page
  std::string caption;  ///< description of the picture
};

/// The catalogue's entry for a model, as the body of a page of the documentation site.
/// \param example a specification of it, which the pictures show
/// \param kernel link to the source that computes it; empty for models that are delta parts alone
[[nodiscard]] std::string html_text(const Model& model, std::string_view example, std::string_view kernel,
                                    const std::vector<ModelPicture>& pictures);

/// The catalogue's entry for a factor, as the body of a page.
[[nodiscard]] std::string html_text(const FactorModel& factor, std::string_view kernel);

/// Name of the page of a factor, which may be called as a model is.
[[nodiscard]] std::string page_name(const FactorModel& factor);

/// The page that leads to those of all models and factors: by chapter, with sources and traits.
/// \param thumbnails one path per model of the catalogue; empty where there is no picture
[[nodiscard]] std::string catalogue_html(const std::vector<std::string>& thumbnails);

}  // namespace lobe::cli
