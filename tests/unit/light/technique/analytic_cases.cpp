// SPDX-License-Identifier: Apache-2.0
#include "unit/light/technique/analytic_cases.h"

#include "light/sample/environment_light.h"
#include "scenes/lambert.h"

namespace wellspring::test {

using namespace scenes;

namespace {

constexpr double over_pi = 1 / double(pi);

constexpr Claim claimed[] = {
    {"path", every_kind, ""},
    {"direct", every_kind & ~unsigned(interreflection | caustics),
     "light between surfaces is left out by definition"},
    {"gather", every_kind & ~unsigned(interreflection),
     "light between surfaces is read from cells, a little biased by their size, and polish that "
     "walks "
     "come upon is blunter"},
    {"instant_radiosity", every_kind & ~unsigned(caustics),
     "caustics are blurred by the photons' radius"},
    {"multires_splatting", every_kind & ~unsigned(interreflection | caustics),
     "of light between surfaces there is one bounce, blurred between discontinuities"},
};

PunctualLight point_light(vec3 position, float intensity) {
  return PunctualLight{.position = position, .intensity = vec3(intensity)};
}

// A floor of albedo 0.5 seen at `p`.
Ray at_floor(vec3 p) { return ray_towards(p + vec3(0.3f, 0.5f, 0.8f), p); }
constexpr double albedo = 0.5;

// A seven-sided lamp that stands askew and dips below the floor's horizon.
std::vector<dvec3> odd_polygon() {
  std::vector<dvec3> corners;
  for (int i = 0; i < 7; i++) {
    double angle = 2 * double(pi) * i / 7, radius = 0.8 + 0.05 * i;
    corners.push_back({1.5 + 0.5 * std::cos(angle) * radius, 0.4 + std::sin(angle) * radius,
                       -0.4 * std::cos(angle) * radius});
  }
  return corners;
}

Scene make_plane_with_polygon(const std::vector<dvec3>& corners, float radiance) {
  Scene scene = empty_scene();
  add_floor(scene, float(albedo));
  Mesh mesh;
  Material m = emitter(vec3(radiance));
  m.double_sided = true;
  mesh.material = add_material(scene, m);
  for (dvec3 c : corners) {
    mesh.positions.push_back(vec3(c));
    mesh.normals.push_back({1, 0, 0});
  }
  for (uint32_t i = 1; i + 1 < corners.size(); i++) mesh.triangles.push_back({0, i, i + 1});
  add_mesh(scene, mesh, "polygon");
  return scene;
}

void add_lamps(std::vector<AnalyticCase>& cases) {
  int i = 0;
  for (vec3 p : {vec3(0, 0, 0), vec3(0.8f, 0, 0.3f), vec3(-2, 0, 1.5f), vec3(6, 0, 0)})
    cases.push_back({"rectangle over a plane, place " + std::to_string(i++),
                     make_plane_with_rect_light(10), at_floor(p),
                     rect_light_irradiance(p, 10) * albedo * over_pi, area_light});
  i = 0;
  for (vec3 p : {vec3(0, 0, 0), vec3(0.9f, 0, 0.9f), vec3(3, 0, -1)}) {
    double e = polygon_irradiance(p, {0, 1, 0}, odd_polygon());
    cases.push_back({"polygon that dips below the horizon, place " + std::to_string(i++),
                     make_plane_with_polygon(odd_polygon(), 3),
                     at_floor(p),
                     3 * e * albedo * over_pi,
                     area_light,
                     {},
                     512});
  }
  for (int rings : {4, 24})
    for (vec3 p : {vec3(0, 0, 0), vec3(2, 0, 1)}) {
      Scene scene = empty_scene();
      add_floor(scene, float(albedo));
      Mesh sphere = sphere_mesh(add_material(scene, emitter(vec3(4))), 0.5f, rings);
      double e = convex_irradiance(p, {0, 1, 0}, sphere, at({0, 1, 0}));
      add_mesh(scene, sphere, "sphere", at({0, 1, 0}));
      cases.push_back({"sphere of " + std::to_string(rings) + " rings",
                       scene,
                       at_floor(p),
                       4 * e * albedo * over_pi,
                       area_light,
                       {},
                       rings > 4 ? 2048 : 512});
    }
  // The eye hovers between the plates and sees the lower one exactly filling its picture; a picture
  // parallel to a plane weighs its places equally, so the mean is the form factor's.
  for (float apart : {0.5f, 1.0f, 3.0f}) {
    Scene scene = empty_scene();
    int white = add_material(scene, diffuse(vec3(float(albedo)))),
        lamp = add_material(scene, emitter(vec3(2)));
    add_quad(scene, white, {-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}, "receiver");
    add_quad(scene, lamp, {-0.5f, apart, -0.5f}, {1, 0, 0}, {0, 0, 1}, "plate");
    double factor = opposed_plates_factor(1 / double(apart), 1 / double(apart));
    cases.push_back({"parallel plates " + std::to_string(apart) + " apart",
                     scene,
                     ray_towards({0, 0.25f, 0}, {0, 0, 0}),
                     2 * albedo * factor,
                     area_light,
                     {},
                     8,
                     2});
  }
}

void add_points(std::vector<AnalyticCase>& cases) {
  for (float height : {0.5f, 1.0f, 4.0f}) {
    double d2 = 1 + double(height) * height, cosine = height / std::sqrt(d2);
    cases.push_back({"point light " + std::to_string(height) + " m up",
                     make_plane_with_punctual(point_light({1, height, 0}, 3)), at_floor({0, 0, 0}),
                     albedo * over_pi * 3 * cosine / d2, punctual_light});
  }
  PunctualLight light = point_light({0, 1, 0}, 3);
  light.range = 2;
  cases.push_back({"point light with a range", make_plane_with_punctual(light), at_floor({0, 0, 0}),
                   albedo * over_pi * 3 * (1 - 1.0 / 16), punctual_light});
  light.range = 0.9f;
  cases.push_back({"point light out of range", make_plane_with_punctual(light), at_floor({0, 0, 0}),
                   0, punctual_light});
  PunctualLight sun{.type = PunctualType::directional,
                    .direction = normalize(vec3(1, -2, 0.5f)),
                    .intensity = vec3(5)};
  cases.push_back({"directional light", make_plane_with_punctual(sun), at_floor({0, 0, 0}),
                   albedo * over_pi * 5 * double(-sun.direction.y), punctual_light});
  PunctualLight spot = point_light({0, 2, 0}, 8);
  spot.type = PunctualType::spot;
  spot.direction = {0, -1, 0};
  spot.inner_cone = 0.3f;
  spot.outer_cone = 0.6f;
  for (double angle : {0.0, 0.29, 0.45, 0.55, 0.61}) {
    double x = 2 * std::tan(angle), d2 = 4 + x * x, c = std::cos(angle);
    double inner = std::cos(double(spot.inner_cone)), outer = std::cos(double(spot.outer_cone));
    double t = glm::clamp((c - outer) / (inner - outer), 0.0, 1.0);
    cases.push_back({"spot, " + std::to_string(angle) + " off its axis",
                     make_plane_with_punctual(spot), at_floor({float(x), 0, 0}),
                     albedo * over_pi * 8 * t * t * c / d2, punctual_light});
  }
  // Twenty points: more than are weighed one by one.
  Scene many = make_plane_with_punctual(point_light({0, 1, 0}, 1));
  double sum = 1;
  for (int i = 1; i < 20; i++) {
    vec3 place(0.4f * float(i), 1 + 0.1f * float(i), 0.2f);
    many.lights.push_back(point_light(place, float(i)));
    double d2 = double(dot(place, place));
    sum += i * double(place.y) / (d2 * std::sqrt(d2));
  }
  cases.push_back({"twenty point lights",
                   many,
                   at_floor({0, 0, 0}),
                   albedo * over_pi * sum,
                   punctual_light,
                   {},
                   512});
}

void add_skies(std::vector<AnalyticCase>& cases) {
  Scene scene = empty_scene();
  add_floor(scene, float(albedo));
  scene.environment.radiance = {1, 2, 4};
  double sky = double(luminance({1, 2, 4}));
  cases.push_back(
      {"uniform sky over a plane", scene, at_floor({0, 0, 0}), albedo * sky, sky_light});
  cases.push_back({"uniform sky", scene, ray_towards({0, 1, 0}, {1, 2, 0}), sky, seen_lights});
  // Bright in one quarter; the expected value by quadrature of the same picture.
  Image image{.width = 32, .height = 16};
  for (int i = 0; i < 32 * 16; i++)
    image.texels.push_back(vec4(i % 32 < 8 ? vec3(20) : vec3(0.1f), 1));
  scene.images.push_back(image);
  scene.environment = {vec3(1.5f), 0};
  EnvironmentLight picture = make_environment_light(scene);
  double mean = 0;
  constexpr int n = 1000;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {  // uniform in projected solid angle
      float r = std::sqrt((float(i) + 0.5f) / n), phi = 2 * pi * (float(j) + 0.5f) / n;
      vec3 direction(r * std::cos(phi), std::sqrt(1 - r * r), r * std::sin(phi));
      mean += double(eval_environment(picture, direction).x) / (n * n);
    }
  cases.push_back({"picture of a sky over a plane",
                   scene,
                   at_floor({0, 0, 0}),
                   albedo * mean,
                   sky_light,
                   {},
                   512});
}

// A sun of half a degree, and a wide one, alone and in a plain sky: a disc that is wholly above the
// horizon lights by pi sin^2(radius) cos(tilt).
void add_suns(std::vector<AnalyticCase>& cases) {
  for (float radius : {0.0046f, 0.3f})
    for (float sky : {0.0f, 0.7f}) {
      Scene scene = empty_scene();
      add_floor(scene, float(albedo));
      SunDisc sun{.direction = normalize(vec3(1, 1.2f, 0.4f))};
      double size = double(pi) * std::pow(std::sin(double(radius)), 2);
      sun.radiance = vec3(float(2 / size));
      sun.angular_radius = radius;
      scene.environment.radiance = vec3(sky);
      scene.environment.sun = sun;
      double e = double(sun.radiance.x) * size * double(sun.direction.y) + double(sky) * double(pi);
      cases.push_back({sky > 0 ? "sun in a plain sky" : "sun alone", scene, at_floor({0, 0, 0}),
                       e * albedo * over_pi, sky_light});
      cases.push_back({"the sun's disc", scene,
                       ray_towards({0, 1, 0}, vec3(0, 1, 0) + sun.direction),
                       double(sun.radiance.x) + double(sky), seen_lights});
    }
}

}  // namespace

const Claim* find_claim(const std::string& technique) {
  for (const Claim& claim : claimed)
    if (technique == claim.technique) return &claim;
  return nullptr;
}

void mark_variants(std::vector<AnalyticCase>& cases) {
  auto kind = [](const std::string& name) {
    return name.substr(0, name.find_first_of(",0123456789"));
  };
  for (size_t i = 1; i < cases.size(); i++)
    cases[i].variant = kind(cases[i].name) == kind(cases[i - 1].name);
}

std::vector<AnalyticCase> direct_light_cases() {
  std::vector<AnalyticCase> cases;
  add_lamps(cases);
  add_points(cases);
  add_skies(cases);
  add_suns(cases);
  mark_variants(cases);
  return cases;
}

}  // namespace wellspring::test
