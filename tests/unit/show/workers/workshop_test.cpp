// SPDX-License-Identifier: Apache-2.0
// A worker finds the same bits as the server, whatever the lamps and whoever stands where; and
// refuses by name what it would find otherwise.
#include "show/workers/workshop.h"

#include <gtest/gtest.h>

#include <cstring>

#include "light/technique/technique.h"
#include "show/state/make_show.h"
#include "show/workers/world_state.h"
#include "unit/folder.h"
#include "unit/show/show_stage.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

Exhibit make_lit_exhibit() {
  Exhibit exhibit = make_tiny_exhibit();
  add_storyteller(exhibit, "anna", {-0.5, 0, 1}).greetings["en"].emplace_back().text = "Welcome.";
  add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
  exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}}};
  return exhibit;
}

// A server's show after a second, and a worker that has only loaded the same exhibit.
struct ServerAndWorker {
  ShowStage stage;
  Folder folder;
  ShowSettings settings;
  Workshop workshop;
  TraceOrder order;

  explicit ServerAndWorker(const std::string& technique = "direct")
      : settings(settings_for(technique, 10)),
        workshop("1.2.3", "north", folder.path.string(), 0,
                 [this](auto&, auto&) { return make_show(make_lit_exhibit(), settings); }) {
    stage.begin(make_lit_exhibit(), settings);
    stage.join(64, 48);
    stage.run(1);
    workshop.add("", "");
    const Show& show = *stage.show;
    order = {1,
             2,
             500,
             show.stage.exhibit.id,
             {"1.2.3", instruction_set(), number_scene(show.stage),
              number_light(known_maps(show.stage).get())},
             false,
             technique,
             false,
             show.settings.transport,
             {},
             {}};
    plan();
    tell_state();
  }
  void plan() {
    View view = stage.visitor().place.last_view;
    view.width = 24, view.height = 16;
    std::vector<PixelSample> which;
    for (int i = 0; i < view.width * view.height; i++)
      which.push_back({i % view.width, i / view.width, 3});
    order.requests.resize(which.size());
    make_pixel_requests(view, 7, which, order.requests);
  }
  void tell_state() {
    order.state =
        write_world_state(stage.show->stage, stage.show->cast, stage.visitor().pieces.shown);
  }
  std::vector<Sample> trace_here() const {
    std::vector<Sample> samples(order.requests.size());
    trace(*find_technique(order.technique), *stage.show->stage.world, stage.show->stage.lights,
          order.transport, order.requests, samples);
    return samples;
  }
};

// Returns how many of the samples are other bits.
int count_different(const std::vector<Sample>& a, const std::vector<Sample>& b) {
  EXPECT_EQ(a.size(), b.size());
  int different = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); i++) {
    const bool same = a[i].position == b[i].position && a[i].smooth == b[i].smooth &&
                      a[i].rest == b[i].rest && a[i].albedo == b[i].albedo &&
                      a[i].instance == b[i].instance && a[i].triangle == b[i].triangle &&
                      a[i].flags == b[i].flags && a[i].known == b[i].known;
    different += !same;
  }
  return different;
}

TEST(Workshop, FindsTheSameBitsByEveryTechniqueWithoutPasses) {
  for (const char* technique : {"direct", "path", "gather"}) {
    SCOPED_TRACE(technique);
    ServerAndWorker both(technique);
    const TraceAnswer answer = both.workshop.answer(both.order, 0);
    ASSERT_EQ(answer.refusal, Refusal::none);
    EXPECT_EQ(answer.number, 2u);
    EXPECT_EQ(count_different(answer.samples, both.trace_here()), 0);
  }
}

TEST(Workshop, FollowsTheStorytellerAndTheLamps) {
  ServerAndWorker both;
  both.workshop.answer(both.order, 0);
  const std::vector<Sample> before = both.trace_here();
  both.stage.order(R"({"type":"lamp","name":"ceiling","on":false})");
  both.stage.run(2);
  both.tell_state();
  const std::vector<Sample> now = both.trace_here();
  EXPECT_GT(count_different(now, before), 0) << "the lamp is off";
  const TraceAnswer answer = both.workshop.answer(both.order, 0);
  ASSERT_EQ(answer.refusal, Refusal::none);
  EXPECT_EQ(count_different(answer.samples, now), 0);
}

TEST(Workshop, RefusesByName) {
  ServerAndWorker both;
  const auto refusal = [&](auto change, double waited = 0) {
    TraceOrder order = both.order;
    change(order);
    const TraceAnswer answer = both.workshop.answer(order, waited);
    EXPECT_EQ(answer.samples.empty(), answer.refusal != Refusal::none);
    return answer.refusal;
  };
  const auto nothing = [](TraceOrder&) {};
  EXPECT_EQ(refusal(nothing), Refusal::none);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.same.version = "1.2.4"; }), Refusal::version);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.same.instructions = "none"; }), Refusal::none);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.same.instructions = "none", o.exact = true; }),
            Refusal::instructions);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.exhibit = "elsewhere"; }), Refusal::exhibit);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.same.scene++; }), Refusal::scene);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.same.light++; }), Refusal::light);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.technique = "magic"; }), Refusal::technique);
  EXPECT_EQ(refusal([](TraceOrder& o) { o.technique = "instant_radiosity"; }), Refusal::technique);
  EXPECT_EQ(refusal(nothing, 0.6), Refusal::late);
  EXPECT_EQ(refusal(nothing, 0.4), Refusal::none);
}

TEST(Workshop, RefusesStatesThatAreNone) {
  ServerAndWorker both;
  const std::string state = both.order.state;
  for (size_t size = 0; size < state.size(); size++) {
    both.order.state = state.substr(0, size);
    ASSERT_EQ(both.workshop.answer(both.order, 0).refusal, Refusal::state) << size;
  }
  both.order.state = state + "x";
  EXPECT_EQ(both.workshop.answer(both.order, 0).refusal, Refusal::state);
  both.order.state = state;
  EXPECT_EQ(both.workshop.answer(both.order, 0).refusal, Refusal::none);
}

TEST(WorldState, NumbersTellScenesApart) {
  const ServerAndWorker both;
  ShowStage other;
  Exhibit exhibit = make_lit_exhibit();
  exhibit.scene.materials[0].base_color.x *= 0.5f;
  other.begin(std::move(exhibit), settings_for("direct", 10));
  EXPECT_NE(number_scene(both.stage.show->stage), number_scene(other.show->stage));
}

}  // namespace
}  // namespace wellspring::test
