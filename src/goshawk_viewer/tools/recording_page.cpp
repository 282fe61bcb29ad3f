// recording_page RECORDING.mcap TEMPLATE.html OUTPUT.html: a recording as the page of a flight.
// For goshawk view. A failure is one line on stderr, "code: sentence"; so is each part that is
// missing.

#include <cstdio>
#include <filesystem>

#include "goshawk/flight_report/page.hpp"
#include "goshawk/viewer/recorded_flight.hpp"

using namespace goshawk;

namespace {

Status make_page(const std::string& recording, const std::string& page, const std::string& output) {
  auto reader = recording::Reader::open(recording);
  if (!reader) return reader.error();
  const auto recorded = viewer::RecordedFlight::read(*reader);
  if (!recorded) return fail(recorded.error().code, recording + ": " + recorded.error().message);
  for (const auto& sentence : recorded->complaints()) {
    std::fprintf(stderr, "%s: %s\n", recording.c_str(), sentence.c_str());
  }
  const auto title = "Recording " + std::filesystem::path(recording).filename().string();
  return flight_report::write_flight_page(recorded->flight(title), page, output);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: recording_page RECORDING.mcap TEMPLATE.html OUTPUT.html\n");
    return 2;
  }
  const auto status = make_page(argv[1], argv[2], argv[3]);
  if (status) return 0;
  std::fprintf(stderr, "%s: %s\n", std::string(to_string(status.error().code)).c_str(),
               status.error().message.c_str());
  return 1;
}
