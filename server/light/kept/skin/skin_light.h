// SPDX-License-Identifier: Apache-2.0
// Keeps light on what moves at the vertices of its meshes: diffusely reflected radiance over
// albedo. It follows the skin of a figure by construction, does not depend on the view, is shared
// by all visitors, and is smooth by interpolation.
//
// Vertices that share a position and about a normal at rest are one place, so that seams of texture
// coordinates do not show; meshes of two-sided materials have places for either side. A sample
// gathers the light that arrives around a place as on a white Lambertian surface (next-event
// estimation and one scattered ray, light/walk/walk.h). Samples are averaged over time, the older
// ones dropped when the newer contradict them: the means of two windows are compared, pooled over a
// place and its neighbours, against the standard error of their difference (as temporal gradients
// drop history in Schied, Peters, Dachsbacher 2018, "Gradient Estimation for Real-Time Adaptive
// Temporal Filtering"). Between neighbours light is smoothed as a Gaussian Markov random field (Rue
// and Held 2005, section 2): the least squares of the samples' light, each weighed by its count,
// and of differences along edges, weighed by how alike light is there. Multigrid by aggregation
// solves that (Briggs, Henson, McCormick 2000, "A Multigrid Tutorial", chapter 8), a V-cycle a
// call, going on from the last. So one sample a place already gives light of little noise.
//
// Each place also keeps how its light changes with the direction that it faces
// (light/material/light_slope.h), smoothed likewise. By that neighbours are expected to differ as
// their normals do, so that smoothing takes no form from a face, and maps of normals are lit.
//
// A place whose hemisphere is blocked within millimetres (skin under cloth, a strand's root, teeth
// behind lips) is hidden: light that is found then is not kept. It keeps the light that it had when
// it was open, or takes that of its neighbours.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "light/sample/lights.h"
#include "light/transport_settings.h"
#include "world/view.h"

namespace wellspring::light {

// A place keeps light: it is a vertex of a moving mesh, and one side of it.
struct SkinPlace {
  uint32_t instance = 0, vertex = 0;
  bool back = false;
  float area = 0;  // a third of each of the triangles around at rest, square metres
};

// A corner is a triangle of the World around a place.
struct SkinCorner {
  uint32_t instance = 0, triangle = 0;
  uint32_t corner = 0;  // the corner of the triangle that is the place
};

struct SkinEdge {
  uint32_t place = 0;
  float alike = 0;  // weight: samples that count as much here as the neighbour's light
};

// Joins neighbouring places, level by level: light is solved for in large groups first.
struct SkinLevel {
  std::vector<uint32_t> parent;  // place here of each place of the finer level
  std::vector<uint32_t> first_edge;
  std::vector<SkinEdge> edges;
  size_t size() const { return first_edge.size() - 1; }
};

// Holds the mean of a place's samples.
struct SkinMean {
  vec3 mean{0}, slope{0};        // slope: mean of luminance times slope_of()
  float count = 0, squares = 0;  // squares: sum of squared differences of luminance from the mean
};
struct SkinHistory {
  SkinMean newer, older;
  float blocked = 0;         // share of the last samples whose ray was blocked
  uint32_t asked = 0;        // samples so far, whatever was found
  uint32_t passed_over = 0;  // times that a view's ray met it while it was well known
};

struct SkinLight {
  // The following does not change, for the places and for the World's moving instances.
  uint32_t first_instance = 0;
  // First of each moving instance in the next lists, and the end
  std::vector<uint32_t> first_vertex;
  std::vector<uint32_t> front, back;  // places of each vertex
  std::vector<SkinPlace> places;
  std::vector<uint32_t> first_corner, first_edge;  // first of each place, and the end
  std::vector<SkinCorner> corners;
  std::vector<SkinEdge> edges;
  std::vector<SkinLevel> levels;  // from fine to coarse
  std::vector<uint32_t> piece;    // each place's set of places that edges connect
  size_t pieces = 0;
  // The following holds the samples and the light made from them.
  std::vector<SkinHistory> history;
  std::vector<vec4> light;  // light of each place; w: 0 if there is none
  // One for each place, in world space; times the light's luminance, unlike in eval_slope()
  std::vector<vec4> slope;
  vec3 mean{0};                   // mean light of all visible places with light
  float noise = 0.5f;             // relative variance of a sample, measured
  float samples = 0;              // mean number of samples of a visible place with light
  float reach = 0;                // metres: a nearer hit blocks a place
  float usual_area = 0;           // mean area of a place
  uint32_t cursor = 0, turn = 0;  // next place in turn, and the round
};
// Returns the memory, about 300 bytes a place.
size_t memory_bytes(const SkinLight& skin);

// Makes the places of what moves in `world`, as its meshes are now (at rest). Takes tens of
// milliseconds.
SkinLight make_skin_light(const World& world);

struct SkinUpdate {
  int samples = 0;
  uint64_t seed = 1;
  // Views of visitors' eyes. Most samples go to places that these see, as often as pixels show
  // them, and more to those with few samples; some go to all places in turn, now and then to those
  // that no eye can face, to small ones less often than to large ones. Empty: no eyes are known.
  std::span<const View> views;
  TransportSettings transport;
};
// Traces samples at places of what moves and is visible, as the world is now; among places in turn
// those never sampled come first. Runs on all cores; the bits are the same whatever the number of
// threads. Returns how many were traced. Call it after World::commit(), while nothing moves.
int update_skin(const World& world, const Lights& lights, const SkinUpdate& update,
                SkinLight& skin);
// Brings `light` up to date, by that many V-cycles. Call it once a picture: it takes about 2 ms for
// thirty thousand places and one core.
void smooth_skin(const World& world, SkinLight& skin, int cycles = 1);

// Holds the places that a view shows, found by rays through some pixels of the window around what
// moves.
struct SkinSight {
  float pixels = 0;              // pixels of the view that show what moves, about
  std::vector<uint32_t> places;  // one for each ray that met any, in the order of the rays
};
// Finds them, by other rays for each `turn`. Clear panes are seen through. Runs on all cores; the
// bits are the same whatever the number of threads. Call it after World::commit(), while nothing
// moves.
SkinSight see_skin(const World& world, const SkinLight& skin, const View& view, int rays,
                   uint64_t turn);

// Changes the light at once after a lamp was switched. Earlier samples count as next to nothing
// from now on, and until new samples arrive `change` is shown: `kept` of the light is left and
// `added` is new, 1 and 0 unless it sets them (LightChange).
using SkinChange = std::function<bool(vec3 place, vec3 normal, vec3& kept, vec3& added)>;
void relight_skin(const World& world, const SkinChange& change, SkinLight& skin);

// Holds light at the corners of a triangle of a moving instance, seen from its back or not.
struct SkinTriangle {
  vec3 corner, edge1, edge2;
  vec3 slope, slope1, slope2;  // slope likewise, relative to the light's luminance
};
// Returns for each of the World's moving instances whether it is visible.
std::vector<uint8_t> find_visible(const World& world, const SkinLight& skin);

SkinTriangle find_skin(const SkinLight& skin, uint32_t instance, uvec3 vertices, bool back);

}  // namespace wellspring::light
