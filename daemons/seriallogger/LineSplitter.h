#pragma once

#include "common/Time.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace hermes::seriallogger {

/// Splits a stream of bytes into lines ended by CR, LF or both. Empty lines are left out.
class LineSplitter {
public:
    static constexpr std::size_t longest = 1024; ///< bytes; what is longer comes in pieces

    struct Line {
        Moment arrival;           ///< of its first byte
        std::uint64_t offset = 0; ///< of its first byte in the stream
        std::string_view bytes;   ///< without its end; until the next feed()
        bool cut = false;         ///< more of the same line follows
    };
    using Sink = std::function<void(const Line &)>;

    void feed(std::string_view bytes, const Moment &arrival, const Sink &sink);
    /// Gives what has no end yet as a line.
    void finish(const Sink &sink);
    /// Bytes are missing here: what was begun is given as a line that is cut.
    void skip(std::uint64_t bytes, const Sink &sink);

private:
    void emitLine(bool cut, const Sink &sink);

    std::string line_;
    Moment arrival_;
    std::uint64_t begin_ = 0, offset_ = 0;
};

/// The bytes as text: printable ASCII and tabs as they are, a backslash doubled, all others as \xHH. Nothing
/// is lost by it.
std::string escaped(std::string_view bytes);

} // namespace hermes::seriallogger
