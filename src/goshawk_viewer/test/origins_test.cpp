#include "goshawk/viewer_bridge/origins.hpp"

#include <gmock/gmock.h>

namespace goshawk::viewer_bridge {
namespace {

using ::testing::HasSubstr;

TEST(Origins, LetInProgramsAndTheDefaultPages) {
  const auto origins = Origins::parse(kDefaultOrigins);
  ASSERT_TRUE(origins) << origins.error().message;
  for (const char* origin : {"", "http://127.0.0.1:8080", "http://localhost:8080",
                             "https://app.foxglove.dev", "https://studio.foxglove.dev"}) {
    EXPECT_TRUE(origins->allow(origin)) << origin;
  }
}

TEST(Origins, RefuseWhatDiffersInSchemeHostOrPort) {
  const auto origins = *Origins::parse(kDefaultOrigins);
  for (const char* origin :
       {"null", "https://example.org", "http://localhost", "http://localhost:8081",
        "https://localhost:8080", "http://127.0.0.1:80801", "http://localhost.example.org:8080",
        "http://localhost:8080.example.org", "http://app.foxglove.dev", "file://",
        "https://app.foxglove.dev.example.org", "http://[::1]:8080", "any"}) {
    EXPECT_FALSE(origins.allow(origin)) << origin;
  }
}

TEST(Origins, AreThoseThatTheUserNamesAndNoOthers) {
  const auto origins = *Origins::parse("http://10.0.0.7:8080, file://");
  EXPECT_TRUE(origins.allow("http://10.0.0.7:8080"));
  EXPECT_TRUE(origins.allow("file://"));
  EXPECT_FALSE(origins.allow("http://127.0.0.1:8080"));
  EXPECT_FALSE(Origins::parse("")->allow("http://127.0.0.1:8080"));
  EXPECT_TRUE(Origins::parse("")->allow(""));
  EXPECT_TRUE(Origins::parse("any")->allow("https://example.org"));
}

TEST(Origins, AreCheckedWhenTheyAreRead) {
  for (const char* list : {"localhost:8080", "http://localhost:8080/", "http://a b", "://a", "all",
                           "http://127.0.0.1:8080;http://localhost:8080/x"}) {
    const auto origins = Origins::parse(list);
    ASSERT_FALSE(origins) << list;
    EXPECT_EQ(origins.code(), ErrorCode::invalid_parameter);
    EXPECT_THAT(origins.error().message, HasSubstr("is not an origin"));
  }
}

}  // namespace
}  // namespace goshawk::viewer_bridge
