// SPDX-License-Identifier: Apache-2.0
#include "spectrum/upsample.h"

#include <gtest/gtest.h>

#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"

namespace wellspring::test {
namespace {

double round_trip(const dvec3& rgb) {
  const LampObserver day(find_lamp("D65")->power);
  const dvec3 xyz = day.xyz(sample_reflectance(fit_reflectance(rgb)));
  const dvec3 wanted = xyz_of_rgb(rgb) / xyz_of_rgb(dvec3(1)) * day.white();
  return ciede2000(lab_of(xyz, day.white()), lab_of(wanted, day.white()));
}

TEST(SpectrumUpsample, TheWholeCubeOfColorsComesBack) {
  double most = 0;
  for (int r = 0; r <= 4; r++)
    for (int g = 0; g <= 4; g++)
      for (int b = 0; b <= 4; b++) most = std::max(most, round_trip(dvec3(r, g, b) / 4.0));
  EXPECT_LT(most, 0.01);
}

TEST(SpectrumUpsample, ReflectancesLieBetweenNoneAndAllLight) {
  for (const dvec3 rgb : {dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(1), dvec3(0), dvec3(7, -3, 0.5)})
    for (const double one : sample_reflectance(fit_reflectance(rgb))) {
      EXPECT_GE(one, 0);
      EXPECT_LE(one, 1);
    }
}

TEST(SpectrumUpsample, GreyIsTheSameAtAllWavelengths) {
  const Spectrum grey = sample_reflectance(fit_reflectance(dvec3(0.18)));
  for (size_t i = 40; i < 340; i++) EXPECT_NEAR(grey[i], 0.18, 0.002);
}

}  // namespace
}  // namespace wellspring::test
