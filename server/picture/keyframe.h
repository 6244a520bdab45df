// SPDX-License-Identifier: Apache-2.0
// A picture as it was drawn, with the depth of every pixel: what warp_picture() makes pictures of
// other views from. In place of the depth its inverse is kept, the disparity: of a plane it is
// linear in the picture, and what moves against what when the eye moves is proportional to it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "frame/frame.h"
#include "frame/tonemap.h"
#include "light/visible/visibility.h"
#include "picture/cells.h"
#include "world/view.h"

namespace wellspring::picture {

struct Keyframe {
  static constexpr int block = 8;            // pixels a side
  static constexpr float step_scale = 4096;  // steps a unit of disparity
  View view;                                 // whose size is the picture's
  // Red in the lowest byte, then green, blue and the step: how far apart the disparities of this
  // pixel and those to its right, below, and both are, times step_scale, rounded up, at most 255.
  // One pixel more than there are, since they are read in pairs; disparities likewise.
  std::vector<uint32_t> color;
  std::vector<float> disparity;  // 1 / depth; 0 at infinity and where the depth is none
  // Of blocks, row after row: the pixels and those around them.
  int columns = 0, rows = 0;
  std::vector<float> farthest, nearest;

  bool empty() const { return color.empty(); }
};
size_t memory_bytes(const Keyframe& keyframe);

// The view with some of what lies around, in pixels of the same size: what is drawn of it for
// warps. To the sides so much that it may turn by `turn` radians, within a tenth of its width.
View keyframe_view(View view, float turn = 0);

// The same in larger pixels: sides of `scale` times as many.
View scaled_view(View view, float scale);

// One view of all that several of nearly the same place show, in their middle direction and as wide
// as it takes, within what a flat picture can hold; about `share` of the first one's pixels, and no
// larger than that to any side. No views: an empty one.
View surrounding_view(std::span<const View> views, float share);

// The unit in which a display is told disparities of the view (frame/disparity_code.h): they are
// off by at most half a pixel of parallax for each metre that the eye moves.
float disparity_unit(const View& view);

// The share of the picture that appears anew beside what is nearer, for a metre that the eye moves.
float uncovered_a_metre(const Keyframe& keyframe);

// Reuses the memory of `keyframe`. `depth`: along the viewing axis, one a pixel, as Frame::depth;
// anything that is not a positive number counts as infinitely far. Throws std::invalid_argument
// when sizes differ.
void make_keyframe(const View& view, const Image8& picture, std::span<const float> depth,
                   Keyframe& keyframe);

// What moves in a picture at rest, drawn by itself over what does not: a storyteller who breathes
// and speaks is a few hundredths of a picture, and the rest of it need not be drawn again for each
// of her moves. Lit by what is kept on her skin (light/known/skin_light.h).

// A layer has what moves alone, with the depth of its pixels, for who lays it over other views.
struct MovingLayer {
  PictureWindow window;
  std::vector<uint8_t> rgb;      // of the window, row after row
  std::vector<float> disparity;  // likewise; 0: nothing that moves is there
};

// A window of a picture, to be laid over the rest of it.
struct MovingPicture {
  View view;  // of the whole
  PictureWindow window;
  std::vector<uint8_t> rgb;  // of the window, row after row
  MovingLayer layer;         // where that is asked for: what moves is there, not in the window
  bool empty() const { return window.empty(); }
};
size_t memory_bytes(const MovingPicture& picture);
// Into a picture of the size of picture.view.
void lay_over(const MovingPicture& picture, Image8& image);
void lay_over(const MovingPicture& picture, Keyframe& keyframe);  // its depths stay

// Scratch, overwritten by every picture.
struct MovingLight {
  Image8 picture;                // of the whole view, the window alone filled
  std::vector<uint8_t> peaks;    // of its pixels, as soften_edges() needs them
  std::vector<float> disparity;  // of those that show what moves, where a layer is asked for
};
size_t memory_bytes(const MovingLight& light);

// Of `view`, where visible moving meshes of the world may show, with some around that edges reach;
// empty: nowhere.
PictureWindow moving_window(const World& world, const View& view);
// What of the picture Raster's runs take that lie in the window.
PictureWindow whole_runs(const PictureWindow& window, const View& view);

// What the keyframe shows there, into a picture of its size: others of its pixels stay.
void copy_colors(const Keyframe& keyframe, const PictureWindow& window, Image8& image);
// The peaks of its pixels, as far as its colours tell them: of white the least.
void guess_peaks(const Image8& image, const PictureWindow& window, std::vector<uint8_t>& peaks);
// Copies the pixels of a window of a picture, row after row.
void take_window(const Image8& image, const PictureWindow& window, std::vector<uint8_t>& rgb);
// The part of the view that the window shows, as a view of its own.
View window_view(const View& view, const PictureWindow& window);

}  // namespace wellspring::picture
