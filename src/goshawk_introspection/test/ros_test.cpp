// What the tools make of ROS 2's endpoints and settings.

#include <gmock/gmock.h>

#include "goshawk/introspection/doctor.hpp"
#include "goshawk/introspection/services.hpp"

namespace goshawk::introspection {
namespace {

using runtime::EndpointInfo;
using runtime::ParticipantInfo;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

EndpointInfo end_of(const std::string& topic, const std::string& type, bool writer) {
  return {topic, type, "1", writer, true, false};
}

const char* const kRequest = "std_srvs/srv/Trigger_Request";
const char* const kResponse = "std_srvs/srv/Trigger_Response";

// A server reads requests and writes replies; a client the other way round.
const std::vector<EndpointInfo> kService = {end_of("rq/uav1/startRequest", kRequest, false),
                                            end_of("rr/uav1/startReply", kResponse, true),
                                            end_of("rq/uav1/startRequest", kRequest, true),
                                            end_of("rr/uav1/startReply", kResponse, false),
                                            end_of("rq/uav1/startRequest", kRequest, true),
                                            end_of("rr/uav1/startReply", kResponse, false)};

TEST(Services, AreFourEndpointsOfDdsForAServerAndAClient) {
  const auto services = services_of(kService);
  ASSERT_EQ(services.size(), 1u);
  const auto& [name, service] = *services.begin();
  EXPECT_EQ(name, "/uav1/start");
  EXPECT_THAT(service.types, ElementsAre("std_srvs/srv/Trigger"));
  EXPECT_EQ(service.servers, 1);
  EXPECT_EQ(service.clients, 2);
}

TEST(Services, AreNotTakenForTopics) {
  for (const char* topic : {"/path", "/rq/pathRequest", "rq/path", "rr/pathRequest", "rqRequest",
                            "rq/Request", "ros_discovery_info", ""}) {
    EXPECT_FALSE(service_end(end_of(topic, "a/msg/B", true))) << topic;
  }
}

TEST(Services, DoNotAlarmTheDoctor) {
  ParticipantInfo ros{"1", "", {"/probe"}};
  ros.is_ros = true;
  EXPECT_THAT(check_topics({ros}, kService), IsEmpty());
  // A topic that ROS 2 alone reads is its own affair; one that Goshawk reads is not.
  const auto lonely = end_of("/cmd_vel", "geometry_msgs/msg/Twist", false);
  EXPECT_THAT(check_topics({ros}, {lonely}), IsEmpty());
  EXPECT_EQ(check_topics({{"1", "", {"/tracker"}}}, {lonely}).size(), 1u);
}

TEST(DoctorOfRos, IsContentIfBothSidesMeet) {
  EXPECT_EQ(check_ros({}, "loopback", 2).level, Level::fine);
  EXPECT_THAT(check_ros({}, "loopback", 2).message, HasSubstr("2 processes of ROS 2"));
  EXPECT_EQ(check_ros({}, "all", 0).level, Level::fine);
  EXPECT_EQ(check_ros({"", "1", "", false}, "loopback", 0).level, Level::fine);
  EXPECT_EQ(check_ros({"rmw_fastrtps_cpp", "1", "", false}, "loopback", 0).level, Level::fine);
}

TEST(DoctorOfRos, GivesTheLineForEachVendor) {
  for (const char* fast : {"", "rmw_fastrtps_cpp"}) {
    const Finding finding = check_ros({fast, "", "", false}, "loopback", 0);
    EXPECT_EQ(finding.level, Level::note);
    EXPECT_THAT(finding.message, HasSubstr("does not meet Goshawk"));
    EXPECT_THAT(finding.mend, HasSubstr("export ROS_LOCALHOST_ONLY=1"));
  }
  // Its limit of nine processes is less than a flight has.
  const Finding finding = check_ros({"rmw_cyclonedds_cpp", "1", "", false}, "loopback", 0);
  EXPECT_EQ(finding.level, Level::note);
  const std::string line = "export CYCLONEDDS_URI='";
  const auto begin = finding.mend.find(line);
  ASSERT_NE(begin, std::string::npos);
  // The line mends what it was given for.
  const auto from = begin + line.size();
  const std::string uri = finding.mend.substr(from, finding.mend.find('\'', from) - from);
  EXPECT_EQ(check_ros({"rmw_cyclonedds_cpp", "", uri, false}, "loopback", 0).level, Level::fine);
}

TEST(DoctorOfRos, DoesNotJudgeAFileOfCyclone) {
  const std::string file = "file:///etc/cyclone.xml";
  const Finding finding = check_ros({"rmw_cyclonedds_cpp", "", file, false}, "loopback", 0);
  EXPECT_EQ(finding.level, Level::note);
  EXPECT_THAT(finding.message, HasSubstr("the file in CYCLONEDDS_URI decides"));
  // Fast DDS does not read it.
  EXPECT_EQ(check_ros({"rmw_fastrtps_cpp", "1", file, false}, "loopback", 0).level, Level::fine);
}

TEST(DoctorOfRos, KnowsThatAProfileDecides) {
  const Finding finding = check_ros({"", "1", "", true}, "loopback", 0);
  EXPECT_EQ(finding.level, Level::note);
  EXPECT_THAT(finding.mend, HasSubstr("FASTRTPS_DEFAULT_PROFILES_FILE"));
}

}  // namespace
}  // namespace goshawk::introspection
