#include "process.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {

void add_view(Program& program) {
  struct ViewOptions {
    std::string what;
    bool live = false, foxglove = false, no_open = false, check = false;
    int port = 8080;
    std::string bridge = "ws://127.0.0.1:8765";
  };
  const Verb verb = program.verb(
      "view", "look at a flight, a recording, or what flies now (--live), in a browser");
  auto o = std::make_shared<ViewOptions>();
  auto* what = verb->add_option(
      "what", o->what, "flight folder or MCAP recording (default: the newest folder in ./flights)");
  verb->add_flag("--live", o->live, "look at what flies now; starts a bridge if none listens")
      ->excludes(what);
  verb->add_flag("--foxglove", o->foxglove,
                 "in Foxglove Studio, which tools/setup --viewer fetches");
  verb->add_option("--port", o->port, "of the page; 0: any free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  verb->add_option("--bridge", o->bridge, "where the bridge listens")->capture_default_str();
  verb->add_flag("--no-open", o->no_open, "do not start a browser");
  verb->add_flag("--check", o->check, "only say what would be shown");
  verb->footer(
      "Serves the page on this machine until Ctrl-C.\n\n"
      "Examples:\n"
      "  goshawk view\n"
      "  goshawk view flight.mcap --port 0\n"
      "  goshawk view --live --foxglove");
  verb.runs([o](const Console& console) {
    return become_helper("view.py",
                         {{"what", o->what.empty() ? Json(nullptr) : Json(o->what)},
                          {"live", o->live},
                          {"foxglove", o->foxglove},
                          {"port", o->port},
                          {"bridge", o->bridge},
                          {"no_open", o->no_open},
                          {"check", o->check}},
                         console);
  });
}

}  // namespace goshawk::cli
