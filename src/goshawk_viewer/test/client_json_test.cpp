#include "goshawk/viewer_bridge/client_json.hpp"

#include <gtest/gtest.h>

namespace goshawk::viewer_bridge {
namespace {

Result<nlohmann::ordered_json> of(const std::string& text) {
  return client_json({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

TEST(ClientJson, NamesTimesAsRos2Does) {
  EXPECT_EQ(of(R"({"header":{"stamp":{"sec":7,"nsec":5},"frame_id":"map"}})")->dump(),
            R"({"header":{"stamp":{"sec":7,"nanosec":5},"frame_id":"map"}})");
  EXPECT_EQ(of(R"({"stamp":{"nsec":5,"sec":7}})")->dump(), R"({"stamp":{"sec":7,"nanosec":5}})");
  EXPECT_EQ(of(R"({"poses":[{"stamp":{"sec":1,"nsec":2}},{"stamp":{"sec":3,"nsec":4}}]})")->dump(),
            R"({"poses":[{"stamp":{"sec":1,"nanosec":2}},{"stamp":{"sec":3,"nanosec":4}}]})");
}

TEST(ClientJson, LeavesAllElseAsItIs) {
  for (const char* text : {R"({"stamp":{"sec":7,"nanosec":5}})", R"({"sec":7,"nsec":5,"x":1})",
                           R"({"nsec":5})", "[]", "null", "3", R"("nsec")", "{}"}) {
    EXPECT_EQ(of(text)->dump(), nlohmann::ordered_json::parse(text).dump()) << text;
  }
}

TEST(ClientJson, RefusesWhatIsNoneOrHasNoEnd) {
  for (const std::string text : {"", "{", "garbage", "\xff\xfe", R"({"a":1}})"}) {
    EXPECT_EQ(of(text).code(), ErrorCode::invalid_input) << text;
  }
  const std::string nested = std::string(100000, '[') + std::string(100000, ']');
  ASSERT_EQ(of(nested).code(), ErrorCode::invalid_input);
  EXPECT_NE(of(nested).error().message.find("nested deeper"), std::string::npos);
}

}  // namespace
}  // namespace goshawk::viewer_bridge
