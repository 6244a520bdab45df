// SPDX-License-Identifier: Apache-2.0
// Answers that come late, in any order, twice or never.
#include "cache/broker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cache/point_image.h"
#include "judge/flip.h"
#include "unit/cache/visit.h"

namespace wellspring::test {
namespace {

View hall(float x = -1, int width = 160, int height = 90) {
  return look_at(vec3(x, 1.6f, 4), vec3(-0.2f, 0.9f, -2), 60, width, height);
}

std::vector<Request> numbered(int count) {
  std::vector<Request> requests(static_cast<size_t>(count));
  for (uint32_t i = 0; i < uint32_t(count); i++) requests[i].pixel = requests[i].seed = i;
  return requests;
}

Answer answer_of(Piece piece, uint64_t pose = 0) {
  Answer answer{std::move(piece), pose, {}};
  answer.samples.resize(answer.piece.requests.size());
  return answer;
}

// A visit whose requests go through a broker, as the show's do.
struct BrokeredVisit {
  Visit visit;
  Broker broker;
  View view;
  std::vector<Piece> taken;
  int budget = 700;
  int landed = 0;

  void begin_picture(const View& now) {
    view = now;
    RenderCache& cache = visit.cache;
    cache.resize(view.width, view.height);
    cache.move_points(visit.world());
    landed = land(broker.collect(), visit.world(), 0, cache);
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, visit.tick++, visit.requests);
    broker.ask(view, {}, visit.requests);
    visit.show(view);
  }
  void take_all() {
    while (auto piece = broker.take()) taken.push_back(std::move(*piece));
  }
  void answer_taken(size_t from = 0) {
    for (size_t i = from; i < taken.size(); i++) {
      Answer answer{std::move(taken[i]), 0, {}};
      trace_room(visit.room, answer.piece.requests, answer.samples);
      broker.answer(std::move(answer));
    }
    taken.resize(std::min(from, taken.size()));
  }
  void step(const View& now) {
    begin_picture(now);
    take_all();
    answer_taken();
  }
  // Returns the share of the pixels with a point whose point lies on another surface.
  float wrong() const {
    Frame truth = render_room(visit.room, view, 1);
    const PointImage& image = visit.cache.image();
    int wrong = 0, known = 0;
    for (size_t i = 0; i < truth.object.size(); i++) {
      if (image.point[i] == no_point) continue;
      known++;
      wrong += visit.cache.points().color[image.point[i]].object != truth.object[i];
    }
    return float(wrong) / float(std::max(known, 1));
  }
};

TEST(Broker, EveryRequestGoesOutOnceAndWhatIsReachedIsSpreadOverThePicture) {
  Broker broker;
  broker.ask({}, {}, numbered(5000));
  EXPECT_EQ(broker.waiting(), 5000);
  std::set<uint32_t> seen;
  std::vector<int> quarter(4, 0);
  for (int i = 0; auto piece = broker.take(); i++) {
    EXPECT_LE(piece->requests.size(), 64u);
    for (const Request& r : piece->requests) EXPECT_TRUE(seen.insert(r.pixel).second);
    if (i < 20) quarter[piece->requests[0].pixel / 1250]++;
  }
  EXPECT_EQ(seen.size(), 5000u);
  for (int n : quarter) EXPECT_NEAR(n, 5, 1);
  EXPECT_EQ(broker.waiting(), 0);
}

TEST(Broker, NewQuestionsTakeThePlaceOfThoseNobodyTook) {
  Broker broker;
  broker.ask({}, {}, numbered(1000));
  auto old = broker.take();
  View later;
  later.position.x = 3;
  broker.ask(later, {}, numbered(100));
  EXPECT_EQ(broker.waiting(), 100);
  EXPECT_EQ(broker.stats().dropped, 1000 - 64u);
  EXPECT_EQ(broker.take()->view.position.x, 3);
  EXPECT_TRUE(broker.answer(answer_of(*old)));  // late, and welcome
  auto got = broker.collect();
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].piece.view.position.x, 0);
}

TEST(Broker, AnswersAreCollectedInTheOrderOfTheQuestions) {
  Broker broker;
  broker.ask({}, {}, numbered(640));
  std::vector<Piece> pieces;
  while (auto piece = broker.take()) pieces.push_back(std::move(*piece));
  std::reverse(pieces.begin(), pieces.end());
  for (Piece& piece : pieces) EXPECT_TRUE(broker.answer(answer_of(std::move(piece))));
  auto got = broker.collect();
  ASSERT_EQ(got.size(), 10u);
  for (size_t i = 1; i < got.size(); i++) EXPECT_LT(got[i - 1].piece.number, got[i].piece.number);
  EXPECT_TRUE(broker.collect().empty());
}

TEST(Broker, DoubledIncompleteInventedAndForgottenAnswersAreRefused) {
  Broker broker;
  broker.ask({}, {}, numbered(256));
  Piece first = *broker.take(), second = *broker.take(), third = *broker.take();
  EXPECT_TRUE(broker.answer(answer_of(first)));
  EXPECT_FALSE(broker.answer(answer_of(first)));
  Answer incomplete = answer_of(second);
  incomplete.samples.pop_back();
  EXPECT_FALSE(broker.answer(std::move(incomplete)));
  EXPECT_TRUE(broker.answer(answer_of(second)));  // made good
  Piece invented = third;
  invented.number = 77;
  EXPECT_FALSE(broker.answer(answer_of(invented)));
  broker.forget();
  EXPECT_FALSE(broker.answer(answer_of(third)));
  EXPECT_TRUE(broker.collect().empty());
  EXPECT_FALSE(broker.take());
  EXPECT_EQ(broker.stats().answered, 128u);
  // The numbers of pieces go on: an old answer cannot be taken for a new one.
  broker.ask({}, {}, numbered(64));
  EXPECT_GT(broker.take()->number, third.number);
}

TEST(Broker, IsBoundedWhateverWorkersDo) {
  Broker broker({.piece = 10, .most_waiting = 100, .most_traced = 50, .most_answered = 30});
  broker.ask({}, {}, numbered(1000));
  EXPECT_EQ(broker.waiting(), 100);
  std::vector<Piece> pieces;
  while (auto piece = broker.take()) pieces.push_back(std::move(*piece));
  ASSERT_EQ(pieces.size(), 10u);
  EXPECT_FALSE(broker.answer(answer_of(pieces[4])));  // one of the five given up
  for (size_t i = 5; i < 10; i++) EXPECT_TRUE(broker.answer(answer_of(pieces[i])));
  EXPECT_EQ(broker.collect().size(), 3u);  // nobody collected in time: the newest
  EXPECT_EQ(broker.stats().lost, 70u);
  // A worker that never answers: questions still go out, nothing grows.
  for (int i = 0; i < 1000; i++) {
    broker.ask({}, {}, numbered(10));
    ASSERT_TRUE(broker.take());
  }
  EXPECT_EQ(broker.stats().lost, 70u + 10000 - 50);
}

TEST(BrokeredVisit, LateAnswersMakeTheSamePictureAtRest) {
  BrokeredVisit late;
  Visit prompt;
  late.visit.room.noisy = prompt.room.noisy = false;
  for (int i = 0; i < 400; i++) {
    late.step(hall());
    prompt.step(hall(), 700);
  }
  Frame truth = render_room(prompt.room, hall(), 256);
  // FLIP judges as the eye does: a single pixel at an edge may be half of the sum of squares over
  // the reference. Late answers are none of the samples that correct a picture at rest, which waits
  // for its own.
  EXPECT_LT(flip(late.visit.frame, truth), 1.1 * flip(prompt.frame, truth));
  EXPECT_LT(flip(late.visit.frame, truth), 0.033);
}

TEST(BrokeredVisit, AnswersAFewFramesLateInAnyOrderLandInTheRightPlaceWhileWalking) {
  BrokeredVisit prompt, late;
  for (int i = 0; i < 90; i++) {
    View view = hall(-2 + 0.02f * float(i));
    prompt.step(view);
    late.begin_picture(view);
    late.take_all();
    std::rotate(late.taken.begin(), late.taken.begin() + ptrdiff_t(late.taken.size() / 3),
                late.taken.end());
    late.answer_taken(std::min<size_t>(20, late.taken.size()));  // the others stay two frames or so
  }
  EXPECT_GT(late.landed, 500);
  EXPECT_LT(late.wrong(), prompt.wrong() + 0.02f);
  EXPECT_GT(late.visit.cache.stats().reprojected, 0.9f * prompt.visit.cache.stats().reprojected);
}

TEST(BrokeredVisit, AnswersAfterATeleportLandWhereTheyWereSeen) {
  BrokeredVisit v;
  for (int i = 0; i < 30; i++) v.step(hall());
  v.begin_picture(hall());
  v.take_all();
  View other = look_at(vec3(2, 1.5f, -3), vec3(3.9f, 1.4f, -3), 60, 160, 90);
  v.begin_picture(other);
  v.answer_taken();  // the answers are to the view before
  for (int i = 0; i < 8; i++) v.step(other);
  EXPECT_LT(v.wrong(), 0.1f);
  v.step(hall());  // and back: what was late is there
  EXPECT_LT(v.wrong(), 0.1f);
}

TEST(BrokeredVisit, AnswersAfterAResizeLandToo) {
  BrokeredVisit v;
  v.begin_picture(hall());
  v.take_all();
  v.begin_picture(hall(-1, 64, 36));  // pixels of the questions lie outside now
  v.answer_taken();
  v.budget = 0;
  v.step(hall(-1, 64, 36));
  EXPECT_EQ(v.landed, 700);
  EXPECT_GT(v.visit.cache.stats().reprojected, 0.15);
  EXPECT_LT(v.wrong(), 0.2f);
}

TEST(BrokeredVisit, AfterAnotherExhibitNothingOfTheOldOneArrives) {
  BrokeredVisit v;
  v.step(hall());
  v.begin_picture(hall());
  v.take_all();
  v.visit.cache.clear();
  v.broker.forget();
  v.answer_taken();
  v.budget = 0;
  v.step(hall());
  EXPECT_EQ(v.landed, 0);
  EXPECT_EQ(v.visit.cache.stats().points, 0);
}

TEST(BrokeredVisit, AWorkerThatNeverAnswersCostsItsShareOnly) {
  BrokeredVisit v;
  for (int i = 0; i < 200; i++) {
    v.begin_picture(hall(-2 + 0.005f * float(i)));
    v.take_all();
    for (size_t k = 0; k < v.taken.size(); k += 2) v.taken[k].requests.clear();  // gone
    std::erase_if(v.taken, [](const Piece& piece) { return piece.requests.empty(); });
    v.answer_taken();
  }
  EXPECT_NEAR(v.landed, 350, 64);
  EXPECT_LT(v.wrong(), 0.06f);
}

// A figure's triangle before a wall; its answers come when it has moved on.
// A grey triangle that may move before a wall, as the world is now.
Sample trace_figure(const World& world, const Request& request) {
  Hit hit = world.intersect(request.ray);
  vec3 d = request.ray.direction;
  Sample sample{.position = d * (hit.valid() ? hit.t : 5 / -d.z),
                .normal = vec3(0, 0, 1),
                .object = hit.valid() ? 7u : 1u};
  sample.albedo = sample.smooth = vec3(0.5f);
  sample.flags = sample_hit;
  if (!hit.valid()) return sample;
  sample.flags |= sample_moving;
  sample.instance = hit.instance, sample.triangle = hit.triangle;
  sample.barycentric = hit.barycentric;
  return sample;
}

// Says whether a pixel of the mask, 64 x 48, or one of its neighbours is set.
bool is_near(const std::vector<uint8_t>& mask, int x, int y) {
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, 47); v++)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, 63); u++)
      if (mask[size_t(v * 64 + u)]) return true;
  return false;
}

TEST(BrokeredVisit, AnswersAboutAFigureThatHasMovedOnLandOnItsSkin) {
  Mesh mesh{.positions = {vec3(-1, -1, -3), vec3(1, -1, -3), vec3(0, 1, -3)},
            .normals = {vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1)},
            .triangles = {uvec3(0, 1, 2)}};
  Scene scene;
  scene.materials.resize(1);
  scene.objects = {"", "figure"};
  World world(scene, {mesh}, {1});
  View view = look_at(vec3(0), vec3(0, 0, -1), 60, 64, 48);
  RenderCache cache;
  Broker broker;
  Frame frame;
  std::vector<Request> requests;
  for (uint32_t pixel = 0; pixel < 64 * 48; pixel++) {
    Request request{.ray = view_ray(view, float(pixel % 64) + 0.5f, float(pixel / 64) + 0.5f),
                    .pixel = pixel};
    requests.push_back(request);
  }
  auto trace = [&](const Request& request) { return trace_figure(world, request); };
  cache.resize(64, 48);
  cache.move_points(world);
  cache.project(view);
  broker.ask(view, {}, requests);
  while (auto piece = broker.take()) {
    Answer answer{std::move(*piece), 1, {}};
    for (const Request& request : answer.piece.requests) answer.samples.push_back(trace(request));
    ASSERT_TRUE(broker.answer(std::move(answer)));
  }
  std::vector<uint8_t> was_there;
  for (const Request& request : requests) was_there.push_back(trace(request).object == 7);
  // Meanwhile it has gone 10 pixels to the right and turned away a little.
  std::vector<vec3> moved = mesh.positions, normals = mesh.normals;
  float pixel = 3 / (24 / std::tan(pi / 6));
  for (vec3& p : moved) p.x += 10 * pixel, p.z -= 0.1f * p.x;
  world.move(0, moved, normals);
  world.commit();
  cache.move_points(world);
  EXPECT_EQ(land(broker.collect(), world, 2, cache), 64 * 48);
  cache.project(view);
  cache.reconstruct(view, frame);
  // Pixels that the figure has uncovered are left out: nobody has seen them.
  std::vector<uint8_t> there, shown;
  for (uint32_t i = 0; i < requests.size(); i++) {
    there.push_back(trace(requests[i]).object == 7);
    shown.push_back(frame.object[i] == 7 && (there[i] || !was_there[i]));
  }
  EXPECT_GT(std::count(there.begin(), there.end(), 1), 300);
  // Samples of pixel centres lie beside them now: the outline may err by a pixel.
  for (int y = 0; y < 48; y++)
    for (int x = 0; x < 64; x++) {
      size_t i = size_t(y * 64 + x);
      EXPECT_TRUE(!shown[i] || is_near(there, x, y)) << "a ghost at " << x << " " << y;
      EXPECT_TRUE(!there[i] || is_near(shown, x, y)) << "missing at " << x << " " << y;
    }
}

}  // namespace
}  // namespace wellspring::test
