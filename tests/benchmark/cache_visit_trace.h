// SPDX-License-Identifier: Apache-2.0
// A recorded visit: where a visitor's camera is at every moment, and what happens meanwhile. Kept
// as small JSON files in tests/benchmark/traces, written by make_visit_traces() with the show's own
// walking and tour rules, so that every machine measures the same visit.
#pragma once
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "world/world.h"

namespace wellspring::test {

struct TraceSample {
  double time = 0;  // seconds from the visit's beginning; strictly growing from sample to sample
  dvec3 position{0};
  float yaw = 0, pitch = 0, fov = 1;  // as Viewpoint; yaw is not wrapped: turns count on
};

// Lamps: punctual lights that have a place. Sun and sky stay.
struct LampSwitch {
  double time = 0;
  bool on = true;
};

struct VisitTrace {
  std::string name, exhibit, about;
  bool telling = false;              // the storyteller tells its first story; else it idles
  std::vector<TraceSample> samples;  // never empty
  std::vector<LampSwitch> lamps;     // by time
};

// Throws LoadError. The name is the file's without its ending.
VisitTrace load_visit_trace(const std::string& file);
void save_visit_trace(const VisitTrace& trace, const std::string& folder);  // folder/name.json
// All *.json of a folder, by name. Throws LoadError when there is none.
std::vector<VisitTrace> load_visit_traces(const std::string& folder);

double trace_seconds(const VisitTrace& trace);
// Linear between samples; before the first and after the last the camera rests there.
Viewpoint eval_trace(const VisitTrace& trace, double time);
bool lamps_on(const VisitTrace& trace, double time);

// The castle's traces, written anew into `folder`: what a visitor's input messages, the tour and
// walls make of a few intentions.
void make_visit_traces(const Exhibit& castle, const World& world, const std::string& folder);

}  // namespace wellspring::test
