#include "goshawk/introspection/doctor.hpp"

#include <gmock/gmock.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "goshawk/runtime/version.hpp"

namespace goshawk::introspection {
namespace {

using runtime::EndpointInfo;
using runtime::ParticipantInfo;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

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
  EXPECT_THAT(findings[0].message, HasSubstr("/corridor_builder gets nothing from /path_search"));
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
      "  1: 0100007F:1CF2 00000000:0000 07 0 0 0 0 0 1\n"
      "  2: 0100007F:6836 00000000:0000 07 0 0 0 0 0 2\n"
      "  3: 0100007F:0035 00000000:0000 07 0 0 0 0 0 3\n"
      "  4: 0100007F:1CF3 00000000:0000 07 0 0 0 0 0 1\n"
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

TEST(Doctor, tells_what_a_profile_file_leaves_to_the_defaults) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("goshawk_profile_" + std::to_string(getpid()) + ".xml");
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", path.c_str(), 1);
  const auto with = [&](const std::string& text) {
    std::ofstream(path) << text;
    return check_environment().front().level;
  };
  EXPECT_EQ(with(""), Level::fault);
  EXPECT_EQ(with("\n<?xml version=\"1.0\"?><profiles/>"), Level::warning);
  EXPECT_EQ(with("<profiles><participant is_default_profile=\"true\"/></profiles>"), Level::note);
  unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");
  std::filesystem::remove(path);
}

TEST(Doctor, reads_ports_and_who_holds_them) {
  const std::string table =
      "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
      "inode\n"
      "  1: 0100007F:1CF2 00000000:0000 07 00000000:00000000 00:00000000 00000000 0 0 4711 2 0 0\n"
      "  2: 00000000:1F90 00000000:0000 0A 00000000:00000000 00:00000000 00000000 0 0 4712 1 0\n"
      "  3: 0100007F:1F91 0100007F:1F90 01 00000000:00000000 00:00000000 00000000 0 0 4713 1 0\n"
      "garbage\n  4: 0100007F:xyz 0 07\n";
  EXPECT_THAT(ports_in_use(table), ElementsAre(Pair(7410, 4711), Pair(8080, 4712)));
  EXPECT_THAT(ports_in_use(""), IsEmpty());
}

TEST(Doctor, tells_participants_from_who_took_a_port_of_theirs) {
  const int base = 7400 + 250 * 3;
  const std::map<int, long> ports{{base + 10, 1}, {base + 11, 1}, {base + 15, 2}, {9, 3}};
  EXPECT_THAT(stolen_ports(ports, 3), ElementsAre(base + 15));
  EXPECT_THAT(stolen_ports(ports, 4), IsEmpty());
}

TEST(Doctor, notes_a_domain_whose_ports_any_program_may_get) {
  EXPECT_EQ(check_port_range(100, 32768, 60999).level, Level::fine);
  const auto high = check_port_range(102, 32768, 60999);
  EXPECT_EQ(high.level, Level::note);
  EXPECT_THAT(high.mend, HasSubstr("0 to 100"));
  EXPECT_EQ(check_port_range(230, 32768, 60999).level, Level::fine);
}

TEST(Doctor, finds_processes_of_other_versions_of_goshawk) {
  const std::string own = runtime::version();
  EXPECT_THAT(check_topics({{"1", "", {"/a"}, own}, {"2", "ros2", {}, ""}}, {}), IsEmpty());
  const auto mixed = check_topics({{"1", "", {"/a"}, own}, {"2", "", {"/b"}, "0.0.9"}}, {});
  ASSERT_EQ(mixed.size(), 1u);
  EXPECT_EQ(mixed[0].level, Level::warning);
  EXPECT_THAT(mixed[0].message, HasSubstr("0.0.9: /b"));
}

TEST(Doctor, compares_libraries_as_compiled_and_as_loaded) {
  EXPECT_EQ(compare_versions("x", "2.9.1", "/usr/lib/libx.so.2.9.3").level, Level::fine);
  const auto other = compare_versions("x", "2.9.1", "/opt/ros/libx.so.2.14.0");
  EXPECT_EQ(other.level, Level::warning);
  EXPECT_THAT(other.message, HasSubstr("2.9.1 as compiled, but 2.14.0 as loaded, of /opt/ros"));
  EXPECT_EQ(compare_versions("x", "", "/usr/lib/libx.so.2.9.3").level, Level::fine);
  EXPECT_EQ(compare_versions("x", "3.4.0", "").level, Level::fine);
  const auto own = check_versions();
  EXPECT_EQ(own[0].message, runtime::version());
  EXPECT_EQ(own[1].about, "Fast DDS");
  EXPECT_THAT(own[1].message, HasSubstr("as loaded"));
}

TEST(Doctor, tells_clocks_that_jump_or_differ) {
  EXPECT_EQ(check_clock_jump(0.001).level, Level::fine);
  EXPECT_EQ(check_clock_jump(-0.5).level, Level::warning);
  EXPECT_EQ(check_stamps("/odom", {0.3, 0.001}).level, Level::fine);
  EXPECT_THAT(check_stamps("/odom", {0.3, -0.5}).message, HasSubstr("500.0 ms in the future"));
  EXPECT_EQ(check_stamps("/odom", {100.0, 90.0}).level, Level::warning);
}

TEST(Doctor, says_of_all_that_is_not_fine_why_it_matters_and_what_mends_it) {
  std::vector<Finding> all = check_machine();
  const auto add = [&](std::vector<Finding> more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(check_versions());
  add(check_environment());
  add(check_ports(102, false));
  add(ClockWatch().findings());
  add(check_topics(kTwo, {writer(false, false), reader(true, true)}));
  add({check_refused("/tracker", 3, "3 datagrams were refused"), check_clock_jump(1.0),
       check_stamps("/odom", {-1.0}), check_stamps("/odom", {9.0})});
  for (const auto& f : all) {
    EXPECT_FALSE(f.message.empty()) << f.about;
    if (f.level == Level::fine) continue;
    EXPECT_FALSE(f.why.empty()) << f.about;
    EXPECT_FALSE(f.mend.empty()) << f.about;
  }
}

TEST(Doctor, looks_at_the_machine_and_always_says_something) {
  for (const auto& finding : check_machine()) {
    EXPECT_FALSE(finding.about.empty());
    EXPECT_FALSE(finding.message.empty());
  }
}

}  // namespace
}  // namespace goshawk::introspection
