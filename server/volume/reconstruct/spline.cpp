// SPDX-License-Identifier: Apache-2.0
#include "volume/reconstruct/spline.h"

#include <limits>
#include <optional>
#include <stdexcept>

#include "base/parallel.h"
#include "volume/reconstruct/line_filter.h"
#include "volume/reconstruct/spline_weights.h"

namespace wellspring::volume {

namespace {

struct SchemeFilters {
  std::optional<LineFilter> values;  // along all axes; of derivatives, across them
  std::optional<LineFilter> along;   // gives derivatives; none: the spline's own are taken
};
SchemeFilters filters_of(GradientScheme scheme) {
  switch (scheme) {
    case GradientScheme::central: return {{}, LineFilter::central_difference};
    case GradientScheme::wide: return {{}, LineFilter::wide_difference};
    case GradientScheme::analytic: return {};
    case GradientScheme::prefiltered: return {LineFilter::quasi_interpolating, {}};
    case GradientScheme::wide_across:
      return {LineFilter::quasi_interpolating, LineFilter::wide_difference};
    case GradientScheme::interpolating: return {LineFilter::interpolating, {}};
  }
  return {};
}

// Returns what a mirror makes of a derivative across it: one that points the other way.
int sign_behind(int index, int size) { return index < 0 || index >= size ? -1 : 1; }

// Copies samples with the padding. `across`: the axis along which they are derivatives, or -1.
template <class Real>
std::vector<Real> pad(const std::vector<Real>& samples, glm::ivec3 size, glm::ivec3 padded,
                      int across) {
  std::vector<Real> result(size_t(padded.x) * size_t(padded.y) * size_t(padded.z));
  parallel_each(padded.z, [&](int to_z) {
    const glm::ivec3 shift(1);
    for (int to_y = 0; to_y < padded.y; to_y++)
      for (int to_x = 0; to_x < padded.x; to_x++) {
        const glm::ivec3 at = glm::ivec3(to_x, to_y, to_z) - shift;
        size_t index = 0;
        for (int axis = 2; axis >= 0; axis--)
          index = index * size_t(size[axis]) + size_t(mirrored(at[axis], size[axis]));
        const int sign = across < 0 ? 1 : sign_behind(at[across], size[across]);
        result[(size_t(to_z) * size_t(padded.y) + size_t(to_y)) * size_t(padded.x) + size_t(to_x)] =
            Real(sign) * samples[index];
      }
  });
  return result;
}

template <class Real>
SampleBox<Real> box_of(const Spline<Real>& spline, const std::vector<Real>& coefficients) {
  SampleBox<Real> box = whole_box(coefficients.data(), spline.padded);
  const int first = 1 + box.row + box.slice;
  box.samples += first, box.count -= first;
  box.size = spline.size;
  return box;
}

template <class Real>
ValueGradient<Real> spline_gradient_of(const SampleBox<Real>& box, glm::vec<3, Real> place) {
  const auto x = place_on_axis(place.x, box.size.x), y = place_on_axis(place.y, box.size.y),
             z = place_on_axis(place.z, box.size.z);
  const auto wx = spline_weights<Real>(x.way), wy = spline_weights<Real>(y.way),
             wz = spline_weights<Real>(z.way);
  const auto sx = spline_slopes<Real>(x.way), sy = spline_slopes<Real>(y.way),
             sz = spline_slopes<Real>(z.way);
  const Real* corner = box.samples + ptrdiff_t(x.at - 1) + ptrdiff_t(y.at - 1) * box.row +
                       ptrdiff_t(z.at - 1) * box.slice;
  ValueGradient<Real> sum;
  for (int k = 0; k < 4; k++) {
    Real value = 0, along_x = 0, along_y = 0;
    for (int j = 0; j < 4; j++) {
      const Real* row = corner + ptrdiff_t(k) * box.slice + ptrdiff_t(j) * box.row;
      Real v = 0, s = 0;
      for (int i = 0; i < 4; i++) v += wx[i] * row[i], s += sx[i] * row[i];
      value += wy[j] * v, along_x += wy[j] * s, along_y += sy[j] * v;
    }
    sum.value += wz[k] * value;
    sum.gradient += glm::vec<3, Real>(wz[k] * along_x, wz[k] * along_y, sz[k] * value);
  }
  return sum;
}

}  // namespace

template <class Real>
Spline<Real> make_spline(std::span<const Real> samples, glm::ivec3 size, GradientScheme scheme) {
  if (samples.empty() || glm::any(glm::lessThan(size, glm::ivec3(1))) ||
      samples.size() / size_t(size.x) / size_t(size.y) != size_t(size.z) ||
      samples.size() % (size_t(size.x) * size_t(size.y)) != 0)
    throw std::invalid_argument("a spline needs a grid of samples");
  Spline<Real> spline;
  spline.size = size, spline.scheme = scheme;
  for (int axis = 0; axis < 3; axis++) spline.padded[axis] = std::max(size[axis], 2) + 2;
  const size_t most = size_t(std::numeric_limits<int>::max());
  if (size_t(spline.padded.x) * size_t(spline.padded.y) > most / size_t(spline.padded.z))
    throw std::length_error("a grid is too large for one spline");

  const std::vector<Real> own(samples.begin(), samples.end());
  const SchemeFilters filters = filters_of(scheme);
  std::vector<Real> filtered = own;
  if (filters.values)
    for (int axis = 0; axis < 3; axis++) filter_axis(filtered, size, axis, *filters.values);
  spline.coefficients = pad(filtered, size, spline.padded, -1);
  if (filters.along)
    for (int axis = 0; axis < 3; axis++) {
      filtered = own;
      filter_axis(filtered, size, axis, *filters.along);
      if (filters.values)
        for (int turn = 1; turn < 3; turn++)
          filter_axis(filtered, size, (axis + turn) % 3, *filters.values);
      spline.derivatives[size_t(axis)] = pad(filtered, size, spline.padded, axis);
    }
  return spline;
}

template <class Real>
ValueGradient<Real> gradient_at(const Spline<Real>& spline, glm::vec<3, Real> place) {
  ValueGradient<Real> result = spline_gradient_of(box_of(spline, spline.coefficients), place);
  if (!spline.derivatives[0].empty())
    for (int axis = 0; axis < 3; axis++)
      result.gradient[axis] =
          spline_gradient_of(box_of(spline, spline.derivatives[size_t(axis)]), place).value;
  return result;
}

template <class Real>
Real value_at(const Spline<Real>& spline, glm::vec<3, Real> place) {
  return spline_gradient_of(box_of(spline, spline.coefficients), place).value;
}

Lanes value_at(const Spline<float>& spline, const Lanes3& place) {
  return spline_value(box_of(spline, spline.coefficients), place);
}

LanesGradient gradient_at(const Spline<float>& spline, const Lanes3& place) {
  if (spline.derivatives[0].empty())
    return spline_gradient(box_of(spline, spline.coefficients), place);
  return {value_at(spline, place),
          {spline_value(box_of(spline, spline.derivatives[0]), place),
           spline_value(box_of(spline, spline.derivatives[1]), place),
           spline_value(box_of(spline, spline.derivatives[2]), place)}};
}

template Spline<float> make_spline(std::span<const float>, glm::ivec3, GradientScheme);
template Spline<double> make_spline(std::span<const double>, glm::ivec3, GradientScheme);
template float value_at(const Spline<float>&, glm::vec<3, float>);
template double value_at(const Spline<double>&, glm::vec<3, double>);
template ValueGradient<float> gradient_at(const Spline<float>&, glm::vec<3, float>);
template ValueGradient<double> gradient_at(const Spline<double>&, glm::vec<3, double>);

}  // namespace wellspring::volume
