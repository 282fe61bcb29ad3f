#include "goshawk/path_search/tiled_labels.hpp"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

// Against a std::map that is emptied for each query.
TEST(TiledLabels, HoldWhatThisQueryWroteAndNothingElse) {
  Random random(41);
  for (int n = 0; n < 50; ++n) {
    const Index3 size{1 + random.below(40), 1 + random.below(40), 1 + random.below(12)};
    const auto any = [&] {
      return Index3{random.below(size.x), random.below(size.y), random.below(size.z)};
    };
    TiledLabels labels;
    ASSERT_TRUE(labels.resize(size, 0));
    for (int query = 0; query < 5; ++query) {
      ASSERT_TRUE(labels.start_query());
      std::map<std::tuple<int, int, int>, Label> truth;
      for (int k = 0; k < 300; ++k) {
        const Index3 at = any();
        const Label label =
            TiledLabels::extend(labels.root(), random.below(1'000'000), random.below(27));
        if (TiledLabels::improves(label, labels.at(0, at))) {
          labels.at(0, at) = label;
          const auto held = truth.find({at.x, at.y, at.z});
          ASSERT_TRUE(held == truth.end() || labels.cost(label) < labels.cost(held->second));
          truth[{at.x, at.y, at.z}] = label;
        }
        const Index3 other = any();
        const auto expected = truth.find({other.x, other.y, other.z});
        const Label held = labels.held(0, other);
        ASSERT_EQ(labels.is_current(held), expected != truth.end());
        if (expected != truth.end()) {
          ASSERT_EQ(held, expected->second);
        }
      }
    }
  }
}

}  // namespace
}  // namespace goshawk::path_search
