#pragma once

#include <type_traits>
#include <utility>
#include <variant>

namespace vectorlib {

/// A value, or the error that explains why there is none. Converts from both: `return 3.5;` and
/// `return Error(...);`.
template <typename T, typename Error>
class Result {
public:
    template <typename U = T, typename = std::enable_if_t<std::is_convertible_v<U &&, T>>>
    Result(U &&value)
        : content_(std::in_place_index<0>, std::forward<U>(value)) {}
    Result(Error error)
        : content_(std::in_place_index<1>, std::move(error)) {}

    /// Whether there is a value.
    bool ok() const { return content_.index() == 0; }
    explicit operator bool() const { return ok(); }

    const T &value() const { return std::get<0>(content_); } ///< only when ok()
    T &value() { return std::get<0>(content_); }             ///< only when ok()
    /// Moves the value out; only when ok().
    T take() { return std::move(value()); }
    /// The value, as of a pointer; only when ok().
    T &operator*() { return value(); }
    const T &operator*() const { return value(); }
    T *operator->() { return &value(); }
    const T *operator->() const { return &value(); }
    const Error &error() const { return std::get<1>(content_); } ///< only when not ok()

private:
    std::variant<T, Error> content_;
};

/// Success without a value: `return {};`, or an error.
template <typename Error>
class Result<void, Error> {
public:
    Result() = default;
    Result(Error error)
        : error_(std::move(error))
        , failed_(true) {}

    bool ok() const { return !failed_; }
    explicit operator bool() const { return ok(); }
    const Error &error() const { return error_; } ///< says nothing when ok()

private:
    Error error_;
    bool failed_ = false;
};

} // namespace vectorlib
