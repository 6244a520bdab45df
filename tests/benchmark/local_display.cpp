// SPDX-License-Identifier: Apache-2.0
#include "local_display.h"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "frame/disparity_code.h"
#include "frame/flip.h"
#include "frame/jpeg.h"
#include "screen.h"
#include "wire/packet.h"

namespace wellspring {
namespace {

constexpr float most_unknown = 1;  // a page shows whatever there is

std::vector<uint8_t> read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

vec3 vector_of(const nlohmann::json& json) {
  return {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()};
}

View view_of(const nlohmann::json& json) {
  View view;
  view.right = vector_of(json.at("right"));
  view.up = vector_of(json.at("up"));
  view.forward = vector_of(json.at("forward"));
  view.tan_half_fov = json.at("tan_half_fov");
  view.middle = {json.at("middle").at(0).get<float>(), json.at("middle").at(1).get<float>()};
  view.width = json.at("width"), view.height = json.at("height");
  return view;
}

}  // namespace

bool LocalDisplay::receive(std::span<const uint8_t> message) {
  const auto packet = read_packet(message);
  if (!packet || !packet->keyframe || (packet->header.flags & packet_layer)) return false;
  const KeyframeHeader& header = *packet->keyframe;
  if (!origin_) origin_ = header.eye;
  View view;
  view.position = vec3(header.eye - *origin_);
  view.right = header.right, view.up = header.up, view.forward = header.forward;
  view.tan_half_fov = header.tan_half_fov, view.middle = header.middle;
  view.width = header.width, view.height = header.height;
  const Image8 color =
      scale_picture(decode_jpeg(packet->payload.first(header.color_bytes), "a keyframe"),
                    view.width, view.height);
  std::vector<float> depth;
  if (!decode_disparity(packet->payload.subspan(header.color_bytes), view.width, view.height,
                        header.unit, depth))
    throw std::runtime_error("a keyframe's depth is damaged");
  for (float& one : depth) one = 1 / one;
  make_keyframe(view, color, depth, packet->header.flags & packet_around ? around_ : newest_);
  return true;
}

Image8 LocalDisplay::show(View view, dvec3 eye) {
  Image8 out;
  view.position = vec3(eye - origin_.value_or(eye));
  warp_picture(newest_, around_, view, most_unknown, scratch_, out);
  return out;
}

void compare_with_page(const std::string& folder) {
  const auto text = read_bytes(folder + "/cases.json");
  nlohmann::json flips = nlohmann::json::array();
  for (const nlohmann::json& one : nlohmann::json::parse(text)) {
    LocalDisplay display;
    for (const std::string name : one.at("keyframes"))
      if (!display.receive(read_bytes(folder + "/" + name)))
        throw std::runtime_error(name + ": is no keyframe");
    const nlohmann::json& eye = one.at("view").at("eye");
    const View view = view_of(one.at("view"));
    const Image8 own = display.show(view, dvec3(eye.at(0), eye.at(1), eye.at(2)));
    const std::string name = one.at("shown");
    const Image8 shown{view.width, view.height, read_bytes(folder + "/" + name)};
    if (shown.rgb.size() != own.rgb.size())
      throw std::runtime_error(name + ": is not of the view's size");
    flips.push_back(eval_flip(shown, own).mean);
  }
  std::cout << flips << "\n";
}

}  // namespace wellspring
