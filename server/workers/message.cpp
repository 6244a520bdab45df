// SPDX-License-Identifier: Apache-2.0
#include "workers/message.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <utility>

#include "base/bytes.h"
#include "world/native_rays.h"

namespace wellspring::workers {
namespace {

constexpr size_t most_name_bytes = 64;
constexpr float most_light = 1e6f;  // light of a sample, either way
constexpr float most_place = 1e7f;  // metres from the scene's origin
constexpr float infinity = std::numeric_limits<float>::infinity();

constexpr uint32_t magic = 0x31575357;  // "WSW1"
enum class Kind : uint8_t { order = 1, answer, call, call_answer, file_question, file_part };

// Begins a message.
ByteWriter begin(Kind kind) {
  ByteWriter out;
  out.put(magic), out.put(kind);
  return out;
}

std::string close(ByteWriter& out, const MessageKey& key) {
  return seal(std::move(out).bytes(), key);
}

// Returns what is to be read of a message of that kind; nothing, if it is not one, or not sealed.
std::string_view open(std::string_view bytes, const MessageKey& key, Kind kind) {
  if (bytes.size() > most_message_bytes) return {};
  const std::optional<std::string_view> open = unseal(bytes, key);
  if (!open) return {};
  ByteReader in(*open);
  uint32_t found_magic = 0;
  Kind found{};
  in.take(found_magic), in.take(found);
  if (!in.good() || found_magic != magic || found != kind) return {};
  return open->substr(sizeof magic + sizeof kind);
}

// Says which fields of a ray or sample follow, as others have their usual values.
enum RequestFields : uint8_t { has_origin = 1, has_ends = 2, has_cone = 4, from_eye = 8 };
enum SampleFields : uint8_t {
  has_place = 1,  // on a triangle
  has_smooth = 2,
  has_rest = 4,
  has_glow = 8,
  has_known = 16,
  has_raised = 32,
  has_distance = 64,  // is finite
};

void put_request(const Request& request, const Request& before, ByteWriter& out) {
  const Ray &ray = request.ray, &last = before.ray;
  const bool origin = ray.origin != last.origin, ends = ray.t_min != 0 || ray.t_max != infinity,
             cone = ray.width != last.width || ray.spread != last.spread;
  out.put(uint8_t((origin ? has_origin : 0) | (ends ? has_ends : 0) | (cone ? has_cone : 0) |
                  (ray.from_eye ? from_eye : 0)));
  if (origin) out.put(ray.origin);
  out.put(ray.direction);
  if (ends) out.put(ray.t_min), out.put(ray.t_max);
  if (cone) out.put(ray.width), out.put(ray.spread);
  out.put(request.seed), out.put(request.index);
}

bool is_place(vec3 v) { return glm::all(glm::lessThan(glm::abs(v), vec3(most_place))); }
bool is_light(vec3 v) { return glm::all(glm::lessThan(glm::abs(v), vec3(most_light))); }
bool is_direction(vec3 v) {
  const float length = dot(v, v);
  return length > 0.98f && length < 1.02f;
}

constexpr size_t least_request_bytes = 1 + 12 + 8 + 4, least_sample_bytes = 2 + 12 + 12 + 4 + 12;

void take_request(const Request& before, ByteReader& in, Request& request) {
  uint8_t fields = 0;
  in.take(fields);
  in.need(fields < 16);
  Ray& ray = request.ray;
  ray = {.origin = before.ray.origin, .width = before.ray.width, .spread = before.ray.spread};
  if (fields & has_origin) in.take(ray.origin);
  in.take(ray.direction);
  if (fields & has_ends) in.take(ray.t_min), in.take(ray.t_max);
  if (fields & has_cone) in.take(ray.width), in.take(ray.spread);
  ray.from_eye = fields & from_eye;
  in.take(request.seed), in.take(request.index);
  in.need(is_place(ray.origin) && is_direction(ray.direction) && ray.t_min >= 0 &&
          ray.t_max >= ray.t_min && ray.t_min < most_place && ray.width >= 0 &&
          ray.width < most_place && std::abs(ray.spread) < most_place);
}

void put_sample(const Sample& sample, ByteWriter& out) {
  const bool place = sample.instance != 0 || sample.triangle != 0 || sample.barycentric != vec2(0);
  const auto bit = [](bool is, SampleFields field) { return is ? unsigned(field) : 0u; };
  out.put(sample.flags);
  const unsigned fields =
      bit(place, has_place) | bit(sample.smooth != vec3(0), has_smooth) |
      bit(sample.rest != vec3(0), has_rest) | bit(sample.glow != vec3(0), has_glow) |
      bit(sample.known != vec3(1), has_known) | bit(sample.raised != 0, has_raised) |
      bit(sample.distance < infinity, has_distance);
  out.put(uint8_t(fields));
  out.put(sample.position), out.put(sample.normal), out.put(sample.object), out.put(sample.albedo);
  if (fields & has_distance) out.put(sample.distance);
  if (place) out.put(sample.instance), out.put(sample.triangle), out.put(sample.barycentric);
  for (const auto& [field, value] :
       {std::pair(has_smooth, &sample.smooth), std::pair(has_rest, &sample.rest),
        std::pair(has_glow, &sample.glow), std::pair(has_known, &sample.known)})
    if (fields & field) out.put(*value);
  if (fields & has_raised) out.put(sample.raised);
}

void take_sample(ByteReader& in, Sample& sample) {
  in.take(sample.flags);
  uint8_t fields = 0;
  in.take(fields);
  in.need(fields < 128 && sample.flags < 32);
  in.take(sample.position), in.take(sample.normal), in.take(sample.object), in.take(sample.albedo);
  sample.distance = infinity;
  if (fields & has_distance) in.take(sample.distance);
  if (fields & has_place)
    in.take(sample.instance), in.take(sample.triangle), in.take(sample.barycentric);
  for (const auto& [field, value] :
       {std::pair(has_smooth, &sample.smooth), std::pair(has_rest, &sample.rest),
        std::pair(has_glow, &sample.glow), std::pair(has_known, &sample.known)})
    if (fields & field) in.take(*value);
  if (fields & has_raised) in.take(sample.raised);
  const vec2 corner = sample.barycentric;
  in.need(is_place(sample.position) && is_place(sample.normal) && is_light(sample.albedo) &&
          is_light(sample.smooth) && is_light(sample.rest) && is_light(sample.glow) &&
          is_light(sample.known) && std::abs(sample.raised) < most_light && sample.distance >= 0 &&
          corner.x > -1 && corner.x < 2 && corner.y > -1 && corner.y < 2);
}

}  // namespace

std::string instruction_set() {
  std::string words;
  const auto add = [&](const char* word) {
    words += words.empty() ? word : std::string(" ") + word;
  };
#if defined(__x86_64__)
  add("x86-64");
#if defined(__AVX2__)
  add("avx2");
#endif
#if defined(__FMA__)
  add("fma");
#endif
#if defined(__AVX512F__)
  add("avx512f");
#endif
  // Embree chooses its own instructions by the processor.
  const int rays = world::native_rays();
  add(rays == 16 ? "on avx512" : rays == 8 ? "on avx" : "on sse");
#elif defined(__aarch64__)
  add("aarch64");
#else
  add("other");
#endif
  return words;
}

const char* to_word(Refusal refusal) {
  constexpr const char* words[refusals] = {"none",  "version", "instructions", "exhibit",
                                           "scene", "light",   "state",        "technique",
                                           "late",  "busy",    "fetching",     "disk"};
  return words[size_t(refusal)];
}

bool is_worker_name(std::string_view name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !name.empty() && name.size() <= 32 && std::ranges::all_of(name, fits);
}

std::string default_worker_name() {
  char host[64] = "worker";
  gethostname(host, sizeof host - 1);
  std::string name;
  for (const char* c = host; *c && *c != '.' && name.size() < 20; c++)
    name += is_worker_name(std::string_view(c, 1)) ? *c : '-';
  return fmt::format("{}-{}", name, getpid());
}

std::string write_message(const TraceOrder& order, const MessageKey& key) {
  ByteWriter out = begin(Kind::order);
  out.put(order.server), out.put(order.number), out.put(order.worth_ms);
  out.put_text(order.exhibit);
  out.put_text(order.same.version), out.put_text(order.same.instructions);
  out.put(order.same.scene), out.put(order.same.light), out.put(uint8_t(order.exact));
  out.put_text(order.technique), out.put(uint8_t(order.plain));
  out.put(int32_t(order.transport.max_depth)), out.put(order.transport.clamp);
  out.put(uint8_t(order.transport.sees_volumes));
  out.put_text(order.state);
  out.put(uint32_t(order.requests.size()));
  const Request first;
  const Request* before = &first;
  for (const Request& request : order.requests) {
    put_request(request, *before, out);
    before = &request;
  }
  return close(out, key);
}

bool read_message(std::string_view bytes, const MessageKey& key, TraceOrder& order) {
  ByteReader in(open(bytes, key, Kind::order));
  order = {};
  in.take(order.server), in.take(order.number), in.take(order.worth_ms);
  in.take_text(order.exhibit, most_name_bytes);
  in.take_text(order.same.version, most_name_bytes);
  in.take_text(order.same.instructions, most_name_bytes);
  uint8_t exact = 0;
  in.take(order.same.scene), in.take(order.same.light), in.take(exact);
  in.take_text(order.technique, most_name_bytes);
  int32_t depth = 0;
  uint8_t volumes = 0, plain = 0;
  in.take(plain);
  in.take(depth), in.take(order.transport.clamp), in.take(volumes);
  in.need(order.worth_ms <= longest_worth_ms && depth >= 1 && depth <= 64 && volumes <= 1 &&
          exact <= 1 && plain <= 1 && order.transport.clamp >= 0 &&
          order.transport.clamp < most_light);
  order.transport.max_depth = depth, order.transport.sees_volumes = volumes;
  order.exact = exact, order.plain = plain;
  in.take_text(order.state, most_state_bytes);
  order.requests.resize(in.take_count(most_requests, least_request_bytes));
  const Request first;
  const Request* before = &first;
  for (Request& request : order.requests) {
    take_request(*before, in, request);
    if (!in.good()) return false;
    before = &request;
  }
  return in.ended() && !order.requests.empty();
}

std::string write_message(const TraceAnswer& answer, const MessageKey& key) {
  ByteWriter out = begin(Kind::answer);
  out.put(answer.server), out.put(answer.number);
  out.put_text(answer.worker);
  out.put(answer.refusal), out.put(answer.waited), out.put(answer.traced);
  out.put(uint32_t(answer.samples.size()));
  for (const Sample& sample : answer.samples) put_sample(sample, out);
  return close(out, key);
}

bool read_message(std::string_view bytes, const MessageKey& key, TraceAnswer& answer) {
  ByteReader in(open(bytes, key, Kind::answer));
  answer = {};
  in.take(answer.server), in.take(answer.number);
  in.take_text(answer.worker, most_name_bytes);
  in.take(answer.refusal), in.take(answer.waited), in.take(answer.traced);
  constexpr float longest = 0.001f * float(longest_worth_ms);
  in.need(is_worker_name(answer.worker) && int(answer.refusal) < refusals && answer.waited >= 0 &&
          answer.waited <= longest && answer.traced >= 0 && answer.traced <= longest);
  answer.samples.resize(in.take_count(most_requests, least_sample_bytes));
  for (Sample& sample : answer.samples) {
    take_sample(in, sample);
    if (!in.good()) return false;
  }
  return in.ended() && (answer.refusal == Refusal::none) == !answer.samples.empty();
}

std::string write_message(const RollCall& call, const MessageKey& key) {
  ByteWriter out = begin(Kind::call);
  out.put(call.server), out.put(call.number);
  return close(out, key);
}

bool read_message(std::string_view bytes, const MessageKey& key, RollCall& call) {
  ByteReader in(open(bytes, key, Kind::call));
  in.take(call.server), in.take(call.number);
  return in.ended();
}

std::string write_message(const CallAnswer& answer, const MessageKey& key) {
  ByteWriter out = begin(Kind::call_answer);
  out.put(answer.server), out.put(answer.number);
  for (const std::string* text : {&answer.worker, &answer.version, &answer.instructions})
    out.put_text(*text);
  out.put(answer.cores);
  return close(out, key);
}

bool read_message(std::string_view bytes, const MessageKey& key, CallAnswer& answer) {
  ByteReader in(open(bytes, key, Kind::call_answer));
  in.take(answer.server), in.take(answer.number);
  for (std::string* text : {&answer.worker, &answer.version, &answer.instructions})
    in.take_text(*text, most_name_bytes);
  in.take(answer.cores);
  in.need(answer.cores >= 1 && answer.cores <= 65536);
  return in.ended() && is_worker_name(answer.worker);
}

std::string write_message(const FileQuestion& question, const MessageKey& key) {
  ByteWriter out = begin(Kind::file_question);
  out.put(question.server), out.put(question.hash), out.put(question.offset);
  return close(out, key);
}

bool read_message(std::string_view bytes, const MessageKey& key, FileQuestion& question) {
  ByteReader in(open(bytes, key, Kind::file_question));
  in.take(question.server), in.take(question.hash), in.take(question.offset);
  return in.ended() && question.offset <= most_file_bytes;
}

std::string write_message(const FilePart& part, const MessageKey& key) {
  ByteWriter out = begin(Kind::file_part);
  out.put(part.server), out.put(part.hash);
  out.put(part.offset), out.put(part.size), out.put_text(part.bytes);
  return close(out, key);
}

bool read_message(std::string_view bytes, const MessageKey& key, FilePart& part) {
  ByteReader in(open(bytes, key, Kind::file_part));
  in.take(part.server), in.take(part.hash);
  in.take(part.offset), in.take(part.size), in.take_text(part.bytes, most_part_bytes);
  in.need(part.size <= most_file_bytes && part.offset <= part.size &&
          part.bytes.size() <= part.size - part.offset);
  return in.ended();
}

bool are_within(const std::vector<Sample>& samples, const SampleBounds& bounds) {
  return std::ranges::all_of(samples, [&](const Sample& sample) {
    if ((sample.flags & sample_hit) && sample.object >= bounds.objects) return false;
    if (!(sample.flags & sample_moving)) return true;  // nobody looks for its triangle again
    return sample.instance < bounds.triangles.size() &&
           sample.triangle < bounds.triangles[sample.instance];
  });
}

}  // namespace wellspring::workers
