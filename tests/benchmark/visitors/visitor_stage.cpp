// SPDX-License-Identifier: Apache-2.0
#include "visitor_stage.h"

#include <array>
#include <cmath>
#include <glm/gtx/quaternion.hpp>
#include <stdexcept>

#include "avatar/face/expression_sum.h"
#include "avatar/figure/joint_constraints.h"
#include "avatar/figure/rig.h"
#include "avatar/load/character_load.h"
#include "base/parallel.h"
#include "frame/tonemap.h"
#include "light/technique/technique.h"
#include "show/moving/figure.h"
#include "visitor_things.h"

namespace wellspring::test {

namespace {

const quat half_turn = glm::angleAxis(pi, vec3(0, 1, 0));  // figures look along +z, visitors -z

quat turned(vec3 yaw_pitch_roll) {
  return glm::angleAxis(-yaw_pitch_roll.x, vec3(0, 1, 0)) *
         glm::angleAxis(yaw_pitch_roll.y, vec3(1, 0, 0)) *
         glm::angleAxis(-yaw_pitch_roll.z, vec3(0, 0, 1));
}

// The foremost point of what an eye's joint moves.
vec3 pupil_of(const Character& character, int joint) {
  vec3 best(0, 0, -INFINITY);
  for (size_t v = 0; v < character.positions.size(); v++)
    for (uint32_t w = character.first_weight[v]; w < character.first_weight[v + 1]; w++)
      if (character.weights[w].joint == joint && character.weights[w].weight > 0.9f &&
          character.positions[v].z > best.z)
        best = character.positions[v];
  return best;
}

struct Actor {
  Character character;
  Rig rig;
  ExpressionRig expressions;
  SkinScratch scratch;
  vec3 pupils{0};  // between them, humanoid space at rest

  explicit Actor(const std::string& file) : character(load_character(file)) {
    rig = make_rig(character);
    expressions = make_expression_rig(default_expressions(), character);
    if (rig.skull < 0 || rig.eye[0] < 0 || rig.eye[1] < 0)
      throw std::invalid_argument(file + ": has no joints of skull and eyes");
    pupils = 0.5f * (pupil_of(character, rig.eye[0]) + pupil_of(character, rig.eye[1]));
  }

  void hang_arms(Pose& pose) const {
    for (const ArmRig& arm : rig.arm) {
      if (arm.shoulder < 0 || arm.elbow < 0) continue;
      pose.rotations[size_t(arm.shoulder)] = arm.upper_hangs;
      pose.rotations[size_t(arm.elbow)] = glm::inverse(arm.upper_hangs) * arm.fore_hangs;
    }
  }

  // Takes the head to the world; the figure's place follows from it.
  mat4 stand(const Visitor& visitor, Pose& pose) const {
    const quat head = turned(visitor.turn) * half_turn;
    const quat body = turned({visitor.turn.x / 2, 0, 0}) * half_turn;
    // The neck takes its part of the way from the body to the head.
    const quat way = glm::inverse(body) * head;
    quat above{1, 0, 0, 0};
    for (const WeightedJoint& joint : rig.neck) {
      if (joint.joint == rig.skull) continue;
      const quat part = glm::slerp(quat(1, 0, 0, 0), way, 0.4f / float(rig.neck.size()));
      pose.rotations[size_t(joint.joint)] = part;
      above = above * part;
    }
    pose.rotations[size_t(rig.skull)] = glm::inverse(above) * way;
    // Eyes look into the lens, as far as eyes go.
    vec3 gaze = glm::inverse(head) * -normalize(visitor.eyes);
    const float most = std::tan(25 * pi / 180);
    gaze = vec3(glm::clamp(vec2(gaze) / std::max(gaze.z, 0.1f), -most, most), 1);
    for (int eye : rig.eye)
      pose.rotations[size_t(eye)] = glm::rotation(vec3(0, 0, 1), normalize(gaze));
    if (visitor.size != 1) {  // irises are as wide in children as in adults
      const float wider = 1 / visitor.size;
      pose.stretches.resize(pose.rotations.size(), mat3(1));
      for (int eye : rig.eye) pose.stretches[size_t(eye)] = mat3(wider, 0, 0, 0, wider, 0, 0, 0, 1);
    }
    follow_constraints(character, pose);

    std::vector<mat4> joints;
    eval_joints(character, pose, joints);
    const mat4 turn = glm::mat4_cast(body) * glm::scale(mat4(1), vec3(visitor.size));
    const vec3 seen = vec3(turn * joints[size_t(rig.skull)] * vec4(pupils, 1));
    return glm::translate(mat4(1), visitor.eyes - seen) * turn;
  }
};

struct Lighting {
  vec3 from;        // the lamp's position
  float lamp, sky;  // W/sr; radiance from everywhere
  float window;     // its radiance; 0: there is none
};

Lighting lighting_of(VisitorLight light) {
  const vec3 above{-0.7f, 1.3f, -0.9f};
  switch (light) {
    case VisitorLight::bright: return {above, 12, 0.75f, 0};
    case VisitorLight::normal: return {above, 5.5f, 0.33f, 0};
    case VisitorLight::dim: return {above, 1.3f, 0.075f, 0};
    case VisitorLight::side: return {{-1.6f, 0.4f, 0.7f}, 7, 0.07f, 0};
    case VisitorLight::back: return {above, 1, 0.09f, 6};
  }
  return {};
}

// A room in one light, with everybody in it.
struct Room {
  Scene scene;
  std::vector<Figure> figures;
  std::vector<int> things;  // each figure's first moving mesh of things that it may wear
  std::vector<Mesh> worn;
  std::unique_ptr<World> world;
  Lights lights;
  Frame empty;  // without visitors

  Room(const std::vector<Actor>& actors, VisitorLight light) {
    const Lighting lit = lighting_of(light);
    scene.objects = {"", "room"};
    add_room(scene);
    if (lit.window > 0) add_window(scene, vec3(lit.window));
    PunctualLight lamp;
    lamp.position = lit.from, lamp.intensity = lit.lamp * vec3(1, 0.95f, 0.88f);
    scene.lights.push_back(lamp);
    scene.environment.radiance = lit.sky * vec3(0.95f, 0.98f, 1.05f);
    std::vector<Mesh> moving;
    std::vector<uint32_t> objects;
    worn = make_worn(scene);
    for (const Actor& actor : actors) {
      figures.push_back(make_figure(actor.character, scene, moving, objects));
      things.push_back(int(moving.size()));
      for (const Mesh& mesh : worn)
        moving.push_back(mesh), objects.push_back(figures.back().object);
    }
    world = std::make_unique<World>(scene, std::move(moving), std::move(objects));
    lights = make_lights(*world);
  }
};

TransportSettings transport() {
  TransportSettings settings;
  settings.clamp = 8;
  return settings;
}

}  // namespace

const char* name_of(VisitorLight light) {
  constexpr const char* names[] = {"bright", "normal", "dim", "side", "back"};
  return names[size_t(light)];
}

struct VisitorStage::Impl {
  std::vector<Actor> actors;
  std::unique_ptr<Room> room;
  VisitorLight light{};

  View view() const {
    const float fov = 2 * std::atan(std::tan(visitor_fov / 2) * visitor_height / visitor_width);
    return make_view_towards(room->scene, dvec3(0), dvec3(0, 0, 1), vec3(0, 1, 0), fov,
                             visitor_width, visitor_height);
  }

  void enter(VisitorLight wanted) {
    if (room && light == wanted) return;
    room.reset();
    room = std::make_unique<Room>(actors, light = wanted);
    hide_all();
    room->world->commit();
    StillSettings settings;
    settings.spp = 9;
    settings.transport = transport();
    room->empty =
        render_still(*find_technique("direct"), *room->world, room->lights, view(), settings);
  }

  void hide_all() {
    for (size_t i = 0; i < actors.size(); i++) {
      show_figure(*room->world, room->figures[i], false);
      for (int k = 0; k < int(room->worn.size()); k++)
        room->world->show(room->things[i] + k, false);
    }
  }

  void place(const Visitor& visitor) {
    Actor& actor = actors.at(size_t(visitor.figure));
    Pose pose = make_rest_pose(actor.character);
    actor.hang_arms(pose);
    if (!visitor.expression.empty()) {
      const int expression = find_expression(default_expressions(), visitor.expression);
      if (expression < 0 || !shows(actor.expressions, expression))
        throw std::invalid_argument("no expression '" + visitor.expression + "'");
      ExpressionSum sum;
      clear(sum, actor.expressions);
      add(sum, actor.expressions, expression, visitor.strength);
      apply_controls(sum, actor.expressions, pose);
    }
    const mat4 placement = actor.stand(visitor, pose);
    World& world = *room->world;
    Figure& figure = room->figures[size_t(visitor.figure)];
    pose_figure(world, figure, actor.character, pose, placement, actor.scratch);
    show_figure(world, figure, true);
    if (visitor.worn == Worn::nothing) return;
    const int which = int(visitor.worn) - 1, moving = room->things[size_t(visitor.figure)] + which;
    const quat head = turned(visitor.turn) * half_turn;
    std::vector<vec3> positions, normals;
    for (vec3 p : room->worn[size_t(which)].positions)
      positions.push_back(visitor.eyes + head * (visitor.size * p));
    for (vec3 n : room->worn[size_t(which)].normals) normals.push_back(head * n);
    world.move(moving, positions, normals);
    world.show(moving, true);
  }

  // The pixels that visitors may cover: left, top, right, bottom.
  std::array<int, 4> find_box(const World& world) const {
    const Bounds bounds = world.moving_bounds();
    vec2 low(INFINITY), high(-INFINITY);
    for (int corner = 0; corner < 8; corner++) {
      vec3 p(corner & 1 ? bounds.low.x : bounds.high.x, corner & 2 ? bounds.low.y : bounds.high.y,
             std::max(0.05f, corner & 4 ? bounds.low.z : bounds.high.z));
      const Projected at = project_point(view(), p);
      low = glm::min(low, vec2(at.x, at.y)), high = glm::max(high, vec2(at.x, at.y));
    }
    auto inside = [](float value, int most) { return int(glm::clamp(value, 0.f, float(most))); };
    return {inside(low.x - 1, visitor_width), inside(low.y - 1, visitor_height),
            inside(high.x + 2, visitor_width), inside(high.y + 2, visitor_height)};
  }

  // Traces the visitors' pixels, with one around them; the room stays as it is without visitors.
  void draw_box(const std::array<int, 4>& box, int spp, Frame& frame) const {
    const View from = view();
    const World& world = *room->world;
    const Technique& technique = *find_technique("direct");
    std::vector<uint8_t> near(frame.color.size());
    parallel_each(box[3] - box[1], [&](int row) {
      for (int x = box[0]; x < box[2]; x++) {
        const int y = box[1] + row;
        const Hit hit = world.intersect(view_ray(from, float(x) + 0.5f, float(y) + 0.5f));
        near[size_t(y * visitor_width + x)] = hit.valid() && world.is_moving(hit.instance);
      }
    });
    auto is_near = [&](int x, int y) {
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, visitor_height - 1); v++)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, visitor_width - 1); u++)
          if (near[size_t(v * visitor_width + u)]) return true;
      return false;
    };
    parallel_each(box[3] - box[1], [&](int row) {
      const int y = box[1] + row;
      std::vector<Request> requests;
      for (int x = box[0]; x < box[2]; x++)
        for (int k = 0; k < spp && is_near(x, y); k++)
          requests.push_back(pixel_request(from, 1, x, y, k));
      std::vector<Sample> samples(requests.size());
      technique.trace_many(world, room->lights, transport(), requests, samples);
      for (size_t i = 0; i < samples.size(); i += size_t(spp)) {
        vec3 sum(0);
        for (size_t k = 0; k < size_t(spp); k++) sum += samples[i + k].radiance();
        frame.color[requests[i].pixel] = sum / float(spp);
        frame.object[requests[i].pixel] = samples[i].object;
      }
    });
  }

  VisitorPicture draw(const VisitorShot& shot, int spp) {
    enter(shot.light);
    World& world = *room->world;
    hide_all();
    for (const Visitor& visitor : shot.visitors) place(visitor);
    world.commit();
    VisitorPicture picture;
    Frame frame = room->empty;
    if (!shot.visitors.empty()) draw_box(find_box(world), spp, frame);
    tonemap(frame, Tonemap{}, picture.image);
    for (uint32_t object : frame.object) picture.of_visitor.push_back(object > 1);
    return picture;
  }
};

VisitorStage::VisitorStage(const std::vector<std::string>& files)
    : impl_(std::make_unique<Impl>()) {
  for (const std::string& file : files) impl_->actors.emplace_back(file);
}
VisitorStage::~VisitorStage() = default;
VisitorPicture VisitorStage::draw(const VisitorShot& shot, int spp) {
  return impl_->draw(shot, spp);
}

}  // namespace wellspring::test
