// A value or the reason why there is none. Library code returns Result; it never prints or exits.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace gnomon {

// What happened, to which file and element, and what to do: one sentence that can be shown to a
// user as it is.
struct Error {
  std::string message;
};

template <class T>
class Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: converts by design
  Result(Error error) : state_(std::move(error)) {}  // NOLINT: converts by design

  explicit operator bool() const { return std::holds_alternative<T>(state_); }

  // The value; throws std::runtime_error with the error's message where there is none.
  T& value() & {
    require();
    return std::get<T>(state_);
  }
  const T& value() const& {
    require();
    return std::get<T>(state_);
  }
  T&& value() && {
    require();
    return std::get<T>(std::move(state_));
  }

  // Precondition: there is no value.
  const Error& error() const { return std::get<Error>(state_); }

 private:
  void require() const {
    if (const Error* e = std::get_if<Error>(&state_)) throw std::runtime_error(e->message);
  }
  std::variant<T, Error> state_;
};

}  // namespace gnomon
