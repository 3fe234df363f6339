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
        : content(std::in_place_type<T>, std::forward<U>(value)) {}
    Result(Error error)
        : content(std::move(error)) {}

    bool ok() const { return std::holds_alternative<T>(content); }
    explicit operator bool() const { return ok(); }

    const T &value() const { return std::get<T>(content); } ///< only when ok()
    T &value() { return std::get<T>(content); }
    T take() { return std::move(std::get<T>(content)); }
    const T &operator*() const { return value(); }
    const T *operator->() const { return &value(); }
    const Error &error() const { return std::get<Error>(content); } ///< only when not ok()

private:
    std::variant<T, Error> content;
};

/// Success without a value: `return {};`, or an Error.
template <>
class Result<void> {
public:
    Result() = default;
    Result(Error error)
        : failure(std::move(error))
        , failed(true) {}

    bool ok() const { return !failed; }
    explicit operator bool() const { return ok(); }
    const Error &error() const { return failure; } ///< only when not ok()

private:
    Error failure;
    bool failed = false;
};

} // namespace hermes
