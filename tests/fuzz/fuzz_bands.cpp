// SPDX-License-Identifier: Apache-2.0
// Pictures of many bands: a description up to the first zero byte, and the TIFF that lies beside
// it.
#include <cmath>

#include "fuzz/fuzz.h"
#include "fuzz/shown_picture.h"
#include "store/band_files/band_source.h"
#include "store/format/tiff_pyramid.h"

namespace wellspring::fuzz {

void fuzz_bands(Bytes bytes) {
  using namespace store;
  const std::string json = write_file("bands.bands.json", take_until(bytes, 0));
  const std::string file = write_file("bands.tif", bytes);
  load([&] { show_picture(*load_tiff(file, 1 << 20, seconds_now, {"A", true, {}})); });
  load([&] { show_picture(*load_tiff(file, 1 << 20, seconds_now, {"", false, {500}})); });
  load([&] {
    const BandSource source(json);
    const std::vector<double>& nm = source.bands().nm;
    for (size_t i = 1; i < nm.size(); i++) require(nm[i] > nm[i - 1], "wavelengths rise");
    const double samples = double(source.width()) * double(nm.size());
    if (samples > 1 << 20) return;
    std::vector<float> row;
    source.read(source.height() - 1, 1, row);
    require(double(row.size()) == samples, "rows have all bands");
    for (const float one : row) require(std::isfinite(one), "reflectances are numbers");
  });
}

}  // namespace wellspring::fuzz
