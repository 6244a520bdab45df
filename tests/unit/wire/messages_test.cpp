// SPDX-License-Identifier: Apache-2.0
// Messages against the golden files in tests/protocol, and what cannot be written into files.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "wire/json.h"

using namespace wellspring;

using namespace wellspring::test;

namespace {

using nlohmann::json;

static std::vector<json> golden(const std::string& name) {
  std::ifstream file(std::string(WELLSPRING_SOURCE) + "/tests/protocol/" + name);
  EXPECT_TRUE(file) << name;
  std::vector<json> rows;
  for (std::string line; std::getline(file, line);) rows.push_back(json::parse(line));
  EXPECT_GT(rows.size(), 5u) << name;
  return rows;
}

static std::string error_of(const auto& result) {
  const auto* error = std::get_if<WireError>(&result);
  return error ? error->code + ": " + error->message : "";
}

TEST(Messages, good_browser_messages_mean_what_the_golden_file_says) {
  for (const json& row : golden("browser_good.jsonl")) {
    const auto message = read_browser_message(row["text"].dump());
    ASSERT_EQ(error_of(message), "") << row;
    const std::string written = write_message(std::get<BrowserMessage>(message));
    EXPECT_EQ(json::parse(written), row["means"]);
    const auto again = read_browser_message(written);
    ASSERT_EQ(error_of(again), "") << written;
    EXPECT_TRUE(std::get<BrowserMessage>(again) == std::get<BrowserMessage>(message)) << written;
  }
}

TEST(Messages, every_kind_is_described_and_has_a_row_of_the_golden_file) {
  const json described = describe_browser_messages();
  EXPECT_EQ(described.size(), std::variant_size_v<BrowserMessage>);
  std::set<std::string> golden_types;
  for (const json& row : golden("browser_good.jsonl"))
    golden_types.insert(row["means"]["type"].get<std::string>());
  for (const auto& [type, fields] : described.items()) {
    EXPECT_TRUE(golden_types.contains(type)) << type;
    for (const auto& [name, about] : fields.items())
      EXPECT_TRUE(about.is_string() || about.is_object()) << name;
  }
}

TEST(Messages, bad_browser_messages_are_refused_naming_the_field) {
  for (const json& row : golden("browser_bad.jsonl")) {
    const auto message = read_browser_message(row["text"].get<std::string>());
    ASSERT_TRUE(std::holds_alternative<WireError>(message)) << row;
    const auto& error = std::get<WireError>(message);
    EXPECT_EQ(error.code, row["code"].get<std::string>()) << row << error.message;
    EXPECT_NE(error.message.find(row["names"].get<std::string>()), std::string::npos)
        << row << error.message;
    EXPECT_LT(error.message.size(), 300u);
  }
}

TEST(Messages, good_observations_mean_what_the_golden_file_says) {
  for (const json& row : golden("observation_good.jsonl")) {
    const auto observation = read_observation(row["text"].dump());
    ASSERT_EQ(error_of(observation), "") << row;
    EXPECT_EQ(json::parse(write_observation(std::get<Observation>(observation))), row["means"]);
  }
}

TEST(Messages, bad_observations_are_refused_naming_the_field) {
  for (const json& row : golden("observation_bad.jsonl")) {
    const auto observation = read_observation(row["text"].get<std::string>());
    ASSERT_TRUE(std::holds_alternative<WireError>(observation)) << row;
    const auto& error = std::get<WireError>(observation);
    EXPECT_EQ(error.code, row["code"].get<std::string>()) << row << error.message;
    EXPECT_NE(error.message.find(row["names"].get<std::string>()), std::string::npos)
        << row << error.message;
  }
}

TEST(Messages, orders_to_eyes_mean_what_the_golden_files_say) {
  for (const json& row : golden("eye_order_good.jsonl")) {
    const auto order = read_eye_order(row["text"].dump());
    ASSERT_EQ(error_of(order), "") << row;
    EXPECT_EQ(json::parse(write_eye_order(std::get<EyeOrder>(order))), row["means"]);
  }
  for (const json& row : golden("eye_order_bad.jsonl")) {
    const auto order = read_eye_order(row["text"].get<std::string>());
    ASSERT_TRUE(std::holds_alternative<WireError>(order)) << row;
    const auto& error = std::get<WireError>(order);
    EXPECT_EQ(error.code, row["code"].get<std::string>()) << row << error.message;
    EXPECT_NE(error.message.find(row["names"].get<std::string>()), std::string::npos)
        << row << error.message;
  }
}

TEST(Messages, fields_get_their_own_values) {
  const auto message = read_browser_message(
      R"({"type":"camera","seq":9,"position":[1,2,3],"yaw":0.5,"pitch":-0.25})");
  const auto& camera = std::get<CameraTo>(std::get<BrowserMessage>(message));
  EXPECT_EQ(camera.seq, 9u);
  EXPECT_EQ(camera.position, dvec3(1, 2, 3));
  EXPECT_EQ(camera.yaw, 0.5f);
  EXPECT_EQ(camera.pitch, -0.25f);
  const auto input = std::get<BrowserMessage>(
      read_browser_message(R"({"type":"input","seq":1,"move":[1,2,3],"look":[4,5]})"));
  EXPECT_EQ(std::get<Input>(input).move, vec3(1, 2, 3));
  EXPECT_EQ(std::get<Input>(input).look, vec2(4, 5));
}

TEST(Messages, of_equal_names_the_last_counts) {
  const auto message = read_browser_message(R"({"type":"bye","type":"ack","frame":1,"frame":2})");
  EXPECT_EQ(std::get<Ack>(std::get<BrowserMessage>(message)).frame, 2u);
}

TEST(Messages, odd_floats_survive_the_round_trip) {
  for (const float value : {0.1f, -1e-30f, 99.99999f, 1.0f / 3}) {
    const BrowserMessage message =
        CameraTo{.seq = 1, .position = {value, 1e-9, -1e5}, .yaw = value};
    EXPECT_TRUE(std::get<BrowserMessage>(read_browser_message(write_message(message))) == message);
  }
}

TEST(Messages, invalid_utf8_is_no_json) {
  for (const std::string bytes : {"\xff", "\xc3", "\xed\xa0\x80", "\xc0\xaf", "\xf4\x90\x80\x80"})
    EXPECT_EQ(std::get<WireError>(
                  read_browser_message(R"({"type":"viewpoint","seq":1,"name":")" + bytes + "\"}"))
                  .code,
              "bad_json");
}

TEST(Messages, names_may_be_200_bytes) {
  const auto with_name = [](size_t bytes) {
    return read_browser_message(R"({"type":"viewpoint","seq":1,"name":")" +
                                std::string(bytes, 'n') + "\"}");
  };
  EXPECT_EQ(error_of(with_name(200)), "");
  EXPECT_EQ(std::get<WireError>(with_name(201)).code, "bad_field");
}

TEST(Messages, each_kind_has_its_size_exactly) {
  struct Row {
    std::string text;
    size_t most;
  };
  for (auto [text, most] : {Row{R"({"type":"bye"})", max_order_bytes},
                            Row{R"({"type":"input","seq":1})", max_order_bytes},
                            Row{R"({"type":"hello"})", max_hello_bytes}}) {
    text.resize(most, ' ');
    EXPECT_EQ(error_of(read_browser_message(text)), "") << text.substr(0, 20);
    text += ' ';
    EXPECT_EQ(std::get<WireError>(read_browser_message(text)).code, "too_large");
  }
  std::string seen = R"({"type":"observation","time":1,"presence":false})";
  seen.resize(max_message_bytes, ' ');
  EXPECT_EQ(error_of(read_observation(seen)), "");
  seen += ' ';
  EXPECT_EQ(std::get<WireError>(read_observation(seen)).code, "too_large");
}

TEST(Messages, the_largest_that_a_page_may_say_fit) {
  const auto name = [](size_t bytes) {  // as long as escapes make it
    std::string text;
    for (size_t i = 0; i < bytes; i++) text += "\\u0041";
    return text;
  };
  EXPECT_EQ(error_of(read_browser_message(R"({"type":"ask","text":")" + name(200) + "\"}")), "");
  const std::string token(max_token_bytes, 't');
  EXPECT_EQ(error_of(read_browser_message(R"({"type":"hello","resume":")" + token +
                                          R"(","token":")" + token + R"(","kiosk":")" + name(200) +
                                          R"(","exhibit":")" + name(200) + "\"}")),
            "");
}

// However large it is: what is read of it, and how many values are made, has an end.
TEST(Messages, reading_ends_where_nothing_is_meant) {
  const auto arrays = [](size_t count) {
    std::string text = R"({"type":"input","seq":1,"x":[)";
    for (size_t i = 1; i < count; i++) text += "[],";
    return text + "[]]}";
  };
  size_t values = 0;
  EXPECT_EQ(error_of(read_browser_message(arrays(100), &values)), "");
  EXPECT_EQ(values, 104u);
  EXPECT_EQ(std::get<WireError>(read_browser_message(arrays(600), &values)).code, "too_large");
  EXPECT_EQ(values, max_order_values);
  values = 0;
  EXPECT_EQ(std::get<WireError>(read_browser_message(arrays(20'000), &values)).code, "too_large");
  EXPECT_EQ(values, 0u) << "by its size alone";
  EXPECT_EQ(std::get<WireError>(read_observation(arrays(20'000), &values)).code, "too_large");
  EXPECT_EQ(values, max_observation_values);
}

TEST(Messages, depth_limit_is_32_exactly) {
  const auto nested = [](int depth) {  // the message itself is one level
    return R"({"type":"bye","x":)" + std::string(size_t(depth - 1), '[') +
           std::string(size_t(depth - 1), ']') + "}";
  };
  EXPECT_EQ(error_of(read_browser_message(nested(31))), "");
  EXPECT_EQ(error_of(read_browser_message(nested(32))), "");
  EXPECT_EQ(std::get<WireError>(read_browser_message(nested(33))).code, "too_deep");
  EXPECT_EQ(std::get<WireError>(read_observation(nested(33))).code, "too_deep");
}

TEST(ParseJson, a_hundred_thousand_brackets_neither_crash_nor_fill_memory) {
  for (const std::string piece : {"[", "{\"a\":", "[{\"a\":"}) {
    std::string text;
    for (int i = 0; i < 100'000; i++) text += piece;
    const auto result = parse_json(text);
    ASSERT_TRUE(std::holds_alternative<WireError>(result));
    EXPECT_EQ(std::get<WireError>(result).code, "too_deep");
  }
  const auto result =
      parse_json(std::string(100'000, '[') + std::string(100'000, ']'), {.depth = 200});
  EXPECT_EQ(std::get<WireError>(result).code, "too_deep");
}

TEST(ParseJson, what_was_accepted_can_be_copied_and_written) {
  const auto result = parse_json(std::string(32, '[') + std::string(32, ']'));
  const json copy = std::get<json>(result);
  EXPECT_EQ(copy.dump(), std::string(32, '[') + std::string(32, ']'));
  EXPECT_EQ(std::get<WireError>(parse_json(std::string(33, '['))).code, "too_deep");
}

TEST(ParseJson, builds_the_same_tree_as_the_library) {
  const std::string text =
      R"({"a":[1,-2,3.5,true,false,null,"x\u00e9\n"],"b":{"c":{},"d":[]},"e":[[],[1,[2,{"f":3}]],4]})";
  EXPECT_EQ(std::get<json>(parse_json(text)), json::parse(text));
  EXPECT_EQ(std::get<json>(parse_json("7")), json(7));
}

TEST(ParseJson, wide_is_not_deep) {
  std::string text = "[";
  for (int i = 0; i < 1000; i++) text += "[],{},";
  EXPECT_EQ(std::get<json>(parse_json(text + "[]]", {.depth = 2})).size(), 2001u);
}

TEST(WriteObservation, is_compact_and_rounds_to_four_decimals) {
  Observation observation{.time = 1.23456789, .state = Presence::person, .people = {Person{}}};
  observation.people[0].position = {0.123456f, -0.00004f, 1};
  EXPECT_EQ(write_observation(observation),
            R"({"type":"observation","time":1.2346,"presence":true,"state":"person","people":[)"
            R"({"id":0,"position":[0.1235,0.0,1.0],"rotation":[0.0,0.0,0.0],"confidence":0.0}]})");
}

TEST(WriteObservation, round_trip_is_exact_after_rounding) {
  Observation observation{.time = 86399.9996, .state = Presence::person, .people = {}};
  for (uint32_t i = 0; i < max_people; i++)
    observation.people.push_back({.id = i,
                                  .position = {0.01f * float(i), 0.333333f, 0.5f + float(i)},
                                  .rotation = {-1.23456f, 0.5f, 0.1f},
                                  .confidence = 0.77777f,
                                  .expression = Expression{.joy = 0.123456f, .surprise = 1},
                                  .gesture = "nod"});
  const std::string text = write_observation(observation);
  EXPECT_LT(text.size(), max_message_bytes);
  const auto read = std::get<Observation>(read_observation(text));
  EXPECT_EQ(write_observation(read), text);
  ASSERT_EQ(read.people.size(), observation.people.size());
  EXPECT_NEAR(read.people[7].position.y, 0.3333f, 1e-6);
  EXPECT_NEAR(read.people[7].expression->joy, 0.1235f, 1e-6);
  EXPECT_EQ(read.people[31].gesture, "nod");
}

TEST(WriteObservation, a_value_that_is_not_finite_cannot_pass_a_reader) {
  Observation observation{.time = 1, .state = Presence::person, .people = {Person{}}};
  observation.people[0].position.x = std::numeric_limits<float>::quiet_NaN();
  const auto read = read_observation(write_observation(observation));
  ASSERT_TRUE(std::holds_alternative<WireError>(read));
  EXPECT_NE(std::get<WireError>(read).message.find("position[0]"), std::string::npos);
}

TEST(WriteError, is_a_message_whatever_bytes_it_holds) {
  const json error = json::parse(write_error({"bad_field", "input.seq \xff is \"odd\"\n"}));
  EXPECT_EQ(error["type"], "error");
  EXPECT_EQ(error["code"], "bad_field");
  EXPECT_NE(error["message"].get<std::string>().find("is \"odd\"\n"), std::string::npos);
}

}  // namespace
