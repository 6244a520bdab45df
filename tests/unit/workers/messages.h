// SPDX-License-Identifier: Apache-2.0
// Messages between a server and its workers that have every field.
#pragma once
#include "workers/message.h"

namespace wellspring::test {

inline TraceOrder make_order() {
  TraceOrder order{7,    41, 500,     "castle", {"0.1.0", "x86-64 avx2", 11, 13}, true, "gather",
                   true, {}, "lamps", {}};
  order.transport.max_depth = 6;
  order.transport.clamp = 4;
  order.transport.sees_volumes = true;
  for (uint32_t i = 0; i < 5; i++) {
    Request request;
    request.ray.origin = vec3(i / 2, 1.6f, -3);
    request.ray.direction = glm::normalize(vec3(0.1f * float(i), -0.2f, -1));
    request.ray.from_eye = i % 2;
    if (i == 2) request.ray.t_min = 0.5f, request.ray.t_max = 20;
    if (i > 2) request.ray.width = 0.001f, request.ray.spread = 0.0005f;
    request.seed = 0x123456789abcdefull * i;
    request.index = i * 7;
    order.requests.push_back(request);
  }
  return order;
}

inline TraceAnswer make_answer() {
  TraceAnswer answer{7, 41, "north-2", Refusal::none, 0.01f, 0.02f, std::vector<Sample>(4)};
  answer.samples[0].position = vec3(0, 1, 0), answer.samples[0].normal = vec3(0, 1, 0);
  answer.samples[0].distance = std::numeric_limits<float>::infinity();
  Sample& hit = answer.samples[1];
  hit.position = vec3(1, 2, 3), hit.normal = vec3(0, 0, 1), hit.distance = 4;
  hit.object = 2, hit.instance = 1, hit.triangle = 9, hit.barycentric = vec2(0.25f, 0.5f);
  hit.albedo = vec3(0.5f), hit.smooth = vec3(0.7f, 0.6f, -0.01f), hit.flags = sample_hit;
  answer.samples[2] = hit;
  answer.samples[2].rest = vec3(3), answer.samples[2].glow = vec3(1);
  answer.samples[2].flags = sample_hit | sample_moving;
  answer.samples[3] = hit;
  answer.samples[3].known = vec3(0.2f), answer.samples[3].raised = 0.01f;
  answer.samples[3].flags = sample_hit | sample_mapped;
  return answer;
}

}  // namespace wellspring::test
