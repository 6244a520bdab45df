// SPDX-License-Identifier: Apache-2.0
// An exhibit package as loaded: what content/<id>/exhibit.json says, with its scene and its
// storyteller's figure. Immutable once loaded; borrowed by the Show for as long as it runs.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "avatar/body/gesture.h"
#include "avatar/face/expression.h"
#include "avatar/figure/character.h"
#include "avatar/story/story_script.h"
#include "lawn/lawn.h"
#include "lawn/wind.h"
#include "show/lighting/day.h"
#include "store/picture/sample_picture.h"
#include "volume/compare/report.h"
#include "volume/draw/preset.h"
#include "volume/nebula/nebula.h"
#include "scan/tree/coarse_cut.h"
#include "world/placed_scan.h"
#include "world/load/scene_join.h"
#include "world/scene.h"

namespace wellspring::show {

// A curator may describe a kiosk in `kiosks` of exhibit.json, all of it optional but the name.

// Seconds that a kiosk waits; what they decide: show/kiosk/kiosk.h.
struct KioskTimes {
  double hold_person = 2;       // a head counts as there after it was last seen
  double sleep_after = 30;      // without motion
  double leave_after = 6;       // without a head or a touch of an engaged guest
  double leave_untouched = 45;  // without a touch of a guest whom no camera sees
  double leave_playing = 90;    // likewise while something plays
  double farewell = 6;          // its length
  double sleep_latest = 20;     // from its beginning, where nothing moves after it
};

// Holds the size of the lit part of a screen, in metres; 0: unknown.
struct ScreenSize {
  float width = 0, height = 0;
  bool known() const { return width > 0 && height > 0; }
};

struct KioskSettings {
  std::string name;       // as its page and its cameras say it
  std::string viewpoint;  // viewpoint of its window; empty: the storyteller's for kiosks
  std::string teller;     // a storyteller's id: who comes there; empty: whoever is there
  float volume = 1;       // 0 to 1
  ScreenSize screen;      // known: its picture follows the head of its guest
  // Recognition tree of what may be held to its camera, one of Exhibit::files; empty: none.
  std::string station;
  std::vector<std::string> held;  // ids of the objects that this tree names
  KioskTimes times;
};

using LocalText = std::map<std::string, std::string>;               // language tag -> text
using LocalLine = std::map<std::string, StoryLine>;                 // language tag -> a sentence
using LocalScript = std::map<std::string, std::vector<StoryLine>>;  // language tag -> sentences

// The text in `lang`, else in its base language ("de" for "de-AT"), else in the first of
// `languages` that has one, else any; "" when there is none at all.
const std::string& text_in(const LocalText& text, const std::string& lang,
                           const std::vector<std::string>& languages);
// The same of a line; null when there is none.
const LocalLine::value_type* line_in(const LocalLine& line, const std::string& lang,
                                     const std::vector<std::string>& languages);
LocalLine plain_line(const LocalText& text);
// Sentence `index` of every language that has one.
LocalLine line_at(const LocalScript& script, size_t index);
size_t line_count(const LocalScript& script);  // lines in the longest language

struct ExhibitViewpoint {
  Viewpoint view;
  LocalText title;
  std::string where;  // in exhibit.json; empty: a camera of the scene
};

struct TourStop {
  int viewpoint = 0;           // index into Exhibit::viewpoints
  float travel_seconds = 0;    // the way there takes at least this long
  float stay_seconds = 1.5;    // and the stay, and as long as its text takes
  LocalScript way_text, text;  // told on the way, and there
  LocalText way_sound, sound;  // language tag -> file of a recording of it
};
struct TourPlan {
  std::string id;
  LocalText title;
  std::vector<TourStop> stops;
};

struct StoryText {
  std::string id;
  LocalText title;
  LocalScript text;
  LocalText sound;             // language tag -> file of a recording of the text
  int storyteller_index = -1;  // index into Exhibit::storytellers; -1: whoever is there
};

// A voice of the synthesiser.
struct VoiceManner {
  int words_per_minute = 155;  // 80 to 450
  int pitch = 45;              // 0 to 100
  std::string variant;         // "f3", "m2", ...; empty: the language's own
};

// How visitors may move. Without one they fly freely.
struct WalkSettings {
  float eye_height = 1.65f;  // metres above the ground under the visitor
  float speed = 1.4f;        // metres a second, for the page's keys
  float radius = 0.25f;      // distance kept from walls
  std::optional<Bounds> bounds;
};

// A storyteller: figure, place, and its own greetings and manner.
struct StorytellerPlace {
  std::string id;
  std::string figure;  // file of its package, or of the one that lends it
  LocalText name;
  dvec3 position{0};                 // place of the feet
  float yaw = 0;                     // as Viewpoint: 0 faces -Z
  LocalScript greetings, farewells;  // a line each
  VoiceManner voice;
  int kiosk_viewpoint = 0;
  Character character;
  std::optional<ExpressionSet> expressions;  // the package's own, in place of the program's
  std::optional<GestureLibrary> gestures;
};

struct PointOfInterest {
  std::string id, node;
  std::vector<uint32_t> objects;  // its parts: indices into Scene::objects
  dvec3 place{0};                 // its middle, where one looks or points; absolute
  float half = 0;  // not 0: it is a part of them, around that place, by so many metres
  LocalText title, text;
  std::string story;                            // id of the one about it; may be empty
  std::map<std::string, LocalText> provenance;  // element of Dublin Core -> value
  std::string manifest;                         // IIIF; https or empty
  bool around = false;                          // may be looked at from all sides
  struct Door {
    std::string exhibit, viewpoint;  // empty viewpoint: that exhibit's start
  } door;                            // to another exhibit; empty exhibit: it leads nowhere
};

// One of the pictures that may be seen at the place of a piece: paint, X-ray, a map of a year, a
// preset of a volume.
struct PieceLayer {
  std::string id, source;  // source: of the package, as exhibit.json names it
  LocalText label, text;
  std::optional<int> year;               // year of a map or scan
  PictureLayer shown;                    // nothing for a volume
  std::optional<volume::Preset> preset;  // a volume's
  ScanColors colors = {};                // a scan's
  int set = 0;                           // likewise: of ExhibitPiece::sets
  // Hold a volume in colours that compare it with a model, and their meaning. Null: the piece's
  // volume is shown as it is.
  std::shared_ptr<const volume::ShownVolume> volume;
  std::shared_ptr<const volume::Comparison> comparison;  // without its points
  // The same with words in another language, by its tag.
  std::map<std::string, std::shared_ptr<const LargePicture>, std::less<>> spoken;
};
inline constexpr size_t most_piece_layers = 32;

// Holds what a nebula's volume is made of, so that it can be made again for another tilt.
struct PieceNebula {
  volume::NebulaPicture picture;
  volume::NebulaSettings settings;
  float tilt = 0;  // radians, of ExhibitPiece::volume
};

// A piece of the exhibit that is no part of its glTF files.
struct ExhibitPiece {
  std::string id, source;  // source: that of the first layer
  std::string material;    // material of the scene that shows it; empty: it hangs at a place
  dvec3 position{0};       // middle of its back; of a volume: of its underside
  float yaw = 0, pitch = 0, roll = 0;  // radians; as a storyteller's yaw; positive pitch looks up
  float width = 1;                     // metres
  float frame_width = 0, frame_depth = 0;  // metres; 0: it has no frame
  vec3 frame_color{0};                     // linear
  bool gilt = false;
  bool stands = false;                                // on four legs
  double floor = 0;                                   // metres; height that they reach down to
  vec3 stand_color{0};                                // linear
  std::shared_ptr<const LargePicture> picture;        // the first layer, which says how it lies
  std::vector<PieceLayer> layers;                     // the first is shown at first
  int image = -1;                                     // index into Scene::images
  std::shared_ptr<const volume::ShownVolume> volume;  // null: it is no volume
  std::shared_ptr<const PieceNebula> nebula;          // null: it is a scan
  std::vector<ScanSet> sets;                          // empty: it is no scan of points
  std::shared_ptr<const ShownSplats> splats;          // null: it is none of splats
  PointBounds scan_box;                               // either one's bounds
  quat scan_turn{1, 0, 0, 0};                         // from its file's axes to +Y up
  // From its file's coordinates, those of a survey perhaps, to the frame of scan_box.
  glm::dmat4 from_file{1};
  bool is_scan() const { return !sets.empty() || splats; }
  bool has_inside() const { return volume || is_scan(); }  // it may be cut
  float sphere = 0;                                        // as PlacedScan's
  float brightness = 1;                                    // a scan's, as it was captured
  float scale = 1;                                         // metres here to one of volume or scan
  uint32_t object = 0;                                     // the volume's or scan's
};
inline constexpr size_t most_exhibit_pieces = 500;

// A lawn, before its ground is known.
struct ExhibitLawn {
  std::string id, where;            // in exhibit.json
  LawnDescription description;      // relative to the scene's origin; its `ground` is not used
  std::vector<std::string> ground;  // materials on which it grows; empty: on all
  float height = 0, reach = 1;      // its ground lies so high, give or take `reach`, metres
  Wind wind;
  uint32_t object = 0;
};

// A thing that a storyteller can hold.
struct ExhibitProp {
  std::string id, file;
  int side = 1;                     // hand that holds it: 0 left, 1 right
  std::string gesture = "hold_up";  // how the arm holds it: of the gesture library
  mat4 to_fist{1};                  // from the file's metres to the fist's (avatar/body/hold.h)
  Flicker flicker;                  // flicker of its lights
  Scene scene;                      // contents of the file
};
inline constexpr size_t most_props = 16;

// Holds a question that visitors may ask the storyteller, and the curator's answer.
struct AnsweredQuestion {
  std::vector<LocalText> question;  // ways to ask it, one or more; the first is offered
  LocalText answer;
};
inline constexpr size_t most_questions = 200;

// An animation of the scene's files, as the curator wants it played.
struct ExhibitAnimation {
  enum class Start : uint8_t { loop, touch };
  std::string id;
  LocalText title;
  Start start = Start::loop;
  int motion = 0, clip = 0;  // indices into scene.motions and into its clips
  double seconds = 0;        // its duration; above 0
  int point = -1;            // index into Exhibit::points: whose touch starts it; -1: nobody's
  bool shared = false;       // who starts it does so for everybody
};
inline constexpr size_t most_animations = 64;

// Names a mesh that an animation moves: it is no part of the scene any more.
struct ExhibitMover {
  int motion = 0, mover = 0;  // indices into scene.motions and into its movers
  int material = 0;           // index into the scene's materials
  uint32_t object = 0;        // index into the scene's objects
};

// Holds a lamp that visitors may switch: scene.lamps[i] lists its parts, and the sun of the day.
struct DialLight {
  std::string spectrum;
  LocalText title;
};
struct ExhibitLamp {
  std::string id;
  LocalText title;
  bool on = true;                 // at first
  bool shared = false;            // who switches it does so for everybody
  std::string spectrum{};         // its own light; empty: a colour
  std::vector<DialLight> dial{};  // other lights, one for each of the scene's lamp
};
inline constexpr size_t most_lamps = 32;

// A topic of the book, or a partner of the museum. Files are named as in exhibit.json.
struct BookPage {
  std::string id;
  LocalText title;
  std::vector<LocalText> text;  // paragraphs
  std::string image;            // may be empty
  LocalText alt, credit;        // words for the picture; its owner
  std::string link;             // address of a partner; https or empty
};
struct BookSlide {
  LocalText title, text;
  std::string image, video;  // at most one of them
  LocalText alt;
  double seconds = 10;  // shown so long
};
struct BookPresentation {
  std::string id;
  LocalText title;
  std::vector<BookSlide> slides;
};
// Holds the book that a kiosk's guests read.
struct Book {
  std::vector<BookPage> topics, partners;
  std::vector<BookPresentation> presentations;
};

// Heard from a place, or everywhere: made by the page (`kind`), or a file.
struct AmbientSound {
  std::string id, kind, file;  // kind: fire, water, room or wind; empty where there is a file
  std::optional<dvec3> position;
  double gain = 1, radius = 8;  // 0 to 1; metres at which it is gone
};

// A file of the package that browsers may have, as it was when it was checked.
struct ServedFile {
  std::string path, type;  // type: "image/jpeg", ...
  uint64_t bytes = 0;
  int64_t changed = 0;  // its last change, in the file system's own count
  std::string etag;     // hash of its bytes
};

struct ExhibitCollection;  // show/exhibit/exhibit_collection.h

struct Exhibit {
  std::string id, folder;
  LocalText title, description;
  std::string poster;  // one of `files`; empty: none
  std::vector<std::string> languages{"en"};
  float exposure = 1;  // multiplies radiance; measured where exhibit.json says "auto"
  bool auto_exposure = false;
  std::optional<WalkSettings> walk;
  std::vector<ExhibitViewpoint> viewpoints;  // never empty
  int start = 0;
  std::vector<StorytellerPlace> storytellers;  // one is there at a time, the first to begin with
  bool shared_storyteller = false;             // there is one for all visitors
  std::vector<ExhibitProp> props;
  std::vector<TourPlan> tours;
  std::vector<StoryText> stories;
  std::vector<PointOfInterest> points;
  std::vector<std::string> allowed_hosts;  // servers whose pictures may hang here: HOST, HOST:PORT
  std::vector<ExhibitPiece> pieces;
  std::vector<ExhibitLawn> lawns;
  std::vector<std::string> piece_languages;  // pieces have words in these, besides the first
  std::vector<ExhibitLamp> lamps;            // one for each of the scene's, but for the day's sun
  std::vector<ChangingLight> lights;
  std::optional<Day> day;
  std::vector<ExhibitAnimation> animations;
  std::vector<ExhibitMover> movers;
  std::optional<Book> book;
  std::shared_ptr<const ExhibitCollection> collection;  // null: there is none
  std::vector<AnsweredQuestion> questions;
  std::vector<AmbientSound> sounds;
  std::map<std::string, ServedFile> files;  // by the name that exhibit.json gives
  std::vector<KioskSettings> kiosks;
  std::vector<Credit> credits;  // authors that its glTF files name
  Scene scene;
};

int find_viewpoint(const Exhibit& exhibit, std::string_view name);  // -1: none
int find_storyteller(const Exhibit& exhibit, std::string_view id);  // likewise
int find_lamp(const Exhibit& exhibit, std::string_view id);         // likewise
int find_prop(const Exhibit& exhibit, std::string_view id);         // likewise
const PointOfInterest* find_point(const Exhibit& exhibit, std::string_view id);

// Says that no viewpoint has that name, and which was perhaps meant.
std::string unknown_viewpoint(const Exhibit& exhibit, const std::string& name);
std::string unknown_storyteller(const Exhibit& exhibit, const std::string& id);
std::string unknown_prop(const Exhibit& exhibit, const std::string& id);
std::string unknown_object(const Exhibit& exhibit, const std::string& id);

}  // namespace wellspring::show
