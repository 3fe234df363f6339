#include "protocol/serial/Cobs.h"

#include <cstring>

namespace hermes {
namespace {

constexpr int longestRun = 0xff; // a code of it: 254 bytes that no zero follows

} // namespace

QByteArray cobsEncoded(const QByteArray &bytes) {
    QByteArray out;
    out.reserve(bytes.size() + bytes.size() / (longestRun - 1) + 1);
    int code = 0; // where that of the run stands
    out.append(char(1));
    const auto close = [&] {
        out[code] = char(out.size() - code);
        code = out.size();
        out.append(char(1));
    };
    for (int i = 0; i < bytes.size(); ++i) {
        if (bytes[i] != 0)
            out.append(bytes[i]);
        const bool isFull = bytes[i] != 0 && out.size() - code == longestRun;
        if (bytes[i] == 0 || (isFull && i + 1 < bytes.size()))
            close();
    }
    out[code] = char(out.size() - code);
    return out;
}

std::optional<QByteArray> cobsDecoded(const char *bytes, int size) {
    if (size <= 0 || std::memchr(bytes, 0, std::size_t(size)))
        return std::nullopt;
    QByteArray out;
    out.reserve(size);
    for (int at = 0; at < size;) {
        const int code = quint8(bytes[at]);
        if (at + code > size)
            return std::nullopt;
        out.append(bytes + at + 1, code - 1);
        at += code;
        if (code < longestRun && at < size)
            out.append('\0');
    }
    return out;
}

} // namespace hermes
