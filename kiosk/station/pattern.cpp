// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/pattern.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wellspring::kiosk {
namespace {

constexpr int pool_size = 2000;  // features of a group
constexpr size_t most_of_pool = 8000;
constexpr int least_of_view = 24, most_of_view = 120;
constexpr int group_bits = 60;
constexpr float group_clearly = 0.85f;
constexpr int likely_votes = 8, sure_votes = 45;
constexpr int sure_inliers = 14;
constexpr float sure_agreement = 0.5f;

}  // namespace

PatternSolver::PatternSolver(const RecognitionTree& tree, Sight& sight)
    : tree_(tree), sight_(sight), views_(tree.nodes.size()), pools_(tree.nodes.size()) {
  std::vector<char> known(tree.nodes.size(), 0);
  auto gather = [&](auto& self, int at) -> void {
    if (std::exchange(known[size_t(at)], 1)) return;
    auto& out = views_[size_t(at)];
    for (size_t i = 0; i < tree.data[size_t(at)].views.size(); i++) out.push_back({at, int(i)});
    for (const int child : tree.nodes[size_t(at)].children) {
      self(self, child);
      const auto& below = views_[size_t(child)];
      out.insert(out.end(), below.begin(), below.end());
    }
    // A node may be reached in several ways.
    std::ranges::sort(out, {}, [](const OwnedView& one) { return std::pair(one.node, one.index); });
    const auto same = std::ranges::unique(out, [](const OwnedView& a, const OwnedView& b) {
      return a.node == b.node && a.index == b.index;
    });
    out.erase(same.begin(), same.end());
  };
  gather(gather, tree.root);
  for (size_t n = 0; n < tree.nodes.size(); n++) {
    const RecognitionNode& node = tree.nodes[n];
    if (node.kind == NodeKind::model || !node.id.empty() || views_[n].empty()) continue;
    Pool& pool = pools_[n];
    pool.views = int(views_[n].size());
    const int each = std::clamp(pool_size / pool.views, least_of_view, most_of_view);
    for (size_t v = 0; v < views_[n].size(); v++) {
      const auto [owner, index] = views_[n][v];
      const auto& features = tree.data[size_t(owner)].views[size_t(index)].features;
      if (pool.features.size() >= most_of_pool) break;
      const size_t count = std::min(size_t(each), features.size());
      pool.features.insert(pool.features.end(), features.begin(), features.begin() + long(count));
      pool.owners.insert(pool.owners.end(), count, int(v));
    }
  }
}

Answer PatternSolver::match_group(int child) {
  const Pool& pool = pools_[size_t(child)];
  std::vector<int> votes(size_t(pool.views), 0);
  for (const Feature& feature : features_of(sight_)) {
    int best = -1, apart = 257, second = 257;  // the second is of another view
    for (size_t i = 0; i < pool.features.size(); i++) {
      const int now = bits_apart(feature.bits, pool.features[i].bits);
      if (now >= second) continue;
      const int owner = pool.owners[i];
      if (now < apart) {
        if (owner != best) second = apart;
        apart = now, best = owner;
      } else if (owner != best) {
        second = now;
      }
    }
    if (best >= 0 && apart <= group_bits && float(apart) < group_clearly * float(second))
      votes[size_t(best)]++;
  }
  const int most = votes.empty() ? 0 : *std::ranges::max_element(votes);
  return {most >= sure_votes     ? Verdict::sure
          : most >= likely_votes ? Verdict::likely
                                 : Verdict::no,
          double(most)};
}

void PatternSolver::tell(int node, ContextStore& context, const mat3& pose) {
  const bool shared = owner_.node == node;
  const float share = area_of(corners_of(pose, *view_)) / float(view_->width * view_->height);
  context.set(pose_value, pose);
  context.set(side_value, view_->side);
  context.set(view_value, shared ? double(owner_.index) : -1.0);
  context.set(scale_value, double(std::sqrt(std::max(share, 0.f))));
  context.set(shared_value, std::string(shared ? "yes" : "no"));
  context.forget(turns_value);
}

Answer PatternSolver::match_views(int child, ContextStore& context) {
  const std::vector<Feature>& seen = features_of(sight_);
  Answer best;
  mat3 best_pose(1);
  for (const OwnedView& one : views_[size_t(child)]) {
    const View& view = tree_.data[size_t(one.node)].views[size_t(one.index)];
    const auto pairs = pair_features(view.features, seen);
    if (pairs.size() < size_t(sure_inliers)) continue;
    std::vector<vec2> from, to;
    for (const auto& [a, b] : pairs)
      from.push_back(view.features[size_t(a)].place), to.push_back(seen[size_t(b)].place);
    const auto found = fit_pose(from, to, 3);
    if (!found || found->inliers < sure_inliers || found->inliers <= best.score) continue;
    if (!is_sound(found->pose, view, sight_.frame->width, sight_.frame->height)) continue;
    mat3 pose = found->pose;
    float agrees = agreement(sight_, view, pose);
    // The homography of few features is refined by the picture itself.
    if (const auto finer = follow_pose(sight_, view, pose))
      if (const float now = agreement(sight_, view, *finer); now >= agrees)
        pose = *finer, agrees = now;
    if (agrees < sure_agreement) continue;
    best = {Verdict::sure, double(found->inliers)};
    best_pose = pose;
    view_ = &view;
    owner_ = one;
  }
  if (best.verdict == Verdict::sure) tell(child, context, best_pose);
  return best;
}

Answer PatternSolver::match(int, int child, ContextStore& context) {
  return pools_[size_t(child)].features.empty() ? match_views(child, context) : match_group(child);
}

bool PatternSolver::verify(int node, ContextStore& context) {
  const mat3* before = context.get<mat3>(pose_value);
  const bool below = std::ranges::any_of(views_[size_t(node)], [&](const OwnedView& one) {
    return one.node == owner_.node && one.index == owner_.index;
  });
  if (!view_ || !before || !below) return false;
  const auto pose = follow_pose(sight_, *view_, *before);
  if (!pose) return false;
  tell(node, context, *pose);
  return true;
}

}  // namespace wellspring::kiosk
