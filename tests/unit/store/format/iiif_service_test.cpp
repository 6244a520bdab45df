// SPDX-License-Identifier: Apache-2.0
#include <utility>  // Boost 1.74's awaitable.hpp uses std::exchange without it

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "store/format/iiif_service.h"
#include "store/piece_store.h"
#include "store/remote/http_get.h"
#include "unit/store/format/pictures.h"

namespace wellspring::test {
namespace {

using namespace store;
namespace net_asio = boost::asio;
namespace net_http = boost::beast::http;

struct ServerAnswer {
  unsigned status = 404;
  std::string body, location;
  bool hangs = false;    // it never comes
  std::string declared;  // length that it lies about; empty: it tells the truth
};

// Answers on the loopback, one request at a time.
class ImageServer {
 public:
  using Answer = std::function<ServerAnswer(const std::string& path)>;

  explicit ImageServer(Answer answer)
      : answer_(std::move(answer)),
        door_(io_, {net_asio::ip::make_address("127.0.0.1"), 0}),
        thread_([this] { live(); }) {}
  ~ImageServer() {
    leaves_ = true;
    net_asio::ip::tcp::socket knock(io_);
    boost::system::error_code ignored;
    knock.connect(door_.local_endpoint(), ignored);
    thread_.join();
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(door_.local_endpoint().port()); }
  std::string address(const std::string& path) const { return "http://" + host() + path; }
  std::vector<std::string> asked() const {
    std::lock_guard lock(mutex_);
    return asked_;
  }
  int times(const std::string& path) const {
    const auto all = asked();
    return int(std::ranges::count(all, path));
  }

 private:
  void live() {
    while (!leaves_) {
      net_asio::ip::tcp::socket socket(io_);
      boost::system::error_code ec;
      door_.accept(socket, ec);
      if (ec || leaves_) return;
      boost::beast::flat_buffer buffer;
      net_http::request<net_http::empty_body> request;
      net_http::read(socket, buffer, request, ec);
      if (ec) continue;
      const std::string path(request.target());
      {
        std::lock_guard lock(mutex_);
        asked_.push_back(path);
      }
      const ServerAnswer answer = answer_(path);
      if (answer.hangs) {
        silent_.push_back(std::move(socket));
        continue;
      }
      net_http::response<net_http::string_body> reply;
      reply.result(answer.status);
      reply.body() = answer.body;
      reply.prepare_payload();
      if (!answer.location.empty()) reply.set(net_http::field::location, answer.location);
      if (!answer.declared.empty()) reply.set(net_http::field::content_length, answer.declared);
      net_http::write(socket, reply, ec);
    }
  }

  const Answer answer_;
  net_asio::io_context io_;
  net_asio::ip::tcp::acceptor door_;
  std::vector<net_asio::ip::tcp::socket> silent_;
  mutable std::mutex mutex_;
  std::vector<std::string> asked_;
  std::atomic<bool> leaves_{false};
  std::thread thread_;
};

// Encodes a part of a smooth picture of 600 x 400, which JPEG keeps well.
int smooth(int x, int y, int channel) {
  return channel == 0 ? x * 255 / 600 : channel == 1 ? y * 255 / 400 : 90;
}
std::string jpeg_of(int x0, int y0, int width, int height, int scale) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++)
        image.rgb.push_back(uint8_t(smooth((x0 + x) * scale, (y0 + y) * scale, c)));
  std::vector<uint8_t> jpeg;
  encode_jpeg(image, 95, true, jpeg);
  return {jpeg.begin(), jpeg.end()};
}

const std::string service_2 =
    R"({"@context": "http://iiif.io/api/image/2/context.json", "width": 600, "height": 400,
        "profile": ["http://iiif.io/api/image/2/level1.json"],
        "tiles": [{"width": 256, "scaleFactors": [1, 2]}]})";
const std::string service_3 =
    R"({"@context": "http://iiif.io/api/image/3/context.json", "type": "ImageService3",
        "profile": "level2", "width": 600, "height": 400, "tiles": [{"width": 256,
        "scaleFactors": [1, 2]}]})";

// Serves the tiles that version 2 or 3 asks for; other requests are no tiles of it.
ServerAnswer serve(const std::string& info, bool third, const std::string& path) {
  if (path == "/a/info.json") return {200, info, {}, false, {}};
  for (int scale : {1, 2, 4}) {
    const int wide = 600 / scale, high = 400 / scale;
    for (int y = 0; y < high; y += 256)
      for (int x = 0; x < wide; x += 256) {
        const int w = std::min(256, wide - x), h = std::min(256, high - y);
        const bool all = w == wide && h == high;
        std::string region = all ? "full" : "";
        if (!all)
          for (int number : {x, y, w, h})
            region += (region.empty() ? "" : ",") + std::to_string(number * scale);
        const std::string size = std::to_string(w) + "," + (third ? std::to_string(h) : "");
        if (path == "/a/" + region + "/" + size + "/0/default.jpg")
          return {200, jpeg_of(x, y, w, h, scale), {}, false, {}};
      }
  }
  return {400, "no tile", {}, false, {}};
}

template <class Load>
std::string told(const Load& load) {
  try {
    load();
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(IiifService, TilesAreAskedForAsBothVersionsHaveThem) {
  for (const bool third : {false, true}) {
    SCOPED_TRACE(third);
    const ImageServer server(
        [&](const std::string& path) { return serve(third ? service_3 : service_2, third, path); });
    for (const char* path : {"/a", "/a/info.json"}) {
      const auto pyramid = load_iiif_service(server.address(path), {server.host()});
      ASSERT_EQ(pyramid->levels().size(), 3u) << "a level that is one tile is added";
      for (int i = 0; i < 3; i++) {
        const PyramidLevel& level = pyramid->levels()[size_t(i)];
        expect_same(whole_level(*pyramid, i),
                    piece_of(int(level.width), int(level.height),
                             [&](int x, int y, int c) { return smooth(x << i, y << i, c); }),
                    4);
      }
    }
  }
}

TEST(IiifService, OpenPictureKnowsAddresses) {
  const ImageServer server([&](const std::string& path) { return serve(service_2, false, path); });
  EXPECT_EQ(open_picture(server.address("/a"), "", "en", {server.host()})->levels()[0].width, 600);
  EXPECT_NE(told([&] { open_picture(server.address("/a")); }).find("is not allowed"),
            std::string::npos);
}

TEST(IiifService, ATileThatIsNotThereIsAbsentAndFilesHaveAnotherName) {
  const std::string info =
      R"({"@context": "http://iiif.io/api/image/2/context.json", "width": 40, "height": 20,
          "profile": "http://iiif.io/api/image/2/level0.json",
          "tiles": [{"width": 20, "scaleFactors": [1]}]})";
  const ImageServer server([&](const std::string& path) -> ServerAnswer {
    if (path == "/a/info.json") return {200, info, {}, false, {}};
    if (path == "/a/0,0,20,20/20,20/0/default.jpg")
      return {200, jpeg_of(0, 0, 20, 20, 1), {}, false, {}};
    return {};
  });
  const auto pyramid = load_iiif_service(server.address("/a"), {server.host()});
  EXPECT_NE(pyramid->fetch({1, 0, 0, 0}).piece, nullptr);
  const Fetched absent = pyramid->fetch({1, 0, 1, 0});
  EXPECT_EQ(absent.piece, nullptr);
  EXPECT_EQ(absent.hard, 60);
}

TEST(IiifService, TilesThatFailAreAskedForAgain) {
  std::atomic<int> mode = 0;  // 0: status 500, 1: silence, 2: a broken file, 3: all is well
  const ImageServer server([&](const std::string& path) -> ServerAnswer {
    if (path == "/a/info.json" || mode == 3) return serve(service_2, false, path);
    if (mode == 2) return {200, "no picture", {}, false, {}};
    return {500, "", {}, mode == 1, {}};
  });
  const auto pyramid = load_iiif_service(server.address("/a"), {server.host()}, 0.3);
  double now = 100;
  const auto pieces = std::make_shared<PieceStore>(size_t(1) << 24, 0, [&] { return now; });
  const int source = pieces->add(pyramid);
  PieceClient client(pieces);
  const std::string words[] = {"status 500", "does not answer within 0.3 s", "default.jpg"};
  for (mode = 0; mode < 4; mode++, now += 11) {
    client.want({{PieceKey(source, 2, 0, 0)}});
    client.fetch();
    const StoreStats stats = pieces->stats();
    EXPECT_EQ(stats.failed, uint64_t(std::min(mode + 1, 3)));
    if (mode < 3) {
      EXPECT_NE(stats.last_error.find(words[mode]), std::string::npos) << mode;
    }
  }
  EXPECT_NE(PieceReader(*pieces).find(PieceKey(source, 2, 0, 0)), nullptr);
  EXPECT_EQ(server.times("/a/full/150,/0/default.jpg"), 4);
}

TEST(IiifService, TilesMayBeATexelOff) {
  for (const int off : {1, -1, 2, -2}) {
    const ImageServer server([&](const std::string& path) -> ServerAnswer {
      if (path == "/a/info.json") return serve(service_2, false, path);
      return {200, jpeg_of(0, 0, 150, 100 + off, 4), {}, false, {}};
    });
    const auto pyramid = load_iiif_service(server.address("/a"), {server.host()});
    const std::string wrong = told([&] {
      const auto tile = pyramid->fetch({1, 2, 0, 0}).piece;
      EXPECT_EQ(tile->height, 100);
      EXPECT_NEAR(tile->bytes[size_t(99 * 150) * 4 + 1], smooth(0, 396, 1), 4);
    });
    EXPECT_EQ(wrong.empty(), std::abs(off) == 1) << wrong;
  }
}

TEST(IiifService, OnlyAllowedHostsAreAskedAlsoByRedirects) {
  const ImageServer other([&](const std::string& path) { return serve(service_2, false, path); });
  std::string to;
  const ImageServer server([&](const std::string& path) -> ServerAnswer {
    if (path.starts_with("/moved")) return {302, "", to, false, {}};
    return serve(service_2, false, path);
  });
  const auto open = [&](const std::string& path, const std::vector<std::string>& hosts) {
    return told([&] { load_iiif_service(server.address(path), hosts); });
  };
  for (const std::vector<std::string>& hosts :
       {std::vector<std::string>{}, {"127.0.0.1"}, {"127.0.0.1:1"}, {"iiif.example.org"}})
    EXPECT_NE(open("/a", hosts).find("host '" + server.host() + "' is not allowed"),
              std::string::npos);
  EXPECT_EQ(server.asked().size(), 0u);
  const std::vector<std::string> both = {server.host(), "localhost", "localhost:80"};
  to = "/a/info.json";
  EXPECT_EQ(open("/moved", both), "");
  to = other.address("/a/info.json");
  EXPECT_NE(open("/moved", both).find("is not allowed"), std::string::npos);
  to = "http://localhost/a/info.json";
  EXPECT_NE(open("/moved", both).find("another host"), std::string::npos);
  to = "/moved/info.json";
  EXPECT_NE(open("/moved", both).find("too many times"), std::string::npos);
  EXPECT_EQ(other.asked().size(), 0u);
}

TEST(IiifService, AnswersThatAreTooLongOrLieAreRefused) {
  ServerAnswer answer;
  const ImageServer server([&](const std::string&) { return answer; });
  const auto open = [&] {
    return told([&] { load_iiif_service(server.address("/a"), {server.host()}, 0.5); });
  };
  answer = {200, std::string((1 << 20) + 1, ' '), {}, false, {}};
  EXPECT_NE(open().find("more than 1048576 bytes"), std::string::npos);
  answer = {200, "{}", {}, false, "999999999999"};
  EXPECT_NE(open().find("more than 1048576 bytes"), std::string::npos);
  answer = {200, "{}", {}, false, "50"};
  EXPECT_NE(open().find("breaks off"), std::string::npos);
  const auto lie = [&](const std::string& from, const std::string& to) {
    std::string info = service_2;
    info.replace(info.find(from), from.size(), to);
    answer = {200, info, {}, false, {}};
    return open();
  };
  EXPECT_NE(lie("\"width\": 600", "\"width\": -3").find("/a/info.json: /width: "),
            std::string::npos);
  EXPECT_NE(lie("\"width\": 256", "\"width\": 99999").find("/tiles/0/width"), std::string::npos);
  EXPECT_NE(lie("\"width\": 256", "\"width\": 1").find("16 to 4096"), std::string::npos);
  EXPECT_NE(lie("[1, 2]", "[1, 0]").find("/tiles/0/scaleFactors/1"), std::string::npos);
  EXPECT_NE(lie("api/image/2", "api/image/9").find("/@context"), std::string::npos);
  EXPECT_NE(lie("{", "<").find("info.json"), std::string::npos);
  EXPECT_NE(lie("level1.json\"]", "level0.json\"], \"sizes\": 7").find("/sizes: is no list"),
            std::string::npos);
  answer = {404, "", {}, false, {}};
  EXPECT_NE(open().find("is not there"), std::string::npos);
}

TEST(IiifService, AServerThatIsNotThereIsNamed) {
  std::string gone;
  {
    gone = ImageServer([](const std::string&) { return ServerAnswer(); }).host();
  }
  EXPECT_NE(told([&] {
              load_iiif_service("http://" + gone + "/a", {gone});
            }).find("http://" + gone + "/a/info.json: cannot be reached"),
            std::string::npos);
}

TEST(IiifService, ServersWithoutTlsAreNotTakenForHttps) {
  const ImageServer server([&](const std::string& path) { return serve(service_2, false, path); });
  EXPECT_NE(told([&] { load_iiif_service("https://" + server.host() + "/a", {server.host()}, 1); }),
            "");
  EXPECT_EQ(server.asked().size(), 0u);
}

TEST(HttpAddress, IsTakenApart) {
  const auto address = read_http_address("HTTPS://Iiif.Example.org:8443/a%20b?c#d");
  ASSERT_TRUE(address.has_value());
  EXPECT_TRUE(address->tls);
  EXPECT_EQ(address->host, "iiif.example.org");
  EXPECT_EQ(address->port, 8443);
  EXPECT_EQ(address->path, "/a%20b?c");
  EXPECT_EQ(read_http_address("http://[::1]:80")->host, "::1");
  EXPECT_EQ(host_text(*read_http_address("http://[::1]/")), "[::1]");
  EXPECT_TRUE(is_allowed(*read_http_address("https://a.b/"), {"A.B"}));
  EXPECT_FALSE(is_allowed(*read_http_address("https://a.b:8443/"), {"a.b"}));
  for (const char* wrong :
       {"", "http://", "ftp://a", "http://a:0/", "http://a:99999/", "http://a:/", "http://u@a/",
        "http://a b/", "http://a/\r\nX: y", "http://[::1", "http://a:80x/", "http://]/"})
    EXPECT_FALSE(read_http_address(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace wellspring::test
