#include "daemons/seriallogger/LineSplitter.h"

namespace hermes::seriallogger {

void LineSplitter::feed(std::string_view bytes, const Moment &arrival, const Sink &sink) {
    for (const char byte : bytes) {
        if (byte == '\n' || byte == '\r') {
            emitLine(false, sink);
        } else {
            if (line_.size() == longest)
                emitLine(true, sink);
            if (line_.empty()) {
                arrival_ = arrival;
                begin_ = offset_;
            }
            line_.push_back(byte);
        }
        ++offset_;
    }
}

void LineSplitter::finish(const Sink &sink) {
    emitLine(false, sink);
}

void LineSplitter::skip(std::uint64_t bytes, const Sink &sink) {
    emitLine(true, sink);
    offset_ += bytes;
}

void LineSplitter::emitLine(bool cut, const Sink &sink) {
    if (!line_.empty())
        sink({arrival_, begin_, line_, cut});
    line_.clear();
}

std::string escaped(std::string_view bytes) {
    constexpr char digits[] = "0123456789ABCDEF";
    std::string text;
    text.reserve(bytes.size());
    for (const char byte : bytes) {
        const auto value = static_cast<unsigned char>(byte);
        if (byte == '\\')
            text += "\\\\";
        else if ((byte >= ' ' && byte <= '~') || byte == '\t')
            text += byte;
        else
            text += {'\\', 'x', digits[value >> 4], digits[value & 15]};
    }
    return text;
}

} // namespace hermes::seriallogger
