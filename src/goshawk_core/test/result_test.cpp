#include "goshawk/core/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

namespace goshawk {
namespace {

TEST(Result, HoldsTheValueOfASuccess) {
  Result<int> result = 7;
  EXPECT_TRUE(result.ok());
  EXPECT_TRUE(bool(result));
  EXPECT_EQ(result.value(), 7);
  EXPECT_EQ(*result, 7);
  EXPECT_EQ(result.code(), ErrorCode::ok);
  *result = 8;
  const Result<int> copy = result;
  EXPECT_EQ(copy.value(), 8);
  EXPECT_EQ(*copy, 8);
}

TEST(Result, HoldsTheCodeAndTheSentenceOfAFailure) {
  const Result<int> result = fail(ErrorCode::no_path, "the goal is cut off");
  EXPECT_FALSE(result.ok());
  EXPECT_FALSE(bool(result));
  EXPECT_EQ(result.code(), ErrorCode::no_path);
  EXPECT_EQ(result.error().code, ErrorCode::no_path);
  EXPECT_EQ(result.error().message, "the goal is cut off");
}

TEST(Result, ThrowsWhenAskedForWhatItDoesNotHold) {
  Result<std::string> failure = fail(ErrorCode::no_path, "the goal is cut off");
  const Result<std::string>& constant = failure;
  EXPECT_THROW((void)failure.value(), std::logic_error);
  EXPECT_THROW((void)constant.value(), std::logic_error);
  EXPECT_THROW((void)*failure, std::logic_error);
  EXPECT_THROW((void)*constant, std::logic_error);
  EXPECT_THROW((void)failure->size(), std::logic_error);
  EXPECT_THROW((void)constant->size(), std::logic_error);
  EXPECT_THROW((void)std::move(failure).value(), std::logic_error);
  EXPECT_THROW((void)Result<int>(1).error(), std::logic_error);
  try {
    (void)constant.value();
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("the goal is cut off"), std::string::npos);
  }
}

TEST(Result, CarriesValuesThatOnlyMove) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  EXPECT_EQ(**result, 3);
  const std::unique_ptr<int> taken = std::move(result).value();
  EXPECT_EQ(*taken, 3);
}

TEST(Result, StatusSucceedsWithoutAValue) {
  EXPECT_TRUE(success().ok());
  EXPECT_EQ(Status(fail(ErrorCode::io_failed, "disk full")).code(), ErrorCode::io_failed);
}

TEST(ErrorCode, HasANameOfItsOwnForEveryCode) {
  std::set<std::string> names;
  for (const ErrorCode code : all_error_codes()) {
    const std::string name(to_string(code));
    EXPECT_FALSE(name.empty());
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << name;
  }
  EXPECT_EQ(names.size(), all_error_codes().size());
  EXPECT_EQ(all_error_codes().back(), ErrorCode::not_permitted)
      << "a code is missing from the list";
  EXPECT_EQ(to_string(ErrorCode::ok), "ok");
  EXPECT_EQ(to_string(ErrorCode::goal_unknown), "goal_unknown");
  EXPECT_EQ(to_string(ErrorCode::io_failed), "io_failed");
}

TEST(ErrorCode, RefusesACodeThatIsNone) {
  EXPECT_THROW((void)to_string(static_cast<ErrorCode>(1000)), std::out_of_range);
}

}  // namespace
}  // namespace goshawk
