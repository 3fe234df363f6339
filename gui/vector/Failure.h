#pragma once

#include "common/Outcome.h"
#include "vectorlib/io/TextInput.h"

#include <algorithm>
#include <stdexcept>

namespace hermes::vector {

/// Why a command could not do its work; the message is for people. The program exits with status 1.
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Without what a terminal would obey: names in files are anybody's.
inline std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return (c < ' ' && c != '\n') || c == 0x7F; }, '?');
    return text;
}

/// The value, or a Failure with the message.
template <typename T>
T valueOrFail(Outcome<T> outcome) {
    if (!outcome)
        throw Failure(outcome.error());
    return outcome.take();
}

/// The value, or a Failure with the reader's message.
template <typename T>
T valueOrFail(vectorlib::Expected<T> result) {
    if (!result)
        throw Failure(result.error().message());
    return std::move(*result);
}

} // namespace hermes::vector
