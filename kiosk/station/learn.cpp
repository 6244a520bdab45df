// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/learn.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/load_error.h"
#include "kiosk/station/learn_twins.h"

namespace wellspring::kiosk {
namespace {

constexpr size_t least_features = 40;  // a side with fewer has no texture
constexpr float told = 0.3f;           // how far marks of two objects have to be apart

const std::map<std::string, Texts>& usual_hints() {
  static const std::map<std::string, Texts> hints{
      {"turn",
       {{"en", "Turn it over, please."},
        {"de", "Bitte umdrehen."},
        {"fr", "Retournez-le, s'il vous plaît."},
        {"es", "Dele la vuelta, por favor."},
        {"it", "Lo giri, per favore."}}},
      {"closer",
       {{"en", "A little closer, please."},
        {"de", "Bitte etwas näher."},
        {"fr", "Un peu plus près, s'il vous plaît."},
        {"es", "Un poco más cerca, por favor."},
        {"it", "Un po' più vicino, per favore."}}},
      {"light",
       {{"en", "A little more towards the light, please."},
        {"de", "Bitte etwas mehr ins Licht."},
        {"fr", "Un peu plus vers la lumière, s'il vous plaît."},
        {"es", "Un poco más hacia la luz, por favor."},
        {"it", "Un po' più verso la luce, per favore."}}},
      {"tilt",
       {{"en", "It shines. Tilt it a little, please."},
        {"de", "Es spiegelt. Bitte etwas kippen."},
        {"fr", "Il brille. Inclinez-le un peu, s'il vous plaît."},
        {"es", "Brilla. Inclínelo un poco, por favor."},
        {"it", "Brilla. Lo inclini un po', per favore."}}},
      {"whole",
       {{"en", "Show all of it, please."},
        {"de", "Bitte ganz zeigen."},
        {"fr", "Montrez-le en entier, s'il vous plaît."},
        {"es", "Muéstrelo entero, por favor."},
        {"it", "Lo mostri per intero, per favore."}}},
      {"still",
       {{"en", "Hold it still, please."},
        {"de", "Bitte ruhig halten."},
        {"fr", "Tenez-le immobile, s'il vous plaît."},
        {"es", "Manténgalo quieto, por favor."},
        {"it", "Lo tenga fermo, per favore."}}}};
  return hints;
}

// Finds the one who stands for everybody that is equal to `at`.
size_t find_first(std::vector<size_t>& first, size_t at) {
  while (first[at] != at) at = first[at] = first[first[at]];
  return at;
}

class Learner {
 public:
  Learner(std::vector<LearnObject> objects, const std::string& folder)
      : objects_(std::move(objects)), folder_(folder) {}

  Learnt learn() {
    tree().hints = usual_hints();
    for (const LearnObject& object : objects_)
      for (const auto& [name, texts] : object.hints) tree().hints[name] = texts;
    std::vector<int> tops, codes;
    for (size_t i = 0; i < objects_.size(); i++) {
      views_.emplace_back();
      const LearnObject& object = objects_[i];
      for (const Photo& photo : object.photos) views_[i].push_back(make_view(object, photo));
      if (!object.code.empty()) codes.push_back(code_leaf(i));
      else if (is_textured(i)) textured_.push_back(i);
      else if (box_of(object).x > 0) boxes_.push_back(i);
      else plain_.push_back(i);
    }
    find_classes();
    if (!items_.empty()) tops.push_back(divide(items_));
    if (!codes.empty()) tops.push_back(search("codes", "code", codes));
    if (!boxes_.empty()) tops.push_back(boxes());
    if (!plain_.empty()) tops.push_back(outlines());
    if (tops.size() == 1 && tree().nodes[size_t(tops[0])].kind == NodeKind::search &&
        tree().nodes[size_t(tops[0])].id.empty())
      tree().root = tops[0];
    else if (tops.size() == 1 && codes.empty() && plain_.empty() && boxes_.empty())
      tree().root = search("all", "pattern", tops);
    else tree().root = search("all", "always", tops);
    // The way back from a group that only divides leads to the root at once.
    for (size_t n = 0; n < tree().nodes.size(); n++)
      if (RecognitionNode& node = tree().nodes[n];
          node.kind == NodeKind::search && node.id.empty() && int(n) != tree().root)
        node.backtrack = tree().root;
    return std::move(out_);
  }

 private:
  RecognitionTree& tree() { return out_.tree; }
  std::string place(size_t object) const { return folder_ + "/" + objects_[object].id; }

  int add(RecognitionNode node) {
    tree().nodes.push_back(std::move(node));
    tree().data.emplace_back();
    return int(tree().nodes.size()) - 1;
  }
  int search(const std::string& name, const std::string& solver, std::vector<int> children) {
    RecognitionNode node;
    node.name = "search: " + name;
    node.kind = NodeKind::search;
    node.solvers = {{solver, {}}};
    node.children = std::move(children);
    return add(std::move(node));
  }
  int leaf(size_t object) {
    RecognitionNode node;
    node.name = node.id = objects_[object].id;
    node.title = objects_[object].title;
    node.text = objects_[object].text;
    return add(std::move(node));
  }
  int code_leaf(size_t object) {
    for (size_t other = 0; other < object; other++)
      if (objects_[other].code == objects_[object].code)
        throw LoadError(place(object), "", "has the code of " + objects_[other].id);
    const int at = leaf(object);
    tree().data[size_t(at)].code = objects_[object].code;
    return at;
  }

  static View make_view(const LearnObject& object, const Photo& photo) {
    vec2 size(0);
    for (const std::string& name : {std::string(), photo.side})
      if (const auto found = object.sizes.find(name); found != object.sizes.end())
        size = found->second;
    return learn_view(photo, size);
  }
  bool is_textured(size_t object) {
    auto& views = views_[object];
    const bool any = std::ranges::any_of(
        views, [](const View& view) { return view.features.size() >= least_features; });
    if (!any) return false;
    for (View& view : views)
      if (view.features.size() < least_features) {
        out_.notes.push_back(place(object) + ": side '" + view.side +
                             "' has too little texture and is left out");
        view.features.clear();
      }
    return true;
  }

  // Makes leaves, and classes of what is nearly equal.
  void find_classes() {
    std::vector<size_t> first(textured_.size());
    std::iota(first.begin(), first.end(), size_t(0));
    for (size_t a = 0; a < first.size(); a++)
      for (size_t b = 0; b < a; b++)
        if (find_first(first, a) != find_first(first, b) && are_alike(textured_[b], textured_[a]))
          first[find_first(first, a)] = find_first(first, b);
    for (size_t a = 0; a < first.size(); a++) {
      if (find_first(first, a) != a) continue;
      std::vector<size_t> members;
      for (size_t b = 0; b < first.size(); b++)
        if (find_first(first, b) == a) members.push_back(textured_[b]);
      if (members.size() > 1 && make_class(members)) continue;
      for (const size_t object : members) {
        items_.push_back(leaf(object));
        for (const View& view : views_[object])
          if (!view.features.empty()) tree().data[size_t(items_.back())].views.push_back(view);
      }
    }
  }
  bool are_alike(size_t a, size_t b) const {
    for (const View& one : views_[a])
      for (const View& other : views_[b])
        if (align_views(one, other)) return true;
    return false;
  }

  // Finds the sides that all members have. It marks them in `taken`, by member and view.
  std::vector<SharedSide> find_sides(const std::vector<size_t>& members,
                                     std::vector<std::vector<char>>& taken) const {
    std::vector<SharedSide> sides;
    for (size_t v = 0; v < views_[members[0]].size(); v++) {
      const View& view = views_[members[0]][v];
      if (view.features.empty()) continue;
      SharedSide side{view, {}};
      std::vector<std::pair<size_t, size_t>> used{{0, v}};
      side.pictures.push_back(
          shrink_photo(objects_[members[0]].photos[v], view.width, view.height));
      for (size_t m = 1; m < members.size(); m++)
        for (size_t k = 0; k < views_[members[m]].size(); k++) {
          const View& other = views_[members[m]][k];
          const auto pose = taken[m][k] ? std::nullopt : align_views(view, other);
          if (!pose) continue;
          side.pictures.push_back(align_photo(objects_[members[m]].photos[k], other, *pose, view));
          used.emplace_back(m, k);
          break;
        }
      if (side.pictures.size() < members.size()) continue;
      for (const auto& [m, k] : used) taken[m][k] = 1;
      // The light is judged by what all of them look like together.
      vec3 mean(0);
      for (const auto& picture : side.pictures)
        for (size_t i = 0; i + 2 < picture.size(); i += 3)
          mean += vec3(picture[i], picture[i + 1], picture[i + 2]) /
                  float(picture.size() / 3 * side.pictures.size());
      side.view.mean = mean;
      sides.push_back(std::move(side));
    }
    return sides;
  }

  // Names a class by what object.json says, else by its members.
  void name_class(const std::vector<size_t>& members, RecognitionNode& node) const {
    for (const size_t object : members) {
      node.id += (node.id.empty() ? "" : "+") + objects_[object].id;
      if (node.title.empty()) node.title = objects_[object].of_class;
    }
    if (node.id.size() > 100) node.id = objects_[members[0]].id + "+";
    if (!node.title.empty() || members.size() > 2) return;
    for (const auto& [language, word] : {std::pair("en", " or "), {"de", " oder "}}) {
      const auto& a = objects_[members[0]].title;
      const auto& b = objects_[members[1]].title;
      if (a.contains(language) && b.contains(language))
        node.title[language] = a.at(language) + word + b.at(language);
    }
  }

  bool make_class(const std::vector<size_t>& members) {
    std::vector<std::vector<char>> taken;
    for (const size_t object : members) taken.emplace_back(views_[object].size(), 0);
    const auto sides = find_sides(members, taken);
    if (sides.empty()) {
      out_.notes.push_back(place(members[0]) +
                           ": some objects are like it, but no side is like that of all of them");
      return false;
    }
    const ClassMarks marks = choose_marks(sides, members.size());
    std::vector<int> leaves;
    std::vector<char> has_own(members.size(), 0);
    for (size_t m = 0; m < members.size(); m++) {
      const int at = leaf(members[m]);
      leaves.push_back(at);
      NodeData& data = tree().data[size_t(at)];
      data.marks = marks.marks[m];
      for (size_t v = 0; v < views_[members[m]].size(); v++)
        if (!taken[m][v] && !views_[members[m]][v].features.empty())
          data.views.push_back(views_[members[m]][v]), has_own[m] = 1;
    }
    for (size_t a = 0; a < members.size(); a++)
      for (size_t b = 0; b < a; b++)
        if (marks.apart[a * members.size() + b] < told && !(has_own[a] && has_own[b]))
          throw LoadError(place(members[a]), "",
                          "cannot be told from " + objects_[members[b]].id +
                              ": photograph a side in which they differ, or put codes on them");
    const int at =
        search(objects_[members[0]].id, marks.kind == MarkKind::edges ? "twins" : "colors", leaves);
    RecognitionNode& node = tree().nodes[size_t(at)];
    name_class(members, node);
    node.hint = "turn";
    // A side that one object alone has tells it by itself.
    if (std::ranges::any_of(has_own, [](char own) { return own; }))
      node.solvers.push_back({"pattern", {{.value = "shared", .is = "no"}}});
    for (const SharedSide& side : sides) tree().data[size_t(at)].views.push_back(side.view);
    items_.push_back(at);
    return true;
  }

  std::vector<Feature> sample_of(int item) {
    std::vector<Feature> out;
    for (const View& view : tree().data[size_t(item)].views)
      out.insert(out.end(), view.features.begin(),
                 view.features.begin() + long(std::min<size_t>(50, view.features.size())));
    return out;
  }

  // Divides items into two halves of what is alike, and these likewise.
  int divide(std::vector<int> items) {
    if (items.size() == 1) return items[0];
    std::vector<std::vector<Feature>> samples;
    for (const int item : items) samples.push_back(sample_of(item));
    const size_t n = items.size();
    std::vector<float> alike(n * n, 1e9f);
    for (size_t a = 0; a < n; a++)
      for (size_t b = 0; b < a; b++)
        alike[a * n + b] = alike[b * n + a] = float(pair_features(samples[a], samples[b]).size());
    return divide(items, alike, n, [n] {
      std::vector<size_t> all(n);
      std::iota(all.begin(), all.end(), size_t(0));
      return all;
    }());
  }
  int divide(const std::vector<int>& items, const std::vector<float>& alike, size_t n,
             std::vector<size_t> part) {
    if (part.size() == 1) return items[part[0]];
    auto between = [&](size_t a, size_t b) { return alike[a * n + b]; };
    // Two that are least alike begin the halves.
    size_t left = part[0], right = part[1];
    for (const size_t a : part)
      for (const size_t b : part)
        if (a < b && between(a, b) < between(left, right)) left = a, right = b;
    std::ranges::stable_sort(part, {}, [&](size_t at) {
      if (at == left) return -1e9f;
      return at == right ? 1e9f : between(at, right) - between(at, left);
    });
    const size_t half = (part.size() + 1) / 2;
    const int a = divide(items, alike, n, {part.begin(), part.begin() + long(half)});
    const int b = divide(items, alike, n, {part.begin() + long(half), part.end()});
    return search(std::to_string(tree().nodes.size()), "pattern", {a, b});
  }

  // Returns width, height and depth of a box, if the sizes of two of its sides that meet say them;
  // else 0.
  static vec3 box_of(const LearnObject& object) {
    auto size = [&](const char* side) {
      const auto found = object.sizes.find(side);
      return found == object.sizes.end() ? vec2(0) : found->second;
    };
    const vec2 front = size("front").x > 0 ? size("front") : size("back");
    const float depth =
        std::max({size("left").x, size("right").x, size("top").y, size("bottom").y});
    return front.x > 0 && depth > 0 ? vec3(front, depth) : vec3(0);
  }
  // Makes a search for boxes without texture: one for each size, then by colours.
  int boxes() {
    std::vector<int> shapes;
    std::vector<char> done(boxes_.size(), 0);
    for (size_t a = 0; a < boxes_.size(); a++) {
      if (done[a]) continue;
      const vec3 box = box_of(objects_[boxes_[a]]);
      std::vector<size_t> members;
      for (size_t b = a; b < boxes_.size(); b++) {
        const vec3 ratio = glm::abs(box_of(objects_[boxes_[b]]) / box - vec3(1));
        if (done[b] || max_component(ratio) > 0.06f) continue;
        done[b] = 1;
        members.push_back(boxes_[b]);
      }
      shapes.push_back(members.size() == 1 ? leaf(members[0]) : shape(members));
      tree().data[size_t(shapes.back())].box = box;
    }
    return search("boxes", "box", shapes);
  }

  // Makes searches for objects without texture: one for each size, then by colours.
  int outlines() {
    std::vector<int> shapes;
    std::vector<char> done(plain_.size(), 0);
    for (size_t a = 0; a < plain_.size(); a++) {
      if (done[a]) continue;
      const View& view = views_[plain_[a]][0];
      if (view.size.x <= 0)
        throw LoadError(
            place(plain_[a]), "",
            "has too little texture; give its size in object.json, or put a code on it");
      std::vector<size_t> members;
      for (size_t b = a; b < plain_.size(); b++) {
        const vec2 ratio = views_[plain_[b]][0].size / view.size;
        if (done[b] || !(std::abs(ratio.x - 1) < 0.04f && std::abs(ratio.y - 1) < 0.04f)) continue;
        done[b] = 1;
        members.push_back(plain_[b]);
      }
      shapes.push_back(shape(members));
    }
    return search("outlines", "outline", shapes);
  }
  int shape(const std::vector<size_t>& members) {
    const View& view = views_[members[0]][0];
    std::vector<int> leaves;
    for (const size_t object : members) {
      const auto bgr = shrink_photo(objects_[object].photos[0], view.width, view.height);
      std::vector<Mark> marks;
      for (int i = 0; i < 9; i++) {
        const int w = view.width / 5, h = view.height / 5;
        marks.push_back(cut_mark(bgr, view, 0, (2 * (i % 3) + 1) * view.width / 6 - w / 2,
                                 (2 * (i / 3) + 1) * view.height / 6 - h / 2, w, h));
      }
      float most = 0;
      for (const Mark& one : marks)
        most = std::max(most, marks_apart(MarkKind::colors, one, marks[0]));
      if (most < told)
        throw LoadError(place(object), "",
                        "has neither texture nor several colours; put a code on it");
      for (size_t k = 0; k < leaves.size(); k++) {
        float differs = 0;
        for (size_t i = 0; i < marks.size(); i++)
          differs = std::max(differs, marks_apart(MarkKind::colors, marks[i],
                                                  tree().data[size_t(leaves[k])].marks[i]));
        if (differs < told)
          throw LoadError(place(object), "", "has the colours of " + objects_[members[k]].id);
      }
      leaves.push_back(leaf(object));
      tree().data[size_t(leaves.back())].marks = std::move(marks);
    }
    const int at = search("shape of " + objects_[members[0]].id, "colors", leaves);
    View only = view;
    only.features.clear();
    only.gray.clear();
    only.mean = vec3(0);  // members have colours of their own, so light is not judged by them
    tree().data[size_t(at)].views.push_back(std::move(only));
    return at;
  }

  std::vector<LearnObject> objects_;
  std::string folder_;
  std::vector<std::vector<View>> views_;          // by object and photograph
  std::vector<size_t> textured_, boxes_, plain_;  // objects
  std::vector<int> items_;                        // nodes that pattern solvers divide
  Learnt out_;
};

}  // namespace

Learnt learn_tree(std::vector<LearnObject> objects, const std::string& folder) {
  return Learner(std::move(objects), folder).learn();
}

}  // namespace wellspring::kiosk
