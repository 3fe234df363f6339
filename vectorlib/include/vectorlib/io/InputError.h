#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <variant>

namespace vectorlib {

/// Why an input could not be read: where it is, what was found there and what was expected instead.
struct InputError {
    std::string file;     ///< name of the input as the caller gave it
    std::size_t line = 0; ///< counted from 1; 0 when the input as a whole is meant
    std::string found;
    std::string expected;

    /// `room.csv:12: found "nan", expected a finite number`
    std::string message() const {
        const std::string place = line > 0 ? file + ":" + std::to_string(line) : file;
        return place + ": found " + found + ", expected " + expected;
    }
};

/// A value, or the error why there is none.
template <typename T>
class Expected {
public:
    Expected(T value)
        : state_(std::move(value)) {}
    Expected(InputError error)
        : state_(std::move(error)) {}

    bool hasValue() const { return state_.index() == 0; }
    explicit operator bool() const { return hasValue(); }
    T &value() { return std::get<0>(state_); }
    const T &value() const { return std::get<0>(state_); }
    T &operator*() { return value(); }
    const T &operator*() const { return value(); }
    T *operator->() { return &value(); }
    const T *operator->() const { return &value(); }
    const InputError &error() const { return std::get<1>(state_); }

private:
    std::variant<T, InputError> state_;
};

} // namespace vectorlib
