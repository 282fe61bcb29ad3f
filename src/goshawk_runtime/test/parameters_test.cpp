#include "goshawk/runtime/parameters.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "goshawk/runtime/ros_args.hpp"
#include "test_config.hpp"

namespace goshawk::runtime {
namespace {

using runtime_test::Config;
using runtime_test::Planner;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A YAML file for the length of a test.
class File {
 public:
  explicit File(const std::string& text) {
    static int number = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("goshawk_parameters_" + std::to_string(getpid()) + "_" + std::to_string(number++));
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

Result<Config> read(const std::string& yaml, const std::string& node = "search",
                    const std::string& ns = "/") {
  const File file(yaml);
  ParameterSource source;
  if (auto status = source.add_file(file.path(), node, ns); !status) return status.error();
  return read_parameters<Config>(source, node);
}

Result<Config> read_lines(const std::string& lines) {
  return read("search:\n  ros__parameters:\n" + lines);
}

std::string fault(const std::string& lines) {
  const auto config = read_lines("    " + lines + "\n");
  return config ? "no fault" : config.error().message;
}

TEST(Parameters, DefaultsStandWhereNothingIsSet) {
  const auto config = read("");
  ASSERT_TRUE(config);
  EXPECT_EQ(config->radius_m, 0.3);
  EXPECT_EQ(config->planner, Planner::jastar);
}

TEST(Parameters, ReadsEveryType) {
  const auto config = read_lines(
      "    radius_m: 1\n    speed_m_s: +2.5e0\n    count: 7\n    enabled: false\n"
      "    planner: astar\n    label: '12'\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->radius_m, 1.0);
  EXPECT_EQ(config->speed_m_s, 2.5);
  EXPECT_EQ(config->count, 7);
  EXPECT_FALSE(config->enabled);
  EXPECT_EQ(config->planner, Planner::astar);
  EXPECT_EQ(config->label, "12");
}

TEST(Parameters, NamesEachKindOfFault) {
  EXPECT_THAT(fault("radius: 1"),
              HasSubstr("radius: no such parameter of search; did you mean radius_m?"));
  EXPECT_THAT(fault("radius_m: wide"), HasSubstr("radius_m: 'wide' is not a number"));
  EXPECT_THAT(fault("radius_m: '1.0'"), HasSubstr("is not a number"));
  EXPECT_THAT(fault("radius_m: 11"), HasSubstr("at least 0 and at most 10"));
  EXPECT_THAT(fault("radius_m: nan"), HasSubstr("out of range"));
  EXPECT_THAT(fault("speed_m_s: 0"), HasSubstr("above 0"));
  EXPECT_THAT(fault("speed_m_s: inf"), HasSubstr("out of range"));
  EXPECT_THAT(fault("speed_m_s: +-1"), HasSubstr("is not a number"));
  EXPECT_THAT(fault("speed_m_s: 1e999"), HasSubstr("is not a number"));
  EXPECT_THAT(fault("count: 1.5"), HasSubstr("is not a whole number"));
  EXPECT_THAT(fault("count: 99999999999"), HasSubstr("is not a whole number"));
  EXPECT_THAT(fault("count: 101"), HasSubstr("at most 100"));
  EXPECT_THAT(fault("enabled: yes"), HasSubstr("is not true or false"));
  EXPECT_THAT(fault("enabled: 'true'"), HasSubstr("is not true or false"));
  EXPECT_THAT(fault("planner: astr"), HasSubstr("one of jastar, astar; did you mean astar?"));
  EXPECT_THAT(fault("label: [1, 2]"), HasSubstr("is not a single value"));
  EXPECT_THAT(fault("label:"), HasSubstr("is not a single value"));
  EXPECT_THAT(fault("count: 1\n    count: 2"), HasSubstr("is specified twice"));
}

TEST(Parameters, ListsAllFaultsAtOnce) {
  const auto config = read_lines(
      "    radius_m: 11\n    count: many\n    enabled: {}\n    planer: astar\n    label: ok\n");
  ASSERT_FALSE(config);
  EXPECT_EQ(config.code(), ErrorCode::invalid_parameter);
  EXPECT_THAT(
      config.error().message,
      AllOf(HasSubstr("4 parameter faults"), HasSubstr("radius_m"), HasSubstr("count"),
            HasSubstr("enabled"), HasSubstr("did you mean planner?"), Not(HasSubstr("label"))));
}

TEST(Parameters, TakesTheSectionsMeantForTheNode) {
  const std::string yaml =
      "/**:\n  ros__parameters: {count: 1, radius_m: 1.0, label: all}\n"
      "search:\n  ros__parameters: {count: 2, radius_m: 2.0}\n"
      "/uav1/search:\n  ros__parameters: {count: 3}\n"
      "tracker:\n  ros__parameters: {unknown_here: 1}\n";
  const auto in_uav1 = read(yaml, "search", "/uav1");
  ASSERT_TRUE(in_uav1) << in_uav1.error().message;
  EXPECT_EQ(in_uav1->count, 3);
  EXPECT_EQ(in_uav1->radius_m, 2.0);
  EXPECT_EQ(in_uav1->label, "all");
  EXPECT_EQ(read(yaml, "search", "/")->count, 2);
  EXPECT_EQ(read(yaml, "other", "/")->count, 1);
}

TEST(Parameters, ASectionForANodeThatNobodyKnowsIsNamed) {
  const std::vector<std::string> known{"search", "tracker"};
  const File good("/**:\n  ros__parameters: {}\n/uav1/search:\n  ros__parameters: {}\n");
  EXPECT_TRUE(check_sections(good.path(), known));
  const File bad("serch:\n  ros__parameters: {}\ntracker:\n  ros__parameters: {}\n");
  const auto status = check_sections(bad.path(), known);
  EXPECT_EQ(status.code(), ErrorCode::invalid_parameter);
  EXPECT_THAT(status.error().message, AllOf(HasSubstr("serch: no such node; did you mean search?"),
                                            Not(HasSubstr("tracker"))));
  EXPECT_EQ(check_sections("/no/such/file.yaml", known).code(), ErrorCode::io_failed);
}

TEST(Parameters, RefusesFilesOfAnotherForm) {
  EXPECT_THAT(read("search: {count: 1}").error().message, HasSubstr("ros__parameters"));
  EXPECT_THAT(read("- 1").error().message, HasSubstr("is not a map"));
  EXPECT_THAT(read("a: [").error().message, HasSubstr("is not valid YAML"));
  ParameterSource source;
  EXPECT_EQ(source.add_file("/no/such/file.yaml", "a", "/").code(), ErrorCode::io_failed);
  EXPECT_EQ(source.add_file("/tmp", "a", "/").code(), ErrorCode::io_failed);
}

RosArgs ros_args(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "--ros-args");
  auto args = RosArgs::extract(arguments);
  if (!args) throw std::runtime_error(args.error().message);
  return *args;
}

TEST(Parameters, OptionsBeatFilesAndLaterOnesEarlierOnes) {
  const File first("search:\n  ros__parameters: {count: 1, radius_m: 1.0, label: a}\n");
  const File second("search:\n  ros__parameters: {count: 2, radius_m: 2.0}\n");
  const auto source = ros_args({"-p", "count:=3", "--params-file", first.path(), "--params-file",
                                second.path(), "-p", "count:=4"})
                          .parameters_of("search");
  ASSERT_TRUE(source);
  const auto config = read_parameters<Config>(*source, "search");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->count, 4);
  EXPECT_EQ(config->radius_m, 2.0);
  EXPECT_EQ(config->label, "a");
}

TEST(Parameters, OptionsMayNameTheirNodeAndQuoteStrings) {
  const auto args =
      ros_args({"-p", "tracker:count:=9", "-p", "search:count:=8", "-p", "label:='7'"});
  const auto config = read_parameters<Config>(*args.parameters_of("search"), "search");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->count, 8);
  EXPECT_EQ(config->label, "7");
  const auto quoted = ros_args({"-p", "count:=\"7\""}).parameters_of("search");
  EXPECT_THAT(read_parameters<Config>(*quoted, "search").error().message,
              HasSubstr("is not a whole number (-p)"));
}

TEST(Parameters, DescribeThemselves) {
  const auto list = describe_parameters<Config>();
  ASSERT_EQ(list.size(), 6u);
  EXPECT_EQ(list[0].name, "radius_m");
  EXPECT_EQ(list[0].type, "double");
  EXPECT_EQ(list[0].unit, "m");
  EXPECT_EQ(list[0].default_value, "0.3");
  EXPECT_EQ(list[0].range, "at least 0 and at most 10");
  EXPECT_EQ(list[1].range, "above 0");
  EXPECT_EQ(list[3].type, "bool");
  EXPECT_EQ(list[4].range, "one of jastar, astar");
  EXPECT_EQ(list[5].range, "");
  EXPECT_FALSE(list[0].at_run_time);
  EXPECT_TRUE(list[1].at_run_time);
  Config other;
  other.count = 9;
  EXPECT_EQ(describe_parameters(other)[2].value, "9");
  EXPECT_EQ(describe_parameters(other)[2].default_value, "5");
}

TEST(NearestName, IsEmptyWhereNothingIsNear) {
  EXPECT_EQ(nearest_name("raduis_m", {"radius_m", "count"}), "radius_m");
  EXPECT_EQ(nearest_name("zzzzzz", {"radius_m", "count"}), "");
  EXPECT_EQ(nearest_name("", {}), "");
  EXPECT_EQ(nearest_name("v_max", {"v_min_m_s", "v_max_m_s", "max"}), "v_max_m_s");
}

}  // namespace
}  // namespace goshawk::runtime
