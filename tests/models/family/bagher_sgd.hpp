#pragma once

#include <vector>

#include "models/model_test.hpp"

namespace lobe::test {

using reference::BagherFit;

/// One channel of a published fit, with the K and the c that are computed here.
struct Published {
  std::string parameters;
  BagherFit fit;
  Real normalisation, rate;
};

// Of the fits to measured materials: aluminium (blue), gold-metallic-paint2 (red), light-red-paint (red),
// alum-bronze (red), green-acrylic (blue), specular-orange-phenolic (blue).
inline const std::vector<Published> kPublished = {
    {"alpha=0.000991844,p=0.435936,f0=1.77905,f1=0.77905,lambda=6.11887e-08,k=9.69801,theta0=0.566156",
     {0.000991844L, 0.435936L, 1.77905L, 0.77905L, 6.11887e-08L, 9.69801L, 0.566156L},
     653.86L,
     15.88L},
    {"alpha=0.00376608,p=0.415684,f0=0.0343265,f1=-0.00929705,lambda=2.77279,k=83.871,theta0=0.365256",
     {0.00376608L, 0.415684L, 0.0343265L, -0.00929705L, 2.77279L, 83.871L, 0.365256L},
     181.769L,
     4.78294e-08L},
    {"alpha=0.854048,p=1.40232,f0=0.0346142,f1=-0.0688995,lambda=1.72476,k=5.57044,theta0=0.249637",
     {0.854048L, 1.40232L, 0.0346142L, -0.0688995L, 1.72476L, 5.57044L, 0.249637L},
     4.68691L,
     0.0969212L},
    {"alpha=0.014832,p=0.459076,f0=6.05524,f1=5.05524,lambda=2.60672,k=47.783,theta0=0.205635",
     {0.014832L, 0.459076L, 6.05524L, 5.05524L, 2.60672L, 47.783L, 0.205635L},
     46.3841L,
     1.12717e-07L},
    {"alpha=7.95188e-05,p=0.145492,f0=0.170328,f1=0.110218,lambda=15419300,k=403.267,theta0=0.646645",
     {7.95188e-05L, 0.145492L, 0.170328L, 0.110218L, 15419300, 403.267L, 0.646645L},
     11351.3L,
     4233550},
    {"alpha=1.62017e-05,p=3.55583e-12,f0=0.0223538,f1=-0.0433847,lambda=8722070,k=855.811,theta0=0.608547",
     {1.62017e-05L, 3.55583e-12L, 0.0223538L, -0.0433847L, 8722070, 855.811L, 0.608547L},
     61722.9L,
     23012400}};

}  // namespace lobe::test
