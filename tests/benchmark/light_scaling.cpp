// SPDX-License-Identifier: Apache-2.0
// What a ray costs as the scene grows: the Cornell box cut into ever more triangles, the same
// picture each time, so that only the number of triangles changes.
#include <cmath>
#include <ctime>

#include "base/parallel.h"
#include "light/random/sampler.h"
#include "light/technique/technique.h"
#include "light/random/warp.h"
#include "light_scenes.h"
#include "plot.h"
#include "tessellate.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

// Rays from what the eye sees in directions scattered by the cosine: as incoherent as paths are.
std::vector<Ray> scattered_rays(const World& world, const View& view, int count) {
  std::vector<Ray> rays(static_cast<size_t>(count));
  parallel_ranges(count, 1024, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      Sampler sampler(mix64(uint64_t(i) + 1));
      vec2 p = sampler.next2();
      Ray ray = view_ray(view, p.x * float(view.width), p.y * float(view.height));
      Hit hit = world.intersect(ray);
      if (hit.valid()) {
        Surface s = eval_surface(world, ray, hit);
        vec3 local = sample_cosine_hemisphere(sampler.next2());
        vec3 u =
            normalize(cross(std::abs(s.geometric_normal.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0),
                            s.geometric_normal));
        ray.direction = normalize(local.x * u + local.y * cross(s.geometric_normal, u) +
                                  local.z * s.geometric_normal);
        ray.origin = offset_origin(s, ray.direction);
      }
      rays[size_t(i)] = ray;
    }
  });
  return rays;
}

// Nanoseconds of processor time, all threads together: hardly changed by what else the machine
// does.
double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

struct Cost {
  double triangles, ray_ns, sample_ns;
};
Cost measure(const BenchScene& bench, size_t triangles, bool quick) {
  Scene scene = tessellate(bench.scene, triangles);
  World world(scene);
  const Viewpoint& c = bench.camera;
  View view = make_view(scene, c.position, c.yaw, c.pitch, c.fov, 256, 256);
  std::vector<Ray> rays = scattered_rays(world, view, quick ? 100000 : 400000);
  std::vector<double> ray_ns, sample_ns;
  Lights lights = make_lights(world);
  StillSettings settings;
  settings.spp = quick ? 2 : 8;
  double met = 0;
  for (int turn = 0; turn < 3; turn++) {
    double began = cpu_seconds();
    for (const Ray& ray : rays) {
      Hit hit = world.intersect(ray);
      if (hit.valid()) met += double(hit.t);
    }
    ray_ns.push_back((cpu_seconds() - began) / double(rays.size()) * 1e9);
    began = cpu_seconds();
    met += double(render_still(*find_technique("path"), world, lights, view, settings).depth[0]);
    sample_ns.push_back((cpu_seconds() - began) / (256.0 * 256.0 * settings.spp) * 1e9);
  }
  if (!(met > 0)) throw std::runtime_error("light.scaling: no ray met anything");
  return {double(triangle_count(scene)), quantile(ray_ns, 0.5), quantile(sample_ns, 0.5)};
}

// Least squares of y over x: y = a + b x, and how much of y's variance that explains.
struct Fit {
  double a, b, r2;
};
Fit fit_line(const std::vector<std::pair<double, double>>& points) {
  double n = double(points.size()), sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (auto [x, y] : points) sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  double cov = sxy - sx * sy / n, vx = sxx - sx * sx / n, vy = syy - sy * sy / n;
  return {sy / n - cov / vx * sx / n, cov / vx, vy > 0 ? cov * cov / (vx * vy) : 1};
}

}  // namespace

void bench_light_scaling(BenchReport& report, const BenchOptions& options) {
  BenchScene bench = load_bench_scene(options, "cornell_box");
  Plot plot{"Cost of a ray over triangles",
            "Cornell box cut into ever more triangles, the same picture",
            "triangles",
            "processor time [ns]",
            {{"a sample of path", {}}, {"a scattered ray", {}}},
            0,
            ""};
  std::vector<std::pair<double, double>> by_log, log_log;
  for (double exponent = 3; exponent < 6.01; exponent += options.quick ? 1 : 0.5) {
    Cost cost = measure(bench, size_t(std::pow(10, exponent)), options.quick);
    nlohmann::json fields = {{"scene", bench.name}, {"triangles", cost.triangles}};
    report.add("light.scaling.ray_ns", cost.ray_ns, "ns", fields);
    report.add("light.scaling.sample_ns", cost.sample_ns, "ns", fields);
    by_log.push_back({std::log2(cost.triangles), cost.ray_ns});
    log_log.push_back({std::log(cost.triangles), std::log(cost.ray_ns)});
    plot.curves[0].points.push_back({cost.triangles, cost.sample_ns});
    plot.curves[1].points.push_back({cost.triangles, cost.ray_ns});
  }
  Fit line = fit_line(by_log);
  report.add("light.scaling.ns_per_doubling", line.b, "ns",
             {{"r2", line.r2}, {"scene", bench.name}});
  report.add("light.scaling.exponent", fit_line(log_log).b, "1", {{"scene", bench.name}});
  save_svg(options.plots + "light_scaling.svg", plot);
}

}  // namespace wellspring::test
