#pragma once

#include "vectorlib/error/Result.h"

#include <cstddef>
#include <string>

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

/// What was read, or why it could not be read.
template <typename T>
using Expected = Result<T, InputError>;

} // namespace vectorlib
