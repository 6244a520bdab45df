// SPDX-License-Identifier: Apache-2.0
// Messages between servers and workers, as NATS hands them over: orders at a worker, answers at a
// server, calls at both.
#include <cmath>

#include "fuzz/fuzz.h"
#include "workers/message.h"

namespace wellspring::fuzz {

void fuzz_worker_message(Bytes bytes) {
  const std::string text = text_of(bytes);
  const MessageKey none;
  TraceOrder order;
  if (read_message(text, none, order)) {
    require(!order.requests.empty() && order.requests.size() <= most_requests, "requests");
    for (const Request& request : order.requests)
      require(std::isfinite(dot(request.ray.origin, request.ray.direction)), "rays are finite");
    TraceOrder again;
    require(read_message(write_message(order, none), none, again), "what is read can be written");
  }
  TraceAnswer answer;
  if (read_message(text, none, answer)) {
    require(is_worker_name(answer.worker), "names are letters and digits");
    require(answer.samples.size() <= most_requests, "samples");
    for (const Sample& sample : answer.samples) {
      const vec3 light = sample.radiance();
      require(std::isfinite(light.x + light.y + light.z), "light is finite");
    }
    are_within(answer.samples, {4, {1, 2}});
  }
  FileQuestion question;
  if (read_message(text, none, question)) require(question.offset <= most_file_bytes, "offset");
  FilePart part;
  if (read_message(text, none, part))
    require(part.offset + part.bytes.size() <= part.size, "the part lies within its file");
  PackageList list;
  if (read_list(text, list)) {
    for (const PackageFile& file : list)
      require(file.path.front() != '/' && file.path.find("..") != 0, "paths stay inside");
    require(write_list(list) == text, "what is read can be written");
  }
  RollCall call;
  read_message(text, none, call);
  CallAnswer here;
  read_message(text, none, here);
}

}  // namespace wellspring::fuzz
