// SPDX-License-Identifier: Apache-2.0
// Shows keyframes from where the visitor is, as pages do that draw by themselves (web/display).
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "picture/warp_picture.h"

namespace wellspring {

class LocalDisplay {
 public:
  // Takes a binary message. False: it is no keyframe. Throws std::runtime_error where its depth is
  // damaged, LoadError where its JPEG is.
  bool receive(std::span<const uint8_t> message);
  // `view`: at `eye`, in the exhibit's metres; its position does not count.
  Image8 show(View view, dvec3 eye);

 private:
  Keyframe newest_, around_;
  std::optional<dvec3> origin_;  // of the keyframes' places: the first one's eye
  WarpScratch scratch_;
};

// Compares what a page has drawn with what this display draws: `folder` has cases.json, a list of
// {keyframes: [file], view: {eye, right, up, forward, tan_half_fov, middle, width, height}, shown:
// file of RGB bytes}; prints a list of FLIPs. Throws std::runtime_error.
void compare_with_page(const std::string& folder);

}  // namespace wellspring
