// The verb that shows a scene in a browser while it is felt.

#include "command_line/verb.h"

namespace palpate::tools {
namespace {

void defineView(CLI::App& app, Invocation& invocation) {
  auto& o = choose<ViewOptions>(invocation);
  app.add_option("scene", o.touch.scene);
  const char* g = "Who moves the probe";
  addDevice(app, g, o.touch.device,
            "the simulated device that the page's hand holds (default touch): " + deviceModels() +
                "; virtual:NAME means the same. Or let a hand move a device, and the page watch: "
                "falcon, inverse3, hd, dhd, evdev");
  add(app, g, "--replay", "FILE", o.replay,
      "nobody: go through a record (.npy) or a trace (.csv) of `touch`, tick by tick")
      ->check(named);
  add(app, g, "--seconds", "S", o.touch.seconds, "for how long (default: until Ctrl-C)")
      ->check(CLI::Range(0.1, 86400.0));
  addChoice(app, g, "--renderer", {"constraint", "paper"}, o.touch.renderer,
            "constraint or paper (default: as the scene says)", "NAME");
  addRealDevice(app, o.touch.real);
  g = "The page";
  add(app, g, "--port", "N", o.port, "at this port of 127.0.0.1 (default: any that is free)")
      ->check(CLI::Range(1, 65535));
  addFlag(app, g, "--no-open", o.no_open, "do not open a browser");
  add(app, "Output files", "--record", "FILE.npy", o.touch.record,
      "write all that goes into each tick and comes out, for replay and NumPy; beside it "
      "FILE.npy.json and FILE.npy.states")
      ->check(named);
}

}  // namespace

Verb viewVerb() {
  return {
      "view",
      "Show a scene in the browser while a hand feels it",
      "palpate view data/scenes/container.yaml",
      "palpate view SCENE [OPTIONS]",
      R"(Serves a page at 127.0.0.1 and prints its address, which nobody can guess; it works offline. The
page's hand goes where the mouse (drag; the wheel for depth), the arrow keys or a gamepad say, and
holds a simulated device, so that the force draws it back: a mouse cannot feel. One page steers,
others watch. The loop runs at 1 kHz whatever the page does. A scene that is edited meanwhile is felt
and shown as soon as it is saved, and the page marks the line of a fault, while the scene
before goes on; not with --record or --replay. Ends with Ctrl-C, as touch does.)",
      {},
      defineView,
      [](const Invocation& i) {
        const auto& o = chosen<ViewOptions>(i);
        need(!o.touch.scene.empty(), "SCENE");
        if (o.replay.empty()) return;
        if (!o.touch.device.name.empty() || !o.touch.record.empty()) {
          throw usageError("--replay excludes --device and --record",
                           "what was recorded has a hand already");
        }
      },
      true};
}

}  // namespace palpate::tools
