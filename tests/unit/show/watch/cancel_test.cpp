// SPDX-License-Identifier: Apache-2.0
// Every long step of making a show ends soon when it is cancelled.
#include "base/worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "light/kept/bake.h"
#include "light/kept/finish_bake.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/state/baker.h"
#include "show/state/make_show.h"
#include "show/watch/rehearsal.h"
#include "unit/show/exhibit/room_package.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct CancelledShow : testing::Test {
  std::stop_source source;
  Exhibit exhibit = make_tiny_exhibit();
  World world = World(exhibit.scene);
  Lights lights = make_lights(world);
  std::vector<vec3> eyes = {vec3(-2, 1.6f, 3)};

  // Checks that `step` ends by itself, and then that it ends when it is cancelled.
  template <class Step>
  void expect_ends(const Step& step) {
    const CancelScope scope(source.get_token());
    EXPECT_NO_THROW(step());
    source.request_stop();
    EXPECT_THROW(step(), Cancelled);
  }
};

TEST_F(CancelledShow, Package) {
  test::RoomPackage package;
  expect_ends([&] { package.read(); });
}

TEST_F(CancelledShow, Rays) {
  expect_ends([&] { World another(exhibit.scene); });
}

TEST_F(CancelledShow, CoarseLight) {
  expect_ends([&] { make_bake_scene(world, eyes, {.nodes = 300}); });
}

TEST_F(CancelledShow, Exposure) {
  expect_ends([&] { measure_exposure(exhibit, world); });
}

TEST_F(CancelledShow, Bake) {
  expect_ends([&] { begin_bake(world, eyes, {.gather_nodes = 300, .direct_nodes = 600}); });
}

TEST_F(CancelledShow, AllOfIt) {
  expect_ends([&] { make_show(make_tiny_exhibit(), settings_for("direct")); });
}

TEST_F(CancelledShow, IsGivenUpWhenItsRehearsalEnds) {
  test::Folder folder;
  folder.write("exhibit.json", "1");
  std::atomic<bool> begun = false, given_up = false;
  auto make = [&]() -> std::unique_ptr<Show> {
    begun = true;
    try {
      for (int i = 0; i < 6000; i++) {  // a minute
        check_cancelled();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    } catch (const Cancelled&) {
      given_up = true;
      throw;
    }
    return std::make_unique<Show>();
  };
  {
    Rehearsal rehearsal(folder.path.string(), make, false);
    folder.write("exhibit.json", "12");
    rehearsal.look(true);
    while (!begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(given_up);
}

}  // namespace
}  // namespace wellspring::test
