#include "node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace palpate::testing {
namespace {

template <std::size_t kSize>
std::vector<unsigned char> bytesOf(const std::bitset<kSize>& bits) {
  std::vector<unsigned char> out((kSize + 7) / 8);
  for (std::size_t i = 0; i < kSize; ++i) {
    if (bits[i]) out[i / 8] = static_cast<unsigned char>(out[i / 8] | (1U << (i % 8)));
  }
  return out;
}

}  // namespace

Node::Node(const Testbed& bed, int number)
    : bed_(bed),
      path_("/dev/input/event" + std::to_string(number)),
      base_(umockdev_ioctl_base_new()) {
  const std::string text = "P: /devices/mock/event" + std::to_string(number) + "\nN: input/event" +
                           std::to_string(number) + "\nE: SUBSYSTEM=input\nE: DEVNAME=" + path_ +
                           "\n";
  GError* error = nullptr;
  EXPECT_TRUE(umockdev_testbed_add_from_string(bed.get(), text.c_str(), &error))
      << (error != nullptr ? error->message : "");
  g_signal_connect(base_, "handle-ioctl", G_CALLBACK(&Node::onIoctl), this);
  g_signal_connect(base_, "handle-read", G_CALLBACK(&Node::onRead), this);
  EXPECT_TRUE(umockdev_testbed_attach_ioctl(bed.get(), path_.c_str(), base_, &error))
      << (error != nullptr ? error->message : "");
}

Node::~Node() {
  umockdev_testbed_detach_ioctl(bed_.get(), path_.c_str(), nullptr);
  g_object_unref(base_);
}

void Node::report(std::int64_t at, const std::vector<Input>& inputs) {
  const std::lock_guard lock(mutex_);
  push(at, inputs);
}

void Node::reportAtRead(int number, const std::vector<Input>& inputs) {
  const std::lock_guard lock(mutex_);
  at_read_[number] = inputs;
}

void Node::push(std::int64_t at, const std::vector<Input>& inputs) {
  std::vector<Input> all = inputs;
  all.push_back({EV_SYN, SYN_REPORT, 0});
  for (const Input& each : all) {
    input_event event{};
    event.input_event_sec = at / 1'000'000'000;
    event.input_event_usec = at % 1'000'000'000 / 1'000;
    event.type = static_cast<std::uint16_t>(each.type);
    event.code = static_cast<std::uint16_t>(each.code);
    event.value = each.value;
    queue_.push_back(event);
  }
}

void Node::unplug() {
  const std::lock_guard lock(mutex_);
  is_gone_ = true;
}

void Node::unplugAfter(int calls) {
  const std::lock_guard lock(mutex_);
  calls_left_ = calls;
}

/// The bytes that the kernel would return for the request `number`; empty: it has none.
std::vector<unsigned char> Node::bytesFor(unsigned number) {
  if (number == 0x06) return {name.c_str(), name.c_str() + name.size() + 1};
  if (number == 0x18) return bytesOf(keys);
  if (number == 0x20) {
    std::bitset<EV_CNT> types;
    types[EV_SYN] = true;
    types[EV_KEY] = has_keys.any();
    types[EV_REL] = has_relative.any();
    types[EV_ABS] = !absolute.empty();
    return bytesOf(types);
  }
  if (number == 0x20 + EV_KEY) return bytesOf(has_keys);
  if (number == 0x20 + EV_REL) return bytesOf(has_relative);
  if (number == 0x20 + EV_ABS) {
    std::bitset<ABS_CNT> codes;
    for (const auto& [code, range] : absolute) codes.set(static_cast<std::size_t>(code));
    return bytesOf(codes);
  }
  const auto axis = absolute.find(static_cast<int>(number) - 0x40);
  if (axis == absolute.end()) return {};
  std::vector<unsigned char> out(sizeof(input_absinfo));
  std::memcpy(out.data(), &axis->second, out.size());
  return out;
}

bool Node::answer(UMockdevIoctlClient* client) {
  const std::lock_guard lock(mutex_);
  const gulong request = umockdev_ioctl_client_get_request(client);
  if (_IOC_TYPE(request) != 'E') return false;
  if (is_gone_ || calls_left_ == 0) {
    umockdev_ioctl_client_complete(client, -1, ENODEV);
    return true;
  }
  --calls_left_;
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  const std::size_t size = _IOC_SIZE(request);
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, size, nullptr);
  if (request == EVIOCSCLOCKID) {
    int wanted = -1;
    gint length = 0;
    guint8* bytes = nullptr;
    umockdev_ioctl_data_retrieve(data, &bytes, &length);
    std::memcpy(&wanted, bytes, sizeof wanted);
    g_free(bytes);
    if (!refuses_clock) clock_ = wanted;
    umockdev_ioctl_client_complete(client, refuses_clock ? -1 : 0, refuses_clock ? EINVAL : 0);
  } else {
    std::vector<unsigned char> bytes = bytesFor(_IOC_NR(request));
    const bool is_known = !bytes.empty();
    const std::size_t written = std::min(size, bytes.size());
    if (is_known) umockdev_ioctl_data_update(data, 0, bytes.data(), static_cast<gint>(written));
    umockdev_ioctl_client_complete(client, is_known ? static_cast<glong>(written) : -1,
                                   is_known ? 0 : EINVAL);
  }
  umockdev_ioctl_data_unref(data);
  return true;
}

gboolean Node::onIoctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  return static_cast<Node*>(self)->answer(client) ? TRUE : FALSE;
}

gboolean Node::onRead(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  auto& node = *static_cast<Node*>(self);
  const std::lock_guard lock(node.mutex_);
  const auto due = node.at_read_.find(node.reads_++);
  if (due != node.at_read_.end()) node.push(g_get_monotonic_time() * 1'000, due->second);
  if (node.is_gone_ || node.queue_.empty()) {
    umockdev_ioctl_client_complete(client, -1, node.is_gone_ ? ENODEV : EAGAIN);
    return TRUE;
  }
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  const std::size_t room = static_cast<std::size_t>(argument->data_len) / sizeof(input_event);
  const auto count = static_cast<std::ptrdiff_t>(std::min(room, node.queue_.size()));
  std::vector<input_event> out(node.queue_.begin(), node.queue_.begin() + count);
  const std::size_t size = out.size() * sizeof(input_event);
  umockdev_ioctl_data_update(argument, 0, reinterpret_cast<guint8*>(out.data()),
                             static_cast<gint>(size));
  umockdev_ioctl_client_complete(client, static_cast<glong>(size), 0);
  node.queue_.erase(node.queue_.begin(), node.queue_.begin() + count);
  return TRUE;
}

}  // namespace palpate::testing
