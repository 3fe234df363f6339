#pragma once

#include "protocol/roboclaw/Packet.h"

namespace hermes::roboclaw {

/// Reads the answer to one request, byte for byte. Knows no time: the caller gives up when an answer is late,
/// and tells when the line has fallen silent.
class ReplyParser {
public:
    enum class Result {
        Incomplete,
        Done,      ///< reply() holds the answer
        BadCrc,    ///< the answer, or the request on its way, was damaged
        Unexpected ///< no acknowledgement, or a text without its end
    };

    /// Awaits the answer to this request and forgets what came before.
    void begin(const Request &request);
    /// One byte more. What follows the end of an answer must not be fed.
    Result feed(std::uint8_t byte);
    /// The line has been silent for 10 ms or more: what came is all. Done when it is a whole answer of the
    /// firmware whose answer is shorter (ReadStatus with 16 bits, ReadMainLimits).
    Result silence();

    const Reply &reply() const { return reply_; }
    /// Which of the layouts the answer has.
    Dialect dialect() const { return dialect_; }
    std::size_t received() const { return bytes_.size(); }

private:
    Result feedText();
    Result finish(std::string_view fields, Dialect dialect);
    bool crcFits(std::size_t dataSize) const;

    const Layout *layout_ = nullptr;
    std::uint16_t requestCrc_ = 0;
    Bytes bytes_;
    Reply reply_;
    Dialect dialect_ = Dialect::Usual;
};

} // namespace hermes::roboclaw
