#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "goshawk/core/error.hpp"

namespace goshawk {

/// Either a value or an Error; never both, never neither. C++20 has no std::expected.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT: implicit on purpose
  Result(Error error) : content_(std::move(error)) {}  // NOLINT: implicit on purpose

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  /// @pre ok(); asking a failure for its value is a bug and throws.
  T& value() & { return checked(); }
  const T& value() const& { return const_cast<Result*>(this)->checked(); }
  T&& value() && { return std::move(checked()); }
  T& operator*() & { return checked(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(checked()); }
  T* operator->() { return &checked(); }
  const T* operator->() const { return &value(); }

  /// @pre !ok()
  const Error& error() const {
    if (ok()) throw std::logic_error("Result::error() of a success");
    return std::get<Error>(content_);
  }

  ErrorCode code() const { return ok() ? ErrorCode::ok : std::get<Error>(content_).code; }

 private:
  T& checked() {
    if (!ok()) {
      throw std::logic_error("Result::value() of a failure: " + std::get<Error>(content_).message);
    }
    return std::get<T>(content_);
  }

  std::variant<T, Error> content_;
};

/// For operations that have nothing to return but may fail.
using Status = Result<std::monostate>;

inline Status success() {
  return Status(std::monostate{});
}

/// fail(ErrorCode::no_path, "...") reads better than braces at the call.
inline Error fail(ErrorCode code, std::string message) {
  return Error{code, std::move(message)};
}

}  // namespace goshawk
