// SPDX-License-Identifier: Apache-2.0
#include "museum/museum.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

using test::RoomPackage;

constexpr double patience = 30;  // seconds; only what fails waits so long

// A museum of one small room.
struct Small {
  RoomPackage package;
  std::unique_ptr<Museum> museum;
  MuseumSettings settings;
  Small() {
    write();
    settings.content = package.folder.path.string();
    settings.exhibit = "room";
    settings.show.technique = settings.show.still_technique = "direct";
    settings.show.bakes = false;
    museum = std::make_unique<Museum>(settings);
  }
  void write() const { package.write("exhibit.json", package.manifest.dump(1)); }
  std::string title() const { return museum->sources().exhibits[0].exhibit->title.at("en"); }
};

// Runs until `done` says so. False: it never did.
template <class Done>
bool run_until(Museum& museum, const Done& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  bool was_done = false;
  museum.run([&] { return (was_done = done()) || std::chrono::steady_clock::now() > end; });
  return was_done;
}

TEST(Museum, HasGoneOnWhileAllShowsTick) {
  Small small;
  EXPECT_FALSE(small.museum->has_gone_on()) << "nothing ticks";
  int times = 0;
  EXPECT_TRUE(run_until(*small.museum, [&] { return (times += small.museum->has_gone_on()) > 3; }));
}

// A link whose reader holds the show's thread.
TEST(Museum, HasNotGoneOnWhileAShowHangs) {
  Small small;
  std::atomic<bool> hangs = false, is_free = false;
  auto link = std::make_shared<Link>(1, LinkKind::visit, "test");
  link->set_wake([&] {
    hangs = true;
    while (!is_free) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  link->push_text_in(R"({"type":"hello","exhibit":"","width":64,"height":36,"lang":"en"})");
  small.museum->join(link);
  int looks = 0, beats = 0;
  EXPECT_TRUE(run_until(*small.museum, [&] {
    if (!hangs) return false;
    // The first may tell of a tick before.
    if (looks++ == 0) small.museum->has_gone_on();
    else if (looks < 10) EXPECT_FALSE(small.museum->has_gone_on());
    else is_free = true;
    return is_free && (beats += small.museum->has_gone_on()) > 0;
  }));
  EXPECT_TRUE(hangs);
  is_free = true;
}

TEST(Museum, ReloadTakesOverWhatHasChangedAndNothingElse) {
  Small small;
  EXPECT_EQ(small.title(), "Room");
  small.package.manifest["title"]["en"] = "Another room";
  small.write();
  std::filesystem::last_write_time(
      small.package.folder.path / "room" / "exhibit.json",
      std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  int looks = 0;
  EXPECT_FALSE(small.museum->run([&] { return ++looks > 5; })) << "nobody has asked";
  bool asked = false;
  EXPECT_TRUE(small.museum->run([&] {
    if (!std::exchange(asked, true)) small.museum->reload();
    return false;
  }));
  small.museum->take_over();
  EXPECT_EQ(small.title(), "Another room");
  small.museum->reload();
  looks = 0;
  EXPECT_FALSE(small.museum->run([&] { return ++looks > 10; })) << "it is as it was";
}

TEST(Museum, ReloadKeepsWhatCannotBeReplaced) {
  Small small;
  small.package.write("exhibit.json", "{");
  small.museum->reload();
  int looks = 0;
  EXPECT_FALSE(small.museum->run([&] { return ++looks > 10; }));
  EXPECT_EQ(small.title(), "Room");
}

}  // namespace
}  // namespace wellspring::test
