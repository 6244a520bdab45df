// SPDX-License-Identifier: Apache-2.0
// pieces.picture: a picture of 291 million texels in a room. How soon does a visitor who jumps to a
// place close before it see it sharp; how many of its tiles are served to viewers, beside iipimage;
// how much memory do 32 visitors take of the store?
//
// A shown picture is sharp if it has at least `sharp_share` of the details of the last one, which
// comes after seconds of rest. Noise of light and of JPEG, and where pixels are sampled, count
// little in that. Before pieces have come a picture has about a quarter of them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <thread>

#include "base/clock.h"
#include "base/log.h"
#include "large_picture_room.h"
#include "report.h"
#include "reports.h"
#include "show_visit.h"
#include "tile_rate.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

constexpr double sharp_share = 0.6;
constexpr double jump_rest = 5;                         // seconds
constexpr double pan_distance = 0.4, pan_speed = 0.25;  // metres, metres a second
constexpr int tile_connections = 8;
constexpr int gazers = 32, gazer_width = 640, gazer_height = 360;

// Returns a pose close before the picture that looks straight at it.
CameraTo close_place(std::mt19937& random, uint32_t seq) {
  auto between = [&](double low, double high) {
    return low + (high - low) * double(random()) / 4294967296.0;
  };
  using Room = LargePictureRoom;
  const double across = 0.42 * Room::picture_width;
  const double up = across * Room::height / Room::width;
  CameraTo to;
  to.seq = seq;
  to.position = {between(-across, across), Room::middle_height + between(-up, up),
                 Room::surface + between(0.25, 0.6)};
  return to;
}

// Returns the details of a picture: the Laplacian of the luminance of squares of 2x2 pixels. Pixels
// alone differ from one picture at rest to the next, which has them sampled elsewhere.
std::vector<int> details_of(const Image8& picture) {
  const int columns = picture.width / 2, rows = picture.height / 2;
  std::vector<int> luminance(size_t(columns) * size_t(rows)), details;
  for (int y = 0; y < 2 * rows; y++)
    for (int x = 0; x < 2 * columns; x++) {
      const uint8_t* rgb = &picture.rgb[3 * (size_t(y) * size_t(picture.width) + size_t(x))];
      luminance[size_t(y / 2 * columns + x / 2)] += 2 * rgb[0] + 5 * rgb[1] + rgb[2];
    }
  details.reserve(luminance.size());
  for (int y = 1; y + 1 < rows; y++)
    for (int x = 1; x + 1 < columns; x++) {
      const int* at = &luminance[size_t(y * columns + x)];
      details.push_back(4 * at[0] - at[-1] - at[1] - at[-columns] - at[columns]);
    }
  return details;
}

// Returns how much of `wanted` is in `shown`: 1 if it is all there, whatever else there is.
double share_of(const std::vector<int>& shown, const std::vector<int>& wanted) {
  double found = 0, all = 0;
  for (size_t i = 0; i < wanted.size(); i++)
    found += double(shown[i]) * wanted[i], all += double(wanted[i]) * wanted[i];
  return all > 0 ? found / all : 1;
}

struct JumpArrival {
  double after = 0;      // milliseconds since the jump
  bool follows = false;  // whether it shows the place jumped to
  std::vector<uint8_t> message;
};

// Returns after how many milliseconds the first sharp picture came; NaN: no picture of that place
// came. `screen` shows what came before, and then the last one.
double first_sharp(const std::vector<JumpArrival>& arrivals, Screen& screen) {
  struct Seen {
    double after;
    bool follows;
    std::vector<int> details;
  };
  std::vector<Seen> seen;
  for (const JumpArrival& one : arrivals)
    if (screen.receive(one.message))
      seen.push_back({one.after, one.follows, details_of(screen.picture())});
  for (const Seen& one : seen)
    if (one.follows && share_of(one.details, seen.back().details) >= sharp_share) return one.after;
  return std::nan("");
}

void measure_jumps(BenchReport& report, const ServerProcess& server, bool quick) {
  WsClient client;
  join_alone(client, server);
  Screen screen(shown_width, shown_height);
  look_until(client, seconds_now() + jump_rest,
             [&](const WsMessage& message) { screen.receive(message.bytes); });
  std::mt19937 random(7);
  std::vector<double> times;
  const int jumps = quick ? 8 : 24;
  for (uint32_t seq = 1; seq <= uint32_t(jumps); seq++) {
    std::vector<JumpArrival> arrivals;
    const double sent = seconds_now();
    client.send_text(write_message(close_place(random, seq)));
    look_until(client, sent + jump_rest, [&](const WsMessage& message) {
      const bool follows = read_packet(message.bytes)->header.seq == seq;
      arrivals.push_back({1000 * (seconds_now() - sent), follows, message.bytes});
    });
    const double after = first_sharp(arrivals, screen);
    times.push_back(std::isnan(after) ? 1000 * jump_rest : after);
  }
  client.close();
  const nlohmann::json where = {{"size", "1280x720"}, {"jumps", jumps}};
  report.add("pieces.picture.jump_ms_p50", quantile(times, 0.5), "ms", where);
  report.add("pieces.picture.jump_ms_p95", quantile(times, 0.95), "ms", where);
}

// Counts pixels of large pictures, and those more than a level too coarse, over a walk along the
// picture at display rate.
void measure_pan(BenchReport& report, const ServerProcess& server, bool quick) {
  using Room = LargePictureRoom;
  WsClient client;
  join_alone(client, server);
  const double reach = 0.42 * Room::picture_width, seconds = quick ? 6 : 20;
  CameraTo to;
  auto go = [&](double across) {
    to.seq++;
    to.position = {across, Room::middle_height, Room::surface + pan_distance};
    client.send_text(write_message(to));
  };
  go(-reach);
  look_until(client, seconds_now() + 2, [](const WsMessage&) {});
  auto read = [&](const char* detail) {
    return read_metric(server.port, std::string("store_looks_total{detail=\"") + detail + "\"}");
  };
  const double wanted = read("wanted"), coarse = read("too_coarse"), began = seconds_now();
  for (double now = began; now < began + seconds; now = seconds_now()) {
    const double way = std::fmod(pan_speed * (now - began), 4 * reach);
    go(way < 2 * reach ? way - reach : 3 * reach - way);
    look_until(client, now + 1 / 60.0, [](const WsMessage&) {});
  }
  const double soft = read("too_coarse") - coarse, all = read("wanted") - wanted + soft;
  client.close();
  report.add("pieces.picture.pan_too_coarse", soft / std::max(all, 1.0), "",
             {{"size", "1280x720"}, {"speed", pan_speed}});
}

void measure_tiles(BenchReport& report, const std::string& server, uint16_t port,
                   const std::string& picture, double seconds) {
  ask_for_tiles(port, picture, tile_connections, 1);  // so that nobody begins with cold files
  const TileRate rate = ask_for_tiles(port, picture, tile_connections, seconds);
  const nlohmann::json where = {{"server", server}, {"connections", tile_connections}};
  report.add("pieces.tiles_a_second", rate.tiles_a_second, "1/s", where);
  report.add("pieces.tile_ms_p99", quantile(rate.times, 0.99), "ms", where);
  if (rate.refused > 0) report.add("pieces.tiles_refused", double(rate.refused), "", where);
}

// Looks at one place after the other.
void gaze(uint16_t port, int number, double until) {
  WsClient client;
  join_visit(client, port, gazer_width, gazer_height);
  std::mt19937 random(uint32_t(number) + 100);
  for (uint32_t seq = 1; seconds_now() < until; seq++) {
    client.send_text(write_message(close_place(random, seq)));
    look_until(client, std::min(until, seconds_now() + 2), [](const WsMessage&) {});
  }
  client.close();
}

void measure_memory(BenchReport& report, const BenchOptions& options) {
  const ServerProcess server(options, LargePictureRoom::exhibit);
  const double until = seconds_now() + 11;
  std::vector<std::jthread> threads;
  std::vector<std::string> problems(gazers);
  for (int i = 0; i < gazers; i++)
    threads.emplace_back([&, i] {
      try {
        gaze(server.port, i, until);
      } catch (const std::exception& error) {
        problems[size_t(i)] = error.what();
      }
    });
  std::this_thread::sleep_for(std::chrono::seconds(10));
  const nlohmann::json where = {{"visitors", gazers}, {"size", "640x360"}};
  const double bytes = read_metric(server.port, "store_bytes");
  const double coarser = read_metric(server.port, "store_coarser_levels");
  const double memory = server.resident() / (1 << 20);
  threads.clear();
  for (const std::string& problem : problems)
    if (!problem.empty()) throw std::runtime_error(problem);
  report.add("pieces.picture.store_bytes", bytes, "B", where);
  report.add("pieces.picture.coarser_levels", coarser, "", where);
  report.add("pieces.picture.server_memory", memory, "MiB", where);
}

}  // namespace

void bench_pieces_picture(BenchReport& report, const BenchOptions& asked) {
  const LargePictureRoom room;
  BenchOptions options = asked;
  options.content = room.content();
  const double seconds = options.quick ? 4 : 12;
  {
    const ServerProcess server(options, LargePictureRoom::exhibit);
    measure_jumps(report, server, options.quick);
    measure_pan(report, server, options.quick);
    const std::string picture =
        std::string("/iiif/") + LargePictureRoom::exhibit + "~" + LargePictureRoom::piece;
    measure_tiles(report, "wellspring", server.port, picture, seconds);
  }
  {
    const IipServer iip(room.content());
    const std::string file = room.picture().substr(room.content().size() + 1);
    if (iip.port() != 0) measure_tiles(report, "iipimage", iip.port(), iip.address(file), seconds);
    else log::info("iipimage is left out: iipimage-server or lighttpd is not installed");
  }
  // Everybody is let in, at however few pictures.
  if (options.server_words.empty())
    options.server_words = {"--least-fps", "0.01", "--max-visitors", "1000"};
  measure_memory(report, options);
}

}  // namespace wellspring::test
