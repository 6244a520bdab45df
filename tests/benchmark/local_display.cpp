// SPDX-License-Identifier: Apache-2.0
#include "local_display.h"

#include <filesystem>
#include <utility>

#include "base/load_error.h"
#include "base/read_file.h"
#include "frame/disparity_code.h"
#include "frame/picture_file.h"
#include "gltf/file.h"
#include "image/image.h"
#include "judge/flip.h"
#include "screen.h"
#include "wire/packet.h"

namespace wellspring::test {
namespace {

constexpr size_t most_bytes = size_t(64) << 20;  // largest file
constexpr const char* what = "a picture of the server's";

View view_of(const KeyframeHeader& header, dvec3 origin) {
  View view;
  view.position = vec3(header.eye - origin);
  view.right = header.right, view.up = header.up, view.forward = header.forward;
  view.tan_half_fov = header.tan_half_fov, view.middle = header.middle;
  view.width = header.width, view.height = header.height;
  return view;
}

std::vector<float> read_depth(const KeyframeHeader& header, std::span<const uint8_t> bytes) {
  std::vector<float> depth;
  if (!decode_disparity(bytes, header.width, header.height, header.unit, depth))
    throw LoadError(what, "depth", "is damaged");
  depth.resize(size_t(header.width) * header.height);
  for (float& one : depth) one = 1 / one;  // infinite at 0
  return depth;
}

}  // namespace

void LocalDisplay::take(Shown shown, bool is_around) {
  if (is_around) {
    around_ = std::move(shown);
    return;
  }
  before_ = std::exchange(newest_, std::move(shown));
  if (before_.cuts != newest_.cuts) before_ = {};
}

bool LocalDisplay::receive(std::span<const uint8_t> message) {
  const auto packet = read_packet(message);
  if (!packet) return false;
  const PacketHeader& header = packet->header;
  if (header.flags & packet_layer) return true;
  if (packet->keyframe) {
    const KeyframeHeader& keyframe = *packet->keyframe;
    const auto color = packet->payload.first(keyframe.color_bytes);
    take({view_of(keyframe, origin_),
          keyframe.cuts,
          decode_jpeg(color, what),
          read_depth(keyframe, packet->payload.subspan(keyframe.color_bytes)),
          {}},
         header.flags & packet_around);
    return true;
  }
  if ((header.flags & packet_complete) || newest_.depth.empty()) return false;
  newest_.color = scale_picture(newest_.color, header.width, header.height);
  paste_parts(*packet, newest_.color);
  if (!packet->parts.empty()) newest_.keyframe = {};
  return true;
}

Image8 LocalDisplay::picture(const View& view) {
  const Keyframe* keyframes[3];
  size_t i = 0;
  for (Shown* one : {&newest_, &before_, &around_}) {
    if (one->keyframe.empty() && !one->depth.empty())
      make_keyframe(one->view, scale_picture(one->color, one->view.width, one->view.height),
                    one->depth, one->keyframe);
    keyframes[i++] = &one->keyframe;
  }
  Image8 picture{view.width, view.height, {}};
  picture.rgb.resize(3 * size_t(view.width) * size_t(view.height));
  const bool fits = around_.cuts == newest_.cuts;
  warp_picture(std::span(keyframes, fits ? 3 : 2), view, 1, scratch_, picture);
  return picture;
}

nlohmann::json draw_steps(const std::string& folder) {
  auto path = [&](const std::string& name) {
    return (std::filesystem::path(folder) / name).string();
  };
  auto triple = [](const nlohmann::json& from) { return vec3(from[0], from[1], from[2]); };
  const std::string steps = path("steps.json");
  const gltf::Bytes text = read_file<gltf::Bytes>(steps, most_bytes);
  LocalDisplay display;
  nlohmann::json flips = nlohmann::json::object();
  for (const nlohmann::json& step : nlohmann::json::parse(text.begin(), text.end())) {
    if (step.contains("packet")) {
      const std::string file = path(step["packet"]);
      if (!display.receive(read_file<gltf::Bytes>(file, most_bytes)))
        throw LoadError(file, "", "is no picture with depth");
      continue;
    }
    const nlohmann::json& from = step.at("view");
    View view;
    view.position = triple(from.at("eye"));
    view.right = triple(from.at("right")), view.up = triple(from.at("up"));
    view.forward = triple(from.at("forward"));
    view.tan_half_fov = from.at("tan_half_fov");
    view.middle = {from.at("middle")[0], from.at("middle")[1]};
    view.width = from.at("width"), view.height = from.at("height");
    const std::string name = step.at("name");
    const Image8 drawn = display.picture(view);
    save_image8(path(name + ".png"), drawn);
    const gltf::Bytes pixels = read_file<gltf::Bytes>(path(name + ".rgb"), most_bytes);
    if (pixels.size() != drawn.rgb.size())
      throw LoadError(path(name + ".rgb"), "", "is not of the view's size");
    Image8 page{view.width, view.height, std::vector<uint8_t>(pixels.begin(), pixels.end())};
    flips[name] = eval_flip(page, drawn).mean;
  }
  return flips;
}

}  // namespace wellspring::test
