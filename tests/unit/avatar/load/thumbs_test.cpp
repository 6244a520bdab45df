// SPDX-License-Identifier: Apache-2.0
// Thumbs close across the palm with the hand, and by themselves.
#include <gtest/gtest.h>

#include "avatar/body/body.h"
#include "avatar/load/character_load.h"

namespace wellspring::test {
namespace {

TEST(Thumbs, CloseAcrossThePalm) {
  for (const char* file : {"storyteller.x3d", "chronicler.x3d"}) {
    Character figure =
        load_character(std::string(WELLSPRING_SOURCE) + "/content/castle/figures/" + file);
    Rig rig = make_rig(figure);
    for (int side = 0; side < 2; side++) {
      const ArmRig& bones = rig.arm[size_t(side)];
      int joints[3] = {-1, -1, -1}, middle = -1;
      for (const FingerJoint& finger : bones.fingers) {
        if (finger.finger == 0) joints[finger.knuckle] = finger.joint;
        if (finger.finger == 3 && finger.knuckle == 0) middle = finger.joint;
      }
      for (int joint : joints) ASSERT_GE(joint, 0);
      ASSERT_GE(middle, 0);
      // Returns the gap from the thumb's last joint to the root of the ring finger, in the hand.
      auto gap = [&](float curl, float thumb) {
        BodyPlan plan{.fingers = true};
        for (ArmPose& arm : plan.arm) {
          arm = hanging_arm(0);
          arm.curl = curl;
          arm.finger[0] = thumb;
        }
        Pose pose = make_rest_pose(figure);
        eval_body(rig, plan, pose);
        return glm::length(eval_joint_frame(figure, pose, joints[2]).center -
                           eval_joint_frame(figure, pose, middle).center);
      };
      float last = gap(-0.3f, 0);
      for (float curl = 0; curl <= 1.4f; curl += 0.2f) {
        float now = gap(curl, 0);
        EXPECT_LT(now, last + 1e-4f) << file << side << curl;
        last = now;
      }
      EXPECT_LT(gap(1.3f, 0), 0.85f * gap(0, 0)) << file;
      EXPECT_GT(gap(1.3f, -1.3f), gap(1.3f, 0)) << "it opens by itself";
    }
  }
}

}  // namespace
}  // namespace wellspring::test
