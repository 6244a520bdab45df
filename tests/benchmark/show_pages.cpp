// SPDX-License-Identifier: Apache-2.0
// Pages of the reports on what a running show's visitors have before them.
#include "reports.h"

namespace wellspring::test {
namespace {

const std::string truth_note =
    "Converged pictures are of `path`, through the largest network; halves: what two made of half "
    "the samples each differ by. No storyteller is in them, and the fire has its mean brightness.";

}  // namespace

ReportPage show_walk_page() {
  return {
      "show.walk",
      "How right is what somebody who walks through the castle has before them, and what is shown "
      "to somebody who has just come? A server as museums run it, a visitor alone, 1280x720.",
      {"FLIP: what the screen shows, sixty times a second, against a converged picture of where "
       "the visitor is then, each in a window of 160x90 that is elsewhere for each moment. local: "
       "the visitor's device shows keyframes from there; server: pictures come finished.",
       "Wanted, local over server: 0.6 at 0 ms, 0.35 at 150 ms.", truth_note,
       "First visits: nothing is kept from before; shipped: the package carries its light. Wanted "
       "with it, after hello: 0.10 after half a second, 0.08 after two; without, 0.13 ten seconds "
       "after the server's start."},
      {{.caption = "FLIP by the round trip, ms",
        .rows = {{"trace", "walk"}, {"display", "display"}},
        .columns = {{"show.walk.flip", "FLIP"}},
        .across = "round_trip_ms",
        .most_rows = 6},
       {.caption = "Local over server by the round trip, ms",
        .rows = {{"trace", "walk"}},
        .columns = {{"show.walk.ratio", "ratio"}},
        .across = "round_trip_ms",
        .most_rows = 3},
       {.caption = "The first visit: FLIP of the whole picture in the hall",
        .rows = {{"since", "since"}, {"seconds", "seconds"}},
        .columns = {{"show.first.flip", "FLIP"}},
        .across = "light",
        .most_rows = 4}}};
}

ReportPage show_rest_page() {
  return {
      "show.rest",
      "What does the running server show a visitor who has jumped somewhere and rests? The castle "
      "at 1280x720, one visitor, the storyteller sent away.",
      {truth_note},
      {{.caption = "",
        .rows = {{"viewpoint", "viewpoint"}, {"seconds", "seconds at rest"}},
        .columns = {
            {"show.rest.flip", "FLIP"},
            {"show.rest.truth_halves_flip", "of the halves"},
            {"fps", "pictures a second", 1, "1/s"},
            {"samples", "samples a second", 1, "1/s"},
            {"show.rest.flip", "samples a pixel of the converged picture", 1, "", "spp"}}}}};
}

ReportPage show_storyteller_page() {
  return {"show.storyteller",
          "How soon is the light on the storyteller right? Her head while she tells, against a "
          "converged picture; nothing is known of her light at the beginning.",
          {"Of the samples an eighth are hers. Wanted: FLIP 0.15."},
          {{.caption = "FLIP by samples a second of the whole picture",
            .rows = {{"seconds", "seconds"}},
            .columns = {{"flip", "FLIP"}},
            .across = "samples_a_second"},
           {.caption = "One core's time",
            .rows = {{"part", "part"}},
            .columns = {{"ms", "time", 1, "ms"}},
            .most_rows = 4},
           {.caption = "",
            .columns = {{"places", "places where her light is kept"},
                        {"bytes", "memory for all visitors", 1e-6, "MB"},
                        {"truth_halves_flip", "FLIP of the converged picture's halves"}},
            .most_rows = 3}}};
}

ReportPage show_load_page() {
  return {"show.load",
          "What does somebody see who walks through the castle, where the server has few or busy "
          "cores? The walk of `show.walk`.",
          {"Busy: as many threads that do nothing but compute, on the server's cores.",
           "FLIP: decoded pictures of 1280x720 against converged ones of the pose that they show, "
           "each in a window of 160x90 that is elsewhere for each pose.",
           truth_note},
          {{.caption = "",
            .rows = {{"cores", "cores"}, {"busy", "busy"}},
            .columns = {{"show.load.flip", "FLIP, mean"},
                        {"show.load.flip_worst", "in the worst half second"},
                        {"show.load.flip_late", "against the visitor's own pose by then"},
                        {"show.load.truth_halves_flip", "of the halves"},
                        {"show.load.flip", "pictures judged", 1, "", "judged"},
                        {"show.load.fps", "pictures a second", 1, "1/s"},
                        {"show.load.drawn_fps", "keyframes a second", 1, "1/s"},
                        {"show.load.latency_ms", "pose to picture, median"},
                        {"show.load.still_gap_ms", "longest gap"},
                        {"show.load.picture_bytes", "a picture, median", 1e-3, "kB"}}}}};
}

ReportPage pieces_picture_page() {
  return {
      "pieces.picture",
      "How soon is a very large picture sharp, how many of its tiles are served, and what memory "
      "does it take? 19968x14592 texels, 4 m wide, a tiled TIFF of JPEGs.",
      {"Jump: from a camera message to the first picture, at 1280x720, that has six tenths of the "
       "details of the last after five seconds: of the Laplacian of squares of 2x2 pixels. One "
       "visitor, random places 0.25 to 0.6 m before it.",
       "Tiles: eight connections ask for random ones of the five finest levels (IIIF); the "
       "questions share the cores with the server. iipimage: behind lighttpd, a process a core.",
       "Memory: 32 visitors jump to such places every two seconds, for ten seconds. The store may "
       "take 256 MiB."},
      {{.caption = "Jumps",
        .rows = {{"jumps", "jumps"}},
        .columns = {{"pieces.picture.jump_ms_p50", "median"},
                    {"pieces.picture.jump_ms_p95", "95th percentile"}},
        .most_rows = 1},
       {.caption = "Walk along it, 0.4 m before it",
        .rows = {{"speed", "m/s"}},
        .columns = {{"pieces.picture.pan_too_coarse", "pixels over a level too coarse", 100, "%"}},
        .most_rows = 1},
       {.caption = "Tiles",
        .rows = {{"server", "server"}},
        .columns = {{"pieces.tiles_a_second", "tiles a second", 1, "1/s"},
                    {"pieces.tile_ms_p99", "a tile, 99th percentile"},
                    {"pieces.tiles_refused", "refused"}},
        .most_rows = 2},
       {.caption = "Memory",
        .rows = {{"visitors", "visitors"}, {"size", "size"}},
        .columns = {{"pieces.picture.store_bytes", "the store", 1.0 / (1 << 20), "MiB"},
                    {"pieces.picture.coarser_levels", "levels coarser, to fit"},
                    {"pieces.picture.server_memory", "memory of the server"}},
        .most_rows = 1}}};
}

}  // namespace wellspring::test
