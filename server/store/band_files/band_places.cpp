// SPDX-License-Identifier: Apache-2.0
#include "store/band_files/band_places.h"

#include <algorithm>
#include <cmath>

namespace wellspring::store {

std::vector<BandPlace> sample_places(const BandSource& source, int most, int side) {
  const double width = double(source.width()), height = double(source.height());
  const int wide = int(std::min<int64_t>(side, source.width()));
  const int high = int(std::min<int64_t>(side, source.height()));
  // Squares of one size lie side by side, as many as fit.
  const double step = std::max({std::sqrt(width * height / most), double(wide), double(high)});
  const int columns = std::max(1, int(width / step)), rows = std::max(1, int(height / step));
  const size_t bands = source.bands().nm.size();
  std::vector<BandPlace> places;
  std::vector<float> read;
  for (int row = 0; row < rows; row++) {
    const int64_t y = int64_t((row + 0.5) * height / rows);
    const int64_t top = std::clamp<int64_t>(y - high / 2, 0, source.height() - high);
    source.read(top, high, read);
    for (int column = 0; column < columns; column++) {
      const int64_t x = int64_t((column + 0.5) * width / columns);
      const int64_t left = std::clamp<int64_t>(x - wide / 2, 0, source.width() - wide);
      BandPlace place{x, y, std::vector<double>(bands, 0)};
      for (size_t band = 0; band < bands; band++)
        for (int j = 0; j < high; j++)
          for (int i = 0; i < wide; i++)
            place.reflectances[band] +=
                double(read[(band * size_t(high) + size_t(j)) * size_t(source.width()) +
                            size_t(left + i)]) /
                (wide * high);
      places.push_back(std::move(place));
    }
  }
  return places;
}

}  // namespace wellspring::store
