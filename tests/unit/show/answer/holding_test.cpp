// SPDX-License-Identifier: Apache-2.0
// A guest holds something to a kiosk's camera: what the page reads, hears and shows.
#include "show/answer/holding.h"

#include "show/moving/prop.h"
#include "show/state/in_view.h"
#include "unit/show/kiosk_house.h"

namespace wellspring::test {
namespace {

struct HoldingHouse : KioskHouse {
  void SetUp() override {
    KioskSettings hall;
    hall.name = "hall";
    hall.held = {"tile", "ghost", "tale"};
    Exhibit exhibit = make_tiny_exhibit();
    StorytellerPlace& anna = add_storyteller(exhibit, "anna", {-2, 0, 1});
    anna.greetings["en"].emplace_back().text = "Welcome.";
    ExhibitProp& tile = exhibit.props.emplace_back();
    tile.id = "tile";
    Material clay;
    clay.double_sided = true;
    tile.scene.materials = {clay};
    tile.scene.objects = {"", "tile"};
    Mesh plate;
    add_quad(plate, {1, 0, 0}, {0.6f, 0, 0}, {0, 0.6f, 0});
    tile.scene.meshes = {plate};
    tile.scene.instances = {{0, mat4(1), 1}};
    exhibit.kiosks = {hall};
    tick_seconds = 0.05;
    begin(std::move(exhibit), settings_for("direct"));
  }
  void hold(size_t camera, const std::string& id, const std::string& hint = "") {
    Holding& holding = cameras[camera].seen.holding.emplace();
    holding.id = id;
    if (id.empty()) holding.of_class = "coin";
    holding.title = {{"en", id.empty() ? "A coin" : "The " + id}};
    if (!hint.empty()) holding.hint["en"] = hint;
    holding.position = vec3(0, 0, 0.4f);
    holding.rotation = vec3(0);
  }
  long count(size_t page, const std::string& text) { return std::ranges::count(read(page), text); }
};

TEST_F(HoldingHouse, HintsAndNamesAreSpokenAfterTheGreeting) {
  const size_t page = this->page("hall"), camera = this->camera("hall");
  see(camera, {near_screen});
  hold(camera, "", "Turn it over, please.");
  go(12);
  EXPECT_EQ(count(page, "Welcome."), 1);
  EXPECT_EQ(count(page, "Turn it over, please."), 1);
  hold(camera, "tile");
  go(12);
  EXPECT_EQ(count(page, "The tile"), 1);
}

TEST_F(HoldingHouse, WhoHidesTheirFaceWithItIsStillThere) {
  const size_t page = this->page("hall"), camera = this->camera("hall");
  see(camera, {near_screen});
  go(3);
  hold(camera, "tile");
  cameras[camera].seen.state = Presence::motion;
  cameras[camera].seen.people.clear();
  go(6);
  EXPECT_EQ(stage(page), "person");
  cameras[camera].seen.holding.reset();
  go(4);
  EXPECT_NE(stage(page), "person");
}

TEST_F(HoldingHouse, ItsStoryIsTold) {
  page("hall");
  const size_t camera = this->camera("hall");
  see(camera, {near_screen});
  go(4);
  hold(camera, "tale");
  for (int i = 0; i < 60 && show->cast.teller.voice.story.empty(); i++) go(0.25);
  EXPECT_EQ(show->cast.teller.voice.story, "tale");
}

TEST_F(HoldingHouse, ThePageShowsItAndNobodyElseDoes) {
  page("hall");
  join(32, 32);
  const size_t camera = this->camera("hall");
  ASSERT_EQ(show->cast.held.size(), 1u) << "there is a model of the tile alone";
  const Prop& model = show->cast.held[0].second;
  auto shows = [&](bool wanted) {
    for (int i = 0; i < 400 && model.parts[0].shown != wanted; i++) go(0.05);
    return model.parts[0].shown == wanted;
  };
  EXPECT_FALSE(model.parts[0].shown);
  see(camera, {near_screen});
  go(2);
  EXPECT_FALSE(model.parts[0].shown);
  hold(camera, "tile");
  const Visitor& kiosk_page = show->visits.visitors.front();
  ASSERT_TRUE(kiosk_page.kiosk);
  go(1);
  EXPECT_EQ(kiosk_page.held.size, 1);
  EXPECT_EQ(show->visits.visitors.back().held.size, 0);
  ASSERT_TRUE(shows(true));
  // The plate, 0.6 m in its file, is 0.3 m here, and its middle is 0.4 m behind the screen.
  Bounds bounds;
  for (const vec3& p : model.positions)
    bounds.low = min(bounds.low, p), bounds.high = max(bounds.high, p);
  EXPECT_NEAR(bounds.high.y - bounds.low.y, 0.3f, 0.01f);
  const View view = view_of(*show, kiosk_page);
  const vec3 off = 0.5f * (bounds.low + bounds.high) - view.position;
  EXPECT_NEAR(dot(off, view.forward), viewing_distance + 0.4f, 0.01f);
  EXPECT_NEAR(dot(off, view.right), 0, 0.01f);
  cameras[camera].seen.holding.reset();
  go(1);
  EXPECT_EQ(kiosk_page.held.size, 0);
  EXPECT_TRUE(shows(false));
}

}  // namespace
}  // namespace wellspring::test
