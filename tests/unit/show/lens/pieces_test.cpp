// SPDX-License-Identifier: Apache-2.0
// A very large picture on a wall of a running show: who comes sees it coarse, then as it is.
#include "show/lens/pieces.h"

#include <gtest/gtest.h>

#include "show/draw/make_picture_job.h"
#include "show/draw/pace.h"
#include "show/state/visitor_picture.h"
#include "store/picture/sample_picture.h"
#include "unit/show/show_stage.h"
#include "unit/store/address_picture.h"

namespace wellspring::test {
namespace {

// Green where it is sharp enough, red in its small versions.
class SharpIsGreen : public AddressPicture {
 public:
  SharpIsGreen(int sharp_level) : AddressPicture(1 << 16, 1 << 16, 16), sharp_(sharp_level) {}
  Fetched fetch(PieceKey key) const override {
    Fetched fetched = AddressPicture::fetch(key);
    auto piece = std::make_shared<store::Piece>(*fetched.piece);
    const bool green = key.level() <= sharp_;
    for (size_t i = 0; i < piece->bytes.size(); i += 4) {
      piece->bytes[i] = green ? 0 : 250, piece->bytes[i + 1] = green ? 250 : 0;
      piece->bytes[i + 2] = 0;
    }
    return {piece, fetched.soft, fetched.hard};
  }

 private:
  const int sharp_;
};

struct PiecesTest : testing::Test, ShowStage {
  // A picture of 2 m on the wall that the first viewpoint looks at, 3 m away.
  void begin(int sharp_level) {
    Exhibit exhibit = make_tiny_exhibit();
    Scene& scene = exhibit.scene;
    auto large =
        std::make_shared<LargePicture>(shared_store(), std::make_shared<SharpIsGreen>(sharp_level));
    Image image{.width = large->coarsest.width, .height = large->coarsest.height, .srgb = true};
    image.texels8 = large->coarsest.bytes;
    image.large = large;
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
    ShowStage::begin(std::move(exhibit), settings_for("gather"));
    browsers[join(96, 64)].acknowledges = true;
  }
  // Returns how much greener than red the middle of the last picture is, -1 to 1.
  double green() { return green(last_image()); }
  static double green(const Image8& seen) {
    const uint8_t* p = &seen.rgb[size_t(seen.height / 2 * seen.width + seen.width / 2) * 3];
    return (double(p[1]) - p[0]) / std::max({int(p[0]), int(p[1]), 1});
  }
};

TEST_F(PiecesTest, WhoStandsBeforeAPictureSeesItSharpAndAtRestExact) {
  // 65536 texels in 2 m; a pixel at 3 m covers about 0.05 m, which is level 10 or 11.
  begin(11);
  ASSERT_TRUE(step_until([&] { return !pictures().empty(); }));
  ASSERT_TRUE(step_until([&] { return green() > 0.8; }));
  run(2);
  EXPECT_GT(green(), 0.8);
  EXPECT_FALSE(has_new_pieces(visitor().picture->pieces));
  EXPECT_GT(green(truth(visitor().place.last_view, 16)), 0.8);
  const StoreStats stats = shared_store()->stats();
  EXPECT_GT(stats.pieces, 0);
  EXPECT_EQ(stats.waiting, 0);
}

TEST_F(PiecesTest, TheFirstPictureAtRestWaitsNeitherForItsTurnNorForSamples) {
  begin(11);
  ASSERT_TRUE(step_until([&] { return !pictures().empty(); }));
  ASSERT_TRUE(step_until([&] { return green() > 0.8; }));
  Visitor& one = visitor();
  ASSERT_TRUE(step_until([&] { return stands(show->time, one) && !one.picture->at_work; }));
  run(2);
  EXPECT_FALSE(is_wanted_at_once(*one.picture, one.place.last_view));
  const PictureJob later = make_picture_job(*show, one, 1, PictureKind::still);
  one.picture->job.kind = PictureKind::moving;
  EXPECT_TRUE(is_wanted_at_once(*one.picture, one.place.last_view));
  VisitorDrawState state = draw_states(*show)[0];
  state.at_work = state.unshown = state.in_pass = state.other_light = false;
  state.stands = state.same_view = state.can_take = true;
  state.drew_moving = state.sees_moving;
  state.drawn_at = show->time;
  EXPECT_TRUE(wants_picture(show->time, state));
  state.at_once = false;
  EXPECT_FALSE(wants_picture(show->time, state)) << "it is not due";
  const PictureJob first = make_picture_job(*show, one, 1, PictureKind::still);
  EXPECT_LT(first.samples, later.samples);
  one.picture->pieces.motions.clear();
  EXPECT_FALSE(is_wanted_at_once(*one.picture, one.place.last_view)) << "it shows no pieces";
}

TEST_F(PiecesTest, AfterALeapThePictureHasAllItsPixels) {
  begin(11);
  ASSERT_TRUE(step_until([&] { return !pictures().empty(); }));
  Visitor& one = visitor();
  one.times.drawing = one.times.light = 1000;  // too slow for all pixels in motion
  one.place.moved_at = show->time;
  one.place.leapt = false;
  EXPECT_LT(make_picture_job(*show, one, 1).scale, 1);
  one.place.leapt = true;
  EXPECT_EQ(make_picture_job(*show, one, 1).scale, 1);
}

TEST_F(PiecesTest, NothingIsReadThatNobodySees) {
  begin(3);  // only from much nearer
  const uint64_t before = shared_store()->stats().fetched;
  run(1);
  EXPECT_LT(green(), 0) << "its small version";
  turn(3.1);  // away from it
  run(2);
  EXPECT_LT(shared_store()->stats().fetched - before, 400u) << "there are 22 million";
}

}  // namespace
}  // namespace wellspring::test
