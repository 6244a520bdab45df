// SPDX-License-Identifier: Apache-2.0
#include "kiosk/config.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/load_error.h"
#include "wire/json.h"
#include "wire/json_line.h"

namespace wellspring::kiosk {
namespace {

using nlohmann::json;

constexpr float degree = pi / 180;

std::string read_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw LoadError(file, "", "cannot be read");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

json parse(const std::string& file, const std::string& text) {
  auto parsed = parse_json(text);
  if (auto* error = std::get_if<WireError>(&parsed)) throw LoadError(file, "", error->message);
  json root = std::get<json>(std::move(parsed));
  if (!root.is_object()) throw LoadError(file, "", "not an object");
  return root;
}

// One value at `where`.
using Take = std::function<void(const json& value, const std::string& where)>;

struct Reader {
  const std::string &file, &written;

  // What is missing has the line of what lacks it.
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    int line = find_json_line(written, where);
    if (line == 0) line = find_json_line(written, where.substr(0, where.rfind('/')));
    throw LoadError(file, "line " + std::to_string(line) + ", " + where, what);
  }
  void object(const json& value, const std::string& where,
              const std::map<std::string, Take>& known) const {
    if (!value.is_object()) fail(where, "is not an object");
    for (const auto& [name, item] : value.items()) {
      const std::string at = where + "/" + name;
      auto found = known.find(name);
      if (found == known.end()) {
        std::string names;
        for (const auto& [one, unused] : known) names += (names.empty() ? "" : ", ") + one;
        fail(at, "is unknown; there are " + names);
      }
      found->second(item, at);
    }
  }
  template <class Number>
  Take number(Number& to, double least, double most, double unit = 1) const {
    return [this, &to, least, most, unit](const json& value, const std::string& where) {
      double v = value.is_number() ? value.get<double>() : NAN;
      if (!(v >= least && v <= most)) {
        std::ostringstream range;
        range << "is not a number from " << least << " to " << most;
        fail(where, range.str());
      }
      to = Number(v * unit);
    };
  }
  Take text(std::string& to) const {
    return [this, &to](const json& value, const std::string& where) {
      if (!value.is_string() || value.get<std::string>().empty()) fail(where, "is not a text");
      to = value.get<std::string>();
    };
  }
  Take flag(bool& to) const {
    return [this, &to](const json& value, const std::string& where) {
      if (!value.is_boolean()) fail(where, "is not true or false");
      to = value.get<bool>();
    };
  }
  Take place(vec3& to) const {
    return [this, &to](const json& value, const std::string& where) {
      if (!value.is_array() || value.size() != 3) fail(where, "is not a list of three numbers");
      for (int i = 0; i < 3; i++) number(to[i], -10, 10)(value[size_t(i)], where);
    };
  }
  Take part(std::map<std::string, Take> known) const {
    return [this, known = std::move(known)](const json& value, const std::string& where) {
      object(value, where, known);
    };
  }
  std::map<std::string, Take> lens(CameraSettings& camera) const {
    return {{"width", number(camera.width, 160, 1920)},
            {"rate", number(camera.rate, 1, 120)},
            {"fov", number(camera.mount.fov, 10, 170, double(degree))},
            {"mirrored", flag(camera.mount.mirrored)}};
  }
  Take mount(Mount& to) const {
    return part({{"offset", place(to.offset)}, {"pitch", number(to.pitch, -80, 80, degree)}});
  }
  // Those that the file lists; `common`: what they leave out.
  Take list(std::vector<CameraSettings>& cameras, const CameraSettings& common) const {
    return [this, &cameras, &common](const json& value, const std::string& where) {
      if (!value.is_array() || value.empty()) fail(where, "is not a list of cameras");
      for (size_t i = 0; i < value.size(); i++) {
        const std::string at = where + "/" + std::to_string(i);
        CameraSettings& camera = cameras.emplace_back(common);
        std::map<std::string, Take> known = lens(camera);
        known["source"] = text(camera.source);
        known["name"] = text(camera.name);
        known["mount"] = mount(camera.mount);
        object(value[i], at, known);
        if (camera.source.empty()) fail(at + "/source", "is missing");
      }
    };
  }
};

}  // namespace

void load_config(const std::string& file, KioskConfig& config) {
  const std::string written = read_text(file);
  const json root = parse(file, written);
  const Reader r{file, written};
  CameraSettings& camera = config.camera;
  PresenceSettings& presence = config.presence;
  constexpr double longest = 600;  // seconds
  r.object(root, "",
           {{"name", r.text(config.name)},
            {"server", r.text(config.server)},
            {"token_file", r.text(config.token_file)},
            {"ca_file", r.text(config.ca_file)},
            {"camera", r.part(r.lens(camera))},
            {"mount", r.mount(camera.mount)},
            {"cameras", [](const json&, const std::string&) {}},  // after what they have in common
            {"presence", r.part({{"wake_after", r.number(presence.wake_after, 0, longest)},
                                 {"confirm_after", r.number(presence.confirm_after, 0, longest)},
                                 {"hold_person", r.number(presence.hold_person, 0, longest)},
                                 {"hold_motion", r.number(presence.hold_motion, 0, longest)}})},
            {"expression", r.flag(config.expression)},
            {"hands", r.flag(config.hands)}});
  if (root.contains("cameras")) r.list(config.cameras, camera)(root["cameras"], "/cameras");
}

void save_mount(const std::string& file, const std::string& source, const Mount& mount) {
  json root = std::filesystem::exists(file) ? parse(file, read_text(file)) : json::object();
  auto rounded = [](double v) { return std::round(1000 * v) / 1000; };
  json *lens = &root["camera"], *place = &root["mount"];
  if (root.contains("cameras"))
    for (json& camera : root["cameras"])
      if (camera["source"] == source) lens = &camera, place = &camera["mount"];
  (*lens)["fov"] = rounded(double(mount.fov / degree));
  (*place)["pitch"] = rounded(double(mount.pitch / degree));
  (*place)["offset"] = {rounded(double(mount.offset.x)), rounded(double(mount.offset.y)),
                        rounded(double(mount.offset.z))};
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << root.dump(2) << '\n';
  if (!out.flush()) throw LoadError(file, "", "cannot be written");
}

}  // namespace wellspring::kiosk
