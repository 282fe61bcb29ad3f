#include "goshawk/path_search/neighbour_labels.hpp"

namespace goshawk::path_search {

BlockMask improved_neighbours(const LabelTable& labels, const ObstacleBits& bits,
                              ObstacleBits::Node node) {
  const Label* held = labels.around(node);
  const Label straight = LabelTable::extend(*held, kMoveCost[1], 0);
  const Label diagonal = LabelTable::extend(*held, kMoveCost[2], 0);
  const Label triagonal = LabelTable::extend(*held, kMoveCost[3], 0);
  // extend() without a direction leaves the lowest six bits zero, so that a comparison of whole
  // labels is one of costs.
  const auto row = [&](int r, Label outer, Label middle) {
    const Label* l = held + bits.offset(3 * r + 1);
    return (BlockMask(outer > l[-1]) | BlockMask(middle > l[0]) << 1 | BlockMask(outer > l[1]) << 2)
           << 3 * r;
  };
  return row(0, triagonal, diagonal) | row(1, diagonal, straight) | row(2, triagonal, diagonal) |
         row(3, diagonal, straight) | row(4, straight, 0) | row(5, diagonal, straight) |
         row(6, triagonal, diagonal) | row(7, diagonal, straight) | row(8, triagonal, diagonal);
}

}  // namespace goshawk::path_search
