#include "doctor.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

namespace goshawk::introspection {
namespace {

using runtime::EndpointInfo;
using runtime::ParticipantInfo;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<ParticipantInfo> kTwo{{"1", "", {"/path_search"}},
                                        {"2", "", {"/corridor_builder"}}};

EndpointInfo writer(bool reliable, bool latched) {
  return {"/path", "goshawk_msgs/msg/Path", "1", true, reliable, latched};
}

EndpointInfo reader(bool reliable, bool latched) {
  return {"/path", "goshawk_msgs/msg/Path", "2", false, reliable, latched};
}

TEST(Doctor, is_content_where_readers_ask_for_no_more_than_writers_offer) {
  for (const bool r : {false, true}) {
    for (const bool l : {false, true}) {
      EXPECT_THAT(check_topics(kTwo, {writer(true, true), reader(r, l)}), IsEmpty());
      EXPECT_THAT(check_topics(kTwo, {writer(r, l), reader(false, false)}), IsEmpty());
    }
  }
}

TEST(Doctor, names_both_ends_where_a_reader_asks_for_more) {
  const auto findings = check_topics(kTwo, {writer(false, false), reader(true, true)});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].level, Level::fault);
  EXPECT_EQ(findings[0].about, "topic /path");
  EXPECT_THAT(findings[0].message, HasSubstr("/corridor_builder does not hear /path_search"));
  EXPECT_THAT(findings[0].message, HasSubstr("reliable, but best effort"));
  EXPECT_THAT(findings[0].message, HasSubstr("latched, but volatile"));
}

TEST(Doctor, finds_a_topic_of_two_types) {
  EndpointInfo other = reader(true, false);
  other.type = "nav_msgs/msg/Path";
  const auto findings = check_topics(kTwo, {writer(true, true), other});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].level, Level::fault);
  EXPECT_THAT(findings[0].message, HasSubstr("goshawk_msgs/msg/Path, nav_msgs/msg/Path"));
}

TEST(Doctor, notes_a_topic_that_is_only_read_and_warns_of_equal_names) {
  const auto lonely = check_topics(kTwo, {reader(true, true)});
  ASSERT_EQ(lonely.size(), 1u);
  EXPECT_EQ(lonely[0].level, Level::note);
  EXPECT_THAT(lonely[0].message, HasSubstr("/corridor_builder"));

  const auto twins = check_topics({{"1", "", {"/tracker"}}, {"2", "", {"/tracker"}}}, {});
  ASSERT_EQ(twins.size(), 1u);
  EXPECT_EQ(twins[0].level, Level::warning);
}

TEST(Doctor, tells_domains_from_udp_ports) {
  // 7400 + 250 * 0 + 10 = 0x1CF2; 7400 + 250 * 77 + 12 = 0x6836; 53 and a user port are no domain's
  const std::string table =
      "  sl  local_address rem_address\n"
      "  1: 0100007F:1CF2 00000000:0000 07\n"
      "  2: 0100007F:6836 00000000:0000 07\n"
      "  3: 0100007F:0035 00000000:0000 07\n"
      "  4: 0100007F:1CF3 00000000:0000 07\n"
      "garbage\n";
  EXPECT_THAT(domains_in_use(table), ElementsAre(0, 77));
  EXPECT_THAT(domains_in_use(""), IsEmpty());
}

TEST(Doctor, says_what_is_wrong_with_a_profile_file) {
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", "/no/such.xml", 1);
  const auto missing = check_environment().front();
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", "/proc/self/status", 1);
  const auto foreign = check_environment().front();
  unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");
  EXPECT_EQ(missing.level, Level::fault);
  EXPECT_THAT(missing.message, HasSubstr("/no/such.xml"));
  EXPECT_EQ(foreign.level, Level::fault);
  EXPECT_THAT(foreign.message, HasSubstr("not XML"));
  EXPECT_EQ(check_environment().front().level, Level::fine);
}

TEST(Doctor, looks_at_the_machine_and_always_says_something) {
  for (const auto& finding : check_machine()) {
    EXPECT_FALSE(finding.about.empty());
    EXPECT_FALSE(finding.message.empty());
  }
}

}  // namespace
}  // namespace goshawk::introspection
