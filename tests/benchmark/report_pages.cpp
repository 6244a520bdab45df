// SPDX-License-Identifier: Apache-2.0
// What each report's page shows: its question, how to read its figures, and tables.
#include "reports.h"
#include "splat_bench.h"

namespace wellspring::test {
namespace {

ReportPage stream_page() {
  return {
      "stream",
      "How quickly does a visitor see what an input does? The server and a scripted client that "
      "strolls up and down the castle over loopback, at 1280x720; both share the cores.",
      {"Wanted: 60 pictures a second and at most 50 ms from input to picture (95th percentile).",
       "Slow lines are a proxy's; lag is from a picture's making to its acknowledgement, at "
       "most two round trips and 100 ms are wanted; recovery: until pictures are whole and at full "
       "quality when the line carries 500 Mbit/s again, at most 3 s."},
      {{.caption = "",
        .columns = {{"stream.walk.fps", "pictures a second", 1, "1/s"},
                    {"stream.walk.drawn_fps", "of them drawn anew"},
                    {"stream.walk.warped_fps", "warps of drawn ones"},
                    {"stream.walk.repeated", "the same as the one before"},
                    {"stream.walk.latency_p50_ms", "input to picture, median"},
                    {"stream.walk.latency_p95_ms", "input to picture, 95th percentile"},
                    {"stream.walk.gap_p95_ms", "gap between pictures, 95th percentile"},
                    {"stream.walk.picture_bytes_p50", "a picture, median", 1e-3, "kB"},
                    {"stream.walk.server_memory", "memory of the server with one visitor"}}},
       {.caption = "Over slow lines",
        .rows = {{"mbit", "Mbit/s"}, {"round_trip_ms", "round trip, ms"}},
        .columns = {{"stream.shaped.lag_p50_ms", "lag, median"},
                    {"stream.shaped.lag_p95_ms", "lag, 95th percentile"},
                    {"stream.shaped.lag_most_ms", "lag, most"},
                    {"stream.shaped.gap_most_ms", "gap between pictures, most"},
                    {"stream.shaped.fps", "pictures a second"},
                    {"stream.shaped.quality_p50", "quality, median"},
                    {"stream.shaped.width_p50", "width, median"},
                    {"stream.shaped.used", "of the line"},
                    {"stream.shaped.recovery_s", "recovery"}}}}};
}

ReportPage avatar_page() {
  std::vector<PageColumn> parts = {{"avatar.made.tick.ms", "whole tick, ms"},
                                   {"avatar.made.animate.ms", "decide and animate, ms"},
                                   {"avatar.made.skin.ms", "skin, ms"},
                                   {"avatar.made.refit.ms", "refit of the ray tracer's tree, ms"}};
  std::vector<PageColumn> storyteller_place = parts;
  for (PageColumn& column : storyteller_place) column.metric.erase(7, 5);  // avatar.tick.ms
  storyteller_place.push_back({"avatar.tick.ms", "triangles", 1, "", "triangles"});
  return {"avatar",
          "What does a figure cost each tick? One core.",
          {"Medians of the ticks; the made avatar's variants tick in turns, in processor time."},
          {{.caption = "The castle's storyteller", .columns = storyteller_place},
           {.caption = "An avatar that the benchmark makes, speaking",
            .rows = {{"technique", "what it has"}, {"springs", "spring bones"}},
            .columns = parts}}};
}

ReportPage attention_page() {
  return {
      "attention",
      "What does it cost to predict where a visitor looks? Saliency of a picture with 400 "
      "coloured things, their measures with two hints, and an order of 1000 shares. Medians. "
      "And what is it worth, where a visitor of the castle points at a thing?",
      {"Wanted: at most 8 ms for the saliency of 512x512 pixels, and cost linear in pixels.",
       "Samples: a pixel of the picture, until the thing's FLIP is what it is without attention "
       "in the end: after two of gather, four of path. Wanted: a third of them, with at most 1.1 "
       "times the whole picture's FLIP."},
      {{.caption = "",
        .rows = {{"width", "width"}, {"height", "height"}, {"cores", "cores"}},
        .columns = {{"attention.ms", "saliency"},
                    {"ns_a_pixel", "of it a pixel"},
                    {"objects_ms", "objects and order"},
                    {"memory", "memory kept"}}},
       {.caption = "Samples where attention is, castle at 192x108",
        .rows = {{"thing", "thing"}, {"technique", "technique"}, {"order", "order"}},
        .columns = {{"attention.steer.samples", "samples"},
                    {"attention.steer.ratio", "over those without"},
                    {"attention.steer.flip", "its FLIP in the end"},
                    {"attention.steer.whole_flip", "of the whole picture"},
                    {"attention.steer.whole_ratio", "over that without"}},
        .most_rows = 16}}};
}

ReportPage cache_display_page() {
  return {
      "cache.display",
      "What does showing remembered points cost, without tracing? The render cache as published, "
      "all points in use, a stroll at 1280x720.",
      {"The yardstick is a bare loop on one core: transform, divide, z-test, store.",
       "One core: processor time. All cores: by the clock."},
      {{.caption = "",
        .columns = {{"ms", "all cores"},
                    {"ms_one_core", "one core"},
                    {"weighted_ms_one_core", "one core, with weights of objects"},
                    {"yardstick_ms_one_core", "the yardstick"},
                    {"yardstick_ratio", "one core over the yardstick", 1, "1"},
                    {"memory", "memory of a cache"}}},
       {.caption = "Stages on one core",
        .rows = {{"stage", "stage"}},
        .columns = {{"stage_ms", "time"}},
        .most_rows = 10},
       {.caption = "Other sizes",
        .rows = {{"size", "size"}},
        .columns = {{"size_ms", "all cores"}, {"size_ms_one_core", "one core"}},
        .most_rows = 4}}};
}

ReportPage cache_warp_page() {
  return {
      "cache.warp",
      "How good is a drawn picture that is warped to a later view? Reflectances in a light from "
      "one direction, so that nothing but the warp differs; recorded visits at 1280x720.",
      {"Held: the drawn picture as it was.",
       "Displaced: pixels that nothing within one pixel of the true picture explains.",
       "Outside: pixels beyond the drawn picture and its margin; they continue its border."},
      {{.caption = "",
        .rows = {{"trace", "visit"}, {"age_ms", "age, ms"}},
        .columns = {{"flip", "FLIP warped"},
                    {"held_flip", "FLIP held"},
                    {"displaced", "displaced"},
                    {"unknown", "outside"},
                    {"processor_ms", "a warp, processor"},
                    {"keyframe_processor_ms", "making the keyframe, processor"}},
        .most_rows = 30}}};
}

ReportPage cache_visit_page() {
  return {
      "cache.visit",
      "How much error has the picture that a walking visitor sees, at equal numbers of samples? "
      "Recorded visits of the castle, every method with the same samples a frame.",
      {"Mismatch: pixels over samples a frame. First: mean FLIP over the visits; lag counts.",
       "primary: the show's own way, a picture a frame: answers a picture late, attention, the "
       "light that the package carries; told of lamps. The others are baselines; cache: the render "
       "cache as published."},
      {{.caption = "",
        .rows = {{"mismatch", "mismatch"}},
        .columns = {{"mean_flip", "FLIP"}},
        .across = "method",
        .most_rows = 6},
       {.caption = "FLIP over that of the best baseline",
        .rows = {{"mismatch", "mismatch"}},
        .columns = {{"flip_ratio", "ratio"}},
        .across = "method",
        .most_rows = 6},
       {.caption = "Each visit at the last mismatch, by the show's own way",
        .rows = {{"trace", "visit"}},
        .columns = {{"flip", "FLIP"},
                    {"rmse", "RMSE, display"},
                    {"temporal", "change along the motion, display"},
                    {"wrong_surface", "wrong surface", 100, "%"}},
        .only = {{"method", {"primary"}}},
        .most_rows = 10}}};
}

ReportPage cache_rest_page() {
  return {
      "cache.rest",
      "How soon does a picture at rest become the reference? FLIP after a jump to a place never "
      "seen, for tracers of so many samples a second at 1280x720.",
      {"cache: points as published; primary: drawn and corrected by samples; denoised: learned "
       "reconstruction. Wanted: 0.03 after 2 s.",
       "castle_part is a piece of a view 1280 wide; castle is all of it, mostly edges.",
       "Halves: what the two halves of the converged picture differ by, which all figures have."},
      {{.caption = "After 2 seconds",
        .rows = {{"scene", "scene"}, {"samples_a_second", "samples a second"}},
        .columns = {{"cache.rest.flip", "FLIP"}},
        .across = "method",
        .only = {{"seconds", {2}}},
        .most_rows = 12},
       {.caption = "By the show's own way, without the network: RMSE after 2 seconds",
        .rows = {{"scene", "scene"}},
        .columns = {{"cache.rest.rmse", "RMSE"}},
        .across = "samples_a_second",
        .only = {{"seconds", {2}}, {"method", {"primary"}}},
        .most_rows = 4},
       {.caption = "What the figures contain",
        .rows = {{"scene", "scene"}},
        .columns = {{"truth_halves_flip", "FLIP of the halves"}},
        .most_rows = 4}}};
}

ReportPage cache_starve_page() {
  return {
      "cache.starve",
      "What does a picture of very few samples look like? FLIP by samples a pixel, nobody moving.",
      {"cache: points as published; primary: the show's own way."},
      {{.caption = "",
        .rows = {{"view", "view"}, {"method", "method"}},
        .columns = {{"flip", "FLIP"}},
        .across = "samples_a_pixel",
        .most_rows = 16}}};
}

ReportPage cache_turns_page() {
  return {"cache.turns",
          "What does somebody see who turns quickly by keys, where a keyframe takes long? Turns of "
          "1.5 rad/s, held for 0.1 to 2 s.",
          {"Outside: pixels beyond the keyframe, by what is foreseen of the motion.",
           "Surroundings: a small wide picture of what lies around, drawn before the keyframe."},
          {{.caption = "Outside of the keyframe, over a minute",
            .rows = {{"drawing_ms", "a keyframe takes, ms"}, {"prediction", "prediction"}},
            .columns = {{"unknown", "mean"}, {"unknown_p95", "95th percentile"}},
            .most_rows = 16},
           {.caption = "In the castle's hall",
            .rows = {{"drawing_ms", "a keyframe takes, ms"}, {"surroundings", "surroundings"}},
            .columns = {{"flip", "FLIP"},
                        {"flip_p95", "FLIP, 95th percentile"},
                        {"hall_unknown", "unknown"},
                        {"surroundings_drawn", "keyframes with surroundings"}},
            .most_rows = 8}}};
}

ReportPage cache_switch_page() {
  return {
      "cache.switch",
      "How soon is the light right after a lamp was switched? Of the pixels that the switch "
      "changes by more than 10 %, the share within 10 % of the converged picture.",
      {"told: the show told the cache; found: the cache had to find out; cleared: it forgot all.",
       "Pictures: drawn since the switch, of 60 a second. One sample for as many pixels as the "
       "mismatch says."},
      {{.caption = "Half a second after",
        .rows =
            {{"scene", "scene"}, {"way", "visitor"}, {"light", "lamp"}, {"mismatch", "mismatch"}},
        .columns = {{"right", "right"}},
        .across = "cache",
        .only = {{"pictures", {30}}},
        .most_rows = 24},
       {.caption = "What a switch takes",
        .rows = {{"scene", "scene"}, {"light", "lamp"}},
        .columns = {{"light_ms", "for everybody"}, {"visitor_ms", "for each visitor"}},
        .most_rows = 4}}};
}

ReportPage corrective_page() {
  return {"corrective",
          "Are samples of what shines, asked for in the order of corrective splatting, worth more "
          "than others? Error of non-diffuse objects' pixels in the castle, lit by its maps, after "
          "a second's walk and at rest; samples: a 64th of the pixels each picture.",
          {"none: samples as the render cache plans them; even: half of them on such pixels in no "
           "order; objects: a fifth, in motion, object by object; groups: half, at rest, too, by "
           "groups of neighbours of one material; weighed: such objects are four times as urgent "
           "to the render cache.",
           "The walk ends after one second.",
           "No order is better by more than chance, so the server has none.",
           "Costs: 512x512 pixels of 37 objects, sampled at the three coarser of four levels, from "
           "ten views. One core: processor time. All cores: by the clock."},
          {{.caption = "FLIP of what shines",
            .rows = {{"visit", "visit"}, {"seconds", "seconds"}},
            .columns = {{"corrective.error.flip", "FLIP"}},
            .across = "order",
            .most_rows = 8},
           {.caption = "Warping and splatting",
            .rows = {{"cores", "cores"}},
            .columns = {{"corrective.splat.ms", "warp and splat"},
                        {"corrective.splat.ms", "samples", 1, "", "samples"},
                        {"corrective.splat.ms", "pixels that show one", 1, "", "pixels"}},
            .most_rows = 2},
           {.caption = "Ageing",
            .rows = {{"cores", "cores"}, {"dropped", "samples dropped"}},
            .columns = {{"corrective.age.ms", "ageing"},
                        {"corrective.age.ms", "samples", 1, "", "samples"}},
            .most_rows = 4}}};
}

ReportPage bake_page() {
  return {"bake",
          "How near do baked illumination maps come to the diffuse light that converged `path` "
          "finds, and after how long?",
          {"Error: root mean square over the mean light, luminance, at what pixels see; the "
           "reference's own noise is taken off.",
           "`gather`: rays from the texels that end in coarse light; `paths`: that go on; "
           "`particles`: density estimation of light from the sources.",
           "Maps of normals count.",
           "Wanted on two cores: hall 0.03 after 120 seconds, 0.02 after 600; castle 0.08, 0.05."},
          {{.caption = "",
            .rows = {{"scene", "scene"}, {"technique", "technique"}, {"seconds", "seconds"}},
            .columns = {{"bake.rmse_true", "error"},
                        {"bake.bias", "of the mean"},
                        {"bake.rmse_told", "estimated by itself"},
                        {"bake.known", "pixels known", 100, "%"}},
            .most_rows = 14},
           {.caption = "Storage, after the longest time",
            .rows = {{"scene", "scene"}},
            .columns = {{"bake.texels", "texels"},
                        {"bake.bytes", "all layers", 1e-6, "MB"},
                        {"bake.vertex_bytes", "at vertices of a mesh as fine", 1e-6, "MB"},
                        {"bake.seam", "mean jump at seams of charts"}},
            .most_rows = 2}}};
}

ReportPage picture_page() {
  return {
      "picture",
      "What does a drawn picture cost, without samples to trace? The castle, 1280x720.",
      {"`maps`: lit by the light that the package carries; `points`: by a visitor's own points, "
       "of which there are none.",
       "Wanted: at most 50 ms of one core.", "One core: processor time. All cores: by the clock.",
       "Depth: what a display that reprojects is sent beside the colours (JPEG, quality 82). "
       "Wanted: a quarter of their bytes, half a pixel of parallax when the eye moves by a metre."},
      {{.caption = "",
        .rows = {{"view", "view"}, {"light", "light"}},
        .columns = {{"picture.drawn.ms_one_core", "one core, ms"},
                    {"picture.drawn.ms", "all cores, ms"}}},
       {.caption = "Depth",
        .rows = {{"view", "view"}},
        .columns = {{"picture.depth.bytes", "bytes", 1e-3, "kB"},
                    {"picture.depth.share", "of the colours'", 100, "%"},
                    {"picture.depth.encode_ms", "encoding, ms"},
                    {"picture.depth.decode_ms", "decoding, ms"},
                    {"picture.depth.parallax_px", "off by at most, pixels"}}}}};
}

ReportPage denoise_time_page() {
  return {"denoise.ms",
          "How long does the learned reconstruction of one picture take?",
          {"The peak is that of the processor's fused multiplications and additions, measured."},
          {{.caption = "", .columns = {{"denoise.peak", "peak of the processor"}}, .most_rows = 1},
           {.caption = "",
            .rows = {{"net", "network"}, {"width", "width"}, {"height", "height"}},
            .columns = {{"denoise.ms", "reconstruction"},
                        {"encode_ms", "preparing its input"},
                        {"peak_share", "of the peak", 100, "%"},
                        {"bytes", "memory for all visitors", 1e-6, "MB"}}}}};
}

ReportPage denoise_flip_page() {
  return {
      "denoise.flip",
      "How much error has a picture of few samples after learned reconstruction? The castle.",
      {"Halves: what the two halves of the converged picture differ by, which all figures have."},
      {{.caption = "",
        .rows = {{"spp", "samples a pixel"}},
        .columns = {{"denoise.flip", "FLIP"}},
        .across = "net"},
       {.caption = "", .columns = {{"truth_halves_flip", "FLIP of the halves"}}, .most_rows = 1}}};
}

std::vector<ReportPage> declared_pages() {
  return {stream_page(),
          avatar_page(),
          attention_page(),
          kiosk_face_page(),
          kiosk_eye_page(),
          kiosk_screen_page(),
          kiosk_figures_page(),
          kiosk_expression_page(),
          kiosk_hard_page(),
          kiosk_gestures_page(),
          kiosk_hands_page(),
          kiosk_station_page(),
          kiosk_map_page(),
          cache_display_page(),
          cache_warp_page(),
          cache_visit_page(),
          cache_rest_page(),
          cache_starve_page(),
          cache_turns_page(),
          cache_switch_page(),
          corrective_page(),
          bake_page(),
          picture_page(),
          denoise_time_page(),
          denoise_flip_page(),
          show_walk_page(),
          show_rest_page(),
          show_storyteller_page(),
          show_load_page(),
          load_visitors_page(),
          load_seats_page(),
          workers_page(),
          load_plan_page(),
          pieces_picture_page(),
          pieces_bands_page(),
          pieces_scan_page(),
          pieces_splats_page(),
          pieces_particles_page(),
          pieces_lawn_page(),
          volume_reconstruct_page(),
          lamps_page(),
          spectral_page(),
          spectral_color_page(),
          volume_march_page(),
          volume_compressed_page(),
          light_frame_page(),
          light_scaling_page(),
          splat_page(),
          splat_error_page(),
          light_error_page("light.error"),
          light_error_page("light.hall"),
          light_rays_page(),
          light_cycles_page(),
          light_photons_page(),
          light_dynamic_page()};
}

}  // namespace

ReportPage find_page(const std::string& name) {
  for (ReportPage& page : declared_pages())
    if (page.report == name) return page;
  return plain_page(name);
}

}  // namespace wellspring::test
