#include "file.hpp"

#include <fmt/format.h>

#include <fstream>

#include "goshawk/flight_report/draw.hpp"
#include "goshawk/flight_report/files.hpp"

namespace goshawk::flight_report {

Status write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) {
    return fail(ErrorCode::io_failed,
                fmt::format("cannot open '{}' for writing: check that its folder exists and is "
                            "writable",
                            file.string()));
  }
  out.write(bytes.data(), std::streamsize(bytes.size()));
  out.close();  // the last bytes go out here: a full disk shows
  if (out) return success();
  return fail(
      ErrorCode::io_failed,
      fmt::format("cannot write all of '{}': check that the disk is not full", file.string()));
}

Status write_flight_folder(const Flight& flight, const std::filesystem::path& folder) {
  bool timed = !flight.flown.empty();
  for (const Leg& leg : flight.legs) timed = timed || !leg.trajectory.pieces.empty();
  if (auto status = draw_top(flight, folder / "top.png"); !status) return status;
  if (auto status = draw_side(flight, folder / "side.png"); !status) return status;
  if (timed) {
    if (auto status = draw_time(flight, folder / "time.png"); !status) return status;
  }
  if (auto status = write_flown_csv(flight, folder / "flown.csv"); !status) return status;
  if (auto status = write_trajectory_csv(flight, folder / "trajectory.csv"); !status) return status;
  return write_corridor_ply(flight, folder / "corridor.ply");
}

}  // namespace goshawk::flight_report
