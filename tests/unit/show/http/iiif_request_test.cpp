// SPDX-License-Identifier: Apache-2.0
#include "show/http/iiif_request.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

constexpr int64_t wide = 6000, high = 4000;  // texels of the picture

IiifQuestion read(const std::string& text) { return read_iiif_request(text, wide, high); }
IiifQuestion read_size(const std::string& size, const std::string& region = "0,0,600,400") {
  return read(region + "/" + size + "/0/default.jpg");
}
std::string canonical(const std::string& text) {
  const IiifQuestion question = read(text);
  EXPECT_EQ(question.status, 200) << text << ": " << question.problem;
  return question.canonical;
}

TEST(IiifRequest, RegionsAreCutToThePicture) {
  struct Case {
    const char* text;
    int64_t x, y, width, height;
  };
  for (const Case& one : {Case{"full", 0, 0, wide, high},
                          {"square", 1000, 0, 4000, 4000},
                          {"0,0,1,1", 0, 0, 1, 1},
                          {"5999,3999,1,1", 5999, 3999, 1, 1},
                          {"5000,3000,2000,2000", 5000, 3000, 1000, 1000},
                          {"0,0,999999999999,5", 0, 0, wide, 5},
                          {"pct:25,50,50,25", 1500, 2000, 3000, 1000},
                          {"pct:0.5,0,100,12.5", 30, 0, 5970, 500},
                          {"pct:99,99,99,99", 5940, 3960, 60, 40}}) {
    SCOPED_TRACE(one.text);
    const IiifQuestion question = read(std::string(one.text) + "/max/0/default.jpg");
    ASSERT_EQ(question.status, 200) << question.problem;
    EXPECT_EQ(question.request.x, one.x);
    EXPECT_EQ(question.request.y, one.y);
    EXPECT_EQ(question.request.region_width, one.width);
    EXPECT_EQ(question.request.region_height, one.height);
  }
  const IiifQuestion tall = read_iiif_request("square/max/0/default.jpg", 30, 80);
  EXPECT_EQ(tall.request.y, 25);
  EXPECT_EQ(tall.request.region_height, 30);
}

TEST(IiifRequest, SizesFollowTheRegion) {
  struct Case {
    const char* text;
    int width, height;
  };
  for (const Case& one : {Case{"max", 600, 400},   {"^max", 4096, 2731},
                          {"300,", 300, 200},      {",100", 150, 100},
                          {"600,", 600, 400},      {"^1200,", 1200, 800},
                          {"^,800", 1200, 800},    {"pct:50", 300, 200},
                          {"pct:12.5", 75, 50},    {"pct:100", 600, 400},
                          {"^pct:200", 1200, 800}, {"300,400", 300, 400},
                          {"^700,10", 700, 10},    {"!300,300", 300, 200},
                          {"!900,100", 150, 100},  {"!900,900", 600, 400},
                          {"^!900,900", 900, 600}, {"^!99999,99999", 4096, 2731},
                          {"^300,", 300, 200},     {"1,", 1, 1}}) {
    const IiifQuestion question = read_size(one.text);
    EXPECT_EQ(question.status, 200) << one.text << ": " << question.problem;
    EXPECT_EQ(question.request.width, one.width) << one.text;
    EXPECT_EQ(question.request.height, one.height) << one.text;
  }
  EXPECT_EQ(read_size("max", "full").request.width, 4096);
  EXPECT_EQ(read_size("max", "full").request.height, 2731);
  EXPECT_EQ(largest_iiif_size(4096, 17).height, 17);
  EXPECT_EQ(largest_iiif_size(1 << 30, 1).height, 1);
}

TEST(IiifRequest, SizesThatAreTooLargeOrNothingAreRefused) {
  for (const char* size : {"601,",      ",401",
                           "601,400",   "pct:101",
                           "0,",        ",0",
                           "0,10",      "^4097,",
                           "^,4097",    "^10,4097",
                           "^pct:1000", "pct:0",
                           "pct:0.01",  "!0,5",
                           "!5,",       "!,5",
                           "!5",        ",",
                           "",          "^",
                           "10",        "10,10,10",
                           "-1,",       "1.5,",
                           "1e2,",      "full",
                           "^full",     "^^max",
                           "!max",      "pct:",
                           "pct:-5",    "pct:1e1",
                           "pct:nan",   "pct:5,5",
                           "+5,",       " 5,",
                           "max ",      "99999999999999999999,",
                           "!^5,5",     "pct:1.2.3",
                           "pct:."}) {
    const IiifQuestion question = read_size(size);
    EXPECT_EQ(question.status, 400) << size;
    EXPECT_TRUE(question.problem.starts_with("size: ")) << size << ": " << question.problem;
  }
  EXPECT_EQ(read_size("4097,", "full").status, 400) << "larger than is made";
  EXPECT_NE(read_size("601,").problem.find("^"), std::string::npos) << "says what would help";
}

TEST(IiifRequest, RegionsOutsideAreRefused) {
  for (const char* region :
       {"6000,0,1,1", "0,4000,1,1", "0,0,0,5", "0,0,5,0", "-1,0,5,5", "0,0,5", "0,0,5,5,5", "",
        "Full", "pct:100,0,5,5", "pct:0,0,0,5", "pct:0,0,5", "pct:", "pct:a,0,5,5", "1.5,0,5,5",
        "pct:1e1,0,5,5", "squares", "0x10,0,5,5", "1,,5,5"}) {
    const IiifQuestion question = read(std::string(region) + "/max/0/default.jpg");
    EXPECT_EQ(question.status, 400) << region;
    EXPECT_TRUE(question.problem.starts_with("region: ")) << region << ": " << question.problem;
  }
}

TEST(IiifRequest, OnlyRightAnglesAreMade) {
  for (const auto& [text, turns, mirrored] : {std::tuple("0", 0, false),
                                              {"90", 1, false},
                                              {"180", 2, false},
                                              {"270", 3, false},
                                              {"360", 0, false},
                                              {"90.0", 1, false},
                                              {"!0", 0, true},
                                              {"!270", 3, true}}) {
    const IiifQuestion question = read("full/max/" + std::string(text) + "/default.jpg");
    ASSERT_EQ(question.status, 200) << text << ": " << question.problem;
    EXPECT_EQ(question.request.quarter_turns, turns) << text;
    EXPECT_EQ(question.request.is_mirrored, mirrored) << text;
  }
  for (const char* text : {"45", "!22.5", "359.9", "0.1"})
    EXPECT_EQ(read("full/max/" + std::string(text) + "/default.jpg").status, 501) << text;
  for (const char* text : {"361", "-90", "", "!", "!!90", "north", "9e1", "90!"})
    EXPECT_EQ(read("full/max/" + std::string(text) + "/default.jpg").status, 400) << text;
}

TEST(IiifRequest, QualitiesAndFormats) {
  using Quality = IiifRequest::Quality;
  for (const auto& [text, quality] : {std::pair("default", Quality::color),
                                      {"color", Quality::color},
                                      {"gray", Quality::gray},
                                      {"bitonal", Quality::bitonal}}) {
    const IiifQuestion question = read("full/max/0/" + std::string(text) + ".png");
    ASSERT_EQ(question.status, 200) << text;
    EXPECT_EQ(question.request.quality, quality) << text;
    EXPECT_EQ(question.request.format, IiifRequest::Format::png);
    EXPECT_EQ(question.request.is_plain(), quality == Quality::color);
  }
  EXPECT_EQ(read("full/max/0/default.jpg").request.format, IiifRequest::Format::jpg);
  for (const char* text : {"default.webp", "default.tif", "default.jpeg", "default.JPG", "default.",
                           "default", ".jpg", "native.jpg", "grey.jpg", "default.jpg.png", ""})
    EXPECT_EQ(read("full/max/0/" + std::string(text)).status, 400) << text;
}

TEST(IiifRequest, HasFourParts) {
  for (const char* text : {"", "full", "full/max", "full/max/0", "full/max/0/default.jpg/",
                           "/full/max/0/default.jpg", "full/max/0/0/default.jpg"})
    EXPECT_EQ(read(text).status, 400) << text;
}

TEST(IiifRequest, HasOneCanonicalForm) {
  for (const auto& [text, wanted] :
       {std::pair("full/max/0/default.jpg", "full/max/0/default.jpg"),
        {"0,0,6000,4000/4096,/0/color.jpg", "full/max/0/default.jpg"},
        {"pct:0,0,100,100/300,/360/gray.png", "full/300,200/0/gray.png"},
        {"square/400,/!90/bitonal.jpg", "1000,0,4000,4000/400,400/!90/bitonal.jpg"},
        {"0,0,600,400/pct:100/0/default.jpg", "0,0,600,400/max/0/default.jpg"},
        {"0,0,600,400/^max/0/default.jpg", "0,0,600,400/^max/0/default.jpg"},
        {"0,0,600,400/^!1200,1200/0/default.jpg", "0,0,600,400/^1200,800/0/default.jpg"},
        {"0,0,600,400/^300,/0/default.jpg", "0,0,600,400/300,200/0/default.jpg"},
        {"5900,3900,600,400/max/90.0/default.jpg", "5900,3900,100,100/max/90/default.jpg"}}) {
    EXPECT_EQ(canonical(text), wanted);
    EXPECT_EQ(canonical(wanted), wanted) << "it is its own";
    EXPECT_EQ(read(text).request, read(wanted).request) << text;
  }
}

}  // namespace
}  // namespace wellspring::test
