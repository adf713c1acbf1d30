// Stands in for OpenHaptics' libHD.so: it returns values that a test sets, and records the calls.
// It has no thread: fakeTurn() runs its scheduler once.

#include <algorithm>
#include <array>
#include <cstring>

struct HdError {
  unsigned code;
  int internal;
  unsigned device;
};

struct Fake {
  std::array<double, 3> position_mm;
  std::array<double, 3> velocity_mm;
  std::array<double, 3> force;
  int buttons;
  unsigned error;
  int is_absent;
  int is_running;
  int is_open;
  int force_is_enabled;
  int frames;       // number of open frames
  int torn_frames;  // calls outside of a frame
};

namespace {

Fake fake{};
unsigned (*the_callback)(void*) = nullptr;
void* the_data = nullptr;

}  // namespace

extern "C" {
Fake* fakeState() { return &fake; }
void fakeTurn() {
  if (fake.is_running != 0 && the_callback != nullptr && the_callback(the_data) == 0) {
    the_callback = nullptr;
  }
}

unsigned hdInitDevice(const char*) {
  if (fake.is_absent != 0) return 0xFFFFFFFF;
  fake.is_open = 1;
  return 7;
}
void hdDisableDevice(unsigned) { fake.is_open = 0; }
void hdEnable(unsigned what) {
  if (what == 0x4000) fake.force_is_enabled = 1;
}
void hdStartScheduler() { fake.is_running = 1; }
void hdStopScheduler() { fake.is_running = 0; }
unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, unsigned short) {
  the_callback = callback;
  the_data = data;
  return 1;
}
void hdUnschedule(unsigned long) { the_callback = nullptr; }
void hdBeginFrame(unsigned) { ++fake.frames; }
void hdEndFrame(unsigned) { --fake.frames; }
void hdGetDoublev(unsigned what, double* out) {
  if (what == 0x2603) *out = 3.3;
  if (what == 0x2604) *out = 0.88;
  if (what >= 0x2600 && what < 0x2700) return;
  if (fake.frames != 1) ++fake.torn_frames;
  if (what == 0x2050) std::copy(fake.position_mm.begin(), fake.position_mm.end(), out);
  if (what == 0x2051) std::copy(fake.velocity_mm.begin(), fake.velocity_mm.end(), out);
  if (what == 0x2052) {
    // A quarter turn about z: the handle's x axis is the frame's y axis.
    constexpr std::array<double, 16> kTurn = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::copy(kTurn.begin(), kTurn.end(), out);
  }
}
void hdGetIntegerv(unsigned what, int* out) {
  if (what == 0x2000) *out = fake.buttons;
}
void hdSetDoublev(unsigned what, const double* in) {
  if (fake.frames != 1) ++fake.torn_frames;
  if (what == 0x2700) std::copy(in, in + 3, fake.force.begin());
}
HdError hdGetError() { return {fake.error, 0, 7}; }
}
