// SPDX-License-Identifier: Apache-2.0
// Turns animations of a glTF file into Motions: turns of nodes about their own axes become turns
// about the axes of humanoid space.
#include <algorithm>
#include <cmath>

#include "avatar/load/gltf_figure.h"
#include "gltf/animation.h"

namespace wellspring::avatar {
namespace {

TrackCurve curve_of(gltf::Curve curve) {
  return curve == gltf::Curve::step     ? TrackCurve::step
         : curve == gltf::Curve::linear ? TrackCurve::linear
                                        : TrackCurve::cubic;
}

int displacer_index(Motion& motion, const std::string& name) {
  auto found = std::find(motion.displacers.begin(), motion.displacers.end(), name);
  if (found != motion.displacers.end()) return int(found - motion.displacers.begin());
  motion.displacers.push_back(name);
  return int(motion.displacers.size()) - 1;
}

struct Converter {
  const GltfFigure& figure;
  Motion& motion;

  void add_turn(const gltf::Track& track, int joint) {
    glm::dquat h = gltf_rotation(figure.to_humanoid);
    int parent = figure.nodes[track.node].parent;
    glm::dquat before = parent < 0 ? h : h * gltf_rotation(figure.rest[size_t(parent)]);
    glm::dquat behind = glm::conjugate(h * gltf_rotation(figure.rest[track.node]));
    MotionTrack made{TrackKind::rotation, curve_of(track.curve), joint,
                     track.times,         track.values,          {}};
    for (size_t i = 0; i + 3 < made.values.size(); i += 4) {  // linear in q: right for tangents too
      float* v = made.values.data() + i;
      quat q(before * glm::dquat(double(v[3]), double(v[0]), double(v[1]), double(v[2])) * behind);
      v[0] = q.x, v[1] = q.y, v[2] = q.z, v[3] = q.w;
    }
    motion.tracks.push_back(std::move(made));
  }

  void add_way(const gltf::Track& track, int joint) {
    int parent = figure.nodes[track.node].parent;
    dmat4 above = parent < 0 ? dmat4(1) : figure.rest[size_t(parent)];
    dvec3 rest((glm::inverse(above) * figure.rest[track.node])[3]);
    glm::dmat3 to_humanoid(figure.to_humanoid * above);
    MotionTrack made{
        TrackKind::translation, curve_of(track.curve), joint, track.times, track.values, {}};
    bool cubic = track.curve == gltf::Curve::cubic, moves = false;
    for (size_t k = 0; k + 2 < made.values.size(); k += 3) {
      float* v = made.values.data() + k;
      bool tangent = cubic && k / 3 % 3 != 1;
      dvec3 way = to_humanoid * (dvec3(v[0], v[1], v[2]) - (tangent ? dvec3(0) : rest));
      moves = moves || glm::length(way) > 1e-6;
      for (int c = 0; c < 3; c++) v[c] = float(way[c]);
    }
    if (moves) motion.tracks.push_back(std::move(made));
  }

  void add_size(const gltf::Track& track, int joint) {
    dvec3 rest = figure.nodes[track.node].scale;
    MotionTrack made{TrackKind::scale, curve_of(track.curve), joint, track.times, track.values, {}};
    made.frame = quat(gltf_rotation(figure.to_humanoid) * gltf_rotation(figure.rest[track.node]));
    bool changes = false;
    bool cubic = track.curve == gltf::Curve::cubic;
    for (size_t k = 0; k < made.values.size(); k++) {
      double was = rest[int(k % 3)];
      made.values[k] = std::abs(was) > 1e-9 ? float(double(made.values[k]) / was) : 1.0f;
      bool tangent = cubic && k / 3 % 3 != 1;
      changes = changes || std::abs(made.values[k] - (tangent ? 0 : 1)) > 1e-4f;
    }
    if (changes) motion.tracks.push_back(std::move(made));
  }

  void add_weights(const gltf::Track& track) {
    for (size_t t = 0; t < track.width; t++) {
      auto move = figure.moves.find({track.node, t});
      if (move == figure.moves.end()) continue;
      double rest = figure.nodes[track.node].weights[t];
      MotionTrack made{TrackKind::displacer, curve_of(track.curve), 0, track.times, {}, {}};
      made.target = displacer_index(motion, move->second.name);
      bool cubic = track.curve == gltf::Curve::cubic;
      for (size_t k = 0; k * track.width + t < track.values.size(); k++) {
        bool tangent = cubic && k % 3 != 1;
        made.values.push_back(track.values[k * track.width + t] - (tangent ? 0.0f : float(rest)));
      }
      motion.tracks.push_back(std::move(made));
    }
  }

  // Reads an expression's weight, which VRM animations keep in the x of a node's place.
  bool add_expression(const gltf::Track& track) {
    for (const auto& [name, node] : figure.vrm.expression_nodes) {
      if (node != track.node) continue;
      if (track.path != gltf::Path::translation) return true;
      MotionTrack made{TrackKind::displacer,
                       curve_of(track.curve),
                       displacer_index(motion, name),
                       track.times,
                       {},
                       {}};
      for (size_t i = 0; i < track.values.size(); i += 3) made.values.push_back(track.values[i]);
      motion.tracks.push_back(std::move(made));
      return true;
    }
    return false;
  }
};

}  // namespace

void read_gltf_motions(GltfFigure& figure) {
  std::vector<gltf::Clip> clips = gltf::read_clips(figure.file, figure.nodes);
  for (size_t c = 0; c < clips.size(); c++) {
    if (figure.character.motions.size() >= most_motions) {
      gltf::warn(figure.file, "/animations",
                 "only the first " + std::to_string(most_motions) + " are kept");
      break;
    }
    Motion motion;
    motion.name = clips[c].name.empty() ? "animation " + std::to_string(c) : clips[c].name;
    motion.loop = true;
    for (const Joint& joint : figure.character.joints)
      motion.joints.push_back({joint.name, joint.parent, joint.center});
    Converter converter{figure, motion};
    for (const gltf::Track& track : clips[c].tracks) {
      motion.duration = std::max(motion.duration, track.times.back());
      if (track.path == gltf::Path::weights) {
        converter.add_weights(track);
        continue;
      }
      if (converter.add_expression(track)) continue;
      int joint = figure.joint_of[track.node];
      if (joint < 0) {
        gltf::warn(figure.file, gltf::at("/animations", c),
                   "moves nodes that are no part of the figure");
        continue;
      }
      if (track.path == gltf::Path::rotation) converter.add_turn(track, joint);
      else if (track.path == gltf::Path::translation) converter.add_way(track, joint);
      else if (track.path == gltf::Path::scale) converter.add_size(track, joint);
    }
    if (!motion.tracks.empty()) figure.character.motions.push_back(std::move(motion));
  }
}

}  // namespace wellspring::avatar
