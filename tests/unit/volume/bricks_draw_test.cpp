// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/load_error.h"
#include "bricks_made.h"
#include "volume/draw/level_samples.h"
#include "volume/draw/preview.h"

namespace wellspring::test {
namespace {

constexpr size_t plenty = 300;  // slots

const Preset shell{
    "shell", VolumeMode::density, {{500, vec3(1), 0.0}, {3000, vec3(1, 0.5f, 0.2f), 0.3}}};

template <class Samples>
LanesLit read(Samples samples, const Lanes3& place) {
  return samples.value_and_normal(place, LaneMask{} - 1);
}

// Draws until nothing more comes.
VolumePicture settled(const Bricked& bricked, const DrawnPreset& preset, const PreviewView& view) {
  do draw_volume(bricked.shown, preset, view);
  while (bricked.load_all() > 0);
  return draw_volume(bricked.shown, preset, view);
}

float difference(const VolumePicture& a, const VolumePicture& b) {
  float most = 0;
  for (size_t i = 0; i < a.color.size(); i++) {
    const vec3 off = abs(a.color[i] - b.color[i]);
    most = std::max({most, off.x, off.y, off.z, std::abs(a.clear[i] - b.clear[i])});
  }
  return most;
}

TEST(DrawBricks, AllPlacesAreInterpolatedAsInTheWholeVolume) {
  for (const glm::ivec3 size :
       {glm::ivec3(70, 65, 66), glm::ivec3(1, 1, 4000), glm::ivec3(1, 90, 2)}) {
    const Volume volume = volume_of(size, rough);
    const ShownVolume whole = make_shown_volume(volume);
    const Bricked bricked(volume, plenty);
    for (int level = 0; level < int(whole.levels.size()); level++) {
      const vec3 last(whole.levels[size_t(level)].size - 1);
      float most = 0, most_one = 0;
      for (int i = 0; i < 4000; i++) {
        Lanes3 place;
        for (int k = 0; k < lane_count; k++) {
          // Places everywhere, and a little beyond; every other one close to where bricks meet.
          const int n = lane_count * i + k;
          vec3 at =
              vec3(fract(vec3(0.7548777f, 0.5698403f, 0.6180340f) * float(n))) * (last + 1.0f) -
              0.5f;
          if (n % 2) at = round(at / 32.0f) * 32.0f + 0.01f * float(n % 300 - 150);
          place.set(k, at);
        }
        read(BrickSamples(bricked.shown, level), place);
        bricked.load_all();
        const LanesLit a = read(BrickSamples(bricked.shown, level), place);
        const LanesLit b = read(WholeSamples(whole, level), place);
        PlaceSamples one(bricked.shown, level), one_whole(whole, level);
        for (int k = 0; k < lane_count; k++) {
          most = std::max({most, std::abs(a.value[k] - b.value[k]) / most_code,
                           length(a.normal.at(k) - b.normal.at(k))});
          const vec3 at = place.at(k);
          most_one = std::max({most_one, std::abs(one.value(at) - b.value[k]) / most_code,
                               std::abs(one_whole.value(at) - b.value[k]) / most_code,
                               length(one.value_and_normal(at).normal.at(k) - b.normal.at(k))});
        }
      }
      EXPECT_LT(most, 1e-6f) << size.x << " x " << size.y << " x " << size.z << ", " << level;
      // One place is counted from the brick's skirt, so its last bit is another one.
      EXPECT_LT(most_one, 1e-5f) << size.x << " x " << size.y << " x " << size.z << ", " << level;
    }
  }
}

TEST(DrawBricks, PicturesAreThoseOfTheWholeVolume) {
  const Volume volume = shelled_ball(96);
  const ShownVolume whole = make_shown_volume(volume);
  const Bricked bricked(volume, plenty);
  std::vector<Preset> presets = find_presets(whole);
  const std::vector<Preset> found = find_presets(bricked.shown);
  ASSERT_EQ(found.size(), presets.size());
  for (size_t i = 0; i < presets.size(); i++)
    EXPECT_EQ(found[i].points[0].value, presets[i].points[0].value);
  presets.push_back(shell);
  for (const Preset& preset : presets) {
    const DrawnPreset a(bricked.shown, preset, preview_light()), b(whole, preset, preview_light());
    EXPECT_EQ(a.grid.lamp, b.grid.lamp);
    EXPECT_EQ(a.grid.around, b.grid.around);
    for (const int side : {200, 40}) {  // on the finest level, and on a coarser one
      const PreviewView view{.side = side};
      const VolumePicture picture = settled(bricked, a, view),
                          expected = draw_volume(whole, b, view);
      EXPECT_LT(difference(picture, expected), 1e-6f) << preset.name << ", " << side;
    }
  }
}

TEST(DrawBricks, AFirstPictureIsWholeAndCoarse) {
  const Volume volume = shelled_ball(96);
  const ShownVolume whole = make_shown_volume(volume);
  const Bricked bricked(volume, plenty);
  const DrawnPreset preset(bricked.shown, shell, preview_light());
  const PreviewView view{.side = 120};
  const VolumePicture first = draw_volume(bricked.shown, preset, view);
  const VolumePicture expected = draw_volume(whole, preset, view);
  double off = 0, all = 0;
  for (size_t i = 0; i < first.clear.size(); i++)
    off += double(std::abs(first.clear[i] - expected.clear[i])),
        all += double(1 - expected.clear[i]);
  EXPECT_GT(off, 0) << "it is not yet fine";
  EXPECT_LT(off, 0.1 * all) << "but nothing is missing";
  EXPECT_EQ(bricked.shown.arrivals(), 0u);
  bricked.load_all();
  EXPECT_GT(bricked.shown.arrivals(), 8u);
}

TEST(DrawBricks, APoolThatIsTooSmallStillGivesAWholePicture) {
  const Volume volume = shelled_ball(96);
  const ShownVolume whole = make_shown_volume(volume);
  const Bricked small(volume, 12);
  const DrawnPreset preset(small.shown, shell, preview_light());
  const PreviewView view{.side = 120};
  const VolumePicture picture = settled(small, preset, view);
  const VolumePicture expected = draw_volume(whole, preset, view);
  const Bricked coarse(volume, 1);
  const VolumePicture coarsest = draw_volume(coarse.shown, preset, view);
  double off = 0, off_coarsest = 0, all = 0;
  for (size_t i = 0; i < picture.clear.size(); i++) {
    off += double(std::abs(picture.clear[i] - expected.clear[i]));
    off_coarsest += double(std::abs(coarsest.clear[i] - expected.clear[i]));
    all += double(1 - expected.clear[i]);
  }
  EXPECT_LT(off, 0.05 * all);
  EXPECT_LT(off, 0.7 * off_coarsest) << "what there is room for is finer";
  EXPECT_EQ(small.pool->stats().used, 12);
}

TEST(DrawBricks, CoarserBricksAreContinuousWhereTheyMeet) {
  // A ramp is linear on every level, so all levels agree in its middle.
  const Volume ramp = volume_of({130, 130, 130},
                                [](glm::ivec3 at) { return uint16_t(100 * (at.x + at.y + at.z)); });
  const Bricked bricked(ramp, 1 + 27);  // no room for the finest level
  const auto value_at = [&](vec3 at) {
    return read(BrickSamples(bricked.shown, 0), all_lanes(at)).value[0] / most_code * 100 * 3 * 129;
  };
  for (int times = 0; times < 2; times++) {
    for (float x = 8; x < 122; x += 0.37f) {
      const vec3 at(x, 64 + 0.1f * (x - 64), 122 - x + 8);
      EXPECT_NEAR(value_at(at), 100 * (at.x + at.y + at.z), 1) << x;
      EXPECT_NEAR(PlaceSamples(bricked.shown, 0).value(at) / most_code * 100 * 3 * 129,
                  100 * (at.x + at.y + at.z), 1)
          << x;
    }
    bricked.load_all();
  }
  EXPECT_GT(bricked.shown.arrivals(), 4u);
}

TEST(DrawBricks, HardVolumesAreShown) {
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(1, 1, 4000), glm::ivec3(3, 1, 2)}) {
    const Volume volume = volume_of(size, rough);
    const ShownVolume whole = make_shown_volume(volume);
    const Bricked bricked(volume, plenty);
    for (const Preset& preset : find_presets(bricked.shown)) {
      const DrawnPreset drawn(bricked.shown, preset, {});
      const PreviewView view{.side = 40};
      EXPECT_LT(difference(settled(bricked, drawn, view), draw_volume(whole, drawn, view)), 1e-6f)
          << preset.name;
    }
  }
}

TEST(DrawBricks, DamagedFilesAreRefusedOrShownWithTheDamage) {
  const Bricked good(volume_of({40, 50, 70}, rough), 1);
  const std::string bytes = good.folder.read("made.bricks");
  // Head and tables are a small part of the file.
  BrickHead head;
  std::memcpy(&head, bytes.data(), sizeof head);
  const size_t tables = sizeof head + head.records * record_bytes;
  uint32_t random = 1;
  const auto next = [&](size_t below) { return (random = random * 1664525 + 1013904223) % below; };
  int shown = 0, refused = 0;
  for (int times = 0; times < 80; times++) {
    std::string damaged = bytes;
    for (int i = 0; i < 1 + times % 3; i++) {
      const size_t at = times % 2 ? next(200) : tables + next(bytes.size() - tables);
      damaged[at] = char(next(256));
    }
    try {
      const ShownVolume volume =
          open_shown_volume(good.folder.write("damaged.bricks", damaged),
                            std::make_shared<BrickPool>(plenty * record_bytes, 0));
      const std::vector<Preset> presets = find_presets(volume);
      const DrawnPreset preset(volume, presets.back(), {});  // the maximum needs no light
      draw_volume(volume, preset, {.side = 16});
      while (volume.bricks->pool().load_some()) {}
      const VolumePicture picture = draw_volume(volume, preset, {.side = 16});
      EXPECT_GE(picture.clear[0], 0);
      shown++;
    } catch (const LoadError&) {
      refused++;
    }
  }
  EXPECT_GT(shown, 20);
  EXPECT_GT(refused, 4);
}

TEST(DrawBricks, OtherFilesAreOpenedWhole) {
  const Folder folder;
  const std::string header =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
      "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
      "space origin: (0,0,0)\n\n";
  const ShownVolume shown =
      open_shown_volume(folder.write("a.nrrd", header + std::string("\0\1\2\3\4\5\6\7", 8)));
  EXPECT_EQ(shown.bricks, nullptr);
  EXPECT_EQ(shown.arrivals(), 0u);
  EXPECT_EQ(shown.levels.front().codes.back(), 65535);
}

}  // namespace
}  // namespace wellspring::test
