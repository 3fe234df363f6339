#pragma once

#include "protocol/jsonrpc/RpcError.h"

#include <type_traits>
#include <utility>
#include <variant>

namespace hermes {

/// What failed: a code for programs, a sentence for people, optional data. The same on the wire and inside.
using Error = RpcError;

/// A value, or the Error that explains why there is none. Converts from both:
/// `return 3.5;` and `return Error(ErrorCode::InputOutput, "...");`.
template <typename T>
class Result {
public:
    template <typename U = T, typename = std::enable_if_t<std::is_convertible_v<U &&, T>>>
    Result(U &&value)
        : content_(std::in_place_type<T>, std::forward<U>(value)) {}
    Result(Error error)
        : content_(std::move(error)) {}

    bool ok() const { return std::holds_alternative<T>(content_); }
    explicit operator bool() const { return ok(); }

    const T &value() const { return std::get<T>(content_); } ///< only when ok()
    T &value() { return std::get<T>(content_); }
    T take() { return std::move(std::get<T>(content_)); }
    const T &operator*() const { return value(); }
    const T *operator->() const { return &value(); }
    const Error &error() const { return std::get<Error>(content_); } ///< only when not ok()

private:
    std::variant<T, Error> content_;
};

/// Success without a value: `return {};`, or an Error.
template <>
class Result<void> {
public:
    Result() = default;
    Result(Error error)
        : failure_(std::move(error))
        , failed_(true) {}

    bool ok() const { return !failed_; }
    explicit operator bool() const { return ok(); }
    const Error &error() const { return failure_; } ///< only when not ok()

private:
    Error failure_;
    bool failed_ = false;
};

} // namespace hermes
