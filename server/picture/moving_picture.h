// SPDX-License-Identifier: Apache-2.0
// What moves in a picture at rest, drawn by itself over what does not: a storyteller who breathes
// and speaks is a few hundredths of a picture, and the rest of it need not be drawn again for each
// of her moves. Lit by what is kept on her skin (light/known/skin_light.h).
#pragma once
#include "frame/tonemap.h"
#include "light/visible/visibility.h"
#include "picture/cells.h"
#include "picture/keyframe.h"

namespace wellspring::picture {

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
