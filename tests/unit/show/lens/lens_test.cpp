// SPDX-License-Identifier: Apache-2.0
// A glass over a picture of two layers, in a running show.
#include "show/lens/lens.h"

#include <gtest/gtest.h>

#include "show/lens/pieces.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"
#include "unit/store/address_picture.h"

namespace wellspring::test {
namespace {

// One colour in all its levels.
class OneColor : public AddressPicture {
 public:
  explicit OneColor(std::array<uint8_t, 3> color) : AddressPicture(4096, 4096, 64), color_(color) {}
  Fetched fetch(PieceKey key) const override {
    auto piece = std::make_shared<store::Piece>(*AddressPicture::fetch(key).piece);
    for (size_t i = 0; i < piece->bytes.size(); i++)
      piece->bytes[i] = i % 4 < 3 ? color_[i % 4] : uint8_t(255);
    return {piece};
  }

 private:
  const std::array<uint8_t, 3> color_;
};

struct LensTest : testing::Test, ShowStage {
  LensTest() {
    Exhibit exhibit = make_tiny_exhibit();
    Scene& scene = exhibit.scene;
    auto layer = [](std::array<uint8_t, 3> color) {
      return PictureLayer{
          std::make_shared<LargePicture>(shared_store(), std::make_shared<OneColor>(color))};
    };
    const PictureLayer red = layer({250, 0, 0}), green = layer({0, 250, 0});
    ExhibitPiece piece;
    piece.id = "wall", piece.image = 0, piece.picture = red.picture;
    piece.layers.push_back(
        {.id = "1650", .source = "", .label = {}, .text = {}, .year = 1650, .shown = red});
    piece.layers.push_back(
        {.id = "1850", .source = "", .label = {}, .text = {}, .year = 1850, .shown = green});
    exhibit.pieces = {piece};
    const LargePicture& large = *red.picture;
    Image image{.width = large.coarsest.width, .height = large.coarsest.height, .srgb = true};
    image.texels8 = large.coarsest.bytes;
    image.large = red.picture;
    scene.images = {image};
    scene.textures = {{.image = 0}};
    Material material = scene.materials[0];
    material.base_color = vec4(1);
    material.base_color_texture.texture = 0;
    material.large_picture = true;
    scene.materials.push_back(material);
    Mesh mesh;
    mesh.material = 2;
    add_quad(mesh, {-3, 0.6f, 0.02f}, {2, 0, 0}, {0, 2, 0});
    mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    scene.instances.push_back({int(scene.meshes.size()), mat4(1), 1});
    scene.meshes.push_back(mesh);
    begin(std::move(exhibit), settings_for("gather"));
    browsers[join(96, 64)].acknowledges = true;
  }
  // The last picture of the glass, or the last other one.
  std::optional<PacketView> last_of(bool lens) {
    for (auto packet = pictures().rbegin(); packet != pictures().rend(); ++packet) {
      const std::optional<PacketView> read = read_packet(*packet);
      if (bool(read->header.flags & packet_lens) == lens && read->parts.empty()) return read;
    }
    return std::nullopt;
  }
  // How much greener than red its middle is, -1 to 1; 0: there is none.
  double green(bool lens) {
    const std::optional<PacketView> read = last_of(lens);
    if (!read) return 0;
    const Image8 seen = decode_jpeg(read->payload, "picture");
    const uint8_t* p = &seen.rgb[size_t(seen.height / 2 * seen.width + seen.width / 2) * 3];
    return (double(p[1]) - p[0]) / std::max({int(p[0]), int(p[1]), 1});
  }
  size_t count_lenses() {
    return size_t(std::ranges::count_if(pictures(), [](const Packet& packet) {
      return read_packet(packet)->header.flags & packet_lens;
    }));
  }
};

TEST_F(LensTest, ItShowsAnotherLayerAndTheRestStaysAsItIs) {
  ASSERT_TRUE(step_until([&] { return green(false) < -0.8; }));
  run(1);
  const double samples = visitor().picture->rest.samples;
  ASSERT_GT(samples, 0);
  say(R"({"type": "lens", "seq": 5, "at": [0.5, 0.5], "radius": 0.25, "name": "wall",
          "layer": "1850"})");
  ASSERT_TRUE(step_until([&] { return green(true) > 0.8; }));
  EXPECT_GE(visitor().picture->rest.samples, samples) << "what rests goes on resting";
  const PacketHeader header = last_of(true)->header;
  EXPECT_EQ(header.seq, 5u);
  EXPECT_EQ(header.width, 48) << "a square of three radii";
  EXPECT_EQ(header.height, 48);
  EXPECT_EQ(last_of(true)->zoom, 1);
  run(1);
  EXPECT_LT(green(false), -0.8);
}

TEST_F(LensTest, OnceWhatItShowsIsThereNothingMoreIsDrawn) {
  say(R"({"type": "lens", "seq": 1, "at": [0.5, 0.5], "name": "wall", "layer": "1850"})");
  ASSERT_TRUE(step_until([&] { return green(true) > 0.8; }));
  run(1);
  const size_t before = count_lenses();
  run(2);
  EXPECT_EQ(count_lenses(), before);
  turn(0.1);
  run(1);
  EXPECT_GT(count_lenses(), before) << "the visitor looks elsewhere";
  say(R"({"type": "lens", "seq": 2})");
  run(0.2);
  const size_t until_then = count_lenses();
  turn(0.1);
  run(1);
  EXPECT_EQ(count_lenses(), until_then) << "it is put down";
}

TEST_F(LensTest, AYearIsChosenAndToldAndItsNeighbourFetched) {
  ASSERT_TRUE(step_until([&] { return green(false) < -0.8; }));
  run(1);
  const int source = show->stage.exhibit.pieces[0].layers[1].shown.picture->source;
  const PieceReader reader(*shared_store());
  bool fetched = false;
  for (int level = 0; level < 6 && !fetched; level++)
    for (uint32_t x = 0; x < 64 && !fetched; x++)
      for (uint32_t y = 0; y < 64 && !fetched; y++)
        fetched = reader.find({source, level, x, y}) != nullptr;
  EXPECT_TRUE(fetched) << "1850 waits in memory";
  order(R"({"type": "piece", "name": "wall", "layer": "1850"})");
  ASSERT_TRUE(step_until([&] { return green(false) > 0.8; }));
  run(0.5);
  EXPECT_EQ(last("state")["pieces"]["wall"]["layer"], "1850");
  order(R"({"type": "piece", "name": "wall", "layer": "1650", "over": "1850", "by": "curtain",
            "share": 1})");
  ASSERT_TRUE(step_until([&] { return green(false) < -0.8; }));
}

TEST_F(LensTest, OneVisitorsYearIsNotAnothers) {
  browsers[join(96, 64)].acknowledges = true;
  order(R"({"type": "piece", "name": "wall", "layer": "1850"})", 1);
  run(2);
  auto middle = [&](size_t who) {
    const Image8 seen = last_image(who);
    const uint8_t* p = &seen.rgb[size_t(seen.height / 2 * seen.width + seen.width / 2) * 3];
    return int(p[1]) - int(p[0]);
  };
  EXPECT_LT(middle(0), -50);
  EXPECT_GT(middle(1), 50);
}

TEST_F(LensTest, TheRulerMeasuresTheWorld) {
  ASSERT_TRUE(step_until([&] { return !pictures().empty(); }));
  order(R"({"type": "measure", "id": 7, "from": [0.45, 0.5], "to": [0.55, 0.5]})");
  const View& view = visitor().place.last_view;
  const auto place = [&](float x) {
    const Ray ray = view_ray(view, x * float(view.width), 0.5f * float(view.height));
    return ray.origin + ray.direction * show->stage.world->intersect(ray).t;
  };
  EXPECT_EQ(last("measured")["id"], 7);
  EXPECT_NEAR(double(last("measured")["metres"]), double(length(place(0.55f) - place(0.45f))),
              1e-4);
}

TEST_F(LensTest, WhatDoesNotExistIsRefused) {
  step();
  order(R"({"type": "piece", "name": "ceiling", "layer": "1850"})");
  EXPECT_EQ(last("error")["code"], "unknown_piece");
  order(R"({"type": "lens", "seq": 1, "at": [0, 0], "name": "wall", "layer": "1750"})");
  EXPECT_EQ(last("error")["code"], "unknown_piece");
  EXPECT_FALSE(visitor().lens.at);
}

TEST(LensView, ItsPixelsAreThoseOfThePictureWhereverItIs) {
  View view;
  view.width = 320, view.height = 180, view.middle = {0.1f, -0.05f};
  const LensOrder order{.at = vec2(0.75f, 0.4f), .radius = 0.2f};
  const View lens = lens_view(view, order, 1);
  ASSERT_EQ(lens.width, 108);
  for (float dx : {-50.f, 0.f, 50.f}) {
    const Ray a = view_ray(view, 240 + dx, 72), b = view_ray(lens, 54 + dx, 54);
    EXPECT_NEAR(length(a.direction - b.direction), 0, 1e-6);
    const Ray c = view_ray(lens_view(view, order, 2), 54 + 2 * dx, 54);
    EXPECT_NEAR(length(a.direction - c.direction), 0, 1e-6) << "twice as large";
  }
}

}  // namespace
}  // namespace wellspring::test
