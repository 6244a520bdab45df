// SPDX-License-Identifier: Apache-2.0
// wellspring_kiosk_watch FOLDER: what the kiosk's eye sees in a folder of pictures with a
// truth.json, for the benchmark, which draws them (tests/benchmark/visitors/). Each picture is
// shown for its time with the noise of a sensor that is new in each frame. Prints a JSON object for
// each picture.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>

#include "about/version.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/rng.h"
#include "kiosk/observe.h"

namespace {

using namespace wellspring;
using namespace wellspring::test;
using nlohmann::json;

// Standard deviation in grey levels: what electronics add, and what light itself does at white.
constexpr float read_noise = 1.5f, photon_noise = 2.5f;

GrayFrame load_picture(const std::string& path) {
  GrayFrame frame;
  std::unique_ptr<uint8_t, void (*)(void*)> gray(
      stbi_load(path.c_str(), &frame.width, &frame.height, nullptr, 1), stbi_image_free);
  if (!gray) throw LoadError(path, "", "not a picture that can be read");
  frame.pixels.assign(gray.get(), gray.get() + size_t(frame.width) * size_t(frame.height));
  return frame;
}

// Gaussian values, drawn once; a frame begins anywhere among them.
const std::vector<float>& gauss_values() {
  static const std::vector<float> values = [] {
    std::vector<float> made(1u << 20);
    for (size_t i = 0; i < made.size(); i++) {
      const uint64_t bits = mix64(i + 1);
      const double u = (double(bits >> 32) + 1) / 4294967297.0,
                   v = double(bits & 0xffffffffu) / 4294967296.0;
      made[i] = float(std::sqrt(-2 * std::log(u)) * std::cos(2 * 3.14159265358979 * v));
    }
    return made;
  }();
  return values;
}

GrayFrame with_noise(const GrayFrame& picture, uint64_t seed) {
  GrayFrame frame = picture;
  const std::vector<float>& gauss = gauss_values();
  uint64_t at = mix64(seed);
  for (uint8_t& pixel : frame.pixels) {
    const float light = float(pixel);
    const float noise =
        std::sqrt(read_noise * read_noise + photon_noise * photon_noise * light / 255);
    pixel = uint8_t(glm::clamp(light + noise * gauss[at++ % gauss.size()] + 0.5f, 0.f, 255.f));
  }
  return frame;
}

json describe(const Person& person) {
  const auto& p = person.position;
  const auto& r = person.rotation;
  const Expression e = person.expression.value_or(Expression{});
  return {{"id", person.id},
          {"position", {p.x, p.y, p.z}},
          {"rotation", {r.x, r.y, r.z}},
          {"expression", {e.joy, e.sadness, e.anger, e.fear, e.disgust, e.surprise}}};
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  CLI::App app{"Tells what the kiosk's eye sees in a folder of pictures."};
  std::string folder;
  ObserverSettings settings;
  app.add_option("folder", folder, "pictures with a truth.json")->required();
  app.add_option("--weights", settings.face.weights, "folder of the networks' weights");
  app.add_flag("--expression", settings.expression, "what faces express, too");
  CLI11_PARSE(app, argc, argv);
  log::start("watch");
  cv::setNumThreads(1);
  try {
    using nlohmann::json;
    std::ifstream in(folder + "/truth.json");
    const json truth = json::parse(in);
    settings.mount.fov = truth.at("fov");
    const double rate = truth.at("rate");
    std::map<std::string, GrayFrame> pictures;
    for (size_t s = 0; s < truth.at("sequences").size(); s++) {
      Observer observer(settings);
      uint64_t number = 0;
      for (const json& shown : truth.at("sequences")[s].at("frames")) {
        const std::string name = shown.at("picture");
        auto known = pictures.find(name);
        if (known == pictures.end())
          known = pictures.emplace(name, load_picture(folder + "/" + name)).first;
        const int frames = std::max(1, int(std::lround(shown.at("seconds").get<double>() * rate)));
        Observation seen;
        int found = 0, judged = 0, most = 0;
        for (int k = 0; k < frames; k++, number++) {
          GrayFrame frame = with_noise(known->second, number);
          frame.time = double(number) / rate;
          seen = observer.step(frame);
          if (2 * k < frames - 1) continue;
          judged++, found += !seen.people.empty();
          most = std::max(most, int(seen.people.size()));
        }
        json line{{"sequence", s}, {"found", double(found) / judged}, {"most", most}};
        line["people"] = json::array();
        for (const Person& person : seen.people) line["people"].push_back(describe(person));
        std::puts(line.dump().c_str());
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
