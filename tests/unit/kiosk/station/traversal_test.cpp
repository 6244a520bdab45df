// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/traversal.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace wellspring::test {
namespace {

// Sees one object, and counts its calls.
struct FakeSolver : Solver {
  std::function<Answer(int node, int child, ContextStore&)> answer;
  std::function<bool(int node)> still = [](int) { return true; };
  bool can_verify = true;
  std::vector<std::string> needed, given;
  int matches = 0, verifications = 0;
  std::vector<int> verified;

  Answer match(int node, int child, ContextStore& context) override {
    matches++;
    return answer(node, child, context);
  }
  bool verifies() const override { return can_verify; }
  bool verify(int node, ContextStore&) override {
    verifications++;
    verified.push_back(node);
    return still(node);
  }
  std::vector<std::string> needs() const override { return needed; }
  std::vector<std::string> gives() const override { return given; }
};

struct Builder {
  RecognitionTree tree;
  int model(const std::string& id) {
    tree.nodes.push_back({.name = id, .kind = NodeKind::model, .id = id});
    return int(tree.nodes.size()) - 1;
  }
  int search(const std::string& name, std::vector<int> children, const std::string& solver = "fake",
             const std::string& of_class = "") {
    tree.nodes.push_back({.name = name,
                          .kind = NodeKind::search,
                          .solvers = {{solver, {}}},
                          .children = std::move(children),
                          .id = of_class});
    return int(tree.nodes.size()) - 1;
  }
  const RecognitionTree& done(int root) {
    tree.root = root;
    tree.data.resize(tree.nodes.size());
    return tree;
  }
};

std::set<int> models_below(const RecognitionTree& tree, int at) {
  if (tree.nodes[size_t(at)].kind == NodeKind::model) return {at};
  std::set<int> out;
  for (const int child : tree.nodes[size_t(at)].children) out.merge(models_below(tree, child));
  return out;
}

// Balanced tree of 2^levels models; the fake knows which is before the camera.
struct Balanced {
  Builder builder;
  std::vector<int> models;
  FakeSolver fake;
  int seen = -1;  // node of a model
  const RecognitionTree* tree = nullptr;

  explicit Balanced(int levels) {
    for (int i = 0; i < 1 << levels; i++) models.push_back(builder.model(std::to_string(i)));
    std::vector<int> row = models;
    for (int level = 0; level < levels; level++) {
      std::vector<int> next;
      for (size_t i = 0; i < row.size(); i += 2)
        next.push_back(builder.search("s" + std::to_string(level) + "_" + std::to_string(i),
                                      {row[i], row[i + 1]}));
      row = next;
    }
    tree = &builder.done(row[0]);
    fake.answer = [this](int, int child, ContextStore&) {
      return Answer{models_below(*tree, child).contains(seen) ? Verdict::sure : Verdict::no};
    };
    fake.still = [this](int node) { return models_below(*tree, node).contains(seen); };
  }
};

TEST(Traversal, balanced_tree_needs_two_matches_a_level) {
  for (int levels = 1; levels <= 7; levels++) {
    Balanced b(levels);
    int most = 0;
    for (const int model : b.models) {
      Traversal walk(*b.tree, {{"fake", &b.fake}});
      ContextStore context;
      b.seen = model;
      const Recognition found = walk.step(context);
      EXPECT_EQ(found.node, model);
      most = std::max(most, found.matches);
    }
    EXPECT_EQ(most, 2 * levels);
  }
}

TEST(Traversal, flat_tree_needs_a_match_a_model) {
  Builder builder;
  std::vector<int> models;
  for (int i = 0; i < 64; i++) models.push_back(builder.model(std::to_string(i)));
  const RecognitionTree& tree = builder.done(builder.search("all", models));
  FakeSolver fake;
  fake.answer = [&](int, int child, ContextStore&) {
    return Answer{child == models[63] ? Verdict::sure : Verdict::no};
  };
  Traversal walk(tree, {{"fake", &fake}});
  ContextStore context;
  EXPECT_EQ(walk.step(context).matches, 64);
}

TEST(Traversal, what_is_held_up_most_is_found_soonest) {
  Balanced b(5);
  Traversal walk(*b.tree, {{"fake", &b.fake}});
  ContextStore context;
  auto matches = [&](int model) {
    b.seen = b.models[size_t(model)];
    walk.restart();
    const Recognition found = walk.step(context);
    EXPECT_EQ(found.node, b.models[size_t(model)]);
    return found.matches;
  };
  EXPECT_EQ(matches(31), 10);
  EXPECT_EQ(matches(31), 5) << "one match a level";
  for (int i = 0; i < 3; i++) EXPECT_EQ(matches(0), 6) << "the other half is tried first";
  EXPECT_EQ(matches(0), 5);
  for (int i = 0; i < 1000; i++) matches(31);
  for (int i = 0; i < 300; i++) matches(0);
  EXPECT_EQ(matches(0), 5) << "visitors of long ago count little";
}

TEST(Traversal, second_still_frame_calls_the_verifier_alone) {
  Balanced b(5);
  b.seen = b.models[21];
  Traversal walk(*b.tree, {{"fake", &b.fake}});
  ContextStore context;
  walk.step(context);
  b.fake.matches = 0;
  for (int frame = 0; frame < 10; frame++) {
    const Recognition found = walk.step(context);
    EXPECT_EQ(found.node, b.models[21]);
    EXPECT_TRUE(found.kept);
    EXPECT_EQ(found.verifications, 1);
  }
  EXPECT_EQ(b.fake.matches, 0);
  EXPECT_EQ(b.fake.verifications, 10);
}

TEST(Traversal, another_object_is_found_from_the_nearest_common_search) {
  Balanced b(5);
  b.seen = b.models[20];
  Traversal walk(*b.tree, {{"fake", &b.fake}});
  ContextStore context;
  walk.step(context);
  b.seen = b.models[21];  // its sibling
  Recognition found = walk.step(context);
  EXPECT_EQ(found.node, b.models[21]);
  EXPECT_EQ(found.back, 1);
  EXPECT_EQ(found.matches, 2);
  EXPECT_FALSE(found.kept);
  b.seen = b.models[0];  // as far away as there is
  found = walk.step(context);
  EXPECT_EQ(found.node, b.models[0]);
  EXPECT_EQ(found.back, 5);
  EXPECT_LE(found.matches, 2 * 5 + 2 * 5);
}

TEST(Traversal, link_skips_nodes_on_the_way_back) {
  Balanced b(5);
  for (const int model : b.models) b.builder.tree.nodes[size_t(model)].backtrack = b.tree->root;
  b.seen = b.models[31];
  Traversal walk(*b.tree, {{"fake", &b.fake}});
  ContextStore context;
  walk.step(context);
  b.seen = b.models[0];
  const Recognition found = walk.step(context);
  EXPECT_EQ(found.node, b.models[0]);
  EXPECT_EQ(found.back, 1);
  EXPECT_LE(found.matches, 2 * 5);
}

TEST(Traversal, nothing_is_seen_without_an_object) {
  Balanced b(5);
  Traversal walk(*b.tree, {{"fake", &b.fake}});
  ContextStore context;
  Recognition found = walk.step(context);
  EXPECT_EQ(found.node, -1);
  EXPECT_EQ(found.matches, 2);
  b.seen = b.models[3];
  walk.step(context);
  b.seen = -1;
  found = walk.step(context);
  EXPECT_EQ(found.node, -1);
  EXPECT_EQ(walk.path().size(), 1u);
}

TEST(Traversal, likely_children_are_tried_best_first_and_a_dead_end_is_left) {
  Builder builder;
  const int a = builder.model("a"), b = builder.model("b"), c = builder.model("c");
  const int left = builder.search("left", {a}), right = builder.search("right", {b});
  const RecognitionTree& tree = builder.done(builder.search("root", {left, right, c}));
  FakeSolver fake;
  std::vector<int> asked;
  fake.answer = [&](int, int child, ContextStore&) -> Answer {
    asked.push_back(child);
    if (child == left) return {Verdict::likely, 0.4};
    if (child == right) return {Verdict::likely, 0.9};
    return {child == a ? Verdict::sure : Verdict::no};
  };
  Traversal walk(tree, {{"fake", &fake}});
  ContextStore context;
  EXPECT_EQ(walk.step(context).node, a);
  EXPECT_EQ(asked, (std::vector<int>{left, right, c, b, a}));
}

// Two boxes that are equal but for a red stripe on one face.
struct Boxes {
  Builder builder;
  FakeSolver edges, stripe;
  std::string face = "front";
  bool red = true;
  int plain = 0, striped = 0, box = 0;
  const RecognitionTree* tree = nullptr;

  Boxes() {
    plain = builder.model("plain");
    striped = builder.model("striped");
    box = builder.search("box", {plain, striped}, "stripe", "a box");
    builder.tree.nodes[size_t(box)].hint = "turn";
    tree = &builder.done(builder.search("root", {box}, "edges"));
    edges.given = {"pose", "side"};
    edges.answer = [this](int, int, ContextStore& context) {
      context.set("side", face);
      return Answer{Verdict::sure};
    };
    stripe.can_verify = false;
    stripe.needed = {"side"};
    stripe.answer = [this](int, int child, ContextStore&) -> Answer {
      if (face != "back") return {Verdict::undecided};
      return {(child == striped) == red ? Verdict::sure : Verdict::no};
    };
  }
};

TEST(Traversal, class_and_hint_come_first_then_the_object) {
  Boxes boxes;
  Traversal walk(*boxes.tree, {{"edges", &boxes.edges}, {"stripe", &boxes.stripe}});
  ContextStore context;
  Recognition found = walk.step(context);
  EXPECT_EQ(found.node, boxes.box);
  EXPECT_EQ(found.hint, "turn");
  // The class is verified, and its children are tried anew; the first search is not.
  found = walk.step(context);
  EXPECT_EQ(found.node, boxes.box);
  EXPECT_TRUE(found.kept);
  EXPECT_EQ(boxes.edges.matches, 1);
  EXPECT_EQ(boxes.stripe.matches, 4);
  boxes.face = "back";
  found = walk.step(context);
  EXPECT_EQ(found.node, boxes.striped);
  EXPECT_EQ(found.hint, "");
  // A model is verified by the nearest solver that can.
  found = walk.step(context);
  EXPECT_EQ(found.node, boxes.striped);
  EXPECT_EQ(boxes.edges.verified.back(), boxes.box);
  EXPECT_EQ(boxes.stripe.matches, 6);
}

TEST(Traversal, what_the_verifier_lost_is_found_again_in_the_same_frame) {
  Boxes boxes;
  Traversal walk(*boxes.tree, {{"edges", &boxes.edges}, {"stripe", &boxes.stripe}});
  ContextStore context;
  boxes.face = "back";
  walk.step(context);
  boxes.edges.still = [](int) { return false; };
  const Recognition found = walk.step(context);
  EXPECT_EQ(found.node, boxes.striped);
  EXPECT_FALSE(found.kept);
}

TEST(Traversal, class_is_no_result_where_it_was_not_matched_again) {
  Boxes boxes;
  Traversal walk(*boxes.tree, {{"edges", &boxes.edges}, {"stripe", &boxes.stripe}});
  ContextStore context;
  boxes.face = "back";
  walk.step(context);
  boxes.edges.still = [](int) { return false; };
  boxes.edges.answer = [](int, int, ContextStore&) { return Answer{}; };
  const Recognition found = walk.step(context);
  EXPECT_EQ(found.node, -1);
  EXPECT_FALSE(context.has("side"));
}

// Figure 5 of the paper: one search needs the left side, another the right side.
struct Sides {
  Builder builder;
  FakeSolver body, left, right;
  std::string pose = "right";
  int wanted = 0;
  int one = 0, two = 0, three = 0;
  const RecognitionTree* tree = nullptr;

  explicit Sides(bool with_switch) {
    one = builder.model("one"), two = builder.model("two"), three = builder.model("three");
    // Either search tells one object from the rest, so that either can be first.
    const int right_last = builder.search("right last", {two, three}, "right", "thing");
    const int left_first = builder.search("left first", {one, right_last}, "left", "thing");
    const int left_last = builder.search("left last", {one, three}, "left", "thing");
    const int right_first = builder.search("right first", {two, left_last}, "right", "thing");
    for (const int at : {left_first, left_last}) builder.tree.nodes[size_t(at)].hint = "go left";
    for (const int at : {right_first, right_last}) builder.tree.nodes[size_t(at)].hint = "go right";
    int top = left_first;
    if (with_switch) {
      builder.tree.nodes.push_back({.name = "switch",
                                    .kind = NodeKind::context_switch,
                                    .children = {right_first, left_first},
                                    .cases = {{{.value = "side", .is = "right"}}, {}}});
      top = int(builder.tree.nodes.size()) - 1;
    }
    tree = &builder.done(builder.search("root", {top}, "body"));
    body.given = {"side"};
    body.answer = [this](int, int, ContextStore& context) {
      context.set("side", pose);
      return Answer{Verdict::sure};
    };
    auto sees = [this](FakeSolver& solver, const char* side) {
      solver.can_verify = false;
      solver.needed = {"side"};
      solver.answer = [this, side](int, int child, ContextStore& context) -> Answer {
        if (*context.get<std::string>("side") != side) return {Verdict::undecided};
        return {models_below(*tree, child).contains(wanted) ? Verdict::sure : Verdict::no};
      };
    };
    sees(left, "left");
    sees(right, "right");
  }
  Solvers solvers() { return {{"body", &body}, {"left", &left}, {"right", &right}}; }
};

TEST(Traversal, context_switch_asks_for_nothing_that_the_pose_need_not_have) {
  for (const bool with_switch : {false, true}) {
    Sides sides(with_switch);
    sides.wanted = sides.two;
    Traversal walk(*sides.tree, sides.solvers());
    ContextStore context;
    const Recognition found = walk.step(context);
    if (with_switch) {
      EXPECT_EQ(found.node, sides.two);
      EXPECT_EQ(found.hint, "");
    } else {
      EXPECT_EQ(found.hint, "go left");
    }
  }
}

TEST(Traversal, context_switch_never_asks_to_go_back) {
  Sides sides(true);
  sides.wanted = sides.three;  // both sides are needed
  Traversal walk(*sides.tree, sides.solvers());
  ContextStore context;
  Recognition found = walk.step(context);
  EXPECT_EQ(found.hint, "go left");
  sides.pose = "left";
  context.set("side", sides.pose);  // the verifier's
  found = walk.step(context);
  EXPECT_EQ(found.node, sides.three);
  // A model is verified as the node that the match was about: the switch.
  walk.step(context);
  EXPECT_EQ(sides.tree->nodes[size_t(sides.body.verified.back())].kind, NodeKind::context_switch);
}

TEST(Traversal, results_that_later_solvers_need_are_refreshed) {
  Builder builder;
  const int a = builder.model("a"), b = builder.model("b");
  const int pair = builder.search("pair", {a, b}, "twins", "pair");
  const int lit = builder.search("lit", {pair}, "light");
  const RecognitionTree& tree = builder.done(builder.search("root", {lit}, "body"));
  FakeSolver body, light, twins;
  body.given = {"pose"};
  light.can_verify = twins.can_verify = false;
  light.given = {"brightness"};
  twins.needed = {"pose", "brightness"};
  auto sure = [](int, int, ContextStore&) { return Answer{Verdict::sure}; };
  body.answer = [](int, int, ContextStore& context) {
    context.set("pose", mat3(1));
    return Answer{Verdict::sure};
  };
  light.answer = [](int, int, ContextStore& context) {
    context.set("brightness", 0.5);
    return Answer{Verdict::sure};
  };
  twins.answer = [](int, int, ContextStore&) { return Answer{Verdict::undecided, 0, "closer"}; };
  Traversal walk(tree, {{"body", &body}, {"light", &light}, {"twins", &twins}});
  ContextStore context;
  EXPECT_EQ(walk.step(context).hint, "closer");
  const Recognition found = walk.step(context);
  EXPECT_EQ(found.refreshed, 1);
  EXPECT_EQ(light.matches, 2);
  EXPECT_EQ(body.matches, 1);
  twins.answer = sure;
  EXPECT_EQ(walk.step(context).node, a);
  walk.step(context);
  EXPECT_EQ(light.matches, 3);  // nothing below a model needs anything
}

TEST(Traversal, solver_is_chosen_by_context) {
  Builder builder;
  const int a = builder.model("a"), b = builder.model("b");
  const int root = builder.search("root", {a, b}, "day");
  builder.tree.nodes[size_t(root)].solvers.push_back(
      {"night", {{.value = "light", .most = 0.2, .quality = 0.5}}});
  const RecognitionTree& tree = builder.done(root);
  FakeSolver day, night;
  day.answer = [&](int, int child, ContextStore&) {
    return Answer{child == a ? Verdict::sure : Verdict::no};
  };
  night.answer = [&](int, int child, ContextStore&) {
    return Answer{child == b ? Verdict::sure : Verdict::no};
  };
  Traversal walk(tree, {{"day", &day}, {"night", &night}});
  ContextStore context;
  auto found = [&] {
    walk.restart();
    return walk.step(context).node;
  };
  EXPECT_EQ(found(), a);
  context.set("light", 0.1, 1);
  EXPECT_EQ(found(), b);
  context.set("light", 0.1, 0.2);  // a value that is hardly known
  EXPECT_EQ(found(), a);
  context.set("light", 0.9, 1);
  EXPECT_EQ(found(), a);
}

TEST(Traversal, solver_that_is_not_there_is_named) {
  Builder builder;
  const int a = builder.model("a");
  const RecognitionTree& tree = builder.done(builder.search("root", {a}, "sonar"));
  try {
    Traversal walk(tree, {});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("sonar"), std::string::npos);
  }
}

}  // namespace
}  // namespace wellspring::test
