// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "cache/lanes.h"
#include "cache/packing.h"
#include "cache/pixel_light.h"
#include "cache/reconstruct.h"
#include "cache/write_pixels.h"

namespace wellspring {
namespace {

constexpr int block = cell_size;  // pixels a side between four cell centres

// Eight pixels as they lie packed, two rows of four; pixels beyond the picture are empty.
struct Block {
  u8 plane[surface_planes];
};

// Pixel `lane` of a block, at (x, y) of the picture, from the cells around it: bilinear among those
// of the object with most weight.
void fill_from_cells(const PixelRays& rays, const Cells& cells, int x, int y, int lane,
                     Block& to) {
  int cx = (x + cell_size / 2) / cell_size - 1, cy = (y + cell_size / 2) / cell_size - 1;
  float fx = (float(x) + 0.5f) / cell_size - 0.5f - float(cx),
        fy = (float(y) + 0.5f) / cell_size - 0.5f - float(cy);
  size_t cell[4];
  float weight[4];
  for (int k = 0; k < 4; k++) {
    int ax = std::clamp(cx + (k & 1), 0, cells.width - 1),
        ay = std::clamp(cy + (k >> 1), 0, cells.height - 1);
    cell[k] = size_t(cells.index(ax, ay));
    weight[k] = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy) + 1e-4f;
  }
  float best = 0;
  uint32_t object = no_object;
  for (int k = 0; k < 4; k++) {
    float support = 0;
    for (int j = 0; j < 4; j++)
      if (cells.object[cell[j]] == cells.object[cell[k]]) support += weight[j];
    if (support > best) best = support, object = cells.object[cell[k]];
  }
  vec3 albedo(0), rest(0), smooth(0), normal(0);
  float inverse_depth = 0, sum = 0;
  vec3 ray(rays.x(float(x) + 0.5f), rays.y(float(y) + 0.5f), 1);
  for (int k = 0; k < 4; k++) {
    if (cells.object[cell[k]] != object) continue;
    for (size_t c = 0; c < 3; c++) {
      albedo[int(c)] += weight[k] * cells.albedo[c][cell[k]];
      rest[int(c)] += weight[k] * cells.rest[c][cell[k]];
      smooth[int(c)] += weight[k] * cells.smooth[c][cell[k]];
      normal[int(c)] += weight[k] * cells.normal[c][cell[k]];
    }
    vec3 plane(cells.plane[0][cell[k]], cells.plane[1][cell[k]], cells.plane[2][cell[k]]);
    float middle = 1 / cells.depth[cell[k]];
    inverse_depth += weight[k] * std::clamp(dot(plane, ray), 0.5f * middle, 2 * middle);
    sum += weight[k];
  }
  float share = 1 / sum;
  to.plane[plane_albedo][lane] = pack_albedo(albedo * share);
  to.plane[plane_rest][lane] = pack_rgb9e5(rest * share);
  to.plane[plane_smooth][lane] = pack_rgb9e5(smooth * share);
  to.plane[plane_more][lane] = pack_normal(normal);
  to.plane[plane_depth][lane] = std::bit_cast<uint32_t>(sum / inverse_depth);
  to.plane[plane_object][lane] = object;
}

// Bilinear weights of a block's pixels, two rows of four at a time, towards the cell centres at its
// corners.
struct Bilinear {
  alignas(32) float weight[4][2][lanes];
};
constexpr Bilinear make_bilinear() {
  Bilinear b{};
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < block * block; i++) {
      float fx = (float(i % block) + 0.5f) / block, fy = (float(i / block) + 0.5f) / block;
      b.weight[k][i / lanes][i % lanes] = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy);
    }
  return b;
}
constexpr Bilinear bilinear = make_bilinear();

// A row of cells; the first and the last stand in for those beyond the picture, one on each side.
void read_cells(const Cells& cells, int cy, std::vector<CellLight>& row) {
  row.resize(size_t(cells.width) + 2);
  for (int x = -1; x <= cells.width; x++) read_cell(cells, x, cy, row[size_t(x + 1)]);
}

// The pixels of a block at (x, y) that lie in the picture.
struct Extent {
  int first, columns;  // the first pixel of a row, and how many
  bool row[2], whole;
  Extent(int x, int y, const Frame& frame) {
    PackedFour four(x, frame.width);
    first = four.first;
    columns = four.count;
    for (int r = 0; r < 2; r++) row[r] = y + r >= 0 && y + r < frame.height;
    whole = columns == block && row[0] && row[1];
  }
};

void read_block(Frame& frame, const Extent& extent, int x, int y, Block& to) {
  size_t width = size_t(frame.width);
  if (extent.whole) {
    size_t at = size_t(y) * width + size_t(x);
    auto pair = [width](const auto* from) {
      return join(load<u4>(from), load<u4>(from + width));
    };
    to.plane[plane_object] = pair(&frame.object[at]);
    to.plane[plane_more] = pair(&frame.confidence[at]);
    to.plane[plane_depth] = pair(&frame.depth[at]);
    const uint32_t *above = packed_words(frame, x, y), *below = packed_words(frame, x, y + 1);
    for (int p : {plane_albedo, plane_rest, plane_smooth})
      to.plane[p] =
          join(load<u4>(above + packed_four * p), load<u4>(below + packed_four * p));
    return;
  }
  uint32_t words[surface_planes][lanes] = {};
  for (uint32_t& object : words[plane_object]) object = no_object;
  for (int r = 0; r < 2; r++) {
    if (!extent.row[r]) continue;
    size_t at = size_t(y + r) * width + size_t(extent.first),
           bytes = size_t(extent.columns) * sizeof(uint32_t);
    int lane = r * block + extent.first - x;
    std::memcpy(&words[plane_object][lane], &frame.object[at], bytes);
    std::memcpy(&words[plane_more][lane], &frame.confidence[at], bytes);
    std::memcpy(&words[plane_depth][lane], &frame.depth[at], bytes);
    const uint32_t* from = packed_words(frame, extent.first, y + r);
    for (int p : {plane_albedo, plane_rest, plane_smooth})
      std::memcpy(&words[p][lane], from + extent.columns * p, bytes);
  }
  for (int p = 0; p < surface_planes; p++) to.plane[p] = load<u8>(words[p]);
}

// Fills what a block does not know and tells the frame its objects.
void finish_block(const PixelRays& rays, const Cells& cells, bool known, const Extent& extent,
                  int x, int y, Block& to, Frame& frame) {
  for (int r = 0; r < 2; r++) {
    if (!extent.row[r]) continue;
    for (int i = extent.first; i < extent.first + extent.columns; i++) {
      int lane = r * block + i - x;
      if (to.plane[plane_object][lane] != no_object) continue;
      if (known) fill_from_cells(rays, cells, i, y + r, lane, to);
      frame.object[size_t(y + r) * size_t(frame.width) + size_t(i)] =
          known ? to.plane[plane_object][lane] : 0;
    }
  }
}

Pixels unpack_pixels(const PixelRays& rays, const Block& from, int x, int y) {
  Pixels p;
  p.object = from.plane[plane_object];
  p.depth = as<f8>(from.plane[plane_depth]);
  u8 more = from.plane[plane_more];
  unpack_octahedron(more & 0xffffu, p.nx, p.ny, p.nz);
  p.normal2 = p.nx * p.nx + p.ny * p.ny + p.nz * p.nz;
  p.samples = to_float((more >> 16) & 255u);
  p.deviation = unpack_deviation(more >> 24);
  unpack_rgb9e5(from.plane[plane_smooth], p.smooth.r, p.smooth.g, p.smooth.b);
  unpack_rgb9e5(from.plane[plane_rest], p.rest.r, p.rest.g, p.rest.b);
  float step = rays.inverse_focal, left = rays.x(float(x) + 0.5f), top = rays.y(float(y) + 0.5f);
  p.x = left + step * f8{0, 1, 2, 3, 0, 1, 2, 3};
  p.y = top - step * f8{0, 0, 0, 0, 1, 1, 1, 1};
  return p;
}

// Writes `count` of four pixels, from the `skip`th on.
struct Result {
  float color[12];
  float confidence[4], depth[4];
};
void write(const Result& result, int skip, int count, size_t at, Frame& frame) {
  if (count == block) {  // mostly; and sizes known at compile time need no calls
    std::memcpy(&frame.color[at].x, result.color, sizeof result.color);
    std::memcpy(&frame.confidence[at], result.confidence, sizeof result.confidence);
    std::memcpy(&frame.depth[at], result.depth, sizeof result.depth);
    return;
  }
  for (int i = skip; i < skip + count; i++) {
    const float* c = result.color + 3 * i;
    frame.color[at + size_t(i)] = vec3(c[0], c[1], c[2]);
    frame.confidence[at + size_t(i)] = result.confidence[i];
    frame.depth[at + size_t(i)] = result.depth[i];
  }
}

// Reflectance times light plus the rest.
void light_pixels(const u8& packed_albedo, const Pixels& p, Result* result) {
  Color albedo;
  unpack_albedo(packed_albedo, albedo.r, albedo.g, albedo.b);
  // Shares that add up to one by a rounding too much can leave a hair of negative light.
  f8 r = positive(albedo.r * p.smooth.r + p.rest.r), g = positive(albedo.g * p.smooth.g + p.rest.g),
     b = positive(albedo.b * p.smooth.b + p.rest.b);
  interleave(part<0>(r), part<0>(g), part<0>(b), result[0].color);
  interleave(part<4>(r), part<4>(g), part<4>(b), result[1].color);
  f8 confidence = p.samples / (p.samples + 8.0f);
  store(result[0].confidence, part<0>(confidence));
  store(result[1].confidence, part<4>(confidence));
  i8 near = (p.depth < 0.5f * infinite_depth) & (p.depth > 0.0f);
  f8 depth = near ? p.depth : splat(std::numeric_limits<float>::infinity());
  store(result[0].depth, part<0>(depth));
  store(result[1].depth, part<4>(depth));
}

}  // namespace

i8 find_flat(const PixelRays& rays, const Cells& cells, int bx, int by) {
  constexpr float same_direction = 0.998f, same_depth = 0.1f * plane_tolerance;
  auto at = [&](const auto& plane, size_t i) {
    return load<f8>(plane.data() + i);
  };
  size_t a = size_t(cells.index(bx - 1, by - 1));
  u8 object = load<u8>(&cells.object[a]);
  f8 nx = at(cells.normal[0], a), ny = at(cells.normal[1], a), nz = at(cells.normal[2], a),
     px = at(cells.plane[0], a), py = at(cells.plane[1], a), pz = at(cells.plane[2], a);
  f8 left = rays.x((float(bx) - 0.5f) * cell_size) +
            float(cell_size) * rays.inverse_focal * f8{0, 1, 2, 3, 4, 5, 6, 7};
  i8 flat = object != no_object;
  for (int k = 1; k < 4; k++) {
    size_t c = a + size_t(k & 1) + size_t(k >> 1) * size_t(cells.stride);
    f8 x = left + float(k & 1) * float(cell_size) * rays.inverse_focal;
    float y = rays.y((float(by + (k >> 1)) - 0.5f) * cell_size);
    f8 cosine = nx * at(cells.normal[0], c) + ny * at(cells.normal[1], c) +
                nz * at(cells.normal[2], c);
    f8 off = at(cells.depth, c) * (px * x + py * y + pz) - 1.0f;
    flat &= (object == load<u8>(&cells.object[c])) & (cosine >= same_direction) &
            (magnitude(off) < same_depth);
  }
  return flat;
}

void compose(const View& view, const Cells& cells, bool known, Frame& frame) {
  PixelRays rays(view);
  parallel_ranges(cells.height + 1, 4, [&](int begin, int end) {
    thread_local std::vector<CellLight> above, below;
    read_cells(cells, begin - 1, below);
    for (int by = begin; by < end; by++) {
      int top = by * block - block / 2;
      std::swap(above, below);
      read_cells(cells, by, below);
      i8 flat{};
      for (int bx = 0; bx <= cells.width; bx++) {
        if (bx % lanes == 0) flat = find_flat(rays, cells, bx, by);
        size_t left = size_t(bx);
        const CellLight* corners[4] = {&above[left], &above[left + 1], &below[left],
                                       &below[left + 1]};
        int x = bx * block - block / 2;
        for (int half = 0; half < 2; half++) {
          int y = top + half * 2;
          Extent extent(x, y, frame);
          if (extent.columns <= 0) continue;
          Block pixels;
          read_block(frame, extent, x, y, pixels);
          if (any(pixels.plane[plane_object] == no_object))
            finish_block(rays, cells, known, extent, x, y, pixels, frame);
          Pixels p = unpack_pixels(rays, pixels, x, y);
          f8 weights[4];
          for (int k = 0; k < 4; k++) weights[k] = load<f8>(bilinear.weight[k][half]);
          Surroundings around = look_around(corners, flat[bx % lanes], weights, p);
          blend_light(around, p);
          Result result[2];
          light_pixels(pixels.plane[plane_albedo], p, result);
          for (int r = 0; r < 2; r++)
            if (extent.row[r])
              write(result[r], extent.first - x, extent.columns,
                    size_t(y + r) * size_t(frame.width) + size_t(x), frame);
        }
      }
    }
  });
}

}  // namespace wellspring
