// SPDX-License-Identifier: Apache-2.0
// fuzz_make_seeds FOLDER: writes those seeds of the corpus that are no text. Run it again when a
// format of our own changes (build target fuzz_make_seeds).
#include <sndfile.h>

#include "frame/picture_file.h"
#include "fuzz/lit_square.h"
#include "fuzz/spoken.h"
#include "image/image.h"
#include "ledger/sums.h"
#include "light/kept/map_file.h"
#include "unit/avatar/load/vrm_person.h"
#include "unit/denoise/tza.h"
#include "unit/folder.h"
#include "unit/kiosk/network/graph/made_graph.h"
#include "unit/show/exhibit/room_package.h"
#include "unit/store/band_files/made_bands.h"
#include "unit/store/format/pictures.h"
#include "unit/volume/format/volume_files.h"
#include "unit/workers/messages.h"
#include "workers/jobs/job_message.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

struct Corpus {
  fs::path root;
  test::Folder folder;  // for what is made as a file

  std::string path(const std::string& target, const std::string& name) const {
    fs::create_directories(root / target);
    return (root / target / name).string();
  }
  void put(const std::string& target, const std::string& name, const auto& bytes) const {
    std::ofstream out(path(target, name), std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  // Puts the bytes behind a kept file's head.
  void put_contents(const std::string& target, const std::string& name) const {
    put(target, name, folder.read(name).substr(24));
  }
};

void write_recordings(const Corpus& corpus) {
  std::vector<float> samples(2000);
  for (size_t i = 0; i < samples.size(); i++) samples[i] = 0.3f * std::sin(0.05f * float(i));
  const std::pair<const char*, int> kinds[] = {
      {"tone.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_16},
      {"tone.ogg", SF_FORMAT_OGG | SF_FORMAT_VORBIS},
      {"tone.mp3", SF_FORMAT_MPEG | SF_FORMAT_MPEG_LAYER_III},
      {"tone.wav", SF_FORMAT_WAV | SF_FORMAT_IMA_ADPCM},
      {"tone.aiff", SF_FORMAT_AIFF | SF_FORMAT_FLOAT}};
  for (const auto& [name, format] : kinds) {
    SF_INFO info{};
    info.samplerate = 16000, info.channels = 1, info.format = format;
    SNDFILE* file = sf_open(corpus.path("recording", name).c_str(), SFM_WRITE, &info);
    if (!file) continue;
    sf_write_float(file, samples.data(), sf_count_t(samples.size()));
    sf_close(file);
  }
}

void write_pictures(const Corpus& corpus) {
  Image8 image{6, 4, std::vector<uint8_t>(72)};
  for (size_t i = 0; i < image.rgb.size(); i++) image.rgb[i] = uint8_t(i * 37);
  save_image8(corpus.path("picture", "small.png"), image, "comment");
  std::vector<uint8_t> jpeg;
  encode_jpeg(image, 80, false, jpeg);
  add_jpeg_comment("comment", jpeg);
  corpus.put("picture", "small.jpg", jpeg);
  Frame frame;
  fit_frame(6, 4, frame);
  for (size_t i = 0; i < frame.color.size(); i++) frame.color[i] = vec3(0.1f * float(i));
  const LinearView view{frame.width, frame.height, frame.color, frame.depth};
  corpus.put("picture", "small.pfm", encode_pfm(view));
  corpus.put("picture", "small.exr", encode_exr(view, "small.exr", "comment"));
  corpus.put("picture", "small.hdr",
             std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") + "\x80\x40\x20\x81" +
                 "\x10\x20\x30\x80");
}

void write_figures(const Corpus& corpus) {
  corpus.put("gltf_figure", "person.gltf", test::make_person().gltf());
  corpus.put("gltf_figure", "vrm_0.glb", test::full_person_0().glb());
  Asset person = test::full_person_1();
  person.root["extensionsUsed"].push_back("VRMC_springBone");
  person.root["extensions"]["VRMC_springBone"] = {
      {"specVersion", "1.0"},
      {"colliders",
       {{{"node", 4}, {"shape", {{"sphere", {{"offset", {0, 0.1, 0}}, {"radius", 0.1}}}}}},
        {{"node", 2}, {"shape", {{"capsule", {{"radius", 0.1}, {"tail", {0, 0.2, 0}}}}}}}}},
      {"colliderGroups", {{{"name", "head"}, {"colliders", {0, 1}}}}},
      {"springs",
       {{{"name", "hair"},
         {"joints", {{{"node", 5}, {"hitRadius", 0.02}, {"stiffness", 1}}, {{"node", 6}}}},
         {"colliderGroups", {0}}}}}};
  const int in = person.add_floats("SCALAR", 1, {0, 1}),
            out = person.add_floats("VEC4", 4, {0, 0, 0, 1, 0, 0.7f, 0, 0.7f});
  person.root["animations"].push_back(
      {{"name", "turn"},
       {"samplers", {{{"input", in}, {"output", out}, {"interpolation", "STEP"}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 3}, {"path", "rotation"}}}}}}});
  corpus.put("gltf_figure", "vrm_1.gltf", person.gltf());
}

void write_scenes(const Corpus& corpus) {
  Asset room = test::room_asset();
  test::add_clip(room, "slide", 1, {1, 0, 0}, true);
  corpus.put("gltf_scene", "room.gltf", room.gltf());
  corpus.put("gltf_scene", "triangle.glb", triangle_asset().glb());
  corpus.put("gltf_scene", "person.glb", test::dressed_person().glb());
  // Pictures, sparse data, small numbers, extensions of materials.
  Asset rich = triangle_asset();
  json& root = rich.root;
  const int uv = rich.add_accessor(rich.add_view(std::vector<uint16_t>{0, 0, 65535, 0, 0, 65535}),
                                   5123, "VEC2", 3, {{"normalized", true}});
  const int index = rich.add_view(std::vector<uint16_t>{1, 0}),
            moved = rich.add_view(std::vector<float>{2, 0, 0});
  const int sparse =
      rich.add_accessor(-1, 5126, "VEC3", 3,
                        {{"sparse",
                          {{"count", 1},
                           {"indices", {{"bufferView", index}, {"componentType", 5123}}},
                           {"values", {{"bufferView", moved}}}}}});
  json& primitive = root["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = uv;
  primitive["targets"] = {{{"POSITION", sparse}}};
  primitive["material"] = 0;
  root["meshes"][0]["weights"] = {0.5};
  std::ifstream png(corpus.path("picture", "small.png"), std::ios::binary);
  const std::string picture{std::istreambuf_iterator<char>(png), {}};
  root["images"] = {{{"uri", "data:image/png;base64," + base64(picture)}}};
  root["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
  root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_ior",
                            "KHR_materials_volume",       "KHR_materials_clearcoat",
                            "KHR_materials_anisotropy",   "KHR_texture_transform"};
  root["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}},
         {"roughnessFactor", 0.3}}},
       {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.4},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_ior", {{"ior", 1.4}}},
         {"KHR_materials_volume",
          {{"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.5, 0}}}},
         {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}},
         {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}}}}}};
  root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
  rich.add_node({{"camera", 0}, {"name", "eye"}});
  corpus.put("gltf_scene", "rich.gltf", rich.gltf());
}

void write_kept(const Corpus& corpus) {
  test::Baked& baked = fuzz::baked_square();
  const auto map = baked.map(2);
  save_map(baked.world, *map, corpus.folder.file("square.maps"), 1);
  save_bake(baked.bake, corpus.folder.file("square.bake"), 1);
  corpus.put_contents("cached_map", "square.maps");
  corpus.put_contents("cached_bake", "square.bake");
}

void write_speech(const Corpus& corpus) {
  const std::string folder = corpus.folder.file("speech"), file = fuzz::keep_speech(folder);
  corpus.put("kept_speech", "tower.speech", corpus.folder.read("speech/" + file));
}

void write_weights(const Corpus& corpus) {
  TzaFile weights;
  weights.add("enc.weight", {2, 1, 1, 1}, "oihw", 'h', {1, 2});
  weights.add("enc.bias", {2}, "x", 'f', {0.5f, -1});
  corpus.put("denoise_weights", "two.tza", weights.bytes());
}

void write_graphs(const Corpus& corpus) {
  const std::pair<const char*, MadeGraph> graphs[] = {{"small", small_graph()},
                                                      {"wide", wide_graph()}};
  for (const auto& [name, graph] : graphs)
    corpus.put("graph", name, graph.json_text() + '\0' + graph.bytes);
}

void write_sums(const Corpus& corpus) {
  const Sums sums = {{{20000, "visits", "castle"}, 3}};
  add_to_file(corpus.folder.file("sums.sqlite"), sums, 100);
  corpus.put("sums_file", "sums.sqlite", corpus.folder.read("sums.sqlite"));
}

void write_many_bands(const Corpus& corpus) {
  MadeBands made;
  made.width = 20, made.height = 9;
  made.value = [](int x, int y, int band) { return 9 * x + 5 * y + 20 * band; };
  const auto put = [&](const char* name) {
    write_bands_tiff(corpus.folder.file("bands.tif"), made);
    corpus.put("bands", name,
               wavelengths_json(3, 430, 100) + '\0' + corpus.folder.read("bands.tif"));
  };
  put("tiles.bands");
  made.tile = 0, made.code = store::BandCode::u8, made.planar = true;
  put("strips.bands");
  made.code = store::BandCode::f32, made.pages = true;
  put("pages.bands");
}

void write_large_pictures(const Corpus& corpus) {
  const auto put = [&](const char* name, const std::vector<TiffSpec>& pages, bool sub = false,
                       const char* mode = "w") {
    write_tiff(corpus.folder, pages, sub, mode);
    corpus.put("tiff_picture", name, corpus.folder.read("test.tif"));
  };
  TiffSpec fine;
  fine.width = 26, fine.height = 18, fine.compression = COMPRESSION_LZW;
  TiffSpec coarse = fine;
  coarse.width = 13, coarse.height = 9;
  put("pages.tif", {fine, coarse});
  put("sub.tif", {fine, coarse}, true, "w8");
  fine.photometric = PHOTOMETRIC_YCBCR, fine.compression = COMPRESSION_JPEG;
  put("jpeg.tif", {fine});
  fine.photometric = PHOTOMETRIC_SEPARATED, fine.compression = COMPRESSION_ADOBE_DEFLATE;
  fine.planar = PLANARCONFIG_SEPARATE, fine.channels = 4, fine.orientation = 6, fine.bits = 16;
  put("inks.tif", {fine}, false, "wb");
  TiffSpec lines;
  lines.width = 30, lines.tile = 0, lines.bits = 1, lines.channels = 1;
  lines.photometric = PHOTOMETRIC_MINISWHITE, lines.compression = COMPRESSION_CCITTFAX4;
  lines.codes = [](int x, int y, int) { return (x + y) / 7 % 2; };
  put("lines.tif", {lines});
  lines.photometric = PHOTOMETRIC_PALETTE, lines.bits = 4, lines.compression = COMPRESSION_PACKBITS;
  put("palette.tif", {lines});
  // A page whose EXIF says that it is mirrored.
  std::vector<uint8_t> jpeg;
  encode_jpeg({6, 4, std::vector<uint8_t>(72, 99)}, 80, false, jpeg);
  const std::string exif =
      std::string("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x05", 27) +
      std::string(6, '\0');
  std::string turned(jpeg.begin(), jpeg.end());
  turned.insert(2, std::string("\xff\xe1\0", 3) + char(exif.size() + 2) + exif);
  corpus.put("plain_picture", "turned.jpg", turned);
  corpus.put("plain_picture", "small.png", png_of(5, 3, pattern));
}

// The first byte is the number of the name in fuzz_volume_file.cpp.
void write_volumes(const Corpus& corpus) {
  const auto put = [&](const char* name, char number, const std::string& bytes) {
    corpus.put("volume_file", name, std::string(1, number) + bytes);
  };
  NiftiFile nifti;
  nifti.dim = {4, 2, 3, 2, 2}, nifti.type = 4, nifti.sform_code = nifti.qform_code = 1;
  nifti.slope = 2;
  const std::string samples(48, 'a');
  put("one.nii", 0, nifti.header() + samples);
  put("packed.nii.gz", 1, pack(nifti.header() + samples));
  nifti.is_big = true, nifti.sform_code = 0;
  put("big.nii", 0, nifti.header() + samples);
  nifti.is_version_2 = true;
  put("version_2.nii", 0, nifti.header() + samples);
  nifti.is_version_2 = false, nifti.type = 2304, nifti.magic = "ni1";
  put("pair.hdr", 2, nifti.header());
  nifti.type = 2, nifti.magic = "", nifti.orient = 1;
  put("analyze.hdr", 2, nifti.header());
  const std::string nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 2\nendian: big\n";
  put("vectors.nrrd", 3,
      nrrd +
          "encoding: raw\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0.5,1)\n"
          "space origin: (1,2,3)\nbyte skip: -1\n\n" +
          samples);
  put("packed.nrrd", 3, nrrd + "encoding: gzip\nspacings: 1 2 3\n\n" + pack(samples));
  put("numbered.nhdr", 4, nrrd + "encoding: raw\ndata file: volume.%d 1 2 1\nline skip: 1\n");
  put("listed.nhdr", 4, nrrd + "encoding: raw\ndata file: LIST\nvolume.1\nvolume.2\n");
  put("color.nrrd", 3,
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n"
      "kinds: RGB-color domain domain\n\n" +
          samples);
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_FLOAT\n"
      "TransformMatrix = 0 1 0 1 0 0 0 0 1\nOffset = 1 2 3\nElementSpacing = 1 2 3\n";
  put("local.mha", 5,
      meta + "CompressedData = True\nElementDataFile = LOCAL\n" + pack(samples, false));
  put("beside.mhd", 6, meta + "HeaderSize = -1\nElementDataFile = volume.raw\n");
  put("runs.slc", 7,
      std::string("11111\n2 2 2 8\n1 1 1\n1 7 0 1\n1 1 Xrgb2X\x04q5X\x82") + "ab\x02z");
  put("raw.json", 8,
      R"({"file": "volume.raw", "size": [2, 3, 4], "kind": "i16", "spacing_mm": [1, 2, 3],)"
      R"( "byte_order": "big", "origin": [0, 0, 1], "axes": "RAS", "slope": 2})");
}

void write_worker_messages(const Corpus& corpus) {
  const MessageKey none;
  corpus.put("worker_message", "order", write_message(make_order(), none));
  corpus.put("worker_message", "answer", write_message(make_answer(), none));
  corpus.put("worker_message", "refusal",
             write_message(TraceAnswer{1, 2, "north", Refusal::light, 0, 0, {}}, none));
  corpus.put("worker_message", "question", write_message(MapQuestion{1, 2, 0, 4096}, none));
  corpus.put("worker_message", "part", write_message(MapPart{1, 2, 0, 6, 9, "abc"}, none));
  corpus.put("worker_message", "call", write_message(RollCall{3, 4}, none));
  corpus.put("worker_message", "here",
             write_message(CallAnswer{3, 4, "north", "0.1.0", "x86-64 avx2", 8}, none));
}

void write_job_messages(const Corpus& corpus) {
  const MessageKey none;
  corpus.put("job_message", "order",
             write_job(JobOrder{"bake-hall-01",
                                "0.1.0",
                                "x86-64 avx2",
                                77,
                                8,
                                {"bake", "content/hall", "--passes", "64"}},
                       none));
  corpus.put("job_message", "lamps",
             write_job(JobOrder{"lamps-01",
                                "0.1.0",
                                "x86-64 avx2",
                                77,
                                1,
                                {"lamps", "--lamp-file", "a.csv", "b.csv", "--picture", "p.tif"}},
                       none));
  corpus.put("job_message", "task", write_job(ShardTask{"bake-hall-01", 3, 1}, none));
  corpus.put("job_message", "done",
             write_job(JobEvent{"bake-hall-01",
                                3,
                                JobNews::done,
                                9,
                                2,
                                1,
                                "north",
                                "",
                                20,
                                {{"4.bake", {1, 2, 3}, 4096}}},
                       none));
}

}  // namespace
}  // namespace wellspring::test

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using namespace wellspring;
  using namespace wellspring::test;
  const Corpus corpus{argv[1], {}};
  write_recordings(corpus);
  write_pictures(corpus);
  write_figures(corpus);
  write_scenes(corpus);
  write_kept(corpus);
  write_speech(corpus);
  write_weights(corpus);
  write_graphs(corpus);
  write_sums(corpus);
  write_large_pictures(corpus);
  write_many_bands(corpus);
  write_volumes(corpus);
  write_worker_messages(corpus);
  write_job_messages(corpus);
  return 0;
}
