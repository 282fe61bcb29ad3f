#include <algorithm>
#include <cmath>
#include <vector>

#include "builder.hpp"

namespace goshawk::worlds {
namespace {

constexpr double kCorridor_m = 1.8;
constexpr double kShortestRoom_m = 1.6;
constexpr double kLongestRoom_m = 4.0;
constexpr double kDoorHeight_m = 2.2;

// The plan is drawn in (u, v): u along the corridor, v across it.
struct Frame {
  bool along_y;
  Index3 world;
  int length() const { return along_y ? world.y : world.x; }
  int width() const { return along_y ? world.x : world.y; }
  Shape box(int u, int v, int size_u, int size_v, int height) const {
    return along_y ? solid_box({v, u, 0}, {size_v, size_u, height})
                   : solid_box({u, v, 0}, {size_u, size_v, height});
  }
};

class Office {
 public:
  Office(const WorldSpec& spec, const GridGeometry& geometry)
      : builder_(spec, geometry),
        random_(spec.seed),
        frame_{geometry.size.y >= geometry.size.x, geometry.size},
        thickness_(std::max(1, int(std::lround(0.1 / spec.resolution_m)))),
        // Growth narrows a door on both sides; three voxels of it must stay.
        door_(builder_.voxels_of(std::max(1.0, 2.0 * spec.inflation_m + 3.0 * spec.resolution_m))),
        door_height_(std::min(geometry.size.z, builder_.voxels_of(kDoorHeight_m))),
        room_(std::max(builder_.voxels_of(kShortestRoom_m), door_ + 2)),
        corridor_(std::max(builder_.voxels_of(kCorridor_m), door_)) {}

  Status build(const WorldSpec& spec) {
    if (auto fits = check_size(); !fits) return fits;
    draw_walls();
    builder_.refresh();
    return furnish(spec.density);
  }

  BitGrid take_occupied() { return builder_.take_occupied(); }

 private:
  Status check_size() const {
    const int narrowest = 2 * (room_ + thickness_) + corridor_;
    if (frame_.width() >= narrowest && frame_.length() >= room_) return success();
    return fail(ErrorCode::invalid_parameter,
                "an office needs at least " + std::to_string(narrowest) + " voxels across and " +
                    std::to_string(room_) + " along its corridor, this world has " +
                    std::to_string(frame_.width()) + " and " + std::to_string(frame_.length()) +
                    ": make it larger, or make another kind");
  }

  void draw_walls() {
    const int spare = frame_.width() - 2 * (room_ + thickness_) - corridor_;
    const int left_depth = room_ + random_.below(spare + 1);
    const int wall_left = left_depth;
    const int wall_right = left_depth + thickness_ + corridor_;
    builder_.put(wall(wall_left));
    builder_.put(wall(wall_right));
    draw_rooms(0, wall_left, wall_left);
    draw_rooms(wall_right + thickness_, frame_.width(), wall_right);
  }

  Shape wall(int v) const { return frame_.box(0, v, frame_.length(), thickness_, frame_.world.z); }

  // Rooms between v0 and v1, each with a door through the corridor's wall at v_wall.
  void draw_rooms(int v0, int v1, int v_wall) {
    const int longest = std::max(room_, builder_.voxels_of(kLongestRoom_m));
    int u = 0;
    while (u < frame_.length()) {
      int size = room_ + random_.below(longest - room_ + 1);
      if (frame_.length() - (u + size) < room_ + thickness_) size = frame_.length() - u;
      cut_door(u, size, v_wall, thickness_, false);
      if (u + size < frame_.length()) {
        builder_.put(frame_.box(u + size, v0, thickness_, v1 - v0, frame_.world.z));
        // Some neighbours have a door between them.
        if (random_.chance(0.5)) cut_door(v0, v1 - v0, u + size, thickness_, true);
      }
      u += size + thickness_;
    }
  }

  // A door somewhere in [from, from + size) of a wall that begins at `across`.
  void cut_door(int from, int size, int across, int depth, bool partition) {
    const int at = from + 1 + random_.below(std::max(1, size - door_ - 1));
    const int step = depth + 4;  // two voxels on either side stay free of furniture
    if (partition) {
      builder_.carve(frame_.box(across, at, depth, door_, door_height_));
      builder_.protect(frame_.box(across - 2, at, step, door_, 1));
    } else {
      builder_.carve(frame_.box(at, across, door_, depth, door_height_));
      builder_.protect(frame_.box(at, across - 2, door_, step, 1));
    }
  }

  Status furnish(double density) {
    if (builder_.share() >= density - kDensityTolerance) return success();
    const auto draw = [&](double scale) {
      const auto side = [&](double lo_m, double hi_m, int limit) {
        return std::min(limit, builder_.voxels_of(scale * random_.uniform(lo_m, hi_m)));
      };
      const int u = side(0.4, 1.6, frame_.length());
      const int v = side(0.4, 1.6, frame_.width());
      const int height = side(0.4, 2.0, frame_.world.z);
      return frame_.box(random_.below(frame_.length() - u + 1),
                        random_.below(frame_.width() - v + 1), u, v, height);
    };
    return fill_to_density(builder_, density, draw);
  }

  Builder builder_;
  Random random_;
  Frame frame_;
  int thickness_;    // [voxels] of a wall
  int door_;         // [voxels]
  int door_height_;  // [voxels]
  int room_;         // [voxels] the shortest side of a room
  int corridor_;     // [voxels]
};

}  // namespace

Result<World> make_office(const WorldSpec& spec, const GridGeometry& geometry) {
  Office office(spec, geometry);
  if (auto built = office.build(spec); !built) return built.error();
  return World{geometry, office.take_occupied()};
}

}  // namespace goshawk::worlds
