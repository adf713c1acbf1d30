// The verbs for devices and for the machine that runs them.

#include "command_line/verb.h"
#include "real_device.h"

namespace palpate::tools {

void addRealDevice(CLI::App& app, RealDeviceOptions& o) {
  const char* g = "A device that a hand holds";
  add(app, g, "--serial", "TEXT", o.serial, "falcon: which one (default: the first)");
  add(app, g, "--descriptor", "N", o.descriptor,
      "falcon: the file descriptor of its node, which the caller has opened")
      ->check(CLI::Range(0, 1 << 20));
  add(app, g, "--firmware", "FILE", o.firmware,
      "falcon: image for a device that runs none; checked before a byte is sent");
  add(app, g, "--calibration", "FILE", o.calibration,
      "falcon: constants, as `palpate devices --calibrate` writes them");
  add(app, g, "--library", "FILE", o.library,
      "hd, dhd: the maker's library (default: libHD.so or libdhd.so, as the system finds it)");
  add(app, g, "--service", "HOST:PORT", o.service,
      "inverse3: its service (default 127.0.0.1:10001)");
}

namespace {

void defineDevices(CLI::App& app, Invocation& invocation) {
  auto& o = choose<DevicesOptions>(invocation);
  const char* g = "What to do (default: list)";
  add(app, g, "--test", "NAME", o.test,
      "open falcon, inverse3, dhd, hd, evdev or evdev:/dev/input/eventN, write zero force for a "
      "while, and tell what it says");
  add(app, g, "--calibrate", "FILE", o.calibrate,
      "falcon: the origin where the grip is held; the constants go to FILE");
  addFlag(app, g, "--states", o.states, "print the table of states that every device goes through");
  add(app, g, "--seconds", "S", o.seconds, "--test, --calibrate: for how long (default 10)")
      ->check(CLI::Range(1.0, 3600.0));
  addRealDevice(app, o.device);
}

void defineDoctor(CLI::App& /*app*/, Invocation& invocation) {
  (void)choose<DoctorOptions>(invocation);
}

}  // namespace

Verb devicesVerb() {
  return {
      "devices",
      "List haptic and input devices, say what bars access to one, test it, calibrate it",
      "palpate devices --states",
      "palpate devices [OPTIONS]",
      R"(Where access to a USB device is denied, the udev rule that permits it is printed. Drivers
that were never run on hardware say so. Exit code of --test: 0 if the device was read without
a fault, 1 if not.)",
      {},
      defineDevices,
      [](const Invocation& i) {
        const auto& o = chosen<DevicesOptions>(i);
        const int asked =
            (o.test.empty() ? 0 : 1) + (o.calibrate.empty() ? 0 : 1) + (o.states ? 1 : 0);
        if (asked > 1) throw usageError("--test, --calibrate and --states exclude one another", "");
        const std::string given = givenOption(o.device);
        if (o.test.empty() && o.calibrate.empty() && !given.empty()) {
          throw usageError(given + " is of a device that is opened", "add --test or --calibrate");
        }
      },
      true};
}

Verb doctorVerb() {
  return {
      "doctor",
      "Say whether this machine is fit for a haptic device, and what to do",
      "palpate doctor",
      "palpate doctor",
      R"(Kernel, real-time priority, locked memory, governor, devices and access to them. Exit code 0 if
nothing is in the way of a real-time loop, 1 if something is.)",
      {},
      defineDoctor,
      [](const Invocation&) {}};
}

}  // namespace palpate::tools
