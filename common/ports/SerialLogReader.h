#pragma once

#include "common/Result.h"
#include "common/ports/SerialIndex.h"

#include <QFile>
#include <optional>

namespace hermes {

/// Reads the recording of one port from its beginning; of one being written, what was there when it was
/// opened. Blocks.
class SerialLogReader {
public:
    struct Piece {
        quint64 offset = 0; ///< of its first byte
        Moment arrival;
        QByteArray bytes;
    };
    static constexpr qint64 maxBytes = 1 << 16; ///< of a piece; longer chunks come in several

    /// base: path without ".raw" and ".index". Errors name the file and what is wrong.
    Result<void> open(const QString &base);
    /// The next bytes that came in together, or an empty piece at the end. What is wrong with the index is an
    /// error.
    Result<Piece> next();
    /// Goes on with the first bytes that came in at this time or later; stamps that go back are not told
    /// apart.
    Result<void> seek(std::int64_t mono_ns);

private:
    std::optional<serialindex::Record> readRecord();
    Error wrong(const QString &what) const;

    QFile raw_, index_;
    quint64 size_ = 0; ///< of the bytes
    quint64 end_ = 0;  ///< of the chunk being read
    std::optional<serialindex::Record> chunk_, following_;
    quint64 offset_ = 0;
};

} // namespace hermes
