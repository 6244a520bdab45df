// SPDX-License-Identifier: Apache-2.0
// A visitor of the castle as the show draws its pictures, in the light of the package's maps, with
// one of several orders in which what shines gets samples.
#pragma once
#include <memory>

#include "corrections.h"
#include "picture/compositor.h"
#include "show/exhibit/exhibit.h"

namespace wellspring::test {

// Says how a visitor's samples are spent. `share` of them is asked for by the order, at most; the
// render cache plans the others, with `weight` as the factor of shining objects.
struct CorrectedWay {
  enum class Order : uint8_t { none, uniform, corrective };
  const char* name = "";
  Order order = Order::none;
  float share = 0;
  bool groups = false;   // correct groups of neighbours of one material; else single objects
  bool at_rest = false;  // not in motion alone
  float weight = 1;
};

// All visits share this.
struct CorrectedStage {
  Exhibit exhibit;
  World world;
  Lights lights;
  std::vector<float> shining;    // find_shining()
  std::vector<uint32_t> groups;  // group_shining()
  std::unique_ptr<VisibilityPass> visibility;
  // Seconds. Throws LoadError where the package has no light of its own.
  explicit CorrectedStage(Exhibit of);
};

// Pixels that show what shines, 1 each.
std::vector<uint8_t> find_shining_pixels(const CorrectedStage& stage, const View& view);

class CorrectedVisit {
 public:
  // Borrows both.
  CorrectedVisit(const CorrectedStage& stage, const CorrectedWay& way);
  // Picture `frame`, counted from 0, of 60 a second, of `budget` samples.
  void show(const View& view, int budget, int frame, Frame& shown);

 private:
  void draw(const View& view, Frame& shown);

  const CorrectedStage& stage_;
  const CorrectedWay& way_;
  RenderCache cache_;
  Compositor compositor_;  // at rest
  Corrections corrections_;
  Cells cells_;
  Frame light_;
  View last_;
  int moved_ = 0;
  std::vector<Request> requests_, corrective_;
  std::vector<Sample> samples_;
};

}  // namespace wellspring::test
