// SPDX-License-Identifier: Apache-2.0
#include "light_rays.h"

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "base/clock.h"
#include "light/technique/technique.h"
#include "world/scene.h"
#include "world/view.h"

namespace wellspring::test {
namespace {

constexpr int rays_width = 1280, rays_height = 720;
constexpr int their_path_length = 8;  // its default: the first vertex and its shadow ray count 1

// The other program's scene: what a Wavefront file of polygons and diffuse colours says.
struct Yardstick {
  Scene scene;
  View view;
};

std::map<std::string, vec3> load_diffuse_colors(const std::filesystem::path& file) {
  std::map<std::string, vec3> colors;
  std::ifstream in(file);
  std::string line, word, name;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    words >> word;
    if (word == "newmtl") words >> name;
    if (vec3 c; word == "Kd" && words >> c.x >> c.y >> c.z) colors[name] = c;
  }
  return colors;
}

Scene load_polygons(const std::filesystem::path& file) {
  Scene scene;
  scene.materials.emplace_back();
  scene.objects.push_back("");
  std::map<std::string, vec3> colors;
  std::map<std::string, int> mesh_of;  // one mesh a material
  std::vector<vec3> positions;
  int current = -1;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word, name;
    words >> word;
    if (word == "mtllib") {
      words >> name;
      colors = load_diffuse_colors(file.parent_path() / name);
    } else if (word == "v") {
      vec3 p;
      words >> p.x >> p.y >> p.z;
      positions.push_back(p);
    } else if (word == "usemtl") {
      words >> name;
      if (!mesh_of.contains(name)) {
        Mesh mesh;
        mesh.material = int(scene.materials.size());
        mesh_of[name] = int(scene.meshes.size());
        Material material;
        material.base_color = vec4(colors[name], 1);
        material.metallic = 0;
        material.ior = 1;  // Lambertian, as theirs
        scene.materials.push_back(material);
        scene.objects.push_back(name);
        scene.instances.push_back({mesh_of[name], mat4(1), uint32_t(scene.objects.size()) - 1});
        scene.meshes.push_back(mesh);
      }
      current = mesh_of[name];
    } else if (word == "f" && current >= 0) {
      std::vector<vec3> corner;
      for (long i; words >> i;) {
        size_t index = i < 0 ? positions.size() + size_t(i) : size_t(i - 1);
        if (index >= positions.size()) throw std::runtime_error(file.string() + ": no such vertex");
        corner.push_back(positions[index]);
      }
      if (corner.size() < 3) continue;
      Mesh& mesh = scene.meshes[size_t(current)];
      for (size_t i = 2; i < corner.size(); i++) {  // each with its own normal: not all are plane
        uint32_t first = uint32_t(mesh.positions.size());
        vec3 normal = normalize(cross(corner[i - 1] - corner[0], corner[i] - corner[0]));
        for (vec3 p : {corner[0], corner[i - 1], corner[i]}) {
          mesh.positions.push_back(p);
          mesh.normals.push_back(normal);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
      }
    }
  }
  return scene;
}

// Reads the settings file: model, one point light, camera.
Yardstick load_yardstick(const std::filesystem::path& settings) {
  Yardstick box;
  std::ifstream in(settings);
  dvec3 eye(0), target(0), up(0, 1, 0);
  double fov = 90;
  PunctualLight light;
  bool lit = false;
  auto read = [&](dvec3& v) { in >> v.x >> v.y >> v.z; };
  for (std::string word; in >> word;) {
    if (word.starts_with("--")) word.erase(0, 1);
    if (word == "-i") {
      std::string name;
      in >> name;
      box.scene = load_polygons(settings.parent_path() / name);
    } else if (word == "-pointlight") {
      dvec3 p, intensity;
      read(p), read(intensity);
      light.position = vec3(p), light.intensity = vec3(intensity);
      lit = true;
    } else if (word == "-vp") {
      read(eye);
    } else if (word == "-vi") {
      read(target);
    } else if (word == "-vu") {
      read(up);
    } else if (word == "-fov") {
      in >> fov;
    }
  }
  if (!lit || triangle_count(box.scene) == 0)
    throw std::runtime_error(settings.string() + ": not the Cornell box this benchmark knows");
  box.scene.lights.push_back(light);
  box.view = make_view_towards(box.scene, eye, target, vec3(up), glm::radians(float(fov)),
                               rays_width, rays_height);
  return box;
}

double processor_seconds(int of) {
  rusage use;
  getrusage(of, &use);
  auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

// Holds the other program's own figures, and the processor time that the system measures for it.
struct OtherRun {
  double rays_per_second = 0;  // 0: it did not say
  double processor_seconds_per_ray = 0;
};
OtherRun run_other(const std::filesystem::path& settings, int frames) {
  constexpr int before = 2;  // frames that it draws and does not count
  std::string command = "cd '" + settings.parent_path().string() +
                        "' && timeout 300 pathtracer -c " + settings.filename().string() +
                        " --size " + std::to_string(rays_width) + " " +
                        std::to_string(rays_height) + " --benchmark " + std::to_string(before) +
                        " " + std::to_string(frames) + " 2>/dev/null </dev/null";
  double began = processor_seconds(RUSAGE_CHILDREN);
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {};
  double millions = 0, frames_per_second = 0;
  std::array<char, 512> line;
  while (std::fgets(line.data(), int(line.size()), pipe)) {
    std::sscanf(line.data(), "BENCHMARK_RENDER_MRAYPS_AVG %lf", &millions);
    std::sscanf(line.data(), "BENCHMARK_RENDER_AVG %lf", &frames_per_second);
  }
  pclose(pipe);
  if (!(millions > 0) || !(frames_per_second > 0)) return {};
  double rays = millions * 1e6 / frames_per_second * (frames + before);
  return {millions * 1e6, (processor_seconds(RUSAGE_CHILDREN) - began) / rays};
}

std::filesystem::path find_settings() {
  for (const char* folder : {"/usr/share/doc/embree3/models", "/usr/share/doc/embree4/models",
                             "/usr/share/doc/embree-tools/models"}) {
    std::filesystem::path file = std::filesystem::path(folder) / "cornell_box.ecs";
    if (std::filesystem::exists(file)) return file;
  }
  return {};
}

bool is_installed(const char* program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

double count_rays(const Technique& technique, const World& world, const Lights& lights,
                  const View& view, const StillSettings& settings) {
  uint64_t before = rays_traced();
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++)
      for (int i = 0; i < settings.spp; i++)
        technique.trace(world, lights, settings.transport,
                        pixel_request(view, settings.seed, x, y, i));
  return double(rays_traced() - before);
}

}  // namespace

void bench_light_rays(BenchReport& report, const BenchOptions& options) {
  std::filesystem::path settings_file = find_settings();
  if (settings_file.empty() || !is_installed("pathtracer")) {
    std::cout << "light.path.rays_ratio: skipped, Embree's pathtracer and its models are not "
                 "installed (Debian: embree-tools)\n";
    return;
  }
  Yardstick box = load_yardstick(settings_file);
  World world(box.scene);
  Lights lights = make_lights(world);
  const Technique& path = *find_technique("path");
  StillSettings settings;
  const int samples_a_pixel = options.quick ? 8 : 16;  // theirs has one in each of its frames
  settings.spp = samples_a_pixel;
  settings.transport.max_depth = their_path_length + 1;  // edges: the last shadow ray is one
  double rays = count_rays(path, world, lights, box.view, settings);
  std::vector<double> ours, theirs, ratios, processor_ratios;
  for (int turn = 0; turn < (options.quick ? 3 : 7); turn++) {
    OtherRun other = run_other(settings_file, samples_a_pixel);
    if (!(other.rays_per_second > 0)) {
      std::cout << "light.path.rays_ratio: skipped, pathtracer printed no rays a second\n";
      return;
    }
    double began = seconds_now(), began_processor = processor_seconds(RUSAGE_SELF);
    render_still(path, world, lights, box.view, settings);
    double own = rays / (seconds_now() - began);
    double own_processor = (processor_seconds(RUSAGE_SELF) - began_processor) / rays;
    theirs.push_back(other.rays_per_second);
    ours.push_back(own);
    ratios.push_back(own / other.rays_per_second);
    processor_ratios.push_back(other.processor_seconds_per_ray / own_processor);
  }
  double samples = double(rays_width) * rays_height * settings.spp;
  nlohmann::json fields = {
      {"scene", "embree cornell_box"}, {"technique", "path"}, {"rays_per_sample", rays / samples}};
  report.add("light.path.rays_per_second", quantile(ours, 0.5), "1/s", fields);
  report.add("light.embree_pathtracer.rays_per_second", quantile(theirs, 0.5), "1/s",
             {{"scene", "embree cornell_box"}});
  auto add_ratio = [&](const char* name, const std::vector<double>& all) {
    report.add(name, quantile(all, 0.5), "1",
               {{"scene", "embree cornell_box"},
                {"lowest", quantile(all, 0.0)},
                {"highest", quantile(all, 1.0)}});
  };
  add_ratio("light.path.rays_ratio", ratios);
  // The same in processor time, which other work on the machine changes less.
  add_ratio("light.path.rays_processor_ratio", processor_ratios);
}

}  // namespace wellspring::test
