// SPDX-License-Identifier: Apache-2.0
// Fits the factors of kiosk/face/expression.h to pictures of figures whose expressions are known,
// and says how often factors are right for a figure that they were not fitted to.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <sstream>

#include "about/version.h"
#include "base/log.h"
#include "kiosk/face/expression.h"
#include "kiosk/face/face_finder.h"
#include "tell.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;
using namespace kiosk;
using nlohmann::json;

constexpr const char* names[] = {"joy", "sadness", "anger", "fear", "disgust", "surprise"};
constexpr size_t expressions = std::size(names);
constexpr float least = 0.2f;         // weaker is no emotion (avatar/face/face.h)
constexpr float turned_from = 0.06f;  // radians; heads that are turned less are at rest
constexpr double ridge = 0.1, noise = 2.5;
constexpr int reads = 2;  // looks at each picture, each with noise of its own

// A picture that was read.
struct Look {
  std::string figure, expression;  // an expression of no name is none
  float strength = 0;              // 0..1
  bool turned = false;
  FaceMesh mesh;
  FaceClasses classes{};
  Cues cues{};
};

class Reader {
 public:
  explicit Reader(const fs::path& weights)
      : finder_(make_network_finder((weights / "face").string(),
                                    MeshReader((weights / "human").string()))),
        classes_((weights / "face").string()) {}

  // Reads the face of a picture as the eye does, once it follows it.
  std::optional<Look> read(const cv::Mat& picture) {
    GrayFrame frame{0, picture.cols, picture.rows, {}};
    std::optional<Face> face;
    for (int k = 0; k < 12; k++) {
      frame.time = 0.1 * k;
      frame.pixels = with_noise(picture);
      if (face) face = finder_->follow(frame, *face);
      else if (const auto found = finder_->search(frame); !found.empty()) face = found[0];
      if (face && face->mesh && k >= 3) break;
    }
    if (!face || !face->mesh) return {};
    Look look;
    look.mesh = *face->mesh;
    look.classes =
        classes_.read({frame.pixels.data(), frame.width, frame.height}, cut_of_marks(*face->marks));
    return look;
  }

 private:
  std::vector<uint8_t> with_noise(const cv::Mat& picture) {
    cv::Mat grains(picture.size(), CV_16S), sum;
    random_.fill(grains, cv::RNG::NORMAL, 0, noise);
    picture.convertTo(sum, CV_16S);
    sum += grains;
    sum.convertTo(sum, CV_8U);
    return {sum.data, sum.data + sum.total()};
  }

  std::unique_ptr<FaceFinder> finder_;
  ClassReader classes_;
  cv::RNG random_{7};
};

// Sets the cues of a visit's looks, measured from the mean of those at rest.
void measure(std::vector<Look>& visit) {
  std::optional<FaceMesh> rest;
  FaceClasses usual{};
  int count = 0;
  for (const Look& look : visit) {
    if (look.turned || !look.expression.empty()) continue;
    if (!rest) rest = look.mesh;
    count++;
    const auto aligned = align(look.mesh, *rest);
    for (size_t k = 0; aligned && k < mesh_points; k++)
      rest->points[k] += (aligned->points[k] - rest->points[k]) / float(count);
    for (size_t c = 0; c < usual.size(); c++)
      usual[c] += (look.classes[c] - usual[c]) / float(count);
  }
  if (!rest) return visit.clear();
  for (Look& look : visit)
    if (const auto movement = measure_movement(*rest, look.mesh))
      look.cues = cues_of(*movement, usual, look.classes);
}

std::vector<Look> read_pictures(const fs::path& folder, const fs::path& weights) {
  std::ifstream file(folder / "truth.json");
  const json truth = json::parse(file);
  Reader reader(weights);
  std::vector<Look> all;
  for (const json& sequence : truth.at("sequences")) {
    std::vector<Look> visit;
    std::set<std::string> done;
    for (const json& frame : sequence.at("frames")) {
      if (frame.at("people").empty()) continue;
      const std::string picture = frame.at("picture");
      if (!done.insert(picture).second) continue;
      const cv::Mat image = cv::imread((folder / picture).string(), cv::IMREAD_GRAYSCALE);
      const json& who = frame.at("people").at(0);
      const auto& rotation = who.at("rotation");
      for (int k = 0; k < reads && !image.empty(); k++) {
        auto look = reader.read(image);
        if (!look) continue;
        look->figure = sequence.at("about").at("figure");
        look->expression = who.at("expression");
        look->strength = float(sequence.at("about").at("strength")) / 100;
        look->turned = std::hypot(float(rotation[0]), float(rotation[1])) > turned_from;
        visit.push_back(*look);
      }
    }
    measure(visit);
    all.insert(all.end(), visit.begin(), visit.end());
  }
  return all;
}

using Factors = std::array<Cues, expressions>;

// Finds the factors with least squared error, those of all looks but a figure's.
Factors fit(const std::vector<Look>& looks, const std::string& but) {
  cv::Mat_<double> squares = ridge * cv::Mat_<double>::eye(int(cue_count), int(cue_count));
  cv::Mat_<double> wanted = cv::Mat_<double>::zeros(int(cue_count), int(expressions));
  for (const Look& look : looks) {
    if (look.figure == but) continue;
    for (size_t i = 0; i < cue_count; i++) {
      for (size_t k = 0; k < cue_count; k++)
        squares(int(i), int(k)) += double(look.cues[i]) * look.cues[k];
      for (size_t e = 0; e < expressions; e++)
        if (look.expression == names[e]) wanted(int(i), int(e)) += look.cues[i] * look.strength;
    }
  }
  cv::Mat_<double> solved;
  cv::solve(squares, wanted, solved, cv::DECOMP_CHOLESKY);
  Factors out;
  for (size_t e = 0; e < expressions; e++)
    for (size_t k = 0; k < cue_count; k++) out[e][k] = float(solved(int(k), int(e)));
  return out;
}

std::string said(const Factors& factors, const Cues& cues) {
  float most = least;
  std::string name;
  for (size_t e = 0; e < expressions; e++) {
    float sum = 0;
    for (size_t k = 0; k < cue_count; k++) sum += factors[e][k] * cues[k];
    if (sum >= most) most = sum, name = names[e];
  }
  return name;
}

// Prints the table in the form of the header, its lines within 100 columns.
void print_table(const Factors& factors) {
  for (size_t e = 0; e < expressions; e++) {
    std::cout << "    // " << names[e] << "\n";
    const std::string margin(5, ' ');
    std::string line = "    {";
    for (size_t k = 0; k < cue_count; k++) {
      std::ostringstream number;
      number << std::round(1e4f * factors[e][k]) / 1e4f << 'f';
      if (line.size() + number.str().size() > 95) {
        std::cout << line << '\n';
        line = margin;
      }
      if (k > 0) line += ' ';
      line += number.str();
      line += k + 1 < cue_count ? "," : "},";
    }
    std::cout << line << '\n';
  }
}

void run(const fs::path& folder, const fs::path& weights, bool table) {
  const std::vector<Look> looks = read_pictures(folder, weights);
  std::set<std::string> figures;
  for (const Look& look : looks) figures.insert(look.figure);
  if (table) return print_table(fit(looks, ""));
  for (const std::string& figure : figures) {
    const Factors factors = fit(looks, figure);
    Mean right, turned;
    for (const Look& look : looks) {
      if (look.figure != figure) continue;
      const std::string name = said(factors, look.cues);
      if (look.expression.empty() && look.turned) turned.add(!name.empty());
      if (!look.expression.empty() && look.strength > 0.99f) right.add(name == look.expression);
    }
    tell("kiosk.expression.unseen", right.value(), "1", {{"figure", figure}});
    tell("kiosk.expression.unseen_turned", turned.value(), "1", {{"figure", figure}});
  }
}

}  // namespace

}  // namespace wellspring::test

int main(int argc, char** argv) {
  if (wellspring::about::answer_version(argc, argv)) return 0;
  CLI::App app{"Fits what the kiosk's eye reads from faces to figures with known expressions."};
  std::string pictures, weights;
  bool table = false;
  app.add_option("--pictures", pictures, "folder with truth.json, as the bench keeps it")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--weights", weights, "folder of networks, with face and human")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_flag("--table", table, "print the factors for kiosk/face/expression_table.h");
  CLI11_PARSE(app, argc, argv);
  wellspring::log::start("expression");
  try {
    wellspring::test::run(pictures, weights, table);
  } catch (const std::exception& error) {
    std::cerr << "wellspring_kiosk_expression: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
