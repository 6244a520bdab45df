// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/objdetect.hpp>

#include "benchmark/kiosk/made_objects.h"
#include "kiosk/station/box.h"
#include "kiosk/station/code.h"
#include "kiosk/station/learn.h"
#include "kiosk/station/outline.h"
#include "kiosk/station/pattern.h"
#include "kiosk/station/twins.h"

namespace wellspring::test {
namespace {

// A search with models that have data.
RecognitionTree one_search(std::vector<NodeData> data, const std::string& solver) {
  RecognitionTree tree;
  RecognitionNode root;
  root.name = "root", root.kind = NodeKind::search, root.id = "class";
  root.solvers = {{solver, {}}};
  for (size_t i = 0; i < data.size(); i++) {
    tree.nodes.push_back({.name = std::to_string(i), .id = std::to_string(i)});
    root.children.push_back(int(i));
  }
  tree.data = std::move(data);
  tree.root = int(tree.nodes.size());
  tree.nodes.push_back(root);
  tree.data.emplace_back();
  return tree;
}

float corner_error(const mat3& pose, const View& view, const std::array<vec2, 4>& corners) {
  float most = 0;
  const auto seen = corners_of(pose, view);
  for (size_t i = 0; i < 4; i++) most = std::max(most, glm::distance(seen[i], corners[i]));
  return most;
}

TEST(PatternSolver, finds_a_view_and_its_pose) {
  NodeData data;
  const cv::Mat face = make_face(1);
  data.views = {learn_view(to_photo(face, "front"), {0.1f, 0.075f})};
  EXPECT_GE(data.views[0].features.size(), 80u);
  const RecognitionTree tree = one_search({data}, "pattern");
  Sight sight;
  PatternSolver solver(tree, sight);
  for (unsigned seed = 0; seed < 6; seed++) {
    const Held held = random_held(seed);
    cv::Mat picture = make_room(seed);
    const auto corners = put_face(picture, face, held);
    const GrayFrame frame = to_frame(picture, 0);
    look_at(sight, frame, made_focal);
    ContextStore context;
    const Answer answer = solver.match(tree.root, 0, context);
    ASSERT_EQ(answer.verdict, Verdict::sure) << seed;
    EXPECT_LT(corner_error(*context.get<mat3>(pose_value), data.views[0], corners), 2.5f);
    EXPECT_EQ(*context.get<std::string>(side_value), "front");
    // A little later it is verified from where it was.
    Held moved = held;
    moved.x += 9, moved.roll += 0.04f;
    cv::Mat next = make_room(seed);
    const auto there = put_face(next, face, moved);
    const GrayFrame later = to_frame(next, 0.03, 0.7, 4, 9);
    look_at(sight, later, made_focal);
    ASSERT_TRUE(solver.verify(0, context));
    EXPECT_LT(corner_error(*context.get<mat3>(pose_value), data.views[0], there), 2.5f);
    // It is not verified where it has gone.
    const GrayFrame empty = to_frame(make_room(seed), 0.06);
    look_at(sight, empty, made_focal);
    EXPECT_FALSE(solver.verify(0, context));
  }
}

TEST(PatternSolver, picture_without_texture_matches_nothing) {
  NodeData data;
  data.views = {learn_view(to_photo(make_face(1), "front"), {})};
  const RecognitionTree tree = one_search({data}, "pattern");
  Sight sight;
  PatternSolver solver(tree, sight);
  const GrayFrame frame = to_frame(cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 90, 90)), 0, 0.7, 0);
  look_at(sight, frame, made_focal);
  ContextStore context;
  EXPECT_EQ(solver.match(tree.root, 0, context).verdict, Verdict::no);
  EXPECT_EQ(
      learn_view(to_photo(cv::Mat(300, 400, CV_8UC3, cv::Scalar(9, 9, 9)), ""), {}).features.size(),
      0u);
}

struct RealPictures : testing::Test {
  std::string folder = std::string(WELLSPRING_DATA) + "/10_exhibits/recognition/";
  void SetUp() override {
    if (cv::imread(folder + "box.png").empty()) GTEST_SKIP() << "no real pictures";
  }
  // Finds a photographed thing in a picture.
  std::optional<mat3> find(const std::string& thing, const std::string& picture, View& view) {
    NodeData data;
    data.views = {learn_view(to_photo(cv::imread(folder + thing), ""), {})};
    view = data.views[0];
    const RecognitionTree tree = one_search({data}, "pattern");
    const cv::Mat seen = cv::imread(folder + picture, cv::IMREAD_GRAYSCALE);
    GrayFrame frame;
    frame.width = seen.cols, frame.height = seen.rows;
    frame.pixels.assign(seen.data, seen.data + seen.total());
    Sight sight;
    PatternSolver solver(tree, sight);
    look_at(sight, frame, made_focal);
    ContextStore context;
    if (solver.match(tree.root, 0, context).verdict != Verdict::sure) return {};
    return *context.get<mat3>(pose_value);
  }
};

TEST_F(RealPictures, box_is_found_in_its_scene) {
  View view;
  const auto pose = find("box.png", "box_in_scene.png", view);
  ASSERT_TRUE(pose);
  const auto corners = corners_of(*pose, view);
  // These are the corners as people see them.
  const vec2 seen[] = {{118, 161}, {285, 178}, {267, 303}, {94, 264}};
  for (size_t i = 0; i < 4; i++)
    EXPECT_LT(glm::distance(corners[i], seen[i]), 14.f) << corners[i].x << ' ' << corners[i].y;
}

TEST_F(RealPictures, wall_is_found_from_another_place) {
  View view;
  const auto pose = find("graf1.png", "graf3.png", view);
  ASSERT_TRUE(pose);
  // This is H1to3p of the data set.
  const mat3 truth(vec3(0.76285898f, 0.33443473f, 3.4663091e-4f),
                   vec3(-0.29922929f, 1.0143901f, -1.4364524e-5f),
                   vec3(225.67123f, -76.999973f, 1));
  const float scale = 800.f / float(view.width);
  for (const vec2 at : {vec2(80, 60), {240, 60}, {160, 128}, {240, 180}})
    EXPECT_LT(glm::distance(project_by(*pose, at), project_by(truth, at * scale)), 4.f);
}

TEST(OutlineSolver, pose_of_a_rectangle_is_the_one_it_was_drawn_with) {
  for (unsigned seed = 0; seed < 8; seed++) {
    Held held = random_held(seed);
    held.tilt_x = std::copysign(std::max(std::abs(held.tilt_x), 0.2f), held.tilt_x);
    cv::Mat picture(480, 640, CV_8UC3, cv::Scalar(60, 60, 60));
    const cv::Mat card(300, 400, CV_8UC3, cv::Scalar(210, 200, 190));
    put_face(picture, card, held);
    const auto quads = find_quads(to_frame(picture, 0));
    ASSERT_FALSE(quads.empty()) << seed;
    float least = 1e9f;
    std::optional<SpacePose> best;
    for (size_t turn = 0; turn < 4; turn++) {
      auto quad = quads[0];
      std::rotate(quad.begin(), quad.begin() + long(turn), quad.end());
      const auto pose = solve_rectangle(quad, {0.12f, 0.09f}, made_focal, 640, 480);
      if (pose && pose->error < least) least = pose->error, best = pose;
    }
    ASSERT_TRUE(best);
    EXPECT_LT(best->error, 1.f);
    const float depth = 0.12f * made_focal / held.size;
    EXPECT_NEAR(best->position.z, depth, 0.02f * depth) << seed;
    EXPECT_NEAR(best->position.x, (held.x - 320) / made_focal * depth, 0.004f);
    // The normal leans as it was tilted.
    const vec3 normal = best->rotation[2];
    const vec3 drawn(std::sin(glm::length(vec2(held.tilt_x, held.tilt_y))) *
                         vec2(held.tilt_y, -held.tilt_x) /
                         glm::length(vec2(held.tilt_x, held.tilt_y)),
                     std::cos(glm::length(vec2(held.tilt_x, held.tilt_y))));
    EXPECT_GT(std::abs(glm::dot(normal, drawn)), std::cos(5 * pi / 180)) << seed;
  }
}

TEST(OutlineSolver, another_shape_does_not_match) {
  NodeData wide, square;
  wide.views = {View{.width = 320, .height = 200, .size = {0.16f, 0.1f}}};
  square.views = {View{.width = 320, .height = 320, .size = {0.1f, 0.1f}}};
  const RecognitionTree tree = one_search({wide, square}, "outline");
  Sight sight;
  OutlineSolver solver(tree, sight);
  cv::Mat picture(480, 640, CV_8UC3, cv::Scalar(60, 60, 60));
  Held held;
  held.roll = 0.3f, held.tilt_y = 0.3f;
  put_face(picture, cv::Mat(250, 400, CV_8UC3, cv::Scalar(210, 200, 190)), held);
  const GrayFrame frame = to_frame(picture, 0);
  look_at(sight, frame, made_focal);
  ContextStore context;
  EXPECT_EQ(solver.match(tree.root, 0, context).verdict, Verdict::likely);
  EXPECT_TRUE(solver.verify(0, context));
  EXPECT_EQ(solver.match(tree.root, 1, context).verdict, Verdict::no);
}

constexpr vec3 made_box(0.12f, 0.08f, 0.05f);

GrayFrame show_box(unsigned seed, vec3 middle, const mat3& axes, vec3 size = made_box) {
  cv::Mat picture = make_room(seed);
  put_box(picture, middle, axes, size, seed);
  return to_frame(picture, 0, 0.7, 4, seed);
}

TEST(BoxSolver, corner_gives_the_pose_it_was_drawn_with) {
  for (unsigned seed = 0; seed < 30; seed++) {
    const mat3 axes = random_axes(seed);
    const vec3 middle(0.02f, -0.01f, 0.45f);
    auto project = [&](vec3 p) { return vec2(p) / p.z * made_focal + vec2(320, 240); };
    // The corner nearest to the camera.
    vec3 corner(0), signs(0);
    for (int axis = 0; axis < 3; axis++) signs[axis] = axes[axis].z < 0 ? 1.f : -1.f;
    corner = middle + axes * (0.5f * signs * made_box);
    Junction seen{project(corner), {}};
    for (int axis = 0; axis < 3; axis++)
      seen.ends[size_t(axis)] = project(corner - axes[axis] * (signs[axis] * made_box[axis]));
    float best = 1;
    for (const SpacePose& pose : solve_corner(seen, made_box, made_focal, 640, 480))
      best = std::min(best, glm::distance(pose.position, middle));
    EXPECT_LT(best, 1e-3f) << seed;
  }
}

TEST(BoxSolver, box_without_texture_is_found_with_its_pose_and_followed) {
  std::vector<NodeData> data(2);
  data[0].box = made_box;
  data[1].box = vec3(0.1f, 0.1f, 0.03f);
  const RecognitionTree tree = one_search(data, "box");
  int found = 0, wrong = 0, kept = 0;
  for (unsigned seed = 0; seed < 20; seed++) {
    Sight sight;
    BoxSolver solver(tree, sight);
    ContextStore context;
    mat3 axes = random_axes(seed);
    vec3 middle(0.03f, -0.02f, 0.4f);
    const GrayFrame frame = show_box(seed, middle, axes);
    look_at(sight, frame, made_focal);
    wrong += solver.match(tree.root, 1, context).verdict == Verdict::sure;
    if (solver.match(tree.root, 0, context).verdict != Verdict::sure) continue;
    found++;
    ASSERT_TRUE(solver.pose());
    EXPECT_LT(glm::distance(solver.pose()->position, middle), 0.012f) << seed;
    for (int axis = 0; axis < 3; axis++)
      EXPECT_GT(std::abs(glm::dot(solver.pose()->rotation[axis], axes[axis])), 0.99f) << seed;
    middle += vec3(0.004f, 0, 0.004f);
    const GrayFrame next = show_box(seed, middle, axes);
    look_at(sight, next, made_focal);
    kept += solver.verify(0, context);
  }
  EXPECT_GE(found, 14);
  EXPECT_GE(kept, found - 2);
  EXPECT_LE(wrong, 1);
}

TEST(BoxSolver, rooms_and_cards_are_no_boxes) {
  std::vector<NodeData> data(1);
  data[0].box = made_box;
  const RecognitionTree tree = one_search(data, "box");
  int wrong = 0;
  for (unsigned seed = 0; seed < 40; seed++) {
    Sight sight;
    BoxSolver solver(tree, sight);
    ContextStore context;
    cv::Mat picture = make_room(seed);
    if (seed % 2) put_face(picture, make_face(seed), random_held(seed));
    const GrayFrame frame = to_frame(picture, 0);
    look_at(sight, frame, made_focal);
    wrong += solver.match(tree.root, 0, context).verdict == Verdict::sure;
  }
  EXPECT_EQ(wrong, 0);
}

cv::Mat make_code(const std::string& text) {
  cv::Mat code, large;
  cv::QRCodeEncoder::create()->encode(text, code);
  cv::resize(code, large, {}, 8, 8, cv::INTER_NEAREST);
  cv::cvtColor(large, large, cv::COLOR_GRAY2BGR);
  return large;
}

TEST(CodeSolver, tells_codes_apart) {
  const cv::Mat one = make_code("wellspring 17"), two = make_code("wellspring 18");
  std::vector<NodeData> data(2);
  for (size_t i = 0; i < 2; i++) {
    cv::Mat gray;
    cv::cvtColor(i ? two : one, gray, cv::COLOR_BGR2GRAY);
    cv::copyMakeBorder(gray, gray, 30, 30, 30, 30, cv::BORDER_CONSTANT, 255);
    const auto codes = read_codes(gray.cols, gray.rows, gray.data);
    ASSERT_EQ(codes.size(), 1u);
    data[i].code = codes[0];
  }
  EXPECT_NE(data[0].code, data[1].code);
  const RecognitionTree tree = one_search(data, "code");
  Sight sight;
  CodeSolver solver(tree, sight);
  int sure = 0;  // one picture in twenty is misread; the next one is not
  for (int k = 0; k < 12; k++) {
    cv::Mat picture = make_room(1);
    Held held;
    held.roll = 0.5f * float(k), held.size = 170 + 5 * float(k), held.tilt_x = 0.2f;
    put_face(picture, two, held);
    const GrayFrame frame = to_frame(picture, 0);
    look_at(sight, frame, made_focal);
    ContextStore context;
    EXPECT_EQ(solver.match(tree.root, 0, context).verdict, Verdict::no);
    EXPECT_FALSE(solver.verify(0, context));
    const bool read = solver.match(tree.root, 1, context).verdict == Verdict::sure;
    EXPECT_EQ(solver.verify(1, context), read);
    sure += read;
  }
  EXPECT_GE(sure, 10);
  const GrayFrame room = to_frame(make_room(2), 0);
  look_at(sight, room, made_focal);
  EXPECT_FALSE(solver.verify(1, *std::make_unique<ContextStore>()));
}

Mark mark_of(const cv::Mat& face, int x, int y, int side) {
  Mark mark{0, x, y, side, side, {}};
  const cv::Mat part = face(cv::Rect(x, y, side, side)).clone();
  mark.bgr.assign(part.data, part.data + part.total() * 3);
  return mark;
}

TEST(Marks, are_apart_by_structure_or_by_colour) {
  cv::Mat a = make_face(5, 320, 240), b = a.clone();
  draw_emblem(a, 1, {100, 100});
  draw_emblem(b, 2, {100, 100});
  const Mark one = mark_of(a, 110, 110, 40), other = mark_of(b, 110, 110, 40);
  EXPECT_LT(marks_apart(MarkKind::edges, one, one), 0.02f);
  EXPECT_GT(marks_apart(MarkKind::edges, one, other), 0.4f);
  // A shift of two pixels is no difference.
  EXPECT_LT(marks_apart(MarkKind::edges, one, mark_of(a, 112, 109, 40)), 0.1f);
  const cv::Mat red(40, 40, CV_8UC3, cv::Scalar(40, 40, 200)),
      green(40, 40, CV_8UC3, cv::Scalar(60, 128, 40));
  EXPECT_EQ(marks_apart(MarkKind::edges, mark_of(red, 0, 0, 40), mark_of(green, 0, 0, 40)), 0.f);
  EXPECT_GT(marks_apart(MarkKind::colors, mark_of(red, 0, 0, 40), mark_of(green, 0, 0, 40)), 0.9f);
}

}  // namespace
}  // namespace wellspring::test
