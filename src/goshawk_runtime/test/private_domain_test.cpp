#include "goshawk/runtime/private_domain.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <set>

namespace goshawk::runtime {
namespace {

TEST(PrivateDomain, IsGivenOnce) {
  std::set<int> held;
  for (int k = 0; k < 3; ++k) {
    const auto domain = hold_private_domain();
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_TRUE(held.insert(*domain).second) << *domain << " was given twice";
    EXPECT_FALSE(hold_domain(*domain));
    EXPECT_GE(*domain, 20);
    EXPECT_LE(*domain, 99);
  }
}

/// A process holds a domain and is killed. @return whether the domain could be held afterwards
bool is_free_after_a_kill() {
  int to_parent[2];
  EXPECT_EQ(pipe(to_parent), 0);
  const pid_t child = fork();
  EXPECT_GE(child, 0);
  if (child == 0) {
    const int domain = hold_private_domain().value();
    (void)!::write(to_parent[1], &domain, sizeof domain);
    while (true) pause();
  }
  int domain = 0;
  EXPECT_EQ(::read(to_parent[0], &domain, sizeof domain), ssize_t(sizeof domain));
  EXPECT_FALSE(hold_domain(domain));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (const int end : to_parent) close(end);
  return bool(hold_domain(domain));
}

// Another test on this machine may take the domain first, but not each time.
TEST(PrivateDomain, IsFreeAgainWhenItsProcessIsKilled) {
  bool free = false;
  for (int k = 0; k < 5 && !free; ++k) free = is_free_after_a_kill();
  EXPECT_TRUE(free);
}

// A program that joined a domain without holding it, as one of another DDS would.
TEST(PrivateDomain, IsNoneThatAnotherProgramIsIn) {
  const int domain = 20 + (hold_private_domain().value() - 20 + 1) % 80;
  const int other = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(std::uint16_t(7400 + 250 * domain + 10));
  (void)bind(other, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  EXPECT_FALSE(hold_domain(domain)) << "its port is taken, by us or by another program";
  EXPECT_NE(hold_private_domain().value(), domain);
  close(other);
}

}  // namespace
}  // namespace goshawk::runtime
