#pragma once

/// \file
/// Studies: their files, runs, results and reports.

#include "lobe/study/chart.hpp"             // curves of several materials
#include "lobe/study/checkpoint.hpp"        // studies that go on where they were ended
#include "lobe/study/load_reflectance.hpp"  // files of any kind
#include "lobe/study/material_curves.hpp"   // albedos and slices of materials
#include "lobe/study/material_file.hpp"     // materials as files
#include "lobe/study/published.hpp"         // printed numbers to compute again
#include "lobe/study/ranks.hpp"             // studies by several processes at once
#include "lobe/study/report_page.hpp"       // results of studies, as a page
#include "lobe/study/scene_file.hpp"        // scenes as files
#include "lobe/study/shard.hpp"             // studies in parts, for job arrays
#include "lobe/study/study.hpp"             // study files, runs and results
#include "lobe/study/study_plan.hpp"        // what running a study takes
#include "lobe/study/study_results.hpp"     // what files of results say
#include "lobe/study/study_schema.hpp"      // study files for editors
#include "lobe/study/verify.hpp"            // whether files are as written
