#pragma once

#include "common/capture/CaptureRecords.h"

#include <QtGlobal>

/// Captures that are made at random, and what CaptureRecords finds in a capture.
namespace hermes::captures {

struct Record {
    qint64 seconds = 0;
    qint64 nanoseconds = 0;
    QByteArray frame;

    bool operator==(const Record &other) const {
        return seconds == other.seconds && nanoseconds == other.nanoseconds && frame == other.frame;
    }
};

/// What a reader made of a file.
struct Reading {
    std::vector<Record> records;
    bool isOpened = false;
    bool failed = false;
};

/// Writes numbers in one byte order.
class Writer {
public:
    explicit Writer(bool bigEndian)
        : bigEndian_(bigEndian) {}
    Writer &number(quint64 value, int bytes) {
        for (int i = 0; i < bytes; ++i)
            content += char(value >> 8 * (bigEndian_ ? bytes - 1 - i : i));
        return *this;
    }
    Writer &word(quint32 value) { return number(value, 4); }
    Writer &half(quint16 value) { return number(value, 2); }
    /// A block of pcapng.
    void block(quint32 type, const QByteArray &body) {
        const quint32 padded = quint32(body.size() + 3) / 4 * 4;
        word(type).word(padded + 12);
        content += body + QByteArray(int(padded) - body.size(), '\0');
        word(padded + 12);
    }

    QByteArray content;

private:
    const bool bigEndian_;
};

class Generator {
public:
    explicit Generator(unsigned seed)
        : random_(seed) {}

    quint32 below(quint32 limit) { return quint32(random_() % limit); }

    QByteArray frame() {
        QByteArray bytes(int(below(80)), '\0');
        for (char &byte : bytes)
            byte = char(random_());
        return bytes;
    }

    QByteArray classic() {
        const bool isBig = below(2), isModified = below(4) == 0, hasNanoseconds = !isModified && below(2);
        const quint16 part =
            quint16(below(2) ? 4 : 2 + below(2)); // before 2.4 lengths may be the other way round
        Writer file(isBig);
        file.word(isModified ? 0xA1B2CD34 : hasNanoseconds ? 0xA1B23C4D : 0xA1B2C3D4).half(2).half(part);
        file.word(0).word(0).word(limit()).word(1);
        for (quint32 i = below(6); i > 0; --i) {
            const QByteArray bytes = frame();
            const quint32 size = quint32(bytes.size()), whole = size + below(9);
            const bool isSwapped = part == 2 || (part == 3 && below(2));
            file.word(quint32(random_())).word(below(hasNanoseconds ? 1000000000 : 1000000));
            file.word(isSwapped ? whole : size).word(isSwapped ? size : whole);
            file.content += (isModified ? QByteArray(8, 'm') : QByteArray()) + bytes;
        }
        return file.content;
    }

    QByteArray pcapng() {
        const bool isBig = below(2);
        longest_ =
            below(2) ? 0 : 65535 + below(1000000); // libpcap wants that of all interfaces to be the same
        Writer file(isBig);
        for (quint32 sections = 1 + below(2); sections > 0; --sections)
            section(file, isBig);
        return file.content;
    }

private:
    /// Of the length of frames, as a classic file tells it.
    quint32 limit() {
        static const quint32 limits[] = {0, 20, 45, 65535, 262144, 400000, 0x80000000, 0xFFFFFFFF};
        return limits[below(8)];
    }

    void section(Writer &file, bool isBig) {
        Writer header(isBig);
        header.word(0x1A2B3C4D).half(1).half(0).number(~0ULL, 8);
        file.block(0x0A0D0D0A, header.content);
        const quint32 interfaces = 1 + below(3);
        for (quint32 i = 0; i < interfaces; ++i)
            file.block(1, interfaceDescription(isBig));
        for (quint32 i = below(6); i > 0; --i) {
            const quint32 kind = below(8);
            if (kind == 0)
                file.block(5, QByteArray(8, 'x')); // statistics: passed over
            else if (kind == 1)
                file.block(3, simplePacket(isBig));
            else
                file.block(kind == 2 ? 2 : 6, packet(isBig, kind == 2, below(interfaces)));
        }
    }

    QByteArray interfaceDescription(bool isBig) {
        Writer body(isBig);
        body.half(1).half(0).word(longest_);
        if (below(2)) {
            // Finer ones of 2 overflow in libpcap.
            static const int resolutions[] = {0, 3, 6, 9, 19, 0x80 | 10, 0x80 | 20, 0x80 | 32};
            body.half(9).half(1).number(quint64(resolutions[below(8)]), 1).number(0, 3);
        }
        if (below(3) == 0)
            body.half(14).half(8).number(below(100000), 8);
        if (below(2))
            body.half(0).half(0);
        return body.content;
    }

    QByteArray packet(bool isBig, bool isOld, quint32 number) {
        const QByteArray bytes = frame();
        const quint32 size = quint32(bytes.size());
        Writer body(isBig);
        if (isOld)
            body.half(quint16(number)).half(0);
        else
            body.word(number);
        body.word(below(0x20000)).word(quint32(random_())).word(size).word(size + below(9));
        return body.content + bytes;
    }

    QByteArray simplePacket(bool isBig) {
        const QByteArray bytes = frame();
        return Writer(isBig).word(quint32(bytes.size())).content + bytes;
    }

    std::mt19937 random_;
    quint32 longest_ = 0;
};

inline Reading ours(const QByteArray &content) {
    std::istringstream stream(content.toStdString());
    std::string error;
    const std::unique_ptr<CaptureRecords> records = CaptureRecords::open(stream, error);
    Reading reading;
    reading.isOpened = bool(records);
    if (!records)
        return reading;
    CaptureRecord record;
    CaptureRecords::Next next;
    while ((next = records->next(record)) == CaptureRecords::Next::Record)
        reading.records.push_back(
            {record.seconds, record.nanoseconds,
             QByteArray(reinterpret_cast<const char *>(record.frame.data()), int(record.frame.size()))});
    reading.failed = next == CaptureRecords::Next::Failed;
    if (reading.failed == records->error().empty())
        qFatal("an error without a message, or a message without an error: %s", records->error().c_str());
    return reading;
}

} // namespace hermes::captures
