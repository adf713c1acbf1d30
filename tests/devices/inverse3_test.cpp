// The Inverse3's driver against a mock service, over WebSocket on the loopback.

#ifdef PALPATE_INVERSE3

#include "palpate/devices/inverse3.h"

#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "palpate/devices/device.h"
#include "support/alloc_guard.h"
#include "support/error_of.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Json = nlohmann::json;

/// One connection: sends the device's state, then answers each message with one.
class MockService {
 public:
  /// The first message, and the answer to message `n` (from 0); empty: hang up.
  std::function<std::string(int)> answer = [](int n) { return state(n); };
  std::string greeting = state(0);
  bool is_silent = false;  // it does not send the first message

  MockService()
      : acceptor_(context_, asio::ip::tcp::endpoint(asio::ip::address_v4::loopback(), 0)) {}
  ~MockService() {
    boost::system::error_code ignored;
    if (thread_.joinable()) {
      // Connects once, so that a server which still waits for a connection can end.
      asio::ip::tcp::socket poke(context_);
      poke.connect(acceptor_.local_endpoint(), ignored);
      poke.close(ignored);
      thread_.join();
    }
  }
  MockService(const MockService&) = delete;
  MockService& operator=(const MockService&) = delete;

  void start() {
    thread_ = std::thread([this] { serve(); });
  }
  [[nodiscard]] Inverse3Settings settings() const {
    Inverse3Settings out;
    out.port = acceptor_.local_endpoint().port();
    return out;
  }
  [[nodiscard]] std::vector<Vec3> forces() {
    const std::lock_guard lock(mutex_);
    return forces_;
  }
  [[nodiscard]] int messages() const { return messages_; }

  static std::string state(int n) {
    return Json{{"session_id", "s"},
                {"inverse3",
                 Json::array({{{"device_id", "A1"},
                               {"state",
                                {{"cursor_position", {{"x", 0.001 * n}, {"y", 0.02}, {"z", -0.03}}},
                                 {"cursor_velocity", {{"x", 1.0}, {"y", 0.0}, {"z", 0.0}}}}}}})}}
        .dump();
  }

 private:
  void serve() {
    boost::system::error_code bad;
    asio::ip::tcp::socket socket(context_);
    acceptor_.accept(socket, bad);
    if (bad) return;
    beast::websocket::stream<asio::ip::tcp::socket> stream(std::move(socket));
    stream.accept(bad);
    if (bad) return;
    if (!is_silent) stream.write(asio::buffer(greeting), bad);
    for (int n = 1; !bad; ++n) {
      beast::flat_buffer buffer;
      stream.read(buffer, bad);
      if (bad) return;
      const Json message = Json::parse(beast::buffers_to_string(buffer.data()), nullptr, false);
      const Json& device = message["inverse3"][0];
      const Json& vector = device["commands"]["set_cursor_force"]["vector"];
      {
        const std::lock_guard lock(mutex_);
        if (device["device_id"] == "A1") {
          forces_.emplace_back(vector["x"].get<double>(), vector["y"].get<double>(),
                               vector["z"].get<double>());
        }
      }
      ++messages_;
      const std::string text = answer(n);
      if (text.empty()) return;
      stream.write(asio::buffer(text), bad);
    }
  }

  asio::io_context context_;
  asio::ip::tcp::acceptor acceptor_;
  std::thread thread_;
  std::mutex mutex_;
  std::vector<Vec3> forces_;
  std::atomic<int> messages_{0};
};

DeviceStatus nextReading(Device& device, DeviceState& state) {
  DeviceStatus status = DeviceStatus::kStale;
  (void)testing::waitUntil([&] {
    status = device.read(state);
    return status != DeviceStatus::kStale;
  });
  return status;
}

TEST(Inverse3, EachWriteIsAForceAndEachAnswerAReading) {
  MockService service;
  service.start();
  const auto device = makeInverse3(service.settings());
  device->open();
  DeviceState state;
  ASSERT_EQ(nextReading(*device, state), DeviceStatus::kOk);
  EXPECT_EQ(state.position.y, 0.02);
  EXPECT_EQ(state.velocity.x, 1.0);
  for (int n = 1; n <= 50; ++n) {
    ASSERT_EQ(device->write(Vec3(n, 0.0, -1.0)), DeviceStatus::kOk);
    ASSERT_TRUE(testing::waitUntil(
        [&] { return !service.forces().empty() && service.forces().back().x == n; }));
    ASSERT_EQ(nextReading(*device, state), DeviceStatus::kOk);
  }
  EXPECT_GE(state.position.x, 0.049);
  EXPECT_EQ(service.forces().front(), Vec3(0.0)) << "the first one asks for an answer only";
  device->close();
  EXPECT_EQ(device->read(state), DeviceStatus::kDisconnected);
  EXPECT_TRUE(testing::waitUntil([&] { return service.forces().back() == Vec3(0.0); }));
}

TEST(Inverse3, ALoopRampsAndLeavesZeroForce) {
  MockService service;
  service.start();
  const auto device = makeInverse3(service.settings());
  std::atomic<bool> stop{false};
  int ticks = 0;
  const auto tick = [&](const DeviceState& /*state*/) {
    if (++ticks == 100) stop = true;
    return Vec3(3.0, 0.0, 0.0);
  };
  const ServoReport report = runServo(*device, tick, {.realtime = true, .rate = 2000.0}, stop);
  if (report.exit == ServoExit::kStopped) {
    EXPECT_EQ(report.ticks, 100U);
  }
  const std::vector<Vec3> forces = service.forces();
  ASSERT_FALSE(forces.empty());
  for (const Vec3& force : forces) EXPECT_LE(glm::length(force), 3.0);
  EXPECT_EQ(forces.front(), Vec3(0.0));
}

TEST(Inverse3, AServiceThatHangsUpIsAnUnplugging) {
  MockService service;
  service.answer = [](int n) { return n < 10 ? MockService::state(n) : std::string(); };
  service.start();
  const auto device = makeInverse3(service.settings());
  device->open();
  DeviceState state;
  DeviceStatus status = DeviceStatus::kOk;
  (void)testing::waitUntil([&] {
    (void)device->write(Vec3(1.0));
    status = device->read(state);
    return status != DeviceStatus::kOk && status != DeviceStatus::kStale;
  });
  EXPECT_EQ(status, DeviceStatus::kDisconnected);
}

TEST(Inverse3, GarbageIsNoReading) {
  for (const std::string& bad :
       {std::string("{"), std::string("[]"), std::string("{\"inverse3\": 5}"),
        std::string("{\"inverse3\": [{\"device_id\": \"A1\"}]}"),
        std::string("{\"inverse3\": [{\"device_id\": \"B2\", \"state\": {}}]}"),
        std::string(
            "{\"inverse3\": [{\"device_id\": \"A1\", \"state\": {\"cursor_position\": {\"x\": "
            "\"1\", \"y\": 0, \"z\": 0}}}]}")}) {
    MockService service;
    service.answer = [&](int n) { return n % 2 == 1 ? bad : MockService::state(n); };
    service.start();
    const auto device = makeInverse3(service.settings());
    device->open();
    DeviceState state;
    ASSERT_EQ(nextReading(*device, state), DeviceStatus::kOk);
    for (int n = 0; n < 4; ++n) {
      const int before = service.messages();
      (void)device->write(Vec3(1.0));
      ASSERT_TRUE(testing::waitUntil([&] { return service.messages() != before; }));
      const DeviceStatus status = device->read(state);
      EXPECT_TRUE(status == DeviceStatus::kOk || status == DeviceStatus::kStale) << bad;
      EXPECT_EQ(state.position.y, 0.02);
    }
  }
}

TEST(Inverse3, AServiceIsFoundWhereItListensOnly) {
  Inverse3Settings nobody;
  {
    MockService gone;  // its port is free again
    nobody = gone.settings();
  }
  EXPECT_FALSE(hasInverseService(nobody));
  MockService service;
  service.start();
  EXPECT_TRUE(hasInverseService(service.settings()));
}

TEST(Inverse3, NobodyThereOrNoSuchDeviceIsToldWithTheRemedy) {
  Inverse3Settings nobody;
  {
    MockService gone;  // its port is free again
    nobody = gone.settings();
  }
  const Error error = errorOf([&] { makeInverse3(nobody)->open(); });
  EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  EXPECT_EQ(error.problem().code, "device.service");
  EXPECT_NE(error.problem().hint.find("Inverse Service"), std::string::npos);
  MockService service;
  service.start();
  Inverse3Settings other = service.settings();
  other.id = "B2";
  EXPECT_EQ(errorOf([&] { makeInverse3(other)->open(); }).problem().code, "device.service");
  other.host = "no host";
  EXPECT_EQ(errorOf([&] { makeInverse3(other)->open(); }).problem().code, "device.service");
}

TEST(Inverse3, AServiceThatSaysNothingIsGivenUp) {
  MockService service;
  service.is_silent = true;
  service.start();
  const Error error = errorOf([&] { makeInverse3(service.settings())->open(); });
  EXPECT_EQ(error.problem().code, "device.service");
  EXPECT_NE(error.problem().message.find("it does not answer"), std::string::npos);
  EXPECT_EQ(service.messages(), 0);
}

TEST(Inverse3, ReadingAndWritingNeitherAllocateNorLock) {
  MockService service;
  service.start();
  const auto device = makeInverse3(service.settings());
  device->open();
  DeviceState state;
  const testing::AllocGuard guard;
  for (int n = 0; n < 1000; ++n) {
    (void)device->read(state);
    (void)device->write(Vec3(1.0, 0.0, 0.0));
  }
  EXPECT_EQ(guard.violations(), 0);
}

}  // namespace
}  // namespace palpate::devices

#endif
