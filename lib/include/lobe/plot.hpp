#pragma once

/// \file
/// Pictures and generated pages.

#include "lobe/plot/approximation_pictures.hpp"  // pictures of approximations
#include "lobe/plot/fit_pictures.hpp"            // pictures of fits
#include "lobe/plot/plausibility_page.hpp"       // the plausibility of the catalogue, as a page
#include "lobe/plot/preview_sheet.hpp"           // contact sheets of spheres
#include "lobe/plot/sampling_page.hpp"           // the worth of importance sampling, as a page
#include "lobe/plot/scene_picture.hpp"           // pictures of scenes
#include "lobe/plot/table_pictures.hpp"          // pictures of tables
