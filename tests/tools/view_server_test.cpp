// The server of `palpate view`: the requests that it answers, and the abuse that it survives.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "page_client.h"
#include "palpate/core/error.h"
#include "support/wait.h"
#include "view/page_request.h"
#include "view/page_server.h"

namespace palpate::tools {
namespace {

using testing::PageLine;
using testing::PageSocket;
using testing::waitUntil;

constexpr std::array<PageFile, 2> kFiles = {
    {{"index.html", "text/html; charset=utf-8", "<p>the page</p>"},
     {"page.js", "text/javascript; charset=utf-8", "let page;"}}};

/// A host that records the calls to it.
class NotingHost {
 public:
  [[nodiscard]] PageHost host() {
    return {.get = [this](std::string_view path) -> std::optional<PageAnswer> {
              const std::lock_guard lock(mutex_);
              asked_.emplace_back(path);
              if (path != "scene.json") return std::nullopt;
              return PageAnswer{"application/json", std::make_shared<const std::string>("{}")};
            },
            .snapshot = [this](std::uint64_t& seen, const PagePlace& place) -> std::string {
              ++snapshots_;
              ++seen;
              return "{\"seen\":" + std::to_string(seen) +
                     ",\"steers\":" + (place.steers ? "true" : "false") +
                     ",\"steered\":" + (place.is_steered ? "true" : "false") + "}";
            },
            .command =
                [this](const std::string& message) {
                  const std::lock_guard lock(mutex_);
                  commands_.push_back(message);
                }};
  }
  [[nodiscard]] std::vector<std::string> asked() {
    const std::lock_guard lock(mutex_);
    return asked_;
  }
  [[nodiscard]] std::vector<std::string> commands() {
    const std::lock_guard lock(mutex_);
    return commands_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> asked_;
  std::vector<std::string> commands_;
  std::atomic<int> snapshots_{0};
};

/// A server with two files.
struct Served {
  NotingHost notes;
  PageServer server{notes.host(), {.rate = 500.0, .files = kFiles}};

  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(server.port()); }
  [[nodiscard]] std::string below(const std::string& path) const {
    return "/" + server.token() + "/" + path;
  }
  [[nodiscard]] testing::HttpReply get(const std::string& target) const {
    return PageSocket(server.port()).get(target, host());
  }
};

/// Reads messages until one contains `part`; false if the connection ends before.
bool hearsOf(PageLine& line, const std::string& part) {
  while (const auto text = line.hear()) {
    if (text->find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(PageRequests, OnlyThePagesOwnAreServed) {
  const std::string token = "0123456789abcdef0123456789abcdef";
  const std::string target = "/" + token + "/a.js?x=1";
  const auto verdict = [&](std::string_view asked, std::string_view host, std::string_view origin,
                           bool is_upgrade = false) {
    return decide({asked, host, origin, is_upgrade}, token, 4000).verdict;
  };
  EXPECT_EQ(verdict(target, "127.0.0.1:4000", ""), PageVerdict::kServe);
  EXPECT_EQ(verdict(target, "localhost:4000", "http://localhost:4000"), PageVerdict::kServe);
  EXPECT_EQ(decide({target, "127.0.0.1:4000", "", false}, token, 4000).path, "a.js");
  // Foreign names that somebody has made resolve to this machine.
  for (const char* host :
       {"evil.example:4000", "127.0.0.1", "127.0.0.1:4001", "", "127.0.0.1.evil:4000"}) {
    EXPECT_EQ(verdict(target, host, ""), PageVerdict::kForeignHost) << host;
  }
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:4000",
                             "http://127.0.0.1:4001", "http://127.0.0.1:40000"}) {
    EXPECT_EQ(verdict(target, "127.0.0.1:4000", origin), PageVerdict::kForeignOrigin) << origin;
  }
  // Every browser states the origin of the page when it opens a WebSocket.
  EXPECT_EQ(verdict(target, "127.0.0.1:4000", "", true), PageVerdict::kForeignOrigin);
  EXPECT_EQ(verdict(target, "127.0.0.1:4000", "http://127.0.0.1:4000", true), PageVerdict::kServe);
  for (const std::string& wrong :
       {std::string("/"), std::string(), std::string("/a.js"), "/" + token, "/" + token + "0/a.js",
        "/" + token.substr(1) + "/a.js", "//" + token + "/a.js",
        std::string("/fedcba9876543210fedcba9876543210/a.js")}) {
    EXPECT_EQ(verdict(wrong, "127.0.0.1:4000", ""), PageVerdict::kWrongToken) << wrong;
  }
}

TEST(PageRequests, TokensAreLongAndNeverTheSame) {
  const std::string token = randomToken();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, randomToken());
}

TEST(PageServer, ServesItsFilesAndItsHost) {
  Served served;
  const auto page = served.get(served.below(""));
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_EQ(page.body, "<p>the page</p>");
  EXPECT_EQ(served.get(served.below("page.js")).body, "let page;");
  EXPECT_EQ(served.get(served.below("scene.json")).body, "{}");
  EXPECT_EQ(served.server.url(), "http://" + served.host() + served.below(""));
  EXPECT_EQ(served.server.counts().refused, 0U);
}

TEST(PageServer, RefusesWhoIsNotItsPage) {
  Served served;
  const auto reply = [&](const std::string& target, const std::string& host,
                         const std::string& origin) {
    return PageSocket(served.server.port()).get(target, host, origin);
  };
  for (const auto& refused :
       {reply("/", served.host(), ""), reply("/" + std::string(32, '0') + "/", served.host(), ""),
        reply(served.below(""), "evil.example:" + std::to_string(served.server.port()), ""),
        reply(served.below("scene.json"), served.host(), "http://evil.example")}) {
    EXPECT_EQ(refused.status, 403);
    EXPECT_EQ(refused.body.find("page</p>"), std::string::npos);
  }
  // A request with two Host headers is refused.
  PageSocket doubled(served.server.port());
  EXPECT_EQ(doubled.get(served.below(""), served.host() + "\r\nHost: evil.example").status, 403);
  EXPECT_FALSE(PageLine(served.server.port()).open(std::string(32, '0')));
  EXPECT_FALSE(PageLine(served.server.port()).open(served.server.token(), "http://evil.example"));
  EXPECT_FALSE(PageLine(served.server.port()).open(served.server.token(), ""));
  EXPECT_EQ(served.server.counts().refused, 8U);
  EXPECT_TRUE(served.notes.asked().empty());
}

TEST(PageServer, NoPathLeadsOutOfThePage) {
  Served served;
  for (const char* path :
       {"../../../../etc/passwd", "/etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "..%2fetc%2fpasswd",
        "page.js/../../../etc/passwd", "./index.html", "index.html%00", "..\\..\\etc\\passwd"}) {
    const auto reply = served.get(served.below(path));
    EXPECT_EQ(reply.status, 404) << path;
    EXPECT_EQ(reply.body, "there is no such file\n") << path;
  }
}

TEST(PageServer, AnswersNothingButGetAndHead) {
  Served served;
  PageSocket post(served.server.port());
  post.send("POST " + served.below("") + " HTTP/1.1\r\nHost: " + served.host() +
            "\r\nContent-Length: 5\r\n\r\nhello");
  // The server does not read bodies: it closes the connection, or answers that there is no such
  // page.
  const auto after = post.get(served.below("page.js"), served.host());
  EXPECT_NE(after.body, "let page;");
  PageSocket deletes(served.server.port());
  deletes.send("DELETE " + served.below("") + " HTTP/1.1\r\nHost: " + served.host() + "\r\n\r\n");
  EXPECT_EQ(deletes.get(served.below("page.js"), served.host()).status, 404);
}

TEST(PageServer, OnePageSteersAndOthersWatch) {
  Served served;
  auto first = std::make_unique<PageLine>(served.server.port());
  ASSERT_TRUE(first->open(served.server.token()));
  PageLine second(served.server.port());
  ASSERT_TRUE(second.open(served.server.token()));

  first->say(R"({"steer":true})");
  ASSERT_TRUE(hearsOf(*first, R"("steers":true)"));
  ASSERT_TRUE(hearsOf(second, R"("steers":false,"steered":true)"));
  second.say(R"({"steer":true})");
  second.say(R"({"to":[2,2,2]})");
  second.say(R"({"steer":false})");
  first->say(R"({"to":[1,1,1]})");
  ASSERT_TRUE(waitUntil([&] { return !served.notes.commands().empty(); }));
  // The second page's commands were read before, and dropped. Make sure that they were all read: it
  // now receives messages that it does not steer.
  second.say("x");
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(second.hear().has_value());
  EXPECT_EQ(served.notes.commands(), std::vector<std::string>{R"({"to":[1,1,1]})"});

  // The steering page disappears without a message; then the other one may steer.
  first->kill();
  ASSERT_TRUE(hearsOf(second, R"("steered":false)"));
  second.say(R"({"steer":true})");
  ASSERT_TRUE(hearsOf(second, R"("steers":true)"));
  second.say(R"({"to":[3,3,3]})");
  ASSERT_TRUE(waitUntil([&] { return served.notes.commands().size() == 2; }));
}

TEST(PageServer, BearsAThousandConnectionsThatDie) {
  Served served;
  const std::string head = "GET " + served.below("page.js") + " HTTP/1.1\r\nHost: " + served.host();
  for (int i = 0; i < 1000; ++i) {
    if (i % 5 == 4) {
      PageLine line(served.server.port());
      EXPECT_TRUE(line.open(served.server.token())) << i;
      line.say("not JSON");
      line.kill();
      continue;
    }
    PageSocket socket(served.server.port());
    if (i % 5 == 1) socket.send(head.substr(0, 20));          // in the middle of a request
    if (i % 5 == 2) socket.send(head + "\r\n\r\n");           // before the answer
    if (i % 5 == 3) socket.send(std::string(20000, '\x16'));  // not HTTP at all
    socket.kill();
  }
  EXPECT_TRUE(waitUntil([&] { return served.server.connections() == 0; }));
  EXPECT_EQ(served.get(served.below("page.js")).body, "let page;");
  EXPECT_EQ(served.server.counts().connections, 1001U);
}

TEST(PageServer, HasRoomForSoManyAndNoMore) {
  Served served;
  std::vector<std::unique_ptr<PageSocket>> open;
  for (int i = 0; i < PageServer::kMostConnections + 10; ++i) {
    open.push_back(std::make_unique<PageSocket>(served.server.port()));
  }
  ASSERT_TRUE(waitUntil([&] { return served.server.counts().turned_away == 10; }));
  EXPECT_EQ(served.server.connections(), PageServer::kMostConnections);
  open.clear();
  ASSERT_TRUE(waitUntil([&] { return served.server.connections() == 0; }));
  EXPECT_EQ(served.get(served.below("")).status, 200);
}

TEST(PageServer, AFloodIsCutOffAndOthersGoOn) {
  Served served;
  PageLine flood(served.server.port());
  PageLine other(served.server.port());
  ASSERT_TRUE(flood.open(served.server.token()));
  ASSERT_TRUE(other.open(served.server.token()));
  // Sends so many messages that some second has too many, however slowly they pass; the server then
  // closes the connection.
  int sent = 0;
  constexpr int kMost = 10'000'000;
  while (sent < kMost && flood.say(R"({"to":[0,0,0]})")) ++sent;
  EXPECT_LT(sent, kMost);
  EXPECT_TRUE(other.hear().has_value());
  EXPECT_TRUE(waitUntil([&] { return served.server.connections() == 1; }));
}

TEST(PageServer, AMessageTooLongIsCutOff) {
  Served served;
  PageLine line(served.server.port());
  ASSERT_TRUE(line.open(served.server.token()));
  line.say(std::string(PageServer::kLongestCommand + 1, 'x'));
  while (line.hear().has_value()) {
  }
  EXPECT_TRUE(waitUntil([&] { return served.server.connections() == 0; }));
}

TEST(PageServer, ASlowReaderGetsFewMessagesAndHoldsUpNobody) {
  // Two readers, told apart by their number of messages: one reads, the other one never does.
  std::mutex mutex;
  std::vector<std::uint64_t*> seen;  // for each connection, in the order of their opening
  std::vector<std::uint64_t> made;
  const std::string filling(100'000, ' ');
  PageServer server({.get = {},
                     .snapshot =
                         [&](std::uint64_t& own, const PagePlace&) {
                           const std::lock_guard lock(mutex);
                           std::size_t i = 0;
                           while (i < seen.size() && seen[i] != &own) ++i;
                           if (i == seen.size()) {
                             seen.push_back(&own);
                             made.push_back(0);
                           }
                           ++made[i];
                           return filling;
                         },
                     .command = {}},
                    {.rate = 1000.0, .unseen = 0.0});
  PageLine slow(server.port());
  ASSERT_TRUE(slow.open(server.token()));
  ASSERT_TRUE(waitUntil([&] {
    const std::lock_guard lock(mutex);
    return seen.size() == 1;
  }));
  PageLine quick(server.port());
  ASSERT_TRUE(quick.open(server.token()));
  const auto made_for_slow = [&] {
    const std::lock_guard lock(mutex);
    return made[0];
  };
  // The kernel's buffers fill up; from then on no message is made for the reader that does not
  // read.
  std::uint64_t before = 0;
  do {
    before = made_for_slow();
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(quick.hear().has_value());
  } while (made_for_slow() != before);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(quick.hear().has_value());
  EXPECT_EQ(made_for_slow(), before);
}

TEST(PageServer, APageThatHasNotShownAMessageGetsNoOther) {
  std::atomic<int> made{0};
  PageServer server(
      {.get = {},
       .snapshot = [&](std::uint64_t&, const PagePlace&) { return std::to_string(++made); },
       .command = {}},
      {.rate = 1000.0, .unseen = 3600.0});
  PageLine line(server.port());
  ASSERT_TRUE(line.open(server.token()));
  ASSERT_EQ(line.hearOnly(), "1");
  // Another page gets hundreds of messages, while this one has not yet shown its first.
  PageLine other(server.port());
  ASSERT_TRUE(other.open(server.token()));
  for (int i = 2; i < 300; ++i) ASSERT_EQ(other.hear(), std::to_string(i));
  ASSERT_TRUE(line.say(R"({"seen":true})"));
  // Its next message is up to date; the other page's next one may have been made before it.
  const std::optional<std::string> next = line.hearOnly();
  ASSERT_TRUE(next);
  EXPECT_GE(std::stoi(*next), 300);
}

TEST(PageServer, APortThatIsTakenIsAnError) {
  Served served;
  NotingHost other;
  try {
    const PageServer second(other.host(), {.port = served.server.port()});
    ADD_FAILURE() << "two servers at one port";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kOperation);
    EXPECT_EQ(error.problem().code, "view.port");
  }
}

TEST(PageServer, EndsWhileItsPagesAreOpen) {
  auto served = std::make_unique<Served>();
  PageLine line(served->server.port());
  ASSERT_TRUE(line.open(served->server.token()));
  ASSERT_TRUE(line.hear().has_value());
  served.reset();
  while (line.hear().has_value()) {
  }
}

}  // namespace
}  // namespace palpate::tools
