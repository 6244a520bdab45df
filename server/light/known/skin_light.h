// SPDX-License-Identifier: Apache-2.0
// Light on what moves, kept at the vertices of its meshes: diffusely reflected radiance over
// albedo. It follows the skin of a figure by construction, does not depend on the view, is shared
// by everybody who looks, and is smooth by interpolation.
//
// Vertices that share a position and about a normal at rest are one place, so that seams of texture
// coordinates do not show; meshes of two-sided materials have places for either side. A sample
// gathers the light that arrives around a place as on a white Lambertian surface (next-event
// estimation and one scattered ray, light/walk/walk.h). Samples are averaged over time, the older
// ones dropped when the newer say otherwise: the means of two windows are compared, pooled over a
// place and its neighbours, against the standard error of their difference (as temporal gradients
// drop history in Schied, Peters, Dachsbacher 2018, "Gradient Estimation for Real-Time Adaptive
// Temporal Filtering"). Between neighbours light is smoothed as a Gaussian Markov random field (Rue
// and Held 2005, section 2): the least squares of what samples say, each weighed by its count, and
// of differences along edges, weighed by how alike light is there. Multigrid by aggregation solves
// that (Briggs, Henson, McCormick 2000, "A Multigrid Tutorial", chapter 8), a V-cycle a call, going
// on from the last. So one sample a place already gives light of little noise.
//
// Each place also keeps how its light changes with the direction that it faces
// (light/material/light_slope.h), smoothed likewise. By that neighbours are expected to differ as
// their normals do, so that smoothing takes no form from a face, and maps of normals are lit.
//
// A place whose hemisphere is blocked within millimetres (skin under cloth, a strand's root, teeth
// behind lips) is hidden: what is found then is not kept. It has the light that it had when it was
// open, or takes that of its neighbours.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "light/sample/lights.h"
#include "light/transport_plan.h"
#include "world/view.h"

namespace wellspring::light {

// Where light is kept: a vertex of a moving mesh, and which side of it.
struct SkinPlace {
  uint32_t instance = 0, vertex = 0;
  bool back = false;
  float area = 0;  // of the triangles around at rest, a third of each, square metres
};

// A triangle around a place, of the World.
struct SkinCorner {
  uint32_t instance = 0, triangle = 0;
  uint32_t corner = 0;  // which of its three is the place
};

struct SkinEdge {
  uint32_t place = 0;
  float alike = 0;  // samples that say as much about light here as knowing it there
};

// Neighbouring places together, and then those: what is known of many is solved for first.
struct SkinLevel {
  std::vector<uint32_t> parent;  // of each of the finer level's, its place here
  std::vector<uint32_t> first_edge;
  std::vector<SkinEdge> edges;
  size_t size() const { return first_edge.size() - 1; }
};

// Samples of a place.
struct SkinMean {
  vec3 mean{0}, slope{0};        // the second: of luminance times slope_of()
  float count = 0, squares = 0;  // of luminance: sum of squared differences from the mean
};
struct SkinHistory {
  SkinMean newer, older;
  float blocked = 0;         // share of the last samples, and of what looked closer
  uint32_t asked = 0;        // samples so far, whatever became of them
  uint32_t passed_over = 0;  // times that it was seen and well known
};

struct SkinLight {
  // What does not change, of the places and of the World's moving instances.
  uint32_t first_instance = 0;
  std::vector<uint32_t> first_vertex;  // of each moving instance in the next lists, and the end
  std::vector<uint32_t> front, back;   // of each vertex, its places
  std::vector<SkinPlace> places;
  std::vector<uint32_t> first_corner, first_edge;  // of each place, and the end
  std::vector<SkinCorner> corners;
  std::vector<SkinEdge> edges;
  std::vector<SkinLevel> levels;  // from fine to coarse
  std::vector<uint32_t> piece;    // of each place: of what hangs together by edges
  size_t pieces = 0;
  // What samples say.
  std::vector<SkinHistory> history;
  std::vector<vec4> light;        // of each place; w: 0 where nothing is known
  std::vector<vec4> slope;        // of the luminance of that, world; times it, unlike eval_slope()
  vec3 mean{0};                   // of all that is known of what is visible
  float noise = 0.5f;             // relative variance of a sample, measured
  float samples = 0;              // of a place that is visible and known, on average
  float reach = 0;                // metres: what is hit nearer than that blocks
  float usual_area = 0;           // of places
  uint32_t cursor = 0, turn = 0;  // whose turn it is
};
// About 300 bytes a place.
size_t memory_bytes(const SkinLight& skin);

// Of what moves in `world`, as its meshes are now (at rest). Tens of milliseconds.
SkinLight make_skin_light(const World& world);

struct SkinUpdate {
  int samples = 0;
  uint64_t seed = 1;
  // These eyes look. Most samples go to places that are seen, as often as pixels show them, and
  // more of them where few are known; some to all in turn, those now and then that no eye can face,
  // small ones less often than large ones. Empty: nothing is known of eyes.
  std::span<const View> views;
  TransportSettings transport;
};
// Traces samples at places of what moves and is visible, as the world is now, of all in turn those
// never sampled first. All cores; the same bits whatever the number of threads. Returns how
// many were traced. Call after World::commit(), while nothing moves.
int update_skin(const World& world, const Lights& lights, const SkinUpdate& update,
                SkinLight& skin);
// Brings `light` up to date, by that many V-cycles. Call once a picture: about 2 ms for thirty
// thousand places and one core.
void smooth_skin(const World& world, SkinLight& skin, int cycles = 1);

// Which places a view shows, by rays through a few places of the window that what moves lies in.
struct SkinSight {
  float pixels = 0;              // of the view that show what moves, about
  std::vector<uint32_t> places;  // one of each ray that met any, in the order of the rays
};
// Other rays for each `turn`. Clear panes are seen through. All cores; the same bits whatever the
// number of threads. Call after World::commit(), while nothing moves.
SkinSight see_skin(const World& world, const SkinLight& skin, const View& view, int rays,
                   uint64_t turn);

// The light changes at once: a lamp was switched. What is known counts as next to nothing from now
// on, and until samples say more `change` is shown: what is left of light, and what is added, 1 and
// 0 unless it says so (LightChange).
using SkinChange = std::function<bool(vec3 place, vec3 normal, vec3& kept, vec3& added)>;
void relight_skin(const World& world, const SkinChange& change, SkinLight& skin);

// Light at the corners of a triangle of a moving instance, seen from its back or not.
struct SkinTriangle {
  vec3 corner, edge1, edge2;
  vec3 slope, slope1, slope2;  // the same of the slope, relative to the light's luminance
};
// Of the World's moving instances, which are visible.
std::vector<uint8_t> find_visible(const World& world, const SkinLight& skin);

SkinTriangle find_skin(const SkinLight& skin, uint32_t instance, uvec3 vertices, bool back);

}  // namespace wellspring::light
