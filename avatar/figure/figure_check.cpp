// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/figure_check.h"

#include <algorithm>
#include <cmath>

namespace wellspring::avatar {
namespace {

struct Box {
  vec3 low{INFINITY}, high{-INFINITY};
  bool empty() const { return !(low.x <= high.x); }
  bool holds(vec3 p, float margin) const {
    for (int i = 0; i < 3; i++)
      if (p[i] < low[i] - margin || p[i] > high[i] + margin) return false;
    return true;
  }
};

std::string centimetres(float metres) {
  return std::to_string(int(std::lround(metres * 100))) + " cm";
}

// Where the head is: around the vertices that follow the skull; for a skull without surface, around
// its joint by the figure's size.
Box head_box(const Character& character, int skull, float height) {
  Box box;
  for (size_t v = 0; v < character.positions.size(); v++)
    for (uint32_t k = character.first_weight[v]; k < character.first_weight[v + 1]; k++) {
      if (character.weights[k].joint != skull || character.weights[k].weight < 0.5f) continue;
      box.low = glm::min(box.low, character.positions[v]);
      box.high = glm::max(box.high, character.positions[v]);
    }
  vec3 centre = character.joints[size_t(skull)].center;
  Box usual{centre - height * vec3(0.08f, 0.06f, 0.1f),
            centre + height * vec3(0.08f, 0.16f, 0.14f)};
  return box.empty() || box.high.y - box.low.y < 0.05f * height ? usual : box;
}

// Joints of some published skeletons lie far from the face they should move.
void check_face_joints(Character& character, float height) {
  int skull = find_joint(character, "skullbase");
  if (skull < 0) return;
  Box head = head_box(character, skull, height);
  auto say = [&](const Joint& joint, const std::string& what) {
    character.warnings.push_back("joint " + joint.name + " " + what + ": misplaced");
  };
  auto place = [&](const char* name) {
    int joint = find_joint(character, name);
    return joint < 0 ? nullptr : &character.joints[size_t(joint)];
  };
  for (const Joint& joint : character.joints) {
    bool face = joint.name.find("_eye") != std::string::npos || joint.name == "temporomandibular";
    vec3 from_skull = joint.center - character.joints[size_t(skull)].center;
    bool below = from_skull.y < -0.05f * height;  // the skull's joint is at its base
    if (face && (below || !head.holds(joint.center, 0.012f * height))) {
      say(joint,
          "lies " + centimetres(glm::length(from_skull)) + " from skullbase, outside the head");
    }
  }
  const Joint* jaw = place("temporomandibular");
  for (const char* side : {"l_", "r_"}) {
    const Joint* eye = place((side + std::string("eyeball_joint")).c_str());
    const Joint* lid = place((side + std::string("eyelid_joint")).c_str());
    const Joint* brow = place((side + std::string("eyebrow_joint")).c_str());
    if (eye && jaw && jaw->center.y > eye->center.y + 0.01f * height)
      say(*jaw, "lies above the eyes");
    if (eye && (eye->center.x < 0) == (side[0] == 'l') && std::abs(eye->center.x) > 0.003f * height)
      say(*eye, "lies on the other side of the head");
    if (eye && lid && glm::length(eye->center - lid->center) > 0.03f * height)
      say(*lid, "lies " + centimetres(glm::length(eye->center - lid->center)) + " from its eye");
    if (eye && brow && brow->center.y < eye->center.y - 0.006f * height)
      say(*brow, "lies below its eye");
  }
}

// H-Anim figures stand on y = 0; some files put their origin elsewhere.
void stand_on_floor(Character& character) {
  if (find_joint(character, "l_talocrural") < 0 && find_joint(character, "l_knee") < 0) return;
  if (character.parts.empty() && !character.motions.empty()) return;  // where a recording has it
  float low = INFINITY;
  for (vec3 p : character.positions) low = std::min(low, p.y);
  // Surfaces may be missing, or stand on legs that have none.
  for (const Joint& joint : character.joints) {
    bool foot = joint.name.find("talocrural") != std::string::npos ||
                joint.name.find("metatarsophalangeal_2") != std::string::npos;
    if (character.positions.empty()) low = std::min(low, joint.center.y - 0.02f);
    else if (foot) low = std::min(low, joint.center.y);
  }
  if (!std::isfinite(low) || std::abs(low) < 0.03f) return;
  char text[100];
  std::snprintf(text, sizeof text, "feet are at y = %.3f m: the figure is moved to stand on 0",
                double(low));
  character.warnings.push_back(text);
  for (vec3& p : character.positions) p.y -= low;
  for (Joint& joint : character.joints) joint.center.y -= low;
  for (Site& site : character.sites) site.position.y -= low;
  for (SpringCollider& collider : character.spring_colliders)
    collider.place.y -= low, collider.tail.y -= low;
  for (Motion& motion : character.motions)
    for (MotionJoint& joint : motion.joints) joint.center.y -= low;
}

}  // namespace

void check_figure(Character& character) {
  stand_on_floor(character);
  float height = 0, size = 0;
  for (const Joint& joint : character.joints) {
    height = std::max(height, joint.center.y);
    size = std::max(size, glm::length(joint.center));
  }
  check_face_joints(character, std::clamp(height * 1.08f, 0.1f, 100.0f));
  if (size > 20)
    character.warnings.push_back(
        "the figure is more than 20 m large: perhaps its unit is not the metre");
}

}  // namespace wellspring::avatar
