// SPDX-License-Identifier: Apache-2.0
// The mesh against the 68 landmarks of another network, on a recorded face.
#include "kiosk/face/face_mesh.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/load_error.h"
#include "kiosk/camera.h"
#include "kiosk/face/face_finder.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

struct FaceMeshes : testing::Test {
  const fs::path weights = WELLSPRING_WEIGHTS_FOLDER;
  const fs::path clip = fs::path(WELLSPRING_DATA) / "5_faces/tracking_js/franck.mp4";
  GrayFrame frame;
  FaceMarks marks{};

  void SetUp() override {
    for (const char* name : {"face", "human"})
      if (!fs::exists(weights / name))
        GTEST_SKIP() << weights / name << " is not here; ./wellspring installs it";
    if (!fs::exists(clip)) GTEST_SKIP() << clip << " is not here";
    CameraSettings source;
    source.source = clip.string();
    auto camera = make_camera(source);
    ASSERT_EQ(camera->next(frame), Got::frame);
    const auto finder = make_network_finder((weights / "face").string());
    std::vector<Face> faces;
    for (int turn = 0; turn < 8 && faces.empty(); turn++) faces = finder->search(frame);
    ASSERT_EQ(faces.size(), 1u);
    ASSERT_TRUE(faces[0].marks);
    marks = *faces[0].marks;
  }
  GrayView view() const { return {frame.pixels.data(), frame.width, frame.height}; }
};

TEST_F(FaceMeshes, PointsAreWhereLandmarksAre) {
  MeshReader reader((weights / "human").string());
  const FaceMesh first = reader.read(view(), mesh_cut_of_marks(marks));
  EXPECT_GT(first.confidence, 0.9f);
  const Cut again = mesh_cut_of_mesh(first);
  const FaceMesh mesh = reader.read(view(), again);
  // Corners of eyes and mouth, tip of the nose, chin: index of the mesh, of 300-W.
  const std::pair<size_t, size_t> same[] = {{33, 36},  {263, 45}, {61, 48},
                                            {291, 54}, {1, 30},   {152, 8}};
  const float eyes = glm::length(marks[36] - marks[45]);
  for (const auto& [point, mark] : same)
    EXPECT_LT(glm::length(vec2(mesh.points[point]) - marks[mark]), 0.1f * eyes) << mark;
  // The tip of the nose is nearer than the ears.
  EXPECT_LT(mesh.points[1].z, mesh.points[234].z - 0.3f * eyes);
  EXPECT_LT(mesh.points[1].z, mesh.points[454].z - 0.3f * eyes);
  // Squares of marks and of the mesh are about the same.
  const Cut cut = mesh_cut_of_marks(marks);
  EXPECT_LT(glm::length(cut.middle - again.middle), 0.05f * cut.width);
  EXPECT_NEAR(cut.width / again.width, 1, 0.1f);
}

TEST_F(FaceMeshes, IrisesLieBetweenTheCornersOfEyes) {
  MeshReader reader((weights / "human").string());
  FaceMesh mesh = reader.read(view(), mesh_cut_of_marks(marks));
  IrisReader((weights / "human").string()).read(view(), mesh);
  ASSERT_TRUE(mesh.irises);
  for (size_t eye = 0; eye < 2; eye++) {
    const auto& iris = (*mesh.irises)[eye];
    const vec2 left(mesh.points[eye ? 362 : 33]), right(mesh.points[eye ? 263 : 133]);
    const float width = glm::length(right - left);
    EXPECT_LT(glm::length(iris[0] - (left + right) / 2.f), 0.25f * width);
    EXPECT_GT(iris[1].x, iris[0].x);
    EXPECT_LT(iris[2].y, iris[0].y);
    EXPECT_LT(iris[3].x, iris[0].x);
    EXPECT_GT(iris[4].y, iris[0].y);
    // An iris is 11.7 mm wide, an eye about 28 mm.
    EXPECT_NEAR(glm::length(iris[1] - iris[3]) / width, 0.42f, 0.1f);
  }
}

TEST_F(FaceMeshes, NoFaceHasNoIrises) {
  MeshReader reader((weights / "human").string());
  const std::vector<uint8_t> wall(64 * 64, 120);
  const FaceMesh mesh = reader.read({wall.data(), 64, 64}, {{32, 32}, 64, 64, 0});
  EXPECT_LT(mesh.confidence, 0.5f);
  EXPECT_FALSE(mesh.irises);
}

TEST(FaceMeshFiles, MissingGraphsAreNamed) {
  try {
    MeshReader reader("/nowhere");
    ADD_FAILURE() << "no error";
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, "/nowhere/facemesh.json");
  }
}

}  // namespace
}  // namespace wellspring::test
