// SPDX-License-Identifier: Apache-2.0
// A keyframe is a picture as it was drawn, with the depth of every pixel: warp_picture() makes
// pictures of other views from it. The inverse of the depth is kept, the disparity: for a plane it
// is linear in the picture, and the parallax of a moving eye is proportional to it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "frame/frame.h"
#include "frame/tonemap.h"
#include "light/visible/visibility.h"
#include "picture/cells/cells.h"
#include "picture/sway_image.h"
#include "world/view.h"

namespace wellspring::picture {

struct Keyframe {
  static constexpr int block = 8;            // pixels a side
  static constexpr float step_scale = 4096;  // steps a unit of disparity
  View view;                                 // its size is the picture's
  // Red lies in the lowest byte, then green, blue and the step: how far apart the disparities of
  // this pixel and those to its right, below, and both are, times step_scale, rounded up, at most
  // 255. There is one pixel more than the picture has, since they are read in pairs; disparities
  // likewise.
  std::vector<uint32_t> color;
  std::vector<float> disparity;  // 1 / depth; 0 at infinity and without a depth
  // Number of blocks, and bounds of the disparities in each, row after row: of its pixels and those
  // around them.
  int columns = 0, rows = 0;
  std::vector<float> farthest, nearest;
  SwayImage sway;  // empty unless it is asked for

  bool empty() const { return color.empty(); }
};
size_t memory_bytes(const Keyframe& keyframe);

// Returns the view with some of what lies around, in pixels of the same size: it is drawn as a
// keyframe for warps. The sides are wide enough that it may turn by `turn` radians, within a tenth
// of its width.
View keyframe_view(View view, float turn = 0);

// Returns the same view in larger pixels: sides have `scale` times as many.
View scaled_view(View view, float scale);

// Returns one view of all that several views of nearly the same place show, in their middle
// direction and as wide as it takes, within what a flat picture can hold; it has about `share` of
// the first one's pixels, and no side is longer than the first one's. Without views it is empty.
View surrounding_view(std::span<const View> views, float share);

// Returns the unit in which a display gets disparities of the view (frame/disparity_code.h): they
// are off by at most half a pixel of parallax for each metre that the eye moves.
float disparity_unit(const View& view);

// Returns the share of the picture that is disoccluded beside nearer things, for a metre that the
// eye moves.
float uncovered_a_metre(const Keyframe& keyframe);

// Makes a keyframe, and reuses the memory of `keyframe`. `depth`: along the viewing axis, one a
// pixel, as Frame::depth; anything that is not a positive number counts as infinitely far. Throws
// std::invalid_argument if sizes differ.
void make_keyframe(const View& view, const Image8& picture, std::span<const float> depth,
                   Keyframe& keyframe);

// Draws what moves in a picture at rest by itself, over what does not: a storyteller who breathes
// and speaks is a few hundredths of a picture, and the rest of it need not be drawn again for each
// move. The light is that kept on the skin (light/kept/skin/skin_light.h).

// A layer has what moves alone, with the depth of its pixels, to be laid over other views.
struct MovingLayer {
  PictureWindow window;
  std::vector<uint8_t> rgb;      // colours of the window, row after row
  std::vector<float> disparity;  // likewise; 0: nothing that moves is there
};

// A window of a picture, to be laid over the rest of it.
struct MovingPicture {
  View view;  // view of the whole picture
  PictureWindow window;
  std::vector<uint8_t> rgb;  // colours of the window, row after row
  MovingLayer layer;  // moving meshes, if a layer is asked for: they are not in the window then
  SwayImage sway;     // the sway of the grass in the window, if a layer is asked for
  bool empty() const { return window.empty(); }
};
size_t memory_bytes(const MovingPicture& picture);
// Lays the window over a picture of the size of picture.view.
void lay_over(const MovingPicture& picture, Image8& image);
void lay_over(const MovingPicture& picture, Keyframe& keyframe);  // its depths stay

// Holds scratch memory, overwritten by every picture.
struct MovingLight {
  Image8 picture;              // picture of the whole view, the window alone filled
  std::vector<uint8_t> peaks;  // peaks of its pixels, as soften_edges() needs them
  // Disparity of pixels that show what moves, if a layer is asked for.
  std::vector<float> disparity;
};
size_t memory_bytes(const MovingLight& light);

// Returns the window of `view` in which visible moving meshes of the world may show, with a margin
// that edges reach; it is empty if they show nowhere.
PictureWindow moving_window(const World& world, const View& view);
// Returns the window in which a box may show, in the same way; all of the picture if it reaches
// behind the eye.
PictureWindow window_around(const Bounds& box, const View& view);
// Returns the least window around both.
PictureWindow joined(const PictureWindow& a, const PictureWindow& b);
// Returns the window widened to whole runs of Raster.
PictureWindow whole_runs(const PictureWindow& window, const View& view);

// Copies the keyframe's colours in the window into a picture of its size; its other pixels stay.
void copy_colors(const Keyframe& keyframe, const PictureWindow& window, Image8& image);
// Guesses the peaks of the window's pixels from their colours: for white the least.
void guess_peaks(const Image8& image, const PictureWindow& window, std::vector<uint8_t>& peaks);
// Copies the pixels of a window of a picture, row after row.
void take_window(const Image8& image, const PictureWindow& window, std::vector<uint8_t>& rgb);
// Returns the part of the view that the window shows, as a view of its own.
View window_view(const View& view, const PictureWindow& window);

}  // namespace wellspring::picture
