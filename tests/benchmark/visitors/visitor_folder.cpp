// SPDX-License-Identifier: Apache-2.0
#include "visitor_folder.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include "frame/picture_file.h"

namespace wellspring::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int samples_a_pixel = 4;

json triple(vec3 v) { return {v.x, v.y, v.z}; }
vec3 vector_of(const json& v) { return {v.at(0), v.at(1), v.at(2)}; }

json describe(const VisitorShot& shot) {
  json people = json::array();
  for (const Visitor& one : shot.visitors)
    people.push_back({{"figure", one.figure},
                      {"position", triple(one.eyes)},
                      {"rotation", triple(one.turn)},
                      {"size", one.size},
                      {"expression", one.expression},
                      {"strength", one.strength},
                      {"worn", int(one.worn)}});
  return {{"light", name_of(shot.light)}, {"people", people}};
}

void write_folder(VisitorStage& stage, const std::vector<VisitorSequence>& sequences,
                  const VisitorWatch& watch) {
  fs::remove_all(watch.folder);
  fs::create_directories(watch.folder);
  std::map<std::string, std::string> drawn;  // the same picture is drawn once
  json all = json::array();
  int count = 0;
  for (const VisitorSequence& sequence : sequences) {
    json frames = json::array();
    for (const VisitorFrame& frame : sequence.frames) {
      json entry = describe(frame.shot);
      std::string& file = drawn[frame.change ? "changed " + std::to_string(count) : entry.dump()];
      if (file.empty()) {
        file = std::to_string(count++) + ".png";
        VisitorPicture picture = stage.draw(frame.shot, samples_a_pixel);
        if (frame.change) frame.change(picture);
        save_image8((fs::path(watch.folder) / file).string(), picture.image);
      }
      entry["picture"] = file, entry["seconds"] = frame.seconds, entry["judged"] = frame.judged;
      frames.push_back(entry);
    }
    all.push_back({{"about", sequence.about}, {"frames", frames}});
  }
  std::ofstream out(fs::path(watch.folder) / "truth.json");
  out << json{{"fov", visitor_fov}, {"rate", watch.rate}, {"sequences", all}}.dump(1);
  if (!out.flush()) throw std::runtime_error(watch.folder + ": cannot be written");
}

VisitorSeen read_seen(const json& line) {
  VisitorSeen seen;
  seen.found = line.at("found"), seen.most = line.at("most");
  for (const json& one : line.at("people")) {
    VisitorSeen::Person person;
    person.id = one.at("id");
    person.position = vector_of(one.at("position"));
    person.rotation = vector_of(one.at("rotation"));
    person.expression = one.at("expression").get<std::array<float, 6>>();
    seen.people.push_back(person);
  }
  return seen;
}

}  // namespace

std::vector<std::vector<VisitorSeen>> watch_visitors(VisitorStage& stage,
                                                     const std::vector<VisitorSequence>& sequences,
                                                     const VisitorWatch& watch) {
  write_folder(stage, sequences, watch);
  auto quoted = [](const fs::path& path) { return "'" + path.string() + "'"; };
  const std::string command = quoted(fs::path(watch.programs) / "wellspring_kiosk_watch") + " " +
                              quoted(watch.folder) + " --weights " + quoted(watch.weights) +
                              (watch.expression ? " --expression" : "");
  std::unique_ptr<FILE, int (*)(FILE*)> out(popen(command.c_str(), "r"), pclose);
  if (!out) throw std::runtime_error(command + ": cannot be started");
  std::vector<std::vector<VisitorSeen>> seen(sequences.size());
  std::string line;
  for (int c; (c = std::fgetc(out.get())) != EOF;) {
    if (c != '\n') {
      line += char(c);
      continue;
    }
    const json fields = json::parse(line);
    seen.at(fields.at("sequence")).push_back(read_seen(fields));
    line.clear();
  }
  if (pclose(out.release()) != 0) throw std::runtime_error(command + ": did not finish");
  for (size_t i = 0; i < sequences.size(); i++)
    if (seen[i].size() != sequences[i].frames.size())
      throw std::runtime_error(command + ": did not watch all pictures");
  return seen;
}

}  // namespace wellspring::test
