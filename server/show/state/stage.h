// SPDX-License-Identifier: Apache-2.0
// Holds the exhibit of a running show, its world and the light that is known in it.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "light/kept/skin/skin_light.h"
#include "light/sample/lights.h"
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "show/lawns/lit_lawns.h"
#include "show/questions/question_index.h"
#include "show/state/baker.h"
#include "show/state/switches.h"
#include "show/visit/tour.h"
#include "show/volumes/lit_volumes.h"
#include "world/world.h"

namespace wellspring::light {
struct Technique;      // light/technique/technique.h
class VisibilityPass;  // light/visible/visibility.h
}  // namespace wellspring::light

namespace wellspring::show {

struct ExhibitStage {
  ExhibitStage();
  ~ExhibitStage();

  Exhibit exhibit;  // the scene inside has the figure's materials and object added
  std::unique_ptr<World> world;
  Lights lights;
  Switches switches;
  // While there are lights.maps, for each object:
  std::vector<char> mapped;      // the maps hold the light of some of it
  std::vector<char> shining;     // some of its light depends on the view
  std::vector<char> known;       // mapped and not shining: it needs no samples
  std::string light_problem;     // problem with the package's own light; empty: none
  std::unique_ptr<Baker> baker;  // null: maps stay as they were at the start
  BakerLooks baker_looks;
  std::unique_ptr<VisibilityPass> visibility;  // draws one picture at a time
  LitVolumes volumes;
  LitLawns lawns;                              // who walks there bends them for all visitors
  SkinLight skin;                              // light on moving things, for all visitors
  const Technique* technique = nullptr;        // used while anything moves
  const Technique* still_technique = nullptr;  // used while the visitor stands still
  TourRoads roads;
  QuestionIndex questions;
  // If the exhibit is watched: problems with its files as they are now (show/watch/rehearsal.h).
  std::vector<Problem> problems;
  std::string problems_message;  // last message about them that visitors were sent
};

}  // namespace wellspring::show
